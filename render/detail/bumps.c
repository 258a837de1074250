#include "render/detail/bumps.h"

#include "config/base/memory.h"
#include "render/detail/detail_terms.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

vec3s tl_blinn_normal(vec3s normal, vec3s p_u, vec3s p_v, float h_u, float h_v)
{
    float area = glms_vec3_dot(normal, glms_vec3_cross(p_u, p_v));
    vec3s offset = glms_vec3_add(glms_vec3_scale(glms_vec3_cross(normal, p_v), h_u),
                                 glms_vec3_scale(glms_vec3_cross(p_u, normal), h_v));
    vec3s sum =
        glms_vec3_add(glms_vec3_scale(normal, fabsf(area)), glms_vec3_scale(offset, copysignf(1, area)));
    return area != 0 ? direction_or(sum, normal) : normal;
}

bool tl_uv_derivatives(const vec3s positions[3], const vec2s uvs[3], vec3s *p_u, vec3s *p_v)
{
    vec3s p = glms_vec3_sub(positions[1], positions[0]), q = glms_vec3_sub(positions[2], positions[0]);
    vec2s a = glms_vec2_sub(uvs[1], uvs[0]), b = glms_vec2_sub(uvs[2], uvs[0]);
    float determinant = a.x * b.y - a.y * b.x;
    *p_u = *p_v = glms_vec3_zero();
    if (!(fabsf(determinant) > 1e-20f))
        return false;
    *p_u = glms_vec3_divs(glms_vec3_sub(glms_vec3_scale(p, b.y), glms_vec3_scale(q, a.y)), determinant);
    *p_v = glms_vec3_divs(glms_vec3_sub(glms_vec3_scale(q, a.x), glms_vec3_scale(p, b.x)), determinant);
    return true;
}

void tl_vertex_derivatives(const tl_surface *surface, vec3s *p_u, vec3s *p_v)
{
    float *areas = TL_NEW_ARRAY(float, surface->vertex_count);
    memset(p_u, 0, surface->vertex_count * sizeof *p_u);
    memset(p_v, 0, surface->vertex_count * sizeof *p_v);
    for (size_t i = 0; i + 2 < surface->index_count; i += 3) {
        const uint32_t *corners = surface->indices + i;
        vec3s p[3], u, v;
        vec2s uvs[3];
        for (int c = 0; c < 3; c++) {
            p[c] = surface->positions[corners[c]];
            uvs[c] = surface->uvs[corners[c]];
        }
        if (!tl_uv_derivatives(p, uvs, &u, &v))
            continue;
        float area = glms_vec3_norm(glms_vec3_cross(glms_vec3_sub(p[1], p[0]), glms_vec3_sub(p[2], p[0])));
        for (int c = 0; c < 3; c++) {
            p_u[corners[c]] = glms_vec3_muladds(u, area, p_u[corners[c]]);
            p_v[corners[c]] = glms_vec3_muladds(v, area, p_v[corners[c]]);
            areas[corners[c]] += area;
        }
    }
    for (size_t i = 0; i < surface->vertex_count; i++) {
        p_u[i] = glms_vec3_scale(p_u[i], areas[i] > 0 ? 1 / areas[i] : 0);
        p_v[i] = glms_vec3_scale(p_v[i], areas[i] > 0 ? 1 / areas[i] : 0);
    }
    free(areas);
}

void tl_slope_factors(const vec3s positions[3], const vec2s uvs[3], float nominal, float out[2])
{
    vec3s p_u, p_v;
    bool is_known = tl_uv_derivatives(positions, uvs, &p_u, &p_v);
    out[0] = is_known ? detail_slope_factor(glms_vec3_norm(p_u), nominal) : 1;
    out[1] = is_known ? detail_slope_factor(glms_vec3_norm(p_v), nominal) : 1;
}
