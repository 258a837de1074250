/* Motion without input, and the frame: turntable, environment, glides to saved views, recorded and played
 * camera paths. It follows the clock, so that a slow machine shows fewer steps of the same motion. Owns
 * `motion` and `path`.
 */
#ifndef TOILE_APP_VIEW_REVIEW_REVIEW_MOVE_H
#define TOILE_APP_VIEW_REVIEW_REVIEW_MOVE_H

#include "app/scene/path.h"
#include "app/view/memory/saved_views.h"

struct tl_review;

/* Motion without input. */
struct tl_review_motion {
    bool turntable, environment;
    double moved_s; /* time of the last step */
    bool glides;    /* from one saved view to another */
    struct tl_saved_view from, to;
    double glide_began_s;
};

struct tl_review_path {
    struct tl_path path; /* count 0: none yet */
    char *file;          /* where it is saved; NULL: nowhere yet */
    bool records, plays;
    double began_s;
    double key_due_s; /* while recording: time of the next key */
};

/* Sets camera and light in `wanted` for the present time, and records a key when one is due; called every
 * frame. */
void tl_review_move(struct tl_review *review);
/* Ends glides and played paths, because the user takes over. */
void tl_review_stop_moving(struct tl_review *review);
/* Gives an automatically framed camera the distance and target that it has now: panning and zooming start
 * from them. */
void tl_review_fix_camera(struct tl_review *review);
/* Glides to the saved view of this index, or reports that there is none. */
void tl_review_go_to_view(struct tl_review *review, int index);
/* Starts or stops one of `motion`'s turntables; `name` is for the report. */
void tl_review_toggle(struct tl_review *review, bool *turntable, const char *name);

/* Pauses at a frame. One that is played back is reached at once; cloth is simulated up to it. */
void tl_review_go_to_frame(struct tl_review *review, int frame);

/* The camera path: adds a key by hand; starts or ends recording; starts or stops playing. */
void tl_review_path_add(struct tl_review *review);
void tl_review_path_record(struct tl_review *review);
void tl_review_path_play(struct tl_review *review);
void tl_review_path_release(struct tl_review_path *path); /* frees and zeroes */

#endif
