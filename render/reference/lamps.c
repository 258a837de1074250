#include "render/reference/lamps.h"

#include "render/brdf/brdf.h"

#include <float.h>
#include <math.h>

static bool is_stopped(const struct tl_reference_scene *scene, vec3s origin, const struct tl_lamplight *light)
{
    return tl_trace_occluded(scene->trace, origin, light->direction, 0, light->distance_m);
}

/* kd/pi cos + f_r cos of a spot under light from `l`. */
static vec3s reflected(const struct tl_spot *spot, const struct tl_brdf *brdf,
                       const struct tl_brdf_frame *frame, vec3s l)
{
    float matt = fmaxf(glms_vec3_dot(spot->normal, l), 0) / (float)M_PI;
    return glms_vec3_add(glms_vec3_scale(spot->albedo, matt), tl_brdf_gloss(brdf, frame, l, spot->viewer));
}

vec3s tl_reference_lamps(const struct tl_reference_scene *scene, const struct tl_spot *spot, size_t *rays)
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
        float shown = tl_lamp_ground_visibility(lamp, scene->ground, spot->point, light.direction);
        if (!(glms_vec3_dot(spot->horizon, light.direction) > 0) || shown <= 0)
            continue;
        (*rays)++;
        if (is_stopped(scene, spot->point, &light))
            continue;
        vec3s sent = reflected(spot, &brdf, &frame, light.direction);
        for (int c = 0; c < 3; c++)
            sum.raw[c] = fminf(sum.raw[c] + shown * light.irradiance.raw[c] * sent.raw[c], FLT_MAX);
    }
    return sum;
}
