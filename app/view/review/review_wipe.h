/* Two appearances side by side: A, on the left, is what the settings were when the comparison began; B, on
 * the right, is what they are. Camera and light are the same. The cloth is the same until B is draped in
 * another fabric or loads another scene: A then keeps the session as it was, which follows the frames of B's.
 * Owns `wipe`. */
#ifndef TOILE_APP_VIEW_REVIEW_REVIEW_WIPE_H
#define TOILE_APP_VIEW_REVIEW_REVIEW_WIPE_H

#include "app/scene/session.h"

struct tl_review;

/* A, on the left, is what the settings were; B, on the right, is what they are. */
struct tl_review_wipe {
    tl_renderer *renderer;         /* of A; NULL: nothing is compared */
    struct tl_settings settings;   /* of A */
    tl_session *session;           /* of A, once B is another drape or scene; NULL: A is drawn from B's */
    struct tl_cloth_fabric draped; /* that the garment of A's session hangs in */
    float place;                   /* of the line between A and B, as a share of the view's width */
};

void tl_review_compare(struct tl_review *review);        /* starts or ends a comparison */
void tl_review_end_comparison(struct tl_review *review); /* without a word; nothing need be compared */
void tl_review_swap(struct tl_review *review);           /* A becomes B */
/* Keeps for A, while something is compared and A has no session of its own, the session that B has left, and
 * nulls *left. To be called before review->draped is B's. */
void tl_review_keep_for_a(struct tl_review *review, tl_session **left);
/* Draws A where `settings` show B, at the levels of the image; `smooth` as tl_frame has it. B's session has
 * been brought to the frame to be drawn, and shows B again afterwards. Errors: as tl_session_go_to,
 * tl_session_apply and tl_renderer_draw. */
bool tl_review_draw_a(struct tl_review *review, const struct tl_settings *settings, bool smooth,
                      tl_error *error);
/* Moves the line between them to a share of the view's width. */
void tl_review_move_wipe(struct tl_review *review, float place);
/* The line's column in a view of this width, pixels; 0 when nothing is compared. */
int tl_review_wipe_column(const struct tl_review *review, int width);
/* Settings that show A where `settings` show B: the same camera and light, and the same scene unless A has
 * one of its own. */
void tl_review_settings_a(const struct tl_review *review, const struct tl_settings *settings,
                          struct tl_settings *out);
/* Names of A and B, and what differs. Both of `size` bytes. */
void tl_review_wipe_labels(const struct tl_review *review, char *a, char *b, size_t size);

#endif
