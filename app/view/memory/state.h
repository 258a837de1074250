/* What the review window remembers from one time to the next: its size, its panel, and the settings with
 * which the built-in review was left. YAML of option tables in $XDG_STATE_HOME/toile, or
 * ~/.local/state/toile; saved views (app/view/memory/saved_views.h) lie beside it.
 *
 * A file that is missing means defaults. Failure: TL_USAGE or TL_INPUT when it cannot be understood, in which
 * case nothing of it is used; TL_OUTPUT when it cannot be written. */
#ifndef TOILE_APP_VIEW_MEMORY_STATE_H
#define TOILE_APP_VIEW_MEMORY_STATE_H

#include "app/scene/settings.h"

struct tl_window_params { /* table "window" */
    int width, height;    /* of the window, pixels */
    bool panel;
    float budget_ms; /* for a frame; 0: none */
    float turntable_deg_s, environment_turn_deg_s;
};
extern const struct tl_option_table tl_window_options;

struct tl_state {
    struct tl_window_params window;
    struct tl_left_review { /* table "review" */
        bool has_settings;
    } review;
    struct tl_settings settings;
};

/* The folder; NULL where the system says none. New string. */
char *tl_state_folder(void);

/* `defaults`: the settings that a file's stand upon. */
bool tl_state_load(const char *file, const struct tl_settings *defaults, struct tl_state *out,
                   tl_error *error);
bool tl_state_save(const char *file, const struct tl_state *state, tl_error *error);

/* Writes tables as YAML, whole or not at all; makes the file's folder too. */
bool tl_state_write(const char *file, const struct tl_binding *bindings, size_t count, tl_error *error);

#endif
