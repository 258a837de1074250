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

/* A sky, a ground and a small lamp, with noise. */
static tl_cube noise_cube(int size)
{
    tl_cube cube = tl_cube_create(size);
    for (int i = 0; i < 6 * size * size; i++) {
        vec3s d = tl_cube_direction(i / (size * size), ((float)(i % size) + 0.5f) / (float)size,
                                    ((float)(i / size % size) + 0.5f) / (float)size);
        d = glms_vec3_normalize(d);
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
        static struct tl_regions regions;
        static struct tl_slices slices;
        regions = (struct tl_regions){0};
        slices = (struct tl_slices){0};
        tl_regions_cut_sphere(&cube, count, &regions);
        tl_slices_make(&slices, &cube, &regions, EXPONENTS);
        double worst = 0;
        for (int k = 0; k < TL_EXPONENT_COUNT; k += 1) {
            double peak = peak_of(&lobes.maps[k]);
            double before = worst;
            for (int probe = 0; probe < 200; probe++) {
                vec3s direction = probe_direction(probe, 200), sum = {{0, 0, 0}};
                for (int i = 0; i < regions.count; i++)
                    sum = glms_vec3_add(
                        sum, tl_slices_fetch(&slices, i, direction, (struct tl_exponent_blend){k, 0}));
                vec3s whole = tl_lobes_fetch(&lobes, direction, (struct tl_exponent_blend){k, 0});
                for (int c = 0; c < 3; c++)
                    worst = fmax(worst, (fabs((double)(sum.raw[c] - whole.raw[c])) - 3e-4 * peak) /
                                            (double)whole.raw[c]);
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
        static struct tl_regions regions;
        static struct tl_slices slices;
        regions = (struct tl_regions){0};
        slices = (struct tl_slices){0};
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
        cmocka_unit_test(regions_sum_to_the_whole),
        cmocka_unit_test(times),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
