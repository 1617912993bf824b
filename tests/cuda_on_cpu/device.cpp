/// \file device.cpp
/// Memory, copies, launches and errors of the emulated device. Device memory is readable and writable only while the
/// device works; what is asked is done when the host waits, so a host that does not wait reads what was there before.
#include "machine.h"

#include <cxxabi.h>
#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <map>
#include <string>
#include <sys/mman.h>

#include "sanitizers.h"
#include "settings.h"

namespace cuda_on_cpu
{

namespace
{

constexpr size_t page_bytes = 4096;
constexpr size_t alignment = 256; ///< that cudaMalloc promises

struct allocation
{
    size_t num_bytes;
    char *map; ///< whole pages, with one that nobody may touch on either side
    size_t map_bytes;
};

/// The one device there is.
struct device
{
    std::map<char *, allocation> allocations;
    std::map<const char *, size_t> pinned; ///< host memory and its bytes
    size_t num_bytes = 0;
    long num_launches = 0;
    long num_allocations = 0;
    long num_left = settings().no_memory_at - 1; ///< allocations that there is memory for; < 0: any
    cudaError_t last_error = cudaSuccess;
    bool is_lost = false; ///< after a fault of a kernel every call fails
};

device &the_device()
{
    static device it;
    return it;
}

/// Lets the host at device memory, or keeps it away.
void set_visible(const char *address, const allocation &block, bool is_visible)
{
    if (is_visible) show(address, block.num_bytes);
    else hide(address, block.num_bytes);
    mprotect(block.map + page_bytes, block.map_bytes - 2 * page_bytes, is_visible ? PROT_READ | PROT_WRITE : PROT_NONE);
}

using allocation_entry = std::map<char *, allocation>::value_type;

/// The allocation that holds the address, its end counts too; NULL for host memory.
const allocation_entry *find_allocation(const void *address)
{
    const auto &allocations = the_device().allocations;
    auto after = allocations.upper_bound(const_cast<char *>(static_cast<const char *>(address)));
    if (after == allocations.begin()) return nullptr;
    const auto before = std::prev(after);
    return static_cast<const char *>(address) <= before->first + before->second.num_bytes ? &*before : nullptr;
}

bool is_of_device(const void *address) { return find_allocation(address) != nullptr; }

bool is_mapped(uintptr_t address)
{
    unsigned char present;
    return mincore(reinterpret_cast<void *>(address / page_bytes * page_bytes), 1, &present) == 0;
}

/// Refuses what no device would do with these pointers.
void check_kind(const void *to, const void *from, cudaMemcpyKind kind)
{
    const bool to_device = kind == cudaMemcpyHostToDevice || kind == cudaMemcpyDeviceToDevice;
    const bool from_device = kind == cudaMemcpyDeviceToHost || kind == cudaMemcpyDeviceToDevice;
    if (is_of_device(to) != to_device || is_of_device(from) != from_device)
        fail("a copy of kind %d to %s memory from %s memory", static_cast<int>(kind),
             is_of_device(to) ? "device" : "host", is_of_device(from) ? "device" : "host");
}

/// Machine code runs on GPUs of its major capability, from its minor one on.
bool has_code()
{
    const int code = settings().code, capability = settings().capability;
    return code == 0 || (code / 10 == capability / 10 && code <= capability);
}

/// Host memory that a captured copy may lie in.
bool is_pinned(const void *address, size_t num_bytes)
{
    const char *byte = static_cast<const char *>(address);
    const auto &pinned = the_device().pinned;
    auto after = pinned.upper_bound(byte);
    if (after == pinned.begin()) return false;
    const auto before = std::prev(after);
    return byte + num_bytes <= before->first + before->second;
}

long number_from(const char *variable, long otherwise)
{
    const char *text = std::getenv(variable);
    return text != nullptr ? std::strtol(text, nullptr, 0) : otherwise;
}

} // namespace

cudaError_t remember(cudaError_t error)
{
    if (error != cudaSuccess) the_device().last_error = error;
    return error;
}

bool is_lost() { return the_device().is_lost; }

std::function<void()> count_launch(std::function<void()> run)
{
    if (++the_device().num_launches != settings().fault_at) return run;
    return []
    {
        the_device().is_lost = true;
        the_device().last_error = cudaErrorIllegalAddress;
    };
}

void set_all_visible(bool is_visible)
{
    for (const auto &entry : the_device().allocations) set_visible(entry.first, entry.second, is_visible);
}

const machine_settings &settings()
{
    static const machine_settings read = []
    {
        const char *order = std::getenv("CUDA_ON_CPU_SCHEDULE");
        const std::string name = order != nullptr ? order : "fifo";
        machine_settings s;
        s.order = name == "lifo" ? schedule::lifo : name == "random" ? schedule::random : schedule::fifo;
        if (s.order == schedule::fifo && name != "fifo") fail("CUDA_ON_CPU_SCHEDULE is %s", name.c_str());
        s.seed = static_cast<unsigned>(number_from("CUDA_ON_CPU_SEED", 1));
        s.num_workers = static_cast<unsigned>(number_from("CUDA_ON_CPU_WORKERS", 2));
        s.num_devices = static_cast<int>(number_from("CUDA_ON_CPU_DEVICES", 1));
        s.capability = static_cast<int>(number_from("CUDA_ON_CPU_CAPABILITY", 80));
        s.code = static_cast<int>(number_from("CUDA_ON_CPU_CODE", 0));
        s.driver = static_cast<int>(number_from("CUDA_ON_CPU_DRIVER", 13000));
        s.memory = static_cast<size_t>(number_from("CUDA_ON_CPU_MEMORY", 1l << 32));
        s.fault_at = number_from("CUDA_ON_CPU_FAULT_AT", 0);
        s.no_memory_at = number_from("CUDA_ON_CPU_NO_MEMORY_AT", 0);
        return s;
    }();
    return read;
}

const char *name_of(const void *function)
{
    static std::map<const void *, std::string> names;
    auto found = names.find(function);
    if (found == names.end())
    {
        Dl_info info;
        const bool is_known = dladdr(function, &info) != 0 && info.dli_sname != nullptr;
        int status = 0;
        char *plain = is_known ? abi::__cxa_demangle(info.dli_sname, nullptr, nullptr, &status) : nullptr;
        found = names.emplace(function, plain != nullptr ? plain : is_known ? info.dli_sname : "kernel").first;
        std::free(plain);
    }
    return found->second.c_str();
}

void refuse_host_addresses(const char *what, const void *bytes, size_t num_bytes)
{
    for (size_t at = 0; at + sizeof(uintptr_t) <= num_bytes; at += sizeof(uintptr_t))
    {
        uintptr_t word;
        std::memcpy(&word, static_cast<const char *>(bytes) + at, sizeof word);
        // programs, heaps and stacks lie between these bounds, and next to no number of a simulation does
        if (word < uintptr_t(0x55) << 40 || word >= uintptr_t(0x80) << 40) continue;
        // a small number with anything in the gap behind it
        if ((word & 0xffffffffu) < 1u << 20) continue;
        if (is_of_device(reinterpret_cast<const void *>(word)) || !is_mapped(word)) continue;
        fail("%s gets the host address %p, at byte %zu of %zu", what, reinterpret_cast<void *>(word), at, num_bytes);
    }
}

void allow_allocations(long num) { the_device().num_left = num; }

long num_allocations() { return the_device().num_allocations; }

int launch(const char *kernel, const launch_shape &shape, std::function<void()> body, cudaStream_t stream)
{
    device &d = the_device();
    const dim3 g = shape.grid, b = shape.block;
    const uint64_t num_threads = uint64_t(b.x) * b.y * b.z;
    if (num_threads == 0 || num_threads > 1024 || g.x == 0 || g.y == 0 || g.z == 0 || g.x > 0x7fffffffu ||
        g.y > 65535 || g.z > 65535 || shape.dynamic_shared_bytes > 48 * 1024)
        return remember(cudaErrorInvalidConfiguration);
    if (d.is_lost) return remember(cudaErrorIllegalAddress);
    if (!has_code()) return remember(cudaErrorNoKernelImageForDevice);
    return enqueue(
        node_kind::kernel, [=, body = std::move(body)] { run_grid(kernel, shape, body); }, stream);
}

} // namespace cuda_on_cpu

using namespace cuda_on_cpu;

cudaError_t cudaGetLastError()
{
    const cudaError_t error = the_device().last_error;
    the_device().last_error = the_device().is_lost ? cudaErrorIllegalAddress : cudaSuccess;
    return error;
}

cudaError_t cudaPeekAtLastError() { return the_device().last_error; }

const char *cudaGetErrorString(cudaError_t error)
{
    switch (error)
    {
    case cudaSuccess:
        return "no error";
    case cudaErrorInvalidValue:
        return "invalid argument";
    case cudaErrorMemoryAllocation:
        return "out of memory";
    case cudaErrorInvalidConfiguration:
        return "invalid configuration argument";
    case cudaErrorInsufficientDriver:
        return "CUDA driver version is insufficient for CUDA runtime version";
    case cudaErrorNoDevice:
        return "no CUDA-capable device is detected";
    case cudaErrorInvalidDeviceFunction:
        return "invalid device function";
    case cudaErrorNoKernelImageForDevice:
        return "no kernel image is available for execution on the device";
    case cudaErrorIllegalState:
        return "the operation cannot be performed in the present state";
    case cudaErrorStreamCaptureUnsupported:
        return "operation not permitted when stream is capturing";
    case cudaErrorStreamCaptureInvalidated:
        return "operation failed due to a previous error during capture";
    case cudaErrorStreamCaptureUnmatched:
        return "capture was not initiated in this stream";
    case cudaErrorStreamCaptureUnjoined:
        return "capturing stream has unjoined work";
    case cudaErrorStreamCaptureIsolation:
        return "dependency created on uncaptured work in another stream";
    case cudaErrorCapturedEvent:
        return "operation not permitted on an event last recorded in a capturing stream";
    case cudaErrorStreamCaptureImplicit:
        return "operation would make the legacy stream depend on a capturing blocking stream";
    case cudaErrorGraphExecUpdateFailure:
        return "the graph update was not performed because it included changes which violated constraints specific to "
               "instantiated graph update";
    case cudaErrorIllegalAddress:
        return "an illegal memory access was encountered";
    }
    return "unknown error";
}

cudaError_t cudaDriverGetVersion(int *version)
{
    *version = settings().driver;
    return cudaSuccess;
}

cudaError_t cudaRuntimeGetVersion(int *version)
{
    *version = 13000;
    return cudaSuccess;
}

cudaError_t cudaGetDeviceCount(int *num_devices)
{
    *num_devices = 0;
    if (settings().driver < 13000) return remember(cudaErrorInsufficientDriver);
    if (settings().num_devices < 1) return remember(cudaErrorNoDevice);
    *num_devices = settings().num_devices;
    return cudaSuccess;
}

cudaError_t cudaSetDevice(int device)
{
    return device >= 0 && device < settings().num_devices ? cudaSuccess : remember(cudaErrorNoDevice);
}

cudaError_t cudaGetDeviceProperties(cudaDeviceProp *properties, int device)
{
    if (device < 0 || device >= settings().num_devices) return remember(cudaErrorNoDevice);
    *properties = cudaDeviceProp{};
    std::strcpy(properties->name, "CUDA on the CPU");
    properties->totalGlobalMem = settings().memory;
    properties->major = settings().capability / 10;
    properties->minor = settings().capability % 10;
    properties->multiProcessorCount = static_cast<int>(settings().num_workers);
    properties->warpSize = 32;
    return cudaSuccess;
}

cudaError_t cudaFuncGetAttributes(cudaFuncAttributes *attributes, const void *)
{
    if (!has_code()) return remember(cudaErrorNoKernelImageForDevice);
    *attributes = cudaFuncAttributes{};
    attributes->binaryVersion = settings().capability;
    return cudaSuccess;
}

cudaError_t cudaMalloc(void **address, size_t num_bytes)
{
    device &d = the_device();
    ++d.num_allocations;
    if (is_capturing()) return break_capture(cudaErrorStreamCaptureUnsupported);
    if (num_bytes == 0 || d.num_left == 0 || d.num_bytes + num_bytes > settings().memory)
        return remember(cudaErrorMemoryAllocation);
    if (d.num_left > 0) --d.num_left;
    // the end of the array stands as near to the forbidden page as the alignment allows
    const size_t rounded = (num_bytes + alignment - 1) / alignment * alignment;
    allocation block = {num_bytes, nullptr, (rounded + page_bytes - 1) / page_bytes * page_bytes + 2 * page_bytes};
    void *map = mmap(nullptr, block.map_bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (map == MAP_FAILED) return remember(cudaErrorMemoryAllocation);
    block.map = static_cast<char *>(map);
    char *data = block.map + block.map_bytes - page_bytes - rounded;
    mprotect(block.map + page_bytes, block.map_bytes - 2 * page_bytes, PROT_READ | PROT_WRITE);
    std::memset(block.map + page_bytes, 0xff, block.map_bytes - 2 * page_bytes);
    hide(block.map + page_bytes, block.map_bytes - 2 * page_bytes);
    set_visible(data, block, false);
    d.num_bytes += num_bytes;
    d.allocations[data] = block;
    *address = data;
    return cudaSuccess;
}

cudaError_t cudaFree(void *address)
{
    if (address == nullptr) return cudaSuccess;
    if (is_capturing()) return break_capture(cudaErrorStreamCaptureUnsupported);
    drain();
    device &d = the_device();
    const auto found = d.allocations.find(static_cast<char *>(address));
    if (found == d.allocations.end()) fail("cudaFree of %p, which is not an allocation", address);
    show(found->second.map, found->second.map_bytes);
    munmap(found->second.map, found->second.map_bytes);
    d.num_bytes -= found->second.num_bytes;
    d.allocations.erase(found);
    return cudaSuccess;
}

cudaError_t cudaMemGetInfo(size_t *num_free, size_t *num_total)
{
    *num_total = settings().memory;
    *num_free = settings().memory - the_device().num_bytes;
    return cudaSuccess;
}

cudaError_t cudaMallocHost(void **address, size_t num_bytes)
{
    if (is_capturing()) return break_capture(cudaErrorStreamCaptureUnsupported);
    *address = std::calloc(1, num_bytes);
    if (*address == nullptr) return remember(cudaErrorMemoryAllocation);
    the_device().pinned[static_cast<char *>(*address)] = num_bytes;
    return cudaSuccess;
}

cudaError_t cudaFreeHost(void *address)
{
    if (address == nullptr) return cudaSuccess;
    if (is_capturing()) return break_capture(cudaErrorStreamCaptureUnsupported);
    drain();
    if (the_device().pinned.erase(static_cast<char *>(address)) != 1)
        fail("cudaFreeHost of %p, which is not pinned", address);
    std::free(address);
    return cudaSuccess;
}

cudaError_t cudaMemcpyAsync(void *to, const void *from, size_t num_bytes, cudaMemcpyKind kind, cudaStream_t stream)
{
    if (num_bytes == 0) return cudaSuccess;
    check_kind(to, from, kind);
    const void *here = kind == cudaMemcpyHostToDevice ? from : kind == cudaMemcpyDeviceToHost ? to : nullptr;
    // memory that is not pinned goes through a buffer of the driver, and the host waits for it
    if (is_captured(stream) && here != nullptr && !is_pinned(here, num_bytes))
        return break_capture(cudaErrorStreamCaptureUnsupported);
    const int error = enqueue(
        node_kind::copy,
        [=]
        {
            if (kind == cudaMemcpyHostToDevice) refuse_host_addresses("a copy to the device", from, num_bytes);
            std::memcpy(to, from, num_bytes);
        },
        stream);
    if (error != cudaSuccess) return static_cast<cudaError_t>(error);
    return the_device().is_lost ? remember(cudaErrorIllegalAddress) : cudaSuccess;
}

cudaError_t cudaMemcpy(void *to, const void *from, size_t num_bytes, cudaMemcpyKind kind)
{
    if (is_capturing()) return break_capture(cudaErrorStreamCaptureImplicit);
    drain();
    if (num_bytes == 0) return cudaSuccess;
    if (the_device().is_lost) return remember(cudaErrorIllegalAddress);
    check_kind(to, from, kind);
    if (kind == cudaMemcpyHostToDevice) refuse_host_addresses("a copy to the device", from, num_bytes);
    // at once, and without showing all the rest of the memory
    const allocation_entry *touched[2] = {find_allocation(to), find_allocation(from)};
    for (const allocation_entry *entry : touched)
        if (entry != nullptr) set_visible(entry->first, entry->second, true);
    std::memcpy(to, from, num_bytes);
    for (const allocation_entry *entry : touched)
        if (entry != nullptr) set_visible(entry->first, entry->second, false);
    return cudaSuccess;
}

cudaError_t cudaMemsetAsync(void *address, int value, size_t num_bytes, cudaStream_t stream)
{
    if (num_bytes == 0) return cudaSuccess;
    if (!is_of_device(address)) fail("cudaMemset of host memory");
    const int error = enqueue(
        node_kind::set, [=] { std::memset(address, value, num_bytes); }, stream);
    if (error != cudaSuccess) return static_cast<cudaError_t>(error);
    return the_device().is_lost ? remember(cudaErrorIllegalAddress) : cudaSuccess;
}

cudaError_t cudaMemset(void *address, int value, size_t num_bytes)
{
    return cudaMemsetAsync(address, value, num_bytes, nullptr); // which may return before it is done
}
