#include "render/surfaces/uv_texels.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

/* Barycentric coordinates below which a texel's middle may be on the edge of a triangle by rounding. */
#define EDGE 1e-4f

void tl_uv_texels_box(const tl_surface *surface, vec2s *low, vec2s *extent)
{
    vec2s minimum = {{INFINITY, INFINITY}}, maximum = {{-INFINITY, -INFINITY}};
    for (size_t i = 0; i < surface->index_count; i++) {
        minimum = glms_vec2_minv(minimum, surface->uvs[surface->indices[i]]);
        maximum = glms_vec2_maxv(maximum, surface->uvs[surface->indices[i]]);
    }
    *low = minimum;
    for (int c = 0; c < 2; c++)
        extent->raw[c] = maximum.raw[c] > minimum.raw[c] ? maximum.raw[c] - minimum.raw[c] : 1;
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

vec3s tl_uv_texels_weights(const tl_surface *surface, uint32_t triangle, vec2s low, vec2s extent, int side,
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

uint32_t *tl_uv_texels_triangles(const tl_surface *surface, int side)
{
    if (!surface->uvs || surface->index_count == 0)
        return NULL;
    uint32_t *covering = TL_NEW_ARRAY(uint32_t, (size_t)side * (size_t)side);
    vec2s low, extent;
    tl_uv_texels_box(surface, &low, &extent);
    for (uint32_t t = 0; t < surface->index_count / 3; t++) {
        vec2s minimum = {{1, 1}}, maximum = {{0, 0}};
        if (is_flat_in_uv(surface, t, low, extent)) {
            free(covering);
            return NULL;
        }
        for (int i = 0; i < 3; i++) {
            vec2s at = corner(surface, t, i, low, extent);
            minimum = glms_vec2_minv(minimum, at);
            maximum = glms_vec2_maxv(maximum, at);
        }
        int left = (int)(minimum.x * (float)(side - 1)), right = (int)(maximum.x * (float)(side - 1)) + 1;
        int top = (int)(minimum.y * (float)(side - 1)), bottom = (int)(maximum.y * (float)(side - 1)) + 1;
        for (int y = top; y <= bottom && y < side; y++)
            for (int x = left; x <= right && x < side; x++) {
                vec3s weights = tl_uv_texels_weights(surface, t, low, extent, side, y * side + x);
                float nearest = fminf(fminf(weights.x, weights.y), weights.z);
                if (nearest < -EDGE)
                    continue;
                uint32_t *texel = &covering[y * side + x];
                vec3s other = *texel
                                  ? tl_uv_texels_weights(surface, *texel - 1, low, extent, side, y * side + x)
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

bool tl_uv_texels_fit(const tl_surface *surface, int side)
{
    uint32_t *triangles = tl_uv_texels_triangles(surface, side);
    bool fits = triangles != NULL;
    free(triangles);
    return fits;
}
