/* Reflections in near mirrors: a coloured wall in a mirror on the floor, with the sky beside it. */
#include "tests/render/scenes.h"

#include "config/base/memory.h"
#include "render/env/from_environment.h"
#include "render/light/compose.h"

#include "tests/testing.h"

#include <string.h>

#define SAMPLES 64

/* A mirror in the plane y = 0, a wall in the plane x = 1 that faces it; even light of 1 and nothing in its
 * way. */
struct stage {
    struct test_shape mirror, wall;
    tl_surface surfaces[2];
    const tl_surface *drawn[2];
    struct tl_triangle_ranges ranges;
    tl_trace *trace;
    struct tl_samples samples;
    struct tl_mirrors mirrors;
};

/* Samples along the floor's x axis, seen from above at 45 degrees towards the wall. */
static void stage_open_with(struct stage *stage, float glossiness, const tl_material *wall)
{
    tl_error error = {0};
    *stage = (struct stage){
        .mirror = test_square((vec3s){{0, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 1, 0}}, 2, 4),
        .wall = test_square((vec3s){{1, 1, 0}}, (vec3s){{0, 0, 1}}, (vec3s){{-1, 0, 0}}, 1, 4)};
    stage->wall.material = *wall;
    test_shape_refresh(&stage->mirror);
    test_shape_refresh(&stage->wall);
    stage->surfaces[0] = stage->mirror.surface;
    stage->surfaces[1] = stage->wall.surface;
    for (int i = 0; i < 2; i++)
        stage->drawn[i] = &stage->surfaces[i];
    tl_triangle_ranges_make(stage->drawn, 2, &stage->ranges);
    stage->trace = tl_trace_create(&error);
    assert_ok(stage->trace && tl_trace_update(stage->trace, stage->surfaces, 2, &error), error);
    stage->samples = (struct tl_samples){.width = SAMPLES, .height = 1};
    tl_samples_reserve(&stage->samples, SAMPLES);
    stage->samples.count = stage->samples.primary_count = SAMPLES;
    vec3s view = glms_vec3_normalize((vec3s){{-1, 1, 0}});
    for (uint32_t i = 0; i < SAMPLES; i++) {
        float x = -1.9f + 2.8f * (float)i / (SAMPLES - 1);
        stage->samples.items[i] = (tl_sample){.texel = i,
                                              .weights = {1, 0, 0},
                                              .cover = 1,
                                              .point = {{x, 0, 0.01f}},
                                              .normal = {{0, 1, 0}},
                                              .smooth = {{0, 1, 0}},
                                              .mirror = {{-view.x, view.y, 0}},
                                              .glossiness = glossiness,
                                              .specular = {{0.5f, 0.5f, 0.5f}}};
    }
    tl_mirrors_trace(&stage->mirrors, stage->trace, &stage->ranges, NULL, &stage->samples);
}

static tl_material matt_wall(void)
{
    tl_material wall = tl_material_default("wall");
    wall.diffuse = (vec3s){{0.8f, 0.4f, 0.2f}};
    wall.specular = (vec3s){{0, 0, 0}};
    return wall;
}

static void stage_open(struct stage *stage, float glossiness)
{
    const tl_material wall = matt_wall();
    stage_open_with(stage, glossiness, &wall);
}

static void stage_close(struct stage *stage)
{
    tl_mirrors_release(&stage->mirrors);
    tl_samples_release(&stage->samples);
    tl_triangle_ranges_release(&stage->ranges);
    tl_trace_destroy(&stage->trace);
    test_shape_release(&stage->mirror);
    test_shape_release(&stage->wall);
}

/* The wall is 2 m high, so a ray at 45 degrees meets it from x = -1 on. */
static bool shows_wall(float x)
{
    return x > -1;
}

static void rays_meet_what_is_there(void **state)
{
    (void)state;
    struct stage stage;
    stage_open(&stage, 1);
    size_t hits = 0;
    for (size_t i = 0; i < SAMPLES; i++) {
        const tl_sample *sample = &stage.samples.items[i];
        uint32_t hit = stage.mirrors.items[i].hits[0];
        assert_int_equal(stage.mirrors.items[i].ray_count, 1);
        if (!shows_wall(sample->point.x)) {
            assert_int_equal(hit, TL_MIRROR_OPEN);
            continue;
        }
        assert_in_range(hit, SAMPLES, stage.samples.count - 1);
        const tl_sample *shown = &stage.samples.items[hit];
        assert_int_equal(shown->texel, sample->texel);
        assert_near(shown->point.x, 1, 1e-4);
        assert_near(shown->point.y, 1 - sample->point.x, 1e-3);
        assert_near(shown->normal.x, -1, 1e-5);
        assert_near(shown->diffuse.y, 0.4, 1e-6);
        hits++;
    }
    assert_int_equal(stage.samples.count, SAMPLES + hits);
    stage_close(&stage);
}

/* The wall as it is seen along the mirrored ray: Schlick's reflectance at its 45 degrees, the mirrored
 * direction on its own viewer's side, and the back's own colours where that is seen. */
static void what_is_met_looks_itself(void **state)
{
    (void)state;
    const vec3s f0 = {{0.1f, 0.2f, 0.3f}}, back_f0 = {{0.05f, 0.5f, 0.02f}},
                back_colour = {{0.1f, 0.2f, 0.6f}};
    for (int look = 0; look < 4; look++) { /* front and back that are alike; those that are not */
        const bool turned = look & 1, own = look == 3;
        tl_material wall = matt_wall();
        wall.specular = f0;
        wall.glossiness = 0.7f;
        wall.openness = 0.3f;
        wall.double_sided = true;
        wall.back = (struct tl_back){look >= 2, back_colour, back_f0};
        struct stage stage;
        stage_open_with(&stage, 1, &wall);
        if (turned) { /* the mirror lies on the wall's other side, which the rays meet */
            for (size_t i = 0; i < SAMPLES; i++) {
                tl_sample *sample = &stage.samples.items[i];
                sample->point.x = 2 - sample->point.x;
                sample->mirror.x = -sample->mirror.x;
            }
            stage.samples.count = SAMPLES;
            tl_mirrors_trace(&stage.mirrors, stage.trace, &stage.ranges, NULL, &stage.samples);
        }
        size_t hits = stage.samples.count - SAMPLES;
        assert_in_range(hits, SAMPLES / 2, SAMPLES);
        for (size_t i = SAMPLES; i < stage.samples.count; i++) {
            const tl_sample *seen = &stage.samples.items[i];
            const double share = pow(1 - sqrt(0.5), 5);
            assert_near(seen->normal.x, turned ? 1 : -1, 1e-5);
            assert_near(seen->smooth.x, turned ? 1 : -1, 1e-5);
            assert_near(seen->mirror.x, (turned ? 1 : -1) * sqrt(0.5), 1e-5);
            assert_near(seen->mirror.y, sqrt(0.5), 1e-5);
            assert_near(seen->cover, 0.7, 1e-6);
            assert_near(seen->glossiness, 0.7, 1e-6);
            assert_true(((seen->triangle & TL_SAMPLE_BACK) != 0) == turned);
            for (int c = 0; c < 3; c++) {
                const double r = (double)(own ? back_f0 : f0).raw[c];
                assert_near(seen->diffuse.raw[c], (own ? back_colour : wall.diffuse).raw[c], 1e-6);
                assert_near(seen->specular.raw[c], r + (1 - r) * share, 1e-5);
            }
        }
        stage_close(&stage);
    }
}

/* Directions of a lobe cos^s by even shares of its volume: the mean of their cosines is (s + 1) / (s + 2),
 * which the middles of shares reach within 1 / count^2 of its width, and they lie on all sides of the axis.
 */
static void directions_follow_the_lobe(void **state)
{
    (void)state;
    enum { COUNT = 512 };
    static const float exponents[] = {1, 10, 200, 1500};
    static const vec3s axes[] = {{{0, 1, 0}}, {{0.6f, 0, -0.8f}}, {{-0.48f, 0.6f, 0.64f}}};
    for (size_t e = 0; e < TL_COUNT(exponents); e++)
        for (size_t a = 0; a < TL_COUNT(axes); a++) {
            const double s = (double)exponents[e], width = 1 / (s + 2);
            double cosines = 0, squares = 0;
            vec3s sum = {{0, 0, 0}};
            for (int m = 0; m < COUNT; m++) {
                const vec3s d = tl_mirror_direction(axes[a], exponents[e], m, COUNT);
                const double cosine = (double)glms_vec3_dot(d, axes[a]);
                assert_near(glms_vec3_norm(d), 1, 1e-5);
                cosines += cosine / COUNT;
                squares += cosine * cosine / COUNT;
                sum = glms_vec3_add(sum, glms_vec3_scale(d, 1.0f / COUNT));
            }
            assert_near(cosines, (s + 1) / (s + 2), 0.002 * width + 1e-6);
            assert_near(squares, (s + 1) / (s + 3), 0.004 * width + 1e-6);
            const vec3s aside = glms_vec3_sub(sum, glms_vec3_scale(axes[a], (float)cosines));
            assert_near(glms_vec3_norm(aside), 0, 0.02 * sqrt(width));
        }
    assert_int_equal(tl_mirror_ray_count(1e5f), 1);
    assert_true(glms_vec3_eqv_eps(tl_mirror_direction(axes[2], 1e5f, 0, 1), axes[2]));
}

/* A mirror that a mirror shows is free to see the sky: its ray goes up and away. */
static void mirrors_in_mirrors_end(void **state)
{
    (void)state;
    tl_material wall = matt_wall();
    wall.glossiness = 1;
    wall.double_sided = true;
    struct stage stage;
    stage_open_with(&stage, 1, &wall);
    assert_true(stage.samples.count > SAMPLES + SAMPLES / 2);
    for (size_t i = SAMPLES; i < stage.samples.count; i++) { /* rays go on, up and away from the wall */
        assert_int_equal(stage.mirrors.items[i].ray_count, 1);
        assert_int_equal(stage.mirrors.items[i].hits[0], TL_MIRROR_OPEN);
    }
    stage_close(&stage);
}

/* Even light of 1 everywhere: sky shows 1, and the wall its own colour. */
static void what_is_met_is_lit(void **state)
{
    (void)state;
    static const float glossinesses[] = {0.996f, 0.9999f, 1};
    tl_environment sky = tl_environment_constant(1, 1, 1);
    tl_cube cube = tl_cube_from_environment(&sky, 16);
    struct tl_regions regions = {0};
    struct tl_lobes lobes = {0};
    struct tl_region_lights *lights = TL_NEW(struct tl_region_lights);
    struct tl_suns suns = {0};
    tl_regions_cut_sphere(&cube, 96, &regions);
    tl_lobes_make(&lobes, &cube, tl_exponents_needed(0, 1));
    tl_region_lights_begin(lights, &regions, TL_WEIGHT_POWER);
    tl_region_lights_add(lights, &lobes, ~0u);
    uint16_t values[96];
    memset(values, 0xff, sizeof values);
    for (size_t k = 0; k < TL_COUNT(glossinesses); k++) {
        struct stage stage;
        stage_open(&stage, glossinesses[k]);
        struct tl_taps *taps = TL_NEW_ARRAY(struct tl_taps, stage.samples.count);
        for (size_t i = 0; i < stage.samples.count; i++)
            taps[i].weight[0] = 1;
        float light[4 * SAMPLES] = {0};
        const struct tl_light_params params = {.method = TL_METHOD_PEM, .lobe = TL_LOBE_DUAL};
        const struct tl_compose_request request = {.samples = &stage.samples,
                                                   .lights = lights,
                                                   .suns = &suns,
                                                   .lobes = &lobes,
                                                   .values = values,
                                                   .stride = 96,
                                                   .taps = taps,
                                                   .environment = &sky,
                                                   .mirrors = stage.mirrors.items,
                                                   .params = &params};
        tl_compose(&request, light);
        for (size_t i = 0; i < SAMPLES; i++) {
            float x = stage.samples.items[i].point.x;
            if (fabsf(x + 1) < 0.85f || x > 0.7f)
                continue; /* the wall's edge and foot, where a lobe shows both */
            static const float wall[3] = {0.8f, 0.4f, 0.2f};
            for (int c = 0; c < 3; c++) /* 2 %: a wall's light is cut at its horizon, region by region */
                assert_near(light[4 * i + (size_t)c], 0.5f * (shows_wall(x) ? wall[c] : 1), 0.02 * 0.5);
        }
        free(taps);
        stage_close(&stage);
    }
    tl_region_lights_release(lights);
    free(lights);
    tl_lobes_release(&lobes);
    tl_regions_release(&regions);
    tl_cube_release(&cube);
    tl_environment_release(&sky);
}

static void ground_is_met_where_it_lies(void **state)
{
    (void)state;
    struct tl_ground *ground = TL_NEW(struct tl_ground);
    tl_ground_make(&(struct tl_casters){.centre = {{0.2f, 1, -0.1f}}, .radius = 1}, TL_GROUND_GREY, ground);
    for (int i = 0; i < 500; i++) {
        bool on_border = i % 2; /* of two segments */
        float angle = on_border ? 2 * (float)M_PI * (float)i / TL_GROUND_SEGMENTS : 0.37f * (float)i;
        float reach = 0.01f * (float)i;
        vec3s to = {{0.2f + reach * cosf(angle), 0, -0.1f + reach * sinf(angle)}}, from = {{1, 2, 3}}, point;
        uint32_t triangle;
        float weights[3];
        bool met = tl_ground_meet(ground, from, glms_vec3_normalize(glms_vec3_sub(to, from)), &point,
                                  &triangle, weights);
        assert_true(met == (tl_ground_cover(ground, to.x, to.z) > 0));
        if (!met)
            continue;
        vec3s joined = {{0, 0, 0}};
        for (int k = 0; k < 3; k++)
            joined = glms_vec3_add(
                joined, glms_vec3_scale(ground->positions[ground->indices[3 * (size_t)triangle + (size_t)k]],
                                        weights[k]));
        assert_near(glms_vec3_distance(joined, to), 0, 2e-3);
        for (int k = 0; k < 3; k++)
            assert_true(weights[k] >= 0);
        assert_near(weights[0] + weights[1] + weights[2], 1, 3e-7);
    }
    free(ground);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_meet_what_is_there),    cmocka_unit_test(what_is_met_looks_itself),
        cmocka_unit_test(directions_follow_the_lobe), cmocka_unit_test(mirrors_in_mirrors_end),
        cmocka_unit_test(what_is_met_is_lit),         cmocka_unit_test(ground_is_met_where_it_lies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
