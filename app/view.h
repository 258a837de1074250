/* The review window's state, shared by its parts: cmd_view.c (its life, the loop, drawing), view_input.c
 * (keys and pointer), view_act.c (what commands do), view_panel.c (what the panel shows). */
#ifndef TOILE_APP_VIEW_H
#define TOILE_APP_VIEW_H

#include "app/panel_shim.h"
#include "app/session.h"
#include "app/window.h"

enum tl_view_command { /* what keys, buttons and answers stand for */
                       TL_VIEW_PLAY,
                       TL_VIEW_STEP,
                       TL_VIEW_RESET,
                       TL_VIEW_FRAME_ALL,
                       TL_VIEW_NEXT_ENVIRONMENT,
                       TL_VIEW_TURN_LEFT,
                       TL_VIEW_TURN_RIGHT,
                       TL_VIEW_SCREENSHOT,
                       TL_VIEW_SCREENSHOT_LINEAR,
                       TL_VIEW_PANEL,
                       TL_VIEW_HELP,
                       TL_VIEW_BACK, /* closes what is open, or the window */
                       TL_VIEW_QUIT,
                       TL_VIEW_USE_GARMENT, /* answers to what a dropped file is */
                       TL_VIEW_USE_AVATAR,
                       TL_VIEW_USE_SCENE,
                       TL_VIEW_USE_FABRIC,
                       TL_VIEW_USE_PRESET,
                       TL_VIEW_USE_NOTHING,
                       TL_VIEW_FABRIC, /* + index into tl_embedded_fabrics_names */
};

enum tl_view_drag { TL_DRAG_NONE, TL_DRAG_ORBIT, TL_DRAG_PAN, TL_DRAG_LIGHT, TL_DRAG_CLOTH };

struct tl_view_times { /* ms, of the last frame that had them */
    double frame, cloth, draw;
};

struct tl_view {
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

    enum tl_view_drag drag;
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
    char **environments; /* known ones, for TL_VIEW_NEXT_ENVIRONMENT */
    size_t environment_count;
    const char *screenshot_folder;

    struct tl_view_times times;
    struct tl_cloth_report report;
    int reported_frame;
    double reported_s;
    int drawn_count, shown_count;
};

/* The picture's part of the window, pixels: what the panel leaves. */
void tl_view_size(const struct tl_view *view, int *width, int *height);

/* Says something in the panel and in the log. */
void tl_view_say(struct tl_view *view, const char *format, ...) __attribute__((format(printf, 2, 3)));
void tl_view_complain(struct tl_view *view, const tl_error *error);

/* Notes that something moves, so that coarse images are in order for a moment. */
void tl_view_touch(struct tl_view *view);

/* Handles every waiting event (view_input.c). */
void tl_view_listen(struct tl_view *view);

/* Before each simulated frame: the hand that pulls on the cloth follows the pointer (view_input.c). */
void tl_view_move_hand(struct tl_view *view);

/* Carries out a command (view_act.c). */
void tl_view_act(struct tl_view *view, int command);
void tl_view_drop(struct tl_view *view, const char *path);
/* Remembers an environment for TL_VIEW_NEXT_ENVIRONMENT. */
void tl_view_know_environment(struct tl_view *view, const char *name);
/* After the panel changed wanted.scene.fabric or .preset: takes over what these names stand for. */
void tl_view_layer(struct tl_view *view);

/* Keys and gestures as rows of help (view_input.c). */
size_t tl_view_help(struct tl_panel_line *lines, size_t capacity);

/* Builds the panel of this frame and carries out what it asks for (view_panel.c). */
void tl_view_build_panel(struct tl_view *view);
int tl_view_panel_width(const struct tl_view *view); /* pixels; 0 when hidden */
size_t tl_view_resident_bytes(void);                 /* of this process */

/* Draws an image of full sharpness, unless there is one (cmd_view.c). */
bool tl_view_draw_sharp(struct tl_view *view, tl_error *error);

#endif
