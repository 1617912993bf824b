/// \file plan.h
/// What a simulation's arrays take.
#ifndef SCREE_PLAN_H
#define SCREE_PLAN_H

#include "dynamics/state.h"

/// Bytes of one item in all arrays.
typedef struct scree_plan_bytes
{
    size_t particle;
    size_t pair; ///< candidate pair of the kind that takes the most, without the contact that it may become
    size_t contact;
} scree_plan_bytes;

scree_plan_bytes scree_simulation_plan_bytes(const scree_simulation *simulation);

#endif
