#include "render/present/resample.h"

#include "config/base/memory.h"
#include "tests/testing.h"

#include <stdbool.h>

/* An image whose channels are given by the place, in [0, 1] from border to border. */
typedef float shade(float x, float y, int channel);

static float *image_of(int width, int height, shade *at)
{
    float *texels = TL_NEW_ARRAY(float, 4 * (size_t)(width * height));
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 4; c++)
                texels[4 * (y * width + x) + c] =
                    at(((float)x + 0.5f) / (float)width, ((float)y + 0.5f) / (float)height, c);
    return texels;
}

static float *resampled(const float *from, int from_width, int from_height, int width, int height)
{
    struct tl_resample resample = {.from = from,
                                   .from_width = from_width,
                                   .from_height = from_height,
                                   .to = TL_NEW_ARRAY(float, 4 * (size_t)(width * height)),
                                   .to_width = width,
                                   .to_height = height};
    tl_resample(&resample);
    return resample.to;
}

static float constant(float x, float y, int channel)
{
    (void)x, (void)y;
    return 0.25f * (float)(channel + 1);
}

static float ramp(float x, float y, int channel)
{
    return channel == 0 ? x : channel == 1 ? y : channel == 2 ? 1 - x : x + y;
}

static float disc(float x, float y, int channel)
{
    bool inside = (x - 0.5f) * (x - 0.5f) + (y - 0.5f) * (y - 0.5f) < 0.1f;
    return inside ? (channel == 3 ? 1 : 1000) : 0;
}

static const int sizes[][4] = {{7, 5, 16, 16},   {64, 48, 128, 96}, {33, 17, 40, 31}, {50, 40, 25, 30},
                               {61, 47, 40, 33}, {1, 1, 5, 3},      {1, 9, 4, 9},     {64, 64, 8, 9}};

static void constants_stay(void **state)
{
    (void)state;
    for (size_t i = 0; i < TL_COUNT(sizes); i++) {
        const int *s = sizes[i];
        float *from = image_of(s[0], s[1], constant), *to = resampled(from, s[0], s[1], s[2], s[3]);
        for (int k = 0; k < 4 * s[2] * s[3]; k++)
            assert_near(to[k], constant(0, 0, k % 4), 2e-6); /* weights add up to 1, in float */
        free(from);
        free(to);
    }
}

/* Catmull and Rom's cubic reproduces a plane: away from the borders, where samples end, a ramp is a ramp, and
 * nothing is shifted by half a sample. Means over areas do where they end between samples; where one ends at
 * a share f of a sample, that sample's value stands for another place, by f (1 - f) / 2 of a sample at most.
 */
static float tolerance(int from, int to)
{
    bool is_exact = from <= to || from % to == 0;
    return is_exact ? 3e-6f : 0.125f / (float)from;
}

static void ramps_stay_where_they_were(void **state)
{
    (void)state;
    for (size_t i = 0; i < TL_COUNT(sizes); i++) {
        const int *s = sizes[i];
        float *from = image_of(s[0], s[1], ramp), *to = resampled(from, s[0], s[1], s[2], s[3]);
        float *expected = image_of(s[2], s[3], ramp);
        for (int y = 0; y < s[3]; y++)
            for (int x = 0; x < s[2]; x++) {
                float largest = fmaxf(tolerance(s[0], s[2]), tolerance(s[1], s[3]));
                float margin_x = 2.0f / (float)s[0], margin_y = 2.0f / (float)s[1];
                const float *wanted = expected + 4 * ((size_t)y * (size_t)s[2] + (size_t)x);
                bool inside = wanted[0] > margin_x && wanted[0] < 1 - margin_x && wanted[1] > margin_y &&
                              wanted[1] < 1 - margin_y;
                for (int c = 0; inside && c < 4; c++)
                    assert_near(to[4 * (y * s[2] + x) + c], wanted[c], (c == 3 ? 2 : 1) * largest);
            }
        free(from);
        free(to);
        free(expected);
    }
}

/* A bright figure keeps within its own range, coverage within [0, 1]: no dark rims, no halos. */
static void edges_do_not_ring(void **state)
{
    (void)state;
    for (size_t i = 0; i < TL_COUNT(sizes); i++) {
        const int *s = sizes[i];
        float *from = image_of(s[0], s[1], disc), *to = resampled(from, s[0], s[1], s[2], s[3]);
        for (int k = 0; k < s[2] * s[3]; k++) {
            assert_true(to[4 * k + 3] >= 0 && to[4 * k + 3] <= 1 + 1e-6f);
            for (int c = 0; c < 3; c++) /* premultiplied: light and coverage fade together */
                assert_near(to[4 * k + c], 1000 * to[4 * k + 3], 1e-2);
        }
        free(from);
        free(to);
    }
}

/* Downwards, light is neither lost nor won. */
static void areas_keep_their_light(void **state)
{
    (void)state;
    const int s[4] = {61, 47, 40, 33};
    float *from = image_of(s[0], s[1], disc), *to = resampled(from, s[0], s[1], s[2], s[3]);
    double before = 0, after = 0;
    for (int k = 0; k < s[0] * s[1]; k++)
        before += (double)from[4 * (size_t)k] / (s[0] * s[1]);
    for (int k = 0; k < s[2] * s[3]; k++)
        after += (double)to[4 * (size_t)k] / (s[2] * s[3]);
    assert_near(after / before, 1, 1e-5);
    free(from);
    free(to);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constants_stay),
        cmocka_unit_test(ramps_stay_where_they_were),
        cmocka_unit_test(edges_do_not_ring),
        cmocka_unit_test(areas_keep_their_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
