/* Packed texels against the fetch that defines maps on the CPU (render/gpu/map_texture.h), for every kind of
 * image, and against numbers worked out by hand. */
#include "render/shade/texels.h"

#include "tests/testing.h"

#include "config/base/memory.h"
#include "render/reference/random.h"

#include <math.h>
#include <string.h>

#define FETCHES 4000

/* Of floats: rounding of a bilinear mean of values up to the range's size, at places up to 4 maps away. */
#define ROUNDING 2e-5
/* Of words: half a step of 65535 besides. */
#define HALF_STEP (0.5 / 65535)

struct image_case {
    const char *name;
    int width, height, channels;
    enum tl_image_type type;
    bool colour, linear; /* as packed; as the image states */
    float low, high;     /* of the values of floats */
    bool is_float;       /* expected */
};

static const struct image_case cases[] = {
    {"sRGB", 64, 32, 3, TL_IMAGE_U8, true, false, 0, 1, false},
    {"sRGB and alpha, odd", 37, 53, 4, TL_IMAGE_U8, true, false, 0, 1, false},
    {"grey", 16, 16, 1, TL_IMAGE_U8, true, false, 0, 1, false},
    {"grey and alpha", 9, 5, 2, TL_IMAGE_U8, true, false, 0, 1, false},
    {"colour, linear bytes", 21, 8, 3, TL_IMAGE_U8, true, true, 0, 1, false},
    {"data", 31, 64, 3, TL_IMAGE_U8, false, false, 0, 1, false},
    {"data, one channel", 40, 7, 1, TL_IMAGE_U8, false, false, 0, 1, false},
    {"floats", 33, 20, 4, TL_IMAGE_F32, false, false, -3, 2, true},
    {"floats, two channels", 1, 11, 2, TL_IMAGE_F32, false, false, 0.2f, 0.4f, true},
    {"large floats", 701, 400, 4, TL_IMAGE_F32, false, false, -3, 2, false},
    {"large floats, three channels", 513, 513, 3, TL_IMAGE_F32, true, false, 0.5f, 7, false},
};

static float random_in(struct tl_random *random, float low, float high)
{
    return low + (high - low) * (float)tl_random_unit(random);
}

static tl_image image_of(const struct image_case *item, struct tl_random *random)
{
    tl_image image = tl_image_create(item->width, item->height, item->channels, item->type);
    image.linear = item->linear;
    size_t count = (size_t)item->width * (size_t)item->height * (size_t)item->channels;
    for (size_t i = 0; i < count; i++) {
        float value = random_in(random, item->low, item->high);
        if (item->type == TL_IMAGE_F32)
            tl_image_floats(&image)[i] = value;
        else
            tl_image_bytes(&image)[i] = (uint8_t)(value * 255.99f);
    }
    return image;
}

static double difference(const struct tl_texels *texels, const struct tl_map_texture *map, float level,
                         struct tl_random *random)
{
    const float u = random_in(random, -2, 3), v = random_in(random, -2, 3);
    bool clamp_u = random_in(random, 0, 1) < 0.5f, clamp_v = random_in(random, 0, 1) < 0.5f;
    const struct tl_footprint at = {.uv = {{u, v}}, .across = {{exp2f(level) / (float)map->widths[0], 0}}};
    vec4s expected = tl_map_texture_fetch(map, &at, clamp_u, clamp_v);
    tl_quad value = tl_texels_fetch(texels, u, v, level, clamp_u, clamp_v);
    double largest = 0;
    for (int c = 0; c < 4; c++)
        largest = fmax(largest, fabs((double)value[c] - (double)expected.raw[c]));
    return largest;
}

static void test_fetches_are_those_of_the_map(void **state)
{
    (void)state;
    struct tl_random random = tl_random_begin(18, 0);
    for (size_t k = 0; k < TL_COUNT(cases); k++) {
        const struct image_case *item = &cases[k];
        tl_image image = image_of(item, &random);
        struct tl_map_texture map = tl_map_texture_make(&image, item->colour);
        struct tl_texels texels = tl_texels_make(&image, item->colour);
        double range = fmax((double)item->high, 1) - fmin((double)item->low, 0), largest = 0;
        double allowed = range * (ROUNDING + (item->is_float ? 0 : HALF_STEP));
        assert_int_equal(texels.is_float, item->is_float);
        assert_int_equal(texels.level_count, map.level_count);
        for (int i = 0; i < FETCHES; i++) {
            float level = random_in(&random, 0, (float)map.level_count + 1);
            if (i % 4 == 0)
                level = floorf(level);
            largest = fmax(largest, difference(&texels, &map, level, &random));
        }
        printf("%-30s largest difference %.2e of %.0f\n", item->name, largest, range);
        assert_near(largest, 0, allowed);
        tl_texels_release(&texels);
        tl_map_texture_release(&map);
        tl_image_release(&image);
    }
}

/* Both fetches read what one function decodes and averages, so a few numbers stand by themselves. */
static void test_bytes_are_decoded(void **state)
{
    (void)state;
    tl_image image = tl_image_create(2, 1, 3, TL_IMAGE_U8);
    const uint8_t bytes[6] = {188, 255, 0, 0, 255, 0};
    memcpy(image.texels, bytes, sizeof bytes);
    struct tl_texels colour = tl_texels_make(&image, true), data = tl_texels_make(&image, false);
    const double linear = pow((188.0 / 255 + 0.055) / 1.055, 2.4), share = 188.0 / 255;
    assert_near(tl_texels_fetch(&colour, 0.25f, 0.5f, 0, true, true)[0], linear, 2e-5);
    assert_near(tl_texels_fetch(&colour, 0.5f, 0.5f, 0, true, true)[0], linear / 2, 2e-5);
    assert_near(tl_texels_mean(&colour)[0], linear / 2, 2e-5);
    assert_near(tl_texels_fetch(&data, 0.25f, 0.5f, 0, true, true)[0], share, 2e-5);
    assert_near(tl_texels_mean(&data)[0], share / 2, 2e-5);
    assert_near(tl_texels_mean(&data)[1], 1, 2e-5);
    assert_near(tl_texels_mean(&data)[3], 1, 2e-5);
    /* 1/8 of a map from the left edge lies half a texel's width from both first centres when it repeats. */
    assert_near(tl_texels_fetch(&data, 0, 0.5f, 0, false, true)[0], share / 2, 2e-5);
    assert_near(tl_texels_fetch(&data, 0, 0.5f, 0, true, true)[0], share, 2e-5);
    tl_texels_release(&colour);
    tl_texels_release(&data);
    tl_image_release(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_fetches_are_those_of_the_map),
                                       cmocka_unit_test(test_bytes_are_decoded)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
