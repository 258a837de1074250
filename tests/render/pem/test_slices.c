#include "render/pem/slices.h"

#include "render/pem/lobe_error.h"

#include "tests/testing.h"

#include <omp.h>
#include <string.h>

/* Every third exponent, an octave apart, and the environment itself. */
#define OCTAVES 0xc9249249u

static struct tl_regions regions;
static struct tl_slices slices;

static struct tl_exponent_blend node(int i)
{
    return (struct tl_exponent_blend){i, 0};
}

/* A sky, a ground, noise and a lamp. */
static tl_cube room(int size)
{
    tl_cube cube = tl_cube_create(size);
    for (int i = 0; i < 6 * size * size; i++) {
        vec3s d =
            glms_vec3_normalize(tl_cube_direction(i / (size * size), ((float)(i % size) + 0.5f) / (float)size,
                                                  ((float)(i / size % size) + 0.5f) / (float)size));
        float noise = (float)(((uint32_t)i * 2654435761u) >> 16) / 65536;
        float lamp = glms_vec3_dot(d, (vec3s){{0.6f, 0.64f, 0.48f}}) > 0.99f ? 30 : 0;
        float *texel = cube.texels + 3 * (size_t)i;
        texel[0] = noise + lamp;
        texel[1] = noise * (1.5f + d.y) + lamp;
        texel[2] = noise * (1.2f - d.x);
    }
    return cube;
}

static double peak_of(const struct tl_lobe_map *map)
{
    double peak = 0;
    for (int i = 0; i < 4 * (map->side + 2) * (map->side + 2); i++)
        peak = fmax(peak, (double)map->texels[i]);
    return peak;
}

/* All regions together against the whole, which is filtered on maps of another kind: what both lose to
 * interpolation (less than 1 % of a lobe each), and to the crop. Relative to the peak, for a lamp's tail is
 * more than the light around it. */
static void sums_are_the_whole(const tl_cube *cube, const struct tl_lobes *lobes)
{
    tl_slices_make(&slices, cube, &regions, OCTAVES);
    double worst = 0;
    for (int k = 0; k < TL_EXPONENT_COUNT; k += 3) {
        double peak = peak_of(&lobes->maps[k]);
        for (int probe = 0; probe < 100; probe++) {
            vec3s direction = tl_lobe_probe(probe, 100), sum = {{0, 0, 0}};
            for (int i = 0; i < regions.count; i++)
                sum = glms_vec3_add(sum, tl_slices_fetch(&slices, i, direction, node(k)));
            vec3s whole = tl_lobes_fetch(lobes, direction, node(k));
            for (int c = 0; c < 3; c++)
                worst = fmax(worst, fabs((double)(sum.raw[c] - whole.raw[c])) / peak);
        }
    }
    printf("%d regions: their sum differs from the whole by up to %.2f %% of the peak\n", regions.count,
           100 * worst);
    assert_true(worst < 0.012);
    tl_slices_release(&slices);
    tl_regions_release(&regions);
}

static void regions_sum_to_the_whole(void **state)
{
    (void)state;
    tl_cube cube = room(64);
    struct tl_lobes lobes = {0};
    tl_lobes_make(&lobes, &cube, OCTAVES);
    const int counts[] = {6, 96, 384};
    for (int i = 0; i < 3; i++) {
        tl_regions_cut_sphere(&cube, counts[i], &regions);
        sums_are_the_whole(&cube, &lobes);
    }
    tl_regions_cut(&cube, 96, &regions);
    sums_are_the_whole(&cube, &lobes);
    tl_lobes_release(&lobes);
    tl_cube_release(&cube);
}

/* A furnace in parts: every region's P is positive, their sum 1, for every exponent; opposite to a region
 * there is nothing of it. */
static void a_uniform_sky_sums_to_one(void **state)
{
    (void)state;
    tl_cube cube = tl_cube_create(64);
    for (int i = 0; i < 18 * 64 * 64; i++)
        cube.texels[i] = 1;
    tl_regions_cut_sphere(&cube, 48, &regions);
    tl_slices_make(&slices, &cube, &regions, OCTAVES);
    for (int k = 0; k < TL_EXPONENT_COUNT; k += 3) {
        for (int probe = 0; probe < 100; probe++) {
            double sum = 0;
            for (int i = 0; i < regions.count; i++) {
                double part = (double)tl_slices_fetch(&slices, i, tl_lobe_probe(probe, 100), node(k)).x;
                assert_true(part >= 0 && part < 1.01);
                sum += part;
            }
            assert_near(sum, 1, 0.01); /* as test_lobes.c's even sky, and what crops lose: 3e-4 a lobe */
        }
    }
    for (int region = 0; region < regions.count; region++) {
        vec3s away = glms_vec3_negate(slices.frames[region].direction);
        assert_near(tl_slices_fetch(&slices, region, away, node(18)).y, 0, 0);
        assert_near(tl_slices_fetch(&slices, region, away, node(30)).y, 0, 0);
    }
    tl_slices_release(&slices);
    tl_regions_release(&regions);
    tl_cube_release(&cube);
}

/* Nothing is cut off: the energy of each slice is the region's power. */
static void slices_keep_their_regions_power(void **state)
{
    (void)state;
    tl_cube cube = room(64);
    tl_regions_cut_sphere(&cube, 24, &regions);
    tl_slices_make(&slices, &cube, &regions, 1u | 1u << 9 | 1u << 18 | 1u << TL_EXPONENT_COUNT);
    enum { GRID = 192 };
    for (int k = 0; k <= TL_EXPONENT_COUNT; k++) {
        if (!(slices.made >> k & 1))
            continue;
        double energies[24] = {0};
        for (int i = 0; i < 6 * GRID * GRID; i++) {
            int face = i / (GRID * GRID), x = i % GRID, y = i / GRID % GRID;
            vec3s d = glms_vec3_normalize(
                tl_cube_direction(face, ((float)x + 0.5f) / GRID, ((float)y + 0.5f) / GRID));
            for (int region = 0; region < regions.count; region++)
                energies[region] += (double)(tl_slices_fetch(&slices, region, d, node(k)).x *
                                             tl_cube_solid_angle(GRID, x, y));
        }
        for (int region = 0; region < regions.count; region++) {
            double power = (double)regions.items[region].power.x;
            /* Error of the region itself: sampling of its border; of a lobe: 3e-4 by the crop. */
            assert_near(energies[region], power, (k == TL_EXPONENT_COUNT ? 0.05 : 0.01) * power);
        }
    }
    tl_slices_release(&slices);
    tl_regions_release(&regions);
    tl_cube_release(&cube);
}

/* The memory that `review` needs for a garment with two glossinesses: 0.15 MB per region, a tenth
 * of the chains of the paper. */
static void slices_are_small(void **state)
{
    (void)state;
    tl_cube cube = room(128);
    const int counts[] = {6, 24, 96, 192, 384};
    for (int i = 0; i < 5; i++) {
        tl_regions_cut_sphere(&cube, counts[i], &regions);
        uint32_t one = tl_exponents_needed(0.95f, 0.95f), two = one | tl_exponents_needed(0.7f, 0.7f);
        tl_slices_make(&slices, &cube, &regions, one);
        double one_kb = (double)tl_slices_bytes(&slices) / 1e3 / regions.count;
        tl_slices_make(&slices, &cube, &regions, two);
        double two_kb = (double)tl_slices_bytes(&slices) / 1e3 / regions.count;
        printf("%3d regions: g = 0.95 %.0f kB a region, with g = 0.7 %.0f kB\n", regions.count, one_kb,
               two_kb);
        assert_true(two_kb <= 150);
        size_t texels = 0;
        for (int k = 0; k <= TL_EXPONENT_COUNT; k++)
            texels += slices.made >> k & 1 ? (size_t)(slices.side[k] * slices.side[k]) : 0;
        assert_int_equal(tl_slices_bytes(&slices), 4 * texels * (size_t)regions.count);
        tl_slices_release(&slices);
        tl_regions_release(&regions);
    }
    tl_cube_release(&cube);
}

static void threads_change_no_bit(void **state)
{
    (void)state;
    tl_cube cube = room(32);
    static struct tl_slices three;
    tl_regions_cut_sphere(&cube, 24, &regions);
    int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    tl_slices_make(&slices, &cube, &regions, OCTAVES);
    omp_set_num_threads(3);
    tl_slices_make(&three, &cube, &regions, OCTAVES & 0xffff);
    tl_slices_make(&three, &cube, &regions, OCTAVES);
    omp_set_num_threads(threads);
    assert_memory_equal(slices.frames, three.frames, 24 * sizeof *slices.frames);
    for (int k = 0; k <= TL_EXPONENT_COUNT; k++)
        if (OCTAVES >> k & 1)
            assert_memory_equal(slices.texels[k], three.texels[k],
                                sizeof(float) * 3 * 24 * (size_t)(slices.side[k] * slices.side[k]));
    tl_slices_release(&slices);
    tl_slices_release(&three);
    tl_regions_release(&regions);
    tl_cube_release(&cube);
}

static void results_are_finite(void **state)
{
    (void)state;
    const float strange[] = {0, INFINITY, NAN, -1, 1e30f, 65504, 0, 1e-40f};
    tl_cube even = tl_cube_create(6), cube = tl_cube_create(6);
    for (int i = 0; i < 18 * 6 * 6; i++) {
        even.texels[i] = 1;
        cube.texels[i] = i < 6 * 6 * 9 ? strange[i % 8] : 0; /* the other half is black */
    }
    tl_regions_cut_sphere(&even, 24, &regions);
    tl_slices_make(&slices, &cube, &regions, OCTAVES);
    const vec3s directions[] = {{{0, 0, 0}}, {{NAN, 0, 1}}, {{0, INFINITY, 0}}, {{0, -1, 0}}};
    for (int k = 0; k <= TL_EXPONENT_COUNT; k++) {
        for (int i = 0; i < regions.count && slices.made >> k & 1; i++) {
            for (int probe = 0; probe < 54; probe++) {
                vec3s d = probe < 4 ? directions[probe] : tl_lobe_probe(probe - 4, 50);
                vec3s got = tl_slices_fetch(&slices, i, d, node(k));
                for (int c = 0; c < 3; c++)
                    assert_true(isfinite(got.raw[c]) && got.raw[c] >= 0);
            }
        }
    }
    tl_slices_release(&slices);
    tl_regions_release(&regions);
    tl_cube_release(&even);
    tl_cube_release(&cube);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(regions_sum_to_the_whole),        cmocka_unit_test(a_uniform_sky_sums_to_one),
        cmocka_unit_test(slices_keep_their_regions_power), cmocka_unit_test(slices_are_small),
        cmocka_unit_test(threads_change_no_bit),           cmocka_unit_test(results_are_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
