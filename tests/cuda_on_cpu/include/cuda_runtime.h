/// \file cuda_runtime.h
/// Stands in for CUDA's header of this name, so that a C++ compiler takes a .cu file for the CPU. Included before
/// anything else (-include cuda_runtime.h), as nvcc does. See README.md for what it covers.
#ifndef CUDA_ON_CPU_CUDA_RUNTIME_H
#define CUDA_ON_CPU_CUDA_RUNTIME_H

#include <cmath>
#include <tuple>
#include <utility>

#include "emulator.h"

// ---- the language

#define __global__
#define __device__
#define __host__
#define __forceinline__ inline
#define __launch_bounds__(...)
/// One block at a time runs on a thread of the operating system, so this is per block. It is not cleared between them.
#define __shared__ static thread_local

namespace cuda_on_cpu
{
/// One coordinate of what the present thread knows about itself.
template <class Vector, Vector thread_state::*vector, unsigned Vector::*coordinate> struct own_coordinate
{
    operator unsigned() const { return (current->*vector).*coordinate; }
};
template <class Vector, Vector thread_state::*vector> struct own_vector
{
    own_coordinate<Vector, vector, &Vector::x> x;
    own_coordinate<Vector, vector, &Vector::y> y;
    own_coordinate<Vector, vector, &Vector::z> z;
};
} // namespace cuda_on_cpu
constexpr cuda_on_cpu::own_vector<uint3, &cuda_on_cpu::thread_state::thread> threadIdx = {};
constexpr cuda_on_cpu::own_vector<uint3, &cuda_on_cpu::thread_state::block> blockIdx = {};
constexpr cuda_on_cpu::own_vector<dim3, &cuda_on_cpu::thread_state::block_size> blockDim = {};
constexpr cuda_on_cpu::own_vector<dim3, &cuda_on_cpu::thread_state::grid_size> gridDim = {};
constexpr int warpSize = 32;

/// `extern __shared__ T name[]` of nvcc.
#define CUDA_ON_CPU_DYNAMIC_SHARED(T, name) T *name = static_cast<T *>(::cuda_on_cpu::dynamic_shared())

inline void __syncthreads(CUDA_ON_CPU_PLACE) { cuda_on_cpu::meet_block(false, CUDA_ON_CPU_SAME_PLACE); }
inline int __syncthreads_count(int predicate, CUDA_ON_CPU_PLACE)
{
    return cuda_on_cpu::meet_block(predicate != 0, CUDA_ON_CPU_SAME_PLACE);
}
inline int __syncthreads_or(int predicate, CUDA_ON_CPU_PLACE)
{
    return cuda_on_cpu::meet_block(predicate != 0, CUDA_ON_CPU_SAME_PLACE) > 0;
}

inline void __syncwarp(unsigned mask = 0xffffffffu, CUDA_ON_CPU_PLACE)
{
    cuda_on_cpu::meet_warp(mask, cuda_on_cpu::warp_operation::sync, cuda_on_cpu::lane_value{}, CUDA_ON_CPU_SAME_PLACE);
}

inline unsigned __ballot_sync(unsigned mask, int predicate, CUDA_ON_CPU_PLACE)
{
    using namespace cuda_on_cpu;
    const warp_meeting_result met =
        meet_warp(mask, warp_operation::ballot, pack(predicate != 0), CUDA_ON_CPU_SAME_PLACE);
    unsigned votes = 0;
    for (unsigned lane = 0; lane < 32; ++lane)
        if (met.lanes >> lane & 1 && unpack<bool>(met.values[lane])) votes |= 1u << lane;
    return votes;
}
inline int __any_sync(unsigned mask, int predicate, CUDA_ON_CPU_PLACE)
{
    return __ballot_sync(mask, predicate, CUDA_ON_CPU_SAME_PLACE) != 0;
}
inline int __all_sync(unsigned mask, int predicate, CUDA_ON_CPU_PLACE)
{
    return __ballot_sync(mask, !predicate, CUDA_ON_CPU_SAME_PLACE) == 0;
}

namespace cuda_on_cpu
{
/// The value of lane `from`, or the own one if `from` lies outside of the lane's group of `width`.
template <class T> T shuffle(unsigned mask, T value, int from, int width, const char *file, int line)
{
    const int lane = static_cast<int>(current->lane), first = lane & ~(width - 1);
    const warp_meeting_result met = meet_warp(mask, warp_operation::shuffle, pack(value), CUDA_ON_CPU_SAME_PLACE);
    if (from < first || from >= first + width) return value;
    if ((met.lanes >> from & 1) == 0)
        fail("lane %d reads from lane %d, which is not in the mask %08x or has returned, at %s:%d", lane, from, mask,
             file, line);
    return unpack<T>(met.values[from]);
}
} // namespace cuda_on_cpu

template <class T> T __shfl_sync(unsigned mask, T value, int from, int width = 32, CUDA_ON_CPU_PLACE)
{
    const int first = static_cast<int>(cuda_on_cpu::current->lane) & ~(width - 1);
    return cuda_on_cpu::shuffle(mask, value, first + (from & (width - 1)), width, CUDA_ON_CPU_SAME_PLACE);
}
template <class T> T __shfl_up_sync(unsigned mask, T value, unsigned by, int width = 32, CUDA_ON_CPU_PLACE)
{
    return cuda_on_cpu::shuffle(mask, value, static_cast<int>(cuda_on_cpu::current->lane) - static_cast<int>(by), width,
                                CUDA_ON_CPU_SAME_PLACE);
}
template <class T> T __shfl_down_sync(unsigned mask, T value, unsigned by, int width = 32, CUDA_ON_CPU_PLACE)
{
    return cuda_on_cpu::shuffle(mask, value, static_cast<int>(cuda_on_cpu::current->lane + by), width,
                                CUDA_ON_CPU_SAME_PLACE);
}
template <class T> T __shfl_xor_sync(unsigned mask, T value, int with, int width = 32, CUDA_ON_CPU_PLACE)
{
    return cuda_on_cpu::shuffle(mask, value, static_cast<int>(cuda_on_cpu::current->lane) ^ with, width,
                                CUDA_ON_CPU_SAME_PLACE);
}

inline void __threadfence() { cuda_on_cpu::fence(); }
inline void __threadfence_block() { cuda_on_cpu::fence(); }

namespace cuda_on_cpu
{
/// Atomics order nothing but themselves, as on the device; after a fence of the same thread they release what was
/// written before it.
template <class T> bool exchange(T *address, T *expected, T value, bool is_release)
{
    static_assert(std::is_integral<T>::value, "atomics are for integers: sums of floats would depend on the order");
    return is_release
               ? __atomic_compare_exchange_n(address, expected, value, false, __ATOMIC_RELEASE, __ATOMIC_RELAXED)
               : __atomic_compare_exchange_n(address, expected, value, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED);
}
} // namespace cuda_on_cpu

#define CUDA_ON_CPU_ATOMIC(name, expression)                                                  \
    template <class T> T name(T *address, typename std::common_type<T>::type value)           \
    {                                                                                         \
        const bool is_release = cuda_on_cpu::note_atomic(address);                            \
        T old = __atomic_load_n(address, __ATOMIC_RELAXED);                                   \
        while (!cuda_on_cpu::exchange(address, &old, static_cast<T>(expression), is_release)) \
        {                                                                                     \
        }                                                                                     \
        return old;                                                                           \
    }
CUDA_ON_CPU_ATOMIC(atomicAdd, old + value)
CUDA_ON_CPU_ATOMIC(atomicMin, value < old ? value : old)
CUDA_ON_CPU_ATOMIC(atomicMax, value > old ? value : old)
CUDA_ON_CPU_ATOMIC(atomicOr, old | value)
CUDA_ON_CPU_ATOMIC(atomicExch, value)

template <class T> T atomicCAS(T *address, typename std::common_type<T>::type expected, T value)
{
    T old = expected;
    cuda_on_cpu::exchange(address, &old, value, cuda_on_cpu::note_atomic(address));
    return old;
}

/// A read past the nearest cache; others may write there atomically.
template <class T> T __ldcg(const T *address) { return __atomic_load_n(address, __ATOMIC_RELAXED); }
inline long long __double_as_longlong(double x)
{
    long long bits;
    std::memcpy(&bits, &x, sizeof bits);
    return bits;
}
inline double __longlong_as_double(long long bits)
{
    double x;
    std::memcpy(&x, &bits, sizeof x);
    return x;
}
inline int __ffsll(long long x) { return __builtin_ffsll(x); }
inline int __clzll(long long x) { return x == 0 ? 64 : __builtin_clzll(static_cast<unsigned long long>(x)); }
inline int __popc(unsigned x) { return __builtin_popcount(x); }
inline int __popcll(unsigned long long x) { return __builtin_popcountll(x); }

// ---- the runtime

/// Codes as in CUDA.
enum cudaError_t
{
    cudaSuccess = 0,
    cudaErrorInvalidValue = 1,
    cudaErrorMemoryAllocation = 2,
    cudaErrorInvalidConfiguration = 9,
    cudaErrorInsufficientDriver = 35,
    cudaErrorInvalidDeviceFunction = 98,
    cudaErrorNoDevice = 100,
    cudaErrorNoKernelImageForDevice = 209,
    cudaErrorIllegalState = 401,
    cudaErrorIllegalAddress = 700,
    cudaErrorStreamCaptureUnsupported = 900,
    cudaErrorStreamCaptureInvalidated = 901,
    cudaErrorStreamCaptureUnmatched = 903,
    cudaErrorStreamCaptureUnjoined = 904,
    cudaErrorStreamCaptureIsolation = 905,
    cudaErrorStreamCaptureImplicit = 906,
    cudaErrorCapturedEvent = 907,
    cudaErrorGraphExecUpdateFailure = 910
};
enum cudaMemcpyKind
{
    cudaMemcpyHostToHost,
    cudaMemcpyHostToDevice,
    cudaMemcpyDeviceToHost,
    cudaMemcpyDeviceToDevice
};
enum cudaStreamCaptureMode
{
    cudaStreamCaptureModeGlobal,
    cudaStreamCaptureModeThreadLocal,
    cudaStreamCaptureModeRelaxed
};
typedef struct cuda_on_cpu_graph *cudaGraph_t;
typedef struct cuda_on_cpu_graph *cudaGraphExec_t;
enum cudaGraphExecUpdateResult
{
    cudaGraphExecUpdateSuccess,
    cudaGraphExecUpdateError,
    cudaGraphExecUpdateErrorTopologyChanged
};
struct cudaGraphExecUpdateResultInfo
{
    cudaGraphExecUpdateResult result;
};

struct cudaDeviceProp
{
    char name[256];
    size_t totalGlobalMem;
    int major, minor;
    int multiProcessorCount;
    int warpSize;
};

struct cudaFuncAttributes
{
    int binaryVersion; ///< the only one there is
};

struct cudaLaunchConfig_t
{
    dim3 gridDim, blockDim;
    size_t dynamicSmemBytes;
    cudaStream_t stream;
};

cudaError_t cudaGetLastError();
cudaError_t cudaPeekAtLastError();
const char *cudaGetErrorString(cudaError_t error);

cudaError_t cudaDriverGetVersion(int *version);
cudaError_t cudaRuntimeGetVersion(int *version);
cudaError_t cudaGetDeviceCount(int *num_devices);
cudaError_t cudaSetDevice(int device);
cudaError_t cudaGetDeviceProperties(cudaDeviceProp *properties, int device);
cudaError_t cudaFuncGetAttributes(cudaFuncAttributes *attributes, const void *kernel);
cudaError_t cudaDeviceSynchronize();
cudaError_t cudaStreamCreate(cudaStream_t *stream);
cudaError_t cudaStreamDestroy(cudaStream_t stream);
cudaError_t cudaStreamSynchronize(cudaStream_t stream);

constexpr unsigned cudaEventDisableTiming = 2;
cudaError_t cudaEventCreateWithFlags(cudaEvent_t *event, unsigned flags);
cudaError_t cudaEventDestroy(cudaEvent_t event);
cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream);
cudaError_t cudaStreamWaitEvent(cudaStream_t stream, cudaEvent_t event, unsigned flags = 0);

cudaError_t cudaMalloc(void **address, size_t num_bytes);
template <class T> cudaError_t cudaMalloc(T **address, size_t num_bytes)
{
    return cudaMalloc(reinterpret_cast<void **>(address), num_bytes);
}
cudaError_t cudaFree(void *address);
cudaError_t cudaMallocHost(void **address, size_t num_bytes);
cudaError_t cudaFreeHost(void *address);
cudaError_t cudaMemGetInfo(size_t *num_free, size_t *num_total);
cudaError_t cudaMemcpy(void *to, const void *from, size_t num_bytes, cudaMemcpyKind kind);
cudaError_t cudaMemcpyAsync(void *to, const void *from, size_t num_bytes, cudaMemcpyKind kind, cudaStream_t stream);
cudaError_t cudaMemset(void *address, int value, size_t num_bytes);
cudaError_t cudaMemsetAsync(void *address, int value, size_t num_bytes, cudaStream_t stream);

cudaError_t cudaStreamBeginCapture(cudaStream_t stream, cudaStreamCaptureMode mode);
cudaError_t cudaStreamEndCapture(cudaStream_t stream, cudaGraph_t *graph);
cudaError_t cudaGraphInstantiate(cudaGraphExec_t *made, cudaGraph_t graph, unsigned long long flags = 0);
cudaError_t cudaGraphExecUpdate(cudaGraphExec_t made, cudaGraph_t graph, cudaGraphExecUpdateResultInfo *info);
cudaError_t cudaGraphLaunch(cudaGraphExec_t made, cudaStream_t stream);
cudaError_t cudaGraphDestroy(cudaGraph_t graph);
cudaError_t cudaGraphExecDestroy(cudaGraphExec_t made);

template <class... Parameters, class... Arguments>
cudaError_t cudaLaunchKernelEx(const cudaLaunchConfig_t *config, void (*kernel)(Parameters...),
                               Arguments &&...arguments)
{
    static_assert((std::is_trivially_copyable<Parameters>::value && ...), "a kernel's parameters are copied as bytes");
    const char *name = cuda_on_cpu::name_of(reinterpret_cast<const void *>(kernel));
    std::tuple<Parameters...> copies(std::forward<Arguments>(arguments)...);
    std::apply(
        [name](Parameters &...copy)
        {
#if __has_builtin(__builtin_clear_padding)
            (__builtin_clear_padding(&copy), ...); // where anything may have been left
#endif
            (cuda_on_cpu::refuse_host_addresses(name, &copy, sizeof copy), ...);
        },
        copies);
    const cuda_on_cpu::launch_shape shape = {config->gridDim, config->blockDim, config->dynamicSmemBytes};
    return static_cast<cudaError_t>(cuda_on_cpu::launch(
        name, shape, [kernel, copies] { std::apply(kernel, copies); }, config->stream));
}

/// For tests of what only the emulation promises.
#define CUDA_ON_CPU 1

// from here on the sources see a device of compute capability 8.0
#define __CUDACC__ 1
#define __CUDA_ARCH__ 800

#endif
