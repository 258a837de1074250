#include "render/envmap/light_map_bake.h"

#include "config/interrupt.h"
#include "config/memory.h"
#include "render/reference/gather.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Sets of directions; batches of points take them in turn. */
enum { GROUPS = 64 };
/* Barycentric coordinates below which a texel's middle may be on the edge of a triangle by rounding. */
#define EDGE 1e-4f

void tl_light_map_frame(const tl_surface *surface, vec2s *low, vec2s *extent)
{
    vec2s least = {{INFINITY, INFINITY}}, most = {{-INFINITY, -INFINITY}};
    for (size_t i = 0; i < surface->index_count; i++) {
        least = glms_vec2_minv(least, surface->uvs[surface->indices[i]]);
        most = glms_vec2_maxv(most, surface->uvs[surface->indices[i]]);
    }
    *low = least;
    for (int c = 0; c < 2; c++)
        extent->raw[c] = most.raw[c] > least.raw[c] ? most.raw[c] - least.raw[c] : 1;
}

/* The middles of the outermost texels lie on the edges of the UVs' box, so that look-ups at the edges of a
 * rectangular panel read no less than its own light. */
static vec2s texel_middle(int side, int texel)
{
    float last = (float)(side > 1 ? side - 1 : 1);
    return (vec2s){{(float)(texel % side) / last, (float)(texel / side) / last}};
}

static vec2s corner(const tl_surface *surface, uint32_t triangle, int i, vec2s low, vec2s extent)
{
    vec2s uv = surface->uvs[surface->indices[3 * (size_t)triangle + (size_t)i]];
    return glms_vec2_div(glms_vec2_sub(uv, low), extent);
}

static float twice_area(vec2s a, vec2s b, vec2s c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

vec3s tl_light_map_weights(const tl_surface *surface, uint32_t triangle, vec2s low, vec2s extent, int side,
                           int texel)
{
    vec2s a = corner(surface, triangle, 0, low, extent), b = corner(surface, triangle, 1, low, extent),
          c = corner(surface, triangle, 2, low, extent), p = texel_middle(side, texel);
    float area = twice_area(a, b, c);
    if (area == 0)
        return (vec3s){{-1, -1, -1}};
    return (vec3s){{twice_area(p, b, c) / area, twice_area(a, p, c) / area, twice_area(a, b, p) / area}};
}

/* Whether a triangle has an area in space but none in UV. */
static bool is_flat_in_uv(const tl_surface *surface, uint32_t triangle, vec2s low, vec2s extent)
{
    const uint32_t *corners = surface->indices + 3 * (size_t)triangle;
    vec3s first = surface->positions[corners[0]];
    vec3s across = glms_vec3_cross(glms_vec3_sub(surface->positions[corners[1]], first),
                                   glms_vec3_sub(surface->positions[corners[2]], first));
    return glms_vec3_norm2(across) > 0 &&
           twice_area(corner(surface, triangle, 0, low, extent), corner(surface, triangle, 1, low, extent),
                      corner(surface, triangle, 2, low, extent)) == 0;
}

uint32_t *tl_light_map_triangles(const tl_surface *surface, int side)
{
    if (!surface->uvs || surface->index_count == 0)
        return NULL;
    uint32_t *covering = TL_NEW_ARRAY(uint32_t, (size_t)side * (size_t)side);
    vec2s low, extent;
    tl_light_map_frame(surface, &low, &extent);
    for (uint32_t t = 0; t < surface->index_count / 3; t++) {
        vec2s least = {{1, 1}}, most = {{0, 0}};
        if (is_flat_in_uv(surface, t, low, extent)) {
            free(covering);
            return NULL;
        }
        for (int i = 0; i < 3; i++) {
            vec2s at = corner(surface, t, i, low, extent);
            least = glms_vec2_minv(least, at);
            most = glms_vec2_maxv(most, at);
        }
        int left = (int)(least.x * (float)(side - 1)), right = (int)(most.x * (float)(side - 1)) + 1;
        int top = (int)(least.y * (float)(side - 1)), bottom = (int)(most.y * (float)(side - 1)) + 1;
        for (int y = top; y <= bottom && y < side; y++)
            for (int x = left; x <= right && x < side; x++) {
                vec3s weights = tl_light_map_weights(surface, t, low, extent, side, y * side + x);
                float nearest = fminf(fminf(weights.x, weights.y), weights.z);
                if (nearest < -EDGE)
                    continue;
                uint32_t *texel = &covering[y * side + x];
                vec3s other = *texel
                                  ? tl_light_map_weights(surface, *texel - 1, low, extent, side, y * side + x)
                                  : (vec3s){{0, 0, 0}};
                if (nearest > EDGE && fminf(fminf(other.x, other.y), other.z) > EDGE) {
                    free(covering);
                    return NULL;
                }
                *texel = t + 1;
            }
    }
    return covering;
}

static void gather_batch(const struct tl_reference_scene *scene, int directions,
                         const struct tl_sky_sample *sky, const struct tl_baked_point *items, size_t count,
                         uint64_t batch, float *light)
{
    struct tl_shading_points points = {0};
    float sums[3][TL_SHADING_POINTS];
    for (size_t i = 0; i < count; i++) {
        const struct tl_shading_point point = {.point = items[i].point,
                                               .horizon = items[i].normal,
                                               .normal = items[i].normal,
                                               .axis = items[i].normal,
                                               .exponent = 1,
                                               .diffuse = {{1, 1, 1}}};
        tl_shading_points_add(&points, &point);
    }
    const struct tl_gather_request request = {.scene = scene,
                                              .strata = directions,
                                              .sky = sky,
                                              .lobe_samples = 0,
                                              .random = tl_random_begin(batch, 0)};
    tl_gather(&request, &points, sums);
    for (size_t i = 0; i < count; i++) {
        for (size_t c = 0; c < 3; c++)
            light[4 * items[i].at + c] = sums[c][i];
        light[4 * items[i].at + 3] = 1;
    }
}

void tl_light_map_gather(const struct tl_reference_scene *scene, int directions,
                         const struct tl_baked_point *points, size_t count, float *light)
{
    struct tl_sky_sample *sky = TL_NEW_ARRAY(struct tl_sky_sample, (size_t)GROUPS * (size_t)directions);
    size_t batches = (count + TL_SHADING_POINTS - 1) / TL_SHADING_POINTS;
#pragma omp parallel for schedule(dynamic)
    for (int group = 0; group < GROUPS; group++)
        tl_gather_sample_sky(&scene->sky, directions, 0, 1, tl_random_begin(~(uint64_t)group, 0),
                             tl_random_begin(~(uint64_t)group, 1), sky + (size_t)group * (size_t)directions);
#pragma omp parallel for schedule(dynamic)
    for (size_t batch = 0; batch < batches; batch++) {
        if (tl_interrupted())
            continue;
        size_t first = batch * TL_SHADING_POINTS, left = count - first;
        gather_batch(scene, directions, sky + batch % GROUPS * (size_t)directions, points + first,
                     left < TL_SHADING_POINTS ? left : TL_SHADING_POINTS, batch, light);
    }
    free(sky);
}

static void pad_texel(const float *from, int side, int x, int y, float out[4])
{
    float sum[4] = {0, 0, 0, 0};
    for (int i = 0; i < 9; i++) {
        int nx = x + i % 3 - 1, ny = y + i / 3 - 1;
        if (nx < 0 || ny < 0 || nx >= side || ny >= side)
            continue;
        const float *other = from + 4 * ((size_t)ny * (size_t)side + (size_t)nx);
        for (size_t c = 0; c < 4; c++)
            sum[c] += other[3] > 0 ? other[c] : 0;
    }
    for (size_t c = 0; c < 4 && sum[3] > 0; c++)
        out[c] = sum[c] / sum[3];
}

void tl_light_map_pad(float *light, int side, int rounds)
{
    size_t count = 4 * (size_t)side * (size_t)side;
    float *from = TL_NEW_ARRAY(float, count);
    for (int round = 0; round < rounds; round++) {
        memcpy(from, light, count * sizeof *from);
        for (int y = 0; y < side; y++)
            for (int x = 0; x < side; x++) {
                float *texel = light + 4 * ((size_t)y * (size_t)side + (size_t)x);
                if (!(texel[3] > 0))
                    pad_texel(from, side, x, y, texel);
            }
    }
    free(from);
}
