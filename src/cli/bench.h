/// \file bench.h
/// What the parts of scree bench share: the request, cases as JSON objects, tables of them, beds, measured steps.
#ifndef SCREE_BENCH_H
#define SCREE_BENCH_H

#include "dynamics/state.h"
#include "scree/scene.h"

#include <jansson.h>

/// The command line of a benchmark, understood. 0 and NULL: the benchmark's own choice.
typedef struct scree_bench_request
{
    const char *name;       ///< of the benchmark
    const char *shape;      ///< only this one
    const char *scene;      ///< file of the rig
    const char **overrides; ///< (num_overrides) of the scene
    int num_overrides;
    const char **words; ///< (num_words) of the command line that say what is measured
    int num_words;
    const char *json;     ///< where the result goes as JSON
    const char *baseline; ///< result to compare with
    const char *order;    ///< of particles in a bed: "lattice", "morton" or "random"
    double depth;         ///< mean indentation over the bounding diameter in a bed
    int64_t particles;
    int64_t triangles;
    int64_t steps; ///< in one repetition
    int64_t repetitions;
    int64_t search_every; ///< [steps] between searches in a bed; steps is a multiple of it
    int64_t threads;
    int64_t parts;      ///< of a run
    int32_t device;     ///< number of a GPU that the steps of beds are done on; -1: the CPU
    bool shows_savings; ///< each piece of avoided work is switched off in turn
} scree_bench_request;

/// A column of the table of a benchmark.
typedef struct scree_bench_column
{
    const char *key;    ///< of the case, "a.b" for b of the object a
    const char *header; ///< its width is the column's
    double factor;      ///< times the number; 0: a text
    int decimals;
} scree_bench_column;

/// A benchmark while it runs.
typedef struct scree_bench
{
    const scree_bench_request *request;
    const scree_bench_column *columns; ///< (num_columns)
    int num_columns;
    json_t *cases; ///< array of objects; each has "name", "core_seconds" (its main time) and, if repeated, "spread"
    scree_report *report;
    bool has_header;
    bool is_quiet; ///< no tables
} scree_bench;

/// Takes the case, keeps it and prints its row.
scree_status scree_bench_add(scree_bench *bench, json_t *measured);
/// The benchmark's own table head; more than one table is allowed.
void scree_bench_set_columns(scree_bench *bench, const scree_bench_column *columns, int num_columns);

/// Repeated measurements of one thing.
typedef struct scree_bench_samples
{
    double *values; ///< (num), sorted
    int num;
} scree_bench_samples;

/// Sorts them.
void scree_bench_sort(scree_bench_samples samples);
double scree_bench_median(scree_bench_samples samples);
/// Largest minus smallest over the median, the noise of a measurement.
double scree_bench_spread(scree_bench_samples samples);
/// The spread to a case under a key, unless there is but one sample: that tells no noise.
void scree_bench_set_noise(json_t *measured, const char *key, scree_bench_samples samples);
/// [s] of all threads of this process.
double scree_bench_core_seconds(void);
double scree_bench_wall_seconds(void);
/// splitmix64, in [0, 1).
double scree_bench_uniform(uint64_t *state);

/// Processor, its threads, compiler, precision.
json_t *scree_bench_machine(void);
/// A GPU by itself, to be called while it is not in use: name, free memory, bytes that a copy within it reads and
/// writes in a second. Those of scree_device_open().
scree_status scree_bench_device(int32_t number, json_t **described, scree_report *report);
/// The result of this benchmark in a file, to be freed by json_decref. SCREE_READ_FAILED, SCREE_INVALID_INPUT.
scree_status scree_bench_read_baseline(const scree_bench_request *request, json_t **baseline, scree_report *report);
/// Prints ratios of the cases to those of a baseline.
void scree_bench_compare(const scree_bench *bench, const json_t *baseline);

/// A dense bed of equal bodies.
typedef struct scree_bench_bed
{
    const char *shape; ///< "cube", "schoenhardt", "rock" or "sphere"
    int64_t triangles; ///< of a rock
    int64_t particles;
    double pairs_per_particle;    ///< that touch, at most, in its inside
    double depth;                 ///< wanted mean indentation over the bounding diameter
    const char *order;            ///< of the particles
    const char *solver;           ///< keys of section solver, or ""
    const scree_simulation *like; ///< takes the places of the bodies from this bed of the same bodies; NULL: made
} scree_bench_bed;

/// Owns the scene and the simulation of it.
typedef struct scree_bench_bodies
{
    scree_scene_file file;
    scree_simulation *simulation;
    double depth; ///< mean indentation of the touching pairs over the bounding diameter
} scree_bench_bodies;

/// Lattice, jittered, orientations at random, pushed apart until the mean indentation is as wanted and no more pairs
/// touch than wanted.
scree_status scree_bench_bed_create(scree_bench_bodies *bodies, const scree_bench_bed *bed, scree_report *report);
void scree_bench_bed_destroy(scree_bench_bodies *bodies);
/// The bodies of a simulation to the places that those of another have.
scree_status scree_bench_copy_places(scree_simulation *s, const scree_simulation *from, scree_report *report);

/// Beads at rest in a drum of meshes with lifters, filled as scenes/tumbling_mill_full.yaml: in drums[0] without the
/// walls, in drums[1] with them, in the same places. Each to be destroyed as a bed.
scree_status scree_bench_drum_create(scree_bench_bodies drums[2], int64_t num_beads, scree_report *report);

/// What the plan of a simulation says of one item, and what the whole process takes [bytes].
json_t *scree_bench_memory(const scree_simulation *simulation);

/// Seconds of each repetition of some steps, whole and per stage.
typedef struct scree_bench_times
{
    double *core, *wall;                                                 ///< (num)
    double *stage_core[SCREE_NUM_STAGES], *stage_wall[SCREE_NUM_STAGES]; ///< (num)
    int num;
    int64_t num_searches; ///< in all
} scree_bench_times;

/// False if memory is out.
bool scree_bench_times_create(scree_bench_times *times, int num);
void scree_bench_times_destroy(scree_bench_times *times);
/// A share of the times of the stages to those of repetition r.
void scree_bench_times_set_stages(scree_bench_times *times, int r, const scree_stage_times *stages, double share);
/// Medians, spread and all whole times to a case, times of stages also for each of num_contacts. Sorts the times.
void scree_bench_times_describe(scree_bench_times *times, double num_contacts, json_t *measured);

/// A simulation and on how many threads its steps are done.
typedef struct scree_bench_way
{
    scree_simulation *simulation;
    int threads;
} scree_bench_way;

/// Beads at the beginning of their fall into that drum, twice: by the automatic skin, and by one of a tenth.
scree_status scree_bench_falling_create(scree_bench_bodies twins[2], int64_t num_beads, scree_report *report);

/// Measures steps of one simulation, or of two in turn, so that both meet the same state of the machine: a case for
/// each, with medians of times per stage, touching pair and candidate, and bytes. The second of two has the median
/// ratio of its times to those of the first in the same turn, elapsed ones if the numbers of threads differ, and their
/// spread. With search_every > 0 candidate pairs are searched that often. The cases are NULL if a step fails.
scree_status scree_bench_steps(const scree_bench_way *ways, int num_ways, const scree_bench_request *request,
                               json_t **cases, scree_report *report);
/// The columns that go with it.
extern const scree_bench_column scree_bench_step_columns[];
extern const int scree_bench_num_step_columns;

scree_status scree_bench_overlap(scree_bench *bench);
scree_status scree_bench_broad_phase(scree_bench *bench);
scree_status scree_bench_packing(scree_bench *bench);
scree_status scree_bench_spheres(scree_bench *bench);
scree_status scree_bench_rig(scree_bench *bench);
scree_status scree_bench_scene(scree_bench *bench);
scree_status scree_bench_scaling(scree_bench *bench);

#endif
