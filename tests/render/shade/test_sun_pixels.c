/* Shadows of suns and lamps at every pixel against rays from every pixel to every place of the sun, or to the
 * lamp: how many pixels are wrong where all of the sun is seen or none, and how far off the penumbrae are.
 * The ID buffer is made by rays too, so no device is needed. */
#include "render/shade/sun_pixels.h"

#include "tests/render/scenes.h"
#include "tests/render/shade/traced_ids.h"

#include "tests/testing.h"

#include "config/base/memory.h"

#include <math.h>

#define WIDTH  300
#define HEIGHT 260
#define PIXELS ((size_t)WIDTH * HEIGHT)
#define RADIUS 0.04f /* rad: a key light's */

/* Balls under a draped sheet on the ground: shadows on all of them, wide and narrow ones. Or a square in
 * place of the balls and the sheet, nearly edge-on to the sun: its shadow on the ground is a line. */
struct sunny {
    size_t shape_count;
    struct test_shape shapes[TEST_SHAPES_MAX];
    tl_surface surfaces[TEST_SHAPES_MAX + 1];
    const tl_surface *listed[TEST_SHAPES_MAX + 1];
    struct tl_ground ground;
    tl_trace *trace;
    struct tl_triangle_ranges ranges;
    struct tl_shade_materials materials;
    struct tl_view view;
    struct tl_id_buffer ids;
    struct tl_trace_hit *hits; /* of the pixels by layer; of the ground: surface `shape_count` */
    struct tl_suns suns;
    size_t lamp_count;
    struct tl_lamp lamps[2];
};

/* Places of a sun of equal power: a spiral over the disc, the first in its middle, the first few spread all
 * over it as tl_suns_extract has them. */
static void place_sun(struct tl_sun *sun, vec3s direction, float disc)
{
    *sun = (struct tl_sun){.direction = glms_vec3_normalize(direction),
                           .power = {{3, 3, 3}},
                           .radius = disc,
                           .sample_count = TL_SUN_SAMPLES_MAX};
    vec3s right = glms_vec3_normalize(glms_vec3_cross(sun->direction, (vec3s){{0, 0, 1}}));
    vec3s up = glms_vec3_cross(right, sun->direction);
    for (int i = 0; i < TL_SUN_SAMPLES_MAX; i++) {
        const int step = (i & 1) << 3 | (i & 2) << 1 | (i & 4) >> 1 | (i & 8) >> 3; /* of the spiral */
        float turn = 2.39996323f * (float)step, radius = disc * sqrtf((float)step / TL_SUN_SAMPLES_MAX);
        vec3s aside = glms_vec3_add(glms_vec3_scale(right, radius * cosf(turn)),
                                    glms_vec3_scale(up, radius * sinf(turn)));
        sun->samples[i] = glms_vec3_normalize(glms_vec3_add(sun->direction, aside));
    }
}

/* Makes everything but the suns from the shapes. */
static void finish_sunny(struct sunny *scene)
{
    tl_error error = {0};
    for (size_t i = 0; i < scene->shape_count; i++) {
        test_shape_refresh(&scene->shapes[i]);
        scene->surfaces[i] = scene->shapes[i].surface;
        scene->listed[i] = &scene->surfaces[i];
    }
    struct tl_casters casters;
    assert_ok(tl_casters_measure(scene->surfaces, scene->shape_count, &casters, &error), error);
    tl_ground_make(&casters, TL_GROUND_GREY, &scene->ground);
    scene->listed[scene->shape_count] = &scene->ground.surface;
    scene->trace = tl_trace_create(&error);
    assert_ok(scene->trace && tl_trace_update(scene->trace, scene->surfaces, scene->shape_count, &error),
              error);
    tl_triangle_ranges_make(scene->listed, scene->shape_count + 1, &scene->ranges);
    const struct tl_detail_params *detail = tl_detail_options.defaults;
    tl_shade_materials_make(&scene->materials, scene->listed, scene->shape_count + 1, 1, detail, 5);
    tl_frame frame = test_frame((vec3s){{1.1f, 1.3f, 1.9f}}, (vec3s){{0, 0.5f, 0}}, 40, scene->surfaces,
                                scene->shape_count, NULL);
    scene->view = tl_view_make(&frame.camera, WIDTH, HEIGHT);
    const struct traced_scene traced = {&scene->ranges, &scene->view, scene->trace,
                                        &scene->ground, WIDTH,        HEIGHT};
    scene->hits = TL_NEW_ARRAY(struct tl_trace_hit, (1 + TL_TRANSPARENCY_LAYERS) * PIXELS);
    traced_ids_make(&traced, &scene->ids, scene->hits);
}

static void open_sunny(struct sunny *scene)
{
    *scene = (struct sunny){.shape_count = 3};
    scene->shapes[0] = test_sphere((vec3s){{0, 0.45f, 0}}, 0.35f, 32);
    scene->shapes[1] = test_sheet(1.1f, 0.5f, 0.08f, 2, 40);
    scene->shapes[2] = test_sphere((vec3s){{0.55f, 0.2f, 0.3f}}, 0.08f, 16); /* shadows of few pixels */
    finish_sunny(scene);
    scene->suns.count = 2;
    place_sun(&scene->suns.items[0], (vec3s){{0.6f, 1, 0.7f}}, RADIUS);
    place_sun(&scene->suns.items[1], (vec3s){{-0.9f, 0.5f, 0.1f}}, RADIUS);
}

/* A sheet that can be looked through and that light shines through, above another one and the balls. */
static void open_sheer(struct sunny *scene)
{
    *scene = (struct sunny){.shape_count = 3};
    scene->shapes[0] = test_sphere((vec3s){{0, 0.45f, 0}}, 0.35f, 32);
    scene->shapes[1] = test_sheet(1.1f, 0.5f, 0.08f, 2, 40);
    scene->shapes[2] = test_sheet(0.9f, 0.4f, 0.03f, 1, 20);
    for (int i = 1; i < 3; i++) {
        scene->shapes[i].material.openness = 0.41f;
        scene->shapes[i].material.transmission = (vec3s){{0.4f, 0.4f, 0.3f}};
    }
    finish_sunny(scene);
    scene->suns.count = 2;
    place_sun(&scene->suns.items[0], (vec3s){{0.6f, 1, 0.7f}}, RADIUS);
    place_sun(&scene->suns.items[1], (vec3s){{-0.9f, 0.5f, 0.1f}}, RADIUS);
}

/* Lamps in place of the suns: one above everything, and one below the sheet, which does not shade it. */
static void open_lamplit(struct sunny *scene)
{
    open_sunny(scene);
    scene->suns.count = 0;
    scene->lamp_count = 2;
    scene->lamps[0] = (struct tl_lamp){.kind = TL_LAMP_POINT, .position = {{0.9f, 1.6f, 0.8f}}};
    scene->lamps[1] = (struct tl_lamp){.kind = TL_LAMP_POINT, .position = {{0.35f, 0.3f, 0.35f}}};
    for (int i = 0; i < 2; i++)
        scene->lamps[i].irradiance = (vec3s){{1, 1, 1}};
}

/* A line of NARROW pixels across. */
#define NARROW 1.4f
static void open_narrow(struct sunny *scene)
{
    const vec3s towards = glms_vec3_normalize((vec3s){{-0.6f, 0.8f, 0.3f}});
    const vec3s across = glms_vec3_normalize(glms_vec3_cross(towards, (vec3s){{0.5f, 0, 0.7f}}));
    const float half = 0.45f, tilt = NARROW * 0.0067f / (2 * half); /* a pixel is 6.7 mm wide */
    vec3s normal = glms_vec3_normalize(glms_vec3_add(across, glms_vec3_scale(towards, tilt)));
    *scene = (struct sunny){.shape_count = 1};
    scene->shapes[0] =
        test_square((vec3s){{0, 0.6f, 0}}, glms_vec3_normalize(glms_vec3_cross(normal, (vec3s){{0, 1, 0}})),
                    normal, half, 1);
    finish_sunny(scene);
    scene->suns.count = 1;
    place_sun(&scene->suns.items[0], towards, 1e-4f);
}

static void close_sunny(struct sunny *scene)
{
    tl_ids_release(&scene->ids);
    tl_shade_materials_release(&scene->materials);
    tl_triangle_ranges_release(&scene->ranges);
    tl_trace_destroy(&scene->trace);
    for (size_t i = 0; i < scene->shape_count; i++)
        test_shape_release(&scene->shapes[i]);
    free(scene->hits);
}

/* The environment turned about +Y, counter-clockwise from above. */
static vec3s turned(vec3s d, float yaw)
{
    float c = cosf(yaw), s = sinf(yaw);
    return (vec3s){{c * d.x + s * d.z, d.y, c * d.z - s * d.x}};
}

/* What open sheets let through up to a distance, one after the other; 0: something is closed. */
static float let_through(const struct sunny *scene, vec3s start, vec3s direction, float to_m)
{
    float through = 1, from_m = 0;
    while (through > 0) {
        struct tl_trace_hit hit = tl_trace_nearest(scene->trace, start, direction, from_m, to_m);
        if (hit.surface == TL_TRACE_NONE)
            break;
        through *= scene->surfaces[hit.surface].materials[0].openness;
        from_m = hit.distance_m + 1e-4f;
    }
    return through;
}

/* The share of a light that arrives at what is seen, by a ray to each place of a sun, or to a lamp; -1 where
 * the surface faces away and nothing shines through. Lamps are numbered after the suns. */
static float traced(const struct sunny *scene, int light, float yaw, const struct tl_trace_hit *hit)
{
    const struct tl_sun *sun = light < scene->suns.count ? &scene->suns.items[light] : NULL;
    const struct tl_lamp *lamp = &scene->lamps[sun ? 0 : light - scene->suns.count];
    const tl_surface *surface = scene->listed[hit->surface];
    const float weights[3] = {1 - hit->u - hit->v, hit->u, hit->v};
    vec3s corners[3], normals[3], point = {{0, 0, 0}}, smooth = {{0, 0, 0}};
    for (int i = 0; i < 3; i++) {
        uint32_t corner = surface->indices[3 * hit->triangle + (uint32_t)i];
        corners[i] = surface->positions[corner];
        normals[i] = glms_vec3_scale(surface->normals[corner], hit->back ? -1.0f : 1.0f);
        point = glms_vec3_add(point, glms_vec3_scale(corners[i], weights[i]));
        smooth = glms_vec3_add(smooth, glms_vec3_scale(normals[i], weights[i]));
    }
    smooth = glms_vec3_normalize(smooth);
    float cosine = glms_vec3_dot(smooth, sun ? turned(sun->samples[0], yaw)
                                             : glms_vec3_normalize(glms_vec3_sub(lamp->position, point)));
    if (cosine < 0 && tl_material_transmits(&surface->materials[0])) {
        smooth = glms_vec3_negate(smooth);
        for (int i = 0; i < 3; i++)
            normals[i] = glms_vec3_negate(normals[i]);
        cosine = -cosine;
    }
    if (!(cosine > 0))
        return -1;
    vec3s start = glms_vec3_add(tl_smooth_point(point, corners, normals, weights),
                                glms_vec3_scale(smooth, tl_trace_offset(scene->trace)));
    float seen = 0;
    if (!sun) {
        const vec3s way = glms_vec3_sub(lamp->position, start);
        const vec3s direction = glms_vec3_normalize(way);
        return let_through(scene, start, direction, glms_vec3_norm(way)) *
               tl_ground_visibility_to(&scene->ground, start, direction, glms_vec3_norm(way));
    }
    for (int i = 0; i < sun->sample_count; i++) {
        vec3s direction = turned(sun->samples[i], yaw);
        seen += let_through(scene, start, direction, INFINITY) *
                tl_ground_visibility(&scene->ground, start, direction);
    }
    return seen / (float)sun->sample_count;
}

struct counts {
    size_t lit, dark, wrong; /* where all of the sun is seen, or none */
    size_t filtered, off;    /* where it is seen through sheets; of these those whose share is another */
    size_t soft;             /* where some places are seen and some are not */
    size_t cut;              /* ... of these the middle of a penumbra, but all of the sun or none is seen */
    double soft_error, soft_bias; /* sums */
};

/* Shares are kept in steps of the root, 2 / 63 of it at most: half of that is rounding. */
#define STEP 0.017f

static struct counts count_pixels(const struct sunny *scene, const float *visible, int layer, int sun,
                                  float yaw)
{
    struct counts counts = {0};
    const struct tl_id_buffer ids = tl_ids_layer(&scene->ids, layer);
    const float powers[] = {0.41f, 0.41f * 0.41f}; /* of one sheet, and of two */
    for (size_t i = 0; i < PIXELS; i++) {
        if (ids.ids[i] == 0)
            continue;
        float share = traced(scene, sun, yaw, &scene->hits[(size_t)layer * PIXELS + i]);
        if (share < 0)
            continue;
        if (fabsf(share - powers[0]) < 1e-5f || fabsf(share - powers[1]) < 1e-5f) {
            counts.filtered++;
            counts.off += fabsf(visible[i] - share) > STEP;
            continue;
        }
        bool all = share > 0.999f, none = share < 0.001f;
        if (!all && !none) {
            counts.soft++;
            counts.cut += share > 0.25f && share < 0.75f && (visible[i] == 0 || visible[i] == 1);
            counts.soft_error += fabs((double)(visible[i] - share));
            counts.soft_bias += (double)(visible[i] - share);
            continue;
        }
        counts.lit += all;
        counts.dark += none;
        counts.wrong += fabsf(visible[i] - share) > 0.001f;
    }
    return counts;
}

/* Measured: no pixel, 0.086 to 0.096, 0.003 to 0.021, 0.010 to 0.023; a third is added, but to the bias. Here
 * a penumbra is up to 16 pixels wide. Most of the error is that 9 of the 16 places are asked. */
#define WRONG_SHARE 5e-4
#define SOFT_ERROR  0.128
#define SOFT_BIAS   0.025
#define CUT_SHARE   0.031
#define SHEER       1

/* What is seen of each sun at each pixel, once the environment is turned by `yaw`. */
static struct tl_sun_pixels pixels_of(const struct sunny *scene, float yaw)
{
    struct tl_pixel_triangles triangles = {0};
    tl_pixel_triangles_make(&triangles, &scene->ids, &scene->view, &scene->ranges, &scene->materials);
    struct tl_pixel_lights lights;
    tl_pixel_lights_make(&scene->suns, yaw, scene->lamps, scene->lamp_count, &lights);
    const struct tl_sun_pixels_request request = {.ids = &scene->ids,
                                                  .triangles = &triangles,
                                                  .ranges = &scene->ranges,
                                                  .lights = &lights,
                                                  .trace = scene->trace,
                                                  .ground = &scene->ground,
                                                  .openness = scene->materials.openness};
    struct tl_sun_pixels pixels = {0};
    tl_sun_pixels_update(&pixels, &request);
    tl_pixel_triangles_release(&triangles);
    return pixels;
}

static void check_suns(const struct sunny *scene, float yaw)
{
    struct tl_sun_pixels pixels = pixels_of(scene, yaw);
    printf("yaw %.1f: %zu rays for %zu pixels\n", (double)yaw, pixels.rays, scene->ids.covered);
    assert_true(pixels.rays < (size_t)scene->suns.count * scene->ids.covered);
    for (int sun = 0; sun < scene->suns.count; sun++) {
        struct counts counts = count_pixels(scene, pixels.visible[0][sun], 0, sun, yaw);
        double soft = (double)counts.soft, sharp = (double)(counts.lit + counts.dark);
        printf("  sun %d: %zu lit, %zu dark, %zu of these wrong; %zu in penumbrae, %zu cut, mean error %.4f, "
               "bias %.4f\n",
               sun, counts.lit, counts.dark, counts.wrong, counts.soft, counts.cut, counts.soft_error / soft,
               counts.soft_bias / soft);
        assert_true(counts.dark > 1000 && counts.lit > 1000 && counts.soft > 500);
        assert_true((double)counts.wrong <= WRONG_SHARE * sharp);
        assert_near(counts.soft_error / soft, 0, SOFT_ERROR);
        assert_near(counts.soft_bias / soft, 0, SOFT_BIAS);
        assert_near((double)counts.cut / soft, 0, CUT_SHARE);
    }
    tl_sun_pixels_release(&pixels);
}

static void test_suns_at_pixels(void **state)
{
    (void)state;
    struct sunny scene;
    open_sunny(&scene);
    check_suns(&scene, 0);
    check_suns(&scene, 1);
    close_sunny(&scene);
}

/* Of sheer sheets every layer is looked at: of the front ones both sides, of what lies behind them through
 * them. Of each layer's pixels that see all of the sun, none, or it through sheets, as many may be wrong as
 * above, or SHEER where they are few; measured: none. Penumbrae may be off by as much in the picture. */
static void test_sheer_layers(void **state)
{
    (void)state;
    struct sunny scene;
    open_sheer(&scene);
    struct tl_sun_pixels pixels = pixels_of(&scene, 0);
    printf("%zu rays for %zu pixels of %d layers\n", pixels.rays, scene.ids.covered, scene.ids.layer_count);
    assert_true(scene.ids.layer_count >= 3);
    assert_true(pixels.rays < (size_t)scene.suns.count * scene.ids.covered);
    size_t lit = 0, filtered = 0, soft = 0;
    double weight = 1; /* of a layer in the picture */
    for (int layer = 0; layer < scene.ids.layer_count; layer++, weight *= (double)scene.materials.openness)
        for (int sun = 0; sun < 2; sun++) {
            struct counts counts = count_pixels(&scene, pixels.visible[layer][sun], layer, sun, 0);
            size_t sharp = counts.lit + counts.dark;
            printf("  layer %d, sun %d: %zu lit or dark, %zu wrong; %zu through sheets, %zu off; %zu in "
                   "penumbrae, mean error %.4f\n",
                   layer, sun, sharp, counts.wrong, counts.filtered, counts.off, counts.soft,
                   counts.soft > 0 ? counts.soft_error / (double)counts.soft : 0);
            assert_true((double)counts.wrong <= WRONG_SHARE * (double)sharp + SHEER);
            assert_true((double)counts.off <= WRONG_SHARE * (double)counts.filtered + SHEER);
            assert_true(weight * counts.soft_error <= SOFT_ERROR * (double)counts.soft);
            if (layer > 0) {
                lit += sharp;
                filtered += counts.filtered;
                soft += counts.soft;
            }
        }
    assert_true(lit > 5000 && filtered > 2000 && soft > 200); /* behind the nearest layer */
    tl_sun_pixels_release(&pixels);
    close_sunny(&scene);
}

/* A line is followed from where the corners of a cell have found it: as many of its pixels may be
 * wrong as lie before the first such cell and after the last. Measured: none; 47 where it is not followed. */
#define ENDS 8
static void test_narrow_shadows(void **state)
{
    (void)state;
    struct sunny scene;
    open_narrow(&scene);
    struct tl_sun_pixels pixels = pixels_of(&scene, 0);
    struct counts counts = count_pixels(&scene, pixels.visible[0][0], 0, 0, 0);
    printf("a line of %zu pixels: %zu wrong, %zu partly lit\n", counts.dark, counts.wrong, counts.soft);
    assert_true(counts.dark > 100);
    assert_true(counts.wrong <= ENDS);
    tl_sun_pixels_release(&pixels);
    close_sunny(&scene);
}

/* Measured: one wrong and none. */
static void test_lamps_at_pixels(void **state)
{
    (void)state;
    struct sunny scene;
    open_lamplit(&scene);
    struct tl_sun_pixels pixels = pixels_of(&scene, 0);
    printf("lamps: %zu rays for %zu pixels\n", pixels.rays, scene.ids.covered);
    assert_true(pixels.rays < scene.lamp_count * scene.ids.covered);
    for (int lamp = 0; lamp < 2; lamp++) {
        struct counts counts = count_pixels(&scene, pixels.visible[0][lamp], 0, lamp, 0);
        printf("  lamp %d: %zu lit, %zu dark, %zu of these wrong\n", lamp, counts.lit, counts.dark,
               counts.wrong);
        assert_true(counts.dark > 1000 && counts.lit > 1000);
        assert_true((double)counts.wrong <= WRONG_SHARE * (double)(counts.lit + counts.dark));
    }
    tl_sun_pixels_release(&pixels);
    close_sunny(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_suns_at_pixels), cmocka_unit_test(test_sheer_layers),
        cmocka_unit_test(test_narrow_shadows), cmocka_unit_test(test_lamps_at_pixels)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
