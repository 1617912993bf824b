/// \file integrator_kernel.h
/// Velocity Verlet for translation, implicit midpoint on the unit quaternions for rotation.
///
/// The state of rotation is the angular momentum L in world axes: free motion keeps it to the last bit, torques change
/// it in half steps like velocities. Between the kicks the orientation follows q' = w q / 2, w = R I^-1 R^T L, through
/// the Cayley map of the midpoint: q1 = (1 + a)(1 - a)^-1 q0, a = w(q_mid) dt/4, q_mid along (1 + a) q0. The map is
/// symmetric in time, of second order, keeps |q| = 1 and needs no sine or cosine.
#ifndef SCREE_INTEGRATOR_KERNEL_H
#define SCREE_INTEGRATOR_KERNEL_H

#include "dynamics/particles.h"
#include "dynamics/step_tally.h"

/// More than enough: each round gains the factor |w| dt.
#define SCREE_ROTATION_MAX_ROUNDS 32

typedef struct scree_predict_args
{
    scree_particles particles;
    scree_real time_step;
    scree_pose *pose;          ///< (num_particles) out: pose at the end of the step
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

/// First half kick, then drift, of particle i.
SCREE_FN void scree_predict_at(scree_predict_args a, int64_t i)
{
    const scree_real dt = a.time_step, half = dt * (scree_real)0.5;
    const scree_real half_over_mass = half / a.particles.mass[i];
    const scree_vec3 force = a.particles.force[i], torque = a.particles.torque[i];
    const scree_vec3 velocity = scree_vec3_add_scaled(a.particles.velocity[i], force, half_over_mass);
    const scree_vec3 momentum = scree_vec3_add_scaled(a.particles.angular_momentum[i], torque, half);
    const scree_vec3 position = scree_vec3_add_scaled(a.particles.position[i], velocity, dt);
    const scree_vec3 end_momentum = scree_vec3_add_scaled(momentum, torque, half);
    const scree_vec3 inertia = a.particles.inertia[i];
    scree_quat orientation;
    scree_vec3 angular_velocity;
    if (scree_is_isotropic(inertia))
    {
        // as below, but one quotient and no matrices
        const scree_real inverse = 1 / inertia.x;
        const scree_vec3 turning = scree_vec3_scale(momentum, inverse);
        orientation = scree_turned(a.particles.orientation[i], scree_vec3_scale(turning, dt * (scree_real)0.25));
        angular_velocity = scree_vec3_scale(end_momentum, inverse);
    }
    else
    {
        orientation = scree_rotate(a.particles.orientation[i], momentum, inertia, dt);
        angular_velocity = scree_angular_velocity(end_momentum, inertia, orientation);
    }
    a.particles.velocity[i] = velocity;
    a.particles.angular_momentum[i] = momentum;
    a.particles.position[i] = position;
    a.particles.orientation[i] = orientation;

    // where the body will be, and how fast if the forces stayed as they were: second order for damping too
    a.pose[i].position = position;
    a.pose[i].orientation = orientation;
    a.pose[i].scale = a.particles.scale[i];
    a.moving[i].velocity = scree_vec3_add_scaled(velocity, force, half_over_mass);
    a.moving[i].angular_velocity = angular_velocity;
}

typedef struct scree_correct_args
{
    scree_particles particles;
    scree_real time_step;
    scree_moving_body *moving; ///< (num_particles) out: velocities at the end of the step
    scree_step_tally *tally;   ///< learns of a particle whose position or momentum is not finite
} scree_correct_args;

/// Second half kick of particle i.
SCREE_FN void scree_correct_at(scree_correct_args a, int64_t i)
{
    const scree_real half = a.time_step * (scree_real)0.5;
    const scree_vec3 velocity =
        scree_vec3_add_scaled(a.particles.velocity[i], a.particles.force[i], half / a.particles.mass[i]);
    const scree_vec3 momentum = scree_vec3_add_scaled(a.particles.angular_momentum[i], a.particles.torque[i], half);
    const scree_vec3 x = a.particles.position[i];
    a.particles.velocity[i] = velocity;
    a.particles.angular_momentum[i] = momentum;
    a.moving[i].velocity = velocity;
    const scree_real sum = x.x + x.y + x.z + momentum.x + momentum.y + momentum.z;
    if (!(sum - sum == 0)) scree_atomic_max(&a.tally->num_from_unstable, (scree_real)(a.particles.num_particles - i));
    a.moving[i].angular_velocity = scree_angular_velocity(momentum, a.particles.inertia[i], a.particles.orientation[i]);
}

#endif
