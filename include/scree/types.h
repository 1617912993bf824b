/// \file types.h
/// The scene: everything a run is made from, as plain definitions in SI units. scree_scene_read() fills it from YAML;
/// names are resolved to indices when the simulation is made. Fields marked "auto" are NAN (numbers) while automatic.
#ifndef SCREE_TYPES_H
#define SCREE_TYPES_H

#include "scree/base.h"

#ifdef __cplusplus
extern "C"
{
#endif

    typedef struct scree_material_def
    {
        char *name;
        double density;        ///< [kg/m^3]
        double youngs_modulus; ///< [Pa]
        double poisson_ratio;  ///< [1]
        double shear_modulus;  ///< [Pa]; auto: E / (2 (1 + nu))
    } scree_material_def;

    /// Which 1/G* a pair uses (physics: section 1).
    typedef enum scree_shear_mixing
    {
        SCREE_SHEAR_MINDLIN, ///< (2 - nu1)/G1 + (2 - nu2)/G2
        SCREE_SHEAR_BILOCK   ///< (1 - nu1^2)/G1 + (1 - nu2^2)/G2, Bilock (2020), eq. 4.11
    } scree_shear_mixing;

    /// Moment against rolling (Ai, Chen, Rotter & Ooi 2011).
    typedef enum scree_rolling_resistance_kind
    {
        SCREE_ROLLING_NONE,
        SCREE_ROLLING_CONSTANT, ///< type A: constant moment against the relative rotation
        SCREE_ROLLING_SPRING    ///< type C: spring with limit
    } scree_rolling_resistance_kind;

    typedef struct scree_contact_law_def
    {
        char *materials[2];                  ///< names of the two materials, in any order
        char *model;                         ///< name in the registry of force models, default "hertz_mindlin"
        double friction_coefficient;         ///< [1]
        double restitution_coefficient;      ///< [1]; auto if damping_ratio is given; exactly one of the two
        double damping_ratio;                ///< [1] g of 2 g sqrt(m* k) v; auto: from the restitution coefficient
        double tangential_damping_ratio;     ///< [1] auto: damping_ratio
        double stiffness_factor;             ///< [1] of E*; auto: what is Hertz's between spheres
        double energy_exponent;              ///< [1] of energy_conserving; auto: 1.25
        double normal_stiffness;             ///< [N/m] of linear_spring, auto otherwise
        double tangential_stiffness;         ///< [N/m] of linear_spring; auto: normal_stiffness 4 G*/E*
        double tangential_spring;            ///< [1] 1: with tangential history, 0: tangential damping alone
        double rolling_friction_coefficient; ///< [1] of a rolling resistance, auto without
        double rolling_damping_ratio;        ///< [1] of a rolling spring, default 0
        scree_rolling_resistance_kind rolling_resistance;
        bool attraction;      ///< true: the total normal force may turn attractive at separation
        bool contact_moments; ///< default true: springs and dashpots of a contact resist twisting and rocking too
        scree_shear_mixing shear_mixing;
    } scree_contact_law_def;

    typedef enum scree_shape_source
    {
        SCREE_SHAPE_FILE,
        SCREE_SHAPE_BOX,
        SCREE_SHAPE_TETRAHEDRON,
        SCREE_SHAPE_SCHOENHARDT,
        SCREE_SHAPE_SPHERE,
        SCREE_SHAPE_ROCK,
        SCREE_SHAPE_TURNED,
        SCREE_SHAPE_CLUMP
    } scree_shape_source;

    /// Corner of a profile that is turned about z.
    typedef struct scree_profile_point
    {
        double radius; ///< [m] distance from the axis
        double height; ///< [m] along it
    } scree_profile_point;

    /// Sphere of a clump.
    typedef struct scree_clump_sphere
    {
        double position[3]; ///< [m] of its centre
        double radius;      ///< [m]
    } scree_clump_sphere;

    /// Filling of a mesh with the spheres of a clump.
    typedef struct scree_clump_fill_def
    {
        char *shape;     ///< name of the shape that is filled; "": none
        int64_t spheres; ///< how many
    } scree_clump_fill_def;

    typedef struct scree_shape_def
    {
        char *name;
        scree_shape_source source;
        char *file;        ///< mesh file, relative to the scene's folder; only for source file
        double scale;      ///< [1] factor of the coordinates of a file, default 1
        double size[3];    ///< [m] edge lengths of a box; first one: diameter of the enclosing sphere of the others
        int64_t triangles; ///< wanted number of triangles (sphere, rock); of a file: simplified to it; 0: as it is
        int64_t seed;      ///< of a rock
        scree_profile_point *profile; ///< of turned: closed polygon
        uint32_t num_profile;
        int64_t segments;            ///< of turned: sides of the cross-sections
        scree_clump_sphere *spheres; ///< of a clump
        uint32_t num_spheres;
        scree_clump_fill_def fill; ///< of a clump, instead of spheres
        double offset[3];          ///< [m] added to every vertex
        int64_t copies;            ///< of the shifted mesh, turned evenly about z: one body of several pieces
    } scree_shape_def;

    typedef enum scree_size_distribution
    {
        SCREE_SIZE_AS_SHAPE, ///< scale 1: the shape's own size
        SCREE_SIZE_FIXED,    ///< mean
        SCREE_SIZE_UNIFORM,  ///< between min and max
        SCREE_SIZE_NORMAL    ///< mean, deviation, truncated to min .. max by drawing again
    } scree_size_distribution;

    /// Size of a particle: the middle one of the three extents of its box in the body frame.
    typedef struct scree_size_def
    {
        scree_size_distribution distribution;
        double mean, deviation, min, max; ///< [m]
    } scree_size_def;

    /// One particle placed by hand.
    typedef struct scree_body_def
    {
        double position[3];         ///< [m] of the centroid
        double orientation[4];      ///< (w, x, y, z) of the shape as given by its source, default identity
        double size;                ///< [m] middle size; auto: drawn from the group's size section
        double velocity[3];         ///< [m/s]
        double angular_velocity[3]; ///< [rad/s], world axes
    } scree_body_def;

    typedef enum scree_axis
    {
        SCREE_AXIS_NONE,
        SCREE_AXIS_X,
        SCREE_AXIS_Y,
        SCREE_AXIS_Z
    } scree_axis;

    /// A box, or the cylinder in it.
    typedef struct scree_region_def
    {
        double min[3], max[3]; ///< [m]
        scree_axis cylinder;   ///< only the cylinder along this axis, through the middle, as wide as the box is narrow
    } scree_region_def;

    /// Particles of one shape and material: either listed one by one in `bodies`, or filled into a region.
    typedef struct scree_particle_group_def
    {
        char *name;
        char *shape;
        char *material;
        scree_size_def size;
        int64_t count;           ///< number to fill in; 0: by mass
        double mass;             ///< [kg] total to fill in; 0: by count
        scree_region_def region; ///< to fill, from the bottom up; groups with the same one are mixed
        double spacing;          ///< [1] distance of the lattice over the largest bounding diameter, default 1.05
        int64_t seed;            ///< of sizes, orientations, jitter and mixing
        double velocity[3];      ///< [m/s] initial
        scree_body_def *bodies;
        uint32_t num_bodies;
    } scree_particle_group_def;

    typedef enum scree_motion_kind
    {
        SCREE_MOTION_FIXED,
        SCREE_MOTION_TRANSLATE,
        SCREE_MOTION_ROTATE
    } scree_motion_kind;

    /// Prescribed motion of a wall between two times; at rest before and after.
    typedef struct scree_motion_def
    {
        scree_motion_kind kind;
        double velocity[3];      ///< [m/s] translate
        double axis[3];          ///< rotate: direction, any length > 0
        double centre[3];        ///< [m] rotate: a point of the axis
        double angular_velocity; ///< [rad/s] rotate
        double start, end;       ///< [s]; default 0 and never
        bool opens;              ///< may part from, or slide through, walls that it touches at the start; default false
    } scree_motion_def;

    typedef struct scree_wall_def
    {
        char *name;
        char *shape;
        char *material;
        double position[3];    ///< [m] of the origin of the shape's source frame
        double orientation[4]; ///< (w, x, y, z)
        scree_motion_def motion;
        double removed_at; ///< [s] gone from then on; default never
    } scree_wall_def;

    typedef struct scree_time_def
    {
        double end;           ///< [s]
        double step;          ///< [s]; auto: from the stiffness of the contacts
        double step_fraction; ///< [1] share of the critical step that auto takes, default 0.5
    } scree_time_def;

    /// Intervals of output; 0 switches that output off.
    typedef struct scree_output_def
    {
        double series;     ///< [s] rows of series.csv
        double frames;     ///< [s] steps of frames.vtkhdf
        double checkpoint; ///< [s] of simulated time
    } scree_output_def;

    /// Angle of repose measured at the end: heights in bins along x, sigmoid fitted (Bilock 2020, 6.3).
    typedef struct scree_repose_def
    {
        bool measure;
        double from, to; ///< [m] range of x
        double base;     ///< [m] height of the plate
        double top;      ///< [m] particles whose centre is higher do not count; default 1e6
        int64_t bins;    ///< default 20
    } scree_repose_def;

    /// Averages over time, kept while the run goes on.
    typedef struct scree_fields_def
    {
        bool measure;
        scree_region_def region;       ///< box of the grid
        double cells[3];               ///< along x, y, z; whole numbers
        double from;                   ///< [s] when the first period begins
        double period;                 ///< [s]; auto: one revolution of the wall
        char *wall;                    ///< "" if the period is given
        int64_t samples;               ///< of the fields in a period, default 200
        int64_t energy_bins;           ///< of the energies of collisions; default 0: not measured
        double energy_min, energy_max; ///< [J] range of the bins
    } scree_fields_def;

    typedef struct scree_solver_def
    {
        double skin;           ///< [1] share of the mean bounding radius added to the boxes; auto: of least cost
        char *overlap_scheme;  ///< "filtered" (default) or "hierarchy"
        bool separate_patches; ///< default false: one contact for all pieces of an overlap

        // avoided work, all by default; the results are the same without
        bool reuse_pairs;         ///< candidate pairs serve until a body may have left its skin
        bool reorder_particles;   ///< those that have mixed change places in memory, to be near their neighbours
        bool compare_spheres;     ///< candidates are those whose bounding spheres overlap, not only their boxes
        bool find_separation;     ///< meshes are asked for a plane between them before their overlap
        bool remember_separation; ///< that plane is tried first the next time
        bool bound_separation;    ///< nothing is asked until the bodies may have travelled through the gap
    } scree_solver_def;

    typedef struct scree_scene
    {
        char *name;
        double gravity[3]; ///< [m/s^2]
        scree_time_def time;
        scree_material_def *materials;
        uint32_t num_materials;
        scree_contact_law_def *contact_laws;
        uint32_t num_contact_laws;
        scree_shape_def *shapes;
        uint32_t num_shapes;
        scree_particle_group_def *particles;
        uint32_t num_particles; ///< number of groups
        scree_wall_def *walls;
        uint32_t num_walls;
        scree_solver_def solver;
        scree_output_def output;
        scree_repose_def repose;
        scree_fields_def fields;
    } scree_scene;

#ifdef __cplusplus
}
#endif
#endif
