/* The studio's image against closed forms of its lights: solid angles, Lambert's polygon formula, directions.
 */
#include "tests/testing.h"

#include "assets/environment/environment.h"
#include "assets/environment/studio.h"

#include "config/base/memory.h"

static tl_environment studio;

static int make_studio(void **state)
{
    (void)state;
    studio = tl_environment_studio();
    return 0;
}

static int drop_studio(void **state)
{
    (void)state;
    tl_environment_release(&studio);
    return 0;
}

static vec3s texel_direction(const tl_image *image, int x, int y)
{
    double azimuth = 2 * M_PI * ((x + 0.5) / image->width - 0.5), polar = M_PI * (y + 0.5) / image->height;
    return (vec3s){
        {(float)(sin(azimuth) * sin(polar)), (float)cos(polar), (float)(-cos(azimuth) * sin(polar))}};
}

static double texel_solid_angle(const tl_image *image, int y)
{
    return 2 * M_PI / image->width * (cos(M_PI * y / image->height) - cos(M_PI * (y + 1) / image->height));
}

static const float *texel(const tl_image *image, int x, int y)
{
    return tl_image_floats(image) + 3 * ((size_t)y * (size_t)image->width + (size_t)x);
}

/* The contribution of one light to the image, without the room: integral over the light's rectangle, extended
 * by its edge and a texel, of radiance, or of radiance x cosine to the light's axis. */
static double integrate_light(const struct tl_studio_light *light, int channel, bool cosine)
{
    struct tl_studio_axes axes = tl_studio_light_axes(light);
    float margin = light->edge + 0.01f;
    double sum = 0;
    for (int y = 0; y < studio.image.height; y++) {
        for (int x = 0; x < studio.image.width; x++) {
            vec3s direction = texel_direction(&studio.image, x, y);
            float depth = glms_vec3_dot(direction, axes.out);
            if (depth <= 0 ||
                fabsf(glms_vec3_dot(direction, axes.right)) > (light->half_width + margin) * depth ||
                fabsf(glms_vec3_dot(direction, axes.up)) > (light->half_height + margin) * depth)
                continue;
            double shown = (double)(texel(&studio.image, x, y)[channel] - tl_studio_room(direction));
            sum += shown * (cosine ? (double)depth : 1) * texel_solid_angle(&studio.image, y);
        }
    }
    return sum;
}

/* Radiance x the solid angle of a rectangle with tangents a, b: 4 asin(ab / sqrt((1+a^2)(1+b^2))). The soft
 * edges are odd about the rectangle's edge, so they change the integral to second order only: edge^2 / (1 +
 * a^2) is at most 1 %, the lamp's texels by their sub-samples about as much. */
static void test_solid_angles(void **state)
{
    (void)state;
    for (size_t i = 0; i < tl_studio_light_count; i++) {
        const struct tl_studio_light *light = &tl_studio_lights[i];
        double a = (double)light->half_width, b = (double)light->half_height;
        double solid_angle = 4 * asin(a * b / sqrt((1 + a * a) * (1 + b * b)));
        for (int channel = 0; channel < 3; channel++) {
            double expected = (double)light->radiance.raw[channel] * solid_angle;
            assert_near(integrate_light(light, channel, false), expected, 0.01 * expected);
        }
    }
}

/* Irradiance of a surface that faces the light, from the configuration factor of a centred parallel rectangle
 * (Howell's catalogue, C-11, four quarters): 2 L [a/A atan(b/A) + b/B atan(a/B)], A = sqrt(1 + a^2). */
static void test_irradiance(void **state)
{
    (void)state;
    for (size_t i = 0; i < tl_studio_light_count; i++) {
        const struct tl_studio_light *light = &tl_studio_lights[i];
        double a = (double)light->half_width, b = (double)light->half_height;
        double root_a = sqrt(1 + a * a), root_b = sqrt(1 + b * b);
        double expected =
            2 * (double)light->radiance.y * (a / root_a * atan(b / root_a) + b / root_b * atan(a / root_b));
        assert_near(integrate_light(light, 1, true), expected, 0.01 * expected);
    }
}

/* The radiance of a white matt surface: irradiance / pi over the whole image. */
static double white_surface(vec3s normal)
{
    double sum = 0;
    for (int y = 0; y < studio.image.height; y++) {
        for (int x = 0; x < studio.image.width; x++) {
            float cosine = glms_vec3_dot(normal, texel_direction(&studio.image, x, y));
            sum += fmax((double)cosine, 0) * (double)texel(&studio.image, x, y)[1] *
                   texel_solid_angle(&studio.image, y);
        }
    }
    return sum / M_PI;
}

/* The exposure that the scene is designed for: a white surface facing the key light has 0.8 to 1.2, the side
 * facing away from all lamps is at least two stops darker, but not black. */
static void test_exposure(void **state)
{
    (void)state;
    double key = white_surface(tl_studio_light_axes(&tl_studio_lights[0]).out);
    double front = white_surface((vec3s){{0, 0, 1}}), below = white_surface((vec3s){{0, -1, 0}});
    printf("white surface: towards the key %.3f, front %.3f, up %.3f, right %.3f, back %.3f, down %.3f\n",
           key, front, white_surface((vec3s){{0, 1, 0}}), white_surface((vec3s){{1, 0, 0}}),
           white_surface((vec3s){{0, 0, -1}}), below);
    assert_true(key > 0.8 && key < 1.2);
    assert_true(front > 0.6 && front < 1.1);
    assert_true(below < key / 4 && below > 0.05);
}

/* The lamp is found in the image in the direction that the data states, on the camera's side; a texel is 0.7
 * degrees, so the brightest one is at most a degree off. It spans few texels, and its peak is the picture's.
 */
static void test_lamp(void **state)
{
    (void)state;
    const struct tl_studio_light *lamp = &tl_studio_lights[tl_studio_light_count - 1];
    int lit = 0;
    double cosine = 0;
    for (int y = 0; y < studio.image.height; y++) {
        for (int x = 0; x < studio.image.width; x++) {
            float red = texel(&studio.image, x, y)[0];
            if (red > 0.5f * lamp->radiance.x)
                lit++;
            if (red == studio.peak)
                cosine = (double)glms_vec3_dot(texel_direction(&studio.image, x, y),
                                               tl_studio_light_axes(lamp).out);
        }
    }
    assert_true(lit >= 4 && lit <= 16);
    assert_true(cosine > cos(1.0 * M_PI / 180));
    assert_near(studio.peak, lamp->radiance.x, 1);
    assert_true(tl_studio_light_axes(lamp).out.z > 0.5f && tl_studio_light_axes(lamp).out.x > 0.2f);
    assert_true(tl_studio_light_axes(&tl_studio_lights[0]).out.z > 0.5f);
}

/* Behind the figure, as a camera of 50 degrees sees it, there is only the even wall: neighbouring texels
 * differ by less than 2 %, and it is brightest near the middle. */
static void test_backdrop(void **state)
{
    (void)state;
    int x0 = studio.image.width / 2 - 43, x1 = studio.image.width / 2 + 43;
    int y0 = studio.image.height / 2 - 36, y1 = studio.image.height / 2 + 36;
    for (int y = y0; y < y1; y++) {
        for (int x = x0; x < x1; x++) {
            double here = (double)texel(&studio.image, x, y)[1];
            assert_near(texel(&studio.image, x + 1, y)[1] / here, 1, 0.02);
            assert_near(texel(&studio.image, x, y + 1)[1] / here, 1, 0.02);
        }
    }
    const float *middle = texel(&studio.image, studio.image.width / 2, studio.image.height / 2);
    assert_true(middle[1] > texel(&studio.image, x0, y0)[1] && middle[1] > texel(&studio.image, x1, y1)[1]);
}

/* The backdrop is the room alone: what the lamps add to the image is not behind the figure, from any side. */
static void test_backdrop_without_lamps(void **state)
{
    (void)state;
    double brightest = 0;
    assert_int_equal(studio.backdrop.width, studio.image.width);
    for (int y = 0; y < studio.image.height; y++)
        for (int x = 0; x < studio.image.width; x++) {
            double room = (double)tl_studio_backdrop(texel_direction(&studio.image, x, y));
            assert_near(texel(&studio.backdrop, x, y)[1], room, 0.01 * room);
            brightest = fmax(brightest, (double)texel(&studio.backdrop, x, y)[1]);
        }
    assert_true(brightest < 0.5);
    /* The same on both sides of the view for which the lights stand, and brightest there. */
    float turn = glm_rad(TL_STUDIO_VIEW_DEG);
    for (int side_deg = 20; side_deg <= 160; side_deg += 20) {
        float left = turn + glm_rad(180 - (float)side_deg), right = turn + glm_rad(180 + (float)side_deg);
        float at_left = tl_studio_backdrop((vec3s){{sinf(left), 0, cosf(left)}});
        assert_near(at_left, tl_studio_backdrop((vec3s){{sinf(right), 0, cosf(right)}}), 1e-5);
        assert_true(at_left < tl_studio_backdrop((vec3s){{-sinf(turn), 0, -cosf(turn)}}));
    }
}

static void test_constant(void **state)
{
    (void)state;
    tl_environment constant = tl_environment_constant(1, 0.5f, 2);
    for (int y = 0; y < constant.image.height; y++) {
        for (int x = 0; x < constant.image.width; x++) {
            const float *value = texel(&constant.image, x, y);
            assert_true(value[0] == 1 && value[1] == 0.5f && value[2] == 2);
        }
    }
    assert_true(constant.peak == 2);
    tl_environment_release(&constant);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_solid_angles), cmocka_unit_test(test_irradiance),
        cmocka_unit_test(test_exposure),     cmocka_unit_test(test_lamp),
        cmocka_unit_test(test_backdrop),     cmocka_unit_test(test_backdrop_without_lamps),
        cmocka_unit_test(test_constant),
    };
    return cmocka_run_group_tests(tests, make_studio, drop_studio);
}
