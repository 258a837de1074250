/* Two appearances side by side: A, on the left, is what the settings were when the comparison began; B, on
 * the right, is what they are. Camera, light and cloth are the same. Owns `wipe`. */
#ifndef TOILE_APP_VIEW_REVIEW_REVIEW_WIPE_H
#define TOILE_APP_VIEW_REVIEW_REVIEW_WIPE_H

#include "app/view/review/review.h"

void tl_review_compare(struct tl_review *review); /* starts or ends a comparison */
void tl_review_swap(struct tl_review *review);    /* A becomes B */
/* Moves the line between them to a share of the view's width. */
void tl_review_move_wipe(struct tl_review *review, float place);
/* The line's column in a view of this width, pixels; 0 when nothing is compared. */
int tl_review_wipe_column(const struct tl_review *review, int width);
/* Settings that show A where `settings` show B: the same scene, light and cloth. */
struct tl_settings tl_review_settings_a(const struct tl_review *review, const struct tl_settings *settings);
/* Names of A and B, and what differs. Both of `size` bytes. */
void tl_review_wipe_labels(const struct tl_review *review, char *a, char *b, size_t size);

#endif
