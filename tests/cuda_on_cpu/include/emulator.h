/// \file emulator.h
/// What the stand-in headers need of the emulated device: threads that meet, work that waits for the device, memory.
#ifndef CUDA_ON_CPU_EMULATOR_H
#define CUDA_ON_CPU_EMULATOR_H

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <type_traits>

struct uint3
{
    unsigned x, y, z;
};

struct dim3
{
    unsigned x, y, z;
    constexpr dim3(unsigned x_ = 1, unsigned y_ = 1, unsigned z_ = 1) : x(x_), y(y_), z(z_) {}
};

typedef struct cuda_on_cpu_stream *cudaStream_t;
typedef struct cuda_on_cpu_event *cudaEvent_t;

namespace cuda_on_cpu
{

/// Last parameters of every function in which threads meet, the place of the call, and how they are handed on. Two
/// numbers, because the compiler takes the caller's place for default arguments only where they stand alone.
#define CUDA_ON_CPU_PLACE const char *file = __builtin_FILE(), int line = __builtin_LINE()
#define CUDA_ON_CPU_SAME_PLACE file, line

/// What a device thread knows about itself.
struct thread_state
{
    uint3 thread, block;
    dim3 block_size, grid_size;
    unsigned rank; ///< in its block
    unsigned lane; ///< in its warp
    unsigned warp; ///< in its block
};
/// The device thread that runs now; NULL on the host.
extern thread_local thread_state *current;

/// Ends the program: the kernel, or the host's use of the device, is wrong. Says which kernel, block and thread.
[[noreturn]] void fail(const char *format, ...) __attribute__((format(printf, 1, 2)));

/// All threads of the block meet; returns how many brought a true vote.
int meet_block(bool vote, const char *file, int line);

/// 16 bytes that a lane brings to a meeting of its warp.
struct lane_value
{
    uint64_t words[2];
};
/// What the lanes of a warp do together; lanes that meet must do the same.
enum class warp_operation
{
    sync,
    ballot,
    shuffle
};
/// The outcome of a meeting.
struct warp_meeting_result
{
    lane_value values[32];
    unsigned lanes; ///< that took part: those of the mask that have not returned from the kernel
};
/// The lanes of `mask` meet. Orders memory between them for warp_operation::sync only, as on the device.
warp_meeting_result meet_warp(unsigned mask, warp_operation operation, lane_value value, const char *file, int line);

/// Before each atomic access. True if the thread has fenced, so that the access releases.
bool note_atomic(const void *address);
void fence();

/// Dynamic shared memory of the block; filled with 0xff when the block starts.
void *dynamic_shared();

/// A launch: copies of the arguments are in `body`, which is called once per thread. Returns a cudaError_t.
struct launch_shape
{
    dim3 grid, block;
    size_t dynamic_shared_bytes;
};
int launch(const char *kernel, const launch_shape &shape, std::function<void()> body, cudaStream_t stream);

enum class node_kind
{
    kernel,
    copy,
    set,
    other
};
/// Work for the device, after what was asked in the stream before. It is done when the host waits for it, not before;
/// if the stream is captured, it is kept for a graph instead. Returns a cudaError_t.
int enqueue(node_kind kind, std::function<void()> work, cudaStream_t stream);
/// Does all the work that waits.
void drain();

/// From now on there is memory for so many allocations; < 0: for all that fit.
void allow_allocations(long num);
/// Arrays that the device was asked for so far.
long num_allocations();

/// From now on graphs can be captured, but not be made ready for launches; false: they can.
void refuse_graphs(bool refuses);

/// Name of a function; the program must export its symbols.
const char *name_of(const void *function);
/// Fails if an aligned word of these bytes is the address of host memory.
void refuse_host_addresses(const char *what, const void *bytes, size_t num_bytes);

template <class T> lane_value pack(T value)
{
    static_assert(sizeof(T) <= sizeof(lane_value) && std::is_trivially_copyable<T>::value, "fits no lane value");
    lane_value packed = {{0, 0}};
    std::memcpy(&packed, &value, sizeof value);
    return packed;
}

template <class T> T unpack(lane_value packed)
{
    T value;
    std::memcpy(&value, &packed, sizeof value);
    return value;
}

} // namespace cuda_on_cpu

#endif
