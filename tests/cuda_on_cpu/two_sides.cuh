/// \file two_sides.cuh
/// For tests that run the same kernels twice, over arrays of the host and over arrays of the device: both leave what
/// they wrote in `outcome`, to be compared byte for byte.
#ifndef CUDA_ON_CPU_TWO_SIDES_CUH
#define CUDA_ON_CPU_TWO_SIDES_CUH

extern "C"
{
#include "core/device_cuda.h"
}
#include "device_array.cuh"

#include <cstring>
#include <memory>

/// One side: its arrays, and the bytes that came of it.
struct side
{
    const bool is_device;
    scree_device *device = nullptr; ///< for launches; the arrays are taken one by one, without an arena
    std::vector<unsigned char> outcome;

    explicit side(bool is_device_, int32_t block = 0) : is_device(is_device_)
    {
        scree_device_def def = scree_default_device_def();
        def.block = block;
        def.arena_bytes = 0;
        if (is_device && scree_cuda_open(&device, &def, nullptr) != SCREE_OK) std::exit(EXIT_FAILURE);
    }
    side(const side &) = delete;
    side &operator=(const side &) = delete;
    ~side()
    {
        if (is_device) SCREE_CHECK_INT(scree_cuda_status(device, nullptr), SCREE_OK);
        if (is_device) scree_cuda_close(device);
        for (void *array : arrays) is_device ? (void)cudaFree(array) : std::free(array);
    }

    /// Room for num items, full of 0xff.
    template <class T> T *make(int64_t num)
    {
        const size_t num_bytes = (static_cast<size_t>(num) + 1) * sizeof(T);
        void *array = nullptr;
        if (is_device) MUST_CUDA(cudaMalloc(&array, num_bytes));
        else
        {
            array = std::malloc(num_bytes);
            std::memset(array, 0xff, num_bytes);
        }
        arrays.push_back(array);
        return static_cast<T *>(array);
    }
    template <class T> T *zeros(int64_t num)
    {
        T *array = make<T>(num);
        if (is_device) MUST_CUDA(cudaMemset(array, 0, static_cast<size_t>(num) * sizeof(T)));
        else std::memset(static_cast<void *>(array), 0, static_cast<size_t>(num) * sizeof(T));
        return array;
    }
    /// NULL stays NULL.
    template <class T> T *copy(const T *values, int64_t num)
    {
        if (values == nullptr) return nullptr;
        T *array = make<T>(num);
        if (num > 0) move(array, values, num, cudaMemcpyHostToDevice);
        return array;
    }
    template <class T> std::vector<T> read(const T *array, int64_t num)
    {
        std::vector<T> values(static_cast<size_t>(num));
        if (num > 0) move(values.data(), array, num, cudaMemcpyDeviceToHost);
        return values;
    }
    /// Adds an array to the outcome.
    template <class T> void keep(const T *array, int64_t num)
    {
        const std::vector<T> values = read(array, num);
        const unsigned char *bytes = reinterpret_cast<const unsigned char *>(values.data());
        outcome.insert(outcome.end(), bytes, bytes + values.size() * sizeof(T));
    }

  private:
    std::vector<void *> arrays;
    template <class T> void move(T *to, const T *from, int64_t num, cudaMemcpyKind kind)
    {
        const size_t num_bytes = static_cast<size_t>(num) * sizeof(T);
        if (is_device) MUST_CUDA(cudaMemcpy(to, from, num_bytes, kind));
        else std::memcpy(static_cast<void *>(to), from, num_bytes);
    }
};

/// Launches a kernel where the arrays are.
#define LAUNCH_ON(where, name, args, num)                                         \
    do {                                                                          \
        if ((where).is_device) name##_launch_cuda((where).device, (args), (num)); \
        else name##_launch((args), (num));                                        \
    } while (0)

/// Runs `body(side &)` on the host and, with several block sizes, on the device: the same bytes, and some.
template <class Body> void check_two_sides(Body body)
{
    side host(false);
    body(host);
    SCREE_CHECK(!host.outcome.empty());
    for (const int32_t block : {1, 32, 50, 128})
    {
        side device(true, block);
        body(device);
        SCREE_CHECK(device.outcome == host.outcome);
    }
}

#endif
