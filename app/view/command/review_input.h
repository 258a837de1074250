/* Keys and pointer gestures of the review window: events become commands (review_commands.h) and drags. */
#ifndef TOILE_APP_VIEW_COMMAND_REVIEW_INPUT_H
#define TOILE_APP_VIEW_COMMAND_REVIEW_INPUT_H

struct tl_review;

/* Handles every event in the window's queue. */
void tl_review_handle_events(struct tl_review *review);

#endif
