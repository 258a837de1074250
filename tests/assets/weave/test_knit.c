/* Loops, naps and piles as height fields: their spacings in true millimetres, what lies in front,
 * periodicity, and how colour follows height. */
#include "tests/testing.h"

#include "assets/weave/tile.h"
#include "assets/weave/weave.h"

#include "config/base/memory.h"

#include <math.h>
#include <string.h>

static struct tl_weave_params params_of(int pattern)
{
    struct tl_weave_params params = *(const struct tl_weave_params *)tl_weave_options.defaults;
    params.pattern = pattern;
    params.wale_mm = 0.8f;
    params.course_mm = 0.5f;
    params.yarn_mm = 0.3f;
    params.texels_per_yarn = 32;
    return params;
}

static tl_weave make(const struct tl_weave_params *params)
{
    tl_weave weave;
    assert_true(tl_weave_create(params, &weave));
    return weave;
}

static double height_at(const tl_weave *weave, int column, int row)
{
    const int width = weave->height.width, height = weave->height.height;
    return (double)tl_image_floats(&weave->height)[(size_t)((row + height) % height) * (size_t)width +
                                                   (size_t)((column + width) % width)];
}

/* Share of the variance of a profile that a wave of `waves` in its length and the next two multiples of it
 * have. */
static double share_of_waves(const double *profile, int count, int waves)
{
    double mean = 0, variance = 0, power = 0;
    for (int i = 0; i < count; i++)
        mean += profile[i] / count;
    for (int i = 0; i < count; i++)
        variance += (profile[i] - mean) * (profile[i] - mean) / count;
    for (int k = 1; k <= 3; k++) {
        double a = 0, b = 0;
        for (int i = 0; i < count; i++) {
            a += profile[i] * cos(2 * M_PI * k * waves * i / count) / count;
            b += profile[i] * sin(2 * M_PI * k * waves * i / count) / count;
        }
        power += 2 * (a * a + b * b);
    }
    return power / variance;
}

/* Mean height by column (over rows) or by row. */
static void profile_of(const tl_weave *weave, bool by_column, double *profile)
{
    const int width = weave->height.width, height = weave->height.height;
    memset(profile, 0, sizeof *profile * (size_t)(by_column ? width : height));
    for (int row = 0; row < height; row++)
        for (int column = 0; column < width; column++)
            profile[by_column ? column : row] += height_at(weave, column, row) / (by_column ? height : width);
}

/* 20 wales of 0.8 mm and 32 courses of 0.5 mm make 16 mm; the heights vary with these spacings and no others,
 * but for what yarns vary by themselves: by measure a sixth and a quarter. */
static void test_spacings(void **state)
{
    (void)state;
    const struct tl_weave_params params = params_of(TL_WEAVE_JERSEY);
    tl_weave weave = make(&params);
    assert_near(weave.size_m[0], 20 * 0.8e-3, 1e-8);
    assert_near(weave.size_m[1], 32 * 0.5e-3, 1e-8);
    assert_int_equal(weave.height.width, 20 * 32);
    assert_int_equal(weave.height.height, 20 * 32); /* square texels */
    double profile[20 * 32];
    profile_of(&weave, true, profile);
    double wales = share_of_waves(profile, weave.height.width, 20);
    profile_of(&weave, false, profile);
    double courses = share_of_waves(profile, weave.height.height, 32);
    print_message("share of wales %.3f, of courses %.3f\n", wales, courses);
    assert_true(wales > 0.65 && courses > 0.7);
    tl_weave_release(&weave);
}

static double mean_over_wales(const tl_weave *weave, int wale, int count, int texels)
{
    double sum = 0;
    for (int row = 0; row < weave->height.height; row++)
        for (int i = 0; i < texels; i++)
            sum += height_at(weave, ((wale % count) + count) % count * texels + i, row);
    return sum / (texels * weave->height.height);
}

/* Face wales of a rib stand in front of purl wales; two by two, or three by three. A jersey has no such step.
 */
static void test_ribs(void **state)
{
    (void)state;
    for (int rib = 2; rib <= 3; rib++) {
        struct tl_weave_params params = params_of(TL_WEAVE_RIB);
        params.rib = rib;
        tl_weave weave = make(&params);
        const int count = weave.height.width / 32;
        assert_int_equal(count % (2 * rib), 0);
        for (int wale = 0; wale < count; wale++) {
            const double own = mean_over_wales(&weave, wale, count, 32);
            const double other = mean_over_wales(&weave, wale + rib, count, 32);
            const bool is_face = wale / rib % 2 == 0;
            assert_true(is_face ? own > other + 0.7 * 0.3e-3 : own < other - 0.7 * 0.3e-3);
        }
        tl_weave_release(&weave);
    }
}

/* Purl courses show heads, which lie across, in every other course: the heights repeat after two. */
static void test_purl_and_interlock(void **state)
{
    (void)state;
    const struct tl_weave_params jersey = params_of(TL_WEAVE_JERSEY), purl = params_of(TL_WEAVE_PURL),
                                 interlock = params_of(TL_WEAVE_INTERLOCK);
    tl_weave plain = make(&jersey), links = make(&purl), locked = make(&interlock);
    double profile[20 * 32];
    profile_of(&plain, false, profile);
    double every_second =
        share_of_waves(profile, plain.height.height, 16) - share_of_waves(profile, plain.height.height, 32);
    profile_of(&links, false, profile);
    double of_links =
        share_of_waves(profile, links.height.height, 16) - share_of_waves(profile, links.height.height, 32);
    print_message("waves of two courses: jersey %.3f, purl %.3f\n", every_second, of_links);
    assert_true(of_links > every_second + 0.3);
    /* Between the wales of an interlock the other side's loops are seen, not a hole. */
    int holes[2] = {0};
    const tl_image *heights[2] = {&plain.height, &locked.height};
    for (int k = 0; k < 2; k++) {
        float lowest = 0;
        for (int i = 0; i < heights[k]->width * heights[k]->height; i++)
            lowest = fminf(lowest, tl_image_floats(heights[k])[i]);
        for (int i = 0; i < heights[k]->width * heights[k]->height; i++)
            holes[k] += tl_image_floats(heights[k])[i] == lowest;
    }
    print_message("texels of holes: jersey %d, interlock %d\n", holes[0], holes[1]);
    assert_true(holes[0] > 100 && holes[1] < 0.1 * holes[0]);
    tl_weave_release(&plain);
    tl_weave_release(&links);
    tl_weave_release(&locked);
}

static struct tl_weave_params furry(int pattern)
{
    struct tl_weave_params params = params_of(pattern);
    params.nap = 1;
    params.melange = 0.3f;
    params.slub = 0.1f;
    params.texels_per_yarn = 16;
    return params;
}

/* The weaves of furry(), each made once. */
static tl_weave weaves[TL_WEAVE_PILE + 1];

static const tl_weave *furry_weave(int pattern)
{
    if (!weaves[pattern].tint.texels) {
        const struct tl_weave_params params = furry(pattern);
        weaves[pattern] = make(&params);
    }
    return &weaves[pattern];
}

static int release_weaves(void **state)
{
    (void)state;
    for (int pattern = TL_WEAVE_PLAIN; pattern <= TL_WEAVE_PILE; pattern++)
        tl_weave_release(&weaves[pattern]);
    return 0;
}

/* Steps across the tile's edge are as small as those inside it; normals are those of the heights; valleys are
 * darker, and the colour's mean is that without darkness. */
static void test_maps(void **state)
{
    (void)state;
    for (int pattern = TL_WEAVE_PLAIN; pattern <= TL_WEAVE_PILE; pattern++) {
        const tl_weave *weave = furry_weave(pattern);
        const int width = weave->height.width, height = weave->height.height;
        double across[2] = {0}, up[2] = {0}, together = 0, squares[2] = {0}, mean = 0;
        for (int row = 0; row < height; row++) {
            across[0] += fabs(height_at(weave, 0, row) - height_at(weave, width - 1, row)) / height;
            across[1] +=
                fabs(height_at(weave, width / 2, row) - height_at(weave, width / 2 - 1, row)) / height;
        }
        for (int column = 0; column < width; column++) {
            up[0] += fabs(height_at(weave, column, 0) - height_at(weave, column, height - 1)) / width;
            up[1] +=
                fabs(height_at(weave, column, height / 2) - height_at(weave, column, height / 2 - 1)) / width;
        }
        for (size_t i = 0; i < (size_t)width * (size_t)height; i++)
            mean += (double)tl_image_floats(&weave->tint)[3 * i + 1] / (width * height);
        for (int row = 0; row < height; row++)
            for (int column = 0; column < width; column++) {
                const size_t i = (size_t)row * (size_t)width + (size_t)column;
                const double h = height_at(weave, column, row);
                const double tint = (double)tl_image_floats(&weave->tint)[3 * i + 1] - mean;
                together += h * tint, squares[0] += h * h, squares[1] += tint * tint;
                const uint8_t *n = tl_image_bytes(&weave->normal) + 3 * i;
                const double slope = (height_at(weave, column + 1, row) - height_at(weave, column - 1, row)) *
                                     width / (2 * (double)weave->size_m[0]);
                if (fabs(slope) > 0.1) /* x is against the slope, whatever bounds it */
                    assert_true(slope > 0 ? n[0] < 128 : n[0] >= 127);
            }
        const double correlation = together / sqrt(squares[0] * squares[1]);
        print_message("pattern %d: %dx%d, steps %.1f/%.1f and %.1f/%.1f um, tint %.3f, "
                      "correlation with height %.2f\n",
                      pattern, width, height, 1e6 * across[0], 1e6 * across[1], 1e6 * up[0], 1e6 * up[1],
                      mean, correlation);
        assert_true(across[0] < 2 * across[1] + 2e-6 && up[0] < 2 * up[1] + 2e-6);
        assert_true(correlation > 0.1);
        struct tl_weave_params flat = furry(pattern);
        flat.cavity = 0;
        tl_weave even = make(&flat);
        double plain = 0;
        for (size_t i = 0; i < (size_t)width * (size_t)height; i++)
            plain += (double)tl_image_floats(&even.tint)[3 * i + 1] / (width * height);
        assert_near(mean, plain, 1e-4);
        assert_memory_equal(even.height.texels, weave->height.texels,
                            sizeof(float) * (size_t)width * (size_t)height); /* and again the same heights */
        tl_weave_release(&even);
    }
}

/* From afar a tile has one brightness: means over a quarter of it differ by 2 %, though clumps and
 * yarns differ by a tenth and more. */
static void test_no_pattern_of_tiles(void **state)
{
    (void)state;
    for (int pattern = TL_WEAVE_PLAIN; pattern <= TL_WEAVE_PILE; pattern++) {
        const tl_weave *weave = furry_weave(pattern);
        const int width = weave->tint.width, height = weave->tint.height;
        double means[4][4] = {{0}}, minimum = 2, maximum = 0;
        for (int row = 0; row < height; row++)
            for (int column = 0; column < width; column++)
                means[row * 4 / height][column * 4 / width] +=
                    (double)tl_image_floats(&weave->tint)[3 * (row * width + column) + 1] * 16 /
                    (width * height);
        for (int i = 0; i < 16; i++) {
            minimum = fmin(minimum, means[i / 4][i % 4]);
            maximum = fmax(maximum, means[i / 4][i % 4]);
        }
        print_message("pattern %d: means of quarters %.4f to %.4f\n", pattern, minimum, maximum);
        /* a quarter does not hold a whole number of ribs */
        assert_true(maximum - minimum < (pattern == TL_WEAVE_RIB ? 0.05 : 0.025));
    }
}

/* A ball of a strand that lies on the tile's corner is seen in all four. */
static void test_a_strand_at_the_corner(void **state)
{
    (void)state;
    struct tl_tile tile = tl_tile_make(32, 32, 32e-3, 32e-3, -1);
    const struct tl_strand strand = {.z = 2e-3, .radius = 2e-3, .along_x = 1, .tint = {0.5f, 0.25f, 1}};
    tl_tile_lay(&tile, &strand);
    const double corner = 2e-3 + sqrt(4e-6 - 2 * 0.25e-6); /* half a texel away on both axes */
    const size_t corners[] = {0, 31, 31 * 32, 31 * 32 + 31};
    for (int i = 0; i < 4; i++) {
        assert_near(tile.heights[corners[i]], corner, 1e-8);
        assert_near(tile.tints[3 * corners[i] + 1], 0.25, 0);
    }
    assert_near(tile.heights[16 * 32 + 16], -1, 0);
    tl_tile_release(&tile);
}

/* The mean slope within windows of `side` texels, by the normals: its root mean square over the windows. */
static double common_slope(const tl_weave *weave, int side)
{
    double sum = 0;
    int windows = 0;
    for (int top = 0; top + side <= weave->normal.height; top += side)
        for (int left = 0; left + side <= weave->normal.width; left += side, windows++) {
            double x = 0, y = 0;
            for (int i = 0; i < side * side; i++) {
                const size_t texel =
                    (size_t)(top + i / side) * (size_t)weave->normal.width + (size_t)(left + i % side);
                const uint8_t *n = tl_image_bytes(&weave->normal) + 3 * texel;
                x += (n[0] - 127.5) / (n[2] - 127.5) / (side * side);
                y += (n[1] - 127.5) / (n[2] - 127.5) / (side * side);
            }
            sum += x * x + y * y;
        }
    return sqrt(sum / windows);
}

/* A pile that leans stands one way within a patch and another way elsewhere: half a patch has a slope in
 * common, all of the tile has next to none, so that from afar the cloth has no grain. Without lean only the
 * tips' own slopes are left. */
static void test_pile_leans_in_patches(void **state)
{
    (void)state;
    struct tl_weave_params params = params_of(TL_WEAVE_PILE);
    params.nap = 2;
    params.fibre_mm = 0.1f;
    params.clump_mm = 4;
    params.crimp_mm = 0;
    tl_weave anyhow = make(&params);
    params.lean = 0.9f;
    tl_weave stroked = make(&params);
    const int patch = (int)(0.5 * 4e-3 / (double)stroked.size_m[0] * stroked.height.width);
    const double upright = common_slope(&anyhow, patch), leans = common_slope(&stroked, patch);
    const double whole = common_slope(&stroked, stroked.height.width);
    print_message("slope of half a patch: %.3f, leaning %.3f; of all of it %.3f\n", upright, leans, whole);
    assert_true(leans > 0.2 && leans > 4 * upright);
    assert_true(whole < 0.2 * leans);
    tl_weave_release(&anyhow);
    tl_weave_release(&stroked);
}

/* A piece of pile is as large as its fibres can be drawn; clumps and patches stay in millimetres. */
static void test_size_of_a_piece(void **state)
{
    (void)state;
    static const float fibres_mm[] = {0.02f, 0.12f, 0.5f}, sizes_mm[] = {32, 40.96f, 48};
    for (int i = 0; i < 3; i++) {
        struct tl_weave_params params = params_of(TL_WEAVE_PILE);
        params.fibre_mm = fibres_mm[i];
        params.nap = 0;
        tl_weave weave = make(&params);
        assert_near(1e3 * (double)weave.size_m[0], sizes_mm[i], 1e-3);
        assert_near(weave.size_m[1], weave.size_m[0], 0);
        tl_weave_release(&weave);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_spacings),
                                       cmocka_unit_test(test_ribs),
                                       cmocka_unit_test(test_purl_and_interlock),
                                       cmocka_unit_test(test_maps),
                                       cmocka_unit_test(test_no_pattern_of_tiles),
                                       cmocka_unit_test(test_a_strand_at_the_corner),
                                       cmocka_unit_test(test_pile_leans_in_patches),
                                       cmocka_unit_test(test_size_of_a_piece)};
    return cmocka_run_group_tests_name("knit", tests, NULL, release_weaves);
}
