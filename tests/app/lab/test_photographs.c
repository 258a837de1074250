/* Photographs that the program takes of its own weave, measured: its normals and colours come back, to a few
 * tenths of a degree more than those without gloss of tests/assets/swatch (lamps that are 20 degrees off
 * leave 3), and what wears them looks as the weave under another lamp. */
#include "tests/testing.h"

#include "app/lab/experiments/experiments.h"
#include "app/lab/gallery/gallery.h"

#include <stdlib.h>
#include <string.h>

static void a_weave_comes_back(void **state)
{
    (void)state;
    char folder[] = "/tmp/toile_photographs_XXXXXX";
    assert_non_null(mkdtemp(folder));
    struct tl_experiment small = *tl_experiment_find(TL_OUTPUT_PICTURES, "c15");
    struct tl_experiment_picture picture = {.experiment = &small, .folder = folder};
    struct tl_photographs_error found[TL_PHOTOGRAPHS_RIGS];
    struct tl_shots shots;
    tl_error error = {0};
    small.side = 128;
    assert_ok(tl_shots_open(&shots, &error), error);
    assert_ok(tl_photographs_make(&shots, &picture, found, &error), error);
    for (int i = 0; i < TL_PHOTOGRAPHS_RIGS; i++) {
        print_message("%2d lamps: normals %.2f degrees, colours %.2f %%\n", found[i].lamps,
                      found[i].normal_deg, 100 * found[i].albedo);
        assert_true(found[i].normal_deg < 1 && found[i].albedo < 0.02); /* what came out: 0.67 and 0.014 */
    }
    /* as the plot's caption has it */
    assert_true(found[TL_PHOTOGRAPHS_RIGS - 1].normal_deg < found[0].normal_deg);
    while (tl_picture_next(&picture, TL_OUTPUT_PICTURES)) {
        struct tl_gallery_shot tested;
        double off;
        const struct tl_gallery_shot *exact = tl_shots_exact(&shots, &picture, TL_PICTURE_SOLID, &error);
        assert_ok(exact && tl_shots_draw(&shots, &picture, TL_PICTURE_SOLID, &tested, &error), error);
        assert_ok(tl_gallery_measure_error(&small, &tested, exact, &off, &error), error);
        print_message("%s worn: %.4f\n", picture.technique->picture, off);
        assert_true(off < 0.08); /* as tests/app/cli/cli_fabric.sh has it */
        tl_gallery_shot_release(&tested);
    }
    tl_shots_close(&shots);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_weave_comes_back)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
