#include "render/env/lobes.h"

#include "render/pem/lobe.h"
#include "render/pem/lobe_error.h"

#include "testing.h"

#include <string.h>
#include <time.h>

#define SIZE 128
#define ALL  (0xffffffffu)

/* Directions spread evenly over the sphere; the first are awkward: poles, edges and corners of the cube. */
static vec3s probe_direction(int i)
{
    static const float awkward[][3] = {{0, 1, 0},      {0, -1, 0},       {1, 0, 0},   {0.02f, 0, -1},
                                       {1, 1, 1},      {-1, -1, 1},      {1, -1, -1}, {1, 1, 0},
                                       {-1, 0.01f, 1}, {0.99f, 0.3f, -1}};
    if (i < (int)(sizeof awkward / sizeof *awkward))
        return glms_vec3_normalize((vec3s){{awkward[i][0], awkward[i][1], awkward[i][2]}});
    float y = 1 - 2 * ((float)i + 0.5f) / 100, phi = (float)i * 2.39996323f, radius = sqrtf(1 - y * y);
    return (vec3s){{radius * cosf(phi), y, radius * sinf(phi)}};
}

struct shown {
    const struct tl_lobes *lobes;
    struct tl_exponent_blend blend;
};

static double show(const void *filter, vec3s direction)
{
    const struct shown *shown = filter;
    return (double)tl_lobes_fetch(shown->lobes, direction, shown->blend).x;
}

static void lobes_of_one_texel(void **state)
{
    (void)state;
    const int steps = 61;
    double worst[64] = {0}, mean[64] = {0}, low = 2, high = 0;
    int probes = getenv("PROBES") ? atoi(getenv("PROBES")) : 12;
    for (int probe = 0; probe < probes; probe++) {
        struct tl_lobe_source source = tl_lobe_source(SIZE, probe_direction(probe));
        tl_cube cube = tl_cube_create(SIZE);
        memcpy(cube.texels + 3 * (size_t)source.texel, source.power.raw, sizeof source.power.raw);
        struct tl_lobes lobes = {0};
        tl_lobes_make(&lobes, &cube, ALL);
        for (int i = 0; i < steps; i++) {
            float s = powf(1024, (float)i / (float)(steps - 1));
            struct shown shown = {&lobes, tl_exponent_blend(s)};
            struct tl_lobe_error error = tl_lobe_measure(&source, s, show, &shown);
            worst[i] = fmax(worst[i], error.error);
            mean[i] += error.error / probes;
            low = fmin(low, error.energy);
            high = fmax(high, error.energy);
        }
        tl_lobes_release(&lobes);
        tl_cube_release(&cube);
    }
    for (int i = 0; i < steps; i++) {
        printf("s = %7.2f: mean %.2f %%, worst %.2f %%\n", pow(1024, (double)i / (steps - 1)), 100 * mean[i],
               100 * worst[i]);
        assert_true(worst[i] <= 0.035);
    }
    printf("energy %.4f to %.4f\n", low, high);
    assert_true(low >= 0.99 && high <= 1.01);
}

static double cpu_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static void times(void **state)
{
    (void)state;
    tl_cube cube = tl_cube_create(SIZE);
    for (size_t i = 0; i < 18 * SIZE * SIZE; i++)
        cube.texels[i] = (float)(((uint32_t)i * 2654435761u) >> 20) / 256;
    struct tl_lobes lobes = {0};
    for (int i = 0; i <= TL_EXPONENT_COUNT; i++) {
        double start = cpu_ms();
        tl_lobes_make(&lobes, &cube, 1u << i);
        printf("%2d s %7.2f: side %d, %.2f ms CPU\n", i, (double)tl_exponent(i), lobes.maps[i].side,
               cpu_ms() - start);
    }
    double start = cpu_ms();
    vec3s sum = {{0, 0, 0}};
    for (int i = 0; i < 1000000; i++)
        sum = glms_vec3_add(
            sum, tl_lobes_fetch(&lobes, probe_direction(10 + i % 90), (struct tl_exponent_blend){8, 0.3f}));
    double half = cpu_ms();
    for (int i = 0; i < 1000000; i++)
        sum = glms_vec3_add(sum, probe_direction(10 + i % 90));
    printf("fetch %.1f ns (%g)\n", (2 * half - start - cpu_ms()), (double)sum.x);
    tl_lobes_release(&lobes);
    tl_cube_release(&cube);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lobes_of_one_texel),
        cmocka_unit_test(times),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
