/// \file simulation.h
/// A simulation: made from a scene, advanced step by step, looked at through energies and counters.
#ifndef SCREE_SIMULATION_H
#define SCREE_SIMULATION_H

#include "scree/types.h"

#ifdef __cplusplus
extern "C"
{
#endif

    typedef struct scree_simulation scree_simulation;

    /// Where the energy is [J]. balance() of a run: kinetic + rotational + potential + elastic + dissipated - input
    /// stays what it was at the start.
    typedef struct scree_energies
    {
        double kinetic; ///< of translation
        double rotational;
        double potential;          ///< gravity, zero at the origin
        double elastic_normal;     ///< of the normal forces of present contacts
        double elastic_tangential; ///< of the tangential, torsion and rolling springs of present contacts
        double damping;            ///< dissipated by normal and tangential damping, accumulated
        double friction;           ///< dissipated by slip and lost tangential springs, accumulated
        double hysteresis; ///< work against the elastic normal forces that elastic_normal did not take up, accumulated;
                           ///< Hertz on the overlap volume is not the gradient of an energy, so it may have either sign
        double input;      ///< put in by moving walls, accumulated
    } scree_energies;

    /// Kinetic + rotational + potential + elastic + dissipated - input [J].
    double scree_energies_balance(const scree_energies *energies);

    typedef struct scree_counters
    {
        int64_t num_pairs;             ///< candidate pairs now
        int64_t num_contacts;          ///< contacts now
        int64_t num_rebuilds;          ///< neighbour searches so far
        int64_t num_without_normal;    ///< overlaps above rounding without a normal so far: no force
        int64_t num_inside;            ///< centres of spheres met inside the solid of a mesh so far, step by step
        int64_t num_fallbacks;         ///< overlaps repeated with the hierarchy so far
        double worst_residual;         ///< worst certificate so far
        double largest_indentation;    ///< [m] so far
        double smallest_critical_step; ///< [s] smallest sqrt(m_eff/k_eff) over contacts so far
    } scree_counters;

    /// Makes shapes, particles and walls from a scene, which must outlive the simulation. `folder` is where mesh files
    /// are looked for. All faults go to the report. The state is that of time 0 with the forces of that moment.
    scree_status scree_simulation_create(scree_simulation **simulation, const scree_scene *scene, const char *folder,
                                         scree_report *report);
    void scree_simulation_destroy(scree_simulation *simulation);

    typedef struct scree_device scree_device;

    /// From now on steps are done on a GPU, which must outlive the simulation; same bits. Particles and contacts here
    /// are those of the last scree_simulation_observe(). Refused with a message: SCREE_OUT_OF_MEMORY if the scene does
    /// not fit there, SCREE_DEVICE_FAILED, SCREE_INVALID_INPUT for the CPU or a second call.
    scree_status scree_simulation_use_device(scree_simulation *simulation, scree_device *device, scree_report *report);
    /// Particles and contacts to the order of ids, where steps may have left it, and up to date with the GPU that steps
    /// are done on. Call before anything is written or asked but time and counters; on the CPU energies are right
    /// without it, up to the rounding of their sums. SCREE_DEVICE_FAILED, SCREE_OUT_OF_MEMORY.
    scree_status scree_simulation_observe(scree_simulation *simulation, scree_report *report);

    /// Stages of a step, in their order.
#define SCREE_STAGE_LIST(X)             \
    X(SCREE_STAGE_PREDICT, "predict")   \
    X(SCREE_STAGE_TRAVEL, "travel")     \
    X(SCREE_STAGE_SEARCH, "search")     \
    X(SCREE_STAGE_CONTACTS, "contacts") \
    X(SCREE_STAGE_HISTORY, "history")   \
    X(SCREE_STAGE_FORCES, "forces")     \
    X(SCREE_STAGE_GATHER, "gather")     \
    X(SCREE_STAGE_CORRECT, "correct")   \
    X(SCREE_STAGE_WORK, "work")         \
    X(SCREE_STAGE_OTHER, "other")

    typedef enum scree_stage
    {
#define SCREE_STAGE_ENUMERATOR(name, text) name,
        SCREE_STAGE_LIST(SCREE_STAGE_ENUMERATOR)
#undef SCREE_STAGE_ENUMERATOR
            SCREE_NUM_STAGES
    } scree_stage;

    const char *scree_stage_name(scree_stage stage);

    /// Time of the stages, summed up over steps.
    typedef struct scree_stage_times
    {
        double wall[SCREE_NUM_STAGES]; ///< [s] elapsed
        double core[SCREE_NUM_STAGES]; ///< [s] of the processors, all threads of the process
    } scree_stage_times;

    /// From now on every step adds its times to *times, which must outlive that; NULL stops it.
    void scree_simulation_time_stages(scree_simulation *simulation, scree_stage_times *times);

    /// One step. SCREE_OUT_OF_MEMORY, SCREE_UNSTABLE and SCREE_DEVICE_FAILED lose the simulation.
    scree_status scree_simulation_step(scree_simulation *simulation, scree_report *report);

    double scree_simulation_time(const scree_simulation *simulation); ///< [s]
    /// [s] of which particles and contacts here are: now, or with a GPU when they were last observed.
    double scree_simulation_observed_time(const scree_simulation *simulation);
    double scree_simulation_time_step(const scree_simulation *simulation);  ///< [s]
    int64_t scree_simulation_num_steps(const scree_simulation *simulation); ///< steps that the scene's end asks for
    int64_t scree_simulation_num_particles(const scree_simulation *simulation);
    /// Energies at the present moment.
    scree_energies scree_simulation_energies(const scree_simulation *simulation);
    scree_counters scree_simulation_counters(const scree_simulation *simulation);
    /// What a moving wall does to the particles along its motion.
    typedef struct scree_wall_load
    {
        double load; ///< now: torque about the axis of a wall that rotates [N m], force along the velocity of one that
                     ///< translates [N]
        double work; ///< [J] done on the particles so far
        int64_t num_revolutions; ///< whole ones so far
        double revolution_power; ///< [W] mean over the last whole revolution; 0 before the first
    } scree_wall_load;

    /// Of wall number `wall` of the scene; zeros for one that never moves. The works of all walls sum up to the energy
    /// `input`.
    scree_wall_load scree_simulation_wall_load(const scree_simulation *simulation, int32_t wall);
    /// 64-bit hash of the moving state; equal states have equal hashes.
    uint64_t scree_simulation_hash(const scree_simulation *simulation);

    /// Result of the fit of section "repose" of the scene.
    typedef struct scree_repose
    {
        double angle_degrees;             ///< steepest slope of the fitted sigmoid
        double height, steepness, middle; ///< c [m], a [1/m], b [m] of h(x) = c/(1 + exp(a (x - b)))
        double residual;                  ///< [m] root mean square of the fit
        int64_t num_bins;
        double bin_x[256];      ///< [m] middles
        double bin_height[256]; ///< [m] largest height of a vertex, or of the top of a sphere, above the plate
    } scree_repose;

    /// Angle of repose of the present state. SCREE_INVALID_INPUT if fewer than 4 bins hold particles.
    scree_status scree_simulation_repose(const scree_simulation *simulation, scree_repose *repose);

    /// Prints the plan: stages, why each is in, bytes per particle or contact. `stream` is a FILE *.
    void scree_simulation_print_plan(const scree_simulation *simulation, void *stream);

#ifdef __cplusplus
}
#endif
#endif
