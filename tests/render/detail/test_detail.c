/* Detail in the frame against its counterpart on the CPU and against the reference; options that are off cost
 * nothing. A square whose colour is its u, in uniform light of 1, shows where its maps are read. */
#include "tests/render/scenes.h"

#include "config/base/memory.h"
#include "render/detail/cones.h"
#include "render/detail/field.h"
#include "render/metrics/compare.h"
#include "render/reference/reference.h"

#include "tests/testing.h"

#include <string.h>

#define SIZE  32
#define DEPTH 0.02f /* of the height map, of a side of the square */

struct stage {
    tl_image ramp, bumps;
    struct test_shape shape;
    tl_environment white;
    float metres; /* a side of the square, and of the unit of UV */
    tl_frame frame;
    struct tl_render_settings settings;
};

static struct stage *stage_new_of(float metres)
{
    struct stage *stage = TL_NEW(struct stage);
    stage->metres = metres;
    stage->ramp = tl_image_create(256, 1, 3, TL_IMAGE_F32);
    for (int i = 0; i < 3 * 256; i++) {
        int column = i / 3;
        tl_image_floats(&stage->ramp)[i] = i % 3 == 2 ? 1 : ((float)column + 0.5f) / 256;
    }
    stage->bumps = tl_image_create(64, 64, 1, TL_IMAGE_U8);
    stage->bumps.linear = true;
    for (int i = 0; i < 64 * 64; i++) {
        int column = i % 64, row = i / 64;
        float x = 2 * (float)M_PI * ((float)column + 0.5f) / 16,
              y = 2 * (float)M_PI * ((float)row + 0.5f) / 16;
        tl_image_bytes(&stage->bumps)[i] = (uint8_t)lrintf(127.5f + 60 * sinf(x) + 60 * cosf(y));
    }
    stage->shape = test_square((vec3s){{0, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 0, 1}}, 0.5f * metres, 2);
    tl_material *material = &stage->shape.material;
    material->diffuse = (vec3s){{1, 1, 1}};
    material->specular = (vec3s){{0, 0, 0}};
    material->diffuse_map.image = &stage->ramp;
    material->diffuse_map.clamp_u = material->diffuse_map.clamp_v = true;
    material->height_map.image = &stage->bumps;
    material->height_m = DEPTH * metres;
    test_shape_refresh(&stage->shape);
    stage->white = tl_environment_constant(1, 1, 1);
    stage->frame = test_frame((vec3s){{1.2f * metres, 0.5f * metres, 1.3f * metres}}, (vec3s){{0, 0, 0}}, 16,
                              &stage->shape.surface, 1, &stage->white);
    stage->settings = test_settings(SIZE, SIZE);
    stage->settings.light.method = TL_METHOD_UNSHADOWED;
    stage->settings.light.composition = TL_COMPOSE_DIFFERENCE;
    stage->settings.image.supersample = 1;
    return stage;
}

static struct stage *stage_new(void)
{
    return stage_new_of(1);
}

static void stage_free(struct stage *stage)
{
    tl_image_release(&stage->ramp);
    tl_image_release(&stage->bumps);
    test_shape_release(&stage->shape);
    tl_environment_release(&stage->white);
    free(stage);
}

/* The intersection of a pixel's ray with z = 0, and the direction back. */
static vec3s pixel_point(const struct stage *stage, int x, int y, vec3s *view)
{
    const struct tl_camera *camera = &stage->frame.camera;
    vec3s forward = glms_vec3_normalize(glms_vec3_sub(camera->target, camera->eye));
    vec3s right = glms_vec3_normalize(glms_vec3_cross(forward, camera->up)),
          up = glms_vec3_cross(right, forward);
    float half = tanf(0.5f * camera->fov_y);
    vec3s ray = glms_vec3_add(forward, glms_vec3_scale(right, half * (2 * ((float)x + 0.5f) / SIZE - 1)));
    ray = glms_vec3_add(ray, glms_vec3_scale(up, half * (1 - 2 * ((float)y + 0.5f) / SIZE)));
    *view = glms_vec3_normalize(glms_vec3_negate(ray));
    return glms_vec3_add(camera->eye, glms_vec3_scale(ray, -camera->eye.z / ray.z));
}

static float expected_u(const struct tl_height_field *field, const struct tl_detail_params *detail, vec2s uv,
                        vec3s view)
{
    if (detail->mode == TL_DETAIL_RELIEF)
        return tl_field_relief(field, uv, view, detail->steps, detail->refine).uv.x;
    return detail->mode < TL_DETAIL_PARALLAX
               ? uv.x
               : tl_field_parallax(field, uv, view, detail->mode == TL_DETAIL_PARALLAX_LIMITED).x;
}

/* The G-buffer keeps colours as halves: 0.0005 of 1. Bilinear weights of 8 bits are as coarse. */
static void check_shift(struct test_device *device, struct stage *stage, const struct tl_height_field *field)
{
    bool behind = field->turned_over;
    stage->frame.camera.eye.z = (behind ? -1.3f : 1.3f) * stage->metres;
    for (int mode = TL_DETAIL_NORMAL; mode <= TL_DETAIL_RELIEF; mode++) {
        stage->settings.detail.mode = mode;
        tl_image image = test_draw(device->renderer, &stage->frame, &stage->settings);
        double worst = 0, mean = 0;
        for (int i = 0; i < SIZE * SIZE; i++) {
            vec3s view, at = pixel_point(stage, i % SIZE, i / SIZE, &view);
            view.z *= behind ? -1 : 1;
            const vec2s uv = {{at.x / stage->metres + 0.5f, 0.5f - at.y / stage->metres}};
            float u = expected_u(field, &stage->settings.detail, uv, view);
            const float *pixel = test_pixel(&image, i % SIZE, i / SIZE);
            double off = fabs((double)(pixel[0] / pixel[2] - u));
            worst = fmax(worst, off);
            mean += off / (SIZE * SIZE);
        }
        printf("%s, mode %d: u off by %.5f, at worst %.5f\n", behind ? "back" : "front", mode, mean, worst);
        assert_true(mean < 1e-3);
        assert_true(worst < 4e-3); /* a quarter of a texel of the height map */
        tl_image_release(&image);
    }
}

static void check_shifts(struct test_device *device, float metres)
{
    struct stage *stage = stage_new_of(metres);
    tl_image heights = tl_image_create(64, 64, 1, TL_IMAGE_F32);
    for (int i = 0; i < 64 * 64; i++)
        tl_image_floats(&heights)[i] = DEPTH * metres * ((float)tl_image_bytes(&stage->bumps)[i] / 255 - 1);
    struct tl_height_field field = tl_height_field_make(&heights, metres, metres, false, false), back;
    tl_image cones = tl_bake_cones(&field, 1);
    field.cones = &cones;
    back = tl_height_field_back(&field);
    stage->shape.material.double_sided = true;
    test_shape_refresh(&stage->shape);
    check_shift(device, stage, &field);
    check_shift(device, stage, &back);
    tl_image_release(&cones);
    tl_image_release(&heights);
    stage_free(stage);
}

/* What is similar looks alike, however many metres a unit of UV has. */
static void test_shift(void **state)
{
    check_shifts(*state, 1);
    check_shifts(*state, 0.25f);
}

/* A ridge across a mirror, seen from +x at 45 degrees: before its near side, as far as it is high, the mirror
 * shows the ridge, which horizons hold to be black, and behind it the sky of 1. */
static void test_gloss_over_horizons(void **state)
{
    struct test_device *device = *state;
    struct stage *stage = stage_new();
    tl_image normals = tl_image_create(64, 64, 3, TL_IMAGE_U8);
    memset(normals.texels, 128, (size_t)3 * 64 * 64);
    normals.linear = true;
    for (int i = 0; i < 64 * 64; i++) {
        tl_image_bytes(&normals)[3 * i + 2] = 255;
        tl_image_bytes(&stage->bumps)[i] = i % 64 >= 30 && i % 64 < 34 ? 255 : 0;
    }
    tl_material *material = &stage->shape.material;
    material->normal_map.image = &normals;
    material->height_m = 0.15f;
    material->diffuse = (vec3s){{0, 0, 0}};
    material->specular = (vec3s){{1, 1, 1}};
    material->glossiness = 0.99f;
    test_shape_refresh(&stage->shape);
    stage->settings.detail.shadow = TL_DETAIL_SHADOW_HORIZON;
    tl_image image = test_draw(device->renderer, &stage->frame, &stage->settings);
    double sums[2] = {0};
    int counts[2] = {0};
    for (int i = 0; i < SIZE * SIZE; i++) {
        vec3s view, at = pixel_point(stage, i % SIZE, i / SIZE, &view);
        if (fabsf(at.x) < 0.05f || fabsf(at.x) > 0.1f)
            continue;
        sums[at.x > 0] += (double)test_pixel(&image, i % SIZE, i / SIZE)[0];
        counts[at.x > 0]++;
    }
    printf("behind the ridge %.3f, before it %.3f\n", sums[0] / counts[0], sums[1] / counts[1]);
    assert_true(counts[0] > 50 && counts[1] > 50);
    assert_near(sums[0] / counts[0], 1, 0.05);
    assert_near(sums[1] / counts[1], 0, 0.05);
    tl_image_release(&image);
    tl_image_release(&normals);
    stage_free(stage);
}

static void test_reference(void **state)
{
    struct test_device *device = *state;
    struct stage *stage = stage_new();
    tl_error error = {0};
    stage->settings.reference.strata = 256;
    for (int mode = TL_DETAIL_PARALLAX; mode <= TL_DETAIL_RELIEF; mode++) {
        stage->settings.detail.mode = mode;
        tl_image image = test_draw(device->renderer, &stage->frame, &stage->settings), truth;
        struct tl_reference_report report;
        struct tl_comparison comparison;
        const struct tl_reference_request request =
            tl_frame_reference_request(&stage->frame, &stage->settings, NULL);
        assert_ok(tl_reference_draw(&request, &truth, &report, &error), error);
        assert_ok(tl_image_compare(&image, &truth, 0, 0, &comparison, &error), error);
        printf("mode %d: %.2f %% relative RMSE against the reference, standard error %.2f %%\n", mode,
               100 * comparison.rel_rmse, 100 * report.standard_error);
        assert_true(comparison.rel_rmse < 0.01 + 3 * report.standard_error);
        tl_image_release(&image);
        tl_image_release(&truth);
    }
    stage_free(stage);
}

static bool runs_detail(const tl_renderer *renderer)
{
    const tl_plan *plan = tl_renderer_last_plan(renderer);
    for (int i = 0; i < plan->count; i++)
        if (strcmp(plan->rows[i].name, "detail") == 0)
            return plan->rows[i].action == TL_JOB_RUN;
    return false;
}

static size_t bytes_with(struct test_device *device, struct stage *stage,
                         const struct tl_detail_params *detail)
{
    stage->settings.detail = *detail;
    tl_image image = test_draw(device->renderer, &stage->frame, &stage->settings);
    tl_image_release(&image);
    return tl_renderer_memory(device->renderer).surfaces;
}

/* Jobs and memory come with an option and go with it. */
static void test_unused(void **state)
{
    struct test_device *device = *state;
    struct stage *stage = stage_new();
    tl_image normals = tl_image_create(64, 64, 3, TL_IMAGE_U8);
    memset(normals.texels, 128, (size_t)3 * 64 * 64);
    normals.linear = true;
    stage->shape.material.normal_map.image = &normals; /* else the height map bends the light by itself */
    test_shape_refresh(&stage->shape);
    struct tl_detail_params none = stage->settings.detail, relief = none, horizon = none, lean = none;
    relief.mode = TL_DETAIL_RELIEF;
    horizon.shadow = TL_DETAIL_SHADOW_HORIZON;
    lean.minify = TL_DETAIL_MINIFY_LEAN;
    size_t bare = bytes_with(device, stage, &none);
    assert_false(runs_detail(device->renderer));
    const struct tl_detail_params *choices[] = {&relief, &horizon, &lean};
    const size_t texels = (4 * 64 * 64 - 1) / 3;       /* with all smaller levels */
    const size_t texel_bytes[] = {4 + 2, 16 + 16, 24}; /* heights and cones; the cloth's two sides; moments */
    for (size_t i = 0; i < TL_COUNT(choices); i++) {
        size_t bytes = bytes_with(device, stage, choices[i]);
        assert_true(runs_detail(device->renderer));
        assert_int_equal(bytes - bare, texel_bytes[i] * texels);
        bytes_with(device, stage, choices[i]);
        assert_false(runs_detail(device->renderer)); /* nothing has changed */
        assert_int_equal(bytes_with(device, stage, &none), bare);
        assert_false(runs_detail(device->renderer));
    }
    tl_image_release(&normals);
    stage_free(stage);
}

/* Extremes of detail, each of which must give finite, bounded images: in light of 1 no more than 1. A program
 * of GL takes a second to compile: each mode has one kind of shadow and of minification, relief two. */
static void test_extremes(void **state)
{
    struct test_device *device = *state;
    struct stage *stage = stage_new();
    tl_image one = tl_image_create(1, 1, 1, TL_IMAGE_U8);
    const float scales[] = {0, 1, 100};
    const int steps[] = {1, 256};
    const int modes[] = {TL_DETAIL_NORMAL, TL_DETAIL_PARALLAX, TL_DETAIL_RELIEF, TL_DETAIL_EYE_SPACE};
    for (int m = 0; m < 4; m++)
        for (int c = 0; c < 12; c++) {
            const int kind = modes[m] == TL_DETAIL_RELIEF && c % 2 ? 1 : m % 3;
            stage->settings.detail.mode = modes[m];
            stage->settings.detail.shadow = kind;
            stage->settings.detail.minify = kind;
            stage->settings.detail.height_scale = scales[c % 3];
            stage->settings.detail.steps = steps[c % 2];
            stage->shape.material.glossiness = c % 2 ? 1.0f : 0.0f;
            stage->shape.material.height_map.image = c % 5 == 4 ? &one : &stage->bumps;
            stage->shape.material.height_map.clamp_u = c % 4 == 3;
            stage->frame.camera.eye = c % 4 == 0   ? (vec3s){{0, 0.2f, -1}}
                                      : c % 4 == 1 ? (vec3s){{2, 0.1f, 0.002f}}
                                                   : (vec3s){{1.2f, 0.5f, 1.3f}};
            for (size_t v = 0; v < stage->shape.mesh.vertex_count; v++) {
                stage->shape.mesh.uvs[v].x *= c % 6 == 5 ? -1.0f : 1.0f;
                stage->shape.mesh.tangents[v] =
                    glms_vec4_scale(stage->shape.mesh.tangents[v], c == 11 ? 0.0f : 1.0f);
            }
            test_shape_refresh(&stage->shape);
            tl_image image = test_draw(device->renderer, &stage->frame, &stage->settings);
            for (int i = 0; i < 4 * SIZE * SIZE; i++)
                assert_true(tl_image_floats(&image)[i] >= 0 && tl_image_floats(&image)[i] <= 1.01f);
            tl_image_release(&image);
        }
    tl_image_release(&one);
    stage_free(stage);
}

#define STRETCH 1.6f

/* A square of 1 x 1 m whose UV unit is stretched to 1.6 m along u, with one normal on all of it. */
static void stretched_open(struct test_scene *scene, const tl_image *normal, bool lamplit)
{
    struct test_shape square =
        test_square((vec3s){{0, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 0, 1}}, 0.5f, 4);
    for (size_t i = 0; i < square.mesh.vertex_count; i++)
        square.mesh.positions[i].x *= STRETCH;
    square.mesh.parts[0].uv_metres = 1;
    square.material.diffuse = (vec3s){{0.8f, 0.8f, 0.8f}};
    square.material.specular = (vec3s){{0, 0, 0}};
    square.material.normal_map.image = normal;
    test_scene_open_lamplit(scene, square, SIZE, SIZE);
    if (!lamplit) {
        uint64_t revision = scene->frame.environment_revision;
        tl_environment_release(&scene->environment);
        scene->environment = test_environment(64, 32, test_daylight);
        scene->frame.environment_revision = revision + 1;
        scene->frame.lamp_count = 0;
    }
    test_scene_refresh(scene);
}

/* One normal in floats, encoded as in a picture, or as maps that keep moments read it. */
static tl_image normal_picture(float slope_x, float slope_y, bool encoded)
{
    vec3s n = glms_vec3_normalize((vec3s){{-slope_x, -slope_y, 1}});
    tl_image image = tl_image_create(4, 4, 3, TL_IMAGE_F32);
    image.linear = true;
    for (int i = 0; i < 3 * 16; i++)
        tl_image_floats(&image)[i] = encoded ? 0.5f + 0.5f * n.raw[i % 3] : n.raw[i % 3];
    return image;
}

/* Heights h(u, v) on the stretched square are a plane that rises by h_u / 1.6 a metre along x: Blinn's form
 * of the slopes in the map is the plain normal map of that plane. For both shaders that draw it (samples,
 * lamps) and the reference's branch, front and back. Only roundings of halves differ: 0.1 % of the peak. */
static void test_blinn(void **state)
{
    struct test_device *device = *state;
    const float slope_x = 0.5f, slope_y = -0.3f;
    for (int i = 0; i < 8; i++) {
        const int mode = i < 4 ? TL_DETAIL_BLINN : TL_DETAIL_EYE_SPACE;
        tl_image bumped = normal_picture(slope_x, slope_y, i < 4),
                 plain = normal_picture(slope_x / STRETCH, slope_y, true);
        bool lamplit = i & 1, behind = i & 2;
        struct test_scene scene, expected;
        stretched_open(&scene, &bumped, lamplit);
        stretched_open(&expected, &plain, lamplit);
        if (behind) {
            scene.frame.camera.eye.z = expected.frame.camera.eye.z *= -1;
            scene.lamps[0].direction.z = expected.lamps[0].direction.z *= -1;
        }
        scene.settings.detail.mode = mode;
        scene.settings.detail.minify = i < 4 ? TL_DETAIL_MINIFY_NONE : TL_DETAIL_MINIFY_LEAN;
        tl_image image = test_scene_draw(&expected, device->renderer);
        struct test_difference off = test_scene_error(&scene, device->renderer, &image);
        scene.settings.detail.mode = TL_DETAIL_NORMAL;
        struct test_difference flat = test_scene_error(&scene, device->renderer, &image);
        scene.settings.detail.mode = mode;
        tl_image traced = test_scene_evaluate(&scene);
        struct test_difference reference =
            lamplit ? test_compare(&traced, &image) : (struct test_difference){0};
        print_message("Blinn's normal on a stretched square, %s, %s, %s: off by %.3f %% of the peak, the "
                      "reference %.3f %%, the "
                      "square patch %.1f %%\n",
                      i < 4 ? "of samples" : "of vertices", lamplit ? "lamp" : "environment",
                      behind ? "behind" : "front", 100 * off.largest, 100 * reference.largest,
                      100 * flat.largest);
        assert_true(off.pixels > 200);
        assert_true(off.largest < 0.001 && reference.largest < 0.001);
        assert_true(flat.largest > 0.005); /* one side of the environment is nearly even */
        tl_image_release(&traced);
        tl_image_release(&image);
        test_scene_close(&scene);
        test_scene_close(&expected);
        tl_image_release(&bumped);
        tl_image_release(&plain);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shift),     cmocka_unit_test(test_gloss_over_horizons),
        cmocka_unit_test(test_reference), cmocka_unit_test(test_blinn),
        cmocka_unit_test(test_unused),    cmocka_unit_test(test_extremes)};
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
