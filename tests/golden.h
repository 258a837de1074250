/* Golden images: small linear images of what was drawn when it was accepted.
 *
 * GL draws the same image everywhere but for the last bits, and for edges, which fall to one side of a sample
 * or to the other. A pixel may therefore differ by a 500th of its value (at least of 1); one in 50 by more,
 * where it lies within what the golden has about that pixel; and one in 200 by anything. A golden that is
 * missing or that differs fails, and the drawn image is written to the test's scratch folder: look at it, and
 * copy it over the golden when it is right. */
#ifndef TOILE_TESTS_GOLDEN_H
#define TOILE_TESTS_GOLDEN_H

#include "assets/image/exr.h"
#include "config/base/memory.h"
#include "tests/testing.h"

#define GOLDEN_PIXEL_TOLERANCE  (1 / 500.0)
#define GOLDEN_EDGE_FRACTION    (1 / 50.0)
#define GOLDEN_FAILING_FRACTION (1 / 200.0)

static inline void golden_write(const char *path, const tl_image *image)
{
    static const char *const names[] = {"R", "G", "B", "A"};
    const struct tl_exr_layer layer = {names, image};
    tl_error error = {0};
    assert_ok(tl_exr_save(path, &layer, 1, &error), error);
}

/* Whether the pixel has the golden's values, or with a `reach` of 1 values between those of the 3 x 3 pixels
 * there. */
static inline bool golden_agrees(const tl_image *drawn, const tl_image *golden, int x, int y, int reach)
{
    for (int c = 0; c < 4; c++) {
        double low = INFINITY, high = -INFINITY;
        for (int v = y - reach; v <= y + reach; v++)
            for (int u = x - reach; u <= x + reach; u++) {
                if (u < 0 || v < 0 || u >= golden->width || v >= golden->height)
                    continue;
                double value = (double)tl_image_floats(
                    golden)[4 * ((size_t)v * (size_t)golden->width + (size_t)u) + (size_t)c];
                low = fmin(low, value);
                high = fmax(high, value);
            }
        double value =
            (double)tl_image_floats(drawn)[4 * ((size_t)y * (size_t)drawn->width + (size_t)x) + (size_t)c];
        double tolerance = GOLDEN_PIXEL_TOLERANCE * fmax(1, high);
        if (!(value >= low - tolerance && value <= high + tolerance))
            return false;
    }
    return true;
}

/* Compares an RGBA image with FOLDER/NAME.exr, a path from the root of the repository. */
static inline void golden_check(const char *folder, const char *name, const tl_image *drawn)
{
    char *golden_path = tl_format("%s/%s/%s.exr", TOILE_SOURCE_DIR, folder, name);
    char *drawn_path = tl_format("%s/%s.exr", TOILE_SCRATCH_DIR, name);
    tl_error error = {0};
    tl_image golden = {0};
    enum tl_exr_envmap envmap;
    size_t pixels = (size_t)drawn->width * (size_t)drawn->height, failing = pixels, edges = 0;
    bool found = tl_exr_load(golden_path, &golden, &envmap, &error);
    if (found && golden.width == drawn->width && golden.height == drawn->height && golden.channels == 4) {
        failing = 0;
        for (int y = 0; y < drawn->height; y++)
            for (int x = 0; x < drawn->width; x++) {
                bool is_near = golden_agrees(drawn, &golden, x, y, 1);
                failing += !is_near;
                edges += is_near && !golden_agrees(drawn, &golden, x, y, 0);
            }
    }
    bool passed = (double)failing <= GOLDEN_FAILING_FRACTION * (double)pixels &&
                  (double)edges <= GOLDEN_EDGE_FRACTION * (double)pixels;
    if (!passed) {
        golden_write(drawn_path, drawn);
        print_error("%s: of %zu pixels %zu differ from %s, and %zu at edges: drawn is %s\n",
                    found ? name : error.message, pixels, failing, golden_path, edges, drawn_path);
    }
    tl_image_release(&golden);
    free(golden_path);
    free(drawn_path);
    assert_true(passed);
}

#endif
