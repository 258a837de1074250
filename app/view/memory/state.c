#include "app/view/memory/state.h"

#include "config/base/file.h"
#include "config/base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TABLES (TL_SETTINGS_TABLES + 2)

static const struct tl_option window_rows[] = {
    TL_OPTION_INT(struct tl_window_params, width, TL_AFFECTS_NOTHING, 320, 16384, "pixels",
                  "size of the window when it opens"),
    TL_OPTION_INT(struct tl_window_params, height, TL_AFFECTS_NOTHING, 240, 16384, "pixels",
                  "size of the window when it opens"),
    TL_OPTION_BOOL(struct tl_window_params, panel, TL_AFFECTS_NOTHING, "show the panel; Tab toggles it"),
    TL_OPTION_BOOL(struct tl_window_params, loop, TL_AFFECTS_NOTHING, "motions begin again at their end"),
    TL_OPTION_FLOAT(struct tl_window_params, budget_ms, TL_AFFECTS_NOTHING, 0, 1000, "ms",
                    "time budget of a frame; a larger one allows more quality; 0: no limit"),
    TL_OPTION_FLOAT(struct tl_window_params, turntable_deg_s, TL_AFFECTS_NOTHING, -360, 360, "degrees/s",
                    "speed of the turntable, T"),
    TL_OPTION_FLOAT(struct tl_window_params, environment_turn_deg_s, TL_AFFECTS_NOTHING, -360, 360,
                    "degrees/s", "speed at which Shift+T turns the environment"),
};
const struct tl_option_table tl_window_options =
    TL_OPTION_TABLE("window", "the review window; kept between runs, not a part of a scene", window_rows,
                    struct tl_window_params, .width = 1280, .height = 800, .panel = true, .loop = true,
                    .budget_ms = 50, .turntable_deg_s = 30, .environment_turn_deg_s = 30);

/* Whether a state file holds settings besides the window's. */
static const struct tl_option review_rows[] = {
    TL_OPTION_BOOL(struct tl_left_review, has_settings, TL_AFFECTS_NOTHING,
                   "the other tables hold the settings of the built-in review"),
};
static const struct tl_option_table review_table = TL_OPTION_TABLE(
    "review", "state of the built-in review", review_rows, struct tl_left_review, .has_settings = false);

char *tl_state_folder(void)
{
    const char *state = getenv("XDG_STATE_HOME"), *home = getenv("HOME");
    if (state && state[0] == '/') /* the XDG specification ignores relative paths */
        return tl_format("%s/toile", state);
    return home && home[0] == '/' ? tl_format("%s/.local/state/toile", home) : NULL;
}

static size_t bind(struct tl_state *state, struct tl_binding bindings[TABLES])
{
    bindings[0] = (struct tl_binding){&tl_window_options, &state->window};
    bindings[1] = (struct tl_binding){&review_table, &state->review};
    if (!state->review.has_settings)
        return 2;
    tl_settings_bind(&state->settings, bindings + 2);
    return TABLES;
}

bool tl_state_load(const char *file, const struct tl_settings *defaults, struct tl_state *out,
                   tl_error *error)
{
    struct tl_state read = {.review = {.has_settings = true},
                            .settings = *defaults}; /* true: all tables are accepted */
    struct tl_binding bindings[TABLES];
    size_t count = bind(&read, bindings);
    tl_options_reset(bindings, 2);
    *out = read;
    if (!tl_file_exists(file))
        return true;
    if (!tl_options_read_yaml_file(bindings, count, file, error) ||
        (read.review.has_settings &&
         !tl_settings_apply_colourway(&read.settings, read.settings.scene.colourway, error)))
        return false;
    *out = read;
    return true;
}

bool tl_state_save(const char *file, const struct tl_state *state, tl_error *error)
{
    struct tl_state copy = *state; /* bindings can be written through */
    struct tl_binding bindings[TABLES];
    size_t count = bind(&copy, bindings);
    tl_options_make_paths_absolute(bindings, count);
    return tl_state_write(file, bindings, count, error);
}

bool tl_state_write(const char *file, const struct tl_binding *bindings, size_t count, tl_error *error)
{
    char *folder = tl_copy_string(file), *slash = strrchr(folder, '/');
    if (slash)
        *slash = '\0';
    bool made = !slash || slash == folder || tl_folder_make(folder, error);
    free(folder);
    struct tl_writer writer;
    if (!made || !tl_writer_begin(&writer, file, error))
        return false;
    tl_options_print_yaml(bindings, count, writer.stream);
    return tl_writer_commit(&writer, error);
}
