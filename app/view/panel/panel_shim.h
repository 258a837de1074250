/* The panel of the review window, drawn with Dear ImGui. C++ stays inside this room's *_shim.cpp.
 *
 * The panel knows no option by name: widgets are made from the option tables, and the caller passes lists and
 * measures. Widgets edit the params that the bindings point to, in place and within range; the result says
 * so, and the caller applies or reverts the edit. Errors: tl_panel_create only. Lifetime: everything passed
 * in is borrowed for the call; the panel must be destroyed before its window. Threads: the window's, with its
 * GL context current. */
#ifndef TOILE_APP_VIEW_PANEL_PANEL_SHIM_H
#define TOILE_APP_VIEW_PANEL_PANEL_SHIM_H

#include "app/view/window/window.h"
#include "assets/base/image.h"
#include "config/options.h"
#include "render/gpu/gpu.h"

typedef struct tl_panel tl_panel;
struct GLFWwindow;

struct tl_panel_button {
    const char *label, *help;
};

struct tl_panel_line { /* one row of measures: cells[0] is its label */
    char cells[4][128];
};

struct tl_panel_lines {
    const char *title, *help;
    const struct tl_panel_line *lines;
    size_t count;
    int columns;
    bool open; /* at first */
};

/* Times of the last frames as bars, the oldest first, with a line at the budget. */
struct tl_panel_strip {
    const float *ms;
    size_t count;
    float budget_ms; /* 0: none */
    const char *label;
};

/* Two appearances side by side: the line between them, pixels from the left, and their labels. */
struct tl_panel_wipe {
    int column; /* 0: nothing is compared */
    const char *left, *right;
};

/* Legend of the image's colours: a scale between stops, entries, or both. Colours: sRGB, [0, 1]. */
#define TL_PANEL_LEGEND_STOPS   33
#define TL_PANEL_LEGEND_ENTRIES 8
struct tl_panel_legend {
    char title[64], unit[8], note[160];
    float low, high; /* at the scale's ends */
    int stop_count;
    float stop_values[TL_PANEL_LEGEND_STOPS], stop_colours[TL_PANEL_LEGEND_STOPS][3];
    int entry_count;
    char entry_labels[TL_PANEL_LEGEND_ENTRIES][40];
    float entry_colours[TL_PANEL_LEGEND_ENTRIES][3];
};

/* A line, a filled convex polygon, or a text about its first point, over the view; framebuffer pixels. */
struct tl_panel_shape {
    const float (*points)[2];
    size_t count;
    float colour[4];  /* sRGB and opacity, [0, 1] */
    float width;      /* of the line; 0: filled */
    const char *text; /* NULL: none */
};

/* The frames of what is played back; a slider goes to one. */
struct tl_panel_timeline {
    int frame, last;   /* last 0: none is shown */
    const char *label; /* "1.20 of 4.00 s" */
};

/* An operation that runs asynchronously. */
struct tl_panel_progress {
    const char *what; /* NULL: nothing */
    float share;      /* [0, 1]; negative: unknown */
    const char *hint; /* the key that stops it */
};

/* Pictures of an option's choices, the first `count` of them. Empty images stand for no picture. */
struct tl_panel_list {
    const struct tl_option *row; /* NULL: no list has pictures */
    const tl_image *images;      /* U8 x4, sRGB; their texels stay as they are until the panel is destroyed */
    size_t count;
};

/* An answer to the notice: a button in a row of its own heading. */
struct tl_panel_choice {
    char label[48];
    const char *row, *help;
    bool is_chosen; /* what holds at present */
};

struct tl_panel_input {
    const char *title;
    const char *message; /* the last report, or ""; over the view */
    bool message_is_error;
    const char *status; /* motion without input, or ""; over the view */
    const char *notice; /* what is asked or to be accepted, or NULL or ""; below the status */
    const struct tl_panel_choice *choices; /* its answers; those of a row stand together */
    size_t choice_count;
    struct tl_panel_strip strip;
    struct tl_panel_wipe wipe;
    struct tl_panel_progress progress;
    struct tl_panel_timeline timeline;
    const struct tl_panel_legend *legend; /* NULL: none */
    const char *read_out;                 /* lines next to the pointer, or "" */
    const char *amount;                   /* of a drag: one line below the pointer, or "" */
    const float (*marks)[2];              /* rings over the view, framebuffer pixels */
    size_t mark_count;
    const struct tl_panel_shape *shapes; /* the first is drawn first */
    size_t shape_count;
    const struct tl_panel_button *buttons;
    size_t button_count;
    const char *const *favourites; /* "table.key" of the options at the top */
    size_t favourite_count;
    const struct tl_panel_lines *measures;
    size_t measure_count;
    const struct tl_binding *bindings;
    size_t binding_count;
    struct tl_panel_list list; /* that was open in the last frame */
    const struct tl_panel_line
        *help; /* keys and what they do, or a heading; drawn over the view when there are any */
    size_t help_count;
    const char *question; /* a modal question with answers; NULL: none */
    const struct tl_panel_button *answers;
    size_t answer_count;
    bool answers_below;      /* one a line, which names of files need */
    int x, y, width, height; /* the panel's place, framebuffer pixels; width 0: hidden */
};

/* The report about a value that was typed. */
struct tl_panel_note {
    tl_error error;   /* it is refused; TL_OK: it is not */
    char remark[512]; /* tl_option_remark of one that was taken; "": none */
};

struct tl_panel_result {
    bool changed; /* an option was edited */
    bool editing; /* a widget is held or typed into: further edits are expected */
    bool behind;  /* events are left for the next frame */
    int button;   /* index of the one that was pressed, -1 for none */
    int answer;   /* index of the one that was chosen, -1 for none */
    int choice;   /* index of the notice's answer that was pressed, -1 for none */
    int frame;    /* that the timeline was moved to, -1 for none */
    struct tl_panel_note note;
    const struct tl_option *listed; /* whose list of choices is open; NULL: none */
};

/* `gpu`: of the window's context. `scale`: of the window's content, 1 on a plain screen. TL_DEVICE when the
 * GL context cannot draw it. */
tl_panel *tl_panel_create(struct GLFWwindow *window, tl_gpu *gpu, float scale, tl_error *error);
void tl_panel_destroy(tl_panel **panel);

/* Whether a press at the pixel x, y of the window is the panel's, whatever it has seen of the pointer so far.
 */
bool tl_panel_wants_pointer(const tl_panel *panel, float x, float y);
bool tl_panel_wants_keys(const tl_panel *panel);
/* Queues an event of the window; every one must be passed. */
void tl_panel_take(tl_panel *panel, const struct tl_window_event *event);
/* Closes the open list or picker. False when there is none. */
bool tl_panel_close(tl_panel *panel);
/* Turns keyboard navigation of the panel's widgets on or off. */
void tl_panel_use_keys(tl_panel *panel, bool used);

/* Builds one frame of the panel, then draws it into the current framebuffer. */
struct tl_panel_result tl_panel_build(tl_panel *panel, const struct tl_panel_input *input);
void tl_panel_draw(tl_panel *panel);

#endif
