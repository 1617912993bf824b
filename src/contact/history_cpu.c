#include "contact/history.h"

SCREE_DEFINE_LAUNCH(scree_history_match)
