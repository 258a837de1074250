/* The legend of the image's colours, and the values under the pointer. Reads the state, changes nothing. */
#ifndef TOILE_APP_VIEW_REVIEW_REVIEW_READ_H
#define TOILE_APP_VIEW_REVIEW_REVIEW_READ_H

#include "app/view/panel/panel_shim.h"

struct tl_review;

/* Surface, normal, strain and visibility under the pointer, as lines of text; "" when there is nothing to
 * print. */
void tl_review_read_out(const struct tl_review *review, char *text, size_t size);
/* Positions in the view of the point of the cloth under the pointer, framebuffer pixels: on the garment and
 * on its pattern. Returns how many there are: 0 unless the pattern is shown and the pointer is on either. */
#define TL_REVIEW_MARKS 2
size_t tl_review_marks(const struct tl_review *review, float marks[TL_REVIEW_MARKS][2]);
/* The colours of the image's view for the panel; false when it shows light. */
bool tl_review_legend(const struct tl_review *review, struct tl_panel_legend *out);

#endif
