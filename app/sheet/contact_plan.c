#include "app/sheet/contact_plan.h"

#include "app/scene/load.h"
#include "app/settings/command.h"
#include "app/sheet/contact_names.h"
#include "app/sheet/contact_store.h"
#include "assets/model.h"
#include "config/base/file.h"
#include "config/base/hash.h"
#include "config/base/memory.h"
#include "config/base/words.h"
#include "config/embedded.h"

#include <stdlib.h>
#include <string.h>

#define CELL_WIDTH  "image.width=240"
#define CELL_HEIGHT "image.height=320"
#define ALL         "all"

/* ---- Names ---- */

static void make_slugs_unique(struct tl_contact_plan *plan)
{
    char ***rows = TL_NEW_ARRAY(char **, plan->row_count),
         ***columns = TL_NEW_ARRAY(char **, plan->column_count);
    for (size_t i = 0; i < plan->row_count; i++)
        rows[i] = &plan->rows[i].slug;
    for (size_t i = 0; i < plan->column_count; i++)
        columns[i] = &plan->columns[i].slug;
    tl_contact_make_unique(rows, plan->row_count);
    tl_contact_make_unique(columns, plan->column_count);
    free((void *)rows);
    free((void *)columns);
}

char *tl_contact_cell_name(const struct tl_contact_plan *plan, size_t row, size_t column)
{
    return tl_format("%s_%s.png", plan->rows[row].slug, plan->columns[column].slug);
}

/* ---- Hashes ---- */

static uint64_t hash_text(uint64_t hash, const char *text)
{
    return tl_hash(hash, text, strlen(text) + 1);
}

/* Adds a file's name and contents to the hash; where it cannot be read, its name alone. */
static uint64_t hash_file(uint64_t hash, const char *name)
{
    char *data;
    size_t size;
    tl_error ignored;
    hash = hash_text(hash, name);
    if (!tl_option_is_file_name(name) || !tl_file_read(name, &data, &size, &ignored))
        return hash;
    hash = tl_hash(hash, data, size);
    free(data);
    return hash;
}

static uint64_t hash_settings(const struct tl_settings *settings, int frame)
{
    const struct tl_option_filter all = {.any_of = UINT64_MAX};
    uint64_t hash = hash_text(tl_settings_hash(settings, all), TOILE_VERSION);
    hash = tl_hash(hash, &frame, sizeof frame);
    hash = tl_colourways_hash(settings->colourways, hash);
    const char *const files[] = {settings->scene.garment, settings->scene.avatar, settings->scene.motion};
    for (size_t i = 0; i < TL_COUNT(files); i++)
        hash = hash_file(hash, files[i]);
    return hash;
}

uint64_t tl_contact_cell_hash(const struct tl_contact_plan *plan, size_t row, size_t column)
{
    const struct tl_contact_column *at = &plan->columns[column];
    uint64_t hash = hash_file(plan->rows[row].hash, at->environment);
    hash = tl_hash(hash, &at->view.camera, sizeof at->view.camera);
    hash = tl_hash(hash, &at->view.key.camera, sizeof at->view.key.camera);
    hash = tl_hash(hash, &at->view.key.environment_yaw_deg, sizeof at->view.key.environment_yaw_deg);
    hash = tl_hash(hash, &at->view.has_pitch, sizeof at->view.has_pitch);
    hash = tl_hash(hash, &at->view.yaw_deg, sizeof at->view.yaw_deg);
    return tl_hash(hash, &at->view.pitch_deg, sizeof at->view.pitch_deg);
}

/* ---- Views ---- */

static const struct {
    const char *name;
    float yaw_deg;
} orbits[] = {{"front", 0},      {"3/4", 35},   {"side", 90},  {"left", 90},
              {"back-3/4", 145}, {"back", 180}, {"right", -90}};

static bool fail_view(const char *text, tl_error *error)
{
    const char *names[TL_COUNT(orbits) + 1] = {"scene"};
    for (size_t i = 0; i < TL_COUNT(orbits); i++)
        names[i + 1] = orbits[i].name;
    const char *near = tl_nearest_word(text, names, TL_COUNT(names));
    return tl_fail(error, TL_USAGE,
                   "--views: \"%s\": expected front, 3/4, side, left, back-3/4, back, right, scene, degrees "
                   "round and down as in 30 or 30:10, or a camera path's .yaml file%s%s%s",
                   text, near ? ": did you mean " : "", near ? near : "", near ? "?" : "");
}

bool tl_contact_view_read(const char *text, struct tl_contact_view *out, tl_error *error)
{
    *out =
        (struct tl_contact_view){.camera = strcmp(text, "scene") == 0 ? TL_CONTACT_SCENE : TL_CONTACT_ORBIT};
    for (size_t i = 0; i < TL_COUNT(orbits); i++)
        if (strcmp(text, orbits[i].name) == 0) {
            out->yaw_deg = orbits[i].yaw_deg;
            out->name = tl_copy_string(text);
            return true;
        }
    char *end = NULL;
    if (out->camera == TL_CONTACT_ORBIT) {
        out->yaw_deg = strtof(text, &end);
        bool good = end != text && fabsf(out->yaw_deg) <= 3600;
        if (good && *end == ':') {
            const char *pitch = end + 1;
            out->has_pitch = true;
            out->pitch_deg = strtof(pitch, &end);
            good = end != pitch && fabsf(out->pitch_deg) <= 90;
        }
        if (!good || *end)
            return fail_view(text, error);
    }
    out->name = tl_copy_string(text);
    return true;
}

/* ---- Rows ---- */

/* The choices that make a row; "" keeps the scene's. */
struct choice {
    const char *garment, *fabric, *colourway;
};

static bool load_row(const struct tl_arguments *arguments, const struct choice *choice,
                     struct tl_settings *out, tl_error *error)
{
    char *own[] = {tl_copy_string(CELL_WIDTH), tl_copy_string(CELL_HEIGHT),
                   tl_format("scene.garment=%s", choice->garment),
                   tl_format("scene.fabric=%s", choice->fabric),
                   tl_format("scene.colourway=%s", choice->colourway)};
    const char *const chosen[] = {choice->garment, choice->fabric, choice->colourway};
    size_t count = 0, given = arguments->assignment_count;
    char **all = TL_NEW_ARRAY(char *, TL_COUNT(own) + given);
    all[count++] = own[0];
    all[count++] = own[1];
    for (size_t i = 0; i < given; i++)
        all[count++] = arguments->assignments[i];
    for (size_t i = 0; i < TL_COUNT(chosen); i++)
        if (chosen[i][0])
            all[count++] = own[2 + i];
    struct tl_arguments changed = *arguments;
    changed.assignments = all;
    changed.assignment_count = count;
    bool loaded = tl_settings_of_command(&changed, false, out, error);
    for (size_t i = 0; i < TL_COUNT(own); i++)
        free(own[i]);
    free((void *)all);
    return loaded;
}

static char *row_name(const struct choice *choice)
{
    char *fabric = tl_contact_label_of(strcmp(choice->fabric, "none") == 0 ? "its own" : choice->fabric);
    char *name =
        tl_format("%s%s%s", fabric, fabric[0] && choice->colourway[0] ? ", " : "", choice->colourway);
    free(fabric);
    return name;
}

static char *row_slug(const struct tl_settings *settings)
{
    char *parts[] = {tl_contact_slug(settings->scene.garment), tl_contact_slug(settings->scene.fabric),
                     tl_contact_slug(settings->scene.colourway)};
    char *slug = tl_format("%s_%s%s%s", parts[0], parts[1], parts[2][0] ? "_" : "", parts[2]);
    for (size_t i = 0; i < TL_COUNT(parts); i++)
        free(parts[i]);
    return slug;
}

/* All undecided rows show the model in place of a scene, so it is loaded for the first of them. One that
 * cannot be read stays undecided: rendering its row reports the reason. */
static void decide(const struct tl_contact_plan *plan, struct tl_scene_params *scene)
{
    if (scene->is_undecided && plan->row_count > 0) {
        const struct tl_scene_params *first = &plan->rows[0].settings.scene;
        scene->garment = first->garment;
        scene->avatar = first->avatar;
        scene->avatar_units = first->avatar_units;
        scene->is_undecided = first->is_undecided;
    } else {
        tl_model model;
        tl_error ignored;
        tl_scene_decide(scene, &model, &ignored);
        tl_model_release(&model);
    }
}

static bool add_row(const struct tl_arguments *arguments, const struct choice *choice,
                    struct tl_contact_plan *plan, tl_error *error)
{
    struct tl_contact_row row = {0};
    if (!load_row(arguments, choice, &row.settings, error))
        return false;
    decide(plan, &row.settings.scene);
    row.garment = tl_contact_label_of(row.settings.scene.garment);
    row.name = row_name(choice);
    row.slug = row_slug(&row.settings);
    plan->rows = tl_resize(plan->rows, plan->row_count + 1, sizeof *plan->rows);
    plan->rows[plan->row_count++] = row;
    return true;
}

static void add_variants(const char *path, struct tl_names *out)
{
    tl_model model;
    tl_error ignored;
    if (!tl_model_is_file(path) || !tl_model_load(path, &model, &ignored))
        return; /* rendering its row reports the reason */
    for (size_t i = 0; i < model.variant_count; i++)
        tl_names_add(out, tl_copy_string(model.variants[i].name));
    tl_model_release(&model);
}

/* Lists the colourways of the scene file and of the garment's and the avatar's files. */
static bool find_colourways(const struct tl_arguments *arguments, const char *garment, struct tl_names *out,
                            tl_error *error)
{
    struct tl_settings settings;
    *out = (struct tl_names){0};
    if (!load_row(arguments, &(const struct choice){garment, "", ""}, &settings, error))
        return false;
    for (size_t i = 0; i < settings.colourways->name_count; i++)
        tl_names_add(out, tl_copy_string(settings.colourways->names[i]));
    add_variants(settings.scene.garment, out);
    add_variants(settings.scene.avatar, out);
    return out->count > 0 ||
           tl_fail(error, TL_USAGE,
                   "--colourways: %s: has none: write some into a scene file, or leave it out",
                   settings.scene.garment);
}

static bool add_garment(const struct tl_arguments *arguments, const char *garment,
                        const struct tl_names *fabrics, const struct tl_names *colourways,
                        struct tl_contact_plan *plan, tl_error *error)
{
    struct tl_names found = {0};
    bool all = colourways->count == 1 && strcmp(colourways->items[0], ALL) == 0;
    if (all && !find_colourways(arguments, garment, &found, error))
        return false;
    const struct tl_names *used = all ? &found : colourways;
    bool added = true;
    for (size_t f = 0; added && f < fabrics->count; f++)
        for (size_t c = 0; added && c < used->count; c++)
            added = add_row(arguments, &(const struct choice){garment, fabrics->items[f], used->items[c]},
                            plan, error);
    tl_names_release(&found);
    return added;
}

static bool read_fabrics(const char *text, struct tl_names *out, tl_error *error)
{
    if (!text || strcmp(text, ALL) != 0)
        return tl_names_read("--fabrics", text, "", out, error);
    *out = (struct tl_names){0};
    for (const char *const *name = tl_embedded_fabrics_names; *name; name++)
        if (strcmp(*name, "none") != 0)
            tl_names_add(out, tl_copy_string(*name));
    return true;
}

static bool add_rows(const struct tl_arguments *arguments, struct tl_contact_plan *plan, tl_error *error)
{
    struct tl_names garments = {0}, fabrics = {0}, colourways = {0};
    bool added = tl_names_read("--garments", arguments->sheet.garments, "", &garments, error) &&
                 read_fabrics(arguments->sheet.fabrics, &fabrics, error) &&
                 tl_names_read("--colourways", arguments->sheet.colourways, "", &colourways, error);
    for (size_t i = 0; added && i < garments.count; i++)
        added = add_garment(arguments, garments.items[i], &fabrics, &colourways, plan, error);
    tl_names_release(&garments);
    tl_names_release(&fabrics);
    tl_names_release(&colourways);
    return added;
}

/* Gives all rows of a garment the mechanical fabric of its first row, so that one drape serves for all. */
static void share_drapes(struct tl_contact_plan *plan)
{
    for (size_t i = 1; i < plan->row_count; i++) {
        struct tl_settings *settings = &plan->rows[i].settings;
        const struct tl_settings *before = &plan->rows[i - 1].settings;
        if (strcmp(settings->scene.garment, before->scene.garment) == 0)
            settings->fabric = before->fabric;
    }
}

/* ---- Columns ---- */

static bool check_environment(const struct tl_contact_plan *plan, const char *name, tl_error *error)
{
    struct tl_settings unused = plan->rows[0].settings;
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    tl_settings_bind(&unused, bindings);
    return tl_options_set(bindings, TL_SETTINGS_TABLES, "scene.environment", name, "--envs", NULL, error);
}

/* Takes ownership of the view's name. */
static void add_column(struct tl_contact_plan *plan, const char *environment,
                       const struct tl_contact_view *view)
{
    const char *name = environment[0] ? environment : plan->rows[0].settings.scene.environment;
    char *parts[] = {tl_contact_slug(name), tl_contact_plain(view->name, strlen(view->name))};
    plan->columns = tl_resize(plan->columns, plan->column_count + 1, sizeof *plan->columns);
    plan->columns[plan->column_count++] =
        (struct tl_contact_column){.environment = tl_copy_string(name),
                                   .view = *view,
                                   .group = tl_contact_label_of(name),
                                   .slug = tl_format("%s_%s", parts[0], parts[1])};
    free(parts[0]);
    free(parts[1]);
}

/* Adds a column for each key of a camera path. */
static bool add_path(struct tl_contact_plan *plan, const char *environment, const char *file, tl_error *error)
{
    struct tl_path path;
    if (!tl_path_load(file, &plan->rows[0].settings, &path, error))
        return false;
    char *stem = tl_contact_slug(file);
    for (size_t i = 0; i < path.count; i++) {
        struct tl_contact_view view = {
            .name = tl_format("%s %zu", stem, i + 1), .camera = TL_CONTACT_KEY, .key = path.keys[i]};
        add_column(plan, environment, &view);
    }
    free(stem);
    tl_path_release(&path);
    return true;
}

static bool add_view(struct tl_contact_plan *plan, const char *environment, const char *text, tl_error *error)
{
    if (tl_path_has_extension(text, "yaml") || tl_path_has_extension(text, "yml"))
        return add_path(plan, environment, text, error);
    struct tl_contact_view view;
    if (!tl_contact_view_read(text, &view, error))
        return false;
    add_column(plan, environment, &view);
    return true;
}

static bool add_columns(const struct tl_arguments *arguments, struct tl_contact_plan *plan, tl_error *error)
{
    struct tl_names environments = {0}, views = {0};
    const char *seen = arguments->sheet.views ? arguments->sheet.views : "front,3/4,back";
    bool added = tl_names_read("--envs", arguments->sheet.environments, "", &environments, error) &&
                 tl_names_read("--views", seen, "", &views, error);
    for (size_t e = 0; added && e < environments.count; e++) {
        const char *name = environments.items[e];
        added = !name[0] || check_environment(plan, name, error);
        for (size_t v = 0; added && v < views.count; v++)
            added = add_view(plan, name, views.items[v], error);
    }
    tl_names_release(&environments);
    tl_names_release(&views);
    return added;
}

bool tl_contact_cell_settings(const struct tl_contact_plan *plan, size_t row, size_t column,
                              struct tl_settings *out, tl_error *error)
{
    const struct tl_contact_column *at = &plan->columns[column];
    *out = plan->rows[row].settings;
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    tl_settings_bind(out, bindings);
    if (!tl_options_set(bindings, TL_SETTINGS_TABLES, "scene.environment", at->environment, "--envs", NULL,
                        error))
        return false;
    if (at->view.camera == TL_CONTACT_KEY) {
        out->camera = at->view.key.camera;
        out->scene.environment_yaw_deg = at->view.key.environment_yaw_deg;
    }
    if (at->view.camera == TL_CONTACT_ORBIT) {
        float from_deg = out->camera.yaw_deg;
        out->camera.yaw_deg = at->view.yaw_deg;
        tl_settings_turn_studio(out, from_deg); /* the figure turns before the lights */
    }
    if (at->view.has_pitch)
        out->camera.pitch_deg = at->view.pitch_deg;
    return true;
}

/* ---- Labels ---- */

static bool have_one_garment(const struct tl_contact_plan *plan)
{
    for (size_t i = 1; i < plan->row_count; i++)
        if (strcmp(plan->rows[i].garment, plan->rows[0].garment) != 0)
            return false;
    return true;
}

static bool have_one_environment(const struct tl_contact_plan *plan)
{
    for (size_t i = 1; i < plan->column_count; i++)
        if (strcmp(plan->columns[i].group, plan->columns[0].group) != 0)
            return false;
    return true;
}

static void label(const struct tl_arguments *arguments, struct tl_contact_plan *plan)
{
    const struct tl_settings *first = &plan->rows[0].settings;
    bool one_garment = have_one_garment(plan), one_environment = have_one_environment(plan);
    plan->row_labels = TL_NEW_ARRAY(struct tl_contact_label, plan->row_count);
    plan->column_labels = TL_NEW_ARRAY(struct tl_contact_label, plan->column_count);
    for (size_t i = 0; i < plan->row_count; i++) {
        const struct tl_contact_row *row = &plan->rows[i];
        bool has_name = row->name[0] != '\0';
        plan->row_labels[i] = (struct tl_contact_label){one_garment || !has_name ? "" : row->garment,
                                                        has_name || one_garment ? row->name : row->garment};
    }
    for (size_t i = 0; i < plan->column_count; i++)
        plan->column_labels[i] = (struct tl_contact_label){one_environment ? "" : plan->columns[i].group,
                                                           plan->columns[i].view.name};
    char *scene = tl_contact_label_of(arguments->positional_count ? arguments->positionals[0] : "");
    plan->title = tl_format("%s%s%s", scene, scene[0] && one_garment ? ": " : "",
                            one_garment ? plan->rows[0].garment
                            : scene[0]  ? ""
                                        : "built-in scene");
    free(scene);
    char *preset = tl_contact_label_of(first->scene.preset);
    plan->note = tl_format("%s%s%s preset, frame %d%s", one_environment ? plan->columns[0].group : "",
                           one_environment ? ", " : "", preset, arguments->first_frame,
                           plan->same_drape ? ", one drape for all fabrics" : "");
    free(preset);
    plan->grid = (struct tl_contact_grid){.title = plan->title,
                                          .note = plan->note,
                                          .rows = plan->row_labels,
                                          .columns = plan->column_labels,
                                          .row_count = plan->row_count,
                                          .column_count = plan->column_count,
                                          .cell_width = first->image.width,
                                          .cell_height = first->image.height};
}

bool tl_contact_plan_make(const struct tl_arguments *arguments, struct tl_contact_plan *out, tl_error *error)
{
    *out = (struct tl_contact_plan){.same_drape = arguments->same_drape};
    bool made = add_rows(arguments, out, error) && add_columns(arguments, out, error);
    size_t cells = out->row_count * out->column_count;
    if (made && cells > TL_CONTACT_CELLS_MAX)
        made = tl_fail(error, TL_USAGE, "sheet: %zu cells, more than %d: ask for fewer", cells,
                       TL_CONTACT_CELLS_MAX);
    if (!made) {
        tl_contact_plan_release(out);
        return false;
    }
    if (out->same_drape)
        share_drapes(out);
    make_slugs_unique(out);
    for (size_t i = 0; i < out->row_count; i++)
        out->rows[i].hash = hash_settings(&out->rows[i].settings, arguments->first_frame);
    label(arguments, out);
    return true;
}

void tl_contact_plan_release(struct tl_contact_plan *plan)
{
    for (size_t i = 0; i < plan->row_count; i++) {
        free(plan->rows[i].garment);
        free(plan->rows[i].name);
        free(plan->rows[i].slug);
    }
    for (size_t i = 0; i < plan->column_count; i++) {
        free(plan->columns[i].environment);
        free(plan->columns[i].view.name);
        free(plan->columns[i].group);
        free(plan->columns[i].slug);
    }
    free(plan->rows);
    free(plan->columns);
    free(plan->title);
    free(plan->note);
    free(plan->row_labels);
    free(plan->column_labels);
    *plan = (struct tl_contact_plan){0};
}
