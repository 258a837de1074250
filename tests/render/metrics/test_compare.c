#include "render/metrics/compare.h"

#include "config/base/memory.h"
#include "render/metrics/flip.h"

#include "tests/testing.h"

#include <stdlib.h>
#include <string.h>

static tl_image filled(int width, int height, int channels, const float *values)
{
    tl_image image = tl_image_create(width, height, channels, TL_IMAGE_F32);
    for (int i = 0; i < width * height * channels; i++)
        tl_image_floats(&image)[i] = values[i % channels];
    return image;
}

static const float grey[4] = {0.5f, 0.25f, 0.75f, 1};

static void equal_images_do_not_differ(void **state)
{
    (void)state;
    tl_image a = filled(20, 10, 4, grey), b = filled(20, 10, 4, grey);
    struct tl_comparison result;
    tl_error error = {0};
    for (int hdr = -1; hdr <= 1; hdr++) {
        assert_ok(tl_image_compare(&a, &b, hdr, 0, &result, &error), error);
        assert_int_equal(result.covered, 200);
        assert_near(result.rel_rmse, 0, 0);
        assert_near(result.flip_mean, 0, 0);
        assert_near(result.flip_frame, 0, 0);
        assert_near(result.max_abs, 0, 0);
        assert_int_equal(result.hdr, hdr == 1);
    }
    tl_image_release(&a);
    tl_image_release(&b);
}

/* Errors of 0.1, 0 and -0.2 against a mean of 0.5: sqrt((0.01 + 0.04) / 3) / 0.5. Only covered pixels count,
 * so that an empty frame around the picture changes none but the frame's own mean. */
static void figures_are_over_covered_pixels(void **state)
{
    (void)state;
    const float shifted[4] = {0.6f, 0.25f, 0.55f, 1}, nothing[4] = {0};
    tl_image small_a = filled(16, 16, 4, shifted), small_b = filled(16, 16, 4, grey);
    tl_image large_a = filled(96, 96, 4, nothing), large_b = filled(96, 96, 4, nothing);
    for (int y = 0; y < 16; y++) {
        for (int x = 0; x < 16; x++) {
            size_t i = 4 * (size_t)((y + 40) * 96 + x + 40);
            memcpy(tl_image_floats(&large_a) + i, shifted, sizeof shifted);
            memcpy(tl_image_floats(&large_b) + i, grey, sizeof grey);
        }
    }
    struct tl_comparison small, large;
    tl_error error = {0};
    assert_ok(tl_image_compare(&small_a, &small_b, 0, 0, &small, &error), error);
    assert_ok(tl_image_compare(&large_a, &large_b, 0, 0, &large, &error), error);
    assert_near(small.rel_rmse, sqrt(0.05 / 3) / 0.5, 1e-6);
    assert_near(small.max_abs, 0.2, 1e-6);
    assert_int_equal(large.covered, 256);
    assert_near(large.rel_rmse, small.rel_rmse, 1e-9);
    assert_near(large.max_abs, small.max_abs, 0);
    assert_near(small.flip_mean, small.flip_frame, 1e-12);
    assert_true(large.flip_mean > 0.05);
    assert_true(large.flip_frame < 0.2 * large.flip_mean); /* 1/36 of the frame, and what filters spread */
    tl_image_release(&small_a);
    tl_image_release(&small_b);
    tl_image_release(&large_a);
    tl_image_release(&large_b);
}

/* Coverage in either image counts: what is missing altogether is an error too. */
static void missing_pixels_count(void **state)
{
    (void)state;
    const float nothing[4] = {0};
    tl_image a = filled(16, 16, 4, nothing), b = filled(16, 16, 4, nothing);
    memcpy(tl_image_floats(&a), grey, sizeof grey);
    memcpy(tl_image_floats(&b) + 40, grey, sizeof grey);
    struct tl_comparison result;
    tl_error error = {0};
    assert_ok(tl_image_compare(&a, &b, -1, 0, &result, &error), error);
    assert_int_equal(result.covered, 2);
    assert_near(result.max_abs, 0.75, 0);
    assert_int_equal(result.worst, 0); /* two alike: the first */
    assert_near(result.worst_share, 0.5, 1e-12);
    /* two pixels, each with squares of 1/4, 1/16 and 9/16; one of them bright in the reference */
    assert_near(result.rel_rmse, sqrt((0.25 + 0.0625 + 0.5625) / 3) / 0.25, 1e-6);
    tl_image_release(&a);
    tl_image_release(&b);
}

static void hdr_is_chosen_by_content(void **state)
{
    (void)state;
    const float bright[4] = {3, 2, 4, 1};
    tl_image a = filled(16, 16, 4, grey), b = filled(16, 16, 4, bright);
    struct tl_comparison result;
    tl_error error = {0};
    assert_ok(tl_image_compare(&a, &b, -1, 0, &result, &error), error);
    assert_true(result.hdr);
    assert_near(result.exposure_start, result.exposure_stop, 1e-6); /* one luminance: both ends agree */
    assert_ok(tl_image_compare(&b, &a, -1, 0, &result, &error), error);
    assert_false(result.hdr);
    tl_image_release(&a);
    tl_image_release(&b);
}

/* PEERS.md: taken over the frame, the median of a picture that is mostly empty is 0 and the exposure
 * infinite; HDR-FLIP then found no difference in any image. */
static void exposures_come_from_covered_pixels(void **state)
{
    (void)state;
    const float nothing[4] = {0};
    tl_image a = filled(64, 64, 4, nothing), b = filled(64, 64, 4, nothing);
    for (size_t i = 0; i < 64; i++) {
        const float tested[4] = {1, 1, 1, 1}, wanted[4] = {2 + (float)(i % 3), 2, 2, 1};
        memcpy(tl_image_floats(&a) + 4 * i, tested, sizeof tested);
        memcpy(tl_image_floats(&b) + 4 * i, wanted, sizeof wanted);
    }
    struct tl_comparison result;
    tl_error error = {0};
    assert_ok(tl_image_compare(&a, &b, -1, 0, &result, &error), error);
    assert_true(result.hdr && isfinite(result.exposure_start) && isfinite(result.exposure_stop));
    assert_true(result.flip_mean > 0.1);

    /* covered but black for more than half: refused, not a mean of 0 */
    for (int i = 64; i < 64 * 64; i++)
        tl_image_floats(&b)[4 * i + 3] = 1;
    assert_false(tl_image_compare(&a, &b, -1, 0, &result, &error));
    assert_int_equal(error.code, TL_INPUT);
    assert_non_null(strstr(error.message, "exposure"));
    tl_image_release(&a);
    tl_image_release(&b);
}

/* An 8-bit picture is decoded: 188 is a linear half. */
static void eight_bits_are_decoded(void **state)
{
    (void)state;
    const float half[3] = {0.5f, 0.5f, 0.5f};
    tl_image a = tl_image_create(8, 8, 1, TL_IMAGE_U8), b = filled(8, 8, 3, half);
    memset(a.texels, 188, 64);
    struct tl_comparison result;
    tl_error error = {0};
    assert_ok(tl_image_compare(&a, &b, -1, 0, &result, &error), error);
    assert_int_equal(result.covered, 64);
    assert_true(result.max_abs < 0.004); /* half a step of 8 bits there */
    tl_image_release(&a);
    tl_image_release(&b);
}

static void check_refused(const tl_image *a, const tl_image *b, double pixels_per_degree, const char *word)
{
    struct tl_comparison result;
    tl_error error = {0};
    assert_false(tl_image_compare(a, b, -1, pixels_per_degree, &result, &error));
    assert_true(error.code == TL_INPUT || error.code == TL_USAGE);
    if (!strstr(error.message, word))
        print_error("\"%s\" does not say \"%s\"\n", error.message, word);
    assert_non_null(strstr(error.message, word));
}

static void bad_images_are_refused(void **state)
{
    (void)state;
    const float nothing[4] = {0};
    tl_image a = filled(16, 16, 4, grey), b = filled(16, 16, 4, grey), other = filled(16, 8, 4, grey);
    tl_image empty = filled(16, 16, 4, nothing);
    check_refused(&a, &other, 0, "16 x 8");
    check_refused(&empty, &empty, 0, "covers");
    check_refused(&a, &b, 1e9, "10 to 1000");
    check_refused(&a, &b, 0.01, "10 to 1000");
    tl_image_floats(&b)[4 * (3 * 16 + 5) + 1] = NAN;
    check_refused(&a, &b, 0, "reference image: pixel (5, 3)");
    check_refused(&b, &a, 0, "tested image");
    tl_image_floats(&b)[4 * (3 * 16 + 5) + 1] = INFINITY;
    check_refused(&a, &b, 0, "not a finite number");
    tl_image_release(&a);
    tl_image_release(&b);
    tl_image_release(&other);
    tl_image_release(&empty);
}

static void tiny_images_work(void **state)
{
    (void)state;
    tl_image a = filled(1, 1, 4, grey), b = filled(1, 1, 4, grey);
    tl_image_floats(&a)[0] = 0.9f;
    struct tl_comparison result;
    tl_error error = {0};
    assert_ok(tl_image_compare(&a, &b, -1, 0, &result, &error), error);
    double near_by = result.flip_mean;
    assert_true(near_by > 0);
    /* one colour against another, from anywhere */
    assert_ok(tl_image_compare(&a, &b, -1, 10, &result, &error), error);
    assert_near(result.flip_mean, near_by, 1e-4);
    tl_image_release(&a);
    tl_image_release(&b);
}

/* ---- One object's pixels ---- */

enum { SIDE = 96 };
static const size_t side_count = (size_t)SIDE * SIDE; /* pixels */

/* 1 in a square, else 0; one channel. */
static tl_image square_mask(int first, int end)
{
    tl_image mask = tl_image_create(SIDE, SIDE, 1, TL_IMAGE_F32);
    for (int y = first; y < end; y++)
        for (int x = first; x < end; x++)
            tl_image_floats(&mask)[y * SIDE + x] = 1;
    return mask;
}

static void blacken(tl_image *image, int first_x, int first_y, int side)
{
    for (int y = first_y; y < first_y + side; y++)
        for (int x = first_x; x < first_x + side; x++)
            memset(tl_image_floats(image) + 4 * ((size_t)y * SIDE + (size_t)x), 0, 3 * sizeof(float));
}

/* The mean of the `wanted` largest values under the mask, found one by one. */
static double mean_of_largest(const float *map, const tl_image *mask, size_t wanted)
{
    bool *taken = TL_NEW_ARRAY(bool, side_count);
    double sum = 0;
    for (size_t k = 0; k < wanted; k++) {
        int largest = -1;
        for (int i = 0; i < SIDE * SIDE; i++)
            if (tl_image_floats(mask)[i] > 0.5f && !taken[i] && (largest < 0 || map[i] > map[largest]))
                largest = i;
        taken[largest] = true;
        sum += (double)map[largest];
    }
    free(taken);
    return sum / (double)wanted;
}

/* FLIP's filters reach 10 pixels at 67 pixels per degree: an error further away than that is none of the
 * object's, however large it is; and the object's error is all its own, whatever is around it. */
static void only_the_objects_pixels_count(void **state)
{
    (void)state;
    tl_image a = filled(SIDE, SIDE, 4, grey), b = filled(SIDE, SIDE, 4, grey), mask = square_mask(4, 44);
    struct tl_object_error object;
    struct tl_comparison all;
    tl_error error = {0};
    blacken(&a, 60, 60, 30);
    assert_ok(tl_image_compare_object(&a, &b, &mask, 0, &object, &error), error);
    assert_ok(tl_image_compare(&a, &b, 0, 0, &all, &error), error);
    assert_int_equal(object.pixels, 40 * 40);
    assert_near(object.flip_mean, 0, 0);
    assert_near(object.flip_worst, 0, 0);
    assert_true(all.flip_mean > 0.05);
    tl_image_release(&a);
    tl_image_release(&b);
    tl_image_release(&mask);
}

/* 5 x 5 black pixels on 40 x 40 of the object: a mean hides them; of the largest 5 %, 80 pixels, they and
 * what the filters spread of them are the greater part. */
static void a_small_patch_shows_in_the_worst(void **state)
{
    (void)state;
    tl_image a = filled(SIDE, SIDE, 4, grey), b = filled(SIDE, SIDE, 4, grey), mask = square_mask(28, 68);
    float rgb[2][3 * SIDE * SIDE], map[SIDE * SIDE];
    const struct tl_flip_frame frame = {SIDE, SIDE, TL_FLIP_PIXELS_PER_DEGREE};
    struct tl_object_error object;
    tl_error error = {0};
    blacken(&a, 40, 44, 5);
    assert_ok(tl_image_compare_object(&a, &b, &mask, 0, &object, &error), error);
    for (int i = 0; i < SIDE * SIDE; i++)
        for (int c = 0; c < 3; c++) {
            rgb[0][3 * i + c] = tl_image_floats(&a)[4 * i + c];
            rgb[1][3 * i + c] = tl_image_floats(&b)[4 * i + c];
        }
    tl_flip_ldr(&frame, rgb[0], rgb[1], map);
    assert_near(object.flip_mean, mean_of_largest(map, &mask, 1600), 1e-12);
    assert_near(object.flip_worst, mean_of_largest(map, &mask, 80), 1e-12);
    assert_true(object.flip_mean < 0.05);
    assert_true(object.flip_worst > 0.3);
    tl_image_release(&a);
    tl_image_release(&b);
    tl_image_release(&mask);
}

/* One colour against another: the mean and the worst are alike, and those of the whole picture. */
static void an_even_error_is_the_same_everywhere(void **state)
{
    (void)state;
    const float other[4] = {0.4f, 0.3f, 0.7f, 1};
    tl_image a = filled(SIDE, SIDE, 4, other), b = filled(SIDE, SIDE, 4, grey), mask = square_mask(30, 37);
    struct tl_object_error object;
    struct tl_comparison all;
    tl_error error = {0};
    assert_ok(tl_image_compare_object(&a, &b, &mask, 0, &object, &error), error);
    assert_ok(tl_image_compare(&a, &b, 0, 0, &all, &error), error);
    assert_true(object.flip_mean > 0.01);
    assert_near(object.flip_mean, all.flip_mean, 1e-6);
    assert_near(object.flip_worst, all.flip_mean, 1e-6);
    tl_image_release(&a);
    tl_image_release(&b);
    tl_image_release(&mask);
}

/* 5 % of one pixel is one pixel; a mask of bytes counts from 128; and without any pixel nothing is known. */
static void masks_are_read_as_stated(void **state)
{
    (void)state;
    const float shifted[4] = {0.6f, 0.25f, 0.55f, 1};
    tl_image a = filled(SIDE, SIDE, 4, shifted), b = filled(SIDE, SIDE, 4, grey);
    tl_image mask = tl_image_create(SIDE, SIDE, 3, TL_IMAGE_U8),
             small = tl_image_create(8, 8, 1, TL_IMAGE_U8);
    struct tl_object_error object;
    tl_error error = {0};
    memset(mask.texels, 127, 3 * side_count);
    assert_ok(tl_image_compare_object(&a, &b, &mask, 0, &object, &error), error);
    assert_int_equal(object.pixels, 0);
    assert_true(isnan(object.flip_mean) && isnan(object.flip_worst));
    tl_image_bytes(&mask)[1500] = 128;
    assert_ok(tl_image_compare_object(&a, &b, &mask, 0, &object, &error), error);
    assert_int_equal(object.pixels, 1);
    assert_true(object.flip_mean > 0.01);
    assert_near(object.flip_worst, object.flip_mean, 0);
    assert_false(tl_image_compare_object(&a, &b, &small, 0, &object, &error));
    assert_non_null(strstr(error.message, "8 x 8"));
    tl_image_floats(&a)[4] = NAN;
    assert_false(tl_image_compare_object(&a, &b, &mask, 0, &object, &error));
    assert_non_null(strstr(error.message, "tested image: pixel (1, 0)"));
    tl_image_release(&a);
    tl_image_release(&b);
    tl_image_release(&mask);
    tl_image_release(&small);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_images_do_not_differ),
        cmocka_unit_test(figures_are_over_covered_pixels),
        cmocka_unit_test(missing_pixels_count),
        cmocka_unit_test(hdr_is_chosen_by_content),
        cmocka_unit_test(exposures_come_from_covered_pixels),
        cmocka_unit_test(eight_bits_are_decoded),
        cmocka_unit_test(bad_images_are_refused),
        cmocka_unit_test(tiny_images_work),
        cmocka_unit_test(only_the_objects_pixels_count),
        cmocka_unit_test(a_small_patch_shows_in_the_worst),
        cmocka_unit_test(an_even_error_is_the_same_everywhere),
        cmocka_unit_test(masks_are_read_as_stated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
