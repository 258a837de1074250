/* Parallax and relief in height fields, against closed forms and a fine march. */
#include "assets/weave.h"
#include "config/memory.h"
#include "render/detail/field.h"
#include "render/reference/random.h"

#include "testing.h"

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

/* The first meeting by steps of a fiftieth texel along the surface (or of the depth, seen from above). */
static vec2s fine_march(const struct tl_height_field *field, vec2s uv, vec3s view)
{
    float along_x = view.x / view.z, along_y = view.y / view.z, depth = field->high_m - field->low_m;
    float texels = hypotf(along_x * field->repeats_per_m[0] * (float)field->heights->width,
                          along_y * field->repeats_per_m[3] * (float)field->heights->height) *
                   depth;
    int steps = 64 + (int)(50 * texels);
    vec2s at = uv;
    for (int i = 0; i <= steps; i++) {
        float z = field->high_m - depth * (float)i / (float)steps;
        at = tl_field_moved(field, uv, z * along_x, z * along_y);
        if (tl_field_height(field, at) >= z)
            break;
    }
    return at;
}

static double texels_between(const struct tl_height_field *field, vec2s a, vec2s b)
{
    return hypot((double)((a.x - b.x) * (float)field->heights->width),
                 (double)((a.y - b.y) * (float)field->heights->height));
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
        vec2s truth = fine_march(field, uv, view);
        double off = texels_between(field, tl_field_relief(field, uv, view, steps, refine).uv, truth);
        spread.within_half += off <= 0.5 ? 1.0 / RAYS : 0;
        spread.mean += off / RAYS;
        spread.worst = fmax(spread.worst, off);
    }
    return spread;
}

/* Yarns are round: a step misses them only where it grazes a crest. */
static void test_steps(void **state)
{
    (void)state;
    for (int pattern = TL_WEAVE_PLAIN; pattern <= TL_WEAVE_SATIN; pattern += 2) {
        tl_weave weave = weave_of(pattern);
        struct tl_height_field field =
            tl_height_field_make(&weave.height, weave.size_m[0], weave.size_m[1], false, false);
        for (int view = 0; view < 3; view++)
            for (int steps = 1; steps <= 256; steps *= 4) {
                float tilt = 30 + 22.5f * (float)view;
                struct spread spread = relief_errors(&field, steps, 6, tilt);
                printf("%s, view at %2.0f degrees, %3d steps: %.2f %% within half a texel, mean %.3f, worst "
                       "%.2f texels\n",
                       pattern == TL_WEAVE_PLAIN ? "plain" : "satin", (double)tilt, steps,
                       100 * spread.within_half, spread.mean, spread.worst);
                if (steps == 64)
                    assert_true(spread.within_half > 0.995 && spread.mean < 0.1);
            }
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
