/// \file nearest_name.h
/// The known name that was probably meant.
#ifndef SCREE_NEAREST_NAME_H
#define SCREE_NEAREST_NAME_H

/// Number of letters to insert, remove, replace or swap with their neighbour to turn one text into the other (optimal
/// string alignment); letters beyond the 63rd are not looked at.
int scree_name_distance(const char *a, const char *b);
/// True if the distance is so small that a slip is likely: at most a third of the letters.
int scree_name_is_near(const char *name, const char *known);
/// The nearest of (num) names; NULL if none is near.
const char *scree_nearest_name(const char *name, const char *const *known, int num);

#endif
