/// \file step_buffers.h
/// Scratch of the step and the arrays over all bodies: particles first, then walls. Internal to dynamics.
#ifndef SCREE_STEP_BUFFERS_H
#define SCREE_STEP_BUFFERS_H

#include "dynamics/body_kernel.h"
#include "dynamics/places.h"
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
    bool has_travel;           ///< some particles are meshes, so travel is kept
    scree_real *travel;        ///< [m] (num_bodies) bound of the way of any point of the body since the last search
    scree_broad_phase_wall *broad_phase_walls; ///< (num_walls)
    scree_broad_phase_wall *wall_input;        ///< (num_walls) the same, of the last search, on the CPU
    scree_real skin;                           ///< [m] of the last search
    double mean_radius;                        ///< [m] of the particles' bounding spheres
    scree_real moved;                          ///< [m] way of the fastest bodies between it and the present step
    int64_t searched_step;                     ///< step of the last search
    bool has_pairs;                            ///< false: search before the next step, and nothing is known of pairs
    bool is_search_asked;                      ///< search before the next step, though the skin may be wide enough

    scree_places places;

    // walls
    scree_wall_motion *wall_motion;      ///< (num_walls)
    scree_wall_motion *wall_motion_here; ///< the same on the CPU, of the present step

    // moving walls
    scree_wall_axis *wall_axes;      ///< (num_moving_walls)
    scree_wall_axis *wall_axes_here; ///< the same on the CPU
    int32_t *moving_wall_here;       ///< (num_walls) index among the moving ones, or -1, on the CPU
    int32_t num_moving_walls;
    scree_real *load_sums; ///< of blocks of particles, and of these sums

    // contacts
    bool is_old_list_of_same_pairs; ///< old contacts can be found by the index of their candidate pair
    int32_t *old_groups;            ///< (2, num_bodies) if not: where those of each first body begin and end
    int32_t *old_of_contact;
    int64_t max_contacts;
    uint8_t *is_continued;
    int64_t max_old;
    scree_contact_side *sides;  ///< (num_contacts, 2) on a GPU; else NULL
    int64_t max_sides;          ///< contacts
    bool has_old_groups;        ///< old_groups were made for the present step
    scree_work_sums *work_sums; ///< of blocks of particles, and of these sums

    scree_step_board *board;
    scree_step_board *board_here; ///< a copy on the CPU, of the end of the last step
    scree_step_tally *tally;      ///< of the board

    // steps that are recorded, see recorded_step.c
    scree_live *live_here;                   ///< on the CPU, what a recording starts from
    scree_recording *recordings[2];          ///< of even and of odd steps, for the two contact lists change places
    bool is_recorded[2];                     ///< as things are now
    int64_t max_recorded;                    ///< contacts that they have room for
    int64_t num_halts[SCREE_HALT_START + 1]; ///< steps so far by where they went on from call by call

    int64_t first_unstable; ///< particle that was not finite at the end of the last step, or -1; on the CPU
} scree_step_buffers;

/// Allocates the arrays over bodies; num_walls from the simulation.
scree_status scree_step_buffers_create(scree_simulation *simulation);
/// The board, what is sent to the device in each step, and the sums that come to the board.
scree_status scree_step_board_create(scree_step_buffers *buffers, int64_t num_particles, int64_t num_walls);
/// Axes of the moving walls.
scree_status scree_wall_axes_create(scree_simulation *simulation);
void scree_step_buffers_destroy(scree_simulation *simulation);

// The stages of a step, in their order. All but scree_is_search_due() and scree_update_contacts() only ask for their
// work and do not wait.

/// Poses and velocities of the walls at `time`, on the CPU.
void scree_move_walls(scree_simulation *simulation, double time);
/// First half kick and drift of the particles; poses and velocities of the walls to the body arrays; their ways to the
/// travels of all bodies.
void scree_predict_motion(scree_simulation *simulation);
/// Poses and velocities of the walls to the body arrays.
void scree_place_walls(scree_simulation *simulation);
/// Poses and velocities of the particles, as they are, to the body arrays.
void scree_place_particles(scree_simulation *simulation);

/// Has a wall come or gone since the last search?
bool scree_have_walls_changed(const scree_simulation *simulation);
/// How far all bodies have moved since the last search to the tally.
void scree_follow_bodies(const scree_simulation *simulation);
/// Follows the bodies. May one have left its skin since the last search?
bool scree_is_search_due(scree_simulation *simulation);
/// Candidate pairs of the present poses.
scree_status scree_search_neighbours(scree_simulation *simulation);
/// Contacts of the present poses and which old ones they continue; old ones that ended leave their energy to the sums.
/// If contacts have no room, candidate pairs are searched first: no step without a search takes memory.
scree_status scree_update_contacts(scree_simulation *simulation);
/// Forces of the contacts, and the loads of the moving walls by them.
void scree_update_forces(scree_simulation *simulation);
/// These and gravity to the particles.
void scree_gather_forces(scree_simulation *simulation);
/// Second half kick.
void scree_correct_motion(scree_simulation *simulation);
/// Work of the contacts over the step just done.
void scree_sum_work(scree_simulation *simulation);
/// Loads of the moving walls by the present contacts.
void scree_sum_wall_loads(scree_simulation *simulation);
/// A copy of the board to the CPU.
void scree_fetch_board(scree_simulation *simulation);
/// Takes up what the kernels have left there, once it has come.
void scree_take_board(scree_simulation *simulation);

// What recorded steps share with the others.

/// scree_update_contacts() for the candidate pairs of the step before, after the lists have changed places.
void scree_update_contacts_again(scree_simulation *simulation);
/// What was found of the contacts to the counters.
void scree_count_contacts(scree_simulation *simulation);
/// Does the step as far as it can be played on a GPU. Returns where it must go on from, or SCREE_HALT_NONE.
scree_halt scree_play_step(scree_simulation *simulation);
void scree_forget_recordings(scree_step_buffers *buffers);

/// Where ways of bodies are added up.
scree_ways scree_step_ways(const scree_simulation *simulation);
/// The bodies as the narrow phase sees them.
scree_bodies scree_step_bodies(const scree_simulation *simulation);
scree_body_motion scree_step_body_motion(const scree_step_buffers *buffers);

#endif
