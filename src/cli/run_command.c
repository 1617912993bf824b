/// \file run_command.c
/// scree run: a scene into a folder, or on with what a folder holds.
#define _POSIX_C_SOURCE 200809L
#include "cli/commands.h"
#include "cli/device_argument.h"
#include "scree/io.h"

#include <errno.h>
#include <hdf5.h>
#include <math.h>
#include <omp.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

static const char usage[] =
    "usage: scree run [options] SCENE\n"
    "\n"
    "Runs a scene and writes everything into one folder: scene.yaml (as used), series.csv (energies and counts over\n"
    "time), frames.vtkhdf, walls.vtkhdf and contacts.vtkhdf (for ParaView), checkpoint.h5, summary.json, and\n"
    "fields.vtkhdf if the scene measures fields.\n"
    "\n"
    "  -o FOLDER         where to; default runs/NAME, NAME being that of the scene\n"
    "  --restart         goes on from the checkpoint in the folder; the result is that of the unbroken run, bit for "
    "bit\n"
    "  --replace         writes over a run that the folder holds\n"
    "  --threads N       number of threads; default: OMP_NUM_THREADS, or all cores. The result is the same for any\n"
    "  --device WHERE    cpu, the default, or cuda or cuda:N, an NVIDIA GPU, N counted from 0. The result is the same\n"
    "  --set PATH=VALUE  replaces a value of the scene, like time.end=2 or particles.fill.count=100; can be repeated\n"
    "  --quiet           prints faults and warnings alone\n"
    "  --help            this text\n"
    "\n"
    "Ctrl-C, or SIGTERM, ends the run with a checkpoint; a second one ends it at once. The keys of scenes: scree "
    "--help\n"
    "scene. Pictures: tools/pictures.py FOLDER.\n"
    "\n"
    "Exit code: 0 finished; 1 files or memory failed, or the simulation was lost; 2 the command line or the scene was\n"
    "refused; 130 stopped by Ctrl-C; 143 stopped by SIGTERM.\n";

/// The command line, understood.
typedef struct run_request
{
    const char *program; ///< as it was called
    const char *path;
    const char *folder;     ///< NULL: by the name of the scene
    const char **overrides; ///< (num_overrides)
    int num_overrides;
    int num_threads; ///< 0: as OpenMP has it
    int32_t device;  ///< number of a GPU; -1: the CPU
    bool restart, replace, is_quiet, wants_help;
} run_request;

/// A run under way.
typedef struct run_state
{
    const run_request *request;
    scree_scene_file file;
    scree_simulation *simulation;
    scree_device *device; ///< NULL: the CPU
    bool is_lost;         ///< a step has failed: the state is half done
    scree_run_folder *folder;
    char *folder_path;
    scree_report report;
    double initial_energy;
    double start_clock;
    int64_t start_step;
    bool has_warned;        ///< of a time step that is too long
    bool has_warned_inside; ///< of a sphere whose centre is inside a solid
    bool has_warned_lost;   ///< of bodies in each other without a force
    bool has_warned_shared; ///< of other processes on the cores of its threads
    double watched_clock;   ///< when they were last looked for
    long watched_switches;  ///< interruptions by them until then
    bool is_terminal;
    double shown_clock; ///< when progress was last shown
    int64_t shown_step;
    double speed; ///< [steps/s] of late
} run_state;

/// The signal that asked for an end, or 0. A handler can reach nothing but a global variable.
static volatile sig_atomic_t stop_signal = 0;

static void note_signal(int number) { stop_signal = number; }

// ---- command line

static bool refuse(const char *what, const char *argument)
{
    fprintf(stderr, "scree run: %s%s; see scree run --help\n", what, argument);
    return false;
}

/// The value of option `name` at argv[*i]: behind "=" or the next argument. NULL if argv[*i] is another option.
static const char *option_value(const char *name, int argc, char **argv, int *i)
{
    const size_t length = strlen(name);
    if (strncmp(argv[*i], name, length) != 0) return NULL;
    if (argv[*i][length] == '=' && length > 2) return argv[*i] + length + 1;
    if (argv[*i][length] != '\0') return NULL;
    if (*i + 1 == argc) return "";
    return argv[++*i];
}

static bool parse_threads(run_request *request, const char *value)
{
    char *end;
    errno = 0;
    const long num = strtol(value, &end, 10);
    if (errno != 0 || end == value || *end != '\0' || num < 1 || num > 4096)
        return refuse("--threads needs a number from 1 to 4096, not ", value);
    request->num_threads = (int)num;
    return true;
}

static bool parse_argument(run_request *request, int argc, char **argv, int *i)
{
    const char *argument = argv[*i], *value;
    if (strcmp(argument, "--restart") == 0) return request->restart = true;
    if (strcmp(argument, "--replace") == 0) return request->replace = true;
    if (strcmp(argument, "--quiet") == 0 || strcmp(argument, "-q") == 0) return request->is_quiet = true;
    if ((value = option_value("--threads", argc, argv, i)) != NULL) return parse_threads(request, value);
    if ((value = option_value("--device", argc, argv, i)) != NULL)
        return scree_parse_device(value, &request->device) || refuse("--device needs cpu, cuda or cuda:N, not ", value);
    if ((value = option_value("--set", argc, argv, i)) != NULL)
    {
        if (value[0] == '\0') return refuse("--set needs PATH=VALUE", "");
        request->overrides[request->num_overrides++] = value;
        return true;
    }
    if ((value = option_value("-o", argc, argv, i)) != NULL || (value = option_value("--out", argc, argv, i)) != NULL)
    {
        if (value[0] == '\0') return refuse("-o needs a folder", "");
        request->folder = value;
        return true;
    }
    if (argument[0] == '-' && argument[1] != '\0') return refuse("unknown option ", argument);
    if (request->path != NULL) return refuse("one scene at a time, what is ", argument);
    request->path = argument;
    return true;
}

static bool parse_command_line(run_request *request, int argc, char **argv)
{
    for (int i = 1; i < argc; ++i)
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0) return request->wants_help = true;
    for (int i = 1; i < argc; ++i)
        if (!parse_argument(request, argc, argv, &i)) return false;
    if (request->restart && request->replace) return refuse("--restart and --replace exclude each other", "");
    return request->path != NULL || refuse("no scene given", "");
}

// ---- telling

static double seconds_of(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static double wall_clock(void) { return seconds_of(CLOCK_MONOTONIC); }

/// Prints and forgets the messages, behind the progress line if there is one.
static void tell_report(run_state *run)
{
    if (run->report.num_messages == 0) return;
    if (run->is_terminal && run->shown_clock > 0) fputs("\r\033[K", stdout);
    fflush(stdout);
    scree_print_report(&run->report);
    scree_report_clear(&run->report);
}

/// "3 h 07 min", "2 min 05 s" or "12 s".
static const char *format_duration(double seconds, char text[32])
{
    if (!(seconds < 1e9)) snprintf(text, 32, "?");
    else if (seconds >= 3600)
        snprintf(text, 32, "%.0f h %02.0f min", floor(seconds / 3600), floor(fmod(seconds, 3600) / 60));
    else if (seconds >= 60) snprintf(text, 32, "%.0f min %02.0f s", floor(seconds / 60), floor(fmod(seconds, 60)));
    else snprintf(text, 32, "%.0f s", seconds);
    return text;
}

static void format_bar(double share, char bar[21])
{
    for (int k = 0; k < 20; ++k) bar[k] = (double)k < 20 * share ? '#' : '.';
    bar[20] = '\0';
}

/// One line: how far, how fast, what is going on. On a terminal always the same line.
static void show_progress(run_state *run)
{
    const scree_simulation *simulation = run->simulation;
    const double now = wall_clock(), time_step = scree_simulation_time_step(simulation);
    const int64_t step = (int64_t)(scree_simulation_time(simulation) / time_step + 0.5);
    const int64_t num_steps = scree_simulation_num_steps(simulation);
    const double elapsed = now - run->shown_clock;
    const double speed = elapsed > 0 ? (double)(step - run->shown_step) / elapsed : 0;
    // the older the measure, the less it counts: half after some seconds
    const double weight = run->speed > 0 ? exp(-elapsed / 5) : 0;
    run->speed = weight * run->speed + (1 - weight) * speed;
    run->shown_clock = now;
    run->shown_step = step;

    // a look would bring particles home that have changed places, and from a GPU the whole state: these digits are
    // not worth it. On the CPU they are of now, on a GPU of the last look for something else.
    const double time = scree_simulation_time(simulation), observed = scree_simulation_observed_time(simulation);
    const scree_energies energies = scree_simulation_energies(simulation);
    const double share = num_steps > 0 ? (double)step / (double)num_steps : 1;
    char left[32], bar[21];
    format_bar(share, bar);
    if (run->is_terminal) printf("\r[%s] ", bar);
    printf("%5.1f %%  t %.4g s  left %s  %.3g steps/s  %lld contacts  E_kin %.3g J", 100 * share, time,
           format_duration((double)(num_steps - step) / run->speed, left), run->speed,
           (long long)scree_simulation_counters(simulation).num_contacts, energies.kinetic + energies.rotational);
    if (observed < time) printf(" at %.4g s", observed);
    fputs(run->is_terminal ? "\033[K" : "\n", stdout);
    fflush(stdout);
}

static void show_progress_sometimes(run_state *run)
{
    if (run->request->is_quiet) return;
    if (wall_clock() - run->shown_clock >= (run->is_terminal ? 0.25 : 5.0)) show_progress(run);
}

/// A time step beyond what the contacts so far allow, once.
static void warn_of_time_step(run_state *run)
{
    const double step = scree_simulation_time_step(run->simulation);
    const double critical = scree_simulation_counters(run->simulation).smallest_critical_step;
    if (run->has_warned || !(step > critical)) return;
    run->has_warned = true;
    scree_report_warn(&run->report,
                      "t = %g s: the time step of %g s exceeds the critical one of a contact, %g s; energies may be "
                      "wrong from here on: choose a time.step below %.2g s",
                      scree_simulation_time(run->simulation), step, critical, 0.5 * critical);
    tell_report(run);
}

/// A sphere deeper in a mesh than its radius, once: it may leave on the wrong side.
static void warn_of_inside(run_state *run)
{
    if (run->has_warned_inside || scree_simulation_counters(run->simulation).num_inside == 0) return;
    run->has_warned_inside = true;
    scree_report_warn(
        &run->report,
        "t = %g s: the centre of a sphere is inside the solid of a wall or a particle, below the surface; "
        "it is pushed out where the surface is nearest. Contacts are too soft for the speeds, or the step "
        "too long: raise youngs_modulus or choose a smaller time.step",
        scree_simulation_time(run->simulation));
    tell_report(run);
}

/// Bodies in each other without a force, once.
static void warn_of_lost_overlaps(run_state *run)
{
    if (run->has_warned_lost || scree_simulation_counters(run->simulation).num_without_normal == 0) return;
    run->has_warned_lost = true;
    scree_report_warn(
        &run->report,
        "t = %g s: a polyhedron is inside another body, or goes through it: no direction leads out, and such a contact "
        "has no force. Contacts are too soft for the speeds, or the step too long: raise youngs_modulus or choose a "
        "smaller time.step; series.csv counts such contacts as without_normal",
        scree_simulation_time(run->simulation));
    tell_report(run);
}

/// Threads that other processes interrupt, once: those that wait for one spin, and so keep it from going on.
static void warn_of_sharing(run_state *run)
{
    const double interval = 5; // [s]
    const int num_threads = omp_get_max_threads();
    const char *policy = getenv("OMP_WAIT_POLICY");
    if (run->has_warned_shared || num_threads == 1 || (policy != NULL && strcasecmp(policy, "passive") == 0)) return;
    const double now = wall_clock();
    if (now - run->watched_clock < interval) return;
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    const double rate = (double)(usage.ru_nivcsw - run->watched_switches) / (now - run->watched_clock);
    run->watched_clock = now;
    run->watched_switches = usage.ru_nivcsw;
    // on a machine of its own there are a few; a scheduler that shares a core gives turns of some milliseconds
    if (rate < 20 * num_threads) return;
    run->has_warned_shared = true;
    scree_report_warn(&run->report,
                      "other processes interrupt the %d threads of this run %.0f times a second, and threads that wait "
                      "for each other then take many times as long: set OMP_WAIT_POLICY=passive in the environment, or "
                      "fewer --threads",
                      num_threads, rate);
    tell_report(run);
}

/// A word of a shell command, quoted where needed.
static void print_word(const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=,:+%@";
    if (word[0] != '\0' && strspn(word, plain) == strlen(word))
    {
        printf(" %s", word);
        return;
    }
    fputs(" '", stdout);
    for (const char *c = word; *c != '\0'; ++c)
        if (*c == '\'') fputs("'\\''", stdout);
        else putchar(*c);
    putchar('\'');
}

/// Where the folder has its checkpoint, if it has one. NULL: out of memory.
static char *checkpoint_path(const run_state *run)
{
    const size_t size = strlen(run->folder_path) + 32;
    char *path = malloc(size);
    if (path != NULL) snprintf(path, size, "%s/checkpoint.h5", run->folder_path);
    return path;
}

static void print_command_to_go_on(const run_state *run)
{
    const run_request *request = run->request;
    fputs("go on with:", stdout);
    print_word(request->program);
    fputs(" run --restart -o", stdout);
    print_word(run->folder_path);
    if (request->num_threads > 0) printf(" --threads %d", request->num_threads);
    if (request->device >= 0) printf(" --device cuda:%d", request->device);
    for (int k = 0; k < request->num_overrides; ++k)
    {
        fputs(" --set", stdout);
        print_word(request->overrides[k]);
    }
    print_word(request->path);
    putchar('\n');
}

/// After a stop in a sound state: from where the run can go on, and how.
static void tell_how_to_go_on(const run_state *run, bool is_saved)
{
    char *path = checkpoint_path(run);
    const bool has_checkpoint = path != NULL && access(path, F_OK) == 0;
    free(path);
    printf("stopped at t = %g s, %s\n", scree_simulation_time(run->simulation),
           is_saved         ? "checkpoint written"
           : has_checkpoint ? "no checkpoint could be written, one from before is kept"
                            : "no checkpoint could be written and there is none from before: make room, then start the "
                              "run anew with --replace");
    if (has_checkpoint) print_command_to_go_on(run);
}

// ---- outputs

/// Is there something to write at this step? True for step 0 and the first step at or after each multiple of the
/// interval; depends on the step alone, so that a restart writes at the same steps.
static bool is_due(int64_t step, double time_step, double interval)
{
    if (!(interval > 0)) return false;
    if (step == 0) return true;
    const double steps = interval / time_step * (1 - 1e-12);
    return floor((double)step / steps) > floor((double)(step - 1) / steps);
}

/// Row and frame, then the checkpoint: what a checkpoint has passed is in the other files.
static scree_status write_outputs(run_state *run, int64_t step, bool is_last)
{
    const scree_output_def *output = &run->file.scene.output;
    const double time_step = scree_simulation_time_step(run->simulation);
    const bool wants_row = is_due(step, time_step, output->series) || (is_last && output->series > 0);
    const bool wants_frame = is_due(step, time_step, output->frames) || (is_last && output->frames > 0);
    const bool wants_checkpoint =
        output->checkpoint > 0 && (is_last || (step > 0 && is_due(step, time_step, output->checkpoint)));
    scree_status status = SCREE_OK;
    if (wants_row || wants_frame || wants_checkpoint || is_last)
        status = scree_simulation_observe(run->simulation, &run->report);
    if (status == SCREE_DEVICE_FAILED) run->is_lost = true;
    if (status == SCREE_OK && wants_row)
        status = scree_run_folder_write_series(run->folder, run->simulation, &run->report);
    if (status == SCREE_OK && wants_frame)
        status = scree_run_folder_write_frame(run->folder, run->simulation, &run->report);
    if (status == SCREE_OK) status = scree_run_folder_write_fields(run->folder, run->simulation, &run->report);
    if (status == SCREE_OK && wants_checkpoint)
        status = scree_run_folder_write_checkpoint(run->folder, run->simulation, &run->report);
    return status;
}

static scree_status write_summary(run_state *run, const char *outcome)
{
    const scree_energies energies = scree_simulation_energies(run->simulation);
    const double turned_over = scree_run_folder_energy_turned_over(run->folder);
    const double change = scree_energies_balance(&energies) - run->initial_energy;
    const int64_t step =
        (int64_t)(scree_simulation_time(run->simulation) / scree_simulation_time_step(run->simulation) + 0.5);
    const scree_run_result result = {.outcome = outcome,
                                     .wall_seconds = wall_clock() - run->start_clock,
                                     .processor_seconds = seconds_of(CLOCK_PROCESS_CPUTIME_ID),
                                     .initial_energy = run->initial_energy,
                                     .energy_error = turned_over > 0 ? change / turned_over : (double)NAN,
                                     .steps_run = step - run->start_step,
                                     .threads = omp_get_max_threads()};
    return scree_run_folder_write_summary(run->folder, run->simulation, &result, &run->report);
}

// ---- the run

static char *default_folder(const char *name)
{
    static const char base[] = "runs/";
    const size_t size = sizeof base + (name != NULL ? strlen(name) : 0) + 8;
    char *path = malloc(size);
    if (path == NULL) return NULL;
    snprintf(path, size, "%s%s", base, name != NULL && name[0] != '\0' ? name : "scene");
    // a name is one folder, and not one above
    for (char *c = path + sizeof base - 1; *c != '\0'; ++c)
        if (*c == '/') *c = '_';
    if (path[sizeof base - 1] == '.') path[sizeof base - 1] = '_';
    return path;
}

/// The checkpoint of the folder into the fresh simulation.
static scree_status load_checkpoint(run_state *run)
{
    char *path = checkpoint_path(run);
    if (path == NULL) return SCREE_OUT_OF_MEMORY;
    const scree_status status = scree_checkpoint_load(run->simulation, path, &run->report);
    if (status == SCREE_NOT_FOUND || status == SCREE_READ_FAILED)
        scree_report_add(&run->report, "start the run anew: with another folder (-o), or with --replace");
    free(path);
    return status;
}

/// Scene, simulation, checkpoint, folder. Faults are in the report.
static scree_status prepare(run_state *run)
{
    const run_request *request = run->request;
    scree_report *report = &run->report;
    scree_status status =
        scree_scene_read(&run->file, request->path, request->overrides, request->num_overrides, report);
    if (status != SCREE_OK) return status;
    // before anything is computed for it
    status = scree_open_device(request->device, &run->device, report);
    if (status != SCREE_OK) return status;
    run->folder_path = request->folder != NULL ? strdup(request->folder) : default_folder(run->file.scene.name);
    if (run->folder_path == NULL) return SCREE_OUT_OF_MEMORY;
    status = scree_simulation_create(&run->simulation, &run->file.scene, run->file.folder, report);
    if (status != SCREE_OK) return status;
    const scree_energies energies = scree_simulation_energies(run->simulation);
    run->initial_energy = scree_energies_balance(&energies);
    if (request->restart) status = load_checkpoint(run);
    if (status == SCREE_OK && run->device != NULL)
        status = scree_simulation_use_device(run->simulation, run->device, report);
    if (status != SCREE_OK) return status;
    run->start_step =
        (int64_t)(scree_simulation_time(run->simulation) / scree_simulation_time_step(run->simulation) + 0.5);
    const scree_run_folder_def def = {run->folder_path, &run->file, request->replace, request->restart};
    return scree_run_folder_open(&run->folder, &def, run->simulation, report);
}

/// Steps and outputs until the end, a signal or a failure. SCREE_INTERRUPTED on a signal.
static scree_status advance(run_state *run)
{
    const int64_t num_steps = scree_simulation_num_steps(run->simulation);
    scree_status status = SCREE_OK;
    if (run->start_step == 0) status = write_outputs(run, 0, num_steps == 0);
    for (int64_t step = run->start_step + 1; step <= num_steps && status == SCREE_OK; ++step)
    {
        if (stop_signal != 0) return SCREE_INTERRUPTED;
        status = scree_simulation_step(run->simulation, &run->report);
        if (status != SCREE_OK) run->is_lost = true;
        if (status == SCREE_OK) status = write_outputs(run, step, step == num_steps);
        if (status != SCREE_OK) break;
        warn_of_time_step(run);
        warn_of_inside(run);
        warn_of_lost_overlaps(run);
        warn_of_sharing(run);
        show_progress_sometimes(run);
    }
    return status;
}

static void tell_result(run_state *run)
{
    const scree_energies energies = scree_simulation_energies(run->simulation);
    const double seconds = wall_clock() - run->start_clock,
                 turned_over = scree_run_folder_energy_turned_over(run->folder);
    const int64_t num_steps = scree_simulation_num_steps(run->simulation) - run->start_step;
    const double particles = (double)scree_simulation_num_particles(run->simulation);
    char text[32];
    printf("finished in %s", format_duration(seconds, text));
    if (num_steps > 0) printf(", %.3g particle-steps/s", particles * (double)num_steps / seconds);
    if (turned_over > 0)
        printf(", energy error %.2g", (scree_energies_balance(&energies) - run->initial_energy) / turned_over);
    scree_repose repose;
    if (run->file.scene.repose.measure)
    {
        if (scree_simulation_repose(run->simulation, &repose) == SCREE_OK)
            printf(", angle of repose %.1f degrees", repose.angle_degrees);
        else printf(", no angle of repose: too few bins hold particles");
    }
    printf("\nresults in %s\n", run->folder_path);
}

/// The end of a run whose state is lost, because it left the range of numbers, or memory or a GPU failed.
static int conclude_lost(run_state *run, scree_status status)
{
    if (status == SCREE_UNSTABLE)
        scree_report_add(&run->report,
                         "the simulation is lost; the last checkpoint in %s is kept. Choose a smaller time.step, or "
                         "auto, and run again with --replace",
                         run->folder_path);
    write_summary(run, "failed");
    tell_report(run);
    char *path = checkpoint_path(run);
    const bool has_checkpoint = path != NULL && access(path, F_OK) == 0;
    free(path);
    if (status == SCREE_UNSTABLE) return SCREE_EXIT_FAILED;
    printf("the simulation is lost; %s\n", has_checkpoint ? "the last checkpoint is kept" : "there is no checkpoint");
    if (has_checkpoint) print_command_to_go_on(run);
    return SCREE_EXIT_FAILED;
}

/// Does the run go on from a checkpoint that leaves it no step to do?
static bool is_past_end(const run_state *run)
{
    return run->start_step > 0 && run->start_step >= scree_simulation_num_steps(run->simulation);
}

/// Last files and words; the exit code.
static int conclude(run_state *run, scree_status status)
{
    const bool is_quiet = run->request->is_quiet;
    if (!is_quiet && !run->is_lost && run->shown_clock > 0 && !is_past_end(run))
    {
        show_progress(run);
        if (run->is_terminal) putchar('\n');
        run->is_terminal = false;
    }
    if (status == SCREE_OK)
    {
        status = write_summary(run, "finished");
        if (status == SCREE_OK && !is_quiet) tell_result(run);
        return status == SCREE_OK ? SCREE_EXIT_DONE : SCREE_EXIT_FAILED;
    }
    if (run->is_lost) return conclude_lost(run, status);
    // stopped in a sound state, by a signal or because a file could not be written: it is kept if that is possible
    const scree_status saved = scree_run_folder_write_checkpoint(run->folder, run->simulation, &run->report);
    if (saved == SCREE_OK) write_summary(run, "interrupted");
    tell_report(run);
    tell_how_to_go_on(run, saved == SCREE_OK);
    return status == SCREE_INTERRUPTED && saved == SCREE_OK ? 128 + (int)stop_signal : SCREE_EXIT_FAILED;
}

static void catch_signals(void)
{
    struct sigaction action;
    memset(&action, 0, sizeof action);
    sigemptyset(&action.sa_mask);
    action.sa_handler = note_signal;
    action.sa_flags = (int)SA_RESETHAND;
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    // told by the write that fails, not by the end of the run
    action.sa_handler = SIG_IGN;
    action.sa_flags = 0;
    sigaction(SIGXFSZ, &action, NULL);
    sigaction(SIGPIPE, &action, NULL);
}

static int exit_code_of_refusal(const run_state *run, scree_status status)
{
    if (scree_report_num_faults(&run->report) == 0) fprintf(stderr, "scree run: %s\n", scree_status_text(status));
    const bool is_input = status == SCREE_INVALID_INPUT || status == SCREE_NOT_FOUND || status == SCREE_BAD_MESH ||
                          status == SCREE_READ_FAILED || status == SCREE_TOO_MANY;
    return is_input ? SCREE_EXIT_USAGE : SCREE_EXIT_FAILED;
}

static int run_scene(const run_request *request)
{
    run_state run;
    memset(&run, 0, sizeof run);
    run.request = request;
    run.is_terminal = isatty(STDOUT_FILENO) == 1;
    if (request->num_threads > 0) omp_set_num_threads(request->num_threads);
    scree_status status = prepare(&run);
    int exit_code = SCREE_EXIT_DONE;
    if (status != SCREE_OK) exit_code = exit_code_of_refusal(&run, status);
    tell_report(&run);
    if (status == SCREE_OK)
    {
        if (!request->is_quiet)
        {
            scree_simulation_print_plan(run.simulation, stdout);
            printf("  into %s, %d threads", run.folder_path, omp_get_max_threads());
            if (run.device != NULL) printf(", steps on GPU %d, \"%s\"", request->device, scree_device_name(run.device));
            if (run.start_step > 0) printf(", from step %lld on", (long long)run.start_step);
            putchar('\n');
            if (is_past_end(&run))
                printf("nothing is left to do: the checkpoint is at t = %g s, time.end is %g s\n",
                       scree_simulation_time(run.simulation), run.file.scene.time.end);
            fflush(stdout);
        }
        catch_signals();
        run.start_clock = run.shown_clock = run.watched_clock = wall_clock();
        run.shown_step = run.start_step;
        exit_code = conclude(&run, advance(&run));
    }
    if (scree_run_folder_close(run.folder, &run.report) != SCREE_OK && exit_code == SCREE_EXIT_DONE)
        exit_code = SCREE_EXIT_FAILED;
    tell_report(&run);
    scree_simulation_destroy(run.simulation);
    scree_device_close(run.device);
    scree_scene_close(&run.file);
    free(run.folder_path);
    return exit_code;
}

int scree_run_command(int argc, char **argv)
{
    // all files are closed by the time the program ends; after a full disk HDF5's own closing then would crash
    H5dont_atexit();
    run_request request = {
        .program = argv[0], .device = -1, .overrides = calloc((size_t)argc + 1, sizeof(const char *))};
    if (request.overrides == NULL) return SCREE_EXIT_FAILED;
    int exit_code = SCREE_EXIT_USAGE;
    if (parse_command_line(&request, argc, argv))
    {
        exit_code = SCREE_EXIT_DONE;
        if (request.wants_help) fputs(usage, stdout);
        else exit_code = run_scene(&request);
    }
    free(request.overrides);
    fflush(stdout);
    return exit_code;
}
