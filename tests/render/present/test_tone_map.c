/* Tone mapping on the CPU against Khronos's definition of PBR Neutral and IEC 61966-2-1's of sRGB, in double,
 * at sizes that are no multiple of a tile's. */
#include "render/present/tone_map.h"

#include "config/base/memory.h"
#include "render/env/from_environment.h"
#include "tests/testing.h"

#include <stdlib.h>
#include <string.h>

static double encoded(double linear)
{
    linear = fmin(fmax(linear, 0), 1);
    return 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055);
}

/* github.com/KhronosGroup/ToneMapping, PBR_Neutral: pbrNeutral.glsl. */
static void pbr_neutral(double colour[3])
{
    const double start = 0.8 - 0.04, desaturation = 0.15;
    double minimum = fmin(colour[0], fmin(colour[1], colour[2]));
    double offset = minimum < 0.08 ? minimum - 6.25 * minimum * minimum : 0.04;
    for (int c = 0; c < 3; c++)
        colour[c] -= offset;
    double peak = fmax(colour[0], fmax(colour[1], colour[2]));
    if (peak < start)
        return;
    double d = 1 - start, new_peak = 1 - d * d / (peak + d - start);
    double grey = 1 - 1 / (desaturation * (peak - new_peak) + 1);
    for (int c = 0; c < 3; c++)
        colour[c] = (1 - grey) * colour[c] * new_peak / peak + grey * new_peak;
}

/* What a texel should look like over `behind`. */
static void expect(const float *texel, const double behind[3], bool is_light, vec3s exposure, double shown[3])
{
    double open = 1 - fmin(fmax((double)texel[3], 0), 1);
    for (int c = 0; c < 3; c++)
        shown[c] = (is_light ? (double)exposure.raw[c] : 1) * (double)texel[c] + open * behind[c];
    if (is_light)
        pbr_neutral(shown);
    for (int c = 0; c < 3; c++)
        shown[c] = encoded(shown[c]);
}

static float random_share(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (float)(*seed >> 8) / (float)(1 << 24);
}

/* Dark and bright light over six decades; covered, open and half open. */
static float *random_texels(int count)
{
    float *texels = tl_alloc_lines(4 * (size_t)count, sizeof *texels);
    uint32_t seed = 7;
    for (int i = 0; i < count; i++) {
        float scale = powf(10, 6 * random_share(&seed) - 4), cover = floorf(3 * random_share(&seed)) / 2;
        for (int c = 0; c < 3; c++)
            texels[4 * i + c] = cover * scale * random_share(&seed);
        texels[4 * i + 3] = cover;
    }
    return texels;
}

static void expect_bytes(const struct tl_tone_map_request *request, const double *behind, bool is_each,
                         const uint8_t *bytes)
{
    const size_t count = (size_t)request->width * (size_t)request->height;
    for (size_t i = 0; i < count; i++) {
        double shown[3];
        expect(request->texels + 4 * i, is_each ? behind + 3 * i : behind, request->is_light,
               request->exposure, shown);
        for (size_t c = 0; c < 3; c++)
            assert_near((double)bytes[4 * i + c], shown[c], 0.57); /* rounding, and a table's */
        assert_int_equal(bytes[4 * i + 3], 255);
    }
}

static void test_formulas(void **state)
{
    (void)state;
    struct tl_encoding encoding;
    tl_encoding_make(&encoding);
    const int sizes[][2] = {{1, 1}, {31, 3}, {32, 4}, {33, 5}, {200, 17}};
    for (size_t i = 0; i < TL_COUNT(sizes); i++)
        for (int is_light = 0; is_light < 2; is_light++) {
            int width = sizes[i][0], height = sizes[i][1];
            float *texels = random_texels(width * height);
            uint8_t *bytes = TL_NEW_ARRAY(uint8_t, 4 * (size_t)width * (size_t)height);
            const struct tl_tone_map_request request = {.encoding = &encoding,
                                                        .texels = texels,
                                                        .width = width,
                                                        .height = height,
                                                        .end_column = width,
                                                        .is_light = is_light,
                                                        .exposure = {{0.7f, 1.1f, 0.4f}}};
            const double grey[] = {0.18, 0.18, 0.18}, dark[] = {0.03, 0.03, 0.03};
            tl_tone_map(&request, bytes);
            expect_bytes(&request, is_light ? grey : dark, false, bytes);
            free(texels);
            free(bytes);
        }
}

/* Every float that a byte can come from, by all exponents and by mantissas between the table's steps. */
static void test_encoding(void **state)
{
    (void)state;
    struct tl_encoding encoding;
    tl_encoding_make(&encoding);
    enum { COUNT = 1 << 16 };
    float *texels = tl_alloc_lines((size_t)4 * COUNT, sizeof *texels);
    for (int i = 0; i < COUNT; i++) {
        for (int c = 0; c < 3; c++)
            texels[4 * i + c] = exp2f(1.5f - 18.0f * (float)(3 * i + c) / (3 * COUNT));
        texels[4 * i + 3] = 1;
    }
    memset(texels, 0, 3 * sizeof *texels);
    uint8_t *bytes = TL_NEW_ARRAY(uint8_t, (size_t)4 * COUNT);
    const struct tl_tone_map_request request = {
        .encoding = &encoding, .texels = texels, .width = 256, .height = 256, .end_column = 256};
    const double dark[] = {0.03, 0.03, 0.03};
    tl_tone_map(&request, bytes);
    expect_bytes(&request, dark, false, bytes);
    assert_int_equal(bytes[0], 0);
    free(texels);
    free(bytes);
}

static void fill_smooth(tl_environment *environment)
{
    for (int y = 0; y < environment->image.height; y++)
        for (int x = 0; x < environment->image.width; x++) {
            size_t number = (size_t)y * (size_t)environment->image.width + (size_t)x;
            float *texel = tl_image_floats(&environment->image) + 3 * number;
            texel[0] = 0.2f + 0.1f * sinf(0.2f * (float)x);
            texel[1] = 0.01f * (float)y;
            texel[2] = 0.3f;
        }
}

/* What is behind each pixel of a view that is turned, by the look-up of one direction. */
static void list_behind(const struct tl_behind_request *view, vec3s exposure, double *behind)
{
    for (int y = 0; y < view->height; y++)
        for (int x = 0; x < view->width; x++) {
            float u = 2 * ((float)x + 0.5f) / (float)view->width - 1,
                  v = 2 * ((float)y + 0.5f) / (float)view->height - 1;
            vec3s world = glms_vec3_add(
                view->forward, glms_vec3_add(glms_vec3_scale(view->right, u), glms_vec3_scale(view->up, v)));
            vec3s seen =
                tl_environment_sample(view->environment, tl_turn_direction(world, -view->environment_yaw));
            for (int c = 0; c < 3; c++)
                behind[3 * (y * view->width + x) + c] = (double)(exposure.raw[c] * seen.raw[c]);
        }
}

/* The environment is seen behind, for the camera and the revision of each request, whatever was kept. */
static void test_behind(void **state)
{
    (void)state;
    struct tl_encoding encoding;
    struct tl_behind behind = {0};
    tl_encoding_make(&encoding);
    tl_environment environment = tl_environment_constant(0, 0, 0);
    tl_image_release(&environment.image);
    environment.image = tl_image_create(64, 32, 3, TL_IMAGE_F32);
    fill_smooth(&environment);
    int width = 75, height = 42;
    float *texels = random_texels(width * height);
    uint8_t *bytes = TL_NEW_ARRAY(uint8_t, 4 * (size_t)width * (size_t)height);
    double *expected = TL_NEW_ARRAY(double, 3 * (size_t)width * (size_t)height);
    struct tl_behind_request view = {.forward = {{0.3f, 0.2f, -1}},
                                     .right = {{0.6f, 0, 0.18f}},
                                     .up = {{0, 0.4f, 0.08f}},
                                     .environment = &environment,
                                     .width = width,
                                     .height = height};
    struct tl_tone_map_request request = {.encoding = &encoding,
                                          .texels = texels,
                                          .width = width,
                                          .height = height,
                                          .end_column = width,
                                          .is_light = true,
                                          .exposure = {{1.3f, 0.8f, 2}},
                                          .behind = &behind};
    for (int change = 0; change < 6; change++) {
        if (change == 2)
            view.environment_yaw = 0.4f;
        if (change == 3)
            view.forward.y = -0.1f;
        if (change == 4)
            view.up.z = 0.1f;
        if (change == 5) {
            tl_image_floats(&environment.image)[0] = 5;
            memset(environment.image.texels, 0, sizeof(float) * 3 * 64 * 20);
            view.revision++;
        }
        if (change == 1) /* other pixels of the same tiles are open */
            for (int i = 0; i < width * height; i++)
                texels[4 * i + 3] = texels[4 * i + 3] > 0 ? 0.0f : 1.0f;
        list_behind(&view, request.exposure, expected);
        tl_behind_begin(&behind, &view);
        tl_tone_map(&request, bytes);
        expect_bytes(&request, expected, true, bytes);
    }
    tl_behind_release(&behind);
    tl_environment_release(&environment);
    free(expected);
    free(texels);
    free(bytes);
}

/* Columns that are not asked for stay as they are, but for those of the tiles at both ends. */
static void test_columns(void **state)
{
    (void)state;
    struct tl_encoding encoding;
    tl_encoding_make(&encoding);
    int width = 8 * TL_BEHIND_COLUMNS, first = 2 * TL_BEHIND_COLUMNS + 5, end = 5 * TL_BEHIND_COLUMNS + 1;
    float *texels = random_texels(width);
    uint8_t *bytes = TL_NEW_ARRAY(uint8_t, 4 * (size_t)width);
    const struct tl_tone_map_request request = {.encoding = &encoding,
                                                .texels = texels,
                                                .width = width,
                                                .height = 1,
                                                .first_column = first,
                                                .end_column = end,
                                                .is_light = true,
                                                .exposure = {{1, 1, 1}}};
    tl_tone_map(&request, bytes);
    for (int x = 0; x < width; x++) {
        bool is_inside = x >= first && x < end;
        bool is_outside = x < 2 * TL_BEHIND_COLUMNS || x >= 6 * TL_BEHIND_COLUMNS;
        if (is_inside || is_outside)
            assert_int_equal(bytes[4 * x + 3], is_inside ? 255 : 0);
    }
    free(texels);
    free(bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_formulas),
        cmocka_unit_test(test_encoding),
        cmocka_unit_test(test_behind),
        cmocka_unit_test(test_columns),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
