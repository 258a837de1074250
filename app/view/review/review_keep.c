#include "app/view/review/review_keep.h"

#include "app/cli/arguments.h"
#include "app/view/review/review.h"
#include "app/view/review/review_move.h"
#include "assets/model.h"
#include "assets/pattern/pattern.h"
#include "config/base/file.h"
#include "config/base/hash.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char *state_file(const struct tl_review *review)
{
    return tl_format("%s/review.yaml", review->keep.state_folder);
}

static char *recent_file(const struct tl_review *review)
{
    return tl_format("%s/recent.yaml", review->keep.state_folder);
}

static void restore_recent(struct tl_review *review)
{
    tl_error error;
    char *file = recent_file(review);
    if (!tl_recent_load(file, &review->keep.recent, &error))
        tl_warn("view: %s: the recent files are not offered", error.message);
    free(file);
}

void tl_review_keep_recent(struct tl_review *review)
{
    const struct tl_scene_params *scene = &review->wanted.scene;
    const char *name = strcmp(scene->garment, "none") != 0 ? scene->garment : scene->avatar;
    char *path = tl_option_is_file_name(name) ? realpath(name, NULL) : NULL;
    const char *latest = tl_option_text(&review->keep.recent.garments[0]);
    if (path && review->edit.offered == 0 && strcmp(latest, path) != 0) {
        tl_error error;
        char *file = review->keep.state_folder ? recent_file(review) : NULL;
        tl_recent_add(&review->keep.recent, path);
        if (file && !tl_recent_save(file, &review->keep.recent, &error))
            tl_warn("view: %s: the recent files are not saved", error.message);
        free(file);
    }
    free(path);
}

bool tl_review_restore_state(struct tl_review *review)
{
    const struct tl_arguments *arguments = review->keep.arguments;
    const char *scene = arguments->positional_count > 0 ? arguments->positionals[0] : NULL;
    review->screen.params = *(const struct tl_window_params *)tl_window_options.defaults;
    review->keep.scene_file =
        scene && tl_option_is_file_name(scene) && tl_settings_is_scene(scene) ? tl_copy_string(scene) : NULL;
    review->keep.state_folder = arguments->fresh ? NULL : tl_state_folder();
    if (!review->keep.state_folder)
        return false;
    restore_recent(review);
    tl_error error;
    struct tl_state state;
    char *file = state_file(review);
    if (!tl_state_load(file, &review->wanted, &state, &error))
        tl_warn("view: %s: starts with the defaults", error.message);
    free(file);
    review->screen.params = state.window;
    /* A scene or an option on the command line takes precedence over kept settings. */
    review->keep.keeps_settings = !scene && arguments->assignment_count == 0;
    bool is_restored = review->keep.keeps_settings && state.review.has_settings;
    if (is_restored)
        review->wanted = state.settings;
    return is_restored;
}

/* A hash of the words of the command line, and of the folder that they are read from. */
static uint64_t hash_of_command(const struct tl_arguments *arguments)
{
    uint64_t hash = TL_HASH_START;
    for (size_t i = 0; i < arguments->positional_count; i++)
        hash = tl_hash(hash, arguments->positionals[i], strlen(arguments->positionals[i]) + 1);
    for (size_t i = 0; i < arguments->assignment_count; i++)
        hash = tl_hash(hash, arguments->assignments[i], strlen(arguments->assignments[i]) + 1);
    char *folder = hash == TL_HASH_START ? NULL : getcwd(NULL, 0);
    if (folder)
        hash = tl_hash(hash, folder, strlen(folder));
    free(folder);
    return hash;
}

int tl_review_recover(struct tl_review *review)
{
    struct tl_recovered recovered = {0};
    if (review->keep.state_folder)
        review->keep.journal = tl_journal_recover(review->keep.state_folder,
                                                  hash_of_command(review->keep.arguments), &recovered);
    if (!review->keep.journal)
        return -1;
    review->wanted = recovered.settings;
    review->keep.history = recovered.history;
    return (int)recovered.steps;
}

void tl_review_begin_journal(struct tl_review *review)
{
    tl_journal_resume(review->keep.journal);
    if (!review->keep.journal && review->keep.state_folder)
        review->keep.journal = tl_journal_begin(review->keep.state_folder,
                                                hash_of_command(review->keep.arguments), &review->good);
}

void tl_review_save_state(struct tl_review *review)
{
    if (!review->keep.state_folder || !review->session)
        return;
    tl_error error;
    struct tl_settings defaults = review->good;
    struct tl_state state;
    char *file = state_file(review);
    /* The file is read first, so that tables which this review does not keep are written back unchanged. */
    if (!tl_state_load(file, &defaults, &state, &error))
        state.review.has_settings = false;
    if (review->keep.keeps_settings) {
        state.review.has_settings = true;
        state.settings = review->good;
    }
    state.window = review->screen.params;
    tl_window_unscaled_size(review->screen.window, &state.window.width, &state.window.height);
    if (!tl_state_save(file, &state, &error))
        tl_warn("view: %s: the state of this review is not saved", error.message);
    free(file);
}

void tl_review_load_views(struct tl_review *review)
{
    char *name = tl_saved_views_name(&review->good.scene);
    const char *folder = review->keep.state_folder ? review->keep.state_folder : "";
    char *file = tl_format("%s/views/%s", folder, name);
    free(name);
    if (review->keep.views_file && strcmp(review->keep.views_file, file) == 0) {
        free(file);
        return;
    }
    free(review->keep.views_file);
    review->keep.views_file = file;
    tl_error error;
    if (!review->keep.state_folder)
        review->keep.views = (struct tl_saved_views){0};
    else if (!tl_saved_views_load(file, &review->keep.views, &error))
        tl_warn("view: %s: saved views are not loaded", error.message);
}

void tl_review_save_view(struct tl_review *review, int index)
{
    tl_error error;
    tl_review_fix_camera(review);
    review->keep.views.of[index] = tl_saved_view_take(&review->wanted);
    if (review->keep.state_folder &&
        !tl_saved_views_save(review->keep.views_file, &review->keep.views, &error))
        tl_review_report_error(review, &error);
    else
        tl_review_report(review, "view %d saved: %d returns to it", index + 1, index + 1);
}

/* Takes over the file's settings except the camera. */
static void reload_scene(struct tl_review *review)
{
    const struct tl_arguments *arguments = review->keep.arguments;
    bool is_first =
        arguments->positional_count > 0 && strcmp(review->keep.scene_file, arguments->positionals[0]) == 0;
    const struct tl_settings_source source = {
        .scene_file = review->keep.scene_file,
        .assignments = (const char *const *)arguments->assignments,
        .assignment_count = is_first ? arguments->assignment_count : 0,
    };
    struct tl_settings loaded;
    tl_error error;
    if (!tl_settings_load(&loaded, &source, &error)) {
        tl_review_report_error(review, &error);
        return;
    }
    loaded.camera = review->wanted.camera;
    review->wanted = loaded;
    tl_review_mark_changed(review);
    tl_review_report(review, "edited: %s", review->keep.scene_file);
}

static void reload_named(struct tl_review *review, const char *name,
                         bool (*apply)(struct tl_settings *settings, const char *name, tl_error *error))
{
    if (!tl_option_is_file_name(name) || !tl_file_has_changed(&review->keep.watch, name))
        return;
    tl_error error;
    char *copy = tl_copy_string(name); /* `name` points into the settings that are changed */
    if (apply(&review->wanted, copy, &error)) {
        tl_review_mark_changed(review);
        tl_review_report(review, "edited: %s", copy);
    } else {
        tl_review_report_error(review, &error);
    }
    free(copy);
}

void tl_review_reload_edited(struct tl_review *review)
{
    const double every_s = 0.5;
    double now_s = tl_clock_s();
    if (now_s - review->keep.watched_s < every_s)
        return;
    review->keep.watched_s = now_s;
    const struct tl_scene_params *scene = &review->wanted.scene;
    if (review->keep.scene_file && tl_file_has_changed(&review->keep.watch, review->keep.scene_file))
        reload_scene(review);
    reload_named(review, scene->fabric, tl_settings_apply_fabric);
    reload_named(review, scene->preset, tl_settings_apply_preset);
}
