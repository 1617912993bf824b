/// \file mesh_argument.h
/// Meshes named on a command line: a file, or a generator with its numbers.
#ifndef SCREE_MESH_ARGUMENT_H
#define SCREE_MESH_ARGUMENT_H

#include "polyhedra/mesh.h"

/// Lines for a usage text that tell the generators.
#define SCREE_GENERATOR_HELP                                                                        \
    "                      box:X:Y:Z         edge lengths\n"                                        \
    "                      tetrahedron:R     regular, in a sphere of radius R\n"                    \
    "                      schoenhardt:R     twisted octahedron, in a sphere of radius R\n"         \
    "                      sphere:R:N        N triangles, volume of the sphere of radius R\n"       \
    "                      rock:SEED:N       irregular rock of N triangles, middle size about 1\n"  \
    "                      rock:SEED:N:D     the same from a rock of D triangles instead of 1000\n" \
    "                      turned:N:R:Z:...  profile (R, Z) turned about z in N segments, 3 to 256 corners\n"

/// Makes the mesh that `specification` asks for. SCREE_INVALID_INPUT, with a message, if it asks for none.
scree_status scree_mesh_generate(scree_mesh *mesh, const char *specification, scree_report *report);

/// True if `argument` names a generator, that is a known kind followed by a colon.
bool scree_mesh_is_generated(const char *argument);

/// A finite number that makes up the whole text.
bool scree_parse_number(const char *text, double *value);

#endif
