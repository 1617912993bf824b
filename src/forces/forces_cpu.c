#include "forces/forces.h"

SCREE_DEFINE_LAUNCH(scree_collision)
SCREE_DEFINE_LAUNCH(scree_wall_load)
