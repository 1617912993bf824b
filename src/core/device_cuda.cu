/// \file device_cuda.cu
/// Memory and copies of an NVIDIA GPU. One stream and its branches; errors are kept, not returned, so that the step
/// reads as on the CPU.
#include "core/device_cuda.cuh"

#include "core/device_cuda.h"

#include <stdlib.h>
#include <string.h>

/// Compute capability that scree is compiled for, at least: 8.0 stands for 80.
#define SCREE_CUDA_CAPABILITY 80

/// Threads of a kernel with all the registers there are that a multiprocessor holds: 65536/255, in whole warps.
#define SCREE_CUDA_RESIDENT 256

/// The message to an error of the first calls.
static scree_status refuse(cudaError_t error, int number, scree_report *report)
{
    int driver = 0, runtime = 0;
    cudaDriverGetVersion(&driver);
    cudaRuntimeGetVersion(&runtime);
    if (error == cudaErrorInsufficientDriver && driver == 0)
        scree_report_add(report,
                         "no NVIDIA driver is installed here: install one for CUDA %d.%d or later, or run on the "
                         "CPU",
                         runtime / 1000, runtime % 1000 / 10);
    else if (error == cudaErrorInsufficientDriver)
        scree_report_add(report,
                         "the NVIDIA driver offers CUDA %d.%d, this build of scree needs %d.%d: update the driver, or "
                         "run on the CPU",
                         driver / 1000, driver % 1000 / 10, runtime / 1000, runtime % 1000 / 10);
    else if (error == cudaErrorNoDevice)
        scree_report_add(report,
                         "there is no NVIDIA GPU here, or none that this process may use (CUDA_VISIBLE_DEVICES): "
                         "run on the CPU");
    else
        scree_report_add(report, "GPU %d cannot be used: %s; run on the CPU, or on another GPU", number,
                         cudaGetErrorString(error));
    return error == cudaErrorMemoryAllocation ? SCREE_OUT_OF_MEMORY : SCREE_NO_DEVICE;
}

/// Stands for all kernels: they are compiled for the same GPUs.
static __global__ void any_kernel() {}

/// Does the program hold code for the GPU that was chosen?
static scree_status find_code(int number, const cudaDeviceProp *properties, scree_report *report)
{
    cudaFuncAttributes attributes;
    const cudaError_t error = cudaFuncGetAttributes(&attributes, (const void *)any_kernel);
    if (error == cudaSuccess) return SCREE_OK;
    cudaGetLastError(); // told by the message
    if (error != cudaErrorNoKernelImageForDevice && error != cudaErrorInvalidDeviceFunction)
        return refuse(error, number, report);
    scree_report_add(report,
                     "this program was not built for GPU %d, \"%s\", of compute capability %d.%d: configure it with "
                     "-DCMAKE_CUDA_ARCHITECTURES=%d%d and build it again, or run on the CPU",
                     number, properties->name, properties->major, properties->minor, properties->major,
                     properties->minor);
    return SCREE_NO_DEVICE;
}

/// Is GPU `number` there, new enough, and is the program built for it? Its properties.
static scree_status find_device(int number, cudaDeviceProp *properties, scree_report *report)
{
    int num_devices = 0;
    cudaError_t error = cudaGetDeviceCount(&num_devices);
    if (error == cudaSuccess && num_devices == 0) error = cudaErrorNoDevice;
    if (error != cudaSuccess) return refuse(error, number, report);
    if (number < 0 || number >= num_devices)
    {
        scree_report_add(report, "there is no GPU %d: this machine has %d, counted from 0", number, num_devices);
        return SCREE_NO_DEVICE;
    }
    error = cudaGetDeviceProperties(properties, number);
    if (error == cudaSuccess) error = cudaSetDevice(number);
    if (error != cudaSuccess) return refuse(error, number, report);
    if (10 * properties->major + properties->minor < SCREE_CUDA_CAPABILITY)
    {
        scree_report_add(report,
                         "GPU %d, \"%s\", has compute capability %d.%d; scree needs %d.%d or more: run on another GPU, "
                         "or on the CPU",
                         number, properties->name, properties->major, properties->minor, SCREE_CUDA_CAPABILITY / 10,
                         SCREE_CUDA_CAPABILITY % 10);
        return SCREE_NO_DEVICE;
    }
    return find_code(number, properties, report);
}

/// One more block of memory for the arena, of num_bytes at least.
static bool add_block(scree_device *device, int64_t num_bytes)
{
    // half as much again as there is, so that growing costs little in all; less if there is no more
    int64_t wanted =
        device->arena.num_bytes / 2 > device->arena_bytes ? device->arena.num_bytes / 2 : device->arena_bytes;
    if (wanted < num_bytes || device->arena_bytes == 0) wanted = num_bytes;
    void *block = NULL;
    if (cudaMalloc(&block, (size_t)wanted) != cudaSuccess)
    {
        cudaGetLastError(); // told by the NULL that the caller gets
        wanted = num_bytes;
        if (cudaMalloc(&block, (size_t)wanted) != cudaSuccess)
        {
            cudaGetLastError();
            return false;
        }
    }
    if (scree_arena_add_block(&device->arena, block, wanted) == SCREE_OK) return true;
    cudaFree(block);
    return false;
}

scree_status scree_cuda_open(scree_device **device, const scree_device_def *def, scree_report *report)
{
    cudaDeviceProp properties;
    const scree_status status = find_device(def->number, &properties, report);
    if (status != SCREE_OK) return status;
    scree_device *d = (scree_device *)calloc(1, sizeof *d);
    if (d == NULL) return SCREE_OUT_OF_MEMORY;
    d->block = def->block;
    d->records = def->records;
    d->arena_bytes = def->arena_bytes;
    d->concurrency = (int64_t)properties.multiProcessorCount * SCREE_CUDA_RESIDENT;
    memcpy(d->name, properties.name, sizeof d->name);
    for (int k = 0; k <= SCREE_NUM_BRANCHES; ++k)
        if (scree_cuda_note(d, cudaStreamCreate(d->streams + k)))
            scree_cuda_note(d, cudaEventCreateWithFlags(d->events + k, cudaEventDisableTiming));
    d->stream = d->streams[0];
    if (d->error != cudaSuccess)
    {
        const cudaError_t error = d->error;
        scree_cuda_close(d);
        return refuse(error, def->number, report);
    }
    if (def->arena_bytes > 0 && !add_block(d, def->arena_bytes))
    {
        scree_report_add(report,
                         "GPU %d, \"%s\", has no %lld MB of free memory to start with: end what else runs there, "
                         "or run on the CPU",
                         def->number, d->name, (long long)(def->arena_bytes >> 20));
        scree_cuda_close(d);
        return SCREE_OUT_OF_MEMORY;
    }
    *device = d;
    return SCREE_OK;
}

void scree_cuda_close(scree_device *device)
{
    for (int64_t k = 0; k < device->arena.num_pieces; ++k)
        if (device->arena.pieces[k].is_first) cudaFree(device->arena.pieces[k].address);
    scree_arena_destroy(&device->arena);
    for (int k = 0; k <= SCREE_NUM_BRANCHES; ++k)
    {
        if (device->events[k] != NULL) cudaEventDestroy(device->events[k]);
        if (device->streams[k] != NULL) cudaStreamDestroy(device->streams[k]);
    }
    free(device);
}

scree_status scree_cuda_status(scree_device *device, scree_report *report)
{
    scree_cuda_join(device);
    scree_cuda_note(device, cudaStreamSynchronize(device->stream));
    if (device->error == cudaSuccess) return SCREE_OK;
    scree_report_add(report,
                     "GPU \"%s\" has failed: %s. What it held is lost: start again from the last checkpoint, or run on "
                     "the CPU",
                     device->name, cudaGetErrorString(device->error));
    return SCREE_DEVICE_FAILED;
}

int64_t scree_cuda_concurrency(scree_device *device) { return device->concurrency; }

const char *scree_cuda_name(const scree_device *device) { return device->name; }

int64_t scree_cuda_free_memory(scree_device *device)
{
    size_t num_free = 0, num_total = 0;
    scree_cuda_note(device, cudaMemGetInfo(&num_free, &num_total));
    return (int64_t)num_free + scree_arena_free_bytes(&device->arena);
}

bool scree_cuda_take(scree_device *device, int64_t num_bytes)
{
    if (device->arena_bytes == 0 || num_bytes <= scree_arena_free_bytes(&device->arena)) return true;
    return add_block(device, num_bytes);
}

void *scree_cuda_alloc(scree_device *device, int64_t num_bytes)
{
    if (device->error != cudaSuccess) return NULL;
    void *memory = device->arena_bytes > 0 ? scree_arena_take(&device->arena, num_bytes) : NULL;
    if (memory != NULL) return memory;
    if (device->arena_bytes == 0)
        return cudaMalloc(&memory, (size_t)(num_bytes > 0 ? num_bytes : 1)) == cudaSuccess ? memory : NULL;
    // a piece takes up to SCREE_ARENA_ALIGNMENT more than it was asked for
    return add_block(device, num_bytes + SCREE_ARENA_ALIGNMENT) ? scree_arena_take(&device->arena, num_bytes) : NULL;
}

void scree_cuda_free(scree_device *device, void *memory)
{
    // whoever gets this memory next comes after the branches
    scree_cuda_join(device);
    if (device->arena_bytes == 0) scree_cuda_note(device, cudaFree(memory));
    else scree_arena_give_back(&device->arena, memory);
}

void scree_cuda_send(scree_device *device, void *to, const void *from, size_t num_bytes)
{
    if (device->error != cudaSuccess) return;
    scree_cuda_note(device, cudaMemcpyAsync(to, from, num_bytes, cudaMemcpyHostToDevice, device->stream));
}

void scree_cuda_fetch(scree_device *device, void *to, const void *from, size_t num_bytes)
{
    if (device->error != cudaSuccess) return;
    scree_cuda_note(device, cudaMemcpyAsync(to, from, num_bytes, cudaMemcpyDeviceToHost, device->stream));
}

void scree_cuda_branch(scree_device *device, int32_t branch)
{
    device->stream = device->streams[branch];
    if (branch == 0 || device->error != cudaSuccess) return;
    device->is_open[branch] = true;
    scree_cuda_note(device, cudaEventRecord(device->events[0], device->streams[0]));
    scree_cuda_note(device, cudaStreamWaitEvent(device->stream, device->events[0], 0));
}

void scree_cuda_join(scree_device *device)
{
    device->stream = device->streams[0];
    for (int k = 1; k <= SCREE_NUM_BRANCHES; ++k)
    {
        if (!device->is_open[k]) continue;
        device->is_open[k] = false;
        if (device->error != cudaSuccess) continue;
        scree_cuda_note(device, cudaEventRecord(device->events[k], device->streams[k]));
        scree_cuda_note(device, cudaStreamWaitEvent(device->stream, device->events[k], 0));
    }
}

void scree_cuda_wait(scree_device *device)
{
    scree_cuda_join(device);
    if (device->error != cudaSuccess) return;
    scree_cuda_note(device, cudaStreamSynchronize(device->stream));
}

void scree_cuda_write(scree_device *device, void *to, const void *from, size_t num_bytes)
{
    scree_cuda_send(device, to, from, num_bytes);
    scree_cuda_wait(device);
}

void scree_cuda_read(scree_device *device, void *to, const void *from, size_t num_bytes)
{
    scree_cuda_fetch(device, to, from, num_bytes);
    scree_cuda_wait(device);
}

void scree_cuda_copy(scree_device *device, void *to, const void *from, size_t num_bytes)
{
    if (device->error != cudaSuccess) return;
    scree_cuda_note(device, cudaMemcpyAsync(to, from, num_bytes, cudaMemcpyDeviceToDevice, device->stream));
}

void scree_cuda_zero(scree_device *device, void *memory, size_t num_bytes)
{
    if (device->error != cudaSuccess) return;
    scree_cuda_note(device, cudaMemsetAsync(memory, 0, num_bytes, device->stream));
}

void *scree_cuda_alloc_host(size_t num_bytes)
{
    void *memory = NULL;
    if (cudaMallocHost(&memory, num_bytes) != cudaSuccess)
    {
        cudaGetLastError(); // told by the NULL that the caller gets
        return NULL;
    }
    memset(memory, 0, num_bytes);
    return memory;
}

void scree_cuda_free_host(scree_device *device, void *memory) { scree_cuda_note(device, cudaFreeHost(memory)); }

// ---- recordings: CUDA graphs

bool scree_cuda_records(const scree_device *device) { return device->records && device->error == cudaSuccess; }

void scree_cuda_record(scree_device *device, const scree_live *live)
{
    // relaxed, for a kernel may be loaded at its first launch
    scree_cuda_note(device, cudaStreamBeginCapture(device->stream, cudaStreamCaptureModeRelaxed));
    device->live = live;
}

/// The calls of a graph in place of those of *recording: what is ready to be launched is changed if it can be.
static bool renew(cudaGraphExec_t *ready, cudaGraph_t graph)
{
    cudaGraphExecUpdateResultInfo info;
    if (*ready != NULL && cudaGraphExecUpdate(*ready, graph, &info) == cudaSuccess) return true;
    if (*ready != NULL) cudaGraphExecDestroy(*ready);
    *ready = NULL;
    cudaGetLastError(); // of the update
    return cudaGraphInstantiate(ready, graph, 0) == cudaSuccess;
}

bool scree_cuda_end_record(scree_device *device, scree_recording **recording)
{
    scree_cuda_join(device);
    cudaGraph_t graph = NULL;
    cudaGraphExec_t ready = (cudaGraphExec_t)*recording;
    const bool is_kept = cudaStreamEndCapture(device->stream, &graph) == cudaSuccess && device->error == cudaSuccess;
    const bool is_done = is_kept && renew(&ready, graph);
    if (graph != NULL) cudaGraphDestroy(graph);
    device->live = NULL;
    if (!is_done)
    {
        // nothing has been done yet, so nothing is lost: all goes on call by call
        if (ready != NULL) cudaGraphExecDestroy(ready);
        ready = NULL;
        cudaGetLastError();
        device->error = cudaSuccess;
        device->records = false;
    }
    *recording = (scree_recording *)ready;
    return is_done;
}

void scree_cuda_play(scree_device *device, const scree_recording *recording)
{
    if (device->error != cudaSuccess) return;
    scree_cuda_note(device, cudaGraphLaunch((cudaGraphExec_t)recording, device->stream));
}

void scree_cuda_forget(scree_device *device, scree_recording *recording)
{
    scree_cuda_note(device, cudaGraphExecDestroy((cudaGraphExec_t)recording));
}
