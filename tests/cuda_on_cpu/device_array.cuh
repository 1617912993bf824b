/// \file device_array.cuh
/// For tests: arrays in device memory that go with their scope, and launches that must succeed.
#ifndef CUDA_ON_CPU_DEVICE_ARRAY_CUH
#define CUDA_ON_CPU_DEVICE_ARRAY_CUH

#include <cuda_runtime.h>

#include <cstdio>
#include <cstdlib>
#include <vector>

/// Ends the program if a call fails: a test cannot go on without.
#define MUST_CUDA(call)                                                                                 \
    do {                                                                                                \
        const cudaError_t scree_error = (call);                                                         \
        if (scree_error != cudaSuccess)                                                                 \
        {                                                                                               \
            std::printf("%s:%d: %s: %s\n", __FILE__, __LINE__, #call, cudaGetErrorString(scree_error)); \
            std::exit(EXIT_FAILURE);                                                                    \
        }                                                                                               \
    } while (0)

/// True, with a word about it, if there is no GPU to run on; the test then ends with the code of a skipped one.
inline bool is_without_device()
{
    int num_devices = 0;
    const cudaError_t error = cudaGetDeviceCount(&num_devices);
    if (error == cudaSuccess && num_devices > 0) return false;
    std::printf("skipped: %s\n", error != cudaSuccess ? cudaGetErrorString(error) : "there is no GPU");
    return true;
}
constexpr int SKIPPED = 77;

template <class T> struct device_array
{
    T *data = nullptr;
    size_t num;

    explicit device_array(size_t num_) : num(num_) { MUST_CUDA(cudaMalloc(&data, bytes(num > 0 ? num : 1))); }
    explicit device_array(const std::vector<T> &values) : device_array(values.size()) { write(values.data()); }
    device_array(const T *values, size_t num_) : device_array(num_) { write(values); }
    device_array(const device_array &) = delete;
    device_array &operator=(const device_array &) = delete;
    ~device_array() { cudaFree(data); }

    static size_t bytes(size_t num) { return num * sizeof(T); }
    void write(const T *values) { MUST_CUDA(cudaMemcpy(data, values, bytes(num), cudaMemcpyHostToDevice)); }
    void fill(int byte) { MUST_CUDA(cudaMemset(data, byte, bytes(num))); }
    std::vector<T> read() const
    {
        std::vector<T> values(num);
        MUST_CUDA(cudaMemcpy(values.data(), data, bytes(num), cudaMemcpyDeviceToHost));
        return values;
    }
};

template <class... Parameters, class... Arguments>
cudaError_t start_kernel(void (*kernel)(Parameters...), unsigned grid, unsigned block, Arguments... arguments)
{
    cudaLaunchConfig_t config = {};
    config.gridDim = dim3(grid);
    config.blockDim = dim3(block);
    return cudaLaunchKernelEx(&config, kernel, static_cast<Parameters>(arguments)...);
}

#endif
