#include "render/local/lamp_rays.h"

#include <math.h>
#include <string.h>

#define BUNDLE 16 /* rays */
#define BLOCK  64 /* bundles that a thread takes at a time */

/* One bundle of neighbouring samples. Rays are as long as the way to the lamp, which ends at 1. */
static void look(const struct tl_lamp *lamp, const struct tl_trace *trace, const tl_sample *samples,
                 int count, const struct tl_triangle_ranges *ranges, const struct tl_ground *ground,
                 uint8_t *out)
{
    bool is_point = lamp->kind == TL_LAMP_POINT;
    float offset_m = tl_trace_offset(trace);
    struct tl_ray_packet bundle = {.to_m = is_point ? 1 : INFINITY, .coherent = true};
    uint32_t texels[BUNDLE];
    float shown[BUNDLE];
    for (int i = 0; i < count; i++) {
        const tl_sample *sample = &samples[i];
        vec3s start = tl_sample_start(sample, ranges, offset_m);
        struct tl_lamplight light = tl_lamp_at(lamp, start, sample->smooth);
        float left = tl_lamp_ground_visibility(lamp, ground, start, light.direction);
        if (left <= 0 || glms_vec3_dot(sample->smooth, light.direction) <= 0)
            continue;
        vec3s way = is_point ? glms_vec3_sub(lamp->position, start) : light.direction;
        int k = bundle.count++;
        bundle.origin_x[k] = start.x, bundle.origin_y[k] = start.y, bundle.origin_z[k] = start.z;
        bundle.direction_x[k] = way.x, bundle.direction_y[k] = way.y, bundle.direction_z[k] = way.z;
        texels[k] = sample->texel;
        shown[k] = left;
    }
    if (bundle.count == 0)
        return;
    float seen[BUNDLE];
    tl_trace_transmittance_packet(trace, &bundle, seen);
    for (int k = 0; k < bundle.count; k++)
        out[texels[k]] = (uint8_t)lroundf(255 * shown[k] * seen[k]);
}

void tl_lamp_rays(const struct tl_lamp *lamp, const struct tl_trace *trace, const struct tl_samples *samples,
                  const struct tl_triangle_ranges *ranges, const struct tl_ground *ground, uint8_t *out)
{
    size_t count = samples->primary_count;
    memset(out, 0, (size_t)samples->width * (size_t)samples->height);
#pragma omp parallel for schedule(dynamic, BLOCK)
    for (size_t first = 0; first < count; first += BUNDLE)
        look(lamp, trace, samples->items + first, count - first < BUNDLE ? (int)(count - first) : BUNDLE,
             ranges, ground, out);
}

vec3s tl_lamp_irradiance_at(const struct tl_lamp *lamp, const tl_trace *trace, const tl_sample *sample,
                            const struct tl_triangle_ranges *ranges, const struct tl_ground *ground,
                            vec3s *direction)
{
    vec3s start = trace ? tl_sample_start(sample, ranges, tl_trace_offset(trace)) : sample->point;
    struct tl_lamplight light = tl_lamp_at(lamp, start, sample->smooth);
    float shown = trace ? tl_lamp_ground_visibility(lamp, ground, start, light.direction) : 1;
    *direction = light.direction;
    if (shown <= 0 || glms_vec3_dot(sample->smooth, light.direction) <= 0)
        return (vec3s){{0, 0, 0}};
    struct tl_ray_packet bundle = {.count = trace ? 1 : 0, .to_m = light.distance_m};
    bundle.origin_x[0] = start.x, bundle.origin_y[0] = start.y, bundle.origin_z[0] = start.z;
    bundle.direction_x[0] = light.direction.x;
    bundle.direction_y[0] = light.direction.y;
    bundle.direction_z[0] = light.direction.z;
    float seen[BUNDLE] = {1};
    if (trace)
        tl_trace_transmittance_packet(trace, &bundle, seen);
    return glms_vec3_scale(light.irradiance, shown * seen[0]);
}
