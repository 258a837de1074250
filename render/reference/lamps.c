#include "render/reference/lamps.h"

#include "render/brdf/brdf.h"
#include "render/env/exponent.h"

#include <float.h>
#include <math.h>

/* What is seen of the lamp from `origin`, through open cloth too. */
static float seen_from(const struct tl_reference_scene *scene, const struct tl_lamp *lamp, vec3s origin,
                       const struct tl_lamplight *light)
{
    float shown = tl_lamp_ground_visibility(lamp, scene->ground, origin, light->direction), seen[16];
    struct tl_ray_packet bundle = {.count = 1, .to_m = light->distance_m};
    bundle.origin_x[0] = origin.x, bundle.origin_y[0] = origin.y, bundle.origin_z[0] = origin.z;
    bundle.direction_x[0] = light->direction.x;
    bundle.direction_y[0] = light->direction.y;
    bundle.direction_z[0] = light->direction.z;
    tl_trace_transmittance_packet(scene->trace, &bundle, seen);
    return shown * seen[0];
}

/* kd/pi cos + f_r cos, under the coat and with it, of a spot that faces light from `l`. */
static vec3s reflected(const struct tl_shading_point *spot, const struct tl_brdf *brdf,
                       const struct tl_brdf_frame *frame, vec3s l)
{
    const struct tl_shading_layers *layers = &spot->layers;
    float matt = fmaxf(glms_vec3_dot(spot->normal, l), 0) / (float)M_PI;
    vec3s gloss = tl_brdf_gloss(brdf, frame, l, spot->viewer);
    vec3s sent = glms_vec3_add(glms_vec3_scale(spot->albedo, matt), gloss);
    if (!spot->layered)
        return sent;
    float coat = layers->coat > 0 ? layers->coat * tl_lobe_cosine(layers->coat_exponent,
                                                                  glms_vec3_dot(layers->coat_axis, l))
                                  : 0;
    return glms_vec3_adds(glms_vec3_scale(sent, layers->base), coat);
}

vec3s tl_reference_lamps(const struct tl_reference_scene *scene, const struct tl_shading_point *spot,
                         size_t *rays)
{
    vec3s sum = {{0, 0, 0}};
    if (scene->lamp_count == 0)
        return sum;
    const struct tl_brdf brdf = tl_brdf_of(spot->material, spot->f0, spot->glossiness);
    const struct tl_brdf_frame frame = tl_brdf_frame_make(spot->normal, spot->tangent, spot->handedness,
                                                          spot->side * spot->material->gloss.rotation);
    for (size_t i = 0; i < scene->lamp_count; i++) {
        const struct tl_lamp *lamp = &scene->lamps[i];
        struct tl_lamplight light = tl_lamp_at(lamp, spot->point, spot->horizon);
        bool faces = glms_vec3_dot(spot->horizon, light.direction) > 0;
        if (!faces && !spot->layered)
            continue;
        float behind = fmaxf(-glms_vec3_dot(spot->normal, light.direction), 0) / (float)M_PI;
        vec3s sent = faces ? reflected(spot, &brdf, &frame, light.direction)
                           : glms_vec3_scale(spot->layers.transmitted, behind);
        float shown = seen_from(scene, lamp, faces ? spot->point : spot->layers.behind, &light);
        (*rays)++;
        for (int c = 0; c < 3; c++)
            sum.raw[c] = fminf(sum.raw[c] + shown * light.irradiance.raw[c] * sent.raw[c], FLT_MAX);
    }
    return sum;
}
