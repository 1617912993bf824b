/// \file contact_list.h
/// The contacts of the present step in SoA form, sorted by the place of i, the id of j and patch, with the history that
/// follows each of them.
#ifndef SCREE_CONTACT_LIST_H
#define SCREE_CONTACT_LIST_H

#include "bvh/broad_phase.h"
#include "core/scratch.h"

/// Bits of a patch that count the contacts of one part of a pair. Above them stands the part: which two spheres of
/// clumps, or which sphere of a clump on a mesh; 0 between other bodies. A part stays the same from step to step, so
/// history never passes from one sphere to another.
#define SCREE_PATCH_BITS 15

/// Owns its arrays, all (num_contacts) unless stated. Start from {0}, or from {.device = ...} for a list on a GPU.
/// The id of i is smaller than that of j, which may be a wall. Vectors in world axes. What a scene has no use for stays
/// zero, is not touched, takes no memory, and is NULL on a GPU; the arrays marked + and ++ are what is known of the
/// step before.
typedef struct scree_contact_list
{
    int64_t num_contacts;
    int64_t max_contacts; ///< room of the arrays without +, which lie in one block
    int64_t max_carried;  ///< room of the arrays with +
    int64_t max_pairs;
    scree_device *device;   ///< where the arrays lie, NULL: the CPU
    scree_scratch *scratch; ///< borrowed: where the block is taken; NULL: it is owned
    void *block;
    int64_t most_contacts;  ///< that the block has ever had room for
    bool is_history;        ///< of the step before: there are only the arrays with +, and first_of_pair
    bool acts_in_points;    ///< all bodies are spheres and no law has moments: no use for arrays with *
    bool has_no_levers;     ///< no law asks for the shape of the overlap: no use for arrays with **
    bool has_no_rolling;    ///< no law has rolling resistance: no use for rolling_moment
    bool is_one_per_pair;   ///< no pair has several contacts: arrays with ++ are as those without +
    int32_t *first_of_pair; ///< (num_pairs + 1) contacts of candidate pair p are first_of_pair[p] .. [p + 1] - 1

    // geometry, from the narrow phase
    scree_candidate_pair *bodies; ///< +
    int32_t *patch;               ///< ++ part << SCREE_PATCH_BITS, plus 0, 1, ... within the part
    scree_real *volume;           ///< [m^3]
    scree_real *indentation;      ///< [m]
    scree_real *radius;        ///< + * [m] of the contact across the normal, about the contact point; 0 for a sphere's
                               ///< contact, which acts in a point
    scree_vec3 *normal;        ///< [1] unit, from j towards i
    scree_vec3 *area_vector;   ///< * ** [m^2] area of i's surface inside j, outward from i; 0 for a sphere's contact
    scree_vec3 *torque_vector; ///< * ** [m^3] sum of x cross area vector over the same part, x from the contact point
    scree_vec3 *arm;           ///< ++ [m] contact point minus position of i

    // forces, from the force law
    scree_vec3 *normal_force;     ///< [N] on i; that on j is the exact opposite
    scree_vec3 *tangential_force; ///< [N] on i, spring and damping, capped
    scree_real *elastic_force;    ///< [N] elastic part of the normal force
    scree_vec3 *moment;           ///< * [N m] on i: of the normal force, torsion, rocking, rolling resistance
    scree_real *elastic_work;     ///< [J] change of elastic_energy in this step
    scree_real *spring_work;      ///< [J] change of spring_energy in this step
    uint8_t *is_slipping;         ///< 1 while the tangential force is at the Coulomb limit
    uint8_t *is_turning;          ///< * 1 while torsion or rolling resistance is at its limit

    // history, carried from step to step
    scree_vec3 *spring_force;         ///< + [N] elastic part of the tangential force on i
    scree_real *tangential_stiffness; ///< + [N/m] k_t of the last step
    scree_real *torsion;              ///< + * [N m] elastic part of the moment about the normal, on i
    scree_vec3 *rolling_moment;       ///< + * [N m] elastic part of the rolling resistance on i
    scree_real *elastic_energy;       ///< + [J] of the normal force
    scree_real *spring_energy;        ///< + [J] of the tangential, the torsion and the rolling spring
} scree_contact_list;

/// The list as kernels get it: they have no use for the device and the owner of its memory.
SCREE_FN scree_contact_list scree_contact_list_view(const scree_contact_list *list)
{
    scree_contact_list view = *list;
    view.device = NULL;
    view.scratch = NULL;
    view.block = NULL;
    return view;
}

/// The present contacts become those of the step before: the arrays with + and first_of_pair change places. The
/// present list keeps the others, to be written anew. It has no contacts then.
void scree_contact_list_pass_on(scree_contact_list *present, scree_contact_list *history);
/// Gives the block up for a search of candidate pairs: all but the arrays with + is lost until the next call of
/// scree_contact_list_reserve(), which takes it from `scratch`, by itself a stage of it.
void scree_contact_list_lend(scree_contact_list *list, scree_scratch *scratch);
/// Room for num_contacts, exactly in the block, and num_pairs; other arrays grow by a quarter at least. What goes on to
/// the next step stays, also if memory is out; the rest is lost if the block must grow. SCREE_OUT_OF_MEMORY.
scree_status scree_contact_list_reserve(scree_contact_list *list, int64_t num_contacts, int64_t num_pairs);
/// Room that a search of candidate pairs asks for when it finds num_contacts: some more, for those of the steps until
/// the next one.
int64_t scree_contact_list_wanted(int64_t num_contacts);
/// Memory of the forces, which are written after the geometry, until they are: scree_contact_list_spare_bytes() for
/// each contact of max_contacts at least.
void *scree_contact_list_spare(const scree_contact_list *list);
/// 0 if contacts act in points.
size_t scree_contact_list_spare_bytes(const scree_contact_list *list);
/// Contacts that it has room for.
int64_t scree_contact_list_room(const scree_contact_list *list);
/// What one list has no use for, another has none for either.
void scree_contact_list_share_uses(scree_contact_list *to, const scree_contact_list *from);
/// The contacts of one list to another, which may lie elsewhere; not which pairs they belong to. SCREE_OUT_OF_MEMORY.
scree_status scree_contact_list_copy(scree_contact_list *to, const scree_contact_list *from);
/// Contact order[c] to place c; `scratch` has room for a vector of each.
void scree_contact_list_permute(scree_contact_list *list, const int32_t *order, void *scratch);
/// Bytes of a contact in a list of these uses and in the history of the step before.
int64_t scree_contact_list_bytes(const scree_contact_list *list);
/// Those of them in the block.
int64_t scree_contact_list_block_bytes(const scree_contact_list *list);
void scree_contact_list_destroy(scree_contact_list *list);
/// On the CPU: sorted by the place of i, the id of j and patch, unique, normals unit, volumes positive. `ids` of the
/// bodies, or NULL: each is its own. Faults go to the report.
bool scree_contact_list_validate(const scree_contact_list *list, const int32_t *ids, scree_report *report);

#endif
