/* A frame's time includes what GL draws after it has taken the commands: with a clock that only GL's drawing
 * moves on, the time that the governor learns from is that of the drawing. The window, the panel, the
 * renderer and the clock are replaced at link time. */
#include "app/view/review/review.h"
#include "app/view/review/review_draw.h"
#include "config/base/memory.h"

#include "tests/testing.h"

#include <epoxy/gl.h>

#define RASTER_MS 7.0

static struct {
    double now_s, learnt_ms, shown_s;
    int pending; /* commands that GL has taken */
} stage;

double __wrap_tl_clock_s(void);
void __wrap_tl_panel_draw(tl_panel *panel);
bool __wrap_tl_renderer_show_columns(tl_renderer *renderer, int width, int height, int first, int end,
                                     tl_error *error);
void __wrap_tl_review_size(const struct tl_review *review, int *width, int *height);
void __wrap_tl_window_show(tl_window *window);
void __wrap_tl_quality_governor_learn(tl_quality_governor *governor, const tl_plan *plan, double cloth_ms,
                                      double total_ms);
const tl_plan *__wrap_tl_renderer_last_plan(const tl_renderer *renderer);

double __wrap_tl_clock_s(void)
{
    return stage.now_s;
}

void __wrap_tl_panel_draw(tl_panel *panel)
{
    (void)panel;
    stage.pending++;
}

bool __wrap_tl_renderer_show_columns(tl_renderer *renderer, int width, int height, int first, int end,
                                     tl_error *error)
{
    (void)renderer, (void)width, (void)height, (void)first, (void)end, (void)error;
    stage.pending++;
    return true;
}

void __wrap_tl_review_size(const struct tl_review *review, int *width, int *height)
{
    (void)review;
    *width = *height = 100;
}

void __wrap_tl_window_show(tl_window *window)
{
    (void)window;
    stage.shown_s = stage.now_s;
}

void __wrap_tl_quality_governor_learn(tl_quality_governor *governor, const tl_plan *plan, double cloth_ms,
                                      double total_ms)
{
    (void)governor, (void)plan, (void)cloth_ms;
    stage.learnt_ms = total_ms;
}

const tl_plan *__wrap_tl_renderer_last_plan(const tl_renderer *renderer)
{
    static const tl_plan none;
    (void)renderer;
    return &none;
}

static void finish(void)
{
    stage.now_s += 1e-3 * RASTER_MS * stage.pending;
    stage.pending = 0;
}

static void a_frames_time_includes_the_raster(void **state)
{
    (void)state;
    struct tl_review *review = TL_NEW(struct tl_review);
    tl_error error = {0};
    epoxy_glFinish = finish;
    stage.now_s = 100;
    review->image.times.began_s = stage.now_s;
    review->image.is_new = review->image.is_budgeted = true;
    assert_true(tl_review_present(review, &error));
    assert_near(stage.learnt_ms, 2 * RASTER_MS, 1e-6); /* the image and the panel */
    assert_near(review->image.times.frame, 2 * RASTER_MS, 1e-6);
    assert_int_equal(stage.pending, 0);
    assert_near(stage.shown_s, 100 + 2e-3 * RASTER_MS, 1e-6);
    free(review);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_frames_time_includes_the_raster)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
