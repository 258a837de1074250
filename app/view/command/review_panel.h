/* The panel of the review window: what it shows (options, measures, plan, buttons) and what its widgets
 * change. */
#ifndef TOILE_APP_VIEW_COMMAND_REVIEW_PANEL_H
#define TOILE_APP_VIEW_COMMAND_REVIEW_PANEL_H

struct tl_review;

/* Builds the panel of this frame from the state, and carries out edits, buttons and answers. */
void tl_review_build_panel(struct tl_review *review);

#endif
