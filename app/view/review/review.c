#include "app/view/review/review.h"

#include "config/base/log.h"

#include <stdarg.h>
#include <stdio.h>

#define MESSAGE_S 6.0 /* how long a message is shown; an error stays until it is dismissed */

int tl_review_panel_width(const struct tl_review *review)
{
    const float usual = 380; /* at scale 1 */
    int width, height;
    tl_window_size(review->screen.window, &width, &height);
    int panel = (int)(usual * tl_window_scale(review->screen.window));
    return !review->screen.params.panel ? 0 : panel < width / 2 ? panel : width / 2;
}

void tl_review_size(const struct tl_review *review, int *width, int *height)
{
    tl_window_size(review->screen.window, width, height);
    *width -= tl_review_panel_width(review);
}

static void set_message(struct tl_review *review, bool is_error, const char *text)
{
    snprintf(review->screen.message.text, sizeof review->screen.message.text, "%s", text);
    review->screen.message.is_error = is_error;
    review->screen.message.shown_s = tl_clock_s();
    review->due.redraws = review->due.redraws > 1 ? review->due.redraws : 1;
}

void tl_review_report(struct tl_review *review, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    char text[sizeof review->screen.message.text];
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    set_message(review, false, text);
    tl_info("view: %s", text);
}

void tl_review_report_error(struct tl_review *review, const tl_error *error)
{
    set_message(review, true, error->message);
    tl_warn("view: %s", error->message);
    review->play.is_on = false;
}

void tl_review_clear_message(struct tl_review *review)
{
    set_message(review, false, "");
}

void tl_review_expire_message(struct tl_review *review)
{
    bool is_due = tl_clock_s() - review->screen.message.shown_s > MESSAGE_S;
    if (review->screen.message.text[0] && !review->screen.message.is_error && is_due)
        tl_review_clear_message(review);
}

void tl_review_mark_changed(struct tl_review *review)
{
    review->due.changed = true;
}

void tl_review_mark_old(struct tl_review *review)
{
    review->due.image_is_old = true;
}

void tl_review_set_drag(struct tl_review *review, enum tl_review_drag drag)
{
    review->input.drag = drag;
}

void tl_review_note_motion(struct tl_review *review)
{
    review->due.moved_s = tl_clock_s();
}

bool tl_review_is_moving(const struct tl_review *review)
{
    const double rest_s = 0.25;
    return review->play.is_on || tl_review_moves_itself(review) || review->input.drag != TL_DRAG_NONE ||
           tl_clock_s() - review->due.moved_s < rest_s;
}

bool tl_review_moves_itself(const struct tl_review *review)
{
    const struct tl_review_motion *motion = &review->motion;
    return motion->turntable || motion->environment || motion->glides || review->path.plays;
}

void tl_review_set_playing(struct tl_review *review, bool plays)
{
    tl_error error;
    if (!plays && !tl_session_take_step(review->session, &error))
        tl_review_report_error(review, &error);
    review->due.image_is_old |= review->play.is_beside;
    review->play.is_on = plays;
    review->play.is_beside = false;
    review->play.next_step_s = tl_clock_s();
    review->play.speed = 1;
    tl_info("view: %s at frame %d", plays ? "plays" : "paused", tl_session_frame_number(review->session));
}
