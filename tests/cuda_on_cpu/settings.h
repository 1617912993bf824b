/// \file settings.h
/// The emulated machine, from the environment: see README.md.
#ifndef CUDA_ON_CPU_SETTINGS_H
#define CUDA_ON_CPU_SETTINGS_H

#include <cstddef>

namespace cuda_on_cpu
{

enum class schedule
{
    fifo,
    lifo,
    random
};

struct machine_settings
{
    schedule order;
    unsigned seed;
    unsigned num_workers;
    int num_devices;
    int capability;    ///< 80 stands for 8.0
    int code;          ///< capability that kernels are compiled for, as machine code; 0: for all
    int driver;        ///< as cudaDriverGetVersion() tells it
    size_t memory;     ///< [bytes]
    long fault_at;     ///< number of the launch that fails, counted from 1; 0: none
    long no_memory_at; ///< number of the allocation from which on there is no memory, counted from 1; 0: none
};
const machine_settings &settings();

} // namespace cuda_on_cpu

#endif
