/// \file state.h
/// What a simulation is made of: constant data, moving state, scratch. Shared by dynamics and io only.
#ifndef SCREE_STATE_H
#define SCREE_STATE_H

#include "bvh/broad_phase.h"
#include "contact/contact_list.h"
#include "contact/narrow_phase.h"
#include "dynamics/averages.h"
#include "dynamics/particles.h"
#include "dynamics/stage_clock.h"
#include "dynamics/wall_loads.h"
#include "dynamics/walls.h"
#include "forces/force_model.h"
#include "polyhedra/shape.h"
#include "scree/simulation.h"
#include "scree/types.h"

struct scree_simulation
{
    scree_device *device; ///< where the arrays that kernels work on lie, NULL: the CPU
    /// The same simulation with its arrays on a GPU, where the step is done; see on_device.h. NULL: it is done here.
    struct scree_simulation *there;
    int64_t observed_step; ///< of which what is there has been copied to the arrays here

    // constant: set by scree_simulation_create()
    const scree_scene *scene;      ///< borrowed; must outlive the simulation
    scree_shape *particle_shapes;  ///< (num_shapes) principal frames; entries not used by particles are {0}
    scree_shape *wall_shapes;      ///< (num_shapes) source frames; entries not used by walls are {0}
    scree_shape_view *shape_views; ///< (2 num_shapes) particle shapes, then wall shapes
    scree_shape_view *views_here;  ///< (2 num_shapes) on the CPU what shape_views holds on a GPU; else NULL
    scree_force_law *laws;         ///< (num_materials, num_materials)
    int32_t num_shapes;
    int32_t num_materials;
    int32_t num_walls;
    double time_step; ///< [s]

    // moving
    int64_t step; ///< number of steps done; time = step * time_step
    scree_particles particles;
    scree_wall_state *walls;     ///< (num_walls)
    scree_contact_list contacts; ///< of the present step
    scree_energies energies;     ///< accumulated parts; see simulation.h
    scree_counters counters;
    scree_averages averages;     ///< fields, collisions, works; nothing if the scene measures none
    scree_wall_loads wall_loads; ///< torques, forces and work of moving walls

    scree_stage_clock clock; ///< off unless somebody asks

    // scratch
    scree_scratch scratch;           ///< of a search of candidate pairs, and then of the contacts
    scree_contact_list old_contacts; ///< of the step before, for the history
    scree_broad_phase broad_phase;
    scree_narrow_phase narrow_phase;
    struct scree_step_buffers *buffers; ///< internal to dynamics
};

/// Call after the moving state has been replaced (restart): finds neighbours anew and ties the contacts' history to
/// them. contacts must be sorted by (i, j, patch).
scree_status scree_simulation_restored(scree_simulation *simulation, scree_report *report);

#endif
