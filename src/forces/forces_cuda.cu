#include "core/launch_cuda.cuh"
#include "forces/collision_kernel.h"
#include "forces/contact_force_kernel.h"
#include "forces/gather_kernel.h"
#include "forces/step_sums_kernel.h"
#include "forces/wall_load_kernel.h"
#include "forces/work_kernel.h"

SCREE_DEFINE_LAUNCH(scree_contact_force)
SCREE_DEFINE_LAUNCH(scree_gather)
SCREE_DEFINE_LAUNCH(scree_collision)
SCREE_DEFINE_SUM_LAUNCH(scree_wall_load)
SCREE_DEFINE_SUM_LAUNCH(scree_work)
SCREE_DEFINE_SUM_LAUNCH(scree_work_reduce)
SCREE_DEFINE_SUM_LAUNCH(scree_ended)
SCREE_DEFINE_SUM_LAUNCH(scree_wall_load_reduce)
SCREE_DEFINE_SUM_LAUNCH(scree_indentations)
SCREE_DEFINE_LAUNCH(scree_ended_flag)
SCREE_DEFINE_LAUNCH(scree_ended_collisions)
