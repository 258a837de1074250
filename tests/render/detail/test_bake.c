/* Maps baked from heights, against analytic slopes, the cylinder of the lecture [Wimmer n.d.], walls, and
 * rays cast in the field. */
#include "assets/weave/weave.h"
#include "config/base/memory.h"
#include "render/detail/bake.h"
#include "render/detail/bump_statistics.h"
#include "render/detail/bumps.h"
#include "render/reference/random.h"

#include "tests/testing.h"

#include <string.h>

static const float pi = (float)M_PI;

static float random_unit(struct tl_random *random)
{
    return (float)tl_random_unit(random);
}

static tl_image heights_of(int width, int height, float (*at)(float u, float v))
{
    tl_image image = tl_image_create(width, height, 1, TL_IMAGE_F32);
    for (int row = 0; row < height; row++)
        for (int column = 0; column < width; column++)
            tl_image_floats(&image)[(size_t)row * (size_t)width + (size_t)column] =
                at(((float)column + 0.5f) / (float)width, ((float)row + 0.5f) / (float)height);
    return image;
}

static float horizon_texel(const struct tl_horizon_maps *maps, const struct tl_height_field *field, int x,
                           int y, int angle)
{
    int width = field->heights->width, height = field->heights->height;
    x = field->clamp_u ? (x < 0 ? 0 : x >= width ? width - 1 : x) : ((x % width) + width) % width;
    y = field->clamp_v ? (y < 0 ? 0 : y >= height ? height - 1 : y) : ((y % height) + height) % height;
    const tl_image *image = &maps->images[angle / 4];
    return (float)tl_image_bytes(image)[4 * ((size_t)y * (size_t)width + (size_t)x) + (size_t)(angle % 4)] /
           255;
}

/* The sine of one angle, interpolated between texels. */
static float horizon_at(const struct tl_horizon_maps *maps, const struct tl_height_field *field, vec2s uv,
                        int angle)
{
    float u = (uv.x - floorf(uv.x)) * (float)field->heights->width - 0.5f;
    float v = (uv.y - floorf(uv.y)) * (float)field->heights->height - 0.5f;
    int column = (int)floorf(u), row = (int)floorf(v);
    float sine = 0;
    for (int i = 0; i < 4; i++) {
        int x = column + (i & 1), y = row + (i >> 1);
        float share = (1 - fabsf((float)x - u)) * (1 - fabsf((float)y - v));
        sine += share * horizon_texel(maps, field, x, y, angle % maps->angle_count);
    }
    return sine;
}

/* The sine of the horizon towards (x, y), not both 0, interpolated between texels and angles as in
 * detail.glsl. */
static float horizon_sine(const struct tl_horizon_maps *maps, const struct tl_height_field *field, vec2s uv,
                          float x, float y)
{
    float count = (float)maps->angle_count, step = 2 * (float)M_PI / count,
          turn = atan2f(y, x) / step + count;
    int first = (int)turn;
    return detail_between(horizon_at(maps, field, uv, first), horizon_at(maps, field, uv, first + 1),
                          (turn - (float)first) * step, step);
}

static float sine_wave(float u, float v)
{
    return 1e-3f * sinf(2 * pi * u) + 0.5e-3f * sinf(2 * pi * 2 * v);
}

/* The central difference of sin x over steps d is cos x sin(d) / d, exactly. */
static void test_sine(void **state)
{
    (void)state;
    enum { SIDE = 64 };
    tl_image heights = heights_of(SIDE, SIDE, sine_wave);
    struct tl_height_field field = tl_height_field_make(&heights, 0.01f, 0.02f, false, false);
    tl_image slopes = tl_bake_slopes(&field), normals = tl_bake_normals(&slopes, 1);
    float damped_u = sinf(2 * pi / SIDE) / (2 * pi / SIDE), damped_v = sinf(4 * pi / SIDE) / (4 * pi / SIDE);
    double worst = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        int column = i % SIDE, row = i / SIDE;
        float u = ((float)column + 0.5f) / SIDE, v = ((float)row + 0.5f) / SIDE;
        float x = 1e-3f * 2 * pi / 0.01f * cosf(2 * pi * u), y = -0.5e-3f * 4 * pi / 0.02f * cosf(4 * pi * v);
        assert_near(tl_image_floats(&slopes)[2 * (size_t)i], damped_u * x, 1e-4);
        assert_near(tl_image_floats(&slopes)[2 * i + 1], damped_v * y, 1e-4);
        float length = sqrtf(1 + x * x + y * y);
        const float analytic[] = {-x / length, -y / length, 1 / length};
        for (int c = 0; c < 3; c++)
            worst = fmax(worst, fabs((double)(tl_image_floats(&normals)[3 * i + c] - analytic[c])));
    }
    /* A normal moves by no more than its slopes do: the damping is all the error there is. */
    printf("sine wave, %d texels: normals within %.2g of the analytic ones\n", SIDE, worst);
    assert_true(worst <= hypot((1 - (double)damped_u) * 0.63, (1 - (double)damped_v) * 0.32) + 1e-5);
    tl_image_release(&heights);
    tl_image_release(&slopes);
    tl_image_release(&normals);
}

static float slanted(float u, float v)
{
    return 0.3e-3f * u - 0.2e-3f * v;
}

/* A slanted plane on a square patch: tangent-space normals and Blinn's form are one normal. */
static void test_plane(void **state)
{
    (void)state;
    tl_image heights = heights_of(16, 8, slanted);
    struct tl_height_field field = tl_height_field_make(&heights, 1e-3f, 1e-3f, true, true);
    tl_image slopes = tl_bake_slopes(&field), normals = tl_bake_normals(&slopes, 1);
    tl_image bytes = tl_bake_encoded(&normals);
    const vec3s up = {{0, 1, 0}};
    vec3s expected =
        glms_vec3_normalize((vec3s){{-0.3f, 1, 0.2f}}); /* the plane rises along +X and falls along +Z */
    const vec3s p_u = {{1e-3f, 0, 0}}, p_v = {{0, 0, 1e-3f}};
    for (size_t i = 0; i < (size_t)16 * 8; i++) {
        const float *n = tl_image_floats(&normals) + 3 * i;
        vec3s patch = bent_normal((vec3s){{n[0], n[1], n[2]}}, up, (vec3s){{1, 0, 0}}, 1, up);
        vec3s blinn = tl_blinn_normal(up, p_u, p_v, 0.3e-3f, -0.2e-3f);
        for (int c = 0; c < 3; c++) {
            assert_near(patch.raw[c], expected.raw[c], 1e-5);
            assert_near(blinn.raw[c], expected.raw[c], 1e-6);
            assert_near(2 * (float)tl_image_bytes(&bytes)[3 * i + (size_t)c] / 255 - 1, n[c], 1.01 / 255);
        }
    }
    tl_image *made[] = {&heights, &slopes, &normals, &bytes};
    for (size_t i = 0; i < TL_COUNT(made); i++)
        tl_image_release(made[i]);
}

/* P(u, v) = (r cos u, r sin u, l v): N' = r l N_n + h_u l (sin u, -cos u, 0) + h_v (0, 0, -r). */
static void test_cylinder(void **state)
{
    (void)state;
    struct tl_random random = tl_random_begin(4, 0);
    double worst = 0, patch_worst = 0;
    for (int i = 0; i < 10000; i++) {
        float u = 2 * pi * random_unit(&random), r = 0.05f + random_unit(&random),
              l = 0.05f + random_unit(&random);
        float h_u = r * (random_unit(&random) - 0.5f), h_v = l * (random_unit(&random) - 0.5f);
        vec3s normal = {{cosf(u), sinf(u), 0}}, p_u = {{-r * sinf(u), r * cosf(u), 0}}, p_v = {{0, 0, l}};
        vec3s closed = {{r * l * cosf(u) + h_u * l * sinf(u), r * l * sinf(u) - h_u * l * cosf(u), -h_v * r}};
        closed = glms_vec3_normalize(closed);
        vec3s made = tl_blinn_normal(normal, p_u, p_v, h_u, h_v);
        vec3s mirrored = tl_blinn_normal(normal, p_u, glms_vec3_negate(p_v), h_u, -h_v);
        vec3s patch =
            bent_normal((vec3s){{-h_u / r, -h_v / r, 1}}, normal, glms_vec3_normalize(p_u), 1, normal);
        /* The square patch of side r is right along u; along v it takes h_v / r for h_v / l. */
        vec3s stretched = tl_blinn_normal(normal, p_u, p_v, h_u, h_v * l / r);
        for (int c = 0; c < 3; c++) {
            worst = fmax(worst, fabs((double)(made.raw[c] - closed.raw[c])));
            assert_near(mirrored.raw[c], made.raw[c], 1e-6);
            patch_worst = fmax(patch_worst, fabs((double)(patch.raw[c] - stretched.raw[c])));
        }
    }
    printf("cylinder: Blinn's normal within %.2g of its closed form\n", worst);
    assert_true(worst <= 1e-5);
    assert_true(patch_worst <= 1e-5); /* so all of the patch's error is that one factor */
    for (int ratio = 1; ratio <= 4; ratio *= 2)
        printf("square patch on cells 1 : %d: a slope of 0.5 is off by %.2f degrees\n", ratio,
               (double)glm_deg(fabsf(atanf(0.5f) - atanf(0.5f / (float)ratio))));
}

/* Against the displaced surface itself: what Blinn drops, h N_u, is h / r of P_u. */
static void test_displaced(void **state)
{
    (void)state;
    const double r = 0.1, step = 1e-5;
    for (int quarter = 0; quarter < 3; quarter++) {
        double depth = ldexp(1e-4, 2 * quarter), worst = 0;
        for (int part = 0; part < 629; part++) {
            double u = 0.01 * part;
            /* In the plane of the cylinder's circle: radius r + h, h = depth sin(40 u). */
            double a = r + depth * sin(40 * (u - step)), b = r + depth * sin(40 * (u + step));
            double dx = b * cos(u + step) - a * cos(u - step), dy = b * sin(u + step) - a * sin(u - step);
            vec3s truth = glms_vec3_normalize((vec3s){{(float)dy, -(float)dx, 0}});
            vec3s normal = {{(float)cos(u), (float)sin(u), 0}};
            vec3s p_u = {{-(float)(r * sin(u)), (float)(r * cos(u)), 0}}, p_v = {{0, 0, 1}};
            vec3s made = tl_blinn_normal(normal, p_u, p_v, (float)(depth * 40 * cos(40 * u)), 0);
            worst = fmax(worst, (double)glms_vec3_norm(glms_vec3_sub(truth, made)));
        }
        printf("height %.1f %% of the radius: Blinn's normal within %.2g of the displaced surface's\n",
               100 * depth / r, worst);
        assert_true(worst <= 0.5 * depth / r + 1e-4); /* atan(s) - atan(s / (1 + q)) <= q / 2 */
    }
}

static tl_weave satin(void)
{
    const struct tl_weave_params params = {.pattern = TL_WEAVE_SATIN,
                                           .warp_pitch_mm = 0.143f,
                                           .weft_pitch_mm = 0.25f,
                                           .crimp_mm = 0.07f,
                                           .warp_tint = {1, 1, 1},
                                           .weft_tint = {1, 1, 1},
                                           .texels_per_yarn = 32};
    tl_weave weave;
    assert_true(tl_weave_create(&params, &weave));
    return weave;
}

static float wall(float u, float v)
{
    (void)v;
    return u > 0.5f ? 1e-3f : 0;
}

/* Distance d from a wall of height H: its horizon's slope is H / d. */
static void test_wall(void **state)
{
    (void)state;
    enum { SIDE = 64 };
    tl_image heights = heights_of(SIDE, SIDE, wall);
    struct tl_height_field field = tl_height_field_make(&heights, 0.01f, 0.01f, true, true);
    struct tl_horizon_maps maps = tl_bake_horizons(&field, 16);
    for (int column = 2; column < SIDE / 2;
         column++) { /* not where the diagonal leaves the map before it meets the wall */
        vec2s uv = {{((float)column + 0.5f) / SIDE, 0.5f}};
        double distance = (0.5 - (double)uv.x + 0.5 / SIDE) * 0.01, diagonal = distance * sqrt(2);
        assert_near(horizon_sine(&maps, &field, uv, 1, 0), 1e-3 / hypot(distance, 1e-3), 0.6 / 255);
        assert_near(horizon_sine(&maps, &field, uv, 1, -1), 1e-3 / hypot(diagonal, 1e-3), 0.6 / 255);
        assert_near(horizon_sine(&maps, &field, uv, -1, 0), 0, 0);
    }
    tl_horizon_maps_release(&maps);
    tl_image_release(&heights);
}

/* A ray by quarter texels, up to the highest point. */
static bool is_lit(const struct tl_height_field *field, vec2s uv, vec3s light)
{
    float from = tl_field_height(field, uv), flat = hypotf(light.x, light.y), step = 2.2e-6f; /* m */
    for (float distance = step; from + distance * light.z / flat < field->high_m; distance += step) {
        float x = distance * light.x / flat, y = distance * light.y / flat;
        if (tl_field_height(field, tl_field_moved(field, uv, x, y)) > from + distance * light.z / flat)
            return false;
    }
    return true;
}

static void test_horizon_against_rays(void **state)
{
    (void)state;
    tl_weave weave = satin();
    struct tl_height_field field =
        tl_height_field_make(&weave.height, weave.size_m[0], weave.size_m[1], false, false);
    struct tl_horizon_maps maps = tl_bake_horizons(&field, 16);
    struct tl_random random = tl_random_begin(5, 0);
    int agreed[2] = {0}, cast[2] = {0};
    double lit[2] = {0}, by_map = 0;
    for (int i = 0; i < 40000; i++) {
        int between = i & 1; /* at baked angles; anywhere */
        vec2s uv = {{random_unit(&random), random_unit(&random)}};
        float turn = between ? 2 * pi * random_unit(&random) : pi / 4 * floorf(8 * random_unit(&random));
        float z = 0.02f + 0.97f * random_unit(&random), flat = sqrtf(1 - z * z);
        vec3s light = {{flat * cosf(turn), flat * sinf(turn), z}};
        bool truth = is_lit(&field, uv, light);
        bool mapped = z >= horizon_sine(&maps, &field, uv, light.x, light.y);
        agreed[between] += truth == mapped;
        cast[between]++;
        lit[0] += truth;
        lit[1] += mapped;
        by_map++;
    }
    double at_angles = agreed[0] / (double)cast[0], anywhere = agreed[1] / (double)cast[1];
    printf("horizon map of satin: agrees with rays for %.2f %% of lights at its angles, %.2f %% anywhere; "
           "lit %.2f %%, "
           "rays %.2f %%\n",
           100 * at_angles, 100 * anywhere, 100 * lit[1] / by_map, 100 * lit[0] / by_map);
    /* Light heights are even in (0, 1): disagreement is the mean error of the horizon's sine. Texels and
     * bytes leave about a hundredth; between eight angles a sine may bend by a few more. */
    assert_true(at_angles > 0.98);
    assert_true(anywhere > 0.96);
    /* Halfway up the side of a yarn, between a texel that is lit and one that is not, the interpolated map is
     * half lit. */
    assert_near(lit[1] / by_map, lit[0] / by_map, 0.01);
    tl_horizon_maps_release(&maps);
    tl_weave_release(&weave);
}

/* Flat normals keep a gloss map white; spread ones darken it by 1 - g' = 1 - g + 4 variance. */
static void test_gloss(void **state)
{
    (void)state;
    tl_image normals = tl_image_create(8, 8, 3, TL_IMAGE_F32);
    for (int i = 0; i < 64; i++) {
        float x = i % 2 ? 0.1f : -0.1f;
        const float n[] = {x, 0, sqrtf(1 - x * x)};
        memcpy(tl_image_floats(&normals) + 3 * (size_t)i, n, sizeof n);
    }
    tl_image moments = tl_bake_moments(&normals, false), sharp = tl_bake_gloss(&moments, 0.9f, 1),
             wide = tl_bake_gloss(&moments, 0.9f, 2);
    double length = sqrt(0.99), variance = (1 - length) / length;
    for (int i = 0; i < 64; i++) {
        assert_int_equal(tl_image_bytes(&sharp)[i], 255);
        assert_near(tl_image_bytes(&wide)[i], 255 * (0.9 - 4 * variance) / 0.9, 0.6);
    }
    tl_image *made[] = {&normals, &moments, &sharp, &wide};
    for (size_t i = 0; i < TL_COUNT(made); i++)
        tl_image_release(made[i]);
}

/* One texel; no height; no slope; normals of length 0. */
static void test_degenerate(void **state)
{
    (void)state;
    tl_image heights = tl_image_create(1, 1, 1, TL_IMAGE_F32),
             normals = tl_image_create(1, 1, 3, TL_IMAGE_U8);
    for (int clamp = 0; clamp < 2; clamp++) {
        struct tl_height_field field = tl_height_field_make(&heights, 1, 1, clamp, clamp);
        tl_image slopes = tl_bake_slopes(&field);
        struct tl_horizon_maps maps = tl_bake_horizons(&field, 16);
        assert_near(tl_image_floats(&slopes)[0], 0, 0);
        assert_near(horizon_sine(&maps, &field, (vec2s){{0.3f, -7}}, 0.1f, 1), 0, 0);
        tl_horizon_maps_release(&maps);
        tl_image_release(&slopes);
    }
    tl_image_bytes(&normals)[0] = tl_image_bytes(&normals)[1] = tl_image_bytes(&normals)[2] = 128;
    tl_image moments = tl_bake_moments(&normals, false);
    assert_near(tl_image_floats(&moments)[3], 1 / 3.0, 1e-6); /* 128 is a little over 0 in every channel */
    const vec3s up = {{0, 0, 1}}, none = {{0, 0, 0}};
    assert_near(tl_blinn_normal(up, none, none, 1, 1).z, 1, 0);
    assert_near(bent_normal(none, up, none, 1, up).z, 1, 0);
    tl_image_release(&moments);
    tl_image_release(&normals);
    tl_image_release(&heights);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sine),     cmocka_unit_test(test_plane),
        cmocka_unit_test(test_cylinder), cmocka_unit_test(test_displaced),
        cmocka_unit_test(test_wall),     cmocka_unit_test(test_horizon_against_rays),
        cmocka_unit_test(test_gloss),    cmocka_unit_test(test_degenerate)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
