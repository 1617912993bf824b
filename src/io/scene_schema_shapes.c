/// \file scene_schema_shapes.c
/// The tables of the keys of shapes.
#include "io/schema_tables.h"
#include "polyhedra/clump.h"

static const cyaml_strval_t shape_sources[] = {{"file", SCREE_SHAPE_FILE},
                                               {"box", SCREE_SHAPE_BOX},
                                               {"tetrahedron", SCREE_SHAPE_TETRAHEDRON},
                                               {"schoenhardt", SCREE_SHAPE_SCHOENHARDT},
                                               {"sphere", SCREE_SHAPE_SPHERE},
                                               {"rock", SCREE_SHAPE_ROCK},
                                               {"turned", SCREE_SHAPE_TURNED},
                                               {"clump", SCREE_SHAPE_CLUMP}};
static const cyaml_schema_field_t profile_fields[] = {NUMBER(scree_profile_point, radius),
                                                      NUMBER(scree_profile_point, height), CYAML_FIELD_END};
static const scree_scene_key profile_keys[] = {
    {.name = "radius", .unit = "m", .min = 0, .max = MAX_POSITION, .meaning = "distance from the axis; 0: on it"},
    {.name = "height", .unit = "m", .min = -MAX_POSITION, .max = MAX_POSITION, .meaning = "along the axis, z"},
};
static const scree_scene_section profile_section = {
    "shapes[].profile[]",
    "Corners of the closed polygon that is turned about z, in either sense; the last is joined to the first. A drum "
    "with end plates is the section of its shell on one side of the axis, a silo that of its wall and cone.",
    profile_fields, profile_keys, COUNT(profile_keys)};
static const cyaml_schema_value_t profile_value = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, scree_profile_point, profile_fields)};

static const cyaml_schema_field_t ball_fields[] = {NUMBERS(scree_clump_sphere, position, 3),
                                                   NUMBER(scree_clump_sphere, radius), CYAML_FIELD_END};
static const scree_scene_key ball_keys[] = {
    {.name = "position", .unit = "m", .min = -MAX_POSITION, .max = MAX_POSITION, .meaning = "of its centre"},
    {.name = "radius", .unit = "m", .min = 1e-12, .max = MAX_POSITION, .meaning = "of the sphere"},
};
static const scree_scene_section ball_section = {
    "shapes[].spheres[]",
    "Spheres of a clump, a rigid body. Mass and inertia are those of their union; each sphere makes contacts of its "
    "own. They must hang together, and none may be wholly inside another.",
    ball_fields, ball_keys, COUNT(ball_keys)};
static const cyaml_schema_value_t ball_value = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, scree_clump_sphere, ball_fields)};

static const cyaml_schema_field_t fill_fields[] = {TEXT(scree_clump_fill_def, shape),
                                                   INTEGER(scree_clump_fill_def, spheres), CYAML_FIELD_END};
static const scree_scene_key fill_keys[] = {
    {.name = "shape",
     .default_text = "\"\"",
     .rule = SCREE_TEXT_OPTIONAL_NAME,
     .meaning = "name of the shape whose mesh is filled"},
    {.name = "spheres",
     .unit = "1",
     .default_text = "10",
     .min = 1,
     .max = SCREE_CLUMP_MAX_SPHERES,
     .meaning = "how many: the largest one that fits, then one after the other what sticks out most of those before"},
};
static const scree_scene_section fill_section = {
    "shapes[].fill",
    "A clump made from a mesh: spheres inside it that touch its surface. The clump is smaller than the mesh.",
    fill_fields, fill_keys, COUNT(fill_keys)};

static const cyaml_schema_field_t shape_fields[] = {TEXT(scree_shape_def, name),
                                                    WORD(scree_shape_def, source, shape_sources),
                                                    TEXT(scree_shape_def, file),
                                                    NUMBER(scree_shape_def, scale),
                                                    NUMBERS(scree_shape_def, size, 3),
                                                    INTEGER(scree_shape_def, triangles),
                                                    INTEGER(scree_shape_def, seed),
                                                    LIST(scree_shape_def, profile, &profile_value),
                                                    INTEGER(scree_shape_def, segments),
                                                    LIST(scree_shape_def, spheres, &ball_value),
                                                    SECTION(scree_shape_def, fill, fill_fields),
                                                    NUMBERS(scree_shape_def, offset, 3),
                                                    INTEGER(scree_shape_def, copies),
                                                    CYAML_FIELD_END};
static const scree_scene_key shape_keys[] = {
    {.name = "name", .rule = SCREE_TEXT_NAME, .meaning = "what particles and walls call it"},
    {.name = "source", .meaning = "where the shape comes from: a file, or made by rule"},
    {.name = "file",
     .default_text = "\"\"",
     .rule = SCREE_TEXT_PATH,
     .meaning = "mesh file of source file, relative to the folder of the scene"},
    {.name = "scale",
     .unit = "1",
     .default_text = "1",
     .min = 1e-9,
     .max = 1e9,
     .meaning = "of file: its numbers times scale are lengths in m; 0.001 for a file in mm"},
    {.name = "size",
     .unit = "m",
     .default_text = "[1, 1, 1]",
     .min = 0,
     .max = MAX_POSITION,
     .meaning = "edge lengths of a box; of the other shapes made by rule the first number is the diameter of the "
                "sphere around a tetrahedron or schoenhardt, the diameter of a sphere, the middle extent of a rock, "
                "and the others are not used. One number x stands for [x, x, x]"},
    {.name = "triangles",
     .unit = "1",
     .default_text = "0",
     .min = 0,
     .max = 1e6,
     .meaning = "wanted number of triangles of a sphere or a rock, at least 4; a file with more is simplified to it; "
                "0: the file as it is, or a true sphere, which has no mesh and cannot be a wall"},
    {.name = "seed",
     .unit = "1",
     .default_text = "0",
     .min = 0,
     .max = MAX_INTEGER,
     .meaning = "of a rock: another number, another rock"},
    {.name = "profile",
     .default_text = "[]",
     .section = &profile_section,
     .max = 256,
     .meaning = "of turned: from 3 corners on; it must not cross itself"},
    {.name = "segments",
     .unit = "1",
     .default_text = "64",
     .min = 3,
     .max = 4096,
     .meaning = "of turned: sides of the cross-sections, which have the area of the circle"},
    {.name = "spheres",
     .default_text = "[]",
     .section = &ball_section,
     .max = SCREE_CLUMP_MAX_SPHERES,
     .meaning = "of clump: from 1 on. A clump has no mesh and cannot be a wall"},
    {.name = "fill",
     .default_text = "{}",
     .section = &fill_section,
     .meaning = "of clump: instead of spheres, a mesh to fill with them"},
    {.name = "offset",
     .unit = "m",
     .default_text = "[0, 0, 0]",
     .min = -MAX_POSITION,
     .max = MAX_POSITION,
     .meaning = "added to all vertices; only walls notice, particles are centred"},
    {.name = "copies",
     .unit = "1",
     .default_text = "1",
     .min = 1,
     .max = 1000,
     .meaning = "number of copies of the shifted mesh, turned evenly about z, that make one body: lifters of a drum. "
                "They must not touch each other"},
};
const scree_scene_section scree_scene_shape_section = {
    "shapes[]",
    "Closed triangle meshes, true spheres and clumps of them, shared by all particles and walls that name them.",
    shape_fields, shape_keys, COUNT(shape_keys)};
const cyaml_schema_value_t scree_scene_shape_value = {
    CYAML_VALUE_MAPPING(CYAML_FLAG_DEFAULT, scree_shape_def, shape_fields)};
