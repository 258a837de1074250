/* The panel of the review window, drawn by Dear ImGui. C++ stays inside panel_shim.cpp.
 *
 * It knows no option by name: widgets come from the option tables, lists and measures from its caller. It
 * edits the params that the bindings point to, in place and within range, and says so; taking the change
 * over, or back, is the caller's affair. Ownership: everything passed in is borrowed for the call. Threads:
 * the window's. */
#ifndef TOILE_APP_VIEW_PANEL_PANEL_SHIM_H
#define TOILE_APP_VIEW_PANEL_PANEL_SHIM_H

#include "config/options.h"

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

/* The last frames' times as bars, the oldest first, and the line that they are to keep_present below. */
struct tl_panel_strip {
    const float *ms;
    size_t count;
    float budget_ms; /* 0: none */
    const char *label;
};

/* Two looks side by side: the line between them, pixels from the left, and what each is. */
struct tl_panel_wipe {
    int column; /* 0: one look alone */
    const char *left, *right;
};

/* What the colours of the image mean: a scale between stops, or entries, or both. Colours: sRGB, [0, 1]. */
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

/* Something that takes time, and goes on beside the window. */
struct tl_panel_progress {
    const char *what; /* NULL: nothing */
    float share;      /* [0, 1]; negative: not known */
    const char *hint; /* how it is ended */
};

struct tl_panel_input {
    const char *title;
    const char *message; /* what was said last, or ""; stands over the view */
    bool message_is_error;
    const char *status; /* what goes on, or ""; stands over the view */
    struct tl_panel_strip strip;
    struct tl_panel_wipe wipe;
    struct tl_panel_progress progress;
    const struct tl_panel_legend *legend; /* NULL: none */
    const char *read_out;                 /* lines beside the pointer, or "" */
    const struct tl_panel_button *buttons;
    size_t button_count;
    const char *const *favourites; /* "table.key" of options that stand on top */
    size_t favourite_count;
    const struct tl_panel_lines *measures;
    size_t measure_count;
    const struct tl_binding *bindings;
    size_t binding_count;
    const struct tl_panel_line *help; /* key, what it does, or a heading; drawn over the view when there are
                                         any */
    size_t help_count;
    const char *question; /* asks and waits for one of the answers, unless NULL */
    const struct tl_panel_button *answers;
    size_t answer_count;
    int x, y, width, height; /* the panel's place, framebuffer pixels; width 0: hidden */
};

struct tl_panel_result {
    bool changed; /* an option was edited */
    bool editing; /* a widget is held or typed in: more is to come */
    int button;   /* index of the one that was pressed, -1 for none */
    int answer;   /* index of the one that was chosen, -1 for none */
};

/* Chains itself after the window's own callbacks. */
tl_panel *tl_panel_create(struct GLFWwindow *window, float scale, tl_error *error);
void tl_panel_destroy(tl_panel **panel);

bool tl_panel_wants_pointer(const tl_panel *panel);
bool tl_panel_wants_keys(const tl_panel *panel);
/* A key (GLFW's number) for the next frame, however short it was held. */
void tl_panel_press(tl_panel *panel, int key);
/* From now on keys move through the panel's widgets; or no longer. */
void tl_panel_use_keys(tl_panel *panel, bool used);

/* Builds one frame of the panel, then draws it into the current framebuffer. */
struct tl_panel_result tl_panel_build(tl_panel *panel, const struct tl_panel_input *input);
void tl_panel_draw(tl_panel *panel);

#endif
