#include "render/shade/sun_bundle_internal.h"

#include <math.h>

struct tl_sun_bundle tl_sun_bundle_begin(const struct tl_sun_pixels_request *request,
                                         const struct tl_pixel_light *light)
{
    return (struct tl_sun_bundle){.request = request,
                                  .light = light,
                                  .offset_m = tl_trace_offset(request->trace),
                                  /* Not `coherent`, though they are parallel: most pass close by an edge, and
                                     Embree takes a tenth longer with it. */
                                  .rays = {.to_m = light->lamp.kind == TL_LAMP_POINT ? 1 : INFINITY}};
}

static vec3s weighted(const vec3s v[3], const float w[3])
{
    return glms_vec3_add(glms_vec3_scale(v[0], w[0]),
                         glms_vec3_add(glms_vec3_scale(v[1], w[1]), glms_vec3_scale(v[2], w[2])));
}

bool tl_sun_start(const struct tl_sun_bundle *bundle, uint32_t pixel, vec3s *start)
{
    const struct tl_id_buffer *ids = bundle->request->ids;
    const struct tl_pixel_triangle *triangle =
        &bundle->request->triangles->items[tl_ids_place(ids, ids->ids[pixel])];
    const uint32_t x = pixel % (uint32_t)ids->width, y = pixel / (uint32_t)ids->width;
    const struct tl_pixel_weights weights = tl_pixel_weigh(triangle, (float)x + 0.5f, (float)y + 0.5f);
    vec3s corners[3], normals[3];
    for (int i = 0; i < 3; i++) {
        corners[i] = triangle->surface->positions[triangle->corners[i]];
        normals[i] =
            glms_vec3_scale(triangle->surface->normals[triangle->corners[i]], triangle->back ? -1.0f : 1.0f);
    }
    const vec3s flat = weighted(corners, weights.at);
    vec3s smooth = glms_vec3_normalize(weighted(normals, weights.at));
    float cosine = glms_vec3_dot(smooth, tl_pixel_light_at(bundle->light, flat).direction);
    if (cosine < 0 && triangle->transmits) { /* its other side faces the sun, and shines through */
        for (int i = 0; i < 3; i++)
            normals[i] = glms_vec3_negate(normals[i]);
        smooth = glms_vec3_negate(smooth);
        cosine = -cosine;
    }
    if (!(cosine > 0))
        return false;
    vec3s point = tl_smooth_point(flat, corners, normals, weights.at);
    *start = glms_vec3_add(point, glms_vec3_scale(smooth, bundle->offset_m));
    return true;
}

int tl_sun_bundle_trace(struct tl_sun_bundle *bundle, float seen[TL_SUN_BUNDLE])
{
    int count = bundle->rays.count;
    if (count > 0)
        tl_trace_transmittance_packet(bundle->request->trace, &bundle->rays, seen);
    for (int i = 0; i < count; i++)
        seen[i] *= bundle->ground[i];
    bundle->count += (size_t)count;
    bundle->rays.count = 0;
    return count;
}

void tl_sun_bundle_add(struct tl_sun_bundle *bundle, uint32_t pixel, vec3s start)
{
    int k = bundle->rays.count++;
    const bool is_near = bundle->light->lamp.kind == TL_LAMP_POINT;
    const vec3s direction = tl_pixel_light_at(bundle->light, start).direction;
    /* Towards a near lamp the ray has the length of the way, and ends at 1. */
    const vec3s way = is_near ? glms_vec3_sub(bundle->light->lamp.position, start) : direction;
    bundle->pixels[k] = pixel;
    bundle->ground[k] =
        is_near ? tl_ground_visibility_to(bundle->request->ground, start, direction, glms_vec3_norm(way))
                : tl_ground_visibility(bundle->request->ground, start, direction);
    bundle->rays.origin_x[k] = start.x;
    bundle->rays.origin_y[k] = start.y;
    bundle->rays.origin_z[k] = start.z;
    bundle->rays.direction_x[k] = way.x;
    bundle->rays.direction_y[k] = way.y;
    bundle->rays.direction_z[k] = way.z;
}
