/// \file scene_schema.c
/// The tables of all keys of a scene; those of shapes: scene_schema_shapes.c.
#include "forces/force_parameters.h"
#include "io/schema_tables.h"

#include <string.h>

// --------------------------------------------------------------------------------------------------------------- time

static const cyaml_schema_field_t time_fields[] = {NUMBER(scree_time_def, end), NUMBER(scree_time_def, step),
                                                   NUMBER(scree_time_def, step_fraction), CYAML_FIELD_END};
static const scree_scene_key time_keys[] = {
    {.name = "end", .unit = "s", .min = 0, .max = MAX_TIME, .meaning = "simulated time; the run starts at 0"},
    {.name = "step",
     .unit = "s",
     .default_text = "auto",
     .special = "auto",
     .min = 1e-15,
     .max = 1e3,
     .meaning = "time step; auto: step_fraction of the critical step of the stiffest contact to expect"},
    {.name = "step_fraction",
     .unit = "1",
     .default_text = "0.5",
     .min = 1e-4,
     .max = 1,
     .meaning = "share of the critical step sqrt(m_eff/k_eff) that auto takes"},
};
static const scree_scene_section time_section = {"time", "How long and in which steps.", time_fields, time_keys,
                                                 COUNT(time_keys)};

// ---------------------------------------------------------------------------------------------------------- materials

static const cyaml_schema_field_t material_fields[] = {TEXT(scree_material_def, name),
                                                       NUMBER(scree_material_def, density),
                                                       NUMBER(scree_material_def, youngs_modulus),
                                                       NUMBER(scree_material_def, poisson_ratio),
                                                       NUMBER(scree_material_def, shear_modulus),
                                                       CYAML_FIELD_END};
static const scree_scene_key material_keys[] = {
    {.name = "name", .rule = SCREE_TEXT_NAME, .meaning = "what particles, walls and contact laws call it"},
    {.name = "density", .unit = "kg/m^3", .min = 1e-3, .max = 1e6, .meaning = "mass over volume of the solid"},
    {.name = "youngs_modulus", .unit = "Pa", .min = 1, .max = 1e13, .meaning = "stiffness of the solid"},
    {.name = "poisson_ratio", .unit = "1", .min = 0, .max = 0.5, .meaning = "lateral over axial strain"},
    {.name = "shear_modulus",
     .unit = "Pa",
     .default_text = "auto",
     .special = "auto",
     .min = 1,
     .max = 1e13,
     .meaning = "stiffness in shear; auto: youngs_modulus / (2 (1 + poisson_ratio))"},
};
static const scree_scene_section material_section = {"materials[]", "Solids that particles and walls are made of.",
                                                     material_fields, material_keys, COUNT(material_keys)};

// ------------------------------------------------------------------------------------------------------- contact laws

static const char *const force_model_names[] = {
#define SCREE_MODEL_NAME(model, name, exponent, text, source) name,
    SCREE_FORCE_MODELS(SCREE_MODEL_NAME)
#undef SCREE_MODEL_NAME
};
static const cyaml_strval_t shear_mixings[] = {{"mindlin", SCREE_SHEAR_MINDLIN}, {"bilock", SCREE_SHEAR_BILOCK}};
static const cyaml_strval_t rolling_resistances[] = {
    {"none", SCREE_ROLLING_NONE}, {"constant", SCREE_ROLLING_CONSTANT}, {"spring", SCREE_ROLLING_SPRING}};
#define LAW_NUMBER(name, unit, default_text, special, min, max, used_by, needed_by, meaning) \
    NUMBER(scree_contact_law_def, name),
static const cyaml_schema_field_t law_fields[] = {
    CYAML_FIELD_SEQUENCE_FIXED("materials", CYAML_FLAG_DEFAULT, scree_contact_law_def, materials, &name_value, 2),
    TEXT(scree_contact_law_def, model),
    SCREE_FORCE_PARAMETERS(LAW_NUMBER) WORD(scree_contact_law_def, rolling_resistance, rolling_resistances),
    TRUTH(scree_contact_law_def, attraction),
    TRUTH(scree_contact_law_def, contact_moments),
    WORD(scree_contact_law_def, shear_mixing, shear_mixings),
    CYAML_FIELD_END};
#define LAW_KEY(key_name, key_unit, key_default, key_special, key_min, key_max, used_by, needed_by, key_meaning) \
    {.name = #key_name,                                                                                          \
     .unit = key_unit,                                                                                           \
     .default_text = key_default,                                                                                \
     .special = key_special,                                                                                     \
     .min = key_min,                                                                                             \
     .max = key_max,                                                                                             \
     .meaning = key_meaning},
static const scree_scene_key law_keys[] = {
    {.name = "materials", .rule = SCREE_TEXT_NAME, .meaning = "names of the two materials, in any order"},
    {.name = "model",
     .default_text = "hertz_mindlin",
     .rule = SCREE_TEXT_WORD,
     .words = force_model_names,
     .num_words = COUNT(force_model_names),
     .meaning = "normal force; see the table below"},
    SCREE_FORCE_PARAMETERS(LAW_KEY) // what a model does not use is refused
    {.name = "rolling_resistance",
     .default_text = "none",
     .meaning = "moment against rolling after Ai et al. (2011): constant (type A) or a spring with limit (type C)"},
    {.name = "attraction",
     .default_text = "false",
     .meaning = "whether the total normal force may turn attractive when bodies separate"},
    {.name = "contact_moments",
     .default_text = "true",
     .meaning =
         "whether springs and dashpots are spread over the contact area and so resist twisting and rocking; false: "
         "the law of Bilock (2020), where a block spins on its face for ever"},
    {.name = "shear_mixing",
     .default_text = "mindlin",
     .meaning = "1/G* of the pair: mindlin (2 - nu)/G summed over both, or bilock (1 - nu^2)/G, eq. 4.11 of Bilock "
                "(2020)"},
};
static const scree_scene_section law_section = {
    "contact_laws[]", "Forces between two materials; every pair of materials that can meet needs one.", law_fields,
    law_keys, COUNT(law_keys)};

// ---------------------------------------------------------------------------------------------------------- particles

static const cyaml_strval_t size_distributions[] = {{"as_shape", SCREE_SIZE_AS_SHAPE},
                                                    {"fixed", SCREE_SIZE_FIXED},
                                                    {"uniform", SCREE_SIZE_UNIFORM},
                                                    {"normal", SCREE_SIZE_NORMAL}};
static const cyaml_schema_field_t size_fields[] = {WORD(scree_size_def, distribution, size_distributions),
                                                   NUMBER(scree_size_def, mean),
                                                   NUMBER(scree_size_def, deviation),
                                                   NUMBER(scree_size_def, min),
                                                   NUMBER(scree_size_def, max),
                                                   CYAML_FIELD_END};
static const scree_scene_key size_keys[] = {
    {.name = "distribution",
     .default_text = "as_shape",
     .meaning = "as_shape: all as large as the shape; fixed: all of size mean; uniform: between min and max; normal: "
                "mean and deviation, drawn again outside min to max"},
    {.name = "mean",
     .unit = "m",
     .default_text = "0",
     .min = 0,
     .max = MAX_POSITION,
     .meaning = "size of fixed, mean of normal"},
    {.name = "deviation",
     .unit = "m",
     .default_text = "0",
     .min = 0,
     .max = MAX_POSITION,
     .meaning = "standard deviation of normal before it is truncated"},
    {.name = "min",
     .unit = "m",
     .default_text = "0",
     .min = 0,
     .max = MAX_POSITION,
     .meaning = "smallest size of uniform and normal"},
    {.name = "max",
     .unit = "m",
     .default_text = "0",
     .min = 0,
     .max = MAX_POSITION,
     .meaning = "largest size of uniform and normal"},
};
static const scree_scene_section size_section = {
    "particles[].size",
    "Sizes of the particles of a group: the middle one of the three extents of a particle's box in its own axes.",
    size_fields, size_keys, COUNT(size_keys)};

static const cyaml_strval_t cylinder_axes[] = {
    {"none", SCREE_AXIS_NONE}, {"x", SCREE_AXIS_X}, {"y", SCREE_AXIS_Y}, {"z", SCREE_AXIS_Z}};
static const cyaml_schema_field_t region_fields[] = {NUMBERS(scree_region_def, min, 3),
                                                     NUMBERS(scree_region_def, max, 3),
                                                     WORD(scree_region_def, cylinder, cylinder_axes), CYAML_FIELD_END};
static const scree_scene_key region_keys[] = {
    {.name = "min",
     .unit = "m",
     .default_text = "[0, 0, 0]",
     .min = -MAX_POSITION,
     .max = MAX_POSITION,
     .meaning = "lower corner"},
    {.name = "max",
     .unit = "m",
     .default_text = "[0, 0, 0]",
     .min = -MAX_POSITION,
     .max = MAX_POSITION,
     .meaning = "upper corner"},
    {.name = "cylinder",
     .default_text = "none",
     .meaning = "x, y or z: only the cylinder along this axis in the middle of the box, as wide as it is narrow"},
};
static const scree_scene_section region_section = {
    "particles[].region",
    "Box, or cylinder, to fill on a lattice from the bottom up. Groups with the same region, number for number, are "
    "mixed: each cell has room for the largest particle of all and is given to one of them at random. Small particles "
    "share cells with others of their group if not all fit otherwise.",
    region_fields, region_keys, COUNT(region_keys)};

static const cyaml_schema_field_t body_fields[] = {
    NUMBERS(scree_body_def, position, 3), NUMBERS(scree_body_def, orientation, 4),      NUMBER(scree_body_def, size),
    NUMBERS(scree_body_def, velocity, 3), NUMBERS(scree_body_def, angular_velocity, 3), CYAML_FIELD_END};
static const scree_scene_key body_keys[] = {
    {.name = "position", .unit = "m", .min = -MAX_POSITION, .max = MAX_POSITION, .meaning = "of the centre of mass"},
    {.name = "orientation",
     .unit = "1",
     .default_text = "[1, 0, 0, 0]",
     .min = -1e3,
     .max = 1e3,
     .meaning = "quaternion (w, x, y, z) that turns the shape as its source gives it; brought to length 1"},
    {.name = "size",
     .unit = "m",
     .default_text = "auto",
     .special = "auto",
     .min = 1e-9,
     .max = MAX_POSITION,
     .meaning = "middle extent; auto: by the size section of the group"},
    {.name = "velocity",
     .unit = "m/s",
     .default_text = "[0, 0, 0]",
     .min = -MAX_VELOCITY,
     .max = MAX_VELOCITY,
     .meaning = "at the start"},
    {.name = "angular_velocity",
     .unit = "rad/s",
     .default_text = "[0, 0, 0]",
     .min = -1e7,
     .max = 1e7,
     .meaning = "at the start, along the axes of the world"},
};
static const scree_scene_section body_section = {"particles[].bodies[]", "Particles placed one by one.", body_fields,
                                                 body_keys, COUNT(body_keys)};
static const cyaml_schema_value_t body_value = {CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, scree_body_def, body_fields)};

static const cyaml_schema_field_t group_fields[] = {TEXT(scree_particle_group_def, name),
                                                    TEXT(scree_particle_group_def, shape),
                                                    TEXT(scree_particle_group_def, material),
                                                    SECTION(scree_particle_group_def, size, size_fields),
                                                    INTEGER(scree_particle_group_def, count),
                                                    NUMBER(scree_particle_group_def, mass),
                                                    SECTION(scree_particle_group_def, region, region_fields),
                                                    NUMBER(scree_particle_group_def, spacing),
                                                    INTEGER(scree_particle_group_def, seed),
                                                    NUMBERS(scree_particle_group_def, velocity, 3),
                                                    LIST(scree_particle_group_def, bodies, &body_value),
                                                    CYAML_FIELD_END};
static const scree_scene_key group_keys[] = {
    {.name = "name", .rule = SCREE_TEXT_NAME, .meaning = "for messages and --set"},
    {.name = "shape", .rule = SCREE_TEXT_NAME, .meaning = "name of a shape"},
    {.name = "material", .rule = SCREE_TEXT_NAME, .meaning = "name of a material"},
    {.name = "size", .default_text = "{}", .section = &size_section, .meaning = "distribution of sizes"},
    {.name = "count",
     .unit = "1",
     .default_text = "0",
     .min = 0,
     .max = 1e9,
     .meaning = "number of particles to fill in; give this, mass or bodies"},
    {.name = "mass",
     .unit = "kg",
     .default_text = "0",
     .min = 0,
     .max = 1e15,
     .meaning = "total mass to fill in: particles are added until it is reached"},
    {.name = "region", .default_text = "{}", .section = &region_section, .meaning = "what to fill"},
    {.name = "spacing",
     .unit = "1",
     .default_text = "1.05",
     .min = 1,
     .max = 1e3,
     .meaning = "lattice distance over the largest bounding diameter; the room that is left is used for jitter"},
    {.name = "seed",
     .unit = "1",
     .default_text = "0",
     .min = 0,
     .max = MAX_INTEGER,
     .meaning = "of sizes, orientations, jitter, and with the seeds of the others of who is where in a shared region"},
    {.name = "velocity",
     .unit = "m/s",
     .default_text = "[0, 0, 0]",
     .min = -MAX_VELOCITY,
     .max = MAX_VELOCITY,
     .meaning = "of filled particles at the start; bodies have their own"},
    {.name = "bodies",
     .default_text = "[]",
     .section = &body_section,
     .max = 1e7,
     .meaning = "particles placed by hand, instead of count or mass"},
};
static const scree_scene_section group_section = {
    "particles[]", "Groups of particles of one shape and material: filled into a region, or listed in bodies.",
    group_fields, group_keys, COUNT(group_keys)};

// -------------------------------------------------------------------------------------------------------------- walls

static const cyaml_strval_t motion_kinds[] = {
    {"fixed", SCREE_MOTION_FIXED}, {"translate", SCREE_MOTION_TRANSLATE}, {"rotate", SCREE_MOTION_ROTATE}};
static const cyaml_schema_field_t motion_fields[] = {WORD(scree_motion_def, kind, motion_kinds),
                                                     NUMBERS(scree_motion_def, velocity, 3),
                                                     NUMBERS(scree_motion_def, axis, 3),
                                                     NUMBERS(scree_motion_def, centre, 3),
                                                     NUMBER(scree_motion_def, angular_velocity),
                                                     NUMBER(scree_motion_def, start),
                                                     NUMBER(scree_motion_def, end),
                                                     TRUTH(scree_motion_def, opens),
                                                     CYAML_FIELD_END};
static const scree_scene_key motion_keys[] = {
    {.name = "kind", .default_text = "fixed", .meaning = "how the wall moves between start and end"},
    {.name = "velocity",
     .unit = "m/s",
     .default_text = "[0, 0, 0]",
     .min = -MAX_VELOCITY,
     .max = MAX_VELOCITY,
     .meaning = "of translate"},
    {.name = "axis",
     .default_text = "[0, 0, 0]",
     .min = -MAX_POSITION,
     .max = MAX_POSITION,
     .meaning = "of rotate: direction, of any length but zero"},
    {.name = "centre",
     .unit = "m",
     .default_text = "[0, 0, 0]",
     .min = -MAX_POSITION,
     .max = MAX_POSITION,
     .meaning = "of rotate: a point of the axis"},
    {.name = "angular_velocity",
     .unit = "rad/s",
     .default_text = "0",
     .min = -1e7,
     .max = 1e7,
     .meaning = "of rotate, positive by the right hand rule"},
    {.name = "start", .unit = "s", .default_text = "0", .min = 0, .max = MAX_TIME, .meaning = "at rest before"},
    {.name = "end",
     .unit = "s",
     .default_text = "never",
     .special = "never",
     .min = 0,
     .max = MAX_TIME,
     .meaning = "at rest from then on"},
    {.name = "opens",
     .default_text = "false",
     .meaning = "whether it is meant to part from walls that it touches or reaches into at the start, or to slide "
                "through them, as a door, a lid or a gate: if not, those that reach into each other are refused, "
                "and a run warns of those that touch and part"},
};
static const scree_scene_section motion_section = {"walls[].motion", "Prescribed motion of a wall.", motion_fields,
                                                   motion_keys, COUNT(motion_keys)};

static const cyaml_schema_field_t wall_fields[] = {TEXT(scree_wall_def, name),
                                                   TEXT(scree_wall_def, shape),
                                                   TEXT(scree_wall_def, material),
                                                   NUMBERS(scree_wall_def, position, 3),
                                                   NUMBERS(scree_wall_def, orientation, 4),
                                                   SECTION(scree_wall_def, motion, motion_fields),
                                                   NUMBER(scree_wall_def, removed_at),
                                                   CYAML_FIELD_END};
static const scree_scene_key wall_keys[] = {
    {.name = "name", .rule = SCREE_TEXT_NAME, .meaning = "for messages and --set"},
    {.name = "shape", .rule = SCREE_TEXT_NAME, .meaning = "name of a shape"},
    {.name = "material", .rule = SCREE_TEXT_NAME, .meaning = "name of a material; its density is not used"},
    {.name = "position",
     .unit = "m",
     .default_text = "[0, 0, 0]",
     .min = -MAX_POSITION,
     .max = MAX_POSITION,
     .meaning = "of the origin of the mesh: the centre of shapes made by rule"},
    {.name = "orientation",
     .unit = "1",
     .default_text = "[1, 0, 0, 0]",
     .min = -1e3,
     .max = 1e3,
     .meaning = "quaternion (w, x, y, z) about the origin of the mesh; brought to length 1"},
    {.name = "motion",
     .default_text = "{}",
     .section = &motion_section,
     .meaning = "prescribed motion; two walls that reach into each other must move as one, or one of them opens"},
    {.name = "removed_at",
     .unit = "s",
     .default_text = "never",
     .special = "never",
     .min = 0,
     .max = MAX_TIME,
     .meaning = "the wall is gone from then on"},
};
static const scree_scene_section wall_section = {
    "walls[]", "Meshes that particles bounce off; nothing moves them but their own motion.", wall_fields, wall_keys,
    COUNT(wall_keys)};

// --------------------------------------------------------------------------------------------- solver, output, repose

static const char *const overlap_schemes[] = {"filtered", "hierarchy"};
static const cyaml_schema_field_t solver_fields[] = {NUMBER(scree_solver_def, skin),
                                                     TEXT(scree_solver_def, overlap_scheme),
                                                     TRUTH(scree_solver_def, separate_patches),
                                                     TRUTH(scree_solver_def, reuse_pairs),
                                                     TRUTH(scree_solver_def, reorder_particles),
                                                     TRUTH(scree_solver_def, compare_spheres),
                                                     TRUTH(scree_solver_def, find_separation),
                                                     TRUTH(scree_solver_def, remember_separation),
                                                     TRUTH(scree_solver_def, bound_separation),
                                                     CYAML_FIELD_END};
static const scree_scene_key solver_keys[] = {
    {.name = "skin",
     .unit = "1",
     .default_text = "auto",
     .special = "auto",
     .min = 0,
     .max = 10,
     .meaning = "room around the boxes of the neighbour search over the mean bounding radius: more pairs, rarer "
                "searches; auto: what should cost least, chosen anew at every search from counts (particles, pairs, "
                "steps) times costs measured beforehand, which are the same on every machine, so that runs are "
                "repeatable; results stay the same"},
    {.name = "overlap_scheme",
     .default_text = "filtered",
     .rule = SCREE_TEXT_WORD,
     .words = overlap_schemes,
     .num_words = COUNT(overlap_schemes),
     .meaning = "filtered: plain signs where they clear their margin; hierarchy: the consistent decisions everywhere"},
    {.name = "separate_patches",
     .default_text = "false",
     .meaning = "whether the connected pieces of the overlap of two polyhedra are contacts of their own, each with its "
                "force and history; false: one contact for all of them, as Bilock (2020)"},
    {.name = "reuse_pairs",
     .default_text = "true",
     .meaning =
         "whether candidate pairs serve until a body may have left its skin; this and what follows saves work and "
         "changes no result"},
    {.name = "reorder_particles",
     .default_text = "true",
     .meaning =
         "whether particles that have mixed change places in memory, to lie near their neighbours along a Morton "
         "curve; ids and order of what is written stay"},
    {.name = "compare_spheres",
     .default_text = "true",
     .meaning = "whether particles are candidates only if their bounding spheres overlap, and not only their boxes"},
    {.name = "find_separation",
     .default_text = "true",
     .meaning = "whether polyhedra are asked for a plane between them before their overlap is computed"},
    {.name = "remember_separation",
     .default_text = "true",
     .meaning = "whether that plane is tried first in the next step, and pairs that touched are not asked"},
    {.name = "bound_separation",
     .default_text = "true",
     .meaning = "whether a pair is left alone until its bodies may have travelled through the gap between them: along "
                "the plane, or, where no plane separates them, the distance of their surfaces"},
};
static const scree_scene_section solver_section = {"solver", "How contacts are found.", solver_fields, solver_keys,
                                                   COUNT(solver_keys)};

static const cyaml_schema_field_t output_fields[] = {NUMBER(scree_output_def, series), NUMBER(scree_output_def, frames),
                                                     NUMBER(scree_output_def, checkpoint), CYAML_FIELD_END};
static const scree_scene_key output_keys[] = {
    {.name = "series",
     .unit = "s",
     .default_text = "auto",
     .special = "auto",
     .min = 0,
     .max = MAX_TIME,
     .meaning = "simulated time between rows of series.csv; auto: time.end/200"},
    {.name = "frames",
     .unit = "s",
     .default_text = "auto",
     .special = "auto",
     .min = 0,
     .max = MAX_TIME,
     .meaning = "between steps of frames.vtkhdf; auto: time.end/50"},
    {.name = "checkpoint",
     .unit = "s",
     .default_text = "auto",
     .special = "auto",
     .min = 0,
     .max = MAX_TIME,
     .meaning = "between checkpoints; auto: time.end/10"},
};
static const scree_scene_section output_section = {"output", "Intervals of simulated time; 0 switches a file off.",
                                                   output_fields, output_keys, COUNT(output_keys)};

static const cyaml_schema_field_t repose_fields[] = {TRUTH(scree_repose_def, measure),
                                                     NUMBER(scree_repose_def, from),
                                                     NUMBER(scree_repose_def, to),
                                                     NUMBER(scree_repose_def, base),
                                                     NUMBER(scree_repose_def, top),
                                                     INTEGER(scree_repose_def, bins),
                                                     CYAML_FIELD_END};
static const scree_scene_key repose_keys[] = {
    {.name = "measure", .default_text = "false", .meaning = "whether the angle is measured at the end of the run"},
    {.name = "from",
     .unit = "m",
     .default_text = "0",
     .min = -MAX_POSITION,
     .max = MAX_POSITION,
     .meaning = "lower end of the range of x"},
    {.name = "to",
     .unit = "m",
     .default_text = "0",
     .min = -MAX_POSITION,
     .max = MAX_POSITION,
     .meaning = "upper end of the range of x"},
    {.name = "base",
     .unit = "m",
     .default_text = "0",
     .min = -MAX_POSITION,
     .max = MAX_POSITION,
     .meaning = "height of the plate"},
    {.name = "top",
     .unit = "m",
     .default_text = "1e6",
     .min = -MAX_POSITION,
     .max = MAX_POSITION,
     .meaning = "particles whose centre is higher do not count: one may have got stuck above the pile"},
    {.name = "bins", .unit = "1", .default_text = "20", .min = 4, .max = 256, .meaning = "number of bins along x"},
};
static const scree_scene_section repose_section = {
    "repose", "Angle of repose: largest height in bins along x, fitted by a sigmoid (Bilock 2020, 6.3).", repose_fields,
    repose_keys, COUNT(repose_keys)};

// ------------------------------------------------------------------------------------------------------------- fields

static const cyaml_schema_field_t grid_fields[] = {NUMBERS(scree_region_def, min, 3), NUMBERS(scree_region_def, max, 3),
                                                   CYAML_FIELD_END};
static const scree_scene_section grid_section = {"fields.region",
                                                 "Box of the grid. What reaches out of it is left out.", grid_fields,
                                                 region_keys, 2}; // the corners alone

static const cyaml_schema_field_t fields_fields[] = {TRUTH(scree_fields_def, measure),
                                                     SECTION(scree_fields_def, region, grid_fields),
                                                     NUMBERS(scree_fields_def, cells, 3),
                                                     NUMBER(scree_fields_def, from),
                                                     NUMBER(scree_fields_def, period),
                                                     TEXT(scree_fields_def, wall),
                                                     INTEGER(scree_fields_def, samples),
                                                     INTEGER(scree_fields_def, energy_bins),
                                                     NUMBER(scree_fields_def, energy_min),
                                                     NUMBER(scree_fields_def, energy_max),
                                                     CYAML_FIELD_END};
static const scree_scene_key fields_keys[] = {
    {.name = "measure", .default_text = "false", .meaning = "whether fields.vtkhdf is made"},
    {.name = "region", .default_text = "{}", .section = &grid_section, .meaning = "where"},
    {.name = "cells",
     .unit = "1",
     .default_text = "[1, 1, 1]",
     .min = 1,
     .max = 10000,
     .meaning = "cells along x, y and z, whole numbers, at most 1e7 in all"},
    {.name = "from",
     .unit = "s",
     .default_text = "0",
     .min = 0,
     .max = MAX_TIME,
     .meaning = "when the first period begins: after the start-up"},
    {.name = "period",
     .unit = "s",
     .default_text = "auto",
     .special = "auto",
     .min = 1e-12,
     .max = MAX_TIME,
     .meaning = "length of the periods that are averaged over; auto: one revolution of the wall"},
    {.name = "wall",
     .default_text = "\"\"",
     .rule = SCREE_TEXT_OPTIONAL_NAME,
     .meaning = "name of a wall that rotates; give this or period"},
    {.name = "samples",
     .unit = "1",
     .default_text = "200",
     .min = 1,
     .max = 1e6,
     .meaning = "looks at the particles in a period, at equal distances; particles that have mixed change places in "
                "memory only if there are a hundred steps between two of them"},
    {.name = "energy_bins",
     .unit = "1",
     .default_text = "0",
     .min = 0,
     .max = 10000,
     .meaning = "bins of the energies that collisions lose, each a constant factor wider than the one before; 0: "
                "collisions are not followed"},
    {.name = "energy_min",
     .unit = "J",
     .default_text = "1e-12",
     .min = 1e-100,
     .max = 1e100,
     .meaning = "lower edge of the first bin"},
    {.name = "energy_max",
     .unit = "J",
     .default_text = "1",
     .min = 1e-100,
     .max = 1e100,
     .meaning = "upper edge of the last bin"},
};
static const scree_scene_section fields_section = {
    "fields",
    "Averages over whole periods, kept while the run goes on: solid fraction, velocity, speed and granular temperature "
    "on "
    "a grid, and the energies of collisions. Nothing is stored per step.",
    fields_fields, fields_keys, COUNT(fields_keys)};

// --------------------------------------------------------------------------------------------------------------- root

static const cyaml_schema_value_t material_value = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, scree_material_def, material_fields)};
static const cyaml_schema_value_t law_value = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, scree_contact_law_def, law_fields)};
static const cyaml_schema_value_t group_value = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, scree_particle_group_def, group_fields)};
static const cyaml_schema_value_t wall_value = {CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, scree_wall_def, wall_fields)};
static const cyaml_schema_field_t root_fields[] = {TEXT(scree_scene, name),
                                                   NUMBERS(scree_scene, gravity, 3),
                                                   SECTION(scree_scene, time, time_fields),
                                                   LIST(scree_scene, materials, &material_value),
                                                   LIST(scree_scene, contact_laws, &law_value),
                                                   LIST(scree_scene, shapes, &scree_scene_shape_value),
                                                   LIST(scree_scene, particles, &group_value),
                                                   LIST(scree_scene, walls, &wall_value),
                                                   SECTION(scree_scene, solver, solver_fields),
                                                   SECTION(scree_scene, output, output_fields),
                                                   SECTION(scree_scene, repose, repose_fields),
                                                   SECTION(scree_scene, fields, fields_fields),
                                                   CYAML_FIELD_END};
static const scree_scene_key root_keys[] = {
    {.name = "name", .default_text = "scene", .rule = SCREE_TEXT_FREE, .meaning = "for titles and messages"},
    {.name = "gravity",
     .unit = "m/s^2",
     .default_text = "[0, 0, -9.81]",
     .min = -1e6,
     .max = 1e6,
     .meaning = "acceleration of everything that is free"},
    {.name = "time", .default_text = "{}", .section = &time_section, .meaning = "how long and in which steps"},
    {.name = "materials", .default_text = "[]", .section = &material_section, .max = 1000, .meaning = "solids"},
    {.name = "contact_laws",
     .default_text = "[]",
     .section = &law_section,
     .max = 100000,
     .meaning = "forces between two materials"},
    {.name = "shapes", .default_text = "[]", .section = &scree_scene_shape_section, .max = 100000, .meaning = "meshes"},
    {.name = "particles",
     .default_text = "[]",
     .section = &group_section,
     .max = 100000,
     .meaning = "groups of particles"},
    {.name = "walls",
     .default_text = "[]",
     .section = &wall_section,
     .max = 100000,
     .meaning = "meshes with a prescribed motion"},
    {.name = "solver", .default_text = "{}", .section = &solver_section, .meaning = "how contacts are found"},
    {.name = "output", .default_text = "{}", .section = &output_section, .meaning = "what is written, how often"},
    {.name = "repose", .default_text = "{}", .section = &repose_section, .meaning = "measurement of a pile"},
    {.name = "fields", .default_text = "{}", .section = &fields_section, .meaning = "averages over time on a grid"},
};
static const scree_scene_section root_section = {"scene", "The top of the file.", root_fields, root_keys,
                                                 COUNT(root_keys)};
static const cyaml_schema_value_t root_value = {CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER, scree_scene, root_fields)};

const scree_scene_section *scree_scene_root(void) { return &root_section; }
const cyaml_schema_value_t *scree_scene_root_value(void) { return &root_value; }

const scree_scene_section *scree_scene_law_section(void) { return &law_section; }
