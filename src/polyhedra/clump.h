/// \file clump.h
/// Clumps: rigid bodies made of overlapping spheres, the usual rival of polyhedra.
///
/// A clump is the union of its spheres: mass, centroid and inertia are those of the union at uniform density. Contacts
/// are another matter, see sphere_pairs_kernel.h: where spheres overlap each of them pushes.
#ifndef SCREE_CLUMP_H
#define SCREE_CLUMP_H

#include "polyhedra/shape.h"
#include "scree/types.h"

/// As many as a patch can tell apart, see SCREE_PATCH_BITS.
#define SCREE_CLUMP_MAX_SPHERES 256

typedef enum scree_clump_fault_kind
{
    SCREE_CLUMP_GOOD,
    SCREE_CLUMP_EMPTY,
    SCREE_CLUMP_TOO_MANY,  ///< spheres
    SCREE_CLUMP_NO_RADIUS, ///< sphere `first` has a radius that is not above 0
    SCREE_CLUMP_HIDDEN,    ///< sphere `first` is wholly inside sphere `second`, or the same
    SCREE_CLUMP_APART      ///< no chain of overlapping spheres leads from sphere 0 to sphere `first`
} scree_clump_fault_kind;

/// The first thing wrong with a clump.
typedef struct scree_clump_fault
{
    scree_clump_fault_kind kind;
    int32_t first, second;
    double
        gap; ///< [m] of APART: from sphere `first` and what hangs on it to sphere `second`, the nearest of the others
} scree_clump_fault;

scree_clump_fault scree_clump_check(const scree_clump_sphere *spheres, int32_t num);
/// What is wrong and what to do about it, for behind "spheres of ...". "" if nothing is.
void scree_clump_describe_fault(const scree_clump_fault *fault, char *text, size_t size);

/// The clump in the frame of its principal axes; a clump of one is a sphere. Precondition: the check found nothing.
/// SCREE_OUT_OF_MEMORY.
scree_status scree_shape_create_clump(scree_shape *shape, const scree_clump_sphere *spheres, int32_t num);

/// Most spheres that a plane touches at once: those within `depth` [m] below a plane that rests on the clump, over many
/// directions and the planes on three spheres near each of them. A lower bound of the true number.
int32_t scree_clump_num_supports(const scree_shape_view *shape, double depth);

#endif
