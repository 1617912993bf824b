// Faulty kernels and faulty hosts: each must be noticed by the builds that can, and the sound ones by none. Without
// arguments the program runs itself once per case and looks at how that ended; with one it is that case.
#include "device_array.cuh"
#include "harness.h"

#include <cub/device/device_scan.cuh>

#include <string>
#include <sys/wait.h>
#include <unistd.h>

#if defined(CUDA_ON_CPU_ADDRESS)
#define THIS_BUILD ADDRESS
#elif defined(CUDA_ON_CPU_RACES)
#define THIS_BUILD RACES
#else
#define THIS_BUILD PLAIN
#endif

enum
{
    PLAIN = 1,
    ADDRESS = 2,
    RACES = 4,
    ALL = PLAIN | ADDRESS | RACES
};
constexpr int BLOCK = 128;

__global__ void swap_ends(int *values, bool is_sound)
{
    __shared__ int shared[BLOCK];
    shared[threadIdx.x] = values[threadIdx.x];
    if (is_sound) __syncthreads();
    values[threadIdx.x] = shared[BLOCK - 1 - threadIdx.x];
}

__global__ void swap_neighbours(int *values, bool is_sound)
{
    __shared__ int shared[32];
    shared[threadIdx.x] = values[threadIdx.x];
    if (is_sound) __syncwarp();
    values[threadIdx.x] = shared[threadIdx.x ^ 1];
}

__global__ void meet_at_two_places(int *values)
{
    if (threadIdx.x < BLOCK / 2) __syncthreads();
    else
    {
        values[threadIdx.x] = 0;
        __syncthreads();
    }
}

__global__ void return_before_barrier(int *values)
{
    if (threadIdx.x == 5) return;
    __syncthreads();
    values[threadIdx.x] = 0;
}

__global__ void read_from_outside_of_mask(int *values)
{
    if (threadIdx.x < 16) values[threadIdx.x] = __shfl_sync(0xffffu, values[threadIdx.x], 20);
}

__global__ void wait_for_lanes_that_are_elsewhere(int *values)
{
    if (threadIdx.x < 16) values[threadIdx.x] = __shfl_xor_sync(0xffffffffu, values[threadIdx.x], 1);
    __syncthreads();
}

__global__ void write_at(int *values, int at)
{
    if (threadIdx.x == 0) values[at] = 1;
}

__global__ void write_beyond_shared(int *values)
{
    __shared__ int shared[BLOCK];
    volatile int *first = shared;
    first[threadIdx.x + 1] = 1;
    __syncthreads();
    values[threadIdx.x] = first[threadIdx.x];
}

/// Blocks add to one number, with an atomic or without.
__global__ void add_from_blocks(int *sum, bool is_sound)
{
    if (threadIdx.x != 0) return;
    if (is_sound) atomicAdd(sum, 1);
    else *sum += 1;
}

/// The block that comes second reads what the first one wrote, which takes a fence on either side.
__global__ void hand_over(int *values, int *arrivals, bool is_sound)
{
    if (threadIdx.x != 0) return;
    values[blockIdx.x] = 1;
    if (is_sound) __threadfence();
    if (atomicAdd(arrivals, 1) == 0) return;
    if (is_sound) __threadfence();
    values[2] = values[0] + values[1];
}

struct arguments_with_address
{
    int num;
    int *values;
};
__global__ void write_through(arguments_with_address arguments) { arguments.values[threadIdx.x] = 1; }

template <class... Parameters, class... Arguments>
static void run_kernel(void (*kernel)(Parameters...), unsigned grid, unsigned block, Arguments... arguments)
{
    device_array<int> values(BLOCK);
    values.fill(0);
    MUST_CUDA(start_kernel(kernel, grid, block, values.data, arguments...));
    MUST_CUDA(cudaDeviceSynchronize());
}

static void run_hand_over(bool is_sound)
{
    device_array<int> values(3), arrivals(1);
    arrivals.fill(0);
    MUST_CUDA(start_kernel(hand_over, 2, BLOCK, values.data, arrivals.data, is_sound));
    MUST_CUDA(cudaDeviceSynchronize());
}

/// One stream reads what another writes; `is_sound`: after it. The same captured and played.
static void read_in_another_stream(bool is_sound, bool is_captured)
{
    const device_array<int> values(BLOCK);
    cudaStream_t stream[2];
    cudaEvent_t event[2];
    for (int k = 0; k < 2; ++k)
    {
        MUST_CUDA(cudaStreamCreate(stream + k));
        MUST_CUDA(cudaEventCreateWithFlags(event + k, cudaEventDisableTiming));
    }
    if (is_captured) MUST_CUDA(cudaStreamBeginCapture(stream[0], cudaStreamCaptureModeThreadLocal));
    MUST_CUDA(cudaEventRecord(event[0], stream[0]));
    MUST_CUDA(cudaStreamWaitEvent(stream[1], event[0]));
    cudaLaunchConfig_t config = {};
    config.gridDim = dim3(1);
    config.blockDim = dim3(BLOCK);
    config.stream = stream[1];
    MUST_CUDA(cudaLaunchKernelEx(&config, swap_ends, values.data, true));
    config.stream = stream[0];
    if (!is_sound) MUST_CUDA(cudaLaunchKernelEx(&config, swap_ends, values.data, true));
    MUST_CUDA(cudaEventRecord(event[1], stream[1]));
    MUST_CUDA(cudaStreamWaitEvent(stream[0], event[1]));
    MUST_CUDA(cudaLaunchKernelEx(&config, swap_ends, values.data, true));
    if (is_captured)
    {
        cudaGraph_t graph;
        cudaGraphExec_t made;
        MUST_CUDA(cudaStreamEndCapture(stream[0], &graph));
        MUST_CUDA(cudaGraphInstantiate(&made, graph, 0));
        MUST_CUDA(cudaGraphLaunch(made, stream[0]));
        MUST_CUDA(cudaDeviceSynchronize());
        MUST_CUDA(cudaGraphExecDestroy(made));
        MUST_CUDA(cudaGraphDestroy(graph));
    }
    MUST_CUDA(cudaDeviceSynchronize());
    for (int k = 0; k < 2; ++k)
    {
        MUST_CUDA(cudaEventDestroy(event[k]));
        MUST_CUDA(cudaStreamDestroy(stream[k]));
    }
}

static void give_host_address()
{
    std::vector<int> values(BLOCK);
    const arguments_with_address arguments = {BLOCK, values.data()};
    MUST_CUDA(start_kernel(write_through, 1, BLOCK, arguments));
}

static void copy_host_address()
{
    std::vector<int> values(BLOCK);
    const std::vector<arguments_with_address> arguments = {{BLOCK, values.data()}};
    const device_array<arguments_with_address> copy(arguments);
}

static void read_on_host()
{
    const device_array<int> values(BLOCK);
    std::printf("%d\n", *const_cast<volatile int *>(values.data));
}

static void copy_the_wrong_way()
{
    const device_array<int> values(BLOCK);
    int here[BLOCK] = {0};
    MUST_CUDA(cudaMemcpy(values.data, here, sizeof here, cudaMemcpyDeviceToHost));
}

static void use_after_free()
{
    int *data;
    MUST_CUDA(cudaMalloc(&data, BLOCK * sizeof *data));
    MUST_CUDA(cudaFree(data));
    MUST_CUDA(start_kernel(write_at, 1, 1, data, 0));
    MUST_CUDA(cudaDeviceSynchronize());
}

static void free_twice()
{
    int *data;
    MUST_CUDA(cudaMalloc(&data, BLOCK * sizeof *data));
    MUST_CUDA(cudaFree(data));
    MUST_CUDA(cudaFree(data));
}

static void give_too_little_scratch()
{
    const device_array<int> values(BLOCK), sums(BLOCK);
    size_t num_bytes = 0;
    MUST_CUDA(cub::DeviceScan::ExclusiveSum(nullptr, num_bytes, values.data, sums.data, BLOCK));
    const device_array<char> scratch(num_bytes);
    num_bytes /= 2;
    MUST_CUDA(cub::DeviceScan::ExclusiveSum(scratch.data, num_bytes, values.data, sums.data, BLOCK));
}

struct bug_case
{
    const char *name;
    void (*run)();
    int noticed_by;   ///< builds
    const char *text; ///< that stands in its output; by the sanitizer: its own
};

static const char *const by_sanitizer = "";

static const bug_case cases[] = {
    {"barrier", [] { run_kernel(swap_ends, 1, BLOCK, true); }, 0, nullptr},
    {"no barrier", [] { run_kernel(swap_ends, 1, BLOCK, false); }, RACES, by_sanitizer},
    {"warp barrier", [] { run_kernel(swap_neighbours, 1, 32, true); }, 0, nullptr},
    {"no warp barrier", [] { run_kernel(swap_neighbours, 1, 32, false); }, RACES, by_sanitizer},
    {"two barriers", [] { run_kernel(meet_at_two_places, 1, BLOCK); }, ALL, "different __syncthreads"},
    {"return before a barrier", [] { run_kernel(return_before_barrier, 1, BLOCK); }, ALL, "__syncthreads"},
    {"lane outside of the mask", [] { run_kernel(read_from_outside_of_mask, 1, 32); }, ALL, "not in the mask"},
    {"lanes that are elsewhere", [] { run_kernel(wait_for_lanes_that_are_elsewhere, 1, 32); }, ALL, "deadlock"},
    {"last element", [] { run_kernel(write_at, 1, 1, BLOCK - 1); }, 0, nullptr},
    {"one behind the end", [] { run_kernel(write_at, 1, 1, BLOCK); }, PLAIN | ADDRESS, by_sanitizer},
    {"one before the start", [] { run_kernel(write_at, 1, 1, -1); }, ADDRESS, by_sanitizer},
    {"behind shared memory", [] { run_kernel(write_beyond_shared, 1, BLOCK); }, ADDRESS, "insufficient space"},
    {"atomic sum", [] { run_kernel(add_from_blocks, 8, 32, true); }, 0, nullptr},
    {"sum without atomics", [] { run_kernel(add_from_blocks, 8, 32, false); }, RACES, by_sanitizer},
    {"fences", [] { run_hand_over(true); }, 0, nullptr},
    {"no fences", [] { run_hand_over(false); }, RACES, by_sanitizer},
    {"streams with a wait", [] { read_in_another_stream(true, false); }, 0, nullptr},
    {"streams without a wait", [] { read_in_another_stream(false, false); }, RACES, by_sanitizer},
    {"branches with a wait", [] { read_in_another_stream(true, true); }, 0, nullptr},
    {"branches without a wait", [] { read_in_another_stream(false, true); }, RACES, by_sanitizer},
    {"host address in an argument", give_host_address, PLAIN, "host address"},
    {"host address in a copy", copy_host_address, PLAIN, "host address"},
    {"read on the host", read_on_host, PLAIN | ADDRESS, by_sanitizer},
    {"copy the wrong way", copy_the_wrong_way, ALL, "a copy of kind"},
    {"use after free", use_after_free, PLAIN | ADDRESS, by_sanitizer},
    {"free twice", free_twice, ALL, "not an allocation"},
    {"too little scratch", give_too_little_scratch, ALL, "scratch memory"},
};
constexpr int NUM_CASES = sizeof cases / sizeof cases[0];

/// Runs one case in a process of its own; its output goes to *text. True if it ended well.
static bool run_case(const char *program, int number, std::string *text)
{
    const std::string command = std::string("'") + program + "' " + std::to_string(number) + " 2>&1";
    FILE *pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return false;
    char buffer[4096];
    size_t num;
    while ((num = fread(buffer, 1, sizeof buffer, pipe)) > 0) text->append(buffer, num);
    const int status = pclose(pipe);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

int main(int argc, char **argv)
{
    if (argc > 1)
    {
        cases[atoi(argv[1])].run();
        return 0;
    }
    const char *sanitizer = THIS_BUILD == ADDRESS ? "AddressSanitizer" : THIS_BUILD == RACES ? "data race" : "";
    for (int k = 0; k < NUM_CASES; ++k)
    {
        const bug_case &bug = cases[k];
        std::string text;
        const bool ended_well = run_case(argv[0], k, &text);
        const bool is_noticeable = (bug.noticed_by & THIS_BUILD) != 0;
        std::printf("%s: %s\n", bug.name, ended_well ? "nothing noticed" : "noticed");
        if (bug.noticed_by == 0 || is_noticeable) SCREE_CHECK(ended_well == !is_noticeable);
        if (is_noticeable) SCREE_CHECK_CONTAINS(text.c_str(), bug.text == by_sanitizer ? sanitizer : bug.text);
        else if (bug.noticed_by == 0 && !ended_well) std::printf("%s\n", text.c_str());
    }
    return SCREE_TEST_END();
}
