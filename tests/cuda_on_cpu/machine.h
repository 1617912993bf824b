/// \file machine.h
/// What the parts of the emulated device share: memory and errors, streams, threads. Internal to the emulator.
#ifndef CUDA_ON_CPU_MACHINE_H
#define CUDA_ON_CPU_MACHINE_H

#include "cuda_runtime.h"

namespace cuda_on_cpu
{

// ---- device.cpp

/// Keeps an error for cudaGetLastError().
cudaError_t remember(cudaError_t error);
/// Has a kernel had a fault? Then every call fails.
bool is_lost();
/// A launch as it is queued: the one that is to fail does.
std::function<void()> count_launch(std::function<void()> run);
/// Lets the host at all device memory, or keeps it away.
void set_all_visible(bool is_visible);

// ---- streams.cpp

/// For calls that wait, or that change what memory there is.
bool is_capturing();
bool is_captured(cudaStream_t stream);
/// A call that cannot be captured spoils the capture under way.
cudaError_t break_capture(cudaError_t error);

// ---- threads.cpp

/// Runs a kernel. Grids of different chains are not ordered by having run on the same threads.
void run_grid(const char *kernel, const launch_shape &shape, const std::function<void()> &body);
/// The chain of what runs from now on, from 0.
void set_chain(unsigned chain);

} // namespace cuda_on_cpu

#endif
