#include "dynamics/dynamics.h"

SCREE_DEFINE_LAUNCH(scree_boxes)
SCREE_DEFINE_LAUNCH(scree_skin)
SCREE_DEFINE_LAUNCH(scree_place_walls)
SCREE_DEFINE_LAUNCH(scree_place_particles)
