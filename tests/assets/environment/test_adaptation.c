/* Brightness and white of environments: closed forms, both layouts, and the studio as the place that others
 * are shown like. */
#include "assets/environment/adaptation.h"
#include "assets/environment/studio.h"
#include "config/base/memory.h"
#include "tests/testing.h"

#include <math.h>

static tl_environment latlong_of(int width, int height)
{
    tl_environment environment = tl_environment_constant(0, 0, 0);
    tl_image_release(&environment.image);
    environment.image = tl_image_create(width, height, 3, TL_IMAGE_F32);
    return environment;
}

static double luminance(vec3s rgb)
{
    return 0.2126 * (double)rgb.r + 0.7152 * (double)rgb.g + 0.0722 * (double)rgb.b;
}

/* Cards under light L from everywhere receive pi L. */
static void test_uniform(void **state)
{
    (void)state;
    tl_environment grey = tl_environment_constant(4, 4, 4);
    vec3s shown = tl_adaptation_to(&grey);
    for (int c = 0; c < 3; c++)
        assert_near((double)shown.raw[c], (double)TL_ADAPTED_LUMINANCE / 4, 1e-3);
    tl_environment_release(&grey);
    tl_environment dark = tl_environment_constant(0, 0, 0);
    shown = tl_adaptation_to(&dark);
    assert_true(shown.r == 1 && shown.g == 1 && shown.b == 1);
    tl_environment_release(&dark);
}

/* A quarter of the logarithm of a tint is left, and no brightness with it. */
static void test_tint(void **state)
{
    (void)state;
    const vec3s light = {{0.5f, 1, 2}};
    tl_environment blue = tl_environment_constant(light.r, light.g, light.b);
    vec3s shown = tl_adaptation_to(&blue), seen = glms_vec3_mul(shown, light);
    assert_near(luminance(seen), (double)TL_ADAPTED_LUMINANCE, 1e-3);
    assert_near((double)(seen.b / seen.r), pow(4, 1 - (double)TL_ADAPTED_WHITE), 1e-3);
    tl_environment_release(&blue);
}

/* A small lamp of solid angle S and radiance L at an angle to the vertical: L S sine / pi^2, whatever its
 * azimuth; a lamp at the zenith counts for nothing. */
static void test_lamp(void **state)
{
    (void)state;
    const int width = 720, height = 360, rows[] = {60, 180, 300}, columns[] = {10, 350, 700};
    for (int i = 0; i < 3; i++) {
        tl_environment lamp = latlong_of(width, height);
        float *texel = tl_image_floats(&lamp.image) + 3 * (size_t)(rows[i] * width + columns[i]);
        texel[0] = texel[1] = texel[2] = 1e4f;
        double angle = M_PI * (rows[i] + 0.5) / height, solid = 2 * M_PI * M_PI * sin(angle) / width / height;
        double card = 1e4 * solid * sin(angle) / (M_PI * M_PI);
        vec3s shown = tl_adaptation_to(&lamp);
        assert_near((double)shown.g * card, (double)TL_ADAPTED_LUMINANCE, 1e-4);
        tl_environment_release(&lamp);
    }
    tl_environment zenith = latlong_of(width, height);
    tl_image_floats(&zenith.image)[0] = tl_image_floats(&zenith.image)[1] = 1;
    assert_true(tl_adaptation_to(&zenith).g == TL_ADAPTED_MAX || tl_adaptation_to(&zenith).g > 1000);
    tl_environment_release(&zenith);
}

/* A cube with one white face: those around the horizon send 1/4 of what all four do; those above and below
 * the rest of what light from everywhere does. */
static void test_cube(void **state)
{
    (void)state;
    const size_t side = 64;
    double sent[6], all = 0;
    for (size_t face = 0; face < 6; face++) {
        tl_environment cube = tl_environment_constant(0, 0, 0);
        tl_image_release(&cube.image);
        cube.layout = TL_ENV_CUBE;
        cube.image = tl_image_create((int)side, (int)(6 * side), 3, TL_IMAGE_F32);
        for (size_t i = 0; i < 3 * side * side; i++)
            tl_image_floats(&cube.image)[3 * face * side * side + i] = 1;
        sent[face] = (double)TL_ADAPTED_LUMINANCE / (double)tl_adaptation_to(&cube).g;
        all += sent[face];
        tl_environment_release(&cube);
    }
    assert_near(all, 1, 1e-3);
    for (int face = 0; face < 6; face++)
        assert_near(sent[face], face == 2 || face == 3 ? sent[2] : sent[0], 1e-6);
    assert_true(sent[0] > 1.5 * sent[2]);
}

static void test_studio(void **state)
{
    (void)state;
    tl_environment studio = tl_environment_studio();
    vec3s shown = tl_adaptation_to(&studio);
    print_message("the studio: %.4f %.4f %.4f\n", (double)shown.r, (double)shown.g, (double)shown.b);
    assert_near(luminance(shown), 1, 0.03);
    assert_true(studio.shown.r == 0); /* as it was made */
    tl_environment_release(&studio);
}

/* A lat-long and a cube, white above and of a colour below the horizon: that is the ground's reflectance,
 * within what a ground may have. The same upside down is as bright a ground as may be. */
static void test_ground(void **state)
{
    (void)state;
    const float colours[][3] = {{0.2f, 0.3f, 0.1f}, {0.01f, 0.01f, 0.01f}, {3, 3, 3}, {0, 0, 0}};
    const float expected[][3] = {{0.2f, 0.3f, 0.1f},
                                 {TL_GROUND_DARKEST, TL_GROUND_DARKEST, TL_GROUND_DARKEST},
                                 {TL_GROUND_BRIGHTEST, TL_GROUND_BRIGHTEST, TL_GROUND_BRIGHTEST},
                                 {TL_GROUND_DARKEST, TL_GROUND_DARKEST, TL_GROUND_DARKEST}};
    for (size_t i = 0; i < TL_COUNT(colours); i++)
        for (int layout = 0; layout < 2; layout++) {
            const int side = 32, width = layout ? side : 64, rows = layout ? 6 * side : 32;
            tl_environment place = latlong_of(width, rows);
            place.layout = layout ? TL_ENV_CUBE : TL_ENV_LATLONG;
            for (int y = 0; y < rows; y++) {
                int face = y / side;
                bool is_below = layout ? face == 3 || (face != 2 && y % side >= side / 2) : y >= rows / 2;
                for (int x = 0; x < width; x++)
                    for (int c = 0; c < 3; c++)
                        tl_image_floats(&place.image)[3 * (y * width + x) + c] = is_below ? colours[i][c] : 1;
            }
            vec3s ground = tl_adaptation_ground(&place);
            for (int c = 0; c < 3; c++)
                assert_near((double)ground.raw[c], (double)expected[i][c], 1e-3);
            tl_environment_release(&place);
        }
    tl_environment dark = tl_environment_constant(0, 0, 0);
    assert_true(tl_adaptation_ground(&dark).g == 0);
    tl_environment_release(&dark);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_uniform), cmocka_unit_test(test_tint),   cmocka_unit_test(test_lamp),
        cmocka_unit_test(test_cube),    cmocka_unit_test(test_studio), cmocka_unit_test(test_ground),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
