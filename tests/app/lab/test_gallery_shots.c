/* The gallery's pictures are of the first frame, also after a strip, whose environment has played. */
#include "tests/testing.h"

#include "app/lab/gallery/moving_sky.h"
#include "app/lab/gallery/shots.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <string.h>

static const struct tl_technique techniques[] = {{.picture = "shown", .id = "D11"}};
static const struct tl_experiment section = {
    .name = "shots",
    .title = "D11  A strip",
    .scene = "gallery",
    .exact_text = "the same",
    .solid = "torus",
    .base = {"scene.environment=@sky.####.exr", "light.method=unshadowed"},
    .techniques = techniques,
    .technique_count = TL_COUNT(techniques),
    .ids = {"D11"},
    .output = TL_OUTPUT_PICTURES,
    .motion = TL_MOTION_SKY,
    .motion_step = 1,
    .side = 64};

static void strips_leave_no_trace(void **state)
{
    (void)state;
    tl_error error = {0};
    struct tl_shots shots;
    struct tl_gallery_shot before, after, exact[TL_STRIP_FRAMES], tested[TL_STRIP_FRAMES];
    struct tl_experiment_picture picture = {.experiment = &section,
                                            .folder = TOILE_SCRATCH_DIR "/gallery_shots"};
    assert_true(tl_picture_next(&picture, TL_OUTPUT_PICTURES));
    assert_ok(tl_folder_make(picture.folder, &error), error);
    assert_ok(tl_moving_sky_make(&picture, &error), error);
    assert_ok(tl_shots_open(&shots, &error), error);
    assert_ok(tl_shots_draw(&shots, &picture, TL_PICTURE_SOLID, &before, &error), error);
    assert_ok(tl_shots_strip(&shots, &picture, exact, tested, &error), error);
    assert_ok(tl_shots_draw(&shots, &picture, TL_PICTURE_SOLID, &after, &error), error);
    const size_t bytes = (size_t)3 * 64 * 64, strip_bytes = (size_t)3 * TL_STRIP_SIDE * TL_STRIP_SIDE;
    assert_memory_equal(tl_image_bytes(&before.shown), tl_image_bytes(&after.shown), bytes);
    for (int i = 0; i < TL_STRIP_FRAMES; i++) {
        assert_memory_equal(tl_image_bytes(&exact[i].shown), tl_image_bytes(&tested[i].shown), strip_bytes);
        if (i > 0) /* the environment moves */
            assert_memory_not_equal(tl_image_bytes(&tested[i].shown), tl_image_bytes(&tested[i - 1].shown),
                                    strip_bytes);
        tl_gallery_shot_release(&exact[i]);
    }
    for (int i = 0; i < TL_STRIP_FRAMES; i++)
        tl_gallery_shot_release(&tested[i]);
    tl_gallery_shot_release(&before);
    tl_gallery_shot_release(&after);
    tl_shots_close(&shots);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(strips_leave_no_trace)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
