/* The linear image on either side, by numbers that name their texel: what is read is what the side that made
 * the image holds, whatever the other one held before. */
#include "config/base/memory.h"
#include "render/present/linear_image.h"
#include "tests/testing.h"

#include <epoxy/gl.h>

#include <stdlib.h>

static float value_of(int x, int y, int channel, float image)
{
    return image + (float)(100 * y + 10 * x + channel);
}

static void fill(float *texels, int width, int height, float image)
{
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 4; c++)
                texels[4 * (y * width + x) + c] = value_of(x, y, c, image);
}

static void expect_read(const struct tl_linear_image *linear, int width, int height, float image)
{
    tl_image read;
    tl_linear_image_read(linear, &read);
    assert_int_equal(read.width, width);
    assert_int_equal(read.height, height);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 4; c++)
                assert_true(tl_image_floats(&read)[4 * (y * width + x) + c] ==
                            value_of(x, height - 1 - y, c, image));
    tl_image_release(&read);
}

static void expect_texture(struct tl_linear_image *linear, tl_gpu *gpu, int width, int height, float image)
{
    const tl_texture *texture = tl_linear_image_texture(linear, gpu);
    float *texels = tl_alloc(4 * (size_t)width * (size_t)height, sizeof *texels);
    float *expected = tl_alloc(4 * (size_t)width * (size_t)height, sizeof *expected);
    assert_int_equal(texture->width, width);
    assert_int_equal(texture->height, height);
    glGetTextureImage(texture->id, 0, GL_RGBA, GL_FLOAT, 16 * width * height, texels);
    fill(expected, width, height, image);
    assert_memory_equal(texels, expected, 16 * (size_t)width * (size_t)height);
    free(texels);
    free(expected);
}

static void test_sides(void **state)
{
    tl_gpu *gpu = *state;
    struct tl_linear_image linear = {0};
    size_t textures = tl_gpu_bytes(gpu);
    fill(tl_linear_image_begin_cpu(&linear, 5, 3), 5, 3, 0);
    assert_int_equal((uintptr_t)linear.texels % TL_CACHE_LINE, 0);
    expect_read(&linear, 5, 3, 0);
    assert_int_equal(tl_gpu_bytes(gpu), textures); /* nothing has asked for a texture */
    expect_texture(&linear, gpu, 5, 3, 0);
    fill(tl_linear_image_begin_cpu(&linear, 5, 3), 5, 3,
         1000); /* the same size: the texture is out of date */
    expect_texture(&linear, gpu, 5, 3, 1000);
    fill(tl_linear_image_begin_cpu(&linear, 3, 5), 3, 5, 2000); /* as many texels in another shape */
    expect_read(&linear, 3, 5, 2000);
    expect_texture(&linear, gpu, 3, 5, 2000);
    const float numbers[] = {7, 8, 9, 0.5f};
    tl_linear_image_begin_gpu(&linear, gpu, 3, 5);
    glClearBufferfv(GL_COLOR, 0, numbers); /* of the target that is bound */
    tl_image read;
    tl_linear_image_read(&linear, &read);
    for (int i = 0; i < 4 * 3 * 5; i++)
        assert_true(tl_image_floats(&read)[i] == numbers[i % 4]);
    tl_image_release(&read);
    assert_int_equal(tl_linear_image_bytes(&linear), 16 * 3 * 5); /* of one side */
    fill(tl_linear_image_begin_cpu(&linear, 4, 2), 4, 2, 3000);
    expect_read(&linear, 4, 2, 3000);
    tl_linear_image_release(&linear);
    assert_int_equal(tl_gpu_bytes(gpu), textures);
}

static int open_gpu(void **state)
{
    tl_error error = {0};
    *state = tl_gpu_create_headless(&error);
    return *state ? 0 : 1;
}

static int close_gpu(void **state)
{
    tl_gpu *gpu = *state;
    size_t messages = tl_gpu_message_count(gpu);
    tl_gpu_destroy(&gpu);
    return messages > 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_sides)};
    return cmocka_run_group_tests(tests, open_gpu, close_gpu);
}
