#include "assets/base/image.h"
#include "assets/image/image_file.h"

#include "config/base/memory.h"

#include "tests/testing.h"

#include <string.h>

static tl_image load_data(const char *relative)
{
    tl_image image;
    tl_error error;
    assert_ok(tl_image_load(test_data(relative), &image, &error), error);
    return image;
}

/* PNG Suite names: basi = interlaced, basn = not; colour type and bits follow. */
static void every_kind_of_png(void **state)
{
    (void)state;
    const struct {
        const char *file;
        int side, channels;
    } kinds[] = {{"basi6a16", 32, 4}, {"basn0g01", 32, 1}, {"basn0g16", 32, 1}, {"basn2c16", 32, 3},
                 {"basn3p08", 32, 3}, {"basn4a16", 32, 2}, {"basn6a16", 32, 4}, {"g03n2c08", 32, 3},
                 {"s01n3p01", 1, 3},  {"tbbn3p08", 32, 4}};
    for (size_t i = 0; i < TL_COUNT(kinds); i++) {
        char relative[64];
        snprintf(relative, sizeof relative, "images/pngsuite/%s.png", kinds[i].file);
        tl_image image = load_data(relative);
        assert_int_equal(image.width, kinds[i].side);
        assert_int_equal(image.height, kinds[i].side);
        assert_int_equal(image.channels, kinds[i].channels);
        assert_int_equal(image.type, TL_IMAGE_U8);
        assert_false(image.linear);
        tl_image_release(&image);
    }
}

/* The suite's interlaced image equals the one that is not interlaced. */
static void interlacing_changes_nothing(void **state)
{
    (void)state;
    tl_image plain = load_data("images/pngsuite/basn6a16.png");
    tl_image interlaced = load_data("images/pngsuite/basi6a16.png");
    assert_memory_equal(plain.texels, interlaced.texels, sizeof(uint8_t[32][32][4]));
    tl_image_release(&plain);
    tl_image_release(&interlaced);
}

static tl_image make_pattern(int width, int height, int channels)
{
    tl_image image = tl_image_create(width, height, channels, TL_IMAGE_U8);
    for (int i = 0; i < width * height * channels; i++)
        tl_image_bytes(&image)[i] = (uint8_t)((uint32_t)i * 2654435761u >> 24);
    return image;
}

static void png_round_trip(void **state)
{
    (void)state;
    const char *path = TOILE_SCRATCH_DIR "/image.png";
    const int sizes[][2] = {{1, 1}, {1, 9}, {37, 2}, {64, 64}};
    for (size_t s = 0; s < TL_COUNT(sizes); s++) {
        for (int channels = 1; channels <= 4; channels++) {
            tl_image image = make_pattern(sizes[s][0], sizes[s][1], channels), back;
            tl_error error;
            assert_ok(tl_image_save_png(path, &image, &error), error);
            assert_ok(tl_image_load(path, &back, &error), error);
            assert_true(back.width == image.width && back.height == image.height);
            assert_int_equal(back.channels, channels);
            assert_memory_equal(back.texels, image.texels,
                                (size_t)(image.width * image.height * image.channels));
            tl_image_release(&image);
            tl_image_release(&back);
        }
    }
}

static void cut_or_damaged_png_is_refused(void **state)
{
    (void)state;
    tl_image image = make_pattern(16, 16, 3), back;
    void *png;
    size_t size;
    tl_error error;
    assert_ok(tl_image_encode_png("pattern", &image, &png, &size, &error), error);
    assert_ok(tl_image_decode("pattern", png, size, &back, &error), error);
    tl_image_release(&back);
    for (size_t cut = 0; cut < size; cut++)
        assert_false(tl_image_decode("pattern", png, cut, &back, &error));
    assert_non_null(strstr(error.message, "pattern"));
    /* every chunk has a checksum: one wrong bit anywhere behind the signature is found, but for the length
     * of IEND and what follows its name */
    for (size_t at = 8; at + 12 < size; at++) {
        ((uint8_t *)png)[at] ^= 0x10;
        assert_false(tl_image_decode("pattern", png, size, &back, &error));
        ((uint8_t *)png)[at] ^= 0x10;
    }
    free(png);
    tl_image_release(&image);
}

static void failed_png_writes_are_reported(void **state)
{
    (void)state;
    tl_image image = tl_image_create(2, 2, 3, TL_IMAGE_F32);
    tl_error error;
    assert_false(tl_image_save_png(TOILE_SCRATCH_DIR "/image_float.png", &image, &error));
    assert_true(access(TOILE_SCRATCH_DIR "/image_float.png", F_OK) != 0);
    tl_image_release(&image);
    image = make_pattern(64, 64, 4);
    assert_false(tl_image_save_png("/dev/full", &image, &error));
    assert_int_equal(error.code, TL_OUTPUT);
    tl_image_release(&image);
}

static void sizes_are_checked(void **state)
{
    (void)state;
    tl_error error;
    assert_true(tl_image_size_check("a", 16384, 16384, &error));
    assert_true(tl_image_size_check("a", TL_LIMIT_IMAGE_SIDE, 1, &error));
    assert_false(tl_image_size_check("a", 16384, 16385, &error));
    assert_false(tl_image_size_check("a", TL_LIMIT_IMAGE_SIDE + 1, 1, &error));
    assert_false(tl_image_size_check("a", 0, 5, &error));
    assert_false(tl_image_size_check("a", 5, -1, &error));
    assert_false(tl_image_size_check("a", INT64_MAX, INT64_MAX, &error));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_of_png),
        cmocka_unit_test(interlacing_changes_nothing),
        cmocka_unit_test(png_round_trip),
        cmocka_unit_test(cut_or_damaged_png_is_refused),
        cmocka_unit_test(failed_png_writes_are_reported),
        cmocka_unit_test(sizes_are_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
