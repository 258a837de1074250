/* The review window's state, and what all of its parts need: messages, the size of the view, whether
 * something moves.
 *
 * The parts of this room change the state; each owns the fields that its header names. The rooms above turn
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

#include "app/budget/governor.h"
#include "app/scene/path.h"
#include "app/scene/session.h"
#include "app/view/gizmo/gizmo.h"
#include "app/view/loader/loader.h"
#include "app/view/memory/history.h"
#include "app/view/memory/journal.h"
#include "app/view/memory/recent.h"
#include "app/view/memory/saved_views.h"
#include "app/view/memory/state.h"
#include "app/view/panel/panel_shim.h"
#include "app/view/thumbnails/thumbnails.h"
#include "app/view/window/file_chooser.h"
#include "app/view/window/file_watch.h"
#include "app/view/window/frame_times.h"
#include "app/view/window/window.h"

enum tl_review_drag {
    TL_DRAG_NONE,
    TL_DRAG_ORBIT,
    TL_DRAG_PAN,
    TL_DRAG_LIGHT,
    TL_DRAG_CLOTH,
    TL_DRAG_WIPE,
    TL_DRAG_PLACE
};

struct tl_review_times {       /* of the last frame that had such a part */
    double frame, cloth, draw; /* ms; frame: from its start to the swap of buffers */
    double began_s;            /* when the current frame began */
    double panel_s;            /* when the panel was built */
    double lap_s;              /* when its last part ended */
    const char *longest;       /* its longest part so far other than drawing */
    double longest_ms;
};

/* The way in which images at rest are drawn. */
struct tl_review_rest {
    struct tl_quality levels;
    int samples;     /* a pixel side */
    bool is_shifted; /* the mean of shifted images: tl_frame.smooth */
};

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

/* A, on the left, is what the settings were; B, on the right, is what they are. */
struct tl_review_wipe {
    tl_renderer *renderer;         /* of A; NULL: nothing is compared */
    struct tl_settings settings;   /* of A */
    tl_session *session;           /* of A, once B is another drape or scene; NULL: A is drawn from B's */
    struct tl_cloth_fabric draped; /* that the garment of A's session hangs in */
    float place;                   /* of the line between A and B, as a share of the view's width */
};

/* The reading of the file of a garment or a body; kept: what the user has accepted. */
enum tl_reading_of { TL_READING_NONE, TL_READING_GARMENT, TL_READING_AVATAR, TL_READING_COUNT };
struct tl_review_reading {
    enum tl_reading_of of;     /* whose reading is shown */
    char name[TL_STRING_SIZE]; /* of its file */
    char kept[TL_READING_COUNT][TL_STRING_SIZE];
    char kept_size[512];
    char notice[1024]; /* "": none is shown */
};

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

struct tl_review;
struct tl_review_answer {
    const char *label, *help;
    void (*use)(struct tl_review *review, const char *path); /* NULL: the file is not used */
};

/* The garments that were opened last; while they are offered, one answer each. */
struct tl_review_recent {
    struct tl_recent files;
    size_t offered; /* 0: they are not */
    struct tl_review_answer answers[TL_RECENT_MAX];
};

struct tl_review_memory {
    size_t min_unused; /* bytes: the minimum since memory was last returned to the system */
    double checked_s, logged_s;
};

struct tl_review {
    tl_window *window;
    tl_gpu *gpu;
    tl_panel *panel;
    tl_thumbnails *thumbnails;
    bool panel_has_keys;            /* a field is typed into */
    const struct tl_option *listed; /* whose list of choices is open in the panel; NULL: none */
    tl_renderer *renderer;
    tl_session *session;
    tl_loader *loader;                    /* NULL: nothing is loading */
    struct tl_cloth_fabric draped;        /* that the garment hangs in, or that it was last draped in without
                                             success */
    bool drapes_again;                    /* the loader drapes the present scene in another fabric */
    struct tl_settings loaded_appearance; /* the settings of the last one */

    struct tl_settings
        wanted; /* edited by keys, pointer and panel; the session follows as fast as it can load */
    struct tl_settings good; /* the last settings that were drawn; restored after a failure */
    bool changed;            /* `wanted` was edited since the last image */
    bool editing;            /* a widget of the panel is held: further edits are expected */
    bool image_is_old;       /* the session has changed since the last image */
    int redraws;             /* frames to present with the same image, because the panel changes */
    double moved_s;          /* time of the last move of the camera, the light or a slider */
    double shown_s;          /* time of the last presented frame */
    tl_quality_governor *governor;
    struct tl_quality_choice quality_choice; /* of the last image */
    bool is_budgeted, is_new;                /* the last image: drawn within the budget; not presented yet */
    bool is_exact;                           /* ...: drawn for a file, however long that took */
    bool is_resting;                         /* ...: one of those that refine the picture at rest */
    struct tl_review_rest rest;
    tl_history *history;
    tl_journal *journal; /* NULL: no state is kept */

    bool playing, closing, help_shown, reads_out;
    double next_step_s; /* while playing: time of the next simulated frame */
    double play_speed;  /* of the last frames, as a share of real time; 1 when playing begins */
    struct tl_review_motion motion;
    struct tl_review_path path;
    struct tl_review_wipe wipe;

    enum tl_review_drag drag;
    int drag_button;
    float pointer_x, pointer_y; /* pixels */
    double pressed_s;           /* time of the last press, for double clicks */
    float pressed_x, pressed_y;
    float grab_depth_m; /* depth of the plane, parallel to the image, in which the cloth is pulled */
    uint32_t grab_vertex;
    vec3s grab_target,
        grab_at; /* metres: the pointer's point in that plane, and the hand, which follows it */

    struct tl_review_placing placing;
    struct tl_review_reading reading;
    struct tl_review_recent recent;
    char *title;
    char message[1200]; /* "": none is shown */
    bool message_is_error;
    double message_s;
    tl_file_chooser *chooser; /* NULL: no dialog is open */
    char *dropped;            /* the file that the panel asks about, or NULL */
    char **waiting;           /* those that it asks about next */
    size_t waiting_count;
    char **environments; /* those that E cycles through */
    size_t environment_count;
    const char *output_folder; /* for screenshots and camera paths */

    struct tl_window_params params;
    char *state_folder;  /* NULL: no state is kept between runs */
    bool keeps_settings; /* the settings are a part of that state */
    char *views_file;    /* of the present scene; NULL as above */
    struct tl_saved_views views;
    char *scene_file;                     /* YAML file that the settings came from, or NULL */
    const struct tl_arguments *arguments; /* borrowed */
    struct tl_file_watch watch;
    double watched_s;

    struct tl_review_memory memory;
    struct tl_review_times times;
    struct tl_frame_times frame_times, rest_times; /* of images in motion, and at rest */
    struct tl_frame_times window_times;            /* of images in motion, without drawing and cloth */
    struct tl_cloth_report report;
    int reported_frame;
    double reported_s;
    int drawn_count, shown_count;
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

/* Notes that the camera, the light or a slider has just moved: coarse images are allowed for a moment. */
void tl_review_note_motion(struct tl_review *review);
bool tl_review_is_moving(const struct tl_review *review);    /* coarse images are allowed */
bool tl_review_moves_itself(const struct tl_review *review); /* turntable, environment, glide or path */

#endif
