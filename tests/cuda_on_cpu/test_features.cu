// The stand-in does what CUDA does, and so does a GPU: barriers, warps, tiles, atomics with fences, the queue, CUB's
// sort and sums.
#include "device_array.cuh"
#include "harness.h"

#include <cooperative_groups.h>
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>

#include <algorithm>
#include <numeric>
#include <string>

constexpr int BLOCK = 128;
constexpr int NUM = 1000; ///< not a multiple of a block, nor of a warp

static unsigned num_blocks(unsigned num) { return (num + BLOCK - 1) / BLOCK; }

static std::vector<int> made_numbers()
{
    std::vector<int> numbers(NUM);
    for (int i = 0; i < NUM; ++i) numbers[static_cast<size_t>(i)] = i * 37 % 101 - 50;
    return numbers;
}

__global__ void sum_block(const int *in, int *out, int num)
{
    __shared__ int shared[BLOCK];
    const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
    shared[threadIdx.x] = i < num ? in[i] : 0;
    __syncthreads();
    for (unsigned half = blockDim.x / 2; half > 0; half /= 2)
    {
        if (threadIdx.x < half) shared[threadIdx.x] += shared[threadIdx.x + half];
        __syncthreads();
    }
    if (threadIdx.x == 0) out[blockIdx.x] = shared[0];
}

static void test_block_sums()
{
    const std::vector<int> numbers = made_numbers();
    const device_array<int> in(numbers), out(num_blocks(NUM));
    MUST_CUDA(start_kernel(sum_block, num_blocks(NUM), BLOCK, in.data, out.data, NUM));
    const std::vector<int> sums = out.read();
    SCREE_CHECK_INT(std::accumulate(sums.begin(), sums.end(), 0), std::accumulate(numbers.begin(), numbers.end(), 0));
    SCREE_CHECK_INT(sums[1], std::accumulate(numbers.begin() + BLOCK, numbers.begin() + 2 * BLOCK, 0));
}

template <unsigned Size> __global__ void sum_tile(const int *in, int *out, int num)
{
    namespace groups = cooperative_groups;
    const groups::thread_block_tile<Size> tile = groups::tiled_partition<Size>(groups::this_thread_block());
    const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
    int sum = i < num ? in[i] : 0;
    for (int with = Size / 2; with > 0; with /= 2) sum += tile.shfl_xor(sum, with);
    const unsigned positive = tile.ballot(i < num && in[i] > 0);
    if (tile.thread_rank() != 0) return;
    out[2 * (i / static_cast<int>(Size))] = sum;
    out[2 * (i / static_cast<int>(Size)) + 1] = __popc(positive);
}

template <unsigned Size> static void check_tiles()
{
    const std::vector<int> numbers = made_numbers();
    const device_array<int> in(numbers), out(2 * num_blocks(NUM) * BLOCK / Size);
    MUST_CUDA(start_kernel(sum_tile<Size>, num_blocks(NUM), BLOCK, in.data, out.data, NUM));
    const std::vector<int> sums = out.read();
    for (size_t t = 0; t < sums.size() / 2; ++t)
    {
        int sum = 0, num_positive = 0;
        for (size_t i = t * Size; i < (t + 1) * Size && i < NUM; ++i)
        {
            sum += numbers[i];
            num_positive += numbers[i] > 0;
        }
        SCREE_CHECK_INT(sums[2 * t], sum);
        SCREE_CHECK_INT(sums[2 * t + 1], num_positive);
    }
}

static void test_tiles()
{
    check_tiles<1>();
    check_tiles<8>();
    check_tiles<16>();
    check_tiles<32>();
}

/// Each lane gets the value of the lane before it; a short last warp has fewer lanes.
__global__ void shift_lanes(int *out)
{
    const int value = static_cast<int>(threadIdx.x);
    out[threadIdx.x] = __shfl_up_sync(0xffffffffu, value, 1);
}

static void test_short_warp()
{
    const device_array<int> out(45);
    MUST_CUDA(start_kernel(shift_lanes, 1, 45, out.data));
    const std::vector<int> shifted = out.read();
    for (int i = 0; i < 45; ++i) SCREE_CHECK_INT(shifted[static_cast<size_t>(i)], i % 32 == 0 ? i : i - 1);
}

/// The second child to arrive at a parent adds up the children, as in a tree that is built from the leaves upwards.
__global__ void sum_upwards(const int *leaves, int *nodes, unsigned *arrivals, int num_leaves)
{
    const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
    if (i >= num_leaves) return;
    int k = num_leaves - 1 + i;
    nodes[k] = leaves[i];
    while (k > 0)
    {
        k = (k - 1) / 2;
        __threadfence();
        if (atomicAdd(arrivals + k, 1u) == 0) return;
        __threadfence();
        nodes[k] = nodes[2 * k + 1] + nodes[2 * k + 2];
    }
}

static void test_arrivals()
{
    const std::vector<int> numbers = made_numbers();
    device_array<int> leaves(numbers), nodes(2 * NUM - 1);
    device_array<unsigned> arrivals(NUM);
    arrivals.fill(0);
    MUST_CUDA(start_kernel(sum_upwards, num_blocks(NUM), BLOCK, leaves.data, nodes.data, arrivals.data, NUM));
    SCREE_CHECK_INT(nodes.read()[0], std::accumulate(numbers.begin(), numbers.end(), 0));
}

#ifdef CUDA_ON_CPU
/// Every thread notes its turn.
__global__ void note_turn(int *turns, int *num_turns)
{
    const int turn = atomicAdd(num_turns, 1);
    turns[turn] = static_cast<int>(threadIdx.x);
}

static void test_schedule()
{
    device_array<int> turns(BLOCK), num_turns(1);
    num_turns.fill(0);
    MUST_CUDA(start_kernel(note_turn, 1, BLOCK, turns.data, num_turns.data));
    const std::vector<int> order = turns.read();
    std::vector<int> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    for (int i = 0; i < BLOCK; ++i) SCREE_CHECK_INT(sorted[static_cast<size_t>(i)], i);
    const char *schedule = getenv("CUDA_ON_CPU_SCHEDULE");
    const std::string name = schedule != nullptr ? schedule : "fifo";
    SCREE_CHECK(std::is_sorted(order.begin(), order.end()) == (name == "fifo"));
    SCREE_CHECK(std::is_sorted(order.rbegin(), order.rend()) == (name == "lifo"));
}

__global__ void reverse(int *values)
{
    CUDA_ON_CPU_DYNAMIC_SHARED(int, shared);
    shared[threadIdx.x] = values[threadIdx.x];
    __syncthreads();
    values[threadIdx.x] = shared[blockDim.x - 1 - threadIdx.x];
}

static void test_dynamic_shared()
{
    const device_array<int> values(made_numbers());
    cudaLaunchConfig_t config = {};
    config.gridDim = dim3(1);
    config.blockDim = dim3(BLOCK);
    config.dynamicSmemBytes = BLOCK * sizeof(int);
    MUST_CUDA(cudaLaunchKernelEx(&config, reverse, values.data));
    const std::vector<int> before = made_numbers(), after = values.read();
    for (size_t i = 0; i < BLOCK; ++i) SCREE_CHECK_INT(after[i], before[BLOCK - 1 - i]);
}
static void test_queue()
{
    const std::vector<int> numbers = made_numbers();
    const device_array<int> in(numbers);
    std::vector<int> out(NUM, 7);
    MUST_CUDA(cudaMemcpyAsync(out.data(), in.data, NUM * sizeof(int), cudaMemcpyDeviceToHost, nullptr));
    SCREE_CHECK_INT(out[0], 7); // nothing has come yet
    MUST_CUDA(cudaStreamSynchronize(nullptr));
    SCREE_CHECK(out == numbers);
}
#endif

__global__ void add(int *values, int num, const int *summand)
{
    const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
    if (i < num) values[i] += *summand;
}

/// The calls that the graph of test_graph is made of: out = sums before each of the values, plus a number of the host.
static void enqueue_sums(cudaStream_t stream, int *values, int num, int *summand, const int *summand_here, int *out)
{
    MUST_CUDA(cudaMemcpyAsync(summand, summand_here, sizeof *summand, cudaMemcpyHostToDevice, stream));
    size_t num_bytes = 0;
    MUST_CUDA(cub::DeviceScan::ExclusiveSum(nullptr, num_bytes, values, values, num, stream));
    static char *scratch = nullptr;
    if (scratch == nullptr) MUST_CUDA(cudaMalloc(&scratch, 1 << 16));
    num_bytes = 1 << 16;
    MUST_CUDA(cudaMemsetAsync(out, 0xff, sizeof *out * static_cast<size_t>(num), stream));
    MUST_CUDA(cub::DeviceScan::ExclusiveSum(scratch, num_bytes, values, values, num, stream));
    cudaLaunchConfig_t config = {};
    config.gridDim = dim3(num_blocks(static_cast<unsigned>(num)));
    config.blockDim = dim3(BLOCK);
    config.stream = stream;
    MUST_CUDA(cudaLaunchKernelEx(&config, add, values, num, static_cast<const int *>(summand)));
    MUST_CUDA(cudaMemcpyAsync(out, values, sizeof *out * static_cast<size_t>(num), cudaMemcpyDeviceToDevice, stream));
}

static std::vector<int> sums_of(std::vector<int> values, int summand)
{
    int sum = 0;
    for (int &value : values)
    {
        const int own = value;
        value = sum + summand;
        sum += own;
    }
    return values;
}

/// Nothing is done while calls are captured; the graph does them as often as it is launched, with what is then in
/// pinned memory; another capture of the same calls changes its arguments.
static void test_graph()
{
    const std::vector<int> numbers = made_numbers();
    const std::vector<int> few(numbers.begin(), numbers.begin() + BLOCK);
    const device_array<int> values(numbers), out(NUM), summand(1);
    int *summand_here;
    MUST_CUDA(cudaMallocHost(reinterpret_cast<void **>(&summand_here), sizeof *summand_here));
    cudaStream_t stream;
    MUST_CUDA(cudaStreamCreate(&stream));
    enqueue_sums(stream, values.data, NUM, summand.data, summand_here, out.data); // takes scratch memory
    MUST_CUDA(cudaStreamSynchronize(stream));
    MUST_CUDA(cudaMemcpy(values.data, numbers.data(), NUM * sizeof(int), cudaMemcpyHostToDevice));

    cudaGraphExec_t made = nullptr;
    for (const int num : {NUM, BLOCK})
    {
        MUST_CUDA(cudaStreamBeginCapture(stream, cudaStreamCaptureModeThreadLocal));
        enqueue_sums(stream, values.data, num, summand.data, summand_here, out.data);
        cudaGraph_t graph;
        MUST_CUDA(cudaStreamEndCapture(stream, &graph));
        if (num == NUM)
        {
            SCREE_CHECK(values.read() == numbers);
            MUST_CUDA(cudaGraphInstantiate(&made, graph, 0));
        }
        else
        {
            cudaGraphExecUpdateResultInfo info;
            MUST_CUDA(cudaGraphExecUpdate(made, graph, &info));
        }
        MUST_CUDA(cudaGraphDestroy(graph));
        std::vector<int> expected = num == NUM ? numbers : few;
        MUST_CUDA(cudaMemcpy(values.data, expected.data(), expected.size() * sizeof(int), cudaMemcpyHostToDevice));
        for (const int added : {3, -8})
        {
            expected = sums_of(expected, added);
            *summand_here = added;
            MUST_CUDA(cudaGraphLaunch(made, stream));
            MUST_CUDA(cudaStreamSynchronize(stream));
            std::vector<int> sums = out.read();
            sums.resize(static_cast<size_t>(num));
            SCREE_CHECK(sums == expected);
        }
    }
    MUST_CUDA(cudaGraphExecDestroy(made));
    MUST_CUDA(cudaStreamDestroy(stream));
    MUST_CUDA(cudaFreeHost(summand_here));
}

/// Two streams and an event for each of them.
struct two_streams
{
    cudaStream_t stream[2];
    cudaEvent_t event[2];
    two_streams()
    {
        for (int k = 0; k < 2; ++k)
        {
            MUST_CUDA(cudaStreamCreate(stream + k));
            MUST_CUDA(cudaEventCreateWithFlags(event + k, cudaEventDisableTiming));
        }
    }
    two_streams(const two_streams &) = delete;
    two_streams &operator=(const two_streams &) = delete;
    ~two_streams()
    {
        for (int k = 0; k < 2; ++k)
        {
            cudaStreamDestroy(stream[k]);
            cudaEventDestroy(event[k]);
        }
    }
    /// Stream `waits` comes after what the other one was asked for.
    void wait(int waits) const
    {
        MUST_CUDA(cudaEventRecord(event[1 - waits], stream[1 - waits]));
        MUST_CUDA(cudaStreamWaitEvent(stream[waits], event[1 - waits]));
    }
    /// Sum of two numbers and one, in a stream.
    void add_up(int k, int *sum, const int *a, const int *b) const;
};

__global__ void add_up_numbers(int *sum, const int *a, const int *b) { *sum = *a + *b + 1; }

void two_streams::add_up(int k, int *sum, const int *a, const int *b) const
{
    cudaLaunchConfig_t config = {};
    config.gridDim = dim3(1);
    config.blockDim = dim3(1);
    config.stream = stream[k];
    MUST_CUDA(cudaLaunchKernelEx(&config, add_up_numbers, sum, a, b));
}

/// x[1] and x[2] from x[0] beside each other, x[3] from both; then x[0] from x[3].
static void enqueue_diamond(const two_streams &two, int *x)
{
    two.wait(1);
    two.add_up(1, x + 2, x, x);
    two.add_up(1, x + 2, x + 2, x);
    two.add_up(0, x + 1, x, x);
    two.wait(0);
    two.add_up(0, x + 3, x + 1, x + 2);
    two.add_up(0, x, x + 3, x + 3);
}

/// What branches and joins by events comes out right in every order, called, captured and played.
static void test_branches()
{
    const two_streams two;
    const device_array<int> x(std::vector<int>{1, 0, 0, 0});
    enqueue_diamond(two, x.data);
    MUST_CUDA(cudaStreamSynchronize(two.stream[0]));
    // 3, 3 + 1 + 1, 3 + 5 + 1, 9 + 9 + 1
    SCREE_CHECK(x.read() == (std::vector<int>{19, 3, 5, 9}));

    MUST_CUDA(cudaStreamBeginCapture(two.stream[0], cudaStreamCaptureModeThreadLocal));
    enqueue_diamond(two, x.data);
    cudaGraph_t graph;
    MUST_CUDA(cudaStreamEndCapture(two.stream[0], &graph));
    SCREE_CHECK_INT(x.read()[0], 19); // nothing has been done
    cudaGraphExec_t made;
    MUST_CUDA(cudaGraphInstantiate(&made, graph, 0));
    int first = 19;
    for (int play = 0; play < 3; ++play)
    {
        MUST_CUDA(cudaGraphLaunch(made, two.stream[0]));
        first = 2 * (2 * first + 1 + 3 * first + 2 + 1) + 1;
    }
    MUST_CUDA(cudaStreamSynchronize(two.stream[0]));
    SCREE_CHECK_INT(x.read()[0], first);
    MUST_CUDA(cudaGraphExecDestroy(made));
    MUST_CUDA(cudaGraphDestroy(graph));
}

/// A branch that nobody waits for, and one that comes after what is not captured.
static void test_capture_of_branches()
{
    const two_streams two;
    const device_array<int> x(std::vector<int>{1, 0, 0, 0});
    cudaGraph_t graph;
    MUST_CUDA(cudaStreamBeginCapture(two.stream[0], cudaStreamCaptureModeThreadLocal));
    two.wait(1);
    two.add_up(1, x.data + 1, x.data, x.data);
    SCREE_CHECK_INT(cudaStreamEndCapture(two.stream[0], &graph), cudaErrorStreamCaptureUnjoined);
    SCREE_CHECK(graph == nullptr);
    cudaGetLastError();

    two.add_up(1, x.data + 1, x.data, x.data);
    MUST_CUDA(cudaEventRecord(two.event[1], two.stream[1]));
    MUST_CUDA(cudaStreamBeginCapture(two.stream[0], cudaStreamCaptureModeThreadLocal));
    SCREE_CHECK_INT(cudaStreamWaitEvent(two.stream[0], two.event[1]), cudaErrorStreamCaptureIsolation);
    SCREE_CHECK_INT(cudaStreamEndCapture(two.stream[0], &graph), cudaErrorStreamCaptureInvalidated);
    cudaGetLastError();
    MUST_CUDA(cudaDeviceSynchronize());
    SCREE_CHECK_INT(x.read()[1], 3);
}

#ifdef CUDA_ON_CPU
/// Who waits for one stream does not wait for another.
static void test_streams_apart()
{
    const two_streams two;
    int *here;
    MUST_CUDA(cudaMallocHost(reinterpret_cast<void **>(&here), 2 * sizeof *here));
    const device_array<int> x(std::vector<int>{5, 6});
    for (int k = 0; k < 2; ++k)
        MUST_CUDA(cudaMemcpyAsync(here + k, x.data + k, sizeof *here, cudaMemcpyDeviceToHost, two.stream[k]));
    MUST_CUDA(cudaStreamSynchronize(two.stream[1]));
    SCREE_CHECK(here[0] == 0 && here[1] == 6);
    MUST_CUDA(cudaStreamSynchronize(two.stream[0]));
    SCREE_CHECK_INT(here[0], 5);
    MUST_CUDA(cudaFreeHost(here));
}
#endif

/// What would wait, or change the memory there is, breaks a capture, and nothing else.
static void test_broken_capture()
{
    const device_array<int> values(made_numbers());
    cudaStream_t stream;
    MUST_CUDA(cudaStreamCreate(&stream));
    cudaGraph_t graph;
    SCREE_CHECK_INT(cudaStreamEndCapture(stream, &graph), cudaErrorIllegalState);
    SCREE_CHECK_INT(cudaStreamBeginCapture(nullptr, cudaStreamCaptureModeThreadLocal),
                    cudaErrorStreamCaptureUnsupported);
    for (int call = 0; call < 4; ++call)
    {
        MUST_CUDA(cudaStreamBeginCapture(stream, cudaStreamCaptureModeThreadLocal));
        MUST_CUDA(cudaMemsetAsync(values.data, 0, NUM * sizeof(int), stream));
        void *more = nullptr;
        cudaError_t error = cudaSuccess;
        if (call == 0) error = cudaStreamSynchronize(stream);
        if (call == 1) error = cudaMalloc(&more, 16);
        if (call == 2) error = cudaMemsetAsync(values.data, 1, sizeof(int), nullptr); // the stream without a name
        SCREE_CHECK_INT(error, call < 2    ? cudaErrorStreamCaptureUnsupported
                               : call == 2 ? cudaErrorStreamCaptureImplicit
                                           : cudaSuccess);
        SCREE_CHECK_INT(cudaStreamEndCapture(stream, &graph),
                        call < 3 ? cudaErrorStreamCaptureInvalidated : cudaSuccess);
        SCREE_CHECK((graph != nullptr) == (call == 3));
        cudaGetLastError();
    }
    MUST_CUDA(cudaGraphDestroy(graph));
    SCREE_CHECK(values.read() == made_numbers());
    MUST_CUDA(cudaStreamDestroy(stream));
}

/// A graph of other calls cannot take the place of another.
static void test_graph_of_other_calls()
{
    const device_array<int> values(made_numbers());
    cudaStream_t stream;
    MUST_CUDA(cudaStreamCreate(&stream));
    cudaGraph_t graphs[2];
    for (int k = 0; k < 2; ++k)
    {
        MUST_CUDA(cudaStreamBeginCapture(stream, cudaStreamCaptureModeThreadLocal));
        for (int call = 0; call <= k; ++call) MUST_CUDA(cudaMemsetAsync(values.data + call, 0, sizeof(int), stream));
        MUST_CUDA(cudaStreamEndCapture(stream, graphs + k));
    }
    cudaGraphExec_t made;
    MUST_CUDA(cudaGraphInstantiate(&made, graphs[0], 0));
    cudaGraphExecUpdateResultInfo info;
    SCREE_CHECK_INT(cudaGraphExecUpdate(made, graphs[1], &info), cudaErrorGraphExecUpdateFailure);
    SCREE_CHECK_INT(info.result, cudaGraphExecUpdateErrorTopologyChanged);
    cudaGetLastError();
    MUST_CUDA(cudaGraphLaunch(made, stream));
    MUST_CUDA(cudaStreamSynchronize(stream));
    std::vector<int> expected = made_numbers();
    expected[0] = 0;
    SCREE_CHECK(values.read() == expected);
    for (const cudaGraph_t graph : graphs) MUST_CUDA(cudaGraphDestroy(graph));
    MUST_CUDA(cudaGraphExecDestroy(made));
    MUST_CUDA(cudaStreamDestroy(stream));
}

static void test_refused_launch()
{
    const device_array<int> out(BLOCK);
    SCREE_CHECK_INT(start_kernel(shift_lanes, 1, 2048, out.data), cudaErrorInvalidConfiguration);
    SCREE_CHECK_INT(cudaGetLastError(), cudaErrorInvalidConfiguration);
    SCREE_CHECK_INT(cudaGetLastError(), cudaSuccess);
}

static void test_sort()
{
    std::vector<uint64_t> keys(NUM);
    std::vector<int> values(NUM), order(NUM);
    for (size_t i = 0; i < NUM; ++i)
    {
        keys[i] = i * 2654435761u % 64 << 32 | i; // the lowest 32 bits are not looked at
        values[i] = order[i] = static_cast<int>(i);
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](int i, int j)
                     { return keys[static_cast<size_t>(i)] >> 32 < keys[static_cast<size_t>(j)] >> 32; });
    const device_array<uint64_t> d_keys(keys), d_spare_keys(NUM);
    const device_array<int> d_values(values), d_spare_values(NUM);
    for (int end_bit = 40; end_bit <= 64; end_bit += 8)
    {
        cub::DoubleBuffer<uint64_t> both_keys(d_keys.data, d_spare_keys.data);
        cub::DoubleBuffer<int> both_values(d_values.data, d_spare_values.data);
        MUST_CUDA(cudaMemcpy(d_keys.data, keys.data(), NUM * sizeof(uint64_t), cudaMemcpyHostToDevice));
        MUST_CUDA(cudaMemcpy(d_values.data, values.data(), NUM * sizeof(int), cudaMemcpyHostToDevice));
        size_t num_bytes = 0;
        MUST_CUDA(cub::DeviceRadixSort::SortPairs(nullptr, num_bytes, both_keys, both_values, NUM, 32, end_bit));
        const device_array<char> scratch(num_bytes);
        MUST_CUDA(cub::DeviceRadixSort::SortPairs(scratch.data, num_bytes, both_keys, both_values, NUM, 32, end_bit));
        std::vector<int> sorted(NUM);
        MUST_CUDA(cudaMemcpy(sorted.data(), both_values.Current(), NUM * sizeof(int), cudaMemcpyDeviceToHost));
        SCREE_CHECK(sorted == order);
        MUST_CUDA(cudaMemcpy(sorted.data(), both_keys.Current(), NUM, cudaMemcpyDeviceToHost));
    }
}

static void test_sums()
{
    const std::vector<int> numbers = made_numbers();
    const device_array<int> in(numbers), out(NUM);
    size_t num_bytes = 0;
    MUST_CUDA(cub::DeviceScan::ExclusiveSum(nullptr, num_bytes, in.data, out.data, NUM));
    const device_array<char> scratch(num_bytes);
    MUST_CUDA(cub::DeviceScan::ExclusiveSum(scratch.data, num_bytes, in.data, out.data, NUM));
    const std::vector<int> sums = out.read();
    int sum = 0;
    for (size_t i = 0; i < NUM; ++i)
    {
        SCREE_CHECK_INT(sums[i], sum);
        sum += numbers[i];
    }
}

int main()
{
    if (is_without_device()) return SKIPPED;
    SCREE_RUN(test_block_sums);
    SCREE_RUN(test_tiles);
    SCREE_RUN(test_short_warp);
    SCREE_RUN(test_arrivals);
#ifdef CUDA_ON_CPU
    SCREE_RUN(test_schedule);
    SCREE_RUN(test_dynamic_shared);
    SCREE_RUN(test_queue);
    SCREE_RUN(test_streams_apart);
#endif
    SCREE_RUN(test_branches);
    SCREE_RUN(test_capture_of_branches);
    SCREE_RUN(test_graph);
    SCREE_RUN(test_broken_capture);
    SCREE_RUN(test_graph_of_other_calls);
    SCREE_RUN(test_refused_launch);
    SCREE_RUN(test_sort);
    SCREE_RUN(test_sums);
    return SCREE_TEST_END();
}
