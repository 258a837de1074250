/* Golden images: small linear images of what was drawn when it was accepted.
 *
 * Software GL draws the same image everywhere but for the last bits. A pixel may therefore differ by a 500th
 * of its value (at least of 1), and one pixel in 200, at the edges of shapes and shadows, by more. A golden
 * that is missing or that differs fails, and the drawn image is written to the test's scratch folder: look at
 * it, and copy it over the golden when it is right. */
#ifndef TOILE_TESTS_GOLDEN_H
#define TOILE_TESTS_GOLDEN_H

#include "assets/image/exr.h"
#include "config/base/memory.h"
#include "tests/testing.h"

#define GOLDEN_PIXEL_TOLERANCE  (1 / 500.0)
#define GOLDEN_FAILING_FRACTION (1 / 200.0)

static inline void golden_write(const char *path, const tl_image *image)
{
    static const char *const names[] = {"R", "G", "B", "A"};
    const struct tl_exr_layer layer = {names, image};
    tl_error error = {0};
    assert_ok(tl_exr_save(path, &layer, 1, &error), error);
}

static inline size_t golden_differing_pixels(const tl_image *drawn, const tl_image *golden)
{
    size_t failing = 0;
    for (size_t p = 0; p < (size_t)drawn->width * (size_t)drawn->height; p++) {
        bool same = true;
        for (size_t c = 4 * p; c < 4 * p + 4; c++) {
            double expected = (double)tl_image_floats(golden)[c];
            double difference = fabs((double)tl_image_floats(drawn)[c] - expected);
            same = same && difference <= GOLDEN_PIXEL_TOLERANCE * fmax(1, expected);
        }
        failing += !same;
    }
    return failing;
}

/* Compares an RGBA image with FOLDER/NAME.exr, a path from the root of the repository. */
static inline void golden_check(const char *folder, const char *name, const tl_image *drawn)
{
    char *golden_path = tl_format("%s/%s/%s.exr", TOILE_SOURCE_DIR, folder, name);
    char *drawn_path = tl_format("%s/%s.exr", TOILE_SCRATCH_DIR, name);
    tl_error error = {0};
    tl_image golden = {0};
    enum tl_exr_envmap envmap;
    size_t pixels = (size_t)drawn->width * (size_t)drawn->height, failing = pixels;
    bool found = tl_exr_load(golden_path, &golden, &envmap, &error);
    if (found && golden.width == drawn->width && golden.height == drawn->height && golden.channels == 4)
        failing = golden_differing_pixels(drawn, &golden);
    bool passed = (double)failing <= GOLDEN_FAILING_FRACTION * (double)pixels;
    if (!passed) {
        golden_write(drawn_path, drawn);
        print_error("%s: %zu of %zu pixels differ from %s: drawn is %s\n", found ? name : error.message,
                    failing, pixels, golden_path, drawn_path);
    }
    tl_image_release(&golden);
    free(golden_path);
    free(drawn_path);
    assert_true(passed);
}

#endif
