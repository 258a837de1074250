#include "render/env/cube.h"

#include "render/env/from_environment.h"
#include "render/env/resample.h"

#include "tests/testing.h"

#include <omp.h>
#include <string.h>

static tl_environment make_environment(enum tl_env_layout layout, int width, int height)
{
    return (tl_environment){.layout = layout, .image = tl_image_create(width, height, 3, TL_IMAGE_F32)};
}

static void release_environment(tl_environment *environment)
{
    tl_image_release(&environment->image);
}

static double cube_energy(const tl_cube *cube, int channel)
{
    double sum = 0;
    for (int i = 0; i < 6 * cube->size * cube->size; i++) {
        int texel = i % (cube->size * cube->size);
        sum += (double)cube->texels[3 * i + channel] *
               (double)tl_cube_solid_angle(cube->size, texel % cube->size, texel / cube->size);
    }
    return sum;
}

static void solid_angles_sum_to_the_sphere(void **state)
{
    (void)state;
    const int sizes[] = {1, 2, 3, 16, 128, 256};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        double sum = 0;
        for (int y = 0; y < sizes[i]; y++)
            for (int x = 0; x < sizes[i]; x++)
                sum += (double)tl_cube_solid_angle(sizes[i], x, y);
        assert_near(6 * sum, 4 * M_PI, 4 * M_PI * 1e-6);
    }
}

/* A texel's solid angle against its own midpoint sum of cos / r^2. */
static void solid_angle_of_a_texel(void **state)
{
    (void)state;
    for (int y = 0; y < 4; y++) {
        for (int x = 0; x < 4; x++) {
            double sum = 0;
            for (int j = 0; j < 64; j++) {
                for (int i = 0; i < 64; i++) {
                    double u = 2 * (x + (i + 0.5) / 64) / 4 - 1, v = 2 * (y + (j + 0.5) / 64) / 4 - 1;
                    sum += pow(1 + u * u + v * v, -1.5) / (128.0 * 128);
                }
            }
            assert_near(tl_cube_solid_angle(4, x, y), sum, 1e-5 * sum);
        }
    }
}

static void directions_make_round_trips(void **state)
{
    (void)state;
    for (int face = 0; face < 6; face++) {
        for (int y = 0; y < 32; y++) {
            for (int x = 0; x < 32; x++) {
                float s = ((float)x + 0.5f) / 32, t = ((float)y + 0.5f) / 32, back_s, back_t;
                int back;
                tl_cube_locate(glms_vec3_scale(tl_cube_direction(face, s, t), 3.7f), &back, &back_s, &back_t);
                assert_int_equal(back, face);
                assert_near(back_s, s, 1e-6);
                assert_near(back_t, t, 1e-6);
            }
        }
    }
}

/* OpenGL 4.5, table 8.19, spelled out: sc, tc and the major axis of each face. */
static void faces_are_those_of_gl(void **state)
{
    (void)state;
    const float sc[6][3] = {{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {-1, 0, 0}};
    const float tc[6][3] = {{0, -1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {0, -1, 0}, {0, -1, 0}};
    const float axis[6][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (int face = 0; face < 6; face++) {
        vec3s direction = tl_cube_direction(face, 0.75f, 0.375f); /* sc = 0.5, tc = -0.25 */
        for (int c = 0; c < 3; c++)
            assert_near(direction.raw[c], axis[face][c] + 0.5f * sc[face][c] - 0.25f * tc[face][c], 1e-7);
    }
}

static void a_constant_stays_constant(void **state)
{
    (void)state;
    const int layouts[][3] = {{TL_ENV_LATLONG, 1, 1},   {TL_ENV_LATLONG, 64, 32}, {TL_ENV_LATLONG, 7, 5},
                              {TL_ENV_LATLONG, 300, 9}, {TL_ENV_CUBE, 1, 6},      {TL_ENV_CUBE, 24, 144}};
    const int sizes[] = {1, 5, 32};
    for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++) {
        tl_environment environment =
            make_environment((enum tl_env_layout)layouts[i][0], layouts[i][1], layouts[i][2]);
        for (int k = 0; k < 3 * layouts[i][1] * layouts[i][2]; k++)
            tl_image_floats(&environment.image)[k] = 0.7f;
        for (size_t n = 0; n < 3; n++) {
            tl_cube cube = tl_cube_from_environment(&environment, sizes[n]);
            for (int k = 0; k < 18 * sizes[n] * sizes[n]; k++)
                assert_near(cube.texels[k], 0.7, 0.7e-6);
            tl_cube_release(&cube);
        }
        release_environment(&environment);
    }
}

static double latlong_solid_angle(int width, int height, int row)
{
    return 2 * M_PI / width * (cos(M_PI * row / height) - cos(M_PI * (row + 1) / height));
}

static void check_single_texel(int width, int height, int size, int column, int row)
{
    tl_environment environment = make_environment(TL_ENV_LATLONG, width, height);
    tl_image_floats(&environment.image)[3 * (row * width + column) + 1] = 1e6f;
    tl_cube cube = tl_cube_from_environment(&environment, size);
    double expected = 1e6 * latlong_solid_angle(width, height, row);
    assert_near(cube_energy(&cube, 1), expected, 0.01 * expected);
    assert_near(cube_energy(&cube, 0), 0, 0);
    tl_cube_release(&cube);
    release_environment(&environment);
}

static void a_single_texel_keeps_its_energy(void **state)
{
    (void)state;
    const int columns[] = {0, 63, 128, 301, 511}, rows[] = {0, 1, 63, 64, 90, 128, 200, 254, 255};
    for (size_t i = 0; i < sizeof columns / sizeof *columns; i++)
        for (size_t j = 0; j < sizeof rows / sizeof *rows; j++)
            check_single_texel(512, 256, 32, columns[i], rows[j]);
    check_single_texel(1024, 512, 128, 0, 0); /* as the product uses it */
    check_single_texel(1024, 512, 128, 640, 511);
    check_single_texel(1024, 512, 128, 383, 170);
    check_single_texel(16, 8, 64, 3, 0); /* source texels larger than the cube's */
    check_single_texel(16, 8, 64, 9, 4);
}

/* A cube file of the same size is copied; a larger or odd one keeps energy and place. */
static void cubes_are_averaged_exactly(void **state)
{
    (void)state;
    tl_environment environment = make_environment(TL_ENV_CUBE, 12, 72);
    float *texels = tl_image_floats(&environment.image);
    for (int i = 0; i < 3 * 12 * 72; i++)
        texels[i] = (float)(i % 17) + 0.25f;
    tl_cube source = {.size = 12, .texels = texels};
    tl_cube same = tl_cube_from_environment(&environment, 12);
    for (int i = 0; i < 3 * 12 * 72; i++)
        assert_near(same.texels[i], texels[i], 1e-5);
    const int sizes[] = {4, 5, 30};
    for (int i = 0; i < 3; i++) {
        tl_cube cube = tl_cube_from_environment(&environment, sizes[i]);
        for (int c = 0; c < 3; c++)
            assert_near(cube_energy(&cube, c), cube_energy(&source, c), 1e-5 * cube_energy(&source, c));
        tl_cube_release(&cube);
    }
    tl_cube_release(&same);
    release_environment(&environment);
}

/* The lat-long convention of assets/environment/environment.h, texel by texel. */
static void latlong_is_turned_the_right_way(void **state)
{
    (void)state;
    tl_environment environment = make_environment(TL_ENV_LATLONG, 256, 128);
    for (int y = 0; y < 128; y++) {
        for (int x = 0; x < 256; x++) {
            double phi = ((x + 0.5) / 256 - 0.5) * 2 * M_PI, theta = (y + 0.5) / 128 * M_PI;
            float *texel = tl_image_floats(&environment.image) + 3 * (size_t)(y * 256 + x);
            texel[0] = (float)(2 + sin(theta) * sin(phi)); /* 2 + x, 2 + y, 2 + z */
            texel[1] = (float)(2 + cos(theta));
            texel[2] = (float)(2 - sin(theta) * cos(phi));
        }
    }
    tl_cube cube = tl_cube_from_environment(&environment, 16);
    for (int i = 0; i < 6 * 256; i++) {
        vec3s direction =
            tl_cube_direction(i / 256, ((float)(i % 16) + 0.5f) / 16, ((float)(i / 16 % 16) + 0.5f) / 16);
        direction = glms_vec3_normalize(direction);
        vec3s sampled = tl_environment_sample(&environment, direction);
        for (int c = 0; c < 3; c++) {
            /* 1/4 of a cube texel's width (0.125 at the centre of a face) bounds the average's distance
             * from the value at the centre for functions of slope 1 */
            assert_near(cube.texels[3 * i + c], 2 + direction.raw[c], 0.03);
            assert_near(sampled.raw[c], 2 + direction.raw[c], 0.03);
        }
    }
    tl_cube_release(&cube);
    release_environment(&environment);
}

/* Along any great circle a seamless fetch has no step: with texels of slope about 1 the largest difference of
 * neighbouring samples stays within a few times their distance. */
static void samples_are_continuous_across_borders(void **state)
{
    (void)state;
    tl_cube cube = tl_cube_create(8);
    for (int i = 0; i < 6 * 64; i++) {
        vec3s direction = glms_vec3_normalize(
            tl_cube_direction(i / 64, ((float)(i % 8) + 0.5f) / 8, ((float)(i / 8 % 8) + 0.5f) / 8));
        for (int c = 0; c < 3; c++)
            cube.texels[3 * i + c] = direction.raw[c];
    }
    for (int circle = 0; circle < 40; circle++) {
        vec3s axis = glms_vec3_normalize((vec3s){{sinf((float)circle), cosf(2.3f * (float)circle), 0.3f}});
        vec3s start = glms_vec3_normalize(glms_vec3_cross(axis, (vec3s){{0, 0, 1}}));
        vec3s side = glms_vec3_cross(axis, start), previous = tl_cube_sample(&cube, start);
        for (int i = 1; i <= 3600; i++) {
            float angle = (float)i * (float)(M_PI / 1800);
            vec3s direction =
                glms_vec3_add(glms_vec3_scale(start, cosf(angle)), glms_vec3_scale(side, sinf(angle)));
            vec3s sampled = tl_cube_sample(&cube, direction);
            assert_true(glms_vec3_distance(sampled, previous) < 4 * M_PI / 1800);
            assert_true(glms_vec3_distance(sampled, direction) < 0.05f);
            previous = sampled;
        }
    }
    tl_cube_release(&cube);
}

static void a_corner_is_the_mean_of_three(void **state)
{
    (void)state;
    tl_cube cube = tl_cube_create(1);
    for (int face = 0; face < 6; face++)
        cube.texels[3 * (size_t)face] = (float)(1 << face);
    /* +X, +Y and +Z meet there: 1, 4 and 16 */
    assert_near(tl_cube_sample(&cube, (vec3s){{1, 1, 1}}).x, 7, 1e-5);
    assert_near(tl_cube_sample(&cube, (vec3s){{-1, -1, -1}}).x, (2 + 8 + 32) / 3.0, 1e-5);
    /* an edge is the mean of two, a centre one */
    assert_near(tl_cube_sample(&cube, (vec3s){{1, 1, 0}}).x, 2.5, 1e-5);
    assert_near(tl_cube_sample(&cube, (vec3s){{0, 0, -1}}).x, 32, 1e-5);
    tl_cube_release(&cube);
}

/* One scene, stored once as a cube and once as lat-long by the OpenEXR project: both layouts are read the
 * same way round. The files were resampled from one another, which smears the lamps: without those (capped at
 * 4, where walls are 1) they agree to a few per cent; mirrored faces differ by more than half. */
static void layouts_agree_on_a_real_scene(void **state)
{
    (void)state;
    tl_environment cube_file, latlong_file;
    tl_error error = {0};
    const char *cube_path = test_data("envmaps/exr/StageEnvCube.exr");
    const char *latlong_path = test_data("envmaps/exr/StageEnvLatLong.exr");
    assert_ok(tl_environment_load(cube_path, &cube_file, &error), error);
    assert_ok(tl_environment_load(latlong_path, &latlong_file, &error), error);
    assert_int_equal(cube_file.layout, TL_ENV_CUBE);
    tl_cube a = tl_cube_from_environment(&cube_file, 16), b = tl_cube_from_environment(&latlong_file, 16);
    for (int face = 0; face < 6; face++) {
        double difference = 0, sum = 0;
        for (int i = 3 * face * 256; i < 3 * (face + 1) * 256; i++) {
            double first = fmin((double)a.texels[i], 4), second = fmin((double)b.texels[i], 4);
            difference += fabs(first - second);
            sum += first;
        }
        printf("face %d: mean difference %.1f %%\n", face, 100 * difference / sum);
        assert_true(difference < 0.05 * sum);
    }
    tl_cube_release(&a);
    tl_cube_release(&b);
    tl_environment_release(&cube_file);
    tl_environment_release(&latlong_file);
}

static void threads_change_no_bit(void **state)
{
    (void)state;
    tl_environment environment = make_environment(TL_ENV_LATLONG, 200, 100);
    for (int i = 0; i < 3 * 200 * 100; i++)
        tl_image_floats(&environment.image)[i] = (float)(((uint32_t)i * 2654435761u) >> 16) / 65536;
    int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    tl_cube alone = tl_cube_from_environment(&environment, 32);
    omp_set_num_threads(3);
    tl_cube together = tl_cube_from_environment(&environment, 32);
    omp_set_num_threads(threads);
    assert_memory_equal(alone.texels, together.texels, sizeof(float[18 * 32 * 32]));
    tl_cube_release(&alone);
    tl_cube_release(&together);
    release_environment(&environment);
}

static void expect_same_cube(const tl_environment *environment, int size, struct tl_resampling *kept)
{
    tl_cube with = tl_cube_from_environment_with(environment, size, kept);
    tl_cube without = tl_cube_from_environment(environment, size);
    assert_memory_equal(with.texels, without.texels, sizeof(float) * 18 * (size_t)size * (size_t)size);
    tl_cube_release(&with);
    tl_cube_release(&without);
}

/* One environment after the other, of changing values, sizes and layouts, with what was kept of the last. */
static void cached_weights_change_no_bit(void **state)
{
    (void)state;
    struct tl_resampling kept = {0};
    const struct {
        int width, height, size;
    } cases[] = {{64, 32, 16}, {64, 32, 16}, {64, 32, 8}, {32, 64, 8}, {2, 1, 8}, {64, 32, 16}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        tl_environment latlong = make_environment(TL_ENV_LATLONG, cases[i].width, cases[i].height);
        for (int k = 0; k < 3 * cases[i].width * cases[i].height; k++)
            tl_image_floats(&latlong.image)[k] = (float)(((uint32_t)k + i) * 2654435761u >> 8);
        expect_same_cube(&latlong, cases[i].size, &kept);
        tl_environment cube = make_environment(TL_ENV_CUBE, 4, 24);
        expect_same_cube(&cube, cases[i].size, &kept);
        release_environment(&cube);
        release_environment(&latlong);
    }
    tl_resampling_release(&kept);
}

/* An image so large that it is resampled in bands and no weights are kept: a constant stays constant, and the
 * light of both bands arrives. Red increases downwards, so that the top face is darker than the bottom. */
static void large_images_are_resampled_in_bands(void **state)
{
    (void)state;
    struct tl_resampling kept = {0};
    tl_environment large = make_environment(TL_ENV_LATLONG, 2048, 1024);
    float *colour = tl_image_floats(&large.image);
    for (int y = 0; y < 1024; y++) {
        for (int x = 0; x < 2048; x++, colour += 3) {
            colour[0] = (float)y / 1024;
            colour[1] = colour[2] = 1;
        }
    }
    tl_cube cube = tl_cube_from_environment_with(&large, 8, &kept);
    assert_int_equal(kept.width, 0);
    for (int i = 0; i < 6 * 64; i++) {
        /* red is v = theta / pi; on average over a texel, which spans up to 0.25 rad, within its range */
        vec3s direction = tl_cube_texel_direction(8, i);
        assert_near(cube.texels[3 * (size_t)i], acos((double)direction.y) / M_PI, 0.02);
        assert_near(cube.texels[3 * (size_t)i + 1], 1, 1e-6);
    }
    tl_cube_release(&cube);
    release_environment(&large);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solid_angles_sum_to_the_sphere),
        cmocka_unit_test(solid_angle_of_a_texel),
        cmocka_unit_test(directions_make_round_trips),
        cmocka_unit_test(faces_are_those_of_gl),
        cmocka_unit_test(a_constant_stays_constant),
        cmocka_unit_test(a_single_texel_keeps_its_energy),
        cmocka_unit_test(cubes_are_averaged_exactly),
        cmocka_unit_test(latlong_is_turned_the_right_way),
        cmocka_unit_test(samples_are_continuous_across_borders),
        cmocka_unit_test(a_corner_is_the_mean_of_three),
        cmocka_unit_test(layouts_agree_on_a_real_scene),
        cmocka_unit_test(threads_change_no_bit),
        cmocka_unit_test(cached_weights_change_no_bit),
        cmocka_unit_test(large_images_are_resampled_in_bands),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
