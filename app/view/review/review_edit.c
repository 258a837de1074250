#include "app/view/review/review_edit.h"

#include "app/fabric/fields.h"
#include "app/settings/imported.h"
#include "app/view/review/review.h"
#include "assets/motion/motion_mesh.h"
#include "assets/motion/point_cache.h"
#include "assets/pattern/pattern.h"
#include "config/base/file.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "config/embedded.h"

#include <stdlib.h>
#include <string.h>

bool tl_review_set(struct tl_review *review, const char *key, const char *text)
{
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    tl_settings_bind(&review->wanted, bindings);
    tl_error error;
    if (!tl_options_set(bindings, TL_SETTINGS_TABLES, key, text, "view", NULL, &error)) {
        tl_review_report_error(review, &error);
        return false;
    }
    tl_review_mark_changed(review);
    return true;
}

/* Sets the options that a name or a file stands for. */
typedef bool apply_name(struct tl_settings *settings, const char *name, tl_error *error);

static bool apply_named(struct tl_review *review, apply_name *apply, const char *name)
{
    tl_error error;
    char *copy = tl_copy_string(name); /* `name` may point into the settings that are changed */
    bool applied = apply(&review->wanted, copy, &error);
    if (applied) {
        tl_review_mark_changed(review);
    } else {
        tl_review_report_error(review, &error);
        review->wanted = review->good;
    }
    free(copy);
    return applied;
}

void tl_review_apply_names(struct tl_review *review)
{
    const struct tl_scene_params *wanted = &review->wanted.scene, *good = &review->good.scene;
    bool is_new = strcmp(wanted->garment, good->garment) != 0;
    bool was_own = strcmp(good->fabric, tl_settings_own_fabric(good->garment)) == 0;
    if (strcmp(wanted->fabric, good->fabric) != 0)
        apply_named(review, tl_settings_apply_fabric, wanted->fabric);
    else if (is_new && was_own && strcmp(wanted->fabric, tl_settings_own_fabric(wanted->garment)) != 0)
        apply_named(review, tl_settings_apply_fabric, tl_settings_own_fabric(wanted->garment));
    if (strcmp(wanted->preset, good->preset) != 0)
        apply_named(review, tl_settings_apply_preset, wanted->preset);
    if (is_new)
        apply_named(review, tl_settings_apply_colourway, ""); /* colourways belong to one garment */
    else if (strcmp(wanted->colourway, good->colourway) != 0 ||
             strcmp(wanted->colourways, good->colourways) != 0)
        apply_named(review, tl_settings_apply_colourway, wanted->colourway);
}

void tl_review_next_colourway(struct tl_review *review, int by)
{
    const char *const *names;
    int count = (int)tl_session_colourways(review->session, &names), present = 0; /* 0: none, as cut */
    if (review->load.loader && tl_loader_kind(review->load.loader) == TL_LOAD_SCENE) {
        tl_review_report(review, "the scene is still loading: its colourways come with it");
        return;
    }
    if (count == 0) {
        tl_review_report(review,
                         "this garment has no colourways: a scene's section `colourways` gives it some");
        return;
    }
    for (int i = 0; i < count; i++)
        if (strcmp(names[i], review->wanted.scene.colourway) == 0)
            present = i + 1;
    int next = (present + by + count + 1) % (count + 1);
    apply_named(review, tl_settings_apply_colourway, next > 0 ? names[next - 1] : "");
    tl_review_report(review, next > 0 ? "colourway: %s" : "no colourway%s",
                     next > 0 ? review->wanted.scene.colourway : "");
}

void tl_review_next_view(struct tl_review *review, int by)
{
    int *view = &review->wanted.image.view;
    *view = (*view + by + TL_VIEW_COUNT) % TL_VIEW_COUNT;
    tl_review_mark_changed(review);
    tl_review_report(review, "shows %s", tl_image_view_names[*view]);
}

void tl_review_use_fabric(struct tl_review *review, const char *name)
{
    apply_named(review, tl_settings_apply_fabric, name);
    tl_review_report(review, "fabric: %s", review->wanted.scene.fabric);
}

void tl_review_next_fabric(struct tl_review *review, int by)
{
    int count = 0,
        present = by > 0 ? -1 : 0; /* a fabric from a file comes before the first, or after the last */
    do {
        if (strcmp(tl_embedded_fabrics_names[count], review->wanted.scene.fabric) == 0)
            present = count;
    } while (tl_embedded_fabrics_names[++count]);
    tl_review_use_fabric(review, tl_embedded_fabrics_names[(present + by + count) % count]);
}

void tl_review_use_scene(struct tl_review *review, const char *path)
{
    tl_error error;
    struct tl_settings loaded;
    if (!tl_settings_load(&loaded, &(struct tl_settings_source){.scene_file = path}, &error)) {
        tl_review_report_error(review, &error);
        return;
    }
    free(review->keep.scene_file);
    review->keep.scene_file = tl_copy_string(path);
    review->wanted = loaded;
    tl_review_mark_changed(review);
    review->keep.keeps_settings = false; /* only the built-in review's settings are kept between runs */
    tl_review_add_environment(review, loaded.scene.environment);
}

void tl_review_add_environment(struct tl_review *review, const char *name)
{
    for (size_t i = 0; i < review->edit.environment_count; i++)
        if (strcmp(review->edit.environments[i], name) == 0)
            return;
    size_t count = review->edit.environment_count + 1;
    review->edit.environments =
        tl_resize(review->edit.environments, count, sizeof *review->edit.environments);
    review->edit.environments[review->edit.environment_count++] = tl_copy_string(name);
}

void tl_review_next_environment(struct tl_review *review)
{
    size_t next = 0;
    for (size_t i = 0; i < review->edit.environment_count; i++)
        if (strcmp(review->edit.environments[i], review->wanted.scene.environment) == 0)
            next = (i + 1) % review->edit.environment_count;
    if (review->edit.environment_count < 2)
        tl_review_report(review,
                         "there is only one environment: drop an .exr or .hdr file here to add another");
    else
        tl_review_set(review, "scene.environment", review->edit.environments[next]);
}

/* Asks about files that are dropped together one after the other. */
static void offer_kinds(struct tl_review *review, const char *path)
{
    if (!review->edit.dropped) {
        review->edit.dropped = tl_copy_string(path);
        return;
    }
    review->edit.waiting =
        tl_resize(review->edit.waiting, review->edit.waiting_count + 1, sizeof *review->edit.waiting);
    review->edit.waiting[review->edit.waiting_count++] = tl_copy_string(path);
}

static char *take_dropped(struct tl_review *review)
{
    char *path = review->edit.dropped;
    review->edit.dropped = NULL;
    if (review->edit.waiting_count > 0) {
        review->edit.dropped = review->edit.waiting[0];
        memmove(review->edit.waiting, review->edit.waiting + 1,
                --review->edit.waiting_count * sizeof *review->edit.waiting);
    }
    return path;
}

bool tl_review_cancel_question(struct tl_review *review)
{
    bool is_open = review->edit.offered > 0 || review->edit.dropped;
    if (review->edit.offered > 0)
        review->edit.offered = 0;
    else
        free(take_dropped(review));
    return is_open;
}

/* Whether a model was opened alone: the scene holds it as a body that wears nothing. */
static bool is_alone(const struct tl_review *review)
{
    const struct tl_scene_params *scene = &review->wanted.scene;
    return strcmp(scene->garment, "none") == 0 && tl_option_is_file_name(scene->avatar);
}

/* Units, axis, place and motion were those of the file before. */
static void forget_garment(struct tl_review *review)
{
    static const char *const options[][2] = {{"scene.units", "auto"},   {"scene.up", "auto"},
                                             {"scene.turn_deg", "0"},   {"scene.scale", "1"},
                                             {"scene.move_m", "0,0,0"}, {"scene.motion", "none"}};
    for (size_t i = 0; i < TL_COUNT(options); i++)
        tl_review_set(review, options[i][0], options[i][1]);
    review->reading.kept[TL_READING_GARMENT][0] = '\0';
}

static void forget_avatar(struct tl_review *review)
{
    tl_review_set(review, "scene.avatar_units", "auto");
    tl_review_set(review, "scene.avatar_up", "auto");
    review->reading.kept[TL_READING_AVATAR][0] = '\0';
}

static void use_as_garment(struct tl_review *review, const char *path)
{
    if (strcmp(review->wanted.scene.garment, path) != 0)
        forget_garment(review);
    if (tl_review_set(review, "scene.garment", path))
        tl_review_apply_names(review);
}

/* A garment that was opened alone is worn by the body that comes after it. */
static void use_as_avatar(struct tl_review *review, const char *path)
{
    char *worn = is_alone(review) ? tl_copy_string(review->wanted.scene.avatar) : NULL;
    if (worn)
        use_as_garment(review, worn);
    if (strcmp(review->wanted.scene.avatar, path) != 0)
        forget_avatar(review);
    tl_review_set(review, "scene.avatar", path);
    free(worn);
}

/* In place of a model that was opened alone, which need not be a body. */
static void open_again(struct tl_review *review, const char *path)
{
    if (is_alone(review))
        tl_review_set(review, "scene.avatar", "auto");
    use_as_garment(review, path);
}

void tl_review_offer_recent(struct tl_review *review)
{
    struct tl_review_edit *edit = &review->edit;
    edit->offered = tl_recent_count(&review->keep.recent);
    for (size_t i = 0; i < edit->offered; i++) {
        const char *path = review->keep.recent.garments[i], *slash = strrchr(path, '/');
        edit->answers[i] = (struct tl_review_answer){slash ? slash + 1 : path, path, open_again};
    }
    if (edit->offered == 0)
        tl_review_report(review, "no garment has been opened from a file yet");
}

/* A point cache moves the mesh of its name beside it, if there is one; else the present garment. */
static void use_as_motion(struct tl_review *review, const char *path)
{
    tl_error error;
    char *mesh = tl_motion_find_mesh(path, &error);
    if (mesh)
        use_as_garment(review, mesh);
    tl_review_set(review, "scene.motion", path);
    free(mesh);
}

static void use_as_fabric(struct tl_review *review, const char *path)
{
    apply_named(review, tl_settings_apply_fabric, path);
}

/* Reports what a fabric's file holds, once it is used: how many of its fields are, and which are not. */
static void report_fields(struct tl_review *review, const tl_fabric_file *file)
{
    const struct tl_weave_params *weave = &review->wanted.weave;
    char *unused = tl_fabric_fields_unused(file), width[64] = "";
    size_t used = 0;
    for (size_t i = 0; i < file->field_count; i++)
        used += file->fields[i].is_used;
    if (tl_text_is_given(weave->pictures))
        snprintf(width, sizeof width, ", %g mm wide%s", (double)tl_weave_picture_mm(weave),
                 weave->picture_mm > 0 ? "" : " (assumed: set weave.picture_mm)");
    tl_review_report(review, "fabric %s: %zu of %zu fields are used%s%s%s", file->name, used,
                     file->field_count, width, unused[0] ? "; not used: " : "", unused);
    free(unused);
}

/* Uses a fabric of another program, or a folder of toile's own, and reports what of it. False, without a
 * report, for a file that is none: a .json file may be a pattern. */
static bool use_foreign_fabric(struct tl_review *review, const char *path)
{
    tl_error error;
    tl_fabric_file file;
    if (!tl_fabric_file_is(path))
        return false;
    char *own = tl_imported_own_file(path);
    bool is_own = own != NULL;
    free(own);
    if (is_own) {
        tl_review_use_fabric(review, path);
        return true;
    }
    if (!tl_fabric_file_open(path, &file, &error)) {
        bool may_be_pattern = tl_pattern_is_file(path);
        if (!may_be_pattern)
            tl_review_report_error(review, &error);
        return !may_be_pattern;
    }
    if (apply_named(review, tl_settings_apply_fabric, path))
        report_fields(review, &file);
    tl_fabric_file_release(&file);
    return true;
}

static void use_as_preset(struct tl_review *review, const char *path)
{
    apply_named(review, tl_settings_apply_preset, path);
}

static const struct tl_review_answer model_answers[] = {
    {"Garment", "worn by the avatar", use_as_garment},
    {"Avatar", "wears the garment", use_as_avatar},
    {"Cancel", "", NULL},
};

static const struct tl_review_answer text_answers[] = {
    {"Scene", "replaces all options", tl_review_use_scene},
    {"Fabric", "replaces fabric, weave and material", use_as_fabric},
    {"Preset", "replaces the quality of light, image and cloth", use_as_preset},
    {"Cancel", "", NULL},
};

const struct tl_review_answer *tl_review_answers(const struct tl_review *review, size_t *count)
{
    *count = review->edit.offered;
    if (*count > 0)
        return review->edit.answers;
    if (!review->edit.dropped)
        return NULL;
    bool is_model = tl_model_is_file(review->edit.dropped);
    *count = is_model ? TL_COUNT(model_answers) : TL_COUNT(text_answers);
    return is_model ? model_answers : text_answers;
}

void tl_review_answer(struct tl_review *review, size_t index)
{
    size_t count;
    const struct tl_review_answer *answers = tl_review_answers(review, &count);
    if (index >= count)
        return;
    char *path = review->edit.offered > 0 ? tl_copy_string(answers[index].help) : take_dropped(review);
    review->edit.offered = 0;
    if (answers[index].use)
        answers[index].use(review, path);
    free(path);
}

void tl_review_open_dropped(struct tl_review *review, const char *path)
{
    if (tl_path_has_extension(path, "exr") || tl_path_has_extension(path, "hdr")) {
        tl_review_add_environment(review, path);
        tl_review_set(review, "scene.environment", path);
    } else if (tl_point_cache_is_file(path)) {
        use_as_motion(review, path);
    } else if (use_foreign_fabric(review, path)) {
        return;
    } else if (tl_pattern_is_file(path)) {
        use_as_garment(review, path);
    } else if (tl_model_is_file(path) || tl_path_has_extension(path, "yaml") ||
               tl_path_has_extension(path, "yml")) {
        offer_kinds(review, path);
    } else {
        tl_error error;
        tl_fail(
            &error, TL_INPUT,
            "%s: cannot be used here: open a .glb, .gltf, .obj, .json (a pattern or a fabric's "
            "measurements), "
            ".pc2, .mdd, .exr, .hdr, .yaml, .u3m or .u3ma file, or a folder or .zip of a fabric's textures",
            path);
        tl_review_report_error(review, &error);
    }
}

void tl_review_take_chosen(struct tl_review *review)
{
    char *path = NULL;
    if (review->edit.chooser && tl_file_chooser_poll(&review->edit.chooser, &path) && path)
        tl_review_open_dropped(review, path);
    free(path);
}

/* One gesture is one edit: a slider's whole movement, a drag, or a key that is held or pressed repeatedly. */
static bool is_within_gesture(const struct tl_review *review)
{
    const double gesture_s = 0.4;
    return review->input.editing || review->input.drag != TL_DRAG_NONE || tl_review_moves_itself(review) ||
           tl_clock_s() - review->due.moved_s < gesture_s;
}

void tl_review_note_edit(struct tl_review *review)
{
    if (review->due.changed || review->load.loader || is_within_gesture(review))
        return;
    bool is_edit = tl_history_note(review->keep.history, &review->good);
    tl_journal_note(review->keep.journal, &review->good, is_edit);
}

void tl_review_note_wanted(struct tl_review *review)
{
    if (!tl_review_moves_itself(review) && tl_history_note(review->keep.history, &review->wanted))
        tl_journal_note(review->keep.journal, &review->wanted, true);
}

void tl_review_undo(struct tl_review *review, bool redo)
{
    tl_review_note_wanted(review);
    const struct tl_settings *edit =
        redo ? tl_history_redo(review->keep.history) : tl_history_undo(review->keep.history);
    if (!edit) {
        tl_review_report(review, redo ? "nothing to redo" : "nothing to undo");
        return;
    }
    struct tl_settings before = review->wanted;
    tl_history_restore(edit, &review->wanted);
    tl_review_mark_changed(review);
    tl_journal_undo(review->keep.journal, redo, &review->wanted);
    char *text =
        redo ? tl_history_describe(&before, &review->wanted) : tl_history_describe(&review->wanted, &before);
    tl_review_report(review, redo ? "redone: %s" : "undone: %s", text);
    free(text);
}
