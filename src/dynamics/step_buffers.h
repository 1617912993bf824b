/// \file step_buffers.h
/// Scratch of the step and the arrays over all bodies: particles first, then walls. Internal to dynamics.
#ifndef SCREE_STEP_BUFFERS_H
#define SCREE_STEP_BUFFERS_H

#include "dynamics/state.h"
#include "dynamics/step_tally.h"
#include "forces/forces.h"

/// All arrays lie where the simulation's do, unless stated.
typedef struct scree_step_buffers
{
    scree_device *device;

    // per body (num_bodies)
    scree_pose *pose;
    scree_moving_body *moving;
    scree_real *inverse_radius;
    int32_t *shape; ///< index into shape_views

    // neighbours
    scree_pose *searched_pose; ///< (num_bodies) poses of the last search
    scree_pose *last_pose;     ///< (num_bodies) poses of the last step
    bool has_travel;           ///< some particles are meshes, so travel is kept
    scree_real *travel;        ///< [m] (num_bodies) bound of the way of any point of the body since the last search
    scree_box *boxes;          ///< (num_particles)
    scree_vec3 *centres;       ///< (num_particles)
    scree_real *radii;         ///< (num_particles)
    scree_broad_phase_wall *broad_phase_walls; ///< (num_walls)
    scree_broad_phase_wall *wall_input;        ///< (num_walls) the same, of the last search, on the CPU
    scree_real skin;                           ///< [m] of the last search
    double mean_radius;                        ///< [m] of the particles' bounding spheres
    scree_real moved;                          ///< [m] way of the fastest bodies between it and the present step
    int64_t searched_step;                     ///< step of the last search
    bool has_pairs;                            ///< false: search before the next step, and nothing is known of pairs
    bool is_search_asked;                      ///< search before the next step, though the skin may be wide enough

    // moving walls
    int32_t *moving_wall;       ///< (num_walls) index among the moving ones, or -1
    scree_wall_axis *wall_axes; ///< (num_moving_walls)
    int32_t *moving_wall_here;  ///< the same two on the CPU
    scree_wall_axis *wall_axes_here;
    int32_t num_moving_walls;
    scree_real *load_sums;
    int64_t max_load_sums;

    // contacts
    bool is_old_list_of_same_pairs; ///< old contacts can be found by the index of their candidate pair
    int64_t *old_of_contact;
    int64_t max_contacts;
    uint8_t *is_continued;
    int64_t max_old;
    scree_work_sums *work_sums; ///< of blocks of ended contacts, of blocks of contacts, and of these sums
    int64_t max_work_sums;
    int64_t num_ended_blocks;

    scree_step_tally *tally;
    int64_t first_unstable; ///< particle that was not finite at the end of the last step, or -1; on the CPU
} scree_step_buffers;

/// Allocates the arrays over bodies; num_walls from the simulation.
scree_status scree_step_buffers_create(scree_simulation *simulation);
/// Axes of the moving walls.
scree_status scree_wall_axes_create(scree_simulation *simulation);
void scree_step_buffers_destroy(scree_simulation *simulation);

// The stages of a step, in their order.

/// First half kick and drift of the particles.
void scree_predict_motion(scree_simulation *simulation);
/// Poses and velocities of the walls at `time`, to the wall states and the body arrays.
void scree_place_walls(scree_simulation *simulation, double time);
/// Poses and velocities of the particles, as they are, to the body arrays.
void scree_place_particles(scree_simulation *simulation);

/// Searches candidate pairs if some body may have left its skin since the last search.
scree_status scree_update_neighbours(scree_simulation *simulation);
/// Contacts of the present poses and which old ones they continue; old ones that ended leave their energy to the sums.
scree_status scree_update_contacts(scree_simulation *simulation);
/// Forces of the contacts and of gravity on the particles.
scree_status scree_update_forces(scree_simulation *simulation);
/// Second half kick.
void scree_correct_motion(scree_simulation *simulation);
/// Work of the contacts over the step just done. Waits for all that was asked before.
scree_status scree_account_work(scree_simulation *simulation);
/// Takes up what the kernels have counted so far.
void scree_take_tally(scree_simulation *simulation);

/// The bodies as the narrow phase sees them.
scree_bodies scree_step_bodies(const scree_simulation *simulation);
scree_body_motion scree_step_body_motion(const scree_step_buffers *buffers);

#endif
