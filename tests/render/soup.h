/* Surfaces of random triangles for the tests of ray tracing, and a brute-force ray-triangle intersection as
 * their reference. */
#ifndef TOILE_TESTS_RENDER_SOUP_H
#define TOILE_TESTS_RENDER_SOUP_H

#include "assets/base/surface.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

/* Numbers in [0, 1): a linear congruential generator [Knuth, TAOCP 3.3.4, table 1, line 26]. */
static inline float soup_random(uint64_t *state)
{
    *state = *state * 6364136223846793005ull + 1442695040888963407ull;
    return (float)(*state >> 40) / (float)(1 << 24);
}

static inline vec3s soup_point(uint64_t *state, float half)
{
    vec3s p;
    for (int i = 0; i < 3; i++)
        p.raw[i] = half * (2 * soup_random(state) - 1);
    return p;
}

static inline vec3s soup_direction(uint64_t *state)
{
    for (;;) {
        vec3s p = soup_point(state, 1);
        float square = glms_vec3_norm2(p);
        if (square > 0.01f && square < 1)
            return glms_vec3_scale(p, 1 / sqrtf(square));
    }
}

/* A surface that owns its arrays; normals and tangents are NULL. */
struct soup {
    tl_surface surface;
    vec3s *positions;
    vec2s *uvs;
    uint32_t *indices;
    struct tl_mesh_part parts[2];
    tl_material materials[2];
};

static inline void soup_place(struct soup *soup, uint64_t seed)
{
    for (size_t t = 0; t < soup->surface.index_count / 3; t++) {
        vec3s centre = soup_point(&seed, 1);
        for (size_t i = 0; i < 3; i++)
            soup->positions[3 * t + i] = glms_vec3_add(centre, soup_point(&seed, 0.3f));
    }
    soup->surface.motion_revision++;
}

/* Makes `count` triangles of about 0.3 m in a box of 2 m; the second half is a part of its own. `soup` must
 * not be moved. */
static inline void soup_create(struct soup *soup, size_t count, uint64_t seed)
{
    *soup = (struct soup){.positions = TL_NEW_ARRAY(vec3s, 3 * count),
                          .uvs = TL_NEW_ARRAY(vec2s, 3 * count),
                          .indices = TL_NEW_ARRAY(uint32_t, 3 * count),
                          .materials = {tl_material_default("first"), tl_material_default("second")}};
    uint32_t half = 3 * (uint32_t)(count / 2);
    soup->parts[0] = (struct tl_mesh_part){.index_count = half};
    soup->parts[1] =
        (struct tl_mesh_part){.first_index = half, .index_count = 3 * (uint32_t)count - half, .material = 1};
    for (size_t i = 0; i < 3 * count; i++) {
        soup->indices[i] = (uint32_t)i;
        soup->uvs[i] = (vec2s){{i % 3 == 1, i % 3 == 2}};
    }
    soup->surface = (tl_surface){.name = "soup",
                                 .vertex_count = 3 * count,
                                 .positions = soup->positions,
                                 .uvs = soup->uvs,
                                 .index_count = 3 * count,
                                 .indices = soup->indices,
                                 .part_count = 2,
                                 .parts = soup->parts,
                                 .materials = soup->materials};
    soup_place(soup, seed);
}

static inline void soup_release(struct soup *soup)
{
    free(soup->positions);
    free(soup->uvs);
    free(soup->indices);
}

/* Intersects a ray with the plane of a triangle, in doubles: distance, and weights of the second and third
 * corner, from which inside or outside follows. False for a ray in the plane. Cramer's rule [Moeller and
 * Trumbore 1997]. */
static inline bool soup_intersect(const vec3s t[3], vec3s origin, vec3s direction, double *distance,
                                  double *u, double *v)
{
    double a[3], b[3], d[3], o[3];
    for (int i = 0; i < 3; i++) {
        a[i] = (double)t[1].raw[i] - (double)t[0].raw[i];
        b[i] = (double)t[2].raw[i] - (double)t[0].raw[i];
        d[i] = (double)direction.raw[i];
        o[i] = (double)origin.raw[i] - (double)t[0].raw[i];
    }
    double db[3] = {d[1] * b[2] - d[2] * b[1], d[2] * b[0] - d[0] * b[2], d[0] * b[1] - d[1] * b[0]};
    double oa[3] = {o[1] * a[2] - o[2] * a[1], o[2] * a[0] - o[0] * a[2], o[0] * a[1] - o[1] * a[0]};
    double det = a[0] * db[0] + a[1] * db[1] + a[2] * db[2];
    if (det == 0)
        return false;
    *u = (o[0] * db[0] + o[1] * db[1] + o[2] * db[2]) / det;
    *v = (d[0] * oa[0] + d[1] * oa[1] + d[2] * oa[2]) / det;
    *distance = (b[0] * oa[0] + b[1] * oa[1] + b[2] * oa[2]) / det;
    return true;
}

#endif
