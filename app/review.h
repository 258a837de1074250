/* The review window's state, shared by its parts: cmd_view.c (its life, the loop, drawing), review_input.c
 * (keys and pointer), review_act.c (what commands do), review_panel.c (what the panel shows). */
#ifndef TOILE_APP_REVIEW_H
#define TOILE_APP_REVIEW_H

#include "app/panel_shim.h"
#include "app/session.h"
#include "app/window.h"

enum tl_review_command { /* what keys, buttons and answers stand for */
                         TL_REVIEW_PLAY,
                         TL_REVIEW_STEP,
                         TL_REVIEW_RESET,
                         TL_REVIEW_FRAME_ALL,
                         TL_REVIEW_NEXT_ENVIRONMENT,
                         TL_REVIEW_TURN_LEFT,
                         TL_REVIEW_TURN_RIGHT,
                         TL_REVIEW_SCREENSHOT,
                         TL_REVIEW_SCREENSHOT_LINEAR,
                         TL_REVIEW_PIN, /* holds what is pulled; lets go of all that when nothing is */
                         TL_REVIEW_PANEL,
                         TL_REVIEW_HELP,
                         TL_REVIEW_BACK, /* closes what is open, or the window */
                         TL_REVIEW_QUIT,
                         TL_REVIEW_USE_GARMENT, /* answers to what a dropped file is */
                         TL_REVIEW_USE_AVATAR,
                         TL_REVIEW_USE_SCENE,
                         TL_REVIEW_USE_FABRIC,
                         TL_REVIEW_USE_PRESET,
                         TL_REVIEW_USE_NOTHING,
                         TL_REVIEW_FABRIC, /* + index into tl_embedded_fabrics_names */
};

enum tl_review_drag { TL_DRAG_NONE, TL_DRAG_ORBIT, TL_DRAG_PAN, TL_DRAG_LIGHT, TL_DRAG_CLOTH };

struct tl_review_times { /* ms, of the last frame that had them */
    double frame, cloth, draw;
};

struct tl_review {
    tl_window *window;
    tl_gpu *gpu;
    tl_panel *panel;
    tl_renderer *renderer;
    tl_session *session;

    struct tl_settings wanted; /* edited by keys, pointer and panel; the session follows */
    struct tl_settings good;   /* the last that could be loaded and drawn; where a failure goes back to */
    bool changed;              /* wanted has been edited */
    bool editing;              /* a widget of the panel is held: more edits will come */
    bool image_is_old;         /* the image does not show the session's state */
    int redraws;      /* presentations due though the image is not old: the panel follows the pointer */
    double moved_s;   /* when the camera, the light or a slider moved last */
    int scale;        /* of the last image: one texel for so many pixels */
    int coarse_scale; /* of images while something moves; follows what the machine can do */

    bool playing, closing, panel_hidden, help_shown;
    double next_step_s; /* when playing: the next simulated frame is due */

    enum tl_review_drag drag;
    int drag_button;
    float pointer_x, pointer_y; /* pixels */
    double pressed_s;           /* last press, for double clicks */
    float pressed_x, pressed_y;
    float grab_depth_m; /* of the plane, parallel to the image, in which the cloth is pulled */
    uint32_t grab_vertex;
    vec3s grab_target, grab_at; /* metres: where the pointer is, and where the hand has got to */

    char *title;
    char message[1200];
    bool message_is_error;
    char *dropped;       /* the file that the panel asks about, or NULL */
    char **environments; /* known ones, for TL_REVIEW_NEXT_ENVIRONMENT */
    size_t environment_count;
    const char *screenshot_folder;

    struct tl_review_times times;
    struct tl_cloth_report report;
    int reported_frame;
    double reported_s;
    int drawn_count, shown_count;
};

/* The picture's part of the window, pixels: what the panel leaves. */
void tl_review_size(const struct tl_review *review, int *width, int *height);

/* Says something in the panel and in the log. */
void tl_review_say(struct tl_review *review, const char *format, ...) __attribute__((format(printf, 2, 3)));
void tl_review_complain(struct tl_review *review, const tl_error *error);

/* Notes that something moves, so that coarse images are in order for a moment. */
void tl_review_touch(struct tl_review *review);

/* Handles every waiting event (review_input.c). */
void tl_review_listen(struct tl_review *review);

/* Before each simulated frame: the hand that pulls on the cloth follows the pointer (review_input.c). */
void tl_review_move_hand(struct tl_review *review);

/* Carries out a command (review_act.c). */
void tl_review_act(struct tl_review *review, int command);
void tl_review_drop(struct tl_review *review, const char *path);
/* Remembers an environment for TL_REVIEW_NEXT_ENVIRONMENT. */
void tl_review_know_environment(struct tl_review *review, const char *name);
/* After the panel changed wanted.scene.fabric or .preset: takes over what these names stand for. */
void tl_review_layer(struct tl_review *review);

/* Keys and gestures as rows of help (review_input.c). */
size_t tl_review_help(struct tl_panel_line *lines, size_t capacity);

/* Builds the panel of this frame and carries out what it asks for (review_panel.c). */
void tl_review_build_panel(struct tl_review *review);
int tl_review_panel_width(const struct tl_review *review); /* pixels; 0 when hidden */
size_t tl_review_resident_bytes(void);                     /* of this process */

/* Draws an image of full sharpness, unless there is one (cmd_view.c). */
bool tl_review_draw_sharp(struct tl_review *review, tl_error *error);

#endif
