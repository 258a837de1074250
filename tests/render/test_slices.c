#include "render/pem/slices.h"

#include "render/pem/lobe.h"
#include "render/pem/lobe_error.h"

#include "testing.h"

#include <string.h>
#include <time.h>

#define SIZE      128
#define EXPONENTS ((1u << TL_EXPONENT_COUNT) - 1)

static double cpu_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static vec3s probe_direction(int i, int count)
{
    float y = 1 - 2 * ((float)i + 0.5f) / (float)count, phi = (float)i * 2.39996323f,
          radius = sqrtf(1 - y * y);
    return (vec3s){{radius * cosf(phi), y, radius * sinf(phi)}};
}

static tl_cube even_cube(int size, float radiance)
{
    tl_cube cube = tl_cube_create(size);
    for (int i = 0; i < 18 * size * size; i++)
        cube.texels[i] = radiance;
    return cube;
}

/* One lit texel in each of the regions of an even sky, somewhere in it: the rest keeps just enough light for
 * the region to be what it is. */
#define FAINT 1e-5f
static int source_texel(const struct tl_regions *regions, int region, int round)
{
    uint32_t first = regions->first[region], count = regions->first[region + 1] - first;
    /* The first and the last along the curve are corners of the region. */
    const uint32_t places[] = {0, count - 1, count / 2, count / 3, 2 * count / 3};
    return (int)regions->texels[first + places[(round + region) % 5]];
}

static vec3s texel_direction(int size, int texel)
{
    return glms_vec3_normalize(tl_cube_direction(texel / (size * size),
                                                 ((float)(texel % size) + 0.5f) / (float)size,
                                                 ((float)(texel / size % size) + 0.5f) / (float)size));
}

struct shown {
    const struct tl_slices *slices;
    int region;
    struct tl_exponent_blend blend;
};

static double show(const void *filter, vec3s direction)
{
    const struct shown *shown = filter;
    return (double)tl_slices_fetch(shown->slices, shown->region, direction, shown->blend).x;
}

static struct tl_regions regions;
static struct tl_slices slices;

static float step_exponent(int step, int steps)
{
    return powf(1024, (float)step / (float)(steps - 1));
}

#define STEPS 61
static void lobes_of_one_texel(void **state)
{
    (void)state;
    double worst[STEPS] = {0}, mean[STEPS] = {0}, low = 2, high = 0;
    int sources = 0, rounds = getenv("ROUNDS") ? atoi(getenv("ROUNDS")) : 1;
    int count = getenv("N") ? atoi(getenv("N")) : 24;
    tl_cube even = even_cube(SIZE, 1);
    tl_regions_cut_sphere(&even, count, &regions);
    tl_cube_release(&even);
    for (int round = 0; round < rounds; round++) {
        tl_cube cube = even_cube(SIZE, FAINT);
        for (int i = 0; i < regions.count; i++) {
            int texel = source_texel(&regions, i, round);
            struct tl_lobe_source source = tl_lobe_source(SIZE, texel_direction(SIZE, texel));
            assert_int_equal(source.texel, texel);
            memcpy(cube.texels + 3 * texel, source.power.raw, sizeof source.power.raw);
        }
        tl_slices_make(&slices, &cube, &regions, EXPONENTS);
        for (int i = 0; i < regions.count; i++, sources++) {
            struct tl_lobe_source source =
                tl_lobe_source(SIZE, texel_direction(SIZE, source_texel(&regions, i, round)));
            for (int step = 0; step < STEPS; step++) {
                float s = step_exponent(step, STEPS);
                struct shown shown = {&slices, i, tl_exponent_blend(s)};
                struct tl_lobe_error error = tl_lobe_measure(&source, s, show, &shown);
                worst[step] = fmax(worst[step], error.error);
                mean[step] += error.error;
                low = fmin(low, error.energy);
                high = fmax(high, error.energy);
            }
        }
        tl_slices_release(&slices);
        tl_cube_release(&cube);
    }
    for (int step = 0; step < STEPS; step++)
        printf("s = %7.2f: mean %.2f %%, worst %.2f %%\n", (double)step_exponent(step, STEPS),
               100 * mean[step] / sources, 100 * worst[step]);
    printf("energy %.4f to %.4f\n", low, high);
    for (int step = 0; step < STEPS; step++)
        assert_true(worst[step] <= 0.035);
    assert_true(low >= 0.99 && high <= 1.01);
    tl_regions_release(&regions);
}

/* A sky, a ground and a small lamp, with noise. */
static tl_cube noise_cube(int size)
{
    tl_cube cube = tl_cube_create(size);
    for (int i = 0; i < 6 * size * size; i++) {
        vec3s d = texel_direction(size, i);
        float noise = (float)(((uint32_t)i * 2654435761u) >> 16) / 65536;
        float lamp = glms_vec3_dot(d, (vec3s){{0.6f, 0.64f, 0.48f}}) > 0.99f ? 30 : 0;
        cube.texels[3 * i] = noise + lamp;
        cube.texels[3 * i + 1] = noise * (1.5f + d.y) + lamp;
        cube.texels[3 * i + 2] = noise * (1.2f - d.x);
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

static void regions_sum_to_the_whole(void **state)
{
    (void)state;
    tl_cube cube = noise_cube(64);
    struct tl_lobes lobes = {0};
    tl_lobes_make(&lobes, &cube, EXPONENTS);
    for (int count = 6; count <= 384; count *= 4) {
        tl_regions_cut_sphere(&cube, count, &regions);
        tl_slices_make(&slices, &cube, &regions, EXPONENTS);
        double worst = 0;
        for (int k = 0; k < TL_EXPONENT_COUNT; k++) {
            double peak = peak_of(&lobes.maps[k]), before = worst;
            for (int probe = 0; probe < 200; probe++) {
                vec3s direction = probe_direction(probe, 200), sum = {{0, 0, 0}};
                for (int i = 0; i < regions.count; i++)
                    sum = glms_vec3_add(
                        sum, tl_slices_fetch(&slices, i, direction, (struct tl_exponent_blend){k, 0}));
                vec3s whole = tl_lobes_fetch(&lobes, direction, (struct tl_exponent_blend){k, 0});
                for (int c = 0; c < 3; c++)
                    worst = fmax(worst, fabs((double)(sum.raw[c] - whole.raw[c])) / peak);
            }
            if (worst > before) printf("k %d worst %.4f\n", k, worst);
        }
        printf("N = %d: worst %.4f\n", count, worst);
        assert_true(worst < 0.02);
        tl_slices_release(&slices);
        tl_regions_release(&regions);
    }
    tl_lobes_release(&lobes);
    tl_cube_release(&cube);
}

static void times(void **state)
{
    (void)state;
    tl_cube cube = noise_cube(SIZE);
    const int counts[] = {6, 24, 96, 192, 384};
    for (int i = 0; i < 5; i++) {
        tl_regions_cut_sphere(&cube, counts[i], &regions);
        double start = cpu_ms();
        tl_slices_make(&slices, &cube, &regions, 1u | 3u << 8);
        double few = cpu_ms() - start, bytes = (double)tl_slices_bytes(&slices);
        start = cpu_ms();
        tl_slices_make(&slices, &cube, &regions, EXPONENTS);
        printf("N = %d: s = 1 and two %.1f ms, %.1f kB a region; all %.1f ms, %.1f kB; sides", regions.count,
               few, bytes / 1e3 / regions.count, cpu_ms() - start,
               (double)tl_slices_bytes(&slices) / 1e3 / regions.count);
        for (int k = 0; k < TL_EXPONENT_COUNT; k++)
            printf(" %d", slices.side[k]);
        printf("\n");
        tl_slices_release(&slices);
        tl_regions_release(&regions);
    }
    tl_cube_release(&cube);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lobes_of_one_texel),
        cmocka_unit_test(regions_sum_to_the_whole),
        cmocka_unit_test(times),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
