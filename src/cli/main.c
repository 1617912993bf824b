/// \file main.c
/// The program scree: finds the command and hands it its part of the line.
#include "cli/commands.h"
#include "io/nearest_name.h"
#include "scree/scene.h"

#include <stdio.h>
#include <string.h>

typedef struct program_command
{
    const char *name;
    const char *text; ///< one line
    int (*run)(int argc, char **argv);
} program_command;

static const program_command commands[] = {
    {"run", "run a scene into a folder, or continue a run", scree_run_command},
    {"check", "check a scene and print the plan of its run", scree_check_command},
    {"shape", "measure, check, simplify and convert meshes", scree_shape_command},
    {"bench", "measure this machine: steps, beds, searches", scree_bench_command},
    {"overlap", "overlap volume, area vector and indentation of two meshes", scree_overlap_command},
};
enum
{
    NUM_COMMANDS = sizeof commands / sizeof commands[0]
};

static void print_usage(FILE *out)
{
    fputs("scree " SCREE_VERSION ": particles of polyhedral shape, by the discrete element method\n"
          "\n"
          "usage: scree COMMAND [options] ...\n"
          "\n",
          out);
    for (int k = 0; k < NUM_COMMANDS; ++k) fprintf(out, "  %-9s %s\n", commands[k].name, commands[k].text);
    fputs("\n"
          "  scree COMMAND --help   options of a command\n"
          "  scree --help scene     all keys of scenes\n"
          "  scree --version        the version\n",
          out);
}

void scree_print_report(const scree_report *report)
{
    for (int is_warning = 0; is_warning < 2; ++is_warning)
        for (int k = 0; k < report->num_messages; ++k)
            if ((strncmp(report->messages[k], "warning: ", 9) == 0) == (is_warning == 1))
                fprintf(stderr, "%s\n", report->messages[k]);
}

static const program_command *find_command(const char *name)
{
    for (int k = 0; k < NUM_COMMANDS; ++k)
        if (strcmp(commands[k].name, name) == 0) return commands + k;
    return NULL;
}

/// Tells a word that is not known with the nearest one that is: a command, or one of the others.
static int unknown(const char *what, const char *name)
{
    static const char *const options[] = {"--help", "--version"};
    const char *names[NUM_COMMANDS + 1];
    for (int k = 0; k < NUM_COMMANDS; ++k) names[k] = commands[k].name;
    names[NUM_COMMANDS] = "scene"; // a topic, not a command
    const bool is_topic = strcmp(what, "topic") == 0;
    const char *nearest = strcmp(what, "option") == 0 ? scree_nearest_name(name, options, 2)
                                                      : scree_nearest_name(name, names, NUM_COMMANDS + is_topic);
    fprintf(stderr, "scree: unknown %s \"%.100s\"; ", what, name);
    if (nearest != NULL) fprintf(stderr, "did you mean \"%s\"?\n", nearest);
    else fprintf(stderr, "see scree --help\n");
    return SCREE_EXIT_USAGE;
}

/// What was printed counts only once it is written.
static int finish(void)
{
    if (fflush(stdout) == 0) return SCREE_EXIT_DONE;
    fprintf(stderr, "scree: standard output could not be written\n");
    return SCREE_EXIT_FAILED;
}

static bool is_version(const char *argument)
{
    return strcmp(argument, "--version") == 0 || strcmp(argument, "-V") == 0;
}

/// scree --help [TOPIC]
static int print_help(const char *topic)
{
    if (topic == NULL) print_usage(stdout);
    else if (strcmp(topic, "scene") == 0 || strcmp(topic, "scenes") == 0) scree_scene_print_keys(stdout);
    else
    {
        const program_command *command = find_command(topic);
        char help[] = "--help";
        char *arguments[] = {(char *)topic, help, NULL};
        return command != NULL ? command->run(2, arguments) : unknown("topic", topic);
    }
    return finish();
}

int main(int argc, char **argv)
{
    if (argc < 2)
    {
        print_usage(stderr);
        return SCREE_EXIT_USAGE;
    }
    const char *name = argv[1];
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0 || strcmp(name, "help") == 0)
        return print_help(argc > 2 ? argv[2] : NULL);
    const program_command *command = find_command(name);
    if (is_version(name) || (command != NULL && argc == 3 && is_version(argv[2])))
    {
        printf("scree %s\n", SCREE_VERSION);
        return finish();
    }
    if (command == NULL) return unknown(name[0] == '-' ? "option" : "command", name);
    argv[1] = argv[0]; // as the program was called
    return command->run(argc - 1, argv + 1);
}
