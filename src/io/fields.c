/// \file fields.c
#include "io/fields.h"

#include <string.h>

#define SERIES(name, unit, text, type, member)                        \
    {                                                                 \
        name, unit, text, type, 1, offsetof(scree_series_row, member) \
    }
#define ENERGY(member, text) SERIES(#member, "J", text, SCREE_FIELD_DOUBLE, energies.member)

static const scree_field series_fields[] = {
    SERIES("time", "s", "simulated time", SCREE_FIELD_DOUBLE, time),
    SERIES("step", "1", "steps done", SCREE_FIELD_INT64, step),
    ENERGY(kinetic, "kinetic energy of translation"),
    ENERGY(rotational, "kinetic energy of rotation"),
    ENERGY(potential, "potential energy of gravity, zero at the origin"),
    ENERGY(elastic_normal, "stored in the normal springs of present contacts"),
    ENERGY(elastic_tangential, "stored in the tangential, torsion and rolling springs of present contacts"),
    ENERGY(damping, "dissipated by damping so far"),
    ENERGY(friction, "dissipated by slip and lost tangential springs so far"),
    ENERGY(hysteresis, "work against the elastic normal forces that elastic_normal did not take up, so far"),
    ENERGY(input, "put in by moving walls so far"),
    SERIES("balance", "J", "all of the above, input with a minus: stays what it was at the start", SCREE_FIELD_DOUBLE,
           balance),
    SERIES("pairs", "1", "candidate pairs", SCREE_FIELD_INT64, counters.num_pairs),
    SERIES("contacts", "1", "contacts", SCREE_FIELD_INT64, counters.num_contacts),
    SERIES("coordination_number", "1", "mean number of contacts per particle, walls counted", SCREE_FIELD_DOUBLE,
           coordination_number),
    SERIES("rebuilds", "1", "neighbour searches so far", SCREE_FIELD_INT64, counters.num_rebuilds),
    SERIES("without_normal", "1", "overlaps above rounding without a normal, hence without a force, so far",
           SCREE_FIELD_INT64, counters.num_without_normal),
    SERIES("inside", "1", "centres of spheres met inside the solid of a mesh so far, step by step", SCREE_FIELD_INT64,
           counters.num_inside),
    SERIES("fallbacks", "1", "overlaps repeated with the hierarchy so far", SCREE_FIELD_INT64, counters.num_fallbacks),
    SERIES("worst_residual", "1", "worst certificate of an overlap so far", SCREE_FIELD_DOUBLE,
           counters.worst_residual),
    SERIES("largest_indentation", "m", "largest indentation so far", SCREE_FIELD_DOUBLE, counters.largest_indentation),
    SERIES("smallest_critical_step", "s", "smallest critical time step of a contact so far", SCREE_FIELD_DOUBLE,
           counters.smallest_critical_step),
};

#define PARTICLE(member, unit, text, type, components)                           \
    {                                                                            \
#member, unit, text, type, components, offsetof(scree_particles, member) \
    }

static const scree_field particle_fields[] = {
    PARTICLE(position, "m", "centroid", SCREE_FIELD_REAL, 3),
    PARTICLE(orientation, "1", "quaternion w, x, y, z from principal axes to world axes", SCREE_FIELD_REAL, 4),
    PARTICLE(velocity, "m/s", "velocity of the centroid", SCREE_FIELD_REAL, 3),
    PARTICLE(angular_momentum, "kg m^2/s", "about the centroid, world axes", SCREE_FIELD_REAL, 3),
    PARTICLE(force, "N", "sum of contacts and gravity", SCREE_FIELD_REAL, 3),
    PARTICLE(torque, "N m", "sum of contacts, about the centroid, world axes", SCREE_FIELD_REAL, 3),
    PARTICLE(scale, "1", "size over the size of the shape", SCREE_FIELD_REAL, 1),
    PARTICLE(mass, "kg", "mass", SCREE_FIELD_REAL, 1),
    PARTICLE(inertia, "kg m^2", "principal moments of inertia", SCREE_FIELD_REAL, 3),
    PARTICLE(shape, "1", "index of the shape in the scene", SCREE_FIELD_INT32, 1),
    PARTICLE(material, "1", "index of the material in the scene", SCREE_FIELD_INT32, 1),
    PARTICLE(group, "1", "index of the particle group in the scene", SCREE_FIELD_INT32, 1),
};
enum
{
    NUM_MOVING_PARTICLE_FIELDS = 6
};

#define CONTACT(member, unit, text, type, components)                               \
    {                                                                               \
#member, unit, text, type, components, offsetof(scree_contact_list, member) \
    }

static const scree_field contact_fields[] = {
    CONTACT(bodies, "1", "ids i < j; j may be a wall: number of particles + index of the wall", SCREE_FIELD_INT32, 2),
    CONTACT(patch, "1", "of its part of the pair, in units of 2^15, plus index within that", SCREE_FIELD_INT32, 1),
    CONTACT(volume, "m^3", "overlap volume", SCREE_FIELD_REAL, 1),
    CONTACT(indentation, "m", "extent of the overlap along the normal", SCREE_FIELD_REAL, 1),
    CONTACT(radius, "m", "largest distance of a point of the overlap from the contact point, across the normal",
            SCREE_FIELD_REAL, 1),
    CONTACT(normal, "1", "unit vector from j towards i", SCREE_FIELD_REAL, 3),
    CONTACT(area_vector, "m^2",
            "area of i's surface inside j, outward from i; 0 unless a law of the scene is energy_conserving",
            SCREE_FIELD_REAL, 3),
    CONTACT(torque_vector, "m^3", "sum of x cross area over the same part, x from the contact point; likewise",
            SCREE_FIELD_REAL, 3),
    CONTACT(arm, "m", "contact point minus position of i", SCREE_FIELD_REAL, 3),
    CONTACT(normal_force, "N", "on i", SCREE_FIELD_REAL, 3),
    CONTACT(tangential_force, "N", "on i", SCREE_FIELD_REAL, 3),
    CONTACT(elastic_force, "N", "elastic part of the normal force", SCREE_FIELD_REAL, 1),
    CONTACT(moment, "N m", "on i: of the normal force, torsion, rocking, rolling resistance", SCREE_FIELD_REAL, 3),
    CONTACT(elastic_work, "J", "change of elastic_energy in the step", SCREE_FIELD_REAL, 1),
    CONTACT(spring_work, "J", "change of spring_energy in the step", SCREE_FIELD_REAL, 1),
    CONTACT(is_slipping, "1", "1 while the tangential force is at the Coulomb limit", SCREE_FIELD_UINT8, 1),
    CONTACT(is_turning, "1", "1 while torsion or rolling resistance is at its limit", SCREE_FIELD_UINT8, 1),
    CONTACT(spring_force, "N", "elastic part of the tangential force on i", SCREE_FIELD_REAL, 3),
    CONTACT(tangential_stiffness, "N/m", "of the last step", SCREE_FIELD_REAL, 1),
    CONTACT(torsion, "N m", "elastic part of the moment about the normal, on i", SCREE_FIELD_REAL, 1),
    CONTACT(rolling_moment, "N m", "elastic part of the rolling resistance on i", SCREE_FIELD_REAL, 3),
    CONTACT(elastic_energy, "J", "stored in the normal spring", SCREE_FIELD_REAL, 1),
    CONTACT(spring_energy, "J", "stored in the tangential, the torsion and the rolling spring", SCREE_FIELD_REAL, 1),
};

#define WALL(member, unit, text, type)                                   \
    {                                                                    \
#member, unit, text, type, 1, offsetof(scree_wall_loads, member) \
    }

static const scree_field wall_fields[] = {
    WALL(load, "N m or N", "torque or force on the particles along the wall's motion", SCREE_FIELD_DOUBLE),
    WALL(work, "J", "work done on the particles so far", SCREE_FIELD_DOUBLE),
    WALL(marked_work, "J", "work at the last whole revolution", SCREE_FIELD_DOUBLE),
    WALL(marked_step, "1", "step of the last whole revolution", SCREE_FIELD_INT64),
    WALL(revolution_power, "W", "mean power over the last whole revolution, 0 before the first", SCREE_FIELD_DOUBLE),
};

#define ITEM(structure, member, unit, text, type, components)              \
    {                                                                      \
#member, unit, text, type, components, offsetof(structure, member) \
    }

static const scree_field grid_fields[] = {
    ITEM(scree_grid_sums, volume, "m^3", "sum over samples of the volume of particles", SCREE_FIELD_DOUBLE, 1),
    ITEM(scree_grid_sums, mass, "kg", "of their mass", SCREE_FIELD_DOUBLE, 1),
    ITEM(scree_grid_sums, momentum, "kg m/s", "of their momentum", SCREE_FIELD_DOUBLE, 3),
    ITEM(scree_grid_sums, speed, "kg m/s", "of mass times speed", SCREE_FIELD_DOUBLE, 1),
    ITEM(scree_grid_sums, square, "kg m^2/s^2", "of mass times speed squared", SCREE_FIELD_DOUBLE, 1),
};

static const scree_field spectrum_fields[] = {
    ITEM(scree_spectrum, count_normal, "1", "collisions by their normal energy", SCREE_FIELD_INT64, 1),
    ITEM(scree_spectrum, count_tangential, "1", "collisions by their tangential energy", SCREE_FIELD_INT64, 1),
    ITEM(scree_spectrum, energy_normal, "J", "normal energy of the collisions of count_normal", SCREE_FIELD_DOUBLE, 1),
    ITEM(scree_spectrum, energy_tangential, "J", "tangential energy of the collisions of count_tangential",
         SCREE_FIELD_DOUBLE, 1),
};

static const scree_field collision_fields[] = {
    ITEM(scree_collisions, normal, "J", "work against the normal forces of the contact so far", SCREE_FIELD_DOUBLE, 1),
    ITEM(scree_collisions, tangential, "J", "against its tangential forces and moments", SCREE_FIELD_DOUBLE, 1),
};

static const scree_field period_work_fields[] = {
    ITEM(scree_period_works, start, "J", "work of the wall at the start of the period under way", SCREE_FIELD_DOUBLE,
         1),
    ITEM(scree_period_works, total, "J", "work of the wall in all whole periods", SCREE_FIELD_DOUBLE, 1),
};

// an array that is added to the particles or contacts must be added to its table, or a restart would lose it
_Static_assert(sizeof(scree_particles) == offsetof(scree_particles, position) +
                                              sizeof particle_fields / sizeof particle_fields[0] * sizeof(void *),
               "add the new array to particle_fields");
_Static_assert(sizeof(scree_contact_list) == offsetof(scree_contact_list, bodies) +
                                                 sizeof contact_fields / sizeof contact_fields[0] * sizeof(void *),
               "add the new array to contact_fields");
_Static_assert(sizeof(scree_wall_loads) ==
                   offsetof(scree_wall_loads, load) + sizeof wall_fields / sizeof wall_fields[0] * sizeof(void *),
               "add the new array to wall_fields");
_Static_assert(sizeof(scree_grid_sums) ==
                   offsetof(scree_grid_sums, volume) + sizeof grid_fields / sizeof grid_fields[0] * sizeof(void *),
               "add the new array to grid_fields");
_Static_assert(sizeof(scree_spectrum) == offsetof(scree_spectrum, count_normal) +
                                             sizeof spectrum_fields / sizeof spectrum_fields[0] * sizeof(void *),
               "add the new array to spectrum_fields");

const scree_field scree_frame_particle = {"particle", "1", "id of the particle", SCREE_FIELD_INT32, 1, 0};
const scree_field scree_frame_group = {"group",           "1", "index of the particle group in the scene",
                                       SCREE_FIELD_INT32, 1,   0};
const scree_field scree_frame_speed = {"speed", "m/s", "speed of the particle's centroid", SCREE_FIELD_FLOAT, 1, 0};
const scree_field scree_frame_radius = {"radius", "m", "radius of the sphere", SCREE_FIELD_FLOAT, 1, 0};
const scree_field scree_frame_velocity = {"velocity", "m/s", "velocity of the centre", SCREE_FIELD_FLOAT, 3, 0};
const scree_field scree_frame_wall = {"wall", "1", "index of the wall in the scene", SCREE_FIELD_INT32, 1, 0};
const scree_field scree_frame_i = {"i", "1", "id of the first particle", SCREE_FIELD_INT32, 1, 0};
const scree_field scree_frame_j = {
    "j", "1", "id of the second particle, or number of particles + index of the wall", SCREE_FIELD_INT32, 1, 0};
const scree_field scree_frame_normal_force = {
    "normal_force", "N", "length of the normal force, negative if it attracts", SCREE_FIELD_FLOAT, 1, 0};
const scree_field scree_frame_tangential_force = {"tangential_force", "N", "length of the tangential force",
                                                  SCREE_FIELD_FLOAT,  1,   0};
const scree_field scree_frame_indentation = {"indentation",     "m", "extent of the overlap along the normal",
                                             SCREE_FIELD_FLOAT, 1,   0};
const scree_field scree_frame_volume = {"volume", "m^3", "overlap volume", SCREE_FIELD_FLOAT, 1, 0};
const scree_field scree_frame_slipping = {"slipping", "1", "1 at the Coulomb limit", SCREE_FIELD_UINT8, 1, 0};

const scree_field *scree_series_fields(int *num_fields)
{
    *num_fields = (int)(sizeof series_fields / sizeof series_fields[0]);
    return series_fields;
}

const scree_field *scree_particle_fields(int *num_fields)
{
    *num_fields = (int)(sizeof particle_fields / sizeof particle_fields[0]);
    return particle_fields;
}

int scree_num_moving_particle_fields(void) { return NUM_MOVING_PARTICLE_FIELDS; }

const scree_field *scree_contact_fields(int *num_fields)
{
    *num_fields = (int)(sizeof contact_fields / sizeof contact_fields[0]);
    return contact_fields;
}

const scree_field *scree_wall_fields(int *num_fields)
{
    *num_fields = (int)(sizeof wall_fields / sizeof wall_fields[0]);
    return wall_fields;
}

const scree_field *scree_grid_fields(int *num_fields)
{
    *num_fields = (int)(sizeof grid_fields / sizeof grid_fields[0]);
    return grid_fields;
}

const scree_field *scree_spectrum_fields(int *num_fields)
{
    *num_fields = (int)(sizeof spectrum_fields / sizeof spectrum_fields[0]);
    return spectrum_fields;
}

const scree_field *scree_collision_fields(int *num_fields)
{
    *num_fields = (int)(sizeof collision_fields / sizeof collision_fields[0]);
    return collision_fields;
}

const scree_field *scree_period_work_fields(int *num_fields)
{
    *num_fields = (int)(sizeof period_work_fields / sizeof period_work_fields[0]);
    return period_work_fields;
}

size_t scree_field_size(const scree_field *field)
{
    static const size_t sizes[] = {sizeof(scree_real), sizeof(double),  sizeof(float),
                                   sizeof(int32_t),    sizeof(int64_t), sizeof(uint8_t)};
    return sizes[field->type] * (size_t)field->num_components;
}

void *scree_field_array(const scree_field *field, const void *structure)
{
    void *array;
    memcpy(&array, (const char *)structure + field->offset, sizeof array);
    return array;
}

double scree_field_value(const scree_field *field, const void *structure)
{
    const char *place = (const char *)structure + field->offset;
    if (field->type == SCREE_FIELD_INT64)
    {
        int64_t value;
        memcpy(&value, place, sizeof value);
        return (double)value;
    }
    double value;
    memcpy(&value, place, sizeof value);
    return value;
}

/// Contacts per particle: one between particles belongs to both, one with a wall to one.
static double coordination_number(const scree_simulation *simulation)
{
    const int64_t num_particles = simulation->particles.num_particles;
    if (num_particles == 0) return 0;
    int64_t num_ends = 0;
    for (int64_t c = 0; c < simulation->contacts.num_contacts; ++c)
        num_ends += simulation->contacts.bodies[c].j < num_particles ? 2 : 1;
    return (double)num_ends / (double)num_particles;
}

scree_series_row scree_series_row_of(const scree_simulation *simulation)
{
    scree_series_row row;
    row.time = scree_simulation_time(simulation);
    row.step = simulation->step;
    row.energies = scree_simulation_energies(simulation);
    row.balance = scree_energies_balance(&row.energies);
    row.counters = scree_simulation_counters(simulation);
    row.coordination_number = coordination_number(simulation);
    return row;
}
