/* The scene of the tests of visibility at points. Every function fails the running test when what it calls
 * fails. Not for threads. */
#ifndef TOILE_TESTS_RENDER_VISIBILITY_POINTS_STAGE_H
#define TOILE_TESTS_RENDER_VISIBILITY_POINTS_STAGE_H

#include "render/visibility/points.h"

#include "config/base/memory.h"

#include "tests/render/scenes.h"
#include "tests/testing.h"

#include <string.h>

/* A folded sheet over a sphere on the ground, in an environment of a few regions, with one sample in the
 * middle of every triangle of sheet and ground. */
struct stage {
    struct test_shape sheet, sphere;
    struct tl_casters casters;
    struct tl_ground ground;
    tl_surface shapes[2];
    const tl_surface *all[3];
    struct tl_triangle_ranges ranges;
    tl_cube cube;
    struct tl_regions regions;
    struct tl_samples samples;
    tl_trace *trace;
    tl_points *points;
    struct tl_ray_params params;
    struct tl_points_request request;
};

static vec3s smooth_sky(vec3s d)
{
    float light = 1 + 0.6f * d.y + 0.3f * d.x * d.z;
    return (vec3s){{light, light, 0.5f * light}};
}

static tl_cube make_cube(vec3s (*radiance)(vec3s direction))
{
    tl_cube cube = tl_cube_create(16);
    for (int i = 0; i < 6 * 256; i++) {
        float s = ((float)(i % 16) + 0.5f) / 16, t = ((float)(i / 16 % 16) + 0.5f) / 16;
        vec3s light = radiance(glms_vec3_normalize(tl_cube_direction(i / 256, s, t)));
        memcpy(cube.texels + 3 * (size_t)i, light.raw, sizeof light);
    }
    return cube;
}

/* Seen from the side that faces the front of the triangle, or its back. */
static void add_sample(struct stage *stage, uint32_t triangle, bool back)
{
    uint32_t corners[3];
    size_t index;
    const tl_surface *surface = tl_triangle_find(&stage->ranges, triangle, corners, &index);
    tl_sample *sample = &stage->samples.items[stage->samples.count];
    *sample = (tl_sample){.texel = (uint32_t)stage->samples.count++,
                          .triangle = triangle | (back ? TL_SAMPLE_BACK : 0),
                          .weights = {0.5f, 0.3f, 0.2f},
                          .cover = 1,
                          .glossiness = 0.5f,
                          .diffuse = {{1, 1, 1}},
                          .specular = {{1, 1, 1}}};
    for (int i = 0; i < 3; i++) {
        vec3s normal = surface->normals[corners[i]];
        sample->point =
            glms_vec3_add(sample->point, glms_vec3_scale(surface->positions[corners[i]], sample->weights[i]));
        sample->normal = glms_vec3_add(
            sample->normal, glms_vec3_scale(normal, back ? -sample->weights[i] : sample->weights[i]));
    }
    sample->normal = sample->smooth = sample->mirror = glms_vec3_normalize(sample->normal);
}

static void make_samples(struct stage *stage)
{
    uint32_t sheet = stage->ranges.first[1], ground = stage->ranges.first[2], end = stage->ranges.first[3];
    stage->samples.count = 0;
    stage->samples.capacity = 2 * (size_t)end;
    free(stage->samples.items);
    stage->samples.items = TL_NEW_ARRAY(tl_sample, stage->samples.capacity);
    for (uint32_t i = 0; i < sheet; i++)
        add_sample(stage, i, i % 7 == 0);
    for (uint32_t i = ground; i < end; i++)
        add_sample(stage, i, false);
    stage->samples.width = 64;
    stage->samples.height = ((int)stage->samples.count + 63) / 64;
}

/* The sheet's waves travel with `phase`. */
static void move_sheet(struct stage *stage, float phase)
{
    tl_mesh *mesh = &stage->sheet.mesh;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        vec3s *p = &mesh->positions[i];
        float k = 9, x = p->x + phase, dx = 0.12f * k * cosf(k * x) * cosf(k * p->z);
        float dz = -0.12f * k * sinf(k * x) * sinf(k * p->z);
        p->y = 0.9f + 0.12f * sinf(k * x) * cosf(k * p->z);
        mesh->normals[i] = glms_vec3_normalize((vec3s){{-dx, 1, -dz}});
    }
    stage->sheet.surface.motion_revision++;
}

static void refresh_scene(struct stage *stage)
{
    tl_error error = {0};
    stage->shapes[0] = stage->sheet.surface;
    stage->shapes[1] = stage->sphere.surface;
    assert_ok(tl_trace_update(stage->trace, stage->shapes, 2, &error), error);
    tl_triangle_ranges_make(stage->all, 3, &stage->ranges);
    make_samples(stage);
}

static void use_regions(struct stage *stage, int count)
{
    stage->regions = (struct tl_regions){0};
    tl_regions_cut_sphere(&stage->cube, count, &stage->regions);
    stage->request.regions_revision++;
}

static void stage_open(struct stage *stage, int region_count)
{
    tl_error error = {0};
    *stage = (struct stage){.params = {.rays = 1, .rounds = 4096},
                            .cube = make_cube(smooth_sky),
                            .trace = tl_trace_create(&error),
                            .points = tl_points_create()};
    stage->sheet = test_sheet(0.9f, 0.6f, 0.12f, 1, 20);
    stage->sphere = test_sphere((vec3s){{0.1f, 0.4f, 0}}, 0.35f, 12);
    test_shape_refresh(&stage->sheet);
    test_shape_refresh(&stage->sphere);
    stage->shapes[0] = stage->sheet.surface;
    stage->shapes[1] = stage->sphere.surface;
    assert_ok(tl_casters_measure(stage->shapes, 2, &stage->casters, &error), error);
    tl_ground_make(&stage->casters, TL_GROUND_GREY, &stage->ground);
    stage->all[0] = &stage->shapes[0];
    stage->all[1] = &stage->shapes[1];
    stage->all[2] = &stage->ground.surface;
    move_sheet(stage, 0);
    stage->samples.primary_count = stage->samples.count;
    stage->request = (struct tl_points_request){.trace = stage->trace,
                                                .ranges = &stage->ranges,
                                                .samples = &stage->samples,
                                                .regions = &stage->regions,
                                                .shapes_revision = 1,
                                                .ground = &stage->ground,
                                                .params = &stage->params,
                                                .moved = true};
    refresh_scene(stage);
    use_regions(stage, region_count);
}

static void stage_close(struct stage *stage)
{
    tl_points_destroy(&stage->points);
    assert_null(stage->points);
    tl_trace_destroy(&stage->trace);
    tl_regions_release(&stage->regions);
    tl_cube_release(&stage->cube);
    tl_triangle_ranges_release(&stage->ranges);
    free(stage->samples.items);
    test_shape_release(&stage->sheet);
    test_shape_release(&stage->sphere);
}

static void step(struct stage *stage, bool moved)
{
    stage->request.moved = moved;
    tl_points_update(stage->points, &stage->request);
}

#endif
