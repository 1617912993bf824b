/// \file sanitizers.h
/// What the sanitizers are told about fibers and device memory. Nothing in builds without them.
#ifndef CUDA_ON_CPU_SANITIZERS_H
#define CUDA_ON_CPU_SANITIZERS_H

#include <cstddef>

#ifdef CUDA_ON_CPU_ADDRESS
#include <sanitizer/asan_interface.h>
#include <sanitizer/common_interface_defs.h>
#endif
#ifdef CUDA_ON_CPU_RACES
#include <sanitizer/tsan_interface.h>
#endif

namespace cuda_on_cpu
{

/// Before a switch to another stack; *own_fake_stack is for the return, NULL if there is none.
inline void address_depart([[maybe_unused]] void **own_fake_stack, [[maybe_unused]] const void *bottom,
                           [[maybe_unused]] size_t size)
{
#ifdef CUDA_ON_CPU_ADDRESS
    __sanitizer_start_switch_fiber(own_fake_stack, bottom, size);
#endif
}
/// After a switch, with where it came from.
inline void address_arrive([[maybe_unused]] void *own_fake_stack, [[maybe_unused]] const void **bottom_from,
                           [[maybe_unused]] size_t *size_from)
{
#ifdef CUDA_ON_CPU_ADDRESS
    __sanitizer_finish_switch_fiber(own_fake_stack, bottom_from, size_from);
#endif
}

inline void hide([[maybe_unused]] const void *address, [[maybe_unused]] size_t num_bytes)
{
#ifdef CUDA_ON_CPU_ADDRESS
    __asan_poison_memory_region(address, num_bytes);
#endif
}
inline void show([[maybe_unused]] const void *address, [[maybe_unused]] size_t num_bytes)
{
#ifdef CUDA_ON_CPU_ADDRESS
    __asan_unpoison_memory_region(address, num_bytes);
#endif
}

inline void *race_current_fiber()
{
#ifdef CUDA_ON_CPU_RACES
    return __tsan_get_current_fiber();
#else
    return nullptr;
#endif
}
inline void *race_create_fiber()
{
#ifdef CUDA_ON_CPU_RACES
    return __tsan_create_fiber(0);
#else
    return nullptr;
#endif
}
/// Switches without ordering memory.
inline void race_switch([[maybe_unused]] void *fiber)
{
#ifdef CUDA_ON_CPU_RACES
    __tsan_switch_to_fiber(fiber, __tsan_switch_to_fiber_no_sync);
#endif
}
inline void race_release([[maybe_unused]] const void *address)
{
#ifdef CUDA_ON_CPU_RACES
    __tsan_release(const_cast<void *>(address));
#endif
}
inline void race_acquire([[maybe_unused]] const void *address)
{
#ifdef CUDA_ON_CPU_RACES
    __tsan_acquire(const_cast<void *>(address));
#endif
}

} // namespace cuda_on_cpu

#endif
