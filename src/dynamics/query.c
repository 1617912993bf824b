/// \file query.c
/// What can be asked of a simulation between steps.
#include "core/hash.h"
#include "dynamics/step_buffers.h"

#include <math.h>

double scree_energies_balance(const scree_energies *e)
{
    return e->kinetic + e->rotational + e->potential + e->elastic_normal + e->elastic_tangential + e->damping +
           e->friction + e->hysteresis - e->input;
}

double scree_simulation_time(const scree_simulation *simulation)
{
    return (double)simulation->step * simulation->time_step;
}

double scree_simulation_observed_time(const scree_simulation *simulation)
{
    const int64_t step = simulation->there == NULL ? simulation->step : simulation->observed_step;
    return (double)step * simulation->time_step;
}

double scree_simulation_time_step(const scree_simulation *simulation) { return simulation->time_step; }

int64_t scree_simulation_num_steps(const scree_simulation *simulation)
{
    // an end that is a whole number of steps up to rounding gets no extra step
    return (int64_t)ceil(simulation->scene->time.end / simulation->time_step * (1 - 1e-12));
}

int64_t scree_simulation_num_particles(const scree_simulation *simulation)
{
    return simulation->particles.num_particles;
}

scree_energies scree_simulation_energies(const scree_simulation *simulation)
{
    scree_energies e = simulation->energies;
    const scree_particles *p = &simulation->particles;
    const double *g = simulation->scene->gravity;
    e.kinetic = e.rotational = e.potential = e.elastic_normal = e.elastic_tangential = 0;
    for (int64_t i = 0; i < p->num_particles; ++i)
    {
        const scree_vec3 v = p->velocity[i], x = p->position[i];
        const scree_vec3 w = scree_angular_velocity(p->angular_momentum[i], p->inertia[i], p->orientation[i]);
        const double mass = (double)p->mass[i];
        e.kinetic += 0.5 * mass * (double)scree_vec3_dot(v, v);
        e.rotational += 0.5 * (double)scree_vec3_dot(w, p->angular_momentum[i]);
        e.potential -= mass * (g[0] * (double)x.x + g[1] * (double)x.y + g[2] * (double)x.z);
    }
    const scree_contact_list *contacts = &simulation->contacts;
    for (int64_t c = 0; c < contacts->num_contacts; ++c)
    {
        e.elastic_normal += (double)contacts->elastic_energy[c];
        e.elastic_tangential += (double)contacts->spring_energy[c];
    }
    return e;
}

scree_counters scree_simulation_counters(const scree_simulation *simulation) { return simulation->counters; }

uint64_t scree_simulation_hash(const scree_simulation *simulation)
{
    const scree_particles *p = &simulation->particles;
    const scree_contact_list *contacts = &simulation->contacts;
    const size_t n = (size_t)p->num_particles, m = (size_t)contacts->num_contacts;
    uint64_t hash = scree_hash_bytes(0, &simulation->step, sizeof simulation->step);
    hash = scree_hash_bytes(hash, p->position, n * sizeof *p->position);
    hash = scree_hash_bytes(hash, p->orientation, n * sizeof *p->orientation);
    hash = scree_hash_bytes(hash, p->velocity, n * sizeof *p->velocity);
    hash = scree_hash_bytes(hash, p->angular_momentum, n * sizeof *p->angular_momentum);
    hash = scree_hash_bytes(hash, p->force, n * sizeof *p->force);
    hash = scree_hash_bytes(hash, p->torque, n * sizeof *p->torque);
    hash = scree_hash_bytes(hash, contacts->bodies, m * sizeof *contacts->bodies);
    hash = scree_hash_bytes(hash, contacts->torsion, m * sizeof *contacts->torsion);
    hash = scree_hash_bytes(hash, contacts->rolling_moment, m * sizeof *contacts->rolling_moment);
    hash = scree_hash_bytes(hash, contacts->spring_force, m * sizeof *contacts->spring_force);
    return scree_hash_bytes(hash, contacts->tangential_stiffness, m * sizeof *contacts->tangential_stiffness);
}
