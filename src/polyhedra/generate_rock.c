/// \file generate_rock.c
/// Rocks that look crushed: a sphere made lumpy by noise, cut by planes, bitten by spheres, roughened, and stretched.
/// The surface is a height over the directions of a sphere throughout, so it cannot intersect itself, and stretching
/// keeps that. Numbers come from splitmix64 (Steele, Lea & Flood 2014) and + - * / sqrt alone: same seed, same rock.
#include "polyhedra/generate.h"
#include "polyhedra/generate_internal.h"
#include "polyhedra/shape.h"
#include "polyhedra/simplify.h"

#include <math.h>

#define DEFAULT_DETAIL 1000
#define MAX_DETAIL 200000
#define MAX_CUTS 14
#define MAX_BITES 4
#define MIN_HEIGHT 0.3

static uint64_t mix(uint64_t z)
{
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/// In [low, high).
static double uniform(uint64_t *state, double low, double high)
{
    *state += 0x9e3779b97f4a7c15u;
    return low + (high - low) * ((double)(mix(*state) >> 11) * 0x1p-53);
}

static scree_vec3 random_direction(uint64_t *state)
{
    // a point of the ball, not too near its middle, drawn from the cube around it
    for (;;)
    {
        const double x = uniform(state, -1.0, 1.0);
        const double y = uniform(state, -1.0, 1.0);
        const double z = uniform(state, -1.0, 1.0);
        const double square = x * x + y * y + z * z;
        if (square > 1.0 || square < 0.01) continue;
        const double length = sqrt(square);
        return scree_vec3_make((scree_real)(x / length), (scree_real)(y / length), (scree_real)(z / length));
    }
}

/// What one rock is cut from.
typedef struct rock_recipe
{
    uint64_t noise_seed;
    scree_vec3 cut_normal[MAX_CUTS];
    double cut_height[MAX_CUTS]; ///< distance of the plane from the middle
    scree_vec3 bite_centre[MAX_BITES];
    double bite_radius[MAX_BITES];
    int num_cuts;
    int num_bites;
    double stretch[3];
} rock_recipe;

static rock_recipe draw_recipe(uint64_t seed)
{
    uint64_t state = mix(seed + 0x632be59bd9b4e019u);
    rock_recipe recipe = {0};
    recipe.noise_seed = mix(state ^ 0xd1b54a32d192ed03u);
    recipe.num_cuts = (int)uniform(&state, 8.0, MAX_CUTS + 1.0);
    recipe.num_bites = (int)uniform(&state, 2.0, MAX_BITES + 1.0);
    for (int i = 0; i < recipe.num_cuts; ++i)
    {
        recipe.cut_normal[i] = random_direction(&state);
        recipe.cut_height[i] = uniform(&state, 0.62, 0.88);
    }
    // the sphere of a bite stays outside of the middle: its near side is at the distance that is drawn first
    for (int i = 0; i < recipe.num_bites; ++i)
    {
        const double near_side = uniform(&state, 0.6, 0.8);
        recipe.bite_radius[i] = uniform(&state, 0.35, 0.9);
        recipe.bite_centre[i] =
            scree_vec3_scale(random_direction(&state), (scree_real)(near_side + recipe.bite_radius[i]));
    }
    recipe.stretch[0] = uniform(&state, 1.0, 1.45);
    recipe.stretch[1] = 1.0;
    recipe.stretch[2] = uniform(&state, 0.62, 1.0);
    return recipe;
}

/// A number in [-1, 1) for each point of the lattice.
static double lattice_value(uint64_t seed, int64_t i, int64_t j, int64_t k)
{
    uint64_t z = mix(seed + (uint64_t)i * 0x9e3779b97f4a7c15u);
    z = mix(z + (uint64_t)j * 0xc2b2ae3d27d4eb4fu);
    z = mix(z + (uint64_t)k * 0x165667b19e3779f9u);
    return (double)(z >> 11) * 0x1p-52 - 1.0;
}

/// Largest whole number that is not above x.
static int64_t whole_below(double x)
{
    const int64_t i = (int64_t)x;
    return (double)i > x ? i - 1 : i;
}

/// 6 t^5 - 15 t^4 + 10 t^3: flat to second order at both ends.
static double smooth(double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }

static double blend(double a, double b, double t) { return a + (b - a) * t; }

/// Values of the lattice interpolated to one point.
static double noise(uint64_t seed, scree_vec3 p, double frequency)
{
    const double x = (double)p.x * frequency, y = (double)p.y * frequency, z = (double)p.z * frequency;
    const int64_t i = whole_below(x), j = whole_below(y), k = whole_below(z);
    const double tx = smooth(x - (double)i), ty = smooth(y - (double)j), tz = smooth(z - (double)k);
    double plane[2];
    for (int c = 0; c < 2; ++c)
    {
        const double row0 = blend(lattice_value(seed, i, j, k + c), lattice_value(seed, i + 1, j, k + c), tx);
        const double row1 = blend(lattice_value(seed, i, j + 1, k + c), lattice_value(seed, i + 1, j + 1, k + c), tx);
        plane[c] = blend(row0, row1, ty);
    }
    return blend(plane[0], plane[1], tz);
}

/// Distance of the surface from the middle in direction d.
static double height(const rock_recipe *recipe, scree_vec3 d)
{
    double r = 1.0 + 0.24 * noise(recipe->noise_seed, d, 1.3) + 0.10 * noise(recipe->noise_seed + 1, d, 2.9);
    for (int i = 0; i < recipe->num_cuts; ++i)
    {
        const double slope = (double)scree_vec3_dot(d, recipe->cut_normal[i]);
        if (slope * r > recipe->cut_height[i]) r = recipe->cut_height[i] / slope;
    }
    // first point of the ray inside the sphere of the bite
    for (int i = 0; i < recipe->num_bites; ++i)
    {
        const double along = (double)scree_vec3_dot(d, recipe->bite_centre[i]);
        const double power = (double)scree_vec3_dot(recipe->bite_centre[i], recipe->bite_centre[i]) -
                             recipe->bite_radius[i] * recipe->bite_radius[i];
        const double square = along * along - power;
        if (along <= 0.0 || square <= 0.0) continue;
        const double entry = along - sqrt(square);
        if (entry < r) r = entry;
    }
    r *= 1.0 + 0.035 * noise(recipe->noise_seed + 2, d, 5.3) + 0.015 * noise(recipe->noise_seed + 3, d, 11.7);
    return r > MIN_HEIGHT ? r : MIN_HEIGHT;
}

/// Into the body frame, with a middle size of 1.
static scree_status normalise(scree_mesh *mesh)
{
    scree_shape shape;
    const scree_status status = scree_shape_create(&shape, mesh, SCREE_FRAME_PRINCIPAL);
    if (status != SCREE_OK) return status;
    const scree_real scale = (scree_real)(1.0 / shape.middle_size);
    for (int32_t i = 0; i < mesh->num_vertices; ++i)
        mesh->vertices[i] = scree_vec3_scale(shape.mesh.vertices[i], scale);
    scree_shape_destroy(&shape);
    return SCREE_OK;
}

scree_status scree_generate_rock(scree_mesh *mesh, uint64_t seed, int32_t num_triangles, int32_t detail)
{
    *mesh = (scree_mesh){0};
    if (detail == 0) detail = num_triangles > DEFAULT_DETAIL ? num_triangles : DEFAULT_DETAIL;
    if (num_triangles < 4 || detail < num_triangles || detail > MAX_DETAIL) return SCREE_INVALID_INPUT;
    scree_status status = scree_generate_unit_sphere(mesh, detail);
    if (status != SCREE_OK) return status;
    const rock_recipe recipe = draw_recipe(seed);
    for (int32_t i = 0; i < mesh->num_vertices; ++i)
    {
        const scree_vec3 d = mesh->vertices[i];
        const double r = height(&recipe, d);
        mesh->vertices[i] = scree_vec3_make((scree_real)(recipe.stretch[0] * r * (double)d.x),
                                            (scree_real)(recipe.stretch[1] * r * (double)d.y),
                                            (scree_real)(recipe.stretch[2] * r * (double)d.z));
    }
    status = normalise(mesh);
    if (status == SCREE_OK && mesh->num_triangles > num_triangles + 1)
        status = scree_mesh_simplify(mesh, num_triangles, 0.0, NULL);
    if (status != SCREE_OK) scree_mesh_destroy(mesh);
    return status;
}
