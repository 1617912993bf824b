/// \file forces.h
/// Host side of the force stage: contact forces, their gathering to particles, their work.
#ifndef SCREE_FORCES_H
#define SCREE_FORCES_H

#include "core/launch_cpu.h"
#include "forces/collision_kernel.h"
#include "forces/contact_force_kernel.h"
#include "forces/gather_kernel.h"
#include "forces/step_sums_kernel.h"
#include "forces/wall_load_kernel.h"
#include "forces/work_kernel.h"

SCREE_DECLARE_LAUNCH(scree_contact_force)    ///< over contacts
SCREE_DECLARE_LAUNCH(scree_gather)           ///< over particles
SCREE_DECLARE_LAUNCH(scree_collision)        ///< over contacts
SCREE_DECLARE_LAUNCH(scree_ended_flag)       ///< over old contacts
SCREE_DECLARE_LAUNCH(scree_ended_collisions) ///< over old contacts
SCREE_DECLARE_LAUNCH(scree_wall_load)        ///< over blocks of SCREE_WALL_LOAD_BLOCK particles, times moving walls
SCREE_DECLARE_LAUNCH(scree_work)             ///< over blocks of SCREE_WORK_BLOCK particles
SCREE_DECLARE_LAUNCH(scree_work_reduce)      ///< over groups of SCREE_SUM_FAN_IN parts
SCREE_DECLARE_LAUNCH(scree_wall_load_reduce) ///< over groups of SCREE_SUM_FAN_IN parts, times moving walls
SCREE_DECLARE_LAUNCH(scree_indentations)     ///< over blocks of SCREE_CONTACT_BLOCK contacts

#endif
