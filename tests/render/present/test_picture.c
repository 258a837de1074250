/* The picture for a screen, made on either side: what is copied and what is read are its columns, and what is
 * drawn next lands on the screen that was copied to. */
#include "render/present/picture.h"
#include "tests/testing.h"

#include <epoxy/gl.h>

#define WIDTH  6
#define HEIGHT 4

static uint8_t value_of(int x, int y, int channel)
{
    return (uint8_t)(channel == 3 ? 255 : 40 * x + 10 * y + channel);
}

static const struct tl_picture_part whole = {.width = WIDTH, .height = HEIGHT, .end_column = WIDTH};

static void make_on_cpu(struct tl_picture *picture)
{
    uint8_t *bytes = tl_picture_begin_cpu(picture, &whole);
    for (int i = 0; i < 4 * WIDTH * HEIGHT; i++)
        bytes[i] = value_of(i / 4 % WIDTH, i / 4 / WIDTH, i % 4);
}

/* Columns [first, end) of the screen are the picture's, the others black. */
static void expect_screen(const tl_target *screen, int first, int end)
{
    uint8_t bytes[4 * WIDTH * HEIGHT];
    glGetTextureImage(screen->colours[0].id, 0, GL_RGBA, GL_UNSIGNED_BYTE, sizeof bytes, bytes);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            for (int c = 0; c < 3; c++)
                assert_int_equal(bytes[4 * (y * WIDTH + x) + c],
                                 x >= first && x < end ? value_of(x, y, c) : 0);
}

static void test_copy(void **state)
{
    tl_gpu *gpu = *state;
    const unsigned format = GL_RGBA8;
    const float black[] = {0, 0, 0, 0};
    struct tl_picture picture = {0};
    tl_target screen = tl_target_create(gpu, WIDTH, HEIGHT, &format, 1, false);
    for (int round = 0; round < 2; round++) { /* sent, and already there */
        if (round == 0)
            make_on_cpu(&picture);
        glClearNamedFramebufferfv(screen.id, GL_COLOR, 0, black);
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        tl_picture_copy(&picture, gpu, screen.id, 2, 5);
        expect_screen(&screen, 2, 5);
        GLint bound = -1;
        glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
        assert_int_equal(bound, screen.id);
    }
    tl_target_destroy(&screen);
    tl_picture_release(&picture);
}

static void test_read(void **state)
{
    struct tl_picture picture = {0};
    const float colour[] = {0.2f, 0.4f, 0.6f, 1};
    tl_image read;
    make_on_cpu(&picture);
    tl_picture_read(&picture, &read);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            for (int c = 0; c < 3; c++)
                assert_int_equal(tl_image_bytes(&read)[3 * (y * WIDTH + x) + c],
                                 value_of(x, HEIGHT - 1 - y, c));
    tl_image_release(&read);
    tl_picture_begin_gpu(&picture, *state, &whole);
    glClearBufferfv(GL_COLOR, 0, colour);
    tl_picture_read(&picture, &read);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        assert_int_equal(tl_image_bytes(&read)[i], 51 * (i % 3 + 1));
    tl_image_release(&read);
    tl_picture_release(&picture);
}

static void test_parts(void **state)
{
    (void)state;
    struct tl_picture picture = {0};
    struct tl_picture_part part = {.width = WIDTH, .height = HEIGHT, .first_column = 2, .end_column = 5};
    assert_false(tl_picture_has(&picture, &part));
    tl_picture_begin_cpu(&picture, &part);
    assert_true(tl_picture_has(&picture, &part));
    assert_false(tl_picture_has(&picture, &whole));
    part.first_column = 3;
    assert_true(tl_picture_has(&picture, &part));
    part.width++;
    assert_false(tl_picture_has(&picture, &part));
    tl_picture_release(&picture);
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
    int fault = tl_gpu_message_count(gpu) > 0 || tl_gpu_bytes(gpu) > 0;
    tl_gpu_destroy(&gpu);
    return fault;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_copy),
        cmocka_unit_test(test_read),
        cmocka_unit_test(test_parts),
    };
    return cmocka_run_group_tests(tests, open_gpu, close_gpu);
}
