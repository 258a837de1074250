/* ID buffers for tests that need no device: made by tracing the ray through every pixel's centre, as
 * tl_ids_draw leaves them. */
#ifndef TOILE_TESTS_RENDER_SHADE_TRACED_IDS_H
#define TOILE_TESTS_RENDER_SHADE_TRACED_IDS_H

#include "config/memory.h"
#include "render/gbuffer/ids.h"
#include "render/reference/shading_point.h"
#include "render/trace/trace.h"

#include <math.h>

struct traced_scene {
    const struct tl_triangle_ranges *ranges; /* of the traced surfaces, and of the ground, which comes last */
    const struct tl_view *view;
    const tl_trace *trace;
    const struct tl_ground *ground; /* NULL: none */
    int width, height;
};

/* What lies nearest behind a pixel, rows upwards. The ground counts as a surface after those of the trace. */
static inline struct tl_trace_hit traced_hit(const struct traced_scene *scene, int x, int y)
{
    /* The camera's rays count rows from the top. */
    struct tl_ray_differential ray =
        tl_camera_ray(scene->view, scene->width, scene->height, x, scene->height - 1 - y);
    struct tl_trace_hit hit = tl_trace_nearest(scene->trace, ray.origin, ray.direction, ray.from_m, ray.to_m);
    vec3s point;
    float weights[3];
    uint32_t triangle;
    if (scene->ground &&
        tl_ground_meet(scene->ground, ray.origin, ray.direction, &point, &triangle, weights) &&
        (hit.surface == TL_TRACE_NONE || glms_vec3_distance(point, ray.origin) < hit.distance_m))
        hit = (struct tl_trace_hit){.surface = (uint32_t)scene->ranges->surface_count - 1,
                                    .triangle = triangle,
                                    .u = weights[1],
                                    .v = weights[2]};
    return hit;
}

/* Fills an empty buffer, and the hits [height][width] that it is made from. */
static inline void traced_ids_make(const struct traced_scene *scene, struct tl_id_buffer *ids,
                                   struct tl_trace_hit *hits)
{
    const size_t triangles = scene->ranges->first[scene->ranges->surface_count];
    const size_t pixels = (size_t)scene->width * (size_t)scene->height;
    *ids = (struct tl_id_buffer){.width = scene->width,
                                 .height = scene->height,
                                 .ids = TL_NEW_ARRAY(uint32_t, pixels),
                                 .triangle_count = triangles,
                                 .seen = TL_NEW_ARRAY(uint32_t, 2 * triangles),
                                 .places = TL_NEW_ARRAY(uint32_t, 2 * triangles),
                                 .marks = TL_NEW_ARRAY(uint8_t, 2 * triangles)};
    for (size_t i = 0; i < pixels; i++) {
        hits[i] = traced_hit(scene, (int)(i % (size_t)scene->width), (int)(i / (size_t)scene->width));
        if (hits[i].surface == TL_TRACE_NONE)
            continue;
        uint32_t id = scene->ranges->first[hits[i].surface] + hits[i].triangle + 1;
        ids->ids[i] = id | (hits[i].back ? TL_SAMPLE_BACK : 0);
        ids->marks[2 * (id - 1) + (hits[i].back ? 1 : 0)] = 1;
        ids->covered++;
    }
    for (uint32_t i = 0; i < 2 * triangles; i++)
        if (ids->marks[i]) {
            ids->places[i] = (uint32_t)ids->seen_count;
            ids->seen[ids->seen_count++] = i / 2 | (i & 1 ? TL_SAMPLE_BACK : 0);
        }
}

#endif
