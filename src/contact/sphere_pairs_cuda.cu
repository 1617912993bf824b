#include "contact/sphere_pairs_kernel.h"
#include "core/launch_cuda.cuh"

SCREE_DEFINE_LAUNCH(scree_sphere_sphere_count)
SCREE_DEFINE_LAUNCH(scree_sphere_sphere_write)
SCREE_DEFINE_LAUNCH(scree_sphere_mesh_count)
SCREE_DEFINE_LAUNCH(scree_sphere_mesh_write)
