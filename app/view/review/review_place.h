/* The placement of the garment's file: the scene's options scale, turn_deg and move_m, set by handles over
 * the image or by drags with Ctrl and Shift held. Owns `placing`.
 *
 * A drag moves the garment as it is drawn; when it ends, the scene is loaded with the new place. Only a
 * garment from a file that plays no motion can be placed. */
#ifndef TOILE_APP_VIEW_REVIEW_REVIEW_PLACE_H
#define TOILE_APP_VIEW_REVIEW_REVIEW_PLACE_H

#include "app/view/gizmo/gizmo.h"
#include "app/view/gizmo/gizmo_shapes.h"
#include "assets/base/placing.h"

struct tl_review;

/* Placing the garment's file by the pointer. */
struct tl_review_placing {
    bool shown;                       /* the handles */
    enum tl_gizmo_handle under, held; /* the pointer; held: NONE but in a drag of a handle */
    bool is_anywhere;                 /* a drag that began beside the handles, with keys that choose it */
    struct tl_gizmo gizmo;            /* when the drag began */
    struct tl_placing before;
    vec2s from, to; /* pixels; `to` goes slower than the pointer while the drag is fine */
    struct tl_gizmo_change change;
};

/* Shows or hides the handles; reports why there are none. */
void tl_review_place_toggle(struct tl_review *review);
/* Hides them; false: they are not shown. */
bool tl_review_place_hide(struct tl_review *review);

/* The handle under the pointer is marked from now on. Pixels. */
void tl_review_place_hover(struct tl_review *review, float x, float y);
/* Starts to drag the handle under the pointer; false: there is none. */
bool tl_review_place_catch(struct tl_review *review, float x, float y);
/* Starts a drag that moves the garment in the plane of the image, wherever the pointer is; `turns`: one of
 * tl_review_place_turn. Reports why the garment cannot be moved. */
bool tl_review_place_begin(struct tl_review *review, float x, float y, bool turns);
/* A drag that was begun goes on: Shift makes it ten times as fine, Ctrl snaps to whole steps. */
void tl_review_place_drag(struct tl_review *review, float dx, float dy, int modifiers);
/* Turns the garment by view heights about the vertical through its middle. */
void tl_review_place_turn(struct tl_review *review, float dx);
/* Sizes it about its middle. */
void tl_review_place_scale(struct tl_review *review, float factor);
/* Ends a drag and reports the place as the command line has it. */
void tl_review_place_end(struct tl_review *review);
/* Ends a drag as if it had not begun; false: there is none. */
bool tl_review_place_cancel(struct tl_review *review);

/* Draws the garment where it is wanted while the session still has it elsewhere; called every frame. */
void tl_review_follow_place(struct tl_review *review);

/* The overlay of the view, and the text next to the pointer: "X +12.5 mm" in a drag, else "". */
void tl_review_place_shapes(const struct tl_review *review, struct tl_gizmo_shapes *out);
void tl_review_place_amount(const struct tl_review *review, char *text, size_t size);

#endif
