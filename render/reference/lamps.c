#include "render/reference/lamps.h"

#include "render/brdf/brdf.h"
#include "render/brdf/tables/measured.h"

#include <float.h>
#include <math.h>

/* Visibility of the lamp from `origin`, including transmission through open cloth. */
static float visibility_from(const struct tl_reference_scene *scene, vec3s origin,
                             const struct tl_lamplight *light)
{
    float shown = tl_ground_visibility_to(scene->ground, origin, light->direction, light->distance_m),
          seen[16];
    struct tl_ray_packet packet = {.count = 1, .to_m = light->distance_m};
    packet.origin_x[0] = origin.x, packet.origin_y[0] = origin.y, packet.origin_z[0] = origin.z;
    packet.direction_x[0] = light->direction.x;
    packet.direction_y[0] = light->direction.y;
    packet.direction_z[0] = light->direction.z;
    tl_trace_transmittance_packet(scene->trace, &packet, seen);
    return shown * seen[0];
}

/* kd/pi cos + f_r cos below coat and fuzz, plus these, of a point that faces light from `l`. */
static vec3s reflected(const struct tl_shading_point *point, const struct tl_brdf_sum *brdfs,
                       const struct tl_brdf_frame *frame, vec3s l)
{
    float matt = fmaxf(glms_vec3_dot(point->normal, l), 0) / (float)M_PI;
    if (point->layered)
        matt *= material_matt(point->layers.lobes.over, l);
    vec3s gloss = tl_brdf_sum_gloss(brdfs, frame, l, point->viewer);
    vec3s sent = point->material->measured
                     ? tl_measured_reflected(point->material->measured, frame, l, point->viewer)
                     : glms_vec3_add(glms_vec3_scale(point->albedo, matt), gloss);
    return point->layered ? material_over(point->layers.lobes.over, sent, l, 0) : sent;
}

vec3s tl_reference_lamps(const struct tl_reference_scene *scene, const struct tl_shading_point *point,
                         size_t *rays)
{
    vec3s sum = point->emission;
    if (scene->lamp_count == 0)
        return sum;
    const struct tl_brdf_sum brdfs =
        tl_brdf_sum_of(point->material, point->f0, point->albedo, point->glossiness,
                       point->side * point->handedness, point->widening);
    const struct tl_brdf_frame frame = tl_brdf_frame_make(point->normal, point->tangent, point->handedness,
                                                          point->side * point->material->gloss.rotation);
    for (size_t i = 0; i < scene->lamp_count; i++) {
        const struct tl_lamp *lamp = &scene->lamps[i];
        struct tl_lamplight light = tl_lamp_at(lamp, point->point, point->horizon);
        bool faces = glms_vec3_dot(point->horizon, light.direction) > 0;
        if (!faces && !point->layered)
            continue;
        float behind = fmaxf(-glms_vec3_dot(point->normal, light.direction), 0) / (float)M_PI;
        vec3s sent = faces ? reflected(point, &brdfs, &frame, light.direction)
                           : glms_vec3_scale(point->layers.transmitted, behind);
        float shown = visibility_from(scene, faces ? point->point : point->layers.behind, &light);
        (*rays)++;
        for (int c = 0; c < 3; c++)
            sum.raw[c] = fminf(sum.raw[c] + shown * light.irradiance.raw[c] * sent.raw[c], FLT_MAX);
    }
    return sum;
}
