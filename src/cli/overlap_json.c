#include "cli/overlap_json.h"

/// NAN and infinities have no JSON; they cannot come from a finite mesh, and would be told as null.
static json_t *number(scree_real value)
{
    json_t *json = json_real((double)value);
    return json != NULL ? json : json_null();
}

static json_t *vector(scree_vec3 v, bool is_defined)
{
    if (!is_defined) return json_null();
    json_t *json = json_array();
    json_array_append_new(json, number(v.x));
    json_array_append_new(json, number(v.y));
    json_array_append_new(json, number(v.z));
    return json;
}

static json_t *one_result(const scree_overlap_result *r)
{
    const bool has_volume = r->status != SCREE_OVERLAP_NONE, has_normal = r->status == SCREE_OVERLAP_TOUCHING;
    json_t *json = json_object();
    json_object_set_new(json, "volume", number(has_volume ? r->volume : 0));
    json_object_set_new(json, "centroid", vector(r->arm, has_volume));
    json_object_set_new(json, "area_vector", vector(has_volume ? r->area_vector : scree_vec3_zero(), true));
    json_object_set_new(json, "normal", vector(r->normal, has_normal));
    json_object_set_new(json, "indentation",
                        has_normal   ? number(r->indentation)
                        : has_volume ? json_null()
                                     : number(0));
    json_object_set_new(json, "residual", number(has_volume ? r->residual : 0));
    json_object_set_new(json, "status", json_string(scree_overlap_status_text(r->status)));
    return json;
}

/// Volume and area vector of all patches together, the centroid by volume; normal and indentation are the patches' own.
static scree_overlap_result sum_of(const scree_overlap_result *results, int32_t num_results)
{
    scree_overlap_result sum = results[0];
    if (num_results < 2) return sum;
    scree_vec3 moment = scree_vec3_scale(results[0].arm, results[0].volume);
    for (int32_t r = 1; r < num_results; ++r)
    {
        sum.volume += results[r].volume;
        sum.area_vector = scree_vec3_add(sum.area_vector, results[r].area_vector);
        moment = scree_vec3_add_scaled(moment, results[r].arm, results[r].volume);
        sum.residual = scree_max(sum.residual, results[r].residual);
    }
    sum.arm = scree_vec3_scale(moment, 1 / sum.volume);
    sum.status = SCREE_OVERLAP_NO_NORMAL;
    return sum;
}

json_t *scree_overlap_to_json(const scree_overlap_result *results, int32_t num_results, bool has_patches)
{
    const scree_overlap_result none = {.status = SCREE_OVERLAP_NONE};
    if (num_results < 1) results = &none;
    const scree_overlap_result sum = sum_of(results, num_results);
    json_t *json = one_result(&sum);
    if (!has_patches) return json;
    json_t *patches = json_array();
    for (int32_t r = 0; r < num_results; ++r)
        if (results[r].status != SCREE_OVERLAP_NONE) json_array_append_new(patches, one_result(results + r));
    json_object_set_new(json, "patches", patches);
    return json;
}
