/* The review window's state, and what all of its parts need: messages, the size of the view, whether
 * something moves.
 *
 * The parts of this room change the state; each owns the struct that its header defines. The rooms above turn
 * input into calls of the parts (app/view/command/review_commands.h, review_input.h) and show the state
 * (review_panel.h).
 *
 *     review_edit    edits of the settings: names, dropped files, undo
 *     review_load    scenes, environments and appearances, loaded on a worker thread (loader)
 *     review_draw    when an image is drawn, and how it gets on the screen
 *     review_move    turntable, glides to saved views, camera paths
 *     review_hand    the pointer's point on the garment, and the hand that pulls it
 *     review_place   where the garment's file stands, and the handles that move it
 *     review_reading units and axes of the files
 *     review_wipe    two appearances, or two drapes, side by side
 *     review_read    the legend of the image's colours, and the values under the pointer
 *     review_keep    state that is kept between runs; files that are reloaded when they are edited
 *     review_memory  the process's memory
 *
 * Threads: the window's only. Lifetime: cmd_view.c creates and closes it. */
#ifndef TOILE_APP_VIEW_REVIEW_REVIEW_H
#define TOILE_APP_VIEW_REVIEW_REVIEW_H

#include "app/view/memory/state.h"
#include "app/view/panel/panel_shim.h"
#include "app/view/review/review_draw.h"
#include "app/view/review/review_edit.h"
#include "app/view/review/review_hand.h"
#include "app/view/review/review_keep.h"
#include "app/view/review/review_load.h"
#include "app/view/review/review_memory.h"
#include "app/view/review/review_move.h"
#include "app/view/review/review_place.h"
#include "app/view/review/review_reading.h"
#include "app/view/review/review_wipe.h"
#include "app/view/thumbnails/thumbnails.h"
#include "app/view/window/window.h"

struct tl_review_message {
    char text[1200]; /* "": none is shown */
    bool is_error;
    double shown_s; /* when it was set */
};

struct tl_review_screen {
    tl_window *window;
    tl_gpu *gpu;
    tl_panel *panel;
    tl_thumbnails *thumbnails;
    struct tl_window_params params; /* edited like `wanted` */
    struct tl_review_message message;
};

/* Requests to the next frame. */
struct tl_review_due {
    bool changed;      /* `wanted` was edited since the last image */
    bool image_is_old; /* the session has changed since the last image */
    int redraws;       /* frames to present with the same image, because the panel changes */
    double moved_s;    /* time of the last move of the camera, the light or a slider */
    bool closing;
};

/* The simulation or the playback. */
struct tl_review_play {
    bool is_on;
    double next_step_s; /* while it is on: time of the next simulated frame */
    bool is_beside;     /* since it is on, cloth was stepped while an image was drawn */
    double speed;       /* of the last frames, as a share of real time; 1 when playing begins */
};

enum tl_review_drag {
    TL_DRAG_NONE,
    TL_DRAG_ORBIT,
    TL_DRAG_PAN,
    TL_DRAG_LIGHT,
    TL_DRAG_CLOTH,
    TL_DRAG_WIPE,
    TL_DRAG_PLACE
};

/* Pointer, keys and panel. app/view/command writes it, except `drag`. */
struct tl_review_input {
    enum tl_review_drag drag;
    int button;       /* of the drag */
    float x, y;       /* of the pointer, pixels */
    double pressed_s; /* time of the last press, for double clicks */
    float pressed_x, pressed_y;
    bool panel_has_keys;            /* a field is typed into */
    bool editing;                   /* a widget of the panel is held: further edits are expected */
    const struct tl_option *listed; /* whose list of choices is open in the panel; NULL: none */
    bool help_shown, reads_out;
    struct tl_cloth_report report; /* in the panel */
    int reported_frame;            /* -1: of another session */
    double reported_s;
};

struct tl_review {
    struct tl_review_screen screen;
    tl_renderer *renderer;
    tl_session *session;
    struct tl_settings
        wanted; /* edited by keys, pointer and panel; the session follows as fast as it can load */
    struct tl_settings good; /* the last settings that were drawn; restored after a failure */
    struct tl_review_due due;
    struct tl_review_play play;
    struct tl_review_input input;
    struct tl_review_image image;
    struct tl_review_load load;
    struct tl_review_edit edit;
    struct tl_review_keep keep;
    struct tl_review_motion motion;
    struct tl_review_path path;
    struct tl_review_hand hand;
    struct tl_review_placing placing;
    struct tl_review_reading reading;
    struct tl_review_wipe wipe;
    struct tl_review_memory memory;
};

/* The view's size: the window without the panel. Pixels. */
void tl_review_size(const struct tl_review *review, int *width, int *height);
int tl_review_panel_width(const struct tl_review *review); /* pixels; 0 when hidden */

/* Shows a message over the view for some seconds, and logs it. */
void tl_review_report(struct tl_review *review, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* Shows an error until it is dismissed, logs it as a warning, and pauses. */
void tl_review_report_error(struct tl_review *review, const tl_error *error);
void tl_review_clear_message(struct tl_review *review);
/* Clears a message, but no error, that has been shown for long enough. */
void tl_review_expire_message(struct tl_review *review);

/* Starts or pauses the simulation or the playback, from now on. */
void tl_review_set_playing(struct tl_review *review, bool plays);

/* Requests the next image: `wanted` was edited; the session has changed. review_draw takes the requests back.
 */
void tl_review_mark_changed(struct tl_review *review);
void tl_review_mark_old(struct tl_review *review);

void tl_review_set_drag(struct tl_review *review, enum tl_review_drag drag);

/* Notes that the camera, the light or a slider has just moved: coarse images are allowed for a moment. */
void tl_review_note_motion(struct tl_review *review);
bool tl_review_is_moving(const struct tl_review *review);    /* coarse images are allowed */
bool tl_review_moves_itself(const struct tl_review *review); /* turntable, environment, glide or path */

#endif
