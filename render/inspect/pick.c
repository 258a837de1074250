#include "render/inspect/pick.h"

#include <float.h>
#include <math.h>

/* The distance at which a ray hits a triangle [Moeller and Trumbore 1997], or -1. */
static float intersect(vec3s origin, vec3s direction, const vec3s corners[3], float weights[3])
{
    vec3s side = glms_vec3_sub(corners[1], corners[0]), other = glms_vec3_sub(corners[2], corners[0]);
    vec3s p = glms_vec3_cross(direction, other);
    float determinant = glms_vec3_dot(side, p);
    if (determinant == 0)
        return -1;
    vec3s to_origin = glms_vec3_sub(origin, corners[0]);
    vec3s q = glms_vec3_cross(to_origin, side);
    weights[1] = glms_vec3_dot(to_origin, p) / determinant;
    weights[2] = glms_vec3_dot(direction, q) / determinant;
    weights[0] = 1 - weights[1] - weights[2];
    bool inside = weights[0] >= 0 && weights[1] >= 0 && weights[2] >= 0;
    return inside ? glms_vec3_dot(other, q) / determinant : -1;
}

static void pick_surface(const tl_surface *surface, uint32_t first, vec3s origin, vec3s direction,
                         float *nearest, tl_sample *out)
{
    for (size_t i = 0; i + 2 < surface->index_count; i += 3) {
        const uint32_t *index = &surface->indices[i];
        const vec3s corners[3] = {surface->positions[index[0]], surface->positions[index[1]],
                                  surface->positions[index[2]]};
        float weights[3];
        float distance = intersect(origin, direction, corners, weights);
        if (!(distance > 0 && distance < *nearest))
            continue;
        *nearest = distance;
        vec3s facet =
            glms_vec3_cross(glms_vec3_sub(corners[1], corners[0]), glms_vec3_sub(corners[2], corners[0]));
        bool back = glms_vec3_dot(facet, direction) > 0;
        vec3s smooth = {{0, 0, 0}};
        for (int k = 0; k < 3; k++) {
            out->weights[k] = weights[k];
            smooth = glms_vec3_add(smooth, glms_vec3_scale(surface->normals[index[k]], weights[k]));
        }
        out->triangle = (first + (uint32_t)(i / 3)) | (back ? TL_SAMPLE_BACK : 0);
        out->smooth = glms_vec3_scale(glms_vec3_normalize(smooth), back ? -1 : 1);
    }
}

bool tl_pick(const struct tl_triangle_ranges *ranges, vec3s origin, vec3s direction, tl_sample *out)
{
    float nearest = FLT_MAX;
    *out = (tl_sample){.cover = 1};
    for (size_t s = 0; s < ranges->surface_count; s++)
        pick_surface(ranges->surfaces[s], ranges->first[s], origin, direction, &nearest, out);
    if (nearest == FLT_MAX)
        return false;
    out->point = glms_vec3_add(origin, glms_vec3_scale(direction, nearest));
    out->normal = out->smooth;
    return true;
}
