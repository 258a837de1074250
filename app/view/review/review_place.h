/* How the files of the scene were read (their units and the axis that points up), and where the garment's
 * file stands. Owns `reading`.
 *
 * A reading that was guessed, and a garment of another size than its body, are shown until they are accepted.
 * U, A and drags set the scene's options units, up, scale, turn_deg and move_m, and the notice says how the
 * command line does the same. */
#ifndef TOILE_APP_VIEW_REVIEW_REVIEW_PLACE_H
#define TOILE_APP_VIEW_REVIEW_REVIEW_PLACE_H

#include "app/view/review/review.h"

/* After a scene was loaded: what of it was guessed. */
void tl_review_note_reading(struct tl_review *review);
/* Accepts what is shown; false: nothing is. */
bool tl_review_keep_reading(struct tl_review *review);

/* Reads the file in the next unit (by 1) or the previous one (by -1); turns it to the other axis. The file is
 * the one that the notice is about, or the garment's, or the body's. */
void tl_review_next_units(struct tl_review *review, int by);
void tl_review_next_up(struct tl_review *review);

/* Starts to move the garment's file; reports why it cannot. */
bool tl_review_place_begin(struct tl_review *review);
/* A drag by view heights: moves it in the plane of the image, or turns it about the vertical through its
 * middle. */
void tl_review_place_move(struct tl_review *review, float dx, float dy);
void tl_review_place_turn(struct tl_review *review, float dx);
/* Sizes it about its middle. */
void tl_review_place_scale(struct tl_review *review, float factor);

#endif
