/// \file overlap_check.c
/// Bodies that start in each other: contacts that are deeper than any contact law is meant for, and bodies without a
/// contact because one is inside the other, where no surface is near to push it out.
#include "contact/closest_point_kernel.h"
#include "contact/overlap.h"
#include "contact/sphere_pairs_kernel.h"
#include "dynamics/start_check.h"
#include "dynamics/step_buffers.h"

#include <math.h>

/// Depth of a contact that is allowed, over the half width of the smaller of the two that touch.
#define MAX_INDENTATION 0.05

/// For distances that must be safe in single precision.
#define ROUNDED_DOWN 0.9999

static const scree_shape_view *shape_of(const scree_simulation *s, int64_t body)
{
    return s->shape_views + s->buffers->shape[body];
}

/// Half of the smallest side of the box around a particle, in its own frame.
static double half_width(const scree_simulation *s, int64_t i)
{
    const scree_vec3 half = scree_box_half(shape_of(s, i)->box);
    return (double)s->particles.scale[i] * (double)scree_min(half.x, scree_min(half.y, half.z));
}

/// That of what a particle touches others with: of a clump, sphere `k` alone.
static double half_width_of_part(const scree_simulation *s, int64_t i, int32_t k)
{
    const scree_shape_view *shape = shape_of(s, i);
    if (shape->kind == SCREE_KIND_MESH) return half_width(s, i);
    return (double)s->particles.scale[i] * (double)scree_shape_sphere(shape, k).radius;
}

/// That of the smaller one of the two that touch in contact c; a wall is never the smaller one.
static double smaller_half_width(const scree_simulation *s, int64_t c)
{
    const scree_candidate_pair pair = s->contacts.bodies[c];
    const int32_t part = s->contacts.patch[c] >> SCREE_PATCH_BITS;
    if (pair.j >= s->particles.num_particles) return half_width(s, pair.i);
    const bool has_mesh = shape_of(s, pair.i)->kind == SCREE_KIND_MESH || shape_of(s, pair.j)->kind == SCREE_KIND_MESH;
    const int32_t num = shape_of(s, pair.j)->num_spheres;
    return fmin(half_width_of_part(s, pair.i, has_mesh ? part : part / num),
                half_width_of_part(s, pair.j, has_mesh ? part : part % num));
}

/// Is body a particle that was filled into a region?
static bool is_filled(const scree_simulation *s, int64_t body)
{
    return body < s->particles.num_particles && s->scene->particles[s->particles.group[body]].num_bodies == 0;
}

/// What to do about two bodies that start in each other.
static const char *remedy_for(const scree_simulation *s, scree_candidate_pair pair)
{
    if (is_filled(s, pair.i) && is_filled(s, pair.j))
        return "give both groups the same region, which fills them in together, or regions that are apart";
    return is_filled(s, pair.i) || is_filled(s, pair.j) ? "move one of them or the region of the particles"
                                                        : "move one of them";
}

/// Contacts that are too deep. Returns their number.
static int64_t check_contacts(const scree_simulation *s, scree_report *report)
{
    const scree_contact_list *contacts = &s->contacts;
    int64_t num = 0;
    for (int64_t c = 0; c < contacts->num_contacts; ++c)
    {
        const scree_candidate_pair pair = contacts->bodies[c];
        const double depth = (double)contacts->indentation[c], width = smaller_half_width(s, c);
        const bool is_wall = pair.j >= s->particles.num_particles;
        if (depth <= MAX_INDENTATION * width || ++num > SCREE_MAX_TOLD) continue;
        scree_report_add(report, "%s starts %g m inside %s, more than %g of %s half width of %g m; %s",
                         scree_describe_body(s, pair.i).text, depth, scree_describe_body(s, pair.j).text,
                         MAX_INDENTATION, is_wall ? "its" : "the smaller one's", width, remedy_for(s, pair));
    }
    scree_tell_more(report, num, "start inside others");
    return num;
}

/// Have two bodies of spheres a centre in common? There is no direction to push such spheres apart.
static bool have_common_centre(const scree_simulation *s, scree_candidate_pair pair)
{
    const scree_shape_view *shape_i = shape_of(s, pair.i), *shape_j = shape_of(s, pair.j);
    const scree_pose *pose_i = s->buffers->pose + pair.i, *pose_j = s->buffers->pose + pair.j;
    const scree_vec3 between = scree_vec3_sub(pose_i->position, pose_j->position);
    for (int32_t k = 0; k < shape_i->num_spheres; ++k)
    {
        const scree_vec3 mine = scree_vec3_add(between, scree_turned_sphere(shape_i, pose_i, k).centre);
        for (int32_t m = 0; m < shape_j->num_spheres; ++m)
        {
            const scree_vec3 d = scree_vec3_sub(mine, scree_turned_sphere(shape_j, pose_j, m).centre);
            if (!(scree_vec3_dot(d, d) > 0)) return true;
        }
    }
    return false;
}

bool scree_is_in_clear_ball(const scree_clear_ball *clear, scree_vec3 centre, double radius)
{
    const double distance = (double)scree_vec3_length(scree_vec3_sub(centre, clear->centre));
    return distance + radius < ROUNDED_DOWN * clear->radius;
}

double scree_depth_in_mesh(const scree_simulation *s, int64_t body, scree_vec3 point, double reach, scree_vec3 *normal)
{
    const scree_shape_view *shape = shape_of(s, body);
    const scree_pose pose = s->buffers->pose[body];
    const scree_mat3 rotation = scree_mat3_from_quat(pose.orientation);
    const scree_vec3 turned = scree_mat3_apply_transposed(rotation, scree_vec3_sub(point, pose.position));
    const scree_vec3 p = scree_vec3_scale(turned, 1 / pose.scale);
    const scree_real far = (scree_real)reach / pose.scale;
    if (shape->kind != SCREE_KIND_MESH || scree_box_distance_squared(shape->box, p) > far * far)
        return -(double)INFINITY;
    const scree_closest_point closest = scree_closest_on_mesh(shape, p);
    const scree_approach approach = scree_approach_of(shape, &closest);
    if (normal != NULL) *normal = scree_mat3_apply(rotation, approach.normal);
    return -(double)(approach.height * pose.scale);
}

/// How far the vertices of mesh i are below the surface of mesh j at the least; not above 0 if one is not below it.
static double depth_of_vertices(const scree_simulation *s, int64_t i, int64_t j)
{
    const scree_shape_view *shape = shape_of(s, i);
    const scree_pose pose = s->buffers->pose[i];
    const scree_mat3 rotation = scree_mat3_from_quat(pose.orientation);
    double least = INFINITY;
    for (int32_t v = 0; v < shape->num_vertices && least > 0; ++v)
    {
        const scree_vec3 turned = scree_mat3_apply(rotation, shape->vertices[v]);
        least =
            fmin(least, scree_depth_in_mesh(s, j, scree_vec3_add_scaled(pose.position, turned, pose.scale), 0, NULL));
    }
    return least;
}

/// How far body i is below the surface of mesh j if it is wholly inside, of a clump the first sphere that is; otherwise
/// not above 0.
static double depth_inside(const scree_simulation *s, int64_t i, int64_t j)
{
    const scree_shape_view *shape = shape_of(s, i);
    const scree_pose *pose = s->buffers->pose + i;
    if (shape->kind == SCREE_KIND_MESH) return depth_of_vertices(s, i, j);
    for (int32_t k = 0; k < shape->num_spheres; ++k)
    {
        const scree_sphere sphere = scree_turned_sphere(shape, pose, k);
        const double depth = scree_depth_in_mesh(s, j, scree_vec3_add(pose->position, sphere.centre), 0, NULL);
        if (depth >= (double)sphere.radius) return depth;
    }
    return 0;
}

/// Two meshes with a common volume, but without a normal to push them apart along. SCREE_OUT_OF_MEMORY.
static scree_status find_enclosed(const scree_simulation *s, scree_candidate_pair pair,
                                  scree_overlap_workspace *workspace, bool *is_enclosed)
{
    const scree_shape_view *shape_i = shape_of(s, pair.i), *shape_j = shape_of(s, pair.j);
    const scree_pose *pose_i = s->buffers->pose + pair.i, *pose_j = s->buffers->pose + pair.j;
    scree_overlap_options options = s->narrow_phase.options;
    scree_overlap_result result;
    options.separate_patches = false;
    do {
        scree_overlap_compute(shape_i, pose_i, shape_j, pose_j, &options, workspace, &result, 1);
        if (result.status == SCREE_OVERLAP_WORKSPACE_FULL && scree_overlap_workspace_grow(workspace) != SCREE_OK)
            return SCREE_OUT_OF_MEMORY;
    } while (result.status == SCREE_OVERLAP_WORKSPACE_FULL);
    *is_enclosed = scree_overlap_is_lost(&result, shape_i->bounding_radius * pose_i->scale,
                                         shape_j->bounding_radius * pose_j->scale);
    return SCREE_OK;
}

/// Says that one of two bodies is in the other, or goes through it.
static void tell_enclosed(const scree_simulation *s, scree_candidate_pair pair, scree_report *report)
{
    const int64_t num_particles = s->particles.num_particles;
    int64_t inner = pair.i, outer = pair.j;
    double depth = depth_inside(s, inner, outer);
    if (!(depth > 0) && outer < num_particles)
    {
        inner = pair.j;
        outer = pair.i;
        depth = depth_inside(s, inner, outer);
    }
    const scree_body_text in = scree_describe_body(s, inner), out = scree_describe_body(s, outer);
    if (!(depth > 0))
        scree_report_add(report, "%s and %s start in each other, and no direction leads apart; %s", in.text, out.text,
                         remedy_for(s, pair));
    else if (outer < num_particles)
        scree_report_add(report, "%s starts inside %s, %g m below its surface; %s", in.text, out.text, depth,
                         remedy_for(s, pair));
    else
        scree_report_add(report,
                         "%s starts inside the solid of %s, %g m below its surface; walls are closed solids: move the "
                         "particles out, or make a hollow wall of plates or of its shell",
                         in.text, out.text, depth);
}

/// Have the two a contact? Contacts are sorted by them.
static bool are_touching(const scree_simulation *s, int64_t i, int64_t j)
{
    int64_t low = 0, high = s->contacts.num_contacts;
    while (low < high)
    {
        const int64_t middle = low + (high - low) / 2;
        const scree_candidate_pair pair = s->contacts.bodies[middle];
        if (pair.i < i || (pair.i == i && pair.j < j)) low = middle + 1;
        else high = middle;
    }
    return low < s->contacts.num_contacts && s->contacts.bodies[low].i == i && s->contacts.bodies[low].j == j;
}

/// Is particle i of the pair as a whole outside of mesh j, by what is known of a point outside: most others are near?
/// What is learned of its own centre is kept.
static bool is_outside_as_others(const scree_simulation *s, scree_candidate_pair pair, scree_clear_ball *clear)
{
    const scree_vec3 centre = s->buffers->pose[pair.i].position;
    const double radius = (double)(shape_of(s, pair.i)->bounding_radius * s->buffers->pose[pair.i].scale);
    if (scree_is_in_clear_ball(clear, centre, radius)) return true;
    const double height = -scree_depth_in_mesh(s, pair.j, centre, 0, NULL);
    if (!(height > 0 && height < INFINITY)) return false;
    *clear = (scree_clear_ball){centre, height};
    return scree_is_in_clear_ball(clear, centre, radius);
}

/// Particles inside the solid of a wall: far from its surface they are no candidates. Adds their number.
static void check_solids(const scree_simulation *s, scree_report *report, int64_t *num)
{
    const int64_t num_particles = s->particles.num_particles;
    for (int32_t w = 0; w < s->num_walls; ++w)
    {
        if (!s->walls[w].is_present) continue;
        scree_clear_ball clear = {0};
        for (int64_t i = 0; i < num_particles; ++i)
        {
            const scree_candidate_pair pair = {(int32_t)i, (int32_t)(num_particles + w)};
            if (is_outside_as_others(s, pair, &clear) || !(depth_inside(s, pair.i, pair.j) > 0)) continue;
            // where all vertices are inside, an edge may still come out
            if (shape_of(s, i)->kind == SCREE_KIND_MESH && are_touching(s, pair.i, pair.j)) continue;
            if (++*num <= SCREE_MAX_TOLD) tell_enclosed(s, pair, report);
        }
    }
}

/// Bodies inside others. Adds their number. SCREE_OUT_OF_MEMORY.
static scree_status check_enclosed(const scree_simulation *s, scree_report *report, int64_t *num)
{
    const scree_broad_phase *broad_phase = &s->broad_phase;
    const int64_t num_particles = s->particles.num_particles;
    const bool has_lost = s->narrow_phase.counts.num_without_normal > 0;
    scree_overlap_workspace *workspace = has_lost ? scree_overlap_workspace_create() : NULL;
    if (has_lost && workspace == NULL) return SCREE_OUT_OF_MEMORY;
    scree_status status = SCREE_OK;
    for (int64_t p = 0; p < broad_phase->num_pairs && status == SCREE_OK; ++p)
    {
        const scree_candidate_pair pair = broad_phase->pairs[p];
        const bool is_mesh_i = shape_of(s, pair.i)->kind == SCREE_KIND_MESH;
        const bool is_mesh_j = shape_of(s, pair.j)->kind == SCREE_KIND_MESH;
        bool is_enclosed = false;
        if (!is_mesh_i && !is_mesh_j)
        {
            if (have_common_centre(s, pair) && ++*num <= SCREE_MAX_TOLD)
                scree_report_add(report, "%s has the centre of %s; %s", scree_describe_body(s, pair.i).text,
                                 scree_describe_body(s, pair.j).text, remedy_for(s, pair));
            continue;
        }
        if (!is_mesh_i) is_enclosed = pair.j < num_particles && depth_inside(s, pair.i, pair.j) > 0;
        else if (!is_mesh_j) is_enclosed = depth_inside(s, pair.j, pair.i) > 0;
        else if (has_lost && s->contacts.first_of_pair[p] == s->contacts.first_of_pair[p + 1])
            status = find_enclosed(s, pair, workspace, &is_enclosed);
        // what is in the solid of a wall is found below
        if (pair.j >= num_particles && is_enclosed) is_enclosed = !(depth_inside(s, pair.i, pair.j) > 0);
        if (is_enclosed && ++*num <= SCREE_MAX_TOLD) tell_enclosed(s, pair, report);
    }
    scree_overlap_workspace_destroy(workspace);
    check_solids(s, report, num);
    scree_tell_more(report, *num, "start wholly inside others");
    return status;
}

scree_status scree_check_overlaps(const scree_simulation *simulation, scree_report *report, int64_t *num_faults)
{
    *num_faults = check_contacts(simulation, report);
    int64_t num_enclosed = 0;
    const scree_status status = check_enclosed(simulation, report, &num_enclosed);
    *num_faults += num_enclosed;
    return status;
}
