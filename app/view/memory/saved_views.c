#include "app/view/memory/saved_views.h"

#include "app/scene/orbit.h"
#include "app/view/memory/state.h"
#include "config/base/file.h"
#include "config/base/hash.h"
#include "config/base/intern.h"
#include "config/base/memory.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TABLES_A_VIEW 4

static const struct tl_option view_rows[] = {
    TL_OPTION_BOOL(struct tl_saved_view, saved, TL_AFFECTS_NOTHING, "the view has been saved"),
    TL_OPTION_STRING(struct tl_saved_view, environment, TL_AFFECTS_NOTHING, "as scene.environment"),
    TL_OPTION_FLOAT(struct tl_saved_view, environment_yaw_deg, TL_AFFECTS_NOTHING, -3600, 3600, "degrees",
                    "as scene.environment_yaw_deg"),
    TL_OPTION_FLOAT(struct tl_saved_view, exposure_ev, TL_AFFECTS_NOTHING, -100, 100, "EV",
                    "as image.exposure_ev"),
};
static const struct tl_option_table view_table =
    TL_OPTION_TABLE("view", "a saved view", view_rows, struct tl_saved_view, .saved = false);

struct view_tables {
    struct tl_option_table tables[TL_SAVED_VIEWS * TABLES_A_VIEW];
    char names[TL_SAVED_VIEWS * TABLES_A_VIEW][16];
    struct tl_binding bindings[TL_SAVED_VIEWS * TABLES_A_VIEW];
    size_t count;
};

/* Adds a table under a numbered name: "camera" becomes "camera3". */
static void bind(struct view_tables *tables, const struct tl_option_table *table, int number, void *params)
{
    size_t i = tables->count++;
    snprintf(tables->names[i], sizeof tables->names[i], "%s%d", table->name, number);
    tables->tables[i] = *table;
    tables->tables[i].name = tables->names[i];
    tables->bindings[i] = (struct tl_binding){&tables->tables[i], params};
}

/* Tables of every view, or of the saved ones only. */
static void bind_views(struct view_tables *tables, struct tl_saved_views *views, bool saved_only)
{
    tables->count = 0;
    for (int i = 0; i < TL_SAVED_VIEWS; i++) {
        struct tl_saved_view *view = &views->of[i];
        if (saved_only && !view->saved)
            continue;
        bind(tables, &view_table, i + 1, view);
        bind(tables, &tl_camera_options, i + 1, &view->camera);
        bind(tables, &tl_lamp_options, i + 1, &view->lamp);
        bind(tables, &tl_fill_options, i + 1, &view->fill);
    }
}

/* An absolute path for a file's name; other names as they are. New string. */
static char *full_name(const char *name)
{
    char *path = tl_option_is_file_name(name) ? realpath(name, NULL) : NULL;
    char *copy = tl_copy_string(path ? path : name);
    free(path);
    return copy;
}

struct tl_saved_view tl_saved_view_take(const struct tl_settings *settings)
{
    struct tl_saved_view view = {.saved = true,
                                 .environment_yaw_deg = settings->scene.environment_yaw_deg,
                                 .exposure_ev = settings->image.exposure_ev,
                                 .camera = settings->camera,
                                 .lamp = settings->lamp,
                                 .fill = settings->fill};
    char *name = full_name(settings->scene.environment);
    view.environment = tl_intern(name);
    free(name);
    return view;
}

void tl_saved_view_apply(const struct tl_saved_view *view, struct tl_settings *settings)
{
    settings->scene.environment = view->environment;
    settings->scene.environment_yaw_deg = view->environment_yaw_deg;
    settings->image.exposure_ev = view->exposure_ev;
    settings->camera = view->camera;
    settings->lamp = view->lamp;
    settings->fill = view->fill;
}

struct tl_saved_view tl_saved_view_between(const struct tl_saved_view *from, const struct tl_saved_view *to,
                                           float share)
{
    struct tl_saved_view between = *to;
    if (share >= 1)
        return between;
    float eased = share * share * (3 - 2 * share);
    between.camera = tl_orbit_between(&from->camera, &to->camera, eased);
    between.environment_yaw_deg =
        tl_orbit_angle_between(from->environment_yaw_deg, to->environment_yaw_deg, eased);
    between.exposure_ev = glm_lerp(from->exposure_ev, to->exposure_ev, eased);
    return between;
}

bool tl_saved_views_load(const char *file, struct tl_saved_views *out, tl_error *error)
{
    struct view_tables tables;
    bind_views(&tables, out, false);
    tl_options_reset(tables.bindings, tables.count);
    if (!tl_file_exists(file))
        return true;
    if (tl_options_read_yaml_file(tables.bindings, tables.count, file, error))
        return true;
    tl_options_reset(tables.bindings, tables.count);
    return false;
}

bool tl_saved_views_save(const char *file, const struct tl_saved_views *views, tl_error *error)
{
    struct tl_saved_views copy = *views; /* bindings can be written through */
    struct view_tables tables;
    bind_views(&tables, &copy, true);
    return tl_state_write(file, tables.bindings, tables.count, error);
}

/* Letters and digits of a name without its folder and extension. */
static void shorten(const char *name, char *out, size_t size)
{
    const char *slash = strrchr(name, '/');
    size_t length = 0;
    for (const char *c = slash ? slash + 1 : name; *c && *c != '.' && length + 1 < size; c++)
        out[length++] = isalnum((unsigned char)*c) ? *c : '_';
    out[length] = '\0';
}

char *tl_saved_views_name(const struct tl_scene_params *scene)
{
    char garment[32], avatar[32];
    shorten(scene->garment, garment, sizeof garment);
    shorten(scene->avatar, avatar, sizeof avatar);
    char *names[] = {full_name(scene->garment), full_name(scene->avatar)};
    uint64_t hash = TL_HASH_START;
    for (size_t i = 0; i < TL_COUNT(names); i++) {
        hash = tl_hash(tl_hash(hash, names[i], strlen(names[i])), "\n", 1);
        free(names[i]);
    }
    return tl_format("%s-%s-%016" PRIx64 ".yaml", garment, avatar, hash);
}
