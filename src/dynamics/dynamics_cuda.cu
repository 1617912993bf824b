#include "core/launch_cuda.cuh"
#include "dynamics/body_kernel.h"
#include "dynamics/integrator_kernel.h"
#include "dynamics/neighbour_kernel.h"
#include "dynamics/places_kernel.h"

SCREE_DEFINE_LAUNCH(scree_predict)
SCREE_DEFINE_LAUNCH(scree_correct)
SCREE_DEFINE_LAUNCH(scree_boxes)
SCREE_DEFINE_LAUNCH(scree_travel)
SCREE_DEFINE_LAUNCH(scree_skin)
SCREE_DEFINE_LAUNCH(scree_place_walls)
SCREE_DEFINE_LAUNCH(scree_place_particles)
SCREE_DEFINE_LAUNCH(scree_far_followers)
SCREE_DEFINE_LAUNCH(scree_home_order)
SCREE_DEFINE_LAUNCH(scree_new_places)
SCREE_DEFINE_LAUNCH(scree_move_pairs)
SCREE_DEFINE_LAUNCH(scree_group_sizes)
SCREE_DEFINE_LAUNCH(scree_sort_groups)
