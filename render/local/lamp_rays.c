#include "render/local/lamp_rays.h"

#include <math.h>
#include <string.h>

#define PACKET 16 /* rays */
#define BLOCK  64 /* packets that a thread takes at a time */

/* Traces one packet of neighbouring samples. Directions to a point lamp have the length of the distance to
 * it, so that the rays end at 1. */
static void trace_packet(const struct tl_lamp *lamp, const struct tl_trace *trace, const tl_sample *samples,
                         int count, const struct tl_triangle_ranges *ranges, const struct tl_ground *ground,
                         uint8_t *out)
{
    bool is_point = lamp->kind == TL_LAMP_POINT;
    float offset_m = tl_trace_offset(trace);
    struct tl_ray_packet packet = {.to_m = is_point ? 1 : INFINITY, .coherent = true};
    uint32_t texels[PACKET];
    float shown[PACKET];
    for (int i = 0; i < count; i++) {
        const tl_sample *sample = &samples[i];
        vec3s start = tl_sample_start(sample, ranges, offset_m);
        struct tl_lamplight light = tl_lamp_at(lamp, start, sample->smooth);
        float left = tl_ground_visibility_to(ground, start, light.direction, light.distance_m);
        if (left <= 0 || glms_vec3_dot(sample->smooth, light.direction) <= 0)
            continue;
        vec3s way = is_point ? glms_vec3_sub(lamp->position, start) : light.direction;
        int k = packet.count++;
        packet.origin_x[k] = start.x, packet.origin_y[k] = start.y, packet.origin_z[k] = start.z;
        packet.direction_x[k] = way.x, packet.direction_y[k] = way.y, packet.direction_z[k] = way.z;
        texels[k] = sample->texel;
        shown[k] = left;
    }
    if (packet.count == 0)
        return;
    float transmittance[PACKET];
    tl_trace_transmittance_packet(trace, &packet, transmittance);
    for (int k = 0; k < packet.count; k++)
        out[texels[k]] = (uint8_t)lroundf(255 * shown[k] * transmittance[k]);
}

void tl_lamp_rays(const struct tl_lamp *lamp, const struct tl_trace *trace, const struct tl_samples *samples,
                  const struct tl_triangle_ranges *ranges, const struct tl_ground *ground, uint8_t *out)
{
    size_t count = samples->primary_count;
    memset(out, 0, (size_t)samples->width * (size_t)samples->height);
#pragma omp parallel for schedule(dynamic, BLOCK)
    for (size_t first = 0; first < count; first += PACKET)
        trace_packet(lamp, trace, samples->items + first,
                     count - first < PACKET ? (int)(count - first) : PACKET, ranges, ground, out);
}

vec3s tl_lamp_irradiance_at(const struct tl_lamp *lamp, const tl_trace *trace, const tl_sample *sample,
                            const struct tl_triangle_ranges *ranges, const struct tl_ground *ground,
                            vec3s *direction)
{
    vec3s start = trace ? tl_sample_start(sample, ranges, tl_trace_offset(trace)) : sample->point;
    struct tl_lamplight light = tl_lamp_at(lamp, start, sample->smooth);
    float shown = trace ? tl_ground_visibility_to(ground, start, light.direction, light.distance_m) : 1;
    *direction = light.direction;
    if (shown <= 0 || glms_vec3_dot(sample->smooth, light.direction) <= 0)
        return (vec3s){{0, 0, 0}};
    struct tl_ray_packet packet = {.count = trace ? 1 : 0, .to_m = light.distance_m};
    packet.origin_x[0] = start.x, packet.origin_y[0] = start.y, packet.origin_z[0] = start.z;
    packet.direction_x[0] = light.direction.x;
    packet.direction_y[0] = light.direction.y;
    packet.direction_z[0] = light.direction.z;
    float transmittance[PACKET] = {1};
    if (trace)
        tl_trace_transmittance_packet(trace, &packet, transmittance);
    return glms_vec3_scale(light.irradiance, shown * transmittance[0]);
}
