/* The review window before it has a scene: loads the first one and shows progress. */
#ifndef TOILE_APP_VIEW_COMMAND_REVIEW_BEGIN_H
#define TOILE_APP_VIEW_COMMAND_REVIEW_BEGIN_H

#include "app/view/review/review.h"

/* Loads `wanted` into `session`. False when it cannot be loaded, or when the window was closed meanwhile:
 * then `closing` is set, and the error is TL_INTERRUPTED. */
bool tl_review_load_first(struct tl_review *review, tl_error *error);

#endif
