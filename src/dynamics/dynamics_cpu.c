#include "dynamics/dynamics.h"

SCREE_DEFINE_LAUNCH(scree_predict)
SCREE_DEFINE_LAUNCH(scree_correct)
SCREE_DEFINE_LAUNCH(scree_boxes)
