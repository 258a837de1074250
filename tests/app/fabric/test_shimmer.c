/* Shimmer of fabrics that move by parts of a pixel: it tells filtered maps from those that are not. */
#include "tests/testing.h"

#include "app/fabric/shimmer.h"
#include "config/base/memory.h"

static double shimmer_of(const char *fabric, const char *filter)
{
    const char *const assignments[] = {fabric,
                                       filter,
                                       "cloth.edge_m=0.03",
                                       "cloth.settle_s=0",
                                       "image.ground=false",
                                       "image.background=grey"};
    const struct tl_settings_source source = {"cusick", assignments, TL_COUNT(assignments)};
    struct tl_headless headless;
    struct tl_settings settings;
    double shimmer = 0;
    tl_error error = {0};
    assert_ok(tl_settings_load(&settings, &source, &error), error);
    assert_ok(tl_headless_open(&headless, &settings, &error), error);
    assert_ok(tl_shimmer_measure(&headless, &shimmer, &error), error);
    tl_headless_release(&headless);
    printf("%s, %s: shimmer %.3f %%\n", fabric, filter, 100 * shimmer);
    return shimmer;
}

/* A weave finer than pixels: without LEAN its gloss comes and goes. Smooth cloth of one colour does not
 * shimmer, whatever the filter. */
static void test_lean_lowers_it(void **state)
{
    (void)state;
    const double lean = shimmer_of("scene.fabric=satin", "detail.minify=lean");
    const double none = shimmer_of("scene.fabric=satin", "detail.minify=none");
    assert_true(none > 1.5 * lean);
    const double smooth = shimmer_of("scene.fabric=none", "weave.pattern=none");
    assert_true(smooth < 0.002 && smooth < lean);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_lean_lowers_it)};
    return cmocka_run_group_tests_name("shimmer", tests, NULL, NULL);
}
