/* The review window's state, shared by its parts:
 *
 *     cmd_view.c        its life and its loop
 *     review_draw.c     when an image is drawn, and how it gets on the screen
 *     review_load.c     scenes and environments, made ready beside it
 *     review_edit.c     edits of the settings: names, files, undo
 *     review_move.c     what moves by itself: turntable, glides to saved views, camera paths
 *     review_wipe.c     two looks side by side
 *     review_read.c     what the image's colours mean, and what lies under the pointer
 *     review_keep.c     what is remembered from one time to the next; files that are watched
 *     review_keys.c     keys and their help       review_pointer.c  pointer and gestures
 *     review_memory.c   what it holds of memory
 *     review_act.c      what commands do          review_panel.c    what the panel shows */
#ifndef TOILE_APP_VIEW_REVIEW_H
#define TOILE_APP_VIEW_REVIEW_H

#include "app/budget/governor.h"
#include "app/scene/path.h"
#include "app/scene/session.h"
#include "app/view/memory/history.h"
#include "app/view/memory/saved_views.h"
#include "app/view/memory/state.h"
#include "app/view/panel/panel_shim.h"
#include "app/view/window/file_watch.h"
#include "app/view/window/frame_times.h"
#include "app/view/window/loader.h"
#include "app/view/window/window.h"

enum tl_review_command { /* what keys, buttons and answers stand for */
                         TL_REVIEW_PLAY,
                         TL_REVIEW_STEP,
                         TL_REVIEW_RESET,
                         TL_REVIEW_PIN, /* holds what is pulled; lets go of all that when nothing is */
                         TL_REVIEW_FRAME_ALL,
                         TL_REVIEW_TURN_CAMERA_LEFT,
                         TL_REVIEW_TURN_CAMERA_RIGHT,
                         TL_REVIEW_TURN_CAMERA_UP,
                         TL_REVIEW_TURN_CAMERA_DOWN,
                         TL_REVIEW_NEARER,
                         TL_REVIEW_FARTHER,
                         TL_REVIEW_TURNTABLE,
                         TL_REVIEW_NEXT_ENVIRONMENT,
                         TL_REVIEW_TURN_LEFT,
                         TL_REVIEW_TURN_RIGHT,
                         TL_REVIEW_TURN_ENVIRONMENT,
                         TL_REVIEW_NEXT_FABRIC,
                         TL_REVIEW_PREVIOUS_FABRIC,
                         TL_REVIEW_NEXT_COLOURWAY,
                         TL_REVIEW_PREVIOUS_COLOURWAY,
                         TL_REVIEW_NEXT_VIEW, /* of what the image shows */
                         TL_REVIEW_PREVIOUS_VIEW,
                         TL_REVIEW_PLAIN_VIEW, /* light again */
                         TL_REVIEW_READ_OUT,   /* under the pointer */
                         TL_REVIEW_COMPARE,
                         TL_REVIEW_EXCHANGE, /* the two looks that are compared */
                         TL_REVIEW_WIPE_LEFT,
                         TL_REVIEW_WIPE_RIGHT,
                         TL_REVIEW_PATH_KEY,
                         TL_REVIEW_PATH_RECORD,
                         TL_REVIEW_PATH_PLAY,
                         TL_REVIEW_UNDO,
                         TL_REVIEW_REDO,
                         TL_REVIEW_BUDGET_LESS,
                         TL_REVIEW_BUDGET_MORE,
                         TL_REVIEW_SCREENSHOT,
                         TL_REVIEW_SCREENSHOT_LINEAR,
                         TL_REVIEW_PANEL,
                         TL_REVIEW_OPTIONS, /* the panel is used by keys */
                         TL_REVIEW_HELP,
                         TL_REVIEW_BACK, /* closes what is open, or the window */
                         TL_REVIEW_QUIT,
                         TL_REVIEW_USE_GARMENT, /* answers to what a dropped file is */
                         TL_REVIEW_USE_AVATAR,
                         TL_REVIEW_USE_SCENE,
                         TL_REVIEW_USE_FABRIC,
                         TL_REVIEW_USE_PRESET,
                         TL_REVIEW_USE_NOTHING,
                         TL_REVIEW_VIEW = 100,      /* + index of a saved view */
                         TL_REVIEW_SAVE_VIEW = 200, /* + index */
                         TL_REVIEW_FABRIC = 300,    /* + index into tl_embedded_fabrics_names */
};

enum tl_review_drag { TL_DRAG_NONE, TL_DRAG_ORBIT, TL_DRAG_PAN, TL_DRAG_LIGHT, TL_DRAG_CLOTH, TL_DRAG_WIPE };

struct tl_review_times {       /* ms, of the last frame that had them */
    double frame, cloth, draw; /* frame: all of it, to the swap of buffers */
    double began_s;            /* the frame at hand */
    double lap_s;              /* when its last part ended */
    const char *longest;       /* of its parts so far, outside of drawing */
    double longest_ms;
};

/* What moves without being pushed. */
struct tl_review_motion {
    bool turntable, environment;
    double moved_s; /* when it moved last */
    bool glides;    /* to a saved view */
    struct tl_saved_view from, to;
    double glide_began_s;
};

struct tl_review_path {
    struct tl_path path; /* count 0: none yet */
    char *file;          /* that it is written to; NULL: none yet */
    bool records, plays;
    double began_s;
    double key_due_s; /* recording: when the next key is taken */
};

/* Look A, on the left, is what the settings were; look B, on the right, is what they are. */
struct tl_review_wipe {
    tl_renderer *renderer; /* of look A; NULL: nothing is compared */
    struct tl_settings look;
    float place; /* of the line between, as a share of the view's width */
};

struct tl_review_memory {
    size_t least_unused; /* bytes, since some were given back last */
    double looked_s, told_s;
};

struct tl_review {
    tl_window *window;
    tl_gpu *gpu;
    tl_panel *panel;
    tl_renderer *renderer;
    tl_session *session;
    tl_loader *loader;             /* NULL: nothing is being made ready */
    struct tl_settings made_ready; /* the last look that was */

    struct tl_settings wanted; /* edited by keys, pointer and panel; the session follows */
    struct tl_settings good;   /* the last that could be loaded and drawn; where a failure goes back to */
    bool changed;              /* wanted has been edited */
    bool editing;              /* a widget of the panel is held: more edits will come */
    bool image_is_old;         /* the image does not show the session's state */
    int redraws;    /* presentations due though the image is not old: the panel follows the pointer */
    double moved_s; /* when the camera, the light or a slider moved last */
    double shown_s; /* when something was presented last */
    tl_pace *pace;
    struct tl_pace_choice pace_choice; /* of the last image */
    bool is_paced, is_new;             /* the last image: drawn at these levels; not shown yet */
    tl_history *history;

    bool playing, closing, help_shown, reads_out;
    double next_step_s; /* when playing: the next simulated frame is due */
    struct tl_review_motion motion;
    struct tl_review_path path;
    struct tl_review_wipe wipe;

    enum tl_review_drag drag;
    int drag_button;
    float pointer_x, pointer_y; /* pixels */
    double pressed_s;           /* last press, for double clicks */
    float pressed_x, pressed_y;
    float grab_depth_m; /* of the plane, parallel to the image, in which the cloth is pulled */
    uint32_t grab_vertex;
    vec3s grab_target, grab_at; /* metres: where the pointer is, and where the hand has got to */

    char *title;
    char message[1200]; /* "": none is shown */
    bool message_is_error;
    double said_s;
    char *dropped;  /* the file that the panel asks about, or NULL */
    char **waiting; /* those that it will ask about next */
    size_t waiting_count;
    char **environments; /* known ones, for TL_REVIEW_NEXT_ENVIRONMENT */
    size_t environment_count;
    const char *output_folder; /* of screenshots and camera paths */

    struct tl_window_params params;
    char *state_folder; /* NULL: nothing is remembered */
    bool keeps_settings;
    char *views_file; /* of what is shown; NULL as above */
    struct tl_saved_views views;
    char *scene_file;                     /* YAML that the settings came from, or NULL */
    const struct tl_arguments *arguments; /* borrowed */
    struct tl_watch watch;
    double watched_s;

    struct tl_review_memory memory;
    struct tl_review_times times;
    struct tl_frame_times frame_times, rest_times; /* while something moves; else */
    struct tl_cloth_report report;
    int reported_frame;
    double reported_s;
    int drawn_count, shown_count;
};

/* ---- cmd_view.c */

/* The picture's part of the window, pixels: what the panel leaves. */
void tl_review_size(const struct tl_review *review, int *width, int *height);
/* Says something over the picture, for a while, and in the log. */
void tl_review_say(struct tl_review *review, const char *format, ...) __attribute__((format(printf, 2, 3)));
void tl_review_complain(struct tl_review *review, const tl_error *error);
void tl_review_quiet(struct tl_review *review); /* takes the message away */
/* Notes that something moves, so that coarse images are in order for a moment. */
void tl_review_touch(struct tl_review *review);
bool tl_review_is_moving(const struct tl_review *review); /* while such images are in order */

/* ---- review_draw.c */

/* Simulates and draws what is due; reports what cannot be drawn and draws what was good instead. */
bool tl_review_update_image(struct tl_review *review, tl_error *error);
/* Draws an image at full quality, unless there is one. */
bool tl_review_is_sharp(const struct tl_review *review);
bool tl_review_draw_sharp(struct tl_review *review, tl_error *error);
bool tl_review_is_at_rest(const struct tl_review *review);
/* Ends a part of the frame at hand that is not drawing: --verbose tells the longest of a slow image. */
void tl_review_lap(struct tl_review *review, const char *part);
/* Puts the last image, and the panel as it was built, on the screen. */
bool tl_review_present(struct tl_review *review, tl_error *error);

/* ---- review_load.c */

/* Starts, follows and ends loaders as `wanted` demands. */
void tl_review_load(struct tl_review *review);
/* Gives up what is being made ready. False when there is nothing. */
bool tl_review_stop_loading(struct tl_review *review);
/* The first scene; shows progress. False when it cannot be had, or the window was closed: `closing`. */
bool tl_review_load_first(struct tl_review *review, tl_error *error);
/* What of `wanted` can be followed while the rest is made ready. */
struct tl_settings tl_review_followed(const struct tl_review *review);

/* ---- review_edit.c */

/* Sets one option as if it had been typed. */
bool tl_review_set(struct tl_review *review, const char *key, const char *text);
void tl_review_use_fabric(struct tl_review *review, const char *name);
void tl_review_use_scene(struct tl_review *review, const char *path);
void tl_review_next_fabric(struct tl_review *review, int by);
void tl_review_next_colourway(struct tl_review *review, int by);
void tl_review_next_view(struct tl_review *review, int by);
/* After the panel changed wanted.scene.fabric or .preset: takes over what these names stand for. */
void tl_review_layer(struct tl_review *review);
void tl_review_drop(struct tl_review *review, const char *path);
void tl_review_use_dropped(struct tl_review *review, int command); /* the answer to what it is */
void tl_review_forget_dropped(struct tl_review *review);
/* Remembers an environment for TL_REVIEW_NEXT_ENVIRONMENT. */
void tl_review_know_environment(struct tl_review *review, const char *name);
void tl_review_next_environment(struct tl_review *review);
void tl_review_note_edit(struct tl_review *review); /* for undo, once a gesture has ended */
void tl_review_undo(struct tl_review *review, bool redo);

/* ---- review_move.c */

/* Moves what moves by itself to where it is now. */
void tl_review_move(struct tl_review *review);
bool tl_review_moves_itself(const struct tl_review *review);
void tl_review_stop_moving(struct tl_review *review); /* glides and played paths: the user takes over */
/* Moves but for a turn need to know how far the eye is, which an automatic frame leaves open. */
void tl_review_fix_camera(struct tl_review *review);
void tl_review_go_to_view(struct tl_review *review, int index);
void tl_review_turn(struct tl_review *review, bool *which, const char *what);
void tl_review_path_add(struct tl_review *review);
void tl_review_path_record(struct tl_review *review);
void tl_review_path_play(struct tl_review *review);
void tl_review_path_release(struct tl_review_path *path);

/* ---- review_wipe.c */

void tl_review_compare(struct tl_review *review); /* begins, ends */
void tl_review_exchange(struct tl_review *review);
void tl_review_move_wipe(struct tl_review *review, float place);
int tl_review_wipe_column(const struct tl_review *review, int width); /* pixels; 0 when nothing is compared */
/* Settings that show look A where `settings` show look B: the same scene, light and cloth. */
struct tl_settings tl_review_look_a(const struct tl_review *review, const struct tl_settings *settings);
void tl_review_wipe_labels(const struct tl_review *review, char *a, char *b, size_t size);

/* ---- review_keep.c */

/* Reads what is remembered of the window and, where nothing else was asked for, of the settings. True when
 * the settings were taken over. */
bool tl_review_remember(struct tl_review *review);
void tl_review_keep(struct tl_review *review);
void tl_review_save_view(struct tl_review *review, int index);
void tl_review_follow_views(struct tl_review *review); /* after another scene has come */
/* Takes over the scene, fabric and preset files that have been edited. */
void tl_review_watch(struct tl_review *review);

/* ---- review_keys.c, review_pointer.c */

void tl_review_listen(struct tl_review *review); /* handles every waiting event */
void tl_review_on_key(struct tl_review *review, const struct tl_window_event *event);
/* Keys and gestures as rows of help; a row without a second cell is a heading. */
size_t tl_review_help(struct tl_panel_line *lines, size_t capacity);
/* Before each simulated frame: the hand that pulls on the cloth follows the pointer. */
void tl_review_move_hand(struct tl_review *review);

/* ---- review_act.c */

void tl_review_act(struct tl_review *review, int command);

/* ---- review_read.c */

/* What lies under the pointer, as lines of text; "" when nothing is to be said. */
void tl_review_read_out(const struct tl_review *review, char *text, size_t size);
/* The colours of the image's view for the panel; false when it shows light. */
bool tl_review_legend(const struct tl_review *review, struct tl_panel_legend *out);

/* ---- review_memory.c */

size_t tl_review_resident_bytes(void);              /* of this process */
void tl_review_give_back(struct tl_review *review); /* memory that lies idle, now and then */

/* ---- review_panel.c */

/* Builds the panel of this frame and carries out what it asks for. */
void tl_review_build_panel(struct tl_review *review);
void tl_review_build_progress(struct tl_review *review); /* before there is a session */

int tl_review_panel_width(const struct tl_review *review); /* pixels; 0 when hidden */
/* What may be answered about the dropped file. */
const struct tl_panel_button *tl_review_answers(const struct tl_review *review, size_t *count);

#endif
