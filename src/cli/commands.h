/// \file commands.h
/// The commands of the program scree. Each takes its own command line, argv[0] being its name, prints to standard
/// output, tells faults on standard error, and returns the exit code.
#ifndef SCREE_COMMANDS_H
#define SCREE_COMMANDS_H

#include "scree/base.h"

enum
{
    SCREE_EXIT_DONE = 0,
    SCREE_EXIT_FAILED = 1, ///< the work could not be done: memory, files, a simulation that was lost
    SCREE_EXIT_USAGE = 2   ///< the command line or the input was refused
};

// argv[0]: the program as it was called; what follows the name of the command is in argv[1] and on
int scree_run_command(int argc, char **argv);     ///< run a scene
int scree_check_command(int argc, char **argv);   ///< check a scene, tell its plan
int scree_shape_command(int argc, char **argv);   ///< measure, mend, simplify meshes
int scree_bench_command(int argc, char **argv);   ///< measure
int scree_overlap_command(int argc, char **argv); ///< overlap of two meshes

/// Prints every message to standard error, one a line, faults first.
void scree_print_report(const scree_report *report);

#endif
