// A step takes no memory but when candidate pairs are searched: calls of the allocator are counted in steady steps.
// Those of the OpenMP library are not: GNU's takes a block of its own for each parallel region and gives it back.
#define _GNU_SOURCE
#include "scene_run.h"

#include <dlfcn.h>
#include <omp.h>
#include <stdatomic.h>
#include <stddef.h>

#if defined(SCREE_CHECKED) || !defined(__GLIBC__) // checks take memory, sanitizers have an allocator of their own

int main(void)
{
    printf("skipped: in this build the allocator cannot be watched, or checks take memory\n");
    return 77;
}

#else

static atomic_bool is_counting;
static atomic_long num_calls, num_calls_of_openmp;

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t num, size_t size);
void *__libc_realloc(void *old, size_t size);
void *__libc_memalign(size_t alignment, size_t size);

static void count(const void *caller)
{
    Dl_info info;
    if (!is_counting) return;
    if (dladdr(caller, &info) != 0 && info.dli_fname != NULL && strstr(info.dli_fname, "omp.so") != NULL)
        ++num_calls_of_openmp;
    else ++num_calls;
}

#define COUNT_CALL() count(__builtin_extract_return_addr(__builtin_return_address(0)))

// these take the place of the library's for the whole program; free() stays
void *malloc(size_t size)
{
    COUNT_CALL();
    return __libc_malloc(size);
}

void *calloc(size_t num, size_t size)
{
    COUNT_CALL();
    return __libc_calloc(num, size);
}

void *realloc(void *old, size_t size)
{
    COUNT_CALL();
    return __libc_realloc(old, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    COUNT_CALL();
    return __libc_memalign(alignment, size);
}

void *memalign(size_t alignment, size_t size)
{
    COUNT_CALL();
    return __libc_memalign(alignment, size);
}

int posix_memalign(void **memory, size_t alignment, size_t size)
{
    COUNT_CALL();
    *memory = __libc_memalign(alignment, size);
    return *memory != NULL ? 0 : 12; // ENOMEM
}

static const char head[] =
    "name: steady\n"
    "time: {end: 0.2, step: 5e-5}\n"
    "materials: [{name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}]\n"
    "contact_laws: [{materials: [stone, stone], friction_coefficient: 0.4, damping_ratio: 0.3}]\n"
    "walls:\n"
    "  - {name: floor, shape: floor, material: stone, position: [0, 0, -0.01]}\n"
    "  - {name: paddle, shape: paddle, material: stone, position: [0, 0, 0.053],\n"
    "     motion: {kind: rotate, axis: [0, 0, 1], angular_velocity: 5}}\n"
    "fields: {measure: true, region: {min: [-0.2, -0.2, 0], max: [0.2, 0.2, 0.4]}, cells: [8, 8, 8], period: 0.02,\n"
    "  samples: 50, energy_bins: 20}\n"
    "shapes:\n"
    "  - {name: floor, source: box, size: [0.4, 0.4, 0.02]}\n"
    "  - {name: paddle, source: box, size: [0.14, 0.01, 0.1]}\n";

static const char spheres[] =
    "  - {name: ball, source: sphere, size: 0.012}\n"
    "particles:\n"
    "  - {name: balls, shape: ball, material: stone, count: 400, seed: 1, velocity: [0, 0, -1],\n"
    "     region: {min: [-0.07, -0.07, 0.12], max: [0.07, 0.07, 0.4]}}\n";

static const char polyhedra[] =
    "  - {name: rock, source: rock, triangles: 40, seed: 3}\n"
    "  - {name: schoenhardt, source: schoenhardt, size: [0.02, 0, 0]}\n"
    "particles:\n"
    "  - {name: rocks, shape: rock, material: stone, count: 60, seed: 1, velocity: [0, 0, -1],\n"
    "     size: {distribution: uniform, min: 0.01, max: 0.02},\n"
    "     region: {min: [-0.07, -0.07, 0.12], max: [0.07, 0.07, 0.3]}}\n"
    "  - {name: twisted, shape: schoenhardt, material: stone, count: 40, seed: 2, velocity: [0, 0, -1],\n"
    "     region: {min: [-0.07, -0.07, 0.3], max: [0.07, 0.07, 0.5]}}\n";

/// Collisions that have ended so far.
static int64_t num_ended(const scree_simulation *s)
{
    const scree_spectrum *both[2] = {&s->averages.spectrum, &s->averages.spectrum_total};
    int64_t num = 0;
    for (int k = 0; k < 2; ++k)
        for (int64_t row = 0; row < both[k]->num_rows; ++row) num += both[k]->count_normal[row];
    return num;
}

/// The number of steps that searched nothing and those of them that took memory, after a warm-up.
static void check_steps(const char *bodies, int num_threads)
{
    char text[4096];
    snprintf(text, sizeof text, "%s%s", head, bodies);
    omp_set_num_threads(num_threads);
    scene_run run;
    scene_run_start(&run, text);
    scree_simulation *s = run.simulation;
    if (s == NULL) return;
    scene_run_until(&run, 0.1);
    const int64_t periods = s->averages.num_periods;
    int64_t num_steps = 0, num_taking = 0, num_in_search = 0, ended = 0;
    is_counting = true;
    while (s->step < scree_simulation_num_steps(s))
    {
        const int64_t searches = s->counters.num_rebuilds, before = num_ended(s);
        const long calls = num_calls;
        SCREE_CHECK_INT(scree_simulation_step(s, &run.report), SCREE_OK);
        const bool has_taken = num_calls != calls;
        if (s->counters.num_rebuilds != searches)
        {
            num_in_search += has_taken;
            continue;
        }
        ++num_steps;
        num_taking += has_taken;
        ended += num_ended(s) - before;
    }
    is_counting = false;
    printf("%d threads: %d steps without a search, %d of them take memory; %d collisions ended in them, %d contacts\n",
           num_threads, (int)num_steps, (int)num_taking, (int)ended, (int)s->contacts.num_contacts);
    printf("  %d searches took memory\n", (int)num_in_search);
    printf("  the OpenMP library took memory %ld times\n", (long)num_calls_of_openmp);
    SCREE_CHECK(num_steps > 1000);
    SCREE_CHECK_INT(num_taking, 0);
    // they had to do all that a step may have to do
    SCREE_CHECK(ended > 20);
    SCREE_CHECK(s->averages.num_periods > periods + 3);
    SCREE_CHECK(s->contacts.num_contacts > 20);
    scene_run_end(&run);
}

static void test_the_allocator_is_watched(void)
{
    is_counting = true;
    void *volatile memory = malloc(10);
    SCREE_CHECK_INT((int)num_calls, 1);
    // what the library takes, too
    scene_run run;
    char text[4096];
    snprintf(text, sizeof text, "%s%s", head, spheres);
    scene_run_start(&run, text);
    SCREE_CHECK(num_calls > 10);
    is_counting = false;
    free(memory);
    scene_run_end(&run);
}

static void test_steps_of_spheres_take_no_memory(void)
{
    check_steps(spheres, 1);
    check_steps(spheres, 2);
}

static void test_steps_of_polyhedra_take_no_memory(void)
{
    check_steps(polyhedra, 1);
    check_steps(polyhedra, 2);
}

int main(void)
{
    SCREE_RUN(test_the_allocator_is_watched);
    SCREE_RUN(test_steps_of_spheres_take_no_memory);
    SCREE_RUN(test_steps_of_polyhedra_take_no_memory);
    return SCREE_TEST_END();
}

#endif
