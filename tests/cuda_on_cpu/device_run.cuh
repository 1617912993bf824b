/// \file device_run.cuh
/// For tests of whole steps: a simulation on the device beside the same one on the CPU. Define _XOPEN_SOURCE 700
/// before.
#ifndef CUDA_ON_CPU_DEVICE_RUN_CUH
#define CUDA_ON_CPU_DEVICE_RUN_CUH

extern "C"
{
#include "core/device.h"
#include "dynamics/on_device.h"
#include "dynamics/step_buffers.h"
#include "scene_run.h"
}
#include "device_array.cuh"

#include <string>

#ifdef CUDA_ON_CPU_ADDRESS
#define SCREE_TEST_ARENA_BYTES 0
#else
#define SCREE_TEST_ARENA_BYTES (1 << 20)
#endif

/// Bytes of a block of the arena; 0 where a sanitizer looks for the ends of the arrays.
inline int64_t usual_arena()
{
    const char *arena = std::getenv("SCREE_TEST_ARENA");
    return arena != nullptr ? std::strtoll(arena, nullptr, 10) : SCREE_TEST_ARENA_BYTES;
}

inline scree_device *open_device(int32_t block, bool records = true, int64_t arena_bytes = usual_arena())
{
    scree_device_def def = scree_default_device_def();
    def.block = block;
    def.records = records;
    def.arena_bytes = arena_bytes;
    scree_device *device = nullptr;
    scree_report report = {};
    if (scree_device_open(&device, &def, &report) == SCREE_OK) return device;
    for (int k = 0; k < report.num_messages; ++k) printf("%s\n", report.messages[k]);
    std::exit(EXIT_FAILURE);
}

inline void steps(scree_simulation *s, int64_t num)
{
    scree_report report = {};
    for (int64_t k = 0; k < num; ++k)
    {
        const scree_status status = scree_simulation_step(s, &report);
        SCREE_CHECK_INT(status, SCREE_OK);
        if (status == SCREE_OK) continue;
        for (int m = 0; m < report.num_messages; ++m) printf("%s\n", report.messages[m]);
        break;
    }
    scree_report_clear(&report);
}

inline void move(scree_simulation *s, scree_device *device)
{
    scree_report report = {};
    SCREE_CHECK_INT(scree_simulation_use_device(s, device, &report), SCREE_OK);
    for (int m = 0; m < report.num_messages; ++m) printf("%s\n", report.messages[m]);
    scree_report_clear(&report);
}

template <class T> inline bool is_same(const T &a, const T &b) { return memcmp(&a, &b, sizeof a) == 0; }

inline bool are_same(const double *a, const double *b, int64_t num)
{
    return memcmp(a, b, (size_t)num * sizeof *a) == 0;
}

/// Everything that can be asked of the two is the same.
inline void check_same(scree_simulation *here, scree_simulation *there)
{
    SCREE_CHECK_INT(scree_simulation_observe(there, NULL), SCREE_OK);
    SCREE_CHECK(scree_simulation_hash(here) == scree_simulation_hash(there));
    SCREE_CHECK(is_same(scree_simulation_energies(here), scree_simulation_energies(there)));
    scree_counters a = scree_simulation_counters(here), b = scree_simulation_counters(there);
    b.num_rebuilds = a.num_rebuilds; // one more where the side was changed
    b.num_pairs = a.num_pairs;
    SCREE_CHECK(is_same(a, b));
    for (int32_t w = 0; w < here->num_walls; ++w)
        SCREE_CHECK(is_same(scree_simulation_wall_load(here, w), scree_simulation_wall_load(there, w)));
    const int64_t n = here->contacts.num_contacts;
    SCREE_CHECK_INT(there->contacts.num_contacts, n);
    for (int64_t c = 0; c < n && n == there->contacts.num_contacts; ++c)
        SCREE_CHECK(is_same(here->contacts.normal_force[c], there->contacts.normal_force[c]) &&
                    is_same(here->contacts.elastic_energy[c], there->contacts.elastic_energy[c]) &&
                    is_same(here->contacts.moment[c], there->contacts.moment[c]));
    if (!here->averages.is_on) return;
    const scree_averages *p = &here->averages, *q = &there->averages;
    SCREE_CHECK_INT(p->num_samples, q->num_samples);
    SCREE_CHECK_INT(p->num_periods, q->num_periods);
    SCREE_CHECK(are_same(p->grid.momentum, q->grid.momentum, 3 * p->grid.num_cells));
    SCREE_CHECK(are_same(p->grid_total.square, q->grid_total.square, p->grid.num_cells));
    SCREE_CHECK(are_same(p->spectrum.energy_normal, q->spectrum.energy_normal, p->spectrum.num_rows));
    SCREE_CHECK(
        are_same(p->spectrum_total.energy_tangential, q->spectrum_total.energy_tangential, p->spectrum.num_rows));
    SCREE_CHECK(are_same(p->works.total, q->works.total, p->works.num_walls));
    SCREE_CHECK(are_same(p->collisions.normal, q->collisions.normal, n));
}

#endif
