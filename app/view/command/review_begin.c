#include "app/view/command/review_begin.h"

#include "app/view/review/review_load.h"
#include "config/base/interrupt.h"

#include <epoxy/gl.h>

static void show_progress(struct tl_review *review)
{
    char text[256];
    int width, height;
    tl_window_size(review->screen.window, &width, &height);
    const struct tl_panel_input input = {.message = "",
                                         .status = "",
                                         .progress = tl_review_progress(review, text, sizeof text),
                                         .height = height};
    const float surround = 0.13f; /* the panel's grey */
    glViewport(0, 0, width, height);
    glClearColor(surround, surround, surround, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    tl_panel_build(review->screen.panel, &input);
    tl_panel_draw(review->screen.panel);
    tl_window_show(review->screen.window);
}

/* Only closing the window and Esc have a meaning before there is a scene. */
static void handle_events(struct tl_review *review)
{
    struct tl_window_event event;
    while (tl_window_next(review->screen.window, &event)) {
        review->due.closing |= event.type == TL_WINDOW_CLOSE || tl_window_is_escape(&event);
        tl_window_event_release(&event);
    }
}

bool tl_review_load_first(struct tl_review *review, tl_error *error)
{
    const double tick_s = 0.1;
    tl_review_start_first(review);
    while (!tl_loader_is_done(review->load.loader)) {
        tl_window_wait(review->screen.window, tick_s);
        handle_events(review);
        if (review->due.closing)
            return tl_fail(error, TL_INTERRUPTED, "view: closed");
        if (tl_interrupted())
            return tl_fail(error, TL_INTERRUPTED, "view: stopped");
        show_progress(review);
    }
    return tl_review_finish_first(review, error);
}
