/* The legend of the image's colours, and the values under the pointer. Reads the state, changes nothing. */
#ifndef TOILE_APP_VIEW_REVIEW_REVIEW_READ_H
#define TOILE_APP_VIEW_REVIEW_REVIEW_READ_H

#include "app/view/review/review.h"

/* Surface, normal, strain and visibility under the pointer, as lines of text; "" when there is nothing to
 * print. */
void tl_review_read_out(const struct tl_review *review, char *text, size_t size);
/* The colours of the image's view for the panel; false when it shows light. */
bool tl_review_legend(const struct tl_review *review, struct tl_panel_legend *out);

#endif
