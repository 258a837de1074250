/* The review window's state between runs: its size, its panel, and the last settings of the built-in review.
 * A YAML file of option tables in $XDG_STATE_HOME/toile, or ~/.local/state/toile; saved views
 * (app/view/memory/saved_views.h) are stored next to it.
 *
 * A missing file means defaults. Errors: TL_USAGE or TL_INPUT when the file is malformed, and nothing of it
 * is used; TL_OUTPUT when it cannot be written. Threads: any, one at a time for a file. */
#ifndef TOILE_APP_VIEW_MEMORY_STATE_H
#define TOILE_APP_VIEW_MEMORY_STATE_H

#include "app/settings/settings.h"

struct tl_window_params { /* table "window" */
    int width, height;    /* of the window, pixels */
    bool panel;
    float budget_ms; /* for a frame; 0: none */
    float turntable_deg_s, environment_turn_deg_s;
    bool loop; /* motions begin again at their end */
};
extern const struct tl_option_table tl_window_options;

struct tl_state {
    struct tl_window_params window;
    struct tl_left_review { /* table "review" */
        bool has_settings;
    } review;
    struct tl_settings settings;
};

/* The folder; NULL when neither variable names one. New string. */
char *tl_state_folder(void);

/* Loads a state; options that the file does not set are those of `defaults`, and of the window's table. */
bool tl_state_load(const char *file, const struct tl_settings *defaults, struct tl_state *out,
                   tl_error *error);
bool tl_state_save(const char *file, const struct tl_state *state, tl_error *error);

/* Writes tables as YAML, completely or not at all; creates the file's folder. */
bool tl_state_write(const char *file, const struct tl_binding *bindings, size_t count, tl_error *error);

#endif
