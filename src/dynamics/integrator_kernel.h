/// \file integrator_kernel.h
/// Velocity Verlet for translation, implicit midpoint on the unit quaternions for rotation.
///
/// The state of rotation is the angular momentum L in world axes: free motion keeps it to the last bit, torques change
/// it in half steps like velocities. Between the kicks the orientation follows q' = w q / 2, w = R I^-1 R^T L, through
/// the Cayley map of the midpoint: q1 = (1 + a)(1 - a)^-1 q0, a = w(q_mid) dt/4, q_mid along (1 + a) q0. The map is
/// symmetric in time, of second order, keeps |q| = 1 and needs no sine or cosine.
#ifndef SCREE_INTEGRATOR_KERNEL_H
#define SCREE_INTEGRATOR_KERNEL_H

#include "dynamics/neighbour_kernel.h"
#include "dynamics/particles.h"
#include "dynamics/step_tally.h"

/// More than enough: each round gains the factor |w| dt.
#define SCREE_ROTATION_MAX_ROUNDS 32

typedef struct scree_predict_args
{
    scree_particles particles;
    scree_real time_step;
    scree_ways ways;           ///< shape and travel of each
    scree_pose *pose;          ///< (num_particles) of the step before; out: pose at the end of the step
    scree_moving_body *moving; ///< (num_particles) out: estimates of the velocities at the end of the step, for damping
} scree_predict_args;

/// The Cayley map: (1 + a)(1 - a)^-1 q = (1 - |a|^2 + 2 a)/(1 + |a|^2) q; normalising takes care of the denominator
/// and of rounding.
SCREE_FN scree_quat scree_turned(scree_quat q, scree_vec3 a)
{
    const scree_quat turn = scree_quat_make(1 - scree_vec3_dot(a, a), 2 * a.x, 2 * a.y, 2 * a.z);
    return scree_quat_normalize(scree_quat_multiply(turn, q));
}

/// Orientation after dt of free rotation.
SCREE_FN scree_quat scree_rotate(scree_quat q, scree_vec3 angular_momentum, scree_vec3 inertia, scree_real dt)
{
    const scree_real quarter = dt * (scree_real)0.25;
    scree_vec3 a = scree_vec3_scale(scree_angular_velocity(angular_momentum, inertia, q), quarter);
    // a body that turns the same about all axes keeps its angular velocity
    const int max_rounds = scree_is_isotropic(inertia) ? 0 : SCREE_ROTATION_MAX_ROUNDS;
    for (int round = 0; round < max_rounds; ++round)
    {
        const scree_quat half = scree_quat_make(1, a.x, a.y, a.z);
        const scree_quat middle = scree_quat_normalize(scree_quat_multiply(half, q));
        const scree_vec3 next = scree_vec3_scale(scree_angular_velocity(angular_momentum, inertia, middle), quarter);
        const scree_vec3 change = scree_vec3_sub(next, a);
        a = next;
        if (scree_vec3_dot(change, change) <= 16 * SCREE_REAL_EPSILON * SCREE_REAL_EPSILON * scree_vec3_dot(a, a))
            break;
    }
    return scree_turned(q, a);
}

/// What moves of a particle.
typedef struct scree_moving_state
{
    scree_vec3 position;         ///< [m]
    scree_quat orientation;      ///< body frame to world
    scree_vec3 velocity;         ///< [m/s]
    scree_vec3 angular_momentum; ///< [kg m^2/s]
} scree_moving_state;

/// What acts on it, and its inertia.
typedef struct scree_load
{
    scree_vec3 force;   ///< [N]
    scree_vec3 torque;  ///< [N m]
    scree_real mass;    ///< [kg]
    scree_vec3 inertia; ///< [kg m^2]
} scree_load;

/// Velocities of a particle.
typedef struct scree_velocities
{
    scree_vec3 velocity;         ///< [m/s]
    scree_vec3 angular_velocity; ///< [rad/s]
} scree_velocities;

/// First half kick, then drift. Returns estimates of the velocities at the end of the step.
SCREE_FN scree_velocities scree_half_kick_and_drift(scree_moving_state *state, const scree_load *load,
                                                    bool is_isotropic, scree_real dt)
{
    const scree_real half = dt * (scree_real)0.5, half_over_mass = half / load->mass;
    state->velocity = scree_vec3_add_scaled(state->velocity, load->force, half_over_mass);
    state->angular_momentum = scree_vec3_add_scaled(state->angular_momentum, load->torque, half);
    state->position = scree_vec3_add_scaled(state->position, state->velocity, dt);
    const scree_vec3 end_momentum = scree_vec3_add_scaled(state->angular_momentum, load->torque, half);
    scree_velocities end;
    end.velocity = scree_vec3_add_scaled(state->velocity, load->force, half_over_mass);
    if (is_isotropic)
    {
        // as below, but one quotient and no matrices
        const scree_real inverse = 1 / load->inertia.x;
        const scree_vec3 turning = scree_vec3_scale(state->angular_momentum, inverse);
        state->orientation = scree_turned(state->orientation, scree_vec3_scale(turning, dt * (scree_real)0.25));
        end.angular_velocity = scree_vec3_scale(end_momentum, inverse);
    }
    else
    {
        state->orientation = scree_rotate(state->orientation, state->angular_momentum, load->inertia, dt);
        end.angular_velocity = scree_angular_velocity(end_momentum, load->inertia, state->orientation);
    }
    return end;
}

SCREE_FN scree_moving_state scree_state_of(const scree_particles *particles, int64_t i)
{
    scree_moving_state state;
    state.position = particles->position[i];
    state.orientation = particles->orientation[i];
    state.velocity = particles->velocity[i];
    state.angular_momentum = particles->angular_momentum[i];
    return state;
}

SCREE_FN scree_load scree_load_of(const scree_particles *particles, int64_t i)
{
    scree_load load;
    load.force = particles->force[i];
    load.torque = particles->torque[i];
    load.mass = particles->mass[i];
    load.inertia = particles->inertia[i];
    return load;
}

/// First half kick, then drift, of particle i.
SCREE_FN void scree_predict_at(scree_predict_args a, int64_t i)
{
    scree_moving_state state = scree_state_of(&a.particles, i);
    const scree_load load = scree_load_of(&a.particles, i);
    const scree_velocities end =
        scree_half_kick_and_drift(&state, &load, scree_is_isotropic(load.inertia), a.time_step);

    a.particles.position[i] = state.position;
    a.particles.orientation[i] = state.orientation;
    a.particles.velocity[i] = state.velocity;
    a.particles.angular_momentum[i] = state.angular_momentum;
    scree_pose pose;
    pose.position = state.position;
    pose.orientation = state.orientation;
    pose.scale = a.particles.scale[i];
    scree_add_way(&a.ways, i, a.pose + i, &pose);
    a.pose[i] = pose;
    a.moving[i].velocity = end.velocity;
    a.moving[i].angular_velocity = end.angular_velocity;
}

typedef struct scree_correct_args
{
    scree_particles particles;
    scree_real time_step;
    scree_moving_body *moving; ///< (num_particles) out: velocities at the end of the step
    const int32_t *ids;        ///< of the particles, or NULL: each is its own
    scree_step_tally *tally;   ///< learns of a particle whose position or momentum is not finite
} scree_correct_args;

SCREE_FN void scree_second_half_kick(scree_moving_state *state, const scree_load *load, scree_real dt)
{
    const scree_real half = dt * (scree_real)0.5;
    state->velocity = scree_vec3_add_scaled(state->velocity, load->force, half / load->mass);
    state->angular_momentum = scree_vec3_add_scaled(state->angular_momentum, load->torque, half);
}

/// Not a number or infinite if a part of the position or of the momentum is.
SCREE_FN scree_real scree_sum_of_state(const scree_moving_state *state)
{
    const scree_vec3 x = state->position, l = state->angular_momentum;
    return x.x + x.y + x.z + l.x + l.y + l.z;
}

/// Second half kick of particle i.
SCREE_FN void scree_correct_at(scree_correct_args a, int64_t i)
{
    scree_moving_state state = scree_state_of(&a.particles, i);
    const scree_load load = scree_load_of(&a.particles, i);
    scree_second_half_kick(&state, &load, a.time_step);

    a.particles.velocity[i] = state.velocity;
    a.particles.angular_momentum[i] = state.angular_momentum;
    a.moving[i].velocity = state.velocity;
    a.moving[i].angular_velocity = scree_angular_velocity(state.angular_momentum, load.inertia, state.orientation);
    const scree_real sum = scree_sum_of_state(&state);
    if (sum - sum == 0) return;
    const int64_t id = a.ids ? a.ids[i] : i;
    scree_atomic_max(&a.tally->num_from_unstable, (scree_real)(a.particles.num_particles - id));
}

#endif
