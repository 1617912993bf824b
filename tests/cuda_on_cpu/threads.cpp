/// \file threads.cpp
/// The threads of a block as fibers of one thread of the operating system, the blocks of a grid shared between two or
/// more of those. A fiber runs until it has to wait for others; which one goes on then is the schedule's choice.
/// Never instrumented itself: it tells the sanitizers about its fibers instead.
#include "machine.h"

#include <boost/context/fiber.hpp>

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <random>
#include <sys/mman.h>
#include <thread>
#include <vector>

#include "sanitizers.h"
#include "settings.h"

namespace cuda_on_cpu
{

thread_local thread_state *current = nullptr;
static const char *current_kernel = nullptr;

namespace
{

constexpr size_t stack_bytes = 512 * 1024; ///< of one fiber; touched pages only count
constexpr size_t page_bytes = 4096;

/// Where in the source a thread asked for something.
struct place
{
    const char *file;
    int line;
};

enum class waiting
{
    for_its_turn,
    for_the_block,
    for_its_warp,
    for_nothing ///< has returned from the kernel
};

struct device_thread
{
    thread_state state;
    waiting waits = waiting::for_nothing;
    place where = {"", 0};
    unsigned mask = 0;               ///< of the meeting it waits for
    char *stack = nullptr;           ///< above a page that nobody may touch
    boost::context::fiber fiber;     ///< while others run
    boost::context::fiber scheduler; ///< while this one runs
    void *fake_stack = nullptr;      ///< of the address sanitizer
    void *race_fiber = nullptr;      ///< of the thread sanitizer
    const void *atomics[4] = {};     ///< the last ones, for fences
    unsigned num_atomics = 0;
    bool has_fenced = false;
};

/// One meeting after the other of the lanes of one mask. Results of two are kept: who is slow still reads the last one
/// while others are at the next. Free for another mask when nobody has arrived and all have read.
struct warp_meeting
{
    unsigned mask;
    unsigned arrived;
    unsigned num_readers;
    unsigned generation;
    warp_operation operation;
    place where;
    warp_meeting_result results[2];
    char order[2]; ///< addresses for the thread sanitizer
};

struct warp
{
    unsigned alive;            ///< lanes that have not returned
    warp_meeting meetings[33]; ///< a lane is in one at most; no memory is taken while fibers run
};

/// Gives boost the stack that a device thread has already.
struct own_stack
{
    char *bottom;
    boost::context::stack_context allocate()
    {
        boost::context::stack_context context;
        context.size = stack_bytes;
        context.sp = bottom + stack_bytes;
        return context;
    }
    void deallocate(boost::context::stack_context &) {}
};

bool is_same(place a, place b) { return a.line == b.line && std::strcmp(a.file, b.file) == 0; }

/// Runs blocks, one after the other, on the thread of the operating system that calls it.
struct worker
{
    std::vector<std::unique_ptr<device_thread>> threads;
    std::vector<device_thread *> ready;
    std::vector<warp> warps;
    device_thread *running = nullptr;
    const std::function<void()> *body = nullptr;
    unsigned num_threads = 0, num_alive = 0;

    // meeting of the block
    unsigned num_arrived = 0, num_votes = 0, generation = 0;
    unsigned results[2] = {0, 0};
    place block_where = {"", 0};
    char block_order[2], start_order, end_order;

    std::vector<uint64_t> shared;
    std::mt19937 random{settings().seed};
    const void *stack_bottom = nullptr; ///< of this worker, for the address sanitizer
    size_t stack_size = 0;
    void *race_fiber = nullptr;

    void run_block(const launch_shape &shape, uint3 block, const std::function<void()> &kernel);
    void make_threads(unsigned num);
    void start(device_thread *thread);
    void resume(device_thread *thread);
    void suspend(waiting reason);
    void make_ready(device_thread *thread);
    device_thread *next();
    void leave(device_thread *thread);
    void open_block();
    void open_warp(unsigned w, warp_meeting *meeting);
    [[noreturn]] void report_deadlock();
};

thread_local worker *this_worker = nullptr;

void worker::make_threads(unsigned num)
{
    while (threads.size() < num)
    {
        auto thread = std::make_unique<device_thread>();
        void *memory = mmap(nullptr, stack_bytes + page_bytes, PROT_READ | PROT_WRITE,
                            MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (memory == MAP_FAILED) fail("no memory for the stacks of %u threads", num);
        mprotect(memory, page_bytes, PROT_NONE);
        thread->stack = static_cast<char *>(memory) + page_bytes;
        thread->race_fiber = race_create_fiber();
        threads.push_back(std::move(thread));
    }
}

void worker::make_ready(device_thread *thread)
{
    thread->waits = waiting::for_its_turn;
    ready.push_back(thread);
}

device_thread *worker::next()
{
    size_t k = 0;
    if (settings().order == schedule::lifo) k = ready.size() - 1;
    if (settings().order == schedule::random) k = random() % ready.size();
    device_thread *thread = ready[k];
    ready.erase(ready.begin() + static_cast<std::ptrdiff_t>(k));
    return thread;
}

/// A fiber that runs the kernel once.
void worker::start(device_thread *thread)
{
    thread->num_atomics = 0;
    thread->has_fenced = false;
    thread->fiber = boost::context::fiber(std::allocator_arg, own_stack{thread->stack},
                                          [this, thread](boost::context::fiber &&scheduler)
                                          {
                                              thread->scheduler = std::move(scheduler);
                                              address_arrive(nullptr, &stack_bottom, &stack_size);
                                              race_acquire(&start_order);
                                              (*body)();
                                              race_release(&end_order);
                                              leave(thread);
                                              address_depart(nullptr, stack_bottom, stack_size);
                                              race_switch(race_fiber);
                                              return std::move(thread->scheduler);
                                          });
    make_ready(thread);
}

/// From the worker to a device thread, and back when that waits or has ended.
void worker::resume(device_thread *thread)
{
    running = thread;
    current = &thread->state;
    void *own_fake_stack = nullptr;
    address_depart(&own_fake_stack, thread->stack, stack_bytes);
    race_switch(thread->race_fiber);
    thread->fiber = std::move(thread->fiber).resume();
    address_arrive(own_fake_stack, nullptr, nullptr);
    current = nullptr;
}

/// From the running device thread to the worker, until the thread is resumed.
void worker::suspend(waiting reason)
{
    device_thread *thread = running;
    thread->waits = reason;
    address_depart(&thread->fake_stack, stack_bottom, stack_size);
    race_switch(race_fiber);
    thread->scheduler = std::move(thread->scheduler).resume();
    address_arrive(thread->fake_stack, nullptr, nullptr);
}

/// A thread has returned from the kernel: nobody may wait for it with the whole block; its warp goes on without it.
void worker::leave(device_thread *thread)
{
    thread->waits = waiting::for_nothing;
    --num_alive;
    if (num_arrived > 0)
        fail("the thread returns while %u others wait in __syncthreads at %s:%d", num_arrived, block_where.file,
             block_where.line);
    warp &own = warps[thread->state.warp];
    own.alive &= ~(1u << thread->state.lane);
    for (warp_meeting &meeting : own.meetings)
        if (meeting.arrived != 0 && meeting.arrived == (meeting.mask & own.alive))
            open_warp(thread->state.warp, &meeting);
}

void worker::open_block()
{
    results[generation & 1] = num_votes;
    num_arrived = num_votes = 0;
    ++generation;
    for (unsigned t = 0; t < num_threads; ++t)
        if (threads[t]->waits == waiting::for_the_block) make_ready(threads[t].get());
}

void worker::open_warp(unsigned w, warp_meeting *meeting)
{
    meeting->results[meeting->generation & 1].lanes = meeting->arrived;
    ++meeting->generation;
    const unsigned arrived = meeting->arrived;
    meeting->num_readers += static_cast<unsigned>(__builtin_popcount(arrived));
    meeting->arrived = 0;
    for (unsigned lane = 0; lane < 32; ++lane)
    {
        if ((arrived >> lane & 1) == 0) continue;
        device_thread *thread = threads[w * 32 + lane].get();
        if (thread->waits == waiting::for_its_warp && thread->mask == meeting->mask) make_ready(thread);
    }
}

void worker::report_deadlock()
{
    std::fprintf(stderr, "\ncuda_on_cpu: %s: deadlock, %u of %u threads cannot go on\n", current_kernel, num_alive,
                 num_threads);
    unsigned num_shown = 0;
    for (unsigned t = 0; t < num_threads && num_shown < 8; ++t)
    {
        const device_thread &thread = *threads[t];
        if (thread.waits == waiting::for_nothing) continue;
        const bool is_block = thread.waits == waiting::for_the_block;
        std::fprintf(stderr, "  thread %u waits for %s at %s:%d, mask %08x\n", t, is_block ? "the block" : "its warp",
                     thread.where.file, thread.where.line, thread.mask);
        ++num_shown;
    }
    std::abort();
}

void worker::run_block(const launch_shape &shape, uint3 block, const std::function<void()> &kernel)
{
    const dim3 size = shape.block;
    body = &kernel;
    num_threads = num_alive = size.x * size.y * size.z;
    make_threads(num_threads);
    ready.clear();
    ready.reserve(num_threads);
    shared.assign(shape.dynamic_shared_bytes / sizeof(uint64_t) + 1, ~uint64_t(0));
    warps.clear();
    warps.resize((num_threads + 31) / 32);
    for (unsigned t = 0; t < num_threads; ++t)
    {
        const uint3 place = {t % size.x, t / size.x % size.y, t / size.x / size.y};
        threads[t]->state = {place, block, size, shape.grid, t, t % 32, t / 32};
        warps[t / 32].alive |= 1u << t % 32;
        start(threads[t].get());
    }
    race_release(&start_order);
    while (num_alive > 0)
    {
        if (ready.empty()) report_deadlock();
        resume(next());
    }
    race_acquire(&end_order);
}

/// The share of one worker: every `num_workers`-th block. Fixed, so that the thread sanitizer takes blocks of different
/// workers for unordered, as they are.
void run_share(worker *self, const launch_shape &shape, const std::function<void()> &body, unsigned first,
               unsigned num_workers)
{
    this_worker = self;
    self->race_fiber = race_current_fiber();
    const dim3 grid = shape.grid;
    const uint64_t num_blocks = uint64_t(grid.x) * grid.y * grid.z;
    for (uint64_t b = first; b < num_blocks; b += num_workers)
    {
        const uint3 block = {unsigned(b % grid.x), unsigned(b / grid.x % grid.y), unsigned(b / grid.x / grid.y)};
        self->run_block(shape, block, body);
    }
    this_worker = nullptr;
}

} // namespace

static unsigned current_chain = 0;

void set_chain([[maybe_unused]] unsigned chain)
{
#ifdef CUDA_ON_CPU_RACES
    current_chain = chain;
#endif
}

void run_grid(const char *kernel, const launch_shape &shape, const std::function<void()> &body)
{
    static std::map<unsigned, std::vector<std::unique_ptr<worker>>> workers_of_chain;
    std::vector<std::unique_ptr<worker>> &workers = workers_of_chain[current_chain];
    while (workers.size() < settings().num_workers) workers.push_back(std::make_unique<worker>());
    current_kernel = kernel;
    const bool is_single = shape.grid.x * shape.grid.y * shape.grid.z == 1;
    const unsigned num_workers = is_single ? 1 : settings().num_workers;
    // the host's own thread has one memory for what blocks share, which grids of all chains would have in common
    const unsigned first = current_chain == 0 ? 1 : 0;
    std::vector<std::thread> others;
    for (unsigned w = first; w < num_workers; ++w)
        others.emplace_back(run_share, workers[w].get(), std::cref(shape), std::cref(body), w, num_workers);
    if (first > 0) run_share(workers[0].get(), shape, body, 0, num_workers);
    for (std::thread &other : others) other.join();
    current_kernel = nullptr;
}

int meet_block(bool vote, const char *file, int line)
{
    const place where = {file, line};
    worker &w = *this_worker;
    device_thread *thread = w.running;
    if (w.num_alive < w.num_threads)
        fail("__syncthreads at %s:%d after %u threads have returned", where.file, where.line,
             w.num_threads - w.num_alive);
    if (w.num_arrived == 0) w.block_where = where;
    else if (!is_same(w.block_where, where))
        fail("threads of one block meet in different __syncthreads, at %s:%d and %s:%d", w.block_where.file,
             w.block_where.line, where.file, where.line);
    const unsigned generation = w.generation & 1;
    race_release(&w.block_order[generation]);
    thread->where = where;
    ++w.num_arrived;
    w.num_votes += vote;
    if (w.num_arrived == w.num_threads) w.open_block();
    else w.suspend(waiting::for_the_block);
    race_acquire(&w.block_order[generation]);
    return static_cast<int>(w.results[generation]);
}

/// The meeting of this mask; one that is free if there is none yet.
static warp_meeting *find_meeting(warp &own, unsigned mask)
{
    warp_meeting *free = nullptr;
    for (warp_meeting &meeting : own.meetings)
    {
        if (meeting.mask == mask) return &meeting;
        if (meeting.arrived == 0 && meeting.num_readers == 0) free = &meeting;
    }
    free->mask = mask;
    return free;
}

warp_meeting_result meet_warp(unsigned mask, warp_operation operation, lane_value value, const char *file, int line)
{
    const place where = {file, line};
    worker &w = *this_worker;
    device_thread *thread = w.running;
    const unsigned lane = thread->state.lane, first = thread->state.warp * 32;
    if ((mask >> lane & 1) == 0)
        fail("lane %u is not in its own mask %08x at %s:%d", lane, mask, where.file, where.line);
    // the last warp of a block may be short
    if (w.num_threads - first < 32) mask &= (1u << (w.num_threads - first)) - 1;
    warp &own = w.warps[thread->state.warp];
    warp_meeting *meeting = find_meeting(own, mask);
    if (meeting->arrived == 0)
    {
        meeting->operation = operation;
        meeting->where = where;
    }
    else if (meeting->operation != operation || !is_same(meeting->where, where))
        fail("lanes of the mask %08x meet at different places, %s:%d and %s:%d", mask, meeting->where.file,
             meeting->where.line, where.file, where.line);
    const unsigned generation = meeting->generation & 1;
    meeting->results[generation].values[lane] = value;
    if (operation == warp_operation::sync) race_release(&meeting->order[generation]);
    meeting->arrived |= 1u << lane;
    thread->where = where;
    thread->mask = mask;
    if (meeting->arrived == (mask & own.alive)) w.open_warp(thread->state.warp, meeting);
    else w.suspend(waiting::for_its_warp);
    if (operation == warp_operation::sync) race_acquire(&meeting->order[generation]);
    --meeting->num_readers;
    return meeting->results[generation];
}

/// The thread sanitizer does not know fences. So a fence makes the later atomics of its thread releases, and acquires
/// what the earlier ones (the last four addresses) have met.
bool note_atomic(const void *address)
{
    device_thread *thread = this_worker->running;
    thread->atomics[thread->num_atomics++ & 3] = address;
    if (settings().order == schedule::random && this_worker->random() % 4 == 0)
    {
        this_worker->make_ready(thread);
        this_worker->suspend(waiting::for_its_turn);
    }
    return thread->has_fenced;
}

void fence()
{
    __atomic_thread_fence(__ATOMIC_SEQ_CST);
    device_thread *thread = this_worker->running;
    for (unsigned k = 0; k < 4 && k < thread->num_atomics; ++k) race_acquire(thread->atomics[k]);
    thread->has_fenced = true;
}

void *dynamic_shared() { return this_worker->shared.data(); }

void fail(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    std::fprintf(stderr, "\ncuda_on_cpu: ");
    if (current_kernel != nullptr) std::fprintf(stderr, "%s: ", current_kernel);
    std::vfprintf(stderr, format, arguments);
    va_end(arguments);
    if (current != nullptr)
        std::fprintf(stderr, "\n  in block (%u, %u, %u), thread (%u, %u, %u)", current->block.x, current->block.y,
                     current->block.z, current->thread.x, current->thread.y, current->thread.z);
    std::fputc('\n', stderr);
    std::abort();
}

} // namespace cuda_on_cpu
