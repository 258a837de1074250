/* ID buffers for tests that need no device: made by tracing the ray through every pixel's centre, as
 * tl_ids_draw leaves them. */
#ifndef TOILE_TESTS_RENDER_SHADE_TRACED_IDS_H
#define TOILE_TESTS_RENDER_SHADE_TRACED_IDS_H

#include "config/base/memory.h"
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

/* What lies nearest behind a pixel, rows upwards, and `behind_m` along its ray. The ground counts as a
 * surface after those of the trace. */
static inline struct tl_trace_hit traced_hit(const struct traced_scene *scene, int x, int y, float behind_m)
{
    /* The camera's rays count rows from the top. */
    struct tl_ray_differential ray =
        tl_camera_ray(scene->view, scene->width, scene->height, x, scene->height - 1 - y);
    struct tl_trace_hit hit =
        tl_trace_nearest(scene->trace, ray.origin, ray.direction, fmaxf(ray.from_m, behind_m), ray.to_m);
    vec3s point;
    float weights[3];
    uint32_t triangle;
    if (scene->ground &&
        tl_ground_meet(scene->ground, ray.origin, ray.direction, &point, &triangle, weights)) {
        float distance_m = glms_vec3_distance(point, ray.origin);
        if (distance_m > behind_m && (hit.surface == TL_TRACE_NONE || distance_m < hit.distance_m))
            hit = (struct tl_trace_hit){.surface = (uint32_t)scene->ranges->surface_count - 1,
                                        .triangle = triangle,
                                        .u = weights[1],
                                        .v = weights[2],
                                        .distance_m = distance_m};
    }
    return hit;
}

static inline const tl_material *traced_material(const struct traced_scene *scene,
                                                 const struct tl_trace_hit *hit)
{
    return tl_triangle_material(scene->ranges, scene->ranges->first[hit->surface] + hit->triangle);
}

/* Fills an empty buffer, and the hits [1 + TL_TRANSPARENCY_LAYERS][height][width] that it is made from. */
static inline void traced_ids_make(const struct traced_scene *scene, struct tl_id_buffer *ids,
                                   struct tl_trace_hit *hits)
{
    const float aside_m = 1e-4f; /* a surface does not lie behind itself */
    const size_t triangles = scene->ranges->first[scene->ranges->surface_count];
    const size_t width = (size_t)scene->width, pixels = width * (size_t)scene->height;
    *ids = (struct tl_id_buffer){.width = scene->width,
                                 .height = scene->height,
                                 .ids = TL_NEW_ARRAY(uint32_t, pixels),
                                 .depths = TL_NEW_ARRAY(uint8_t, (size_t)scene->height),
                                 .layer_count = 1,
                                 .triangle_count = triangles,
                                 .seen = TL_NEW_ARRAY(uint32_t, 2 * triangles),
                                 .places = TL_NEW_ARRAY(uint32_t, 2 * triangles),
                                 .marks = TL_NEW_ARRAY(uint8_t, 2 * triangles)};
    for (int k = 0; k < TL_TRANSPARENCY_LAYERS; k++)
        ids->layers[k] = TL_NEW_ARRAY(uint32_t, pixels);
    for (size_t i = 0; i < pixels; i++) {
        float behind_m = 0;
        for (int k = 0; k <= TL_TRANSPARENCY_LAYERS; k++) {
            struct tl_trace_hit hit = traced_hit(scene, (int)(i % width), (int)(i / width), behind_m);
            hits[(size_t)k * pixels + i] = hit;
            if (hit.surface == TL_TRACE_NONE)
                break;
            const tl_material *material = traced_material(scene, &hit);
            uint32_t id = scene->ranges->first[hit.surface] + hit.triangle + 1;
            (k == 0 ? ids->ids : ids->layers[k - 1])[i] = id | (hit.back ? TL_SAMPLE_BACK : 0);
            uint8_t *marks = ids->marks + 2 * (size_t)(id - 1); /* front, back */
            marks[hit.back] = 1;
            if (tl_material_transmits(material))
                marks[0] = marks[1] = 1;
            ids->covered++;
            ids->layer_count = k + 1 > ids->layer_count ? k + 1 : ids->layer_count;
            if (k > ids->depths[i / width])
                ids->depths[i / width] = (uint8_t)k;
            if (!(material->openness > 0))
                break;
            behind_m = hit.distance_m + aside_m;
        }
    }
    for (uint32_t i = 0; i < 2 * triangles; i++)
        if (ids->marks[i]) {
            ids->places[i] = (uint32_t)ids->seen_count;
            ids->seen[ids->seen_count++] = i / 2 | (i & 1 ? TL_SAMPLE_BACK : 0);
        }
}

#endif
