/// \file start_check.h
/// Is the state at time 0 one that a run can start from?
#ifndef SCREE_START_CHECK_H
#define SCREE_START_CHECK_H

#include "dynamics/state.h"

/// Call with bodies placed and contacts found. Refused: particles too deep in others or inside another body, spheres
/// with the same centre, particles outside of a closed vessel, of one wall or of several that hold most particles, or
/// that would fly past all walls for ever.
scree_status scree_check_start(const scree_simulation *simulation, scree_report *report);

/// The first of these: bodies that start in each other, their number to *num_faults. SCREE_OUT_OF_MEMORY.
scree_status scree_check_overlaps(const scree_simulation *simulation, scree_report *report, int64_t *num_faults);

/// Particles of one fault that are named; the others are counted.
#define SCREE_MAX_TOLD 5

/// "particle 3 of "fill" at (1, 2, 3)" or "wall "floor""
typedef struct scree_body_text
{
    char text[400];
} scree_body_text;

/// Counts those of `num` particles that were not named.
void scree_tell_more(scree_report *report, int64_t num, const char *what);

/// Of a particle, or of wall `body` - num_particles.
scree_body_text scree_describe_body(const scree_simulation *simulation, int64_t body);

/// A ball that no surface of a mesh comes into: what is true of its centre is true of all points in it, which saves
/// looking for the surface again.
typedef struct scree_clear_ball
{
    scree_vec3 centre;
    double radius; ///< [m] distance of the surface; 0: nothing is known
} scree_clear_ball;

/// Is another ball inside?
bool scree_is_in_clear_ball(const scree_clear_ball *clear, scree_vec3 centre, double radius);

/// How far a point is below the surface of the mesh of a body [m]; negative outside; -INFINITY farther than `reach`
/// from its box, and of a body without a mesh. *normal is that of the nearest surface, outwards; NULL: not asked for.
double scree_depth_in_mesh(const scree_simulation *simulation, int64_t body, scree_vec3 point, double reach,
                           scree_vec3 *normal);

/// Refused: walls that reach into each other and move differently, unless one opens or bears the other, as an end plate
/// a shaft or a cylinder its piston. Told: walls that touch at the start and part later. Call with walls placed.
scree_status scree_check_walls(const scree_simulation *simulation, scree_report *report);

/// Which particles are in no closed vessel: is_outside (num_particles), not touched if no wall is one. `vessel` gets
/// the last wall that is, or -1. SCREE_OUT_OF_MEMORY.
scree_status scree_find_outside_of_vessels(const scree_simulation *simulation, int32_t *vessel, bool *is_outside);

/// Does the wall stay where it is, or turn there, and is there to the end? Others close no vessel.
bool scree_wall_stays(const scree_simulation *simulation, int32_t w);
/// Which particles could leave all walls that stay: is_outside (num_particles), of use if *num_inside > 0, the number
/// of particles that could not. 0 too where nothing can be told. SCREE_OUT_OF_MEMORY.
scree_status scree_find_outside_of_walls(const scree_simulation *simulation, int64_t *num_inside, bool *is_outside);

#endif
