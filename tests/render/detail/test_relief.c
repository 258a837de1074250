/* Parallax and relief in height fields, against closed forms and a fine march. */
#include "tests/render/height_oracle.h"

#include "assets/weave/weave.h"
#include "config/base/memory.h"
#include "render/detail/cones.h"
#include "render/detail/field.h"
#include "render/reference/random.h"

#include "tests/testing.h"

static const float pi = (float)M_PI;

static vec3s direction(float tilt_deg, float turn)
{
    float z = cosf(glm_rad(tilt_deg)), flat = sinf(glm_rad(tilt_deg));
    return (vec3s){{flat * cosf(turn), flat * sinf(turn), z}};
}

/* A flat step of height h: all of it shifts by h V_xy / V_z, and by h V_xy. */
static void test_parallax(void **state)
{
    (void)state;
    tl_image heights = tl_image_create(4, 4, 1, TL_IMAGE_F32);
    for (int i = 0; i < 16; i++)
        tl_image_floats(&heights)[i] = -2e-3f;
    struct tl_height_field field = tl_height_field_make(&heights, 0.1f, 0.2f, false, false);
    tl_image cones = tl_bake_cones(&field, 1);
    field.cones = &cones;
    const vec2s uv = {{0.25f, 0.5f}};
    for (int degrees = 0; degrees < 87; degrees += 6) {
        float tilt = (float)degrees;
        vec3s view = direction(tilt, 1);
        vec2s full = tl_field_parallax(&field, uv, view, false),
              limited = tl_field_parallax(&field, uv, view, true);
        struct tl_relief relief = tl_field_relief(&field, uv, view, 16, 4);
        float x = -2e-3f * view.x / view.z / 0.1f, y = 2e-3f * view.y / view.z / 0.2f;
        assert_near(full.x - uv.x, x, 1e-6 + 1e-5 * (double)fabsf(x));
        assert_near(full.y - uv.y, y, 1e-6 + 1e-5 * (double)fabsf(y));
        assert_near(limited.x - uv.x, x * view.z, 1e-6);
        assert_near(relief.uv.x, full.x, 1e-6); /* a flat step is what parallax takes it for */
        assert_near(relief.uv.y, full.y, 1e-6);
    }
    /* Grazing and below: limited never more than the height, the others never more than twenty times it. */
    for (int halves = 174; halves <= 360; halves++) {
        float tilt = 0.5f * (float)halves;
        vec3s view = direction(tilt, 2);
        vec2s full = tl_field_parallax(&field, uv, view, false),
              limited = tl_field_parallax(&field, uv, view, true);
        struct tl_relief relief = tl_field_relief(&field, uv, view, 8, 4);
        assert_true(hypotf((limited.x - uv.x) * 0.1f, (limited.y - uv.y) * 0.2f) <= 2.01e-3f);
        assert_true(hypotf((full.x - uv.x) * 0.1f, (full.y - uv.y) * 0.2f) <= 40.1e-3f);
        assert_true(hypotf((relief.uv.x - uv.x) * 0.1f, (relief.uv.y - uv.y) * 0.2f) <= 40.1e-3f);
    }
    tl_image_release(&cones);
    tl_image_release(&heights);
}

/* Down a slope h = a x, the ray through x0 ends where a x = (x - x0) V_z / V_x: parallax takes h(x0), relief
 * solves. */
static void test_slope(void **state)
{
    (void)state;
    enum { SIDE = 256 };
    tl_image heights = tl_image_create(SIDE, 1, 1, TL_IMAGE_F32);
    for (int i = 0; i < SIDE; i++)
        tl_image_floats(&heights)[i] = 0.2f * 0.1f * (((float)i + 0.5f) / SIDE - 0.5f);
    struct tl_height_field field = tl_height_field_make(&heights, 0.1f, 0.1f, true, true);
    tl_image cones = tl_bake_cones(&field, 1);
    field.cones = &cones;
    for (int degrees = 0; degrees <= 60; degrees += 10) {
        float tilt = (float)degrees;
        vec3s view = direction(tilt, 0);
        float x0 = 0.02f, slant = view.x / view.z, x = x0 / (1 - 0.2f * slant);
        struct tl_relief relief = tl_field_relief(&field, (vec2s){{x0 / 0.1f + 0.5f, 0.5f}}, view, 32, 6);
        vec2s shifted = tl_field_parallax(&field, (vec2s){{x0 / 0.1f + 0.5f, 0.5f}}, view, false);
        printf("slope 0.2, view at %2.0f degrees: hit at %.3f mm, relief %.3f, parallax %.3f\n", (double)tilt,
               1e3 * (double)x, 100 * (double)(relief.uv.x - 0.5f), 100 * (double)(shifted.x - 0.5f));
        assert_near((relief.uv.x - 0.5f) * 0.1f, x, 2e-7);
        assert_near(relief.height_m, 0.2f * x, 2e-7);
        assert_near((shifted.x - 0.5f) * 0.1f, x0 + 0.2f * x0 * slant, 2e-7);
    }
    tl_image_release(&cones);
    tl_image_release(&heights);
}

static tl_weave weave_of(int pattern)
{
    const struct tl_weave_params params = {.pattern = pattern,
                                           .warp_pitch_mm = 0.143f,
                                           .weft_pitch_mm = 0.25f,
                                           .crimp_mm = 0.07f,
                                           .texels_per_yarn = 32};
    tl_weave weave;
    assert_true(tl_weave_create(&params, &weave));
    return weave;
}

/* The first meeting by steps of a fiftieth texel along the surface (or of the depth, seen from above). In
 * texels. */
static void fine_march(const struct tl_height_field *field, vec2s uv, vec3s view, double at[2])
{
    double slant = 1 / (double)view.z, depth = (double)(field->high_m - field->low_m),
           high = (double)field->high_m;
    double along_u = slant * (double)view.x * (double)field->repeats_per_m[0];
    double along_v = slant * (double)view.y * (double)field->repeats_per_m[3];
    double texels = depth * hypot(along_u * field->heights->width, along_v * field->heights->height);
    int steps = 64 + (int)(50 * texels);
    for (int i = 0; i <= steps; i++) {
        double z = high - depth * i / steps, u = (double)uv.x + z * along_u, v = (double)uv.y + z * along_v;
        at[0] = u * field->heights->width;
        at[1] = v * field->heights->height;
        if (height_at(field, u, v) >= z)
            break;
    }
}

struct spread {
    double within_half, mean, worst;
};

static struct spread relief_errors(const struct tl_height_field *field, int steps, int refine, float tilt)
{
    enum { RAYS = 4000 };
    struct tl_random random = tl_random_begin(6, 0);
    struct spread spread = {0};
    for (int i = 0; i < RAYS; i++) {
        vec2s uv = {{(float)tl_random_unit(&random), (float)tl_random_unit(&random)}};
        vec3s view = direction(tilt, 2 * pi * (float)tl_random_unit(&random));
        double truth[2] = {0, 0};
        fine_march(field, uv, view, truth);
        vec2s found = tl_field_relief(field, uv, view, steps, refine).uv;
        double off = hypot((double)found.x * field->heights->width - truth[0],
                           (double)found.y * field->heights->height - truth[1]);
        spread.within_half += off <= 0.5 ? 1.0 / RAYS : 0;
        spread.mean += off / RAYS;
        spread.worst = fmax(spread.worst, off);
    }
    return spread;
}

/* 64 steps find every hit, and so do more. With fewer steps the last ones must be long, and a grazing ray may
 * step over a crest: with 16 steps less than one ray in a hundred (measured). */
static void check_steps(const struct tl_height_field *field, const char *name, float tilt)
{
    for (int steps = 1; steps <= 256; steps *= 4) {
        struct spread spread = relief_errors(field, steps, 6, tilt);
        printf("%s, view at %2.0f degrees, %3d steps: %.2f %% within half a texel, mean %.3f, worst %.2f "
               "texels\n",
               name, (double)tilt, steps, 100 * spread.within_half, spread.mean, spread.worst);
        if (steps >= 64)
            assert_true(spread.worst <= 0.5);
        if (steps == 16)
            assert_true(spread.within_half > 0.99);
    }
}

/* For the front and the back of cloth. */
static void test_steps(void **state)
{
    (void)state;
    static const char *const names[] = {"plain", "plain, back", "satin", "satin, back"};
    for (int side = 0; side < 4; side++) {
        tl_weave weave = weave_of(side < 2 ? TL_WEAVE_PLAIN : TL_WEAVE_SATIN);
        struct tl_height_field field =
            tl_height_field_make(&weave.height, weave.size_m[0], weave.size_m[1], false, false);
        tl_image cones = tl_bake_cones(&field, 1);
        field.cones = &cones;
        if (side & 1)
            field = tl_height_field_back(&field);
        for (int view = 0; view < 3; view++)
            check_steps(&field, names[side], 30 + 22.5f * (float)view);
        tl_image_release(&cones);
        tl_weave_release(&weave);
    }
}

/* Light over a wall reaches what lies farther than H cot(height). */
static void test_shadow(void **state)
{
    (void)state;
    enum { SIDE = 512 };
    tl_image heights = tl_image_create(SIDE, 1, 1, TL_IMAGE_F32);
    for (int i = 0; i < SIDE; i++)
        tl_image_floats(&heights)[i] = i >= SIDE / 2 ? 0.01f : 0;
    struct tl_height_field field = tl_height_field_make(&heights, 0.1f, 0.1f, true, true);
    for (int degrees = 20; degrees <= 70; degrees += 10) {
        float tilt = (float)degrees;
        vec3s light = direction(tilt, 0);
        float reach = 0.01f * tanf(glm_rad(tilt)),
              step = reach / 64 + 0.1f / SIDE; /* of the march, and a texel */
        for (int half_mm = 2; half_mm < 90; half_mm++) {
            float distance = 0.0005f * (float)half_mm;
            float lit = tl_field_lit(&field, (vec2s){{0.5f - distance / 0.1f, 0.5f}}, light, 64);
            if (distance < reach - step)
                assert_near(lit, 0, 0);
            if (distance > reach + step)
                assert_near(lit, 1, 0);
        }
        const vec2s on_top = {{0.75f, 0.5f}};
        assert_near(tl_field_lit(&field, on_top, light, 64), 1, 0);
        assert_near(tl_field_lit(&field, on_top, direction(100, 0), 64), 0, 0);
    }
    tl_image_release(&heights);
}

static void test_silhouette(void **state)
{
    (void)state;
    tl_image heights = tl_image_create(1, 1, 1, TL_IMAGE_F32);
    struct tl_height_field clamped = tl_height_field_make(&heights, 1, 1, true, false);
    assert_true(tl_field_is_outside(&clamped, (vec2s){{1.001f, 0}}));
    assert_true(tl_field_is_outside(&clamped, (vec2s){{-0.001f, 0}}));
    assert_true(tl_field_is_outside(&clamped, (vec2s){{NAN, 0}}));
    assert_false(tl_field_is_outside(&clamped, (vec2s){{1, 7}}));
    tl_image_release(&heights);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_parallax), cmocka_unit_test(test_slope),
                                       cmocka_unit_test(test_steps), cmocka_unit_test(test_shadow),
                                       cmocka_unit_test(test_silhouette)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
