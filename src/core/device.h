/// \file device.h
/// Where arrays lie and kernels run: an NVIDIA GPU, or the CPU, which NULL stands for everywhere. What is asked of a
/// GPU is done in the order of the calls, unless they are in branches, but later; reading waits for it. The first
/// failure stays: everything after it does nothing, and scree_device_status() tells it.
#ifndef SCREE_DEVICE_H
#define SCREE_DEVICE_H

#include "core/live.h"
#include "scree/base.h"

#ifdef __cplusplus
extern "C"
{
#endif

    typedef struct scree_device scree_device;

#define SCREE_NUM_BRANCHES 3

    /// How a GPU is used. Start from scree_default_device_def().
    typedef struct scree_device_def
    {
        int32_t number; ///< of the GPU, from 0
        int32_t block;  ///< threads of a block, 1 to 128; no result depends on it
        bool records;   ///< steps may be recorded and played; false: every call by itself, for tools that look at it
        int64_t arena_bytes; ///< taken at the start and whenever more is needed, > 0; 0: every array by itself, for
                             ///< tools that look for accesses beyond its ends
    } scree_device_def;

    scree_device_def scree_default_device_def(void);

    /// Opens a GPU. Refused with a message: SCREE_NO_DEVICE (this build has no CUDA, there is no GPU of this number,
    /// GPU or driver are too old), SCREE_OUT_OF_MEMORY.
    scree_status scree_device_open(scree_device **device, const scree_device_def *def, scree_report *report);
    /// Frees all memory of the GPU that was taken through it. NULL is allowed.
    void scree_device_close(scree_device *device);
    /// Waits. SCREE_OK, or SCREE_DEVICE_FAILED with a message.
    scree_status scree_device_status(scree_device *device, scree_report *report);

    /// How many bodies of a kernel can be under way at once: threads of OpenMP, or of the GPU's multiprocessors.
    int64_t scree_device_concurrency(scree_device *device);
    /// Free memory of a GPU [bytes], what its arena has left included; INT64_MAX for the CPU.
    int64_t scree_device_free_memory(scree_device *device);
    /// Takes memory of a GPU for arrays to come, all at once; false if there is not so much. Nothing on the CPU, or
    /// where every array is taken by itself.
    bool scree_device_take(scree_device *device, int64_t num_bytes);
    /// Name of a GPU; "CPU" for NULL.
    const char *scree_device_name(const scree_device *device);

    /// Uninitialised memory for num_items. Never NULL but if memory is out or the size overflows; 0 items get memory
    /// too.
    void *scree_device_alloc(scree_device *device, int64_t num_items, size_t item_size);
    void scree_device_free(scree_device *device, void *memory);

    /// Copies to the device; `from` can be reused at once.
    void scree_device_write(scree_device *device, void *to, const void *from, size_t num_bytes);
    /// Copies from the device, when all that was asked before is done. After a failure *to stays as it was.
    void scree_device_read(scree_device *device, void *to, const void *from, size_t num_bytes);
    /// Copies within the device; the two must not overlap.
    void scree_device_copy(scree_device *device, void *to, const void *from, size_t num_bytes);
    void scree_device_zero(scree_device *device, void *memory, size_t num_bytes);

    /// Beside the usual way that calls go one after the other, there are branches 1 .. SCREE_NUM_BRANCHES. From here on
    /// calls go to this one: they are done after what it was asked for before, after what was asked outside of branches
    /// so far, and beside all else. 0: outside again.
    void scree_device_branch(scree_device *device, int32_t branch);
    /// Calls go outside of branches again, after all that these were asked for. Waiting and freeing memory does so too.
    void scree_device_join(scree_device *device);

    /// Waits for all that was asked.
    void scree_device_wait(scree_device *device);
    /// Zeroed memory of the host for copies that nobody waits for. NULL: out of memory.
    void *scree_device_alloc_host(scree_device *device, size_t num_bytes);
    void scree_device_free_host(scree_device *device, void *memory);
    /// Copies to the device, later: `from`, of scree_device_alloc_host(), must stay as it is until then.
    void scree_device_send(scree_device *device, void *to, const void *from, size_t num_bytes);
    /// Copies from the device, later, to memory of scree_device_alloc_host(): wait before you look.
    void scree_device_fetch(scree_device *device, void *to, const void *from, size_t num_bytes);

    /// Calls that were recorded, to be played with one call: a CUDA graph.
    typedef struct scree_recording scree_recording;

    /// May calls be recorded? Never on the CPU, which gains nothing by it.
    bool scree_device_records(const scree_device *device);
    /// From here on calls are kept instead of done: launches, scans, and scree_device_copy(), _zero(), _send(),
    /// _fetch(), _branch(), _join(). Nothing else may be called. When they are played, launches look up `live`, which
    /// lies on the device.
    void scree_device_record(scree_device *device, const scree_live *live);
    /// Ends that. The calls take the place of those of *recording, which is NULL to begin with. False: it cannot be
    /// done, *recording is NULL, and scree_device_records() says no from now on.
    bool scree_device_end_record(scree_device *device, scree_recording **recording);
    void scree_device_play(scree_device *device, const scree_recording *recording);
    /// NULL is allowed.
    void scree_device_forget(scree_device *device, scree_recording *recording);

    /// Room for num_items of item_size bytes behind *array, growing by a quarter at least; contents are not kept.
    /// SCREE_OUT_OF_MEMORY leaves *array NULL and *max_items 0.
    scree_status scree_device_reserve(scree_device *device, void *array, int64_t *max_items, int64_t num_items,
                                      size_t item_size);
    /// The same without growing by more than is asked for.
    scree_status scree_device_reserve_only(scree_device *device, void *array, int64_t *max_items, int64_t num_items,
                                           size_t item_size);

#ifdef __cplusplus
}
#endif
#endif
