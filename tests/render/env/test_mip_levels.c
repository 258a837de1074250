/* Mip levels weighted by solid angle, and prefiltered maps in every layout. */
#include "render/env/mip_levels.h"

#include "config/base/memory.h"
#include "render/envmap/prefiltered_map.h"

#include "tests/testing.h"

#include <omp.h>
#include <string.h>

static size_t count_of(const struct tl_mip_levels *levels, int level)
{
    return (size_t)levels->maps[level].width * (size_t)levels->maps[level].height;
}

/* Levels of the picture in texels[0]. */
static void halve_all(const struct tl_mip_levels *levels, float *texels[TL_MIP_LEVELS_MAX])
{
    for (int level = 1; level < levels->count; level++)
        tl_mip_levels_reduce(levels, level, texels[level - 1], texels[level]);
}

static void create_texels(const struct tl_mip_levels *levels, float *texels[TL_MIP_LEVELS_MAX])
{
    texels[0] = TL_NEW_ARRAY(float, 4 * count_of(levels, 0)); /* there is at least one level */
    for (int level = 1; level < levels->count; level++)
        texels[level] = TL_NEW_ARRAY(float, 4 * count_of(levels, level));
}

static void release_texels(const struct tl_mip_levels *levels, float *texels[TL_MIP_LEVELS_MAX])
{
    for (int level = 0; level < levels->count; level++)
        free(texels[level]);
}

/* Weighed by the exact solid angles of the level's own texels, not by the levels' sums. */
static double power(const struct tl_mip_levels *levels, int level, const float *texels, int channel)
{
    const struct tl_sphere_map *map = &levels->maps[level];
    double sum = 0;
    for (size_t i = 0; i < count_of(levels, level); i++)
        sum += (double)texels[4 * i + (size_t)channel] *
               tl_layout_solid_angle(map, (int)(i % (size_t)map->width), (int)(i / (size_t)map->width));
    return sum;
}

/* Closed forms of a coarse texel against sums over the fine ones: doubles. */
static void solid_angles_of_levels(void **state)
{
    (void)state;
    for (int layout = 0; layout < TL_LAYOUT_COUNT; layout++) {
        struct tl_mip_levels levels = tl_mip_levels_create((enum tl_layout)layout, 64);
        assert_int_equal(levels.count, 7);
        for (int level = 0; level < levels.count; level++) {
            const struct tl_sphere_map *map = &levels.maps[level];
            double sum = 0;
            for (int i = 0; i < map->width * map->height; i++) {
                double exact = tl_layout_solid_angle(map, i % map->width, i / map->width);
                assert_near(levels.solid_angles[level][i], exact, 1e-10);
                sum += levels.solid_angles[level][i];
            }
            assert_near(sum, 4 * M_PI, 1e-9);
        }
        tl_mip_levels_release(&levels);
    }
}

/* Off the sphere too, where filters reach. */
static void a_constant_stays_constant(void **state)
{
    (void)state;
    for (int layout = 0; layout < TL_LAYOUT_COUNT; layout++) {
        struct tl_mip_levels levels = tl_mip_levels_create((enum tl_layout)layout, 32);
        float *texels[TL_MIP_LEVELS_MAX];
        create_texels(&levels, texels);
        for (size_t i = 0; i < 4 * count_of(&levels, 0); i++)
            texels[0][i] = 0.7f;
        halve_all(&levels, texels);
        for (int level = 1; level < levels.count; level++)
            for (size_t i = 0; i < count_of(&levels, level); i++)
                for (size_t c = 0; c < 3; c++)
                    assert_near(texels[level][4 * i + c], 0.7f, 2e-7);
        release_texels(&levels, texels);
        tl_mip_levels_release(&levels);
    }
}

/* Every texel of the sphere, one at a time, is a sun. Its share of a coarse texel is rounded to float: 6e-8
 * per level; the limit is 0.1 %. */
static void a_sun_anywhere_keeps_its_power(void **state)
{
    (void)state;
    for (int layout = 0; layout < TL_LAYOUT_COUNT; layout++) {
        struct tl_mip_levels levels = tl_mip_levels_create((enum tl_layout)layout, 8);
        float *texels[TL_MIP_LEVELS_MAX];
        double worst = 0;
        create_texels(&levels, texels);
        for (size_t sun = 0; sun < count_of(&levels, 0); sun++) {
            if (levels.solid_angles[0][sun] <= 0)
                continue;
            texels[0][4 * sun + 1] = 1e6f;
            halve_all(&levels, texels);
            for (int level = 1; level < levels.count; level++) {
                double expected = 1e6 * levels.solid_angles[0][sun];
                double off = power(&levels, level, texels[level], 1) / expected - 1;
                worst = fmax(worst, fabs(off));
                assert_near(power(&levels, level, texels[level], 0), 0, 0);
            }
            texels[0][4 * sun + 1] = 0;
        }
        print_message("%s: a sun anywhere keeps its power within %.1g\n", tl_layout_names[layout], worst);
        assert_true(worst < 1e-5);
        release_texels(&levels, texels);
        tl_mip_levels_release(&levels);
    }
}

/* Solid angle by [Heidrich and Seidel 1999, eq. 6]: dw = dA / |(x, y, f)|^2, f = (1 - x^2 - y^2) / 2. A
 * texel's mean differs from its middle by its curvature: 1 % at 1/32 of the disc. */
static void paraboloids_weigh_as_equation_6(void **state)
{
    (void)state;
    struct tl_mip_levels levels = tl_mip_levels_create(TL_LAYOUT_PARABOLOID, 64);
    for (int y = 0; y < 64; y++)
        for (int x = 0; x < 128; x++) {
            double u = (x % 64 + 0.5) / 32 - 1, v = (y + 0.5) / 32 - 1, f = 0.5 - 0.5 * (u * u + v * v);
            if (u * u + v * v > 0.9)
                continue;
            double expected = 1 / 1024.0 / (u * u + v * v + f * f);
            assert_near(levels.solid_angles[0][128 * y + x], expected, 0.01 * expected);
        }
    tl_mip_levels_release(&levels);
}

/* The error of mip-mapping without weights on a sun, which is the reason for the weights. */
static void plain_means_lose_light(void **state)
{
    (void)state;
    for (int layout = 0; layout < TL_LAYOUT_COUNT; layout++) {
        struct tl_mip_levels levels = tl_mip_levels_create((enum tl_layout)layout, 16);
        double worst = 0;
        for (size_t i = 0; i < count_of(&levels, 1); i++) {
            size_t width = (size_t)levels.maps[0].width,
                   first = 2 * (i / (width / 2)) * width + 2 * (i % (width / 2));
            for (int k = 0; k < 4; k++) {
                double fine = levels.solid_angles[0][first + (size_t)(k & 1) + (size_t)(k >> 1) * width];
                if (fine > 0)
                    worst = fmax(worst, fabs(levels.solid_angles[1][i] / (4 * fine) - 1));
            }
        }
        print_message("%s: a plain mean of four texels errs by up to %.1f %%\n", tl_layout_names[layout],
                      100 * worst);
        assert_true(layout == TL_LAYOUT_SPHERE || worst > 0.05); /* a ball's are equal but at its rim */
        tl_mip_levels_release(&levels);
    }
}

static vec3s smooth(vec3s d)
{
    return (vec3s){{2 + d.x, 1 + d.y * d.z, 3 + d.z - d.x * d.y}};
}

static tl_cube cube_of(int size, vec3s (*light)(vec3s))
{
    tl_cube cube = tl_cube_create(size);
    for (int i = 0; i < 6 * size * size; i++) {
        vec3s value = light(tl_cube_texel_direction(size, i));
        memcpy(cube.texels + 3 * (size_t)i, value.raw, sizeof value);
    }
    return cube;
}

static mat3s some_turn(void)
{
    mat3s turn = glms_mat3_identity();
    for (int i = 0; i < 3; i++) {
        turn.col[i] = glms_vec3_rotate(turn.col[i], 0.7f, (vec3s){{0.3f, 0.8f, -0.5f}});
    }
    return turn;
}

/* The environment itself, in directions of a turned picture: within the slope times the look-ups' reach, a
 * texel of the source, 2 / 32, on the average over four. Off the sphere the same holds in the direction that
 * the layout names there. */
static void pictures_show_their_directions(void **state)
{
    (void)state;
    tl_cube cube = cube_of(32, smooth);
    struct tl_lobes lobes = {0};
    tl_lobes_make(&lobes, &cube, 1u << TL_EXPONENT_COUNT | 1u << 12);
    mat3s turn = some_turn();
    for (int layout = 0; layout < TL_LAYOUT_COUNT; layout++) {
        struct tl_mip_levels levels = tl_mip_levels_create((enum tl_layout)layout, 32);
        const struct tl_sphere_map *map = &levels.maps[0];
        struct tl_prefiltered_map mirror = tl_prefiltered_map_make(&levels, &lobes, TL_EXPONENT_COUNT, turn);
        struct tl_prefiltered_map glossy = tl_prefiltered_map_make(&levels, &lobes, 12, turn);
        for (int i = 0; i < map->width * map->height; i++) {
            int column = i % map->width, row = i / map->width;
            vec3s d = glms_mat3_mulv(turn, tl_layout_direction(map, column + 0.5, row + 0.5));
            vec3s expected = smooth(d);
            vec3s lobe = tl_lobes_fetch(&lobes, d, (struct tl_exponent_blend){.index = 12});
            double across = 2 * (column + 0.5) / map->width - 1, down = 2 * (row + 0.5) / map->height - 1;
            /* texels near a ball's rim reach far over the sphere */
            double reach = layout == TL_LAYOUT_SPHERE && hypot(across, down) > 0.9 ? 1.5 : 0.07;
            for (int c = 0; c < 3; c++) {
                assert_near(mirror.texels[0][4 * i + c], expected.raw[c], reach);
                assert_near(glossy.texels[0][4 * i + c], lobe.raw[c], 1e-6);
            }
        }
        tl_prefiltered_map_release(&mirror);
        tl_prefiltered_map_release(&glossy);
        tl_mip_levels_release(&levels);
    }
    tl_lobes_release(&lobes);
    tl_cube_release(&cube);
}

static vec3s patch(vec3s d)
{
    bool lit = glms_vec3_dot(d, glms_vec3_normalize((vec3s){{0.3f, 1, 0.2f}})) > 0.985f;
    return lit ? (vec3s){{20, 15, 10}} : (vec3s){{0.1f, 0.1f, 0.2f}};
}

/* Sampling is not exact: a lamp of some 100 texels keeps its power within 1 %, a sun of one texel only within
 * 3 %; conversions of files (env/convert.h) keep both exactly. */
static void prefiltered_power(void **state)
{
    (void)state;
    tl_cube lamp = cube_of(64, patch), sun = tl_cube_create(64);
    sun.texels[(size_t)3 * (2 * 64 * 64 + 20 * 64 + 13)] = 1e5f;
    struct tl_lobes lobes[2] = {{0}};
    const tl_cube *cubes[2] = {&lamp, &sun};
    for (int i = 0; i < 2; i++)
        tl_lobes_make(&lobes[i], cubes[i], 1u << TL_EXPONENT_COUNT);
    for (int layout = 0; layout < TL_LAYOUT_COUNT; layout++) {
        struct tl_mip_levels levels =
            tl_mip_levels_create((enum tl_layout)layout, layout == TL_LAYOUT_CUBE ? 64 : 128);
        double off[2];
        for (int i = 0; i < 2; i++) {
            struct tl_prefiltered_map picture =
                tl_prefiltered_map_make(&levels, &lobes[i], TL_EXPONENT_COUNT, glms_mat3_identity());
            double expected = 0;
            for (int k = 0; k < 6 * 64 * 64; k++)
                expected += (double)cubes[i]->texels[3 * (size_t)k] *
                            (double)tl_cube_solid_angle(64, k % 64, k / 64 % 64);
            off[i] = power(&levels, 0, picture.texels[0], 0) / expected - 1;
            tl_prefiltered_map_release(&picture);
        }
        print_message("%s: power poured, lamp %+.2f %%, one texel %+.1f %%\n", tl_layout_names[layout],
                      100 * off[0], 100 * off[1]);
        assert_true(fabs(off[0]) < 0.01);
        assert_true(fabs(off[1]) < 0.03);
        tl_mip_levels_release(&levels);
    }
    for (int i = 0; i < 2; i++)
        tl_lobes_release(&lobes[i]);
    tl_cube_release(&lamp);
    tl_cube_release(&sun);
}

static void threads_change_no_bit(void **state)
{
    (void)state;
    tl_cube cube = cube_of(16, smooth);
    struct tl_lobes lobes = {0};
    tl_lobes_make(&lobes, &cube, 1u << TL_EXPONENT_COUNT);
    struct tl_mip_levels levels = tl_mip_levels_create(TL_LAYOUT_PARABOLOID, 32);
    int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    struct tl_prefiltered_map alone =
        tl_prefiltered_map_make(&levels, &lobes, TL_EXPONENT_COUNT, some_turn());
    omp_set_num_threads(3);
    struct tl_prefiltered_map together =
        tl_prefiltered_map_make(&levels, &lobes, TL_EXPONENT_COUNT, some_turn());
    omp_set_num_threads(threads);
    for (int level = 0; level < levels.count; level++)
        assert_memory_equal(alone.texels[level], together.texels[level],
                            4 * sizeof(float) * count_of(&levels, level));
    tl_prefiltered_map_release(&alone);
    tl_prefiltered_map_release(&together);
    tl_mip_levels_release(&levels);
    tl_lobes_release(&lobes);
    tl_cube_release(&cube);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solid_angles_of_levels),
        cmocka_unit_test(a_constant_stays_constant),
        cmocka_unit_test(a_sun_anywhere_keeps_its_power),
        cmocka_unit_test(paraboloids_weigh_as_equation_6),
        cmocka_unit_test(plain_means_lose_light),
        cmocka_unit_test(pictures_show_their_directions),
        cmocka_unit_test(prefiltered_power),
        cmocka_unit_test(threads_change_no_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
