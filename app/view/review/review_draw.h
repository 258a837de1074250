/* When an image of the review window is drawn, and how it gets on the screen: within the budget while
 * something moves, sharp and with smooth edges as soon as nothing does. Owns `times`, the governor, and the
 * flags changed, image_is_old, is_budgeted and is_new. */
#ifndef TOILE_APP_VIEW_REVIEW_REVIEW_DRAW_H
#define TOILE_APP_VIEW_REVIEW_REVIEW_DRAW_H

#include "app/view/review/review.h"

/* Simulates and draws what is due. What cannot be drawn is reported, and the last good settings are drawn
 * instead; false only when these fail too, or on an interrupt. */
bool tl_review_update_image(struct tl_review *review, tl_error *error);
/* Whether the image is one of a rest: every pixel drawn, edges smoothed. */
bool tl_review_is_sharp(const struct tl_review *review);
/* Draws the first image, in the settings as they are. */
bool tl_review_draw_first(struct tl_review *review, tl_error *error);
/* Draws an image for a file at the quality of the settings, as `toile render` does, and with smooth edges;
 * unless there is one. */
bool tl_review_draw_sharp(struct tl_review *review, tl_error *error);
/* Whether drawing again would not refine the image: its rounds and its shifted images are averaged. */
bool tl_review_is_at_rest(const struct tl_review *review);

/* Ends a part of the current frame other than drawing; --verbose logs the longest part of a slow frame. */
void tl_review_lap(struct tl_review *review, const char *part);
/* Puts the last image, and the panel as it was built, on the screen. */
bool tl_review_present(struct tl_review *review, tl_error *error);

#endif
