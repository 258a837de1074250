#include "render/env/convert.h"

#include "assets/environment/environment.h"
#include "config/base/memory.h"

#include "tests/testing.h"

#include <omp.h>

static struct tl_sphere_map map_of(enum tl_layout layout, int size)
{
    int64_t width, height;
    tl_layout_extent(layout, size, &width, &height);
    return (struct tl_sphere_map){layout, (int)width, (int)height};
}

static tl_image black(const struct tl_sphere_map *map)
{
    return tl_image_create(map->width, map->height, 3, TL_IMAGE_F32);
}

static size_t value_count(const struct tl_sphere_map *map)
{
    return 3 * (size_t)map->width * (size_t)map->height;
}

static double power(const tl_image *image, const struct tl_sphere_map *map, int channel)
{
    double sum = 0;
    for (int i = 0; i < map->width * map->height; i++)
        sum += (double)tl_image_floats(image)[3 * i + channel] *
               tl_layout_solid_angle(map, i % map->width, i / map->width);
    return sum;
}

/* Every pair of layouts, of sizes that do not divide each other, up and down. */
#define PAIRS (TL_LAYOUT_COUNT * TL_LAYOUT_COUNT)
static void pair(int number, struct tl_sphere_map *from, struct tl_sphere_map *to)
{
    static const int sizes[TL_LAYOUT_COUNT] = {11, 33, 22, 21, 27};
    int first = number / TL_LAYOUT_COUNT, second = number % TL_LAYOUT_COUNT;
    *from = map_of((enum tl_layout)first, sizes[first]);
    *to = map_of((enum tl_layout)second, first == second ? 7 : sizes[second] + (number % 3 - 1) * 5);
}

static void a_constant_stays_constant(void **state)
{
    (void)state;
    for (int number = 0; number < PAIRS; number++) {
        struct tl_sphere_map from, to;
        pair(number, &from, &to);
        tl_image image = black(&from);
        for (size_t i = 0; i < value_count(&from); i++)
            tl_image_floats(&image)[i] = 0.7f;
        tl_image converted = tl_image_convert(&image, &from, &to, NULL);
        for (size_t i = 0; i < value_count(&to); i++) /* outside of the discs too */
            assert_near(tl_image_floats(&converted)[i], 0.7f, 1e-7);
        tl_image_release(&converted);
        tl_image_release(&image);
    }
}

/* Suns at two texels, one red and one green. */
static void check_suns(const struct tl_sphere_map *from, const struct tl_sphere_map *to,
                       const size_t texels[2])
{
    tl_image image = black(from);
    for (size_t c = 0; c < 2; c++)
        tl_image_floats(&image)[3 * texels[c] + c] = 1e6f;
    tl_image converted = tl_image_convert(&image, from, to, NULL);
    tl_image back = tl_image_convert(&converted, to, from, NULL);
    for (int c = 0; c < 2; c++) {
        double expected = power(&image, from, c);
        assert_near(power(&converted, to, c), expected, TL_CONVERT_ERROR * expected);
        assert_near(power(&back, from, c), expected, 2 * TL_CONVERT_ERROR * expected);
    }
    assert_near(power(&back, from, 2), 0, 0);
    tl_image_release(&back);
    tl_image_release(&converted);
    tl_image_release(&image);
}

/* At the middle, at corners and borders, at poles and rims. */
static void a_sun_keeps_its_power(void **state)
{
    (void)state;
    for (int number = 0; number < PAIRS; number++) {
        struct tl_sphere_map from, to;
        pair(number, &from, &to);
        size_t width = (size_t)from.width, rows = (size_t)from.height;
        const size_t texels[] = {0,
                                 width / 2,
                                 width - 1,
                                 rows / 2 * width,
                                 rows / 2 * width + width / 2,
                                 (rows - 1) * width + width / 3};
        for (size_t i = 0; i < TL_COUNT(texels); i += 2)
            check_suns(&from, &to, texels + i);
    }
}

/* The reported error bounds the error of every sun; at the sizes of real maps. */
static void every_sun_keeps_its_power(void **state)
{
    (void)state;
    for (int first = 0; first < TL_LAYOUT_COUNT; first++)
        for (int second = 0; second < TL_LAYOUT_COUNT; second++) {
            struct tl_sphere_map latlong = map_of(TL_LAYOUT_LATLONG, 128);
            struct tl_sphere_map from =
                map_of((enum tl_layout)first, tl_convert_size(&latlong, (enum tl_layout)first));
            struct tl_sphere_map to =
                map_of((enum tl_layout)second, tl_convert_size(&latlong, (enum tl_layout)second));
            assert_int_equal(tl_convert_size(&from, TL_LAYOUT_LATLONG), 128);
            tl_image image = black(&from);
            double error;
            tl_image converted = tl_image_convert(&image, &from, &to, &error);
            print_message("%s to %s: %.2g\n", tl_layout_names[first], tl_layout_names[second], error);
            assert_true(error < TL_CONVERT_ERROR);
            tl_image_release(&converted);
            tl_image_release(&image);
        }
}

/* How far a texel's corners on the sphere lie from its middle: the farthest of each, on average over the
 * sphere and at most. */
struct reach {
    double mean, maximum;
};

static struct reach find_reach(const struct tl_sphere_map *map)
{
    struct reach reach = {0};
    for (int i = 0; i < map->width * map->height; i++) {
        int x = i % map->width, y = i / map->width;
        double farthest = 0, inset = 1e-3, solid_angle = tl_layout_solid_angle(map, x, y);
        vec3s middle = tl_layout_direction(map, x + 0.5, y + 0.5);
        for (int k = 0; k < 4 && solid_angle > 0; k++) {
            vec3s corner = tl_layout_direction(map, k & 1 ? x + 1 - inset : x + inset,
                                               k & 2 ? y + 1 - inset : y + inset);
            farthest = fmax(farthest, (double)glms_vec3_distance(middle, corner));
        }
        reach.mean += farthest * solid_angle / (4 * M_PI);
        reach.maximum = fmax(reach.maximum, farthest);
    }
    return reach;
}

/* 2 + d in the three channels. A mean over a texel lies off the value at its middle by no more than the texel
 * reaches from there, plus what the source texels that it takes from reach beyond it. At a seam that were
 * read from the wrong side it would lie off by 1 or more, and with a mirrored axis by 1 on average. */
static void directions_stay(void **state)
{
    (void)state;
    for (int number = 0; number < PAIRS; number++) {
        struct tl_sphere_map from, to;
        pair(number, &from, &to);
        tl_image image = black(&from);
        for (int i = 0; i < from.width * from.height; i++) {
            int row = i / from.width;
            vec3s direction = tl_layout_direction(&from, i % from.width + 0.5, row + 0.5);
            for (int c = 0; c < 3; c++)
                tl_image_floats(&image)[3 * i + c] = 2 + direction.raw[c];
        }
        tl_image converted = tl_image_convert(&image, &from, &to, NULL);
        double worst = 0, mean = 0;
        for (int i = 0; i < to.width * to.height; i++) {
            int x = i % to.width, y = i / to.width;
            double solid_angle = tl_layout_solid_angle(&to, x, y);
            vec3s direction = tl_layout_direction(&to, x + 0.5, y + 0.5);
            const float *texel = tl_image_floats(&converted) + 3 * (size_t)i;
            double off =
                (double)glms_vec3_distance((vec3s){{texel[0] - 2, texel[1] - 2, texel[2] - 2}}, direction);
            worst = solid_angle > 0 ? fmax(worst, off) : worst;
            mean += off * solid_angle / (4 * M_PI);
        }
        struct reach first = find_reach(&from), second = find_reach(&to);
        print_message("%s to %s: mean %.3f of %.3f, worst %.3f of %.3f\n", tl_layout_names[from.layout],
                      tl_layout_names[to.layout], mean, first.mean + second.mean, worst,
                      first.maximum + second.maximum);
        assert_true(mean < 0.5 * (first.mean + second.mean));
        assert_true(worst < first.maximum + second.maximum);
        tl_image_release(&converted);
        tl_image_release(&image);
    }
}

static void real_light_keeps_its_power(void **state)
{
    (void)state;
    tl_environment environment;
    tl_error error;
    assert_ok(tl_environment_load(test_data("envmaps/exr/pmndrs_esplanade_512.exr"), &environment, &error),
              error);
    struct tl_sphere_map from = {TL_LAYOUT_LATLONG, environment.image.width, environment.image.height};
    for (int layout = 0; layout < TL_LAYOUT_COUNT; layout++) {
        if (layout == TL_LAYOUT_LATLONG)
            continue;
        struct tl_sphere_map to = map_of((enum tl_layout)layout, 96);
        tl_image converted = tl_image_convert(&environment.image, &from, &to, NULL);
        tl_image back = tl_image_convert(&converted, &to, &from, NULL);
        for (int c = 0; c < 3; c++) {
            double expected = power(&environment.image, &from, c);
            assert_near(power(&converted, &to, c), expected, TL_CONVERT_ERROR * expected);
            assert_near(power(&back, &from, c), expected, 2 * TL_CONVERT_ERROR * expected);
        }
        for (size_t k = 0; k < value_count(&from); k++)
            assert_true(tl_image_floats(&back)[k] >= 0 &&
                        tl_image_floats(&back)[k] <= environment.peak * 1.00001f);
        tl_image_release(&back);
        tl_image_release(&converted);
    }
    tl_environment_release(&environment);
}

/* The OpenEXR project's two renditions of one light probe: its lat-long file made a cube, against its cube
 * file, by face. They were resampled from one another, which smears the lamps: capped at 4, where walls are
 * 1, they agree to a few per cent; mirrored faces differ by more than half. */
static void the_stage_is_the_same_in_both_files(void **state)
{
    (void)state;
    tl_environment cube, latlong;
    tl_error error;
    assert_ok(tl_environment_load(test_data("envmaps/exr/StageEnvCube.exr"), &cube, &error), error);
    assert_ok(tl_environment_load(test_data("envmaps/exr/StageEnvLatLong.exr"), &latlong, &error), error);
    struct tl_sphere_map cube_map = {TL_LAYOUT_CUBE, cube.image.width, cube.image.height};
    struct tl_sphere_map latlong_map = {TL_LAYOUT_LATLONG, latlong.image.width, latlong.image.height};
    struct tl_sphere_map to = map_of(TL_LAYOUT_CUBE, 16);
    tl_image a = tl_image_convert(&cube.image, &cube_map, &to, NULL);
    tl_image b = tl_image_convert(&latlong.image, &latlong_map, &to, NULL);
    for (int face = 0; face < 6; face++) {
        double difference = 0, sum = 0;
        for (int i = 3 * face * 256; i < 3 * (face + 1) * 256; i++) {
            double first = fmin((double)tl_image_floats(&a)[i], 4),
                   second = fmin((double)tl_image_floats(&b)[i], 4);
            difference += fabs(first - second);
            sum += first;
        }
        print_message("face %d: mean difference %.1f %%\n", face, 100 * difference / sum);
        assert_true(difference < 0.05 * sum);
    }
    tl_image_release(&a);
    tl_image_release(&b);
    tl_environment_release(&cube);
    tl_environment_release(&latlong);
}

static void the_same_map_is_copied(void **state)
{
    (void)state;
    for (int layout = 0; layout < TL_LAYOUT_COUNT; layout++) {
        struct tl_sphere_map map = map_of((enum tl_layout)layout, 9);
        tl_image image = black(&map);
        for (size_t i = 0; i < value_count(&map); i++)
            tl_image_floats(&image)[i] = (float)i;
        tl_image converted = tl_image_convert(&image, &map, &map, NULL);
        assert_memory_equal(converted.texels, image.texels, value_count(&map) * sizeof(float));
        tl_image_release(&converted);
        tl_image_release(&image);
    }
}

static void threads_change_no_bit(void **state)
{
    (void)state;
    struct tl_sphere_map from = map_of(TL_LAYOUT_LATLONG, 50), to = map_of(TL_LAYOUT_PARABOLOID, 40);
    tl_image image = black(&from);
    for (size_t i = 0; i < value_count(&from); i++)
        tl_image_floats(&image)[i] = (float)(((uint32_t)i * 2654435761u) >> 16) / 65536;
    int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    tl_image alone = tl_image_convert(&image, &from, &to, NULL);
    omp_set_num_threads(3);
    tl_image together = tl_image_convert(&image, &from, &to, NULL);
    omp_set_num_threads(threads);
    assert_memory_equal(alone.texels, together.texels, value_count(&to) * sizeof(float));
    tl_image_release(&alone);
    tl_image_release(&together);
    tl_image_release(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_constant_stays_constant),  cmocka_unit_test(a_sun_keeps_its_power),
        cmocka_unit_test(every_sun_keeps_its_power),  cmocka_unit_test(directions_stay),
        cmocka_unit_test(real_light_keeps_its_power), cmocka_unit_test(the_stage_is_the_same_in_both_files),
        cmocka_unit_test(the_same_map_is_copied),     cmocka_unit_test(threads_change_no_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
