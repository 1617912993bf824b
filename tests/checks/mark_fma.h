/// \file mark_fma.h
/// Included first by the check of the PTX: calls of fma() in the source become calls of a function that is defined
/// nowhere, so that every fma instruction left has been made by the compiler.
#ifndef SCREE_MARK_FMA_H
#define SCREE_MARK_FMA_H

#include <cuda_runtime.h>
#include <math.h>

extern "C" __host__ __device__ double scree_marked_fma(double a, double b, double c);
#define fma scree_marked_fma

#endif
