/// \file streams.cpp
/// Streams, events and graphs of the emulated device. What is asked of the device waits until the host does. Then what
/// it waits for is done, one call after the other: each when all that it comes after is done, and which of those goes
/// first is the schedule's choice. So a wait that lacks is noticed by what comes out, and by the thread sanitizer in
/// any order: calls that are not ordered by streams and events are unordered threads to it.
#include "machine.h"
#include "sanitizers.h"
#include "settings.h"

#include <iterator>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <vector>

/// Calls and what they come after, as indices.
struct cuda_on_cpu_graph
{
    struct node
    {
        cuda_on_cpu::node_kind kind;
        std::function<void()> work;
        std::vector<size_t> after;
    };
    std::vector<node> nodes;
};

struct cuda_on_cpu_stream
{
    std::vector<uint64_t> last;        ///< calls that the next one comes after
    bool is_captured = false;          ///< by the capture under way
    std::vector<size_t> last_of_graph; ///< the same in there
};

struct cuda_on_cpu_event
{
    std::vector<uint64_t> last;
    uint64_t capture = 0; ///< that it was recorded in; 0: none
    std::vector<size_t> last_of_graph;
};

namespace cuda_on_cpu
{

namespace
{

/// A call that waits.
struct call
{
    std::function<void()> work;
    std::vector<uint64_t> after;
};

/// For the thread sanitizer: calls of a chain follow each other, those of different chains only as their waits say.
struct chain
{
    unsigned number;
    void *fiber;
};
struct done_call
{
    chain *own;     ///< NULL once another call has gone on with it
    char order = 0; ///< address for the thread sanitizer
};

enum class capture_state
{
    none,
    active,
    broken ///< by a call that cannot be captured
};

struct call_queue
{
    std::map<uint64_t, call> waiting;
    std::map<uint64_t, done_call> done; ///< since all was done
    std::vector<std::unique_ptr<chain>> chains;
    std::vector<chain *> free_chains;
    uint64_t num_calls = 0;
    std::vector<uint64_t> last_unnamed; ///< of the stream without a name, which all others wait for
    std::set<cudaStream_t> streams;
    char host_order = 0;
    std::mt19937 random{settings().seed};

    capture_state capture = capture_state::none;
    cudaStream_t captured = nullptr; ///< that the capture was begun in
    uint64_t num_captures = 0;
    cuda_on_cpu_graph graph; ///< kept so far
    bool refuses_graphs = false;
};

call_queue &the_queue()
{
    static call_queue it;
    return it;
}

template <class T> void append(std::vector<T> *to, const std::vector<T> &from)
{
    to->insert(to->end(), from.begin(), from.end());
}

uint64_t put(std::function<void()> work, std::vector<uint64_t> after)
{
    call_queue &q = the_queue();
    q.waiting[++q.num_calls] = {std::move(work), std::move(after)};
    return q.num_calls;
}

/// What a call in this stream comes after.
std::vector<uint64_t> last_of(cudaStream_t stream)
{
    const call_queue &q = the_queue();
    std::vector<uint64_t> last = q.last_unnamed;
    if (stream != nullptr) append(&last, stream->last);
    else
        for (const cudaStream_t other : q.streams) append(&last, other->last);
    return last;
}

void set_last(cudaStream_t stream, std::vector<uint64_t> last)
{
    (stream != nullptr ? stream->last : the_queue().last_unnamed) = std::move(last);
}

/// The chain that a call goes on with: that of one it comes after, if no other has.
chain *take_chain(const std::vector<uint64_t> &after)
{
    call_queue &q = the_queue();
    for (const uint64_t before : after)
    {
        const auto found = q.done.find(before);
        if (found == q.done.end() || found->second.own == nullptr) continue;
        chain *const own = found->second.own;
        found->second.own = nullptr;
        return own;
    }
    if (q.free_chains.empty())
    {
        const unsigned number = static_cast<unsigned>(q.chains.size());
        q.chains.push_back(std::make_unique<chain>(chain{number, race_create_fiber()}));
        q.free_chains.push_back(q.chains.back().get());
    }
    chain *const own = q.free_chains.back();
    q.free_chains.pop_back();
    return own;
}

/// Does a call. Its work ends there too: it holds memory of whoever asked for it.
void run_call(uint64_t number, call *what)
{
    call_queue &q = the_queue();
    done_call &done = q.done[number];
    chain *const own = take_chain(what->after);
    void *const host = race_current_fiber();
    set_chain(own->number);
    race_switch(own->fiber);
    race_acquire(&q.host_order);
    for (const uint64_t before : what->after)
    {
        const auto found = q.done.find(before);
        if (found != q.done.end()) race_acquire(&found->second.order);
    }
    if (!is_lost()) what->work();
    what->work = nullptr;
    race_release(&done.order);
    race_switch(host);
    done.own = own;
}

/// The calls of `wanted` and all that they come after; those that are done already do not count.
std::set<uint64_t> with_all_before(std::vector<uint64_t> wanted)
{
    const call_queue &q = the_queue();
    std::set<uint64_t> all;
    while (!wanted.empty())
    {
        const uint64_t number = wanted.back();
        wanted.pop_back();
        const auto found = q.waiting.find(number);
        if (found == q.waiting.end() || !all.insert(number).second) continue;
        append(&wanted, found->second.after);
    }
    return all;
}

/// One of those that may go first.
uint64_t choose(const std::set<uint64_t> &ready)
{
    const schedule order = settings().order;
    if (order == schedule::fifo) return *ready.begin();
    if (order == schedule::lifo) return *ready.rbegin();
    return *std::next(ready.begin(), static_cast<std::ptrdiff_t>(the_queue().random() % ready.size()));
}

/// Does them, and waits.
void run_calls(const std::set<uint64_t> &all)
{
    call_queue &q = the_queue();
    if (all.empty()) return;
    std::map<uint64_t, std::vector<uint64_t>> followers;
    std::map<uint64_t, size_t> num_before;
    std::set<uint64_t> ready;
    for (const uint64_t number : all)
    {
        const std::vector<uint64_t> &after = q.waiting[number].after;
        const std::set<uint64_t> before(after.begin(), after.end());
        for (const uint64_t b : before)
            if (q.waiting.count(b) != 0)
            {
                followers[b].push_back(number);
                ++num_before[number];
            }
        if (num_before[number] == 0) ready.insert(number);
    }
    set_all_visible(true);
    race_release(&q.host_order);
    while (!ready.empty())
    {
        const uint64_t number = choose(ready);
        ready.erase(number);
        run_call(number, &q.waiting[number]);
        for (const uint64_t next : followers[number])
            if (--num_before[next] == 0) ready.insert(next);
    }
    for (const uint64_t number : all)
    {
        race_acquire(&q.done[number].order);
        q.waiting.erase(number);
    }
    set_all_visible(false);
}

/// Nothing waits any more, and all is known to the host: chains can be used anew.
void forget_done()
{
    call_queue &q = the_queue();
    q.done.clear();
    q.free_chains.clear();
    for (const auto &c : q.chains) q.free_chains.push_back(c.get());
    q.last_unnamed.clear();
    for (const cudaStream_t stream : q.streams) stream->last.clear();
}

bool is_alike(const cuda_on_cpu_graph &a, const cuda_on_cpu_graph &b)
{
    bool is_same = a.nodes.size() == b.nodes.size();
    for (size_t k = 0; is_same && k < a.nodes.size(); ++k)
        is_same = a.nodes[k].kind == b.nodes[k].kind && a.nodes[k].after == b.nodes[k].after;
    return is_same;
}

} // namespace

bool is_capturing() { return the_queue().capture != capture_state::none; }

bool is_captured(cudaStream_t stream) { return is_capturing() && stream != nullptr && stream->is_captured; }

cudaError_t break_capture(cudaError_t error)
{
    the_queue().capture = capture_state::broken;
    return remember(error);
}

int enqueue(node_kind kind, std::function<void()> work, cudaStream_t stream)
{
    if (current != nullptr) fail("a kernel uses a function of the host");
    call_queue &q = the_queue();
    // the stream without a name waits for all others, which a captured one cannot
    if (is_capturing() && stream == nullptr) return break_capture(cudaErrorStreamCaptureImplicit);
    if (is_captured(stream))
    {
        if (q.capture == capture_state::broken) return remember(cudaErrorStreamCaptureInvalidated);
        q.graph.nodes.push_back({kind, std::move(work), stream->last_of_graph});
        stream->last_of_graph = {q.graph.nodes.size() - 1};
        return cudaSuccess;
    }
    if (kind == node_kind::kernel) work = count_launch(std::move(work));
    set_last(stream, {put(std::move(work), last_of(stream))});
    return cudaSuccess;
}

void drain()
{
    call_queue &q = the_queue();
    std::set<uint64_t> all;
    for (const auto &entry : q.waiting) all.insert(all.end(), entry.first);
    run_calls(all);
    forget_done();
}

void refuse_graphs(bool refuses) { the_queue().refuses_graphs = refuses; }

} // namespace cuda_on_cpu

using namespace cuda_on_cpu;

// ---- streams

cudaError_t cudaDeviceSynchronize()
{
    if (is_capturing()) return break_capture(cudaErrorStreamCaptureUnsupported);
    drain();
    return is_lost() ? remember(cudaErrorIllegalAddress) : cudaSuccess;
}

cudaError_t cudaStreamCreate(cudaStream_t *stream)
{
    *stream = new cuda_on_cpu_stream;
    the_queue().streams.insert(*stream);
    return cudaSuccess;
}

cudaError_t cudaStreamDestroy(cudaStream_t stream)
{
    const cudaError_t error = cudaDeviceSynchronize();
    the_queue().streams.erase(stream);
    delete stream;
    return error;
}

cudaError_t cudaStreamSynchronize(cudaStream_t stream)
{
    if (is_capturing()) return break_capture(cudaErrorStreamCaptureUnsupported);
    run_calls(with_all_before(last_of(stream)));
    if (the_queue().waiting.empty()) forget_done();
    return is_lost() ? remember(cudaErrorIllegalAddress) : cudaSuccess;
}

// ---- events

cudaError_t cudaEventCreateWithFlags(cudaEvent_t *event, unsigned)
{
    *event = new cuda_on_cpu_event;
    return cudaSuccess;
}

cudaError_t cudaEventDestroy(cudaEvent_t event)
{
    delete event;
    return cudaSuccess;
}

cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream)
{
    const call_queue &q = the_queue();
    *event = cuda_on_cpu_event{};
    if (is_captured(stream))
    {
        event->capture = q.num_captures;
        event->last_of_graph = stream->last_of_graph;
    }
    else event->last = last_of(stream);
    return cudaSuccess;
}

cudaError_t cudaStreamWaitEvent(cudaStream_t stream, cudaEvent_t event, unsigned)
{
    const call_queue &q = the_queue();
    if (event->capture != 0)
    {
        // a stream that waits for what is captured is captured too
        if (!is_capturing() || event->capture != q.num_captures) return remember(cudaErrorCapturedEvent);
        if (stream == nullptr) return break_capture(cudaErrorStreamCaptureImplicit);
        stream->is_captured = true;
        append(&stream->last_of_graph, event->last_of_graph);
        return cudaSuccess;
    }
    if (is_captured(stream)) return break_capture(cudaErrorStreamCaptureIsolation);
    std::vector<uint64_t> last = last_of(stream);
    append(&last, event->last);
    set_last(stream, std::move(last));
    return cudaSuccess;
}

// ---- graphs

cudaError_t cudaStreamBeginCapture(cudaStream_t stream, cudaStreamCaptureMode)
{
    call_queue &q = the_queue();
    if (stream == nullptr) return remember(cudaErrorStreamCaptureUnsupported);
    if (is_capturing()) return break_capture(cudaErrorIllegalState);
    q.captured = stream;
    q.capture = capture_state::active;
    q.graph.nodes.clear();
    ++q.num_captures;
    stream->is_captured = true;
    return cudaSuccess;
}

cudaError_t cudaStreamEndCapture(cudaStream_t stream, cudaGraph_t *graph)
{
    call_queue &q = the_queue();
    *graph = nullptr;
    if (!is_capturing()) return remember(cudaErrorIllegalState);
    if (stream != q.captured) return remember(cudaErrorStreamCaptureUnmatched);
    const bool is_whole = q.capture == capture_state::active;
    // what nobody comes after must be what this stream ended with
    std::set<size_t> ends;
    for (size_t k = 0; k < q.graph.nodes.size(); ++k) ends.insert(k);
    for (const cuda_on_cpu_graph::node &node : q.graph.nodes)
        for (const size_t before : node.after) ends.erase(before);
    for (const size_t last : stream->last_of_graph) ends.erase(last);
    q.capture = capture_state::none;
    q.captured = nullptr;
    for (const cudaStream_t other : q.streams)
    {
        other->is_captured = false;
        other->last_of_graph.clear();
    }
    if (!is_whole) return remember(cudaErrorStreamCaptureInvalidated);
    if (!ends.empty()) return remember(cudaErrorStreamCaptureUnjoined);
    *graph = new cuda_on_cpu_graph(std::move(q.graph));
    q.graph.nodes.clear();
    return cudaSuccess;
}

cudaError_t cudaGraphInstantiate(cudaGraphExec_t *made, cudaGraph_t graph, unsigned long long)
{
    *made = nullptr;
    if (the_queue().refuses_graphs) return remember(cudaErrorMemoryAllocation);
    *made = new cuda_on_cpu_graph(*graph);
    return cudaSuccess;
}

cudaError_t cudaGraphExecUpdate(cudaGraphExec_t made, cudaGraph_t graph, cudaGraphExecUpdateResultInfo *info)
{
    // the same kinds of nodes in the same places may get other arguments
    *info = cudaGraphExecUpdateResultInfo{};
    info->result = is_alike(*made, *graph) ? cudaGraphExecUpdateSuccess : cudaGraphExecUpdateErrorTopologyChanged;
    if (info->result != cudaGraphExecUpdateSuccess) return remember(cudaErrorGraphExecUpdateFailure);
    made->nodes = graph->nodes;
    return cudaSuccess;
}

cudaError_t cudaGraphLaunch(cudaGraphExec_t made, cudaStream_t stream)
{
    if (is_capturing()) return break_capture(cudaErrorStreamCaptureUnsupported);
    if (is_lost()) return remember(cudaErrorIllegalAddress);
    std::vector<uint64_t> numbers;
    for (const cuda_on_cpu_graph::node &node : made->nodes)
    {
        std::vector<uint64_t> after = last_of(stream);
        for (const size_t before : node.after) after.push_back(numbers[before]);
        numbers.push_back(put(node.kind == node_kind::kernel ? count_launch(node.work) : node.work, std::move(after)));
    }
    if (!numbers.empty()) set_last(stream, std::move(numbers));
    return cudaSuccess;
}

cudaError_t cudaGraphDestroy(cudaGraph_t graph)
{
    delete graph;
    return cudaSuccess;
}

cudaError_t cudaGraphExecDestroy(cudaGraphExec_t made)
{
    // what was launched goes on: it is in the queue
    delete made;
    return cudaSuccess;
}
