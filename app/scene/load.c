#include "app/scene/load.h"

#include "app/fit/sewn.h"
#include "assets/base/placing.h"
#include "assets/body/fit.h"
#include "assets/garment.h"
#include "assets/model.h"
#include "assets/pattern/pattern.h"
#include "assets/pattern/pattern_worn.h"
#include "assets/refine.h"
#include "assets/sewing/rest.h"
#include "assets/sewing/stitches.h"
#include "assets/specimen/specimen.h"
#include "assets/topology/simplify.h"
#include "cloth/contact/collider.h"
#include "cloth/mesh/topology.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

static bool is_built_in_garment(const char *name)
{
    for (const char *const *known = tl_garment_names; *known; known++)
        if (strcmp(*known, name) == 0)
            return true;
    return false;
}

static void report_line(char *line)
{
    if (line)
        tl_info("%s", line);
    free(line);
}

/* The option's up axis, or the one that the geometry shows, which is logged. A recorded motion, or a rig,
 * moves vertices in the file's own axes: such models are turned on request only. */
static bool is_z_up(const tl_model *model, int up, bool moves, const char *option)
{
    if (up != TL_UP_AUTO || moves)
        return up == TL_UP_Z;
    report_line(tl_units_describe_up(model->name, &model->units, option));
    return model->units.z_up;
}

static bool place_avatar(const struct tl_settings *settings, tl_avatar *avatar, tl_error *error)
{
    int up = settings->scene.avatar_up;
    bool has_rig = avatar->model.rig != NULL;
    if (has_rig && up == TL_UP_Z)
        return tl_fail(error, TL_USAGE, "scene.avatar_up: %s has a rig, which moves it with Y up",
                       avatar->model.name);
    const struct tl_placing placing = {.z_up = is_z_up(&avatar->model, up, has_rig, "scene.avatar_up"),
                                       .scale = 1};
    tl_placing_apply(&placing, &avatar->model.mesh);
    return true;
}

/* Whether the garment hangs on arms or legs, as patterns may. */
static bool needs_limbs(const char *garment)
{
    return tl_garment_is_for_figure(garment) || tl_pattern_is_file(garment);
}

/* Simplifies a heavy body that wears a garment. What is shown alone is shown as its file has it. */
static void simplify_avatar(const struct tl_settings *settings, tl_avatar *avatar)
{
    tl_model *model = &avatar->model;
    if (settings->scene.body_detail == TL_BODY_FULL || strcmp(settings->scene.garment, "none") == 0)
        return;
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, model->mesh.vertex_count);
    tl_weld_positions(model->mesh.positions, model->mesh.vertex_count, weld);
    const struct tl_simplified simplified = tl_simplify_model(model, weld);
    avatar->simplified = simplified.after < simplified.before;
    report_line(tl_simplified_describe(model->name, &simplified));
    free(weld);
}

bool tl_scene_decide(struct tl_scene_params *scene, tl_model *out, tl_error *error)
{
    const bool has_units = scene->avatar_units != TL_UNITS_AUTO;
    const int units = has_units ? scene->avatar_units : scene->units;
    *out = (tl_model){0};
    if (!scene->is_undecided)
        return true;
    if (!tl_model_load_in(scene->avatar, (enum tl_units)units, out, error))
        return false;
    if (out->stitch_count > 0 || tl_sewn_is_worn(out))
        tl_settings_wear(scene);
    else
        scene->avatar_units = units;
    scene->is_undecided = false;
    return true;
}

/* Moves a model that is loaded already; false when there is none. */
static bool take_loaded(tl_model *loaded, tl_model *out)
{
    const bool is_there = loaded->name != NULL;
    if (is_there)
        *out = *loaded;
    *loaded = (tl_model){0};
    return is_there;
}

/* Makes or reads the avatar that the scene names, which is not "none". */
static bool make_avatar(const struct tl_settings *settings, tl_model *loaded, tl_avatar *out, tl_error *error)
{
    const char *name = tl_settings_avatar(&settings->scene);
    if (strcmp(name, "form") == 0)
        *out = needs_limbs(settings->scene.garment) ? tl_avatar_figure() : tl_avatar_form();
    else if (strcmp(name, "figure") == 0)
        *out = tl_avatar_figure();
    else if (strcmp(name, "ball") == 0)
        *out = tl_specimen_ball();
    else if (!take_loaded(loaded, &out->model) &&
             !tl_avatar_load_in(name, (enum tl_units)settings->scene.avatar_units, out, error))
        return false;
    report_line(tl_units_describe(out->model.name, &out->model.units, "scene.avatar_units"));
    for (size_t i = 0; i < out->model.defect_count; i++)
        tl_info("%s: %s", out->model.name, out->model.defects[i]);
    if (!place_avatar(settings, out, error)) {
        tl_avatar_release(out);
        return false;
    }
    simplify_avatar(settings, out);
    return true;
}

bool tl_scene_load_whole_avatar(const struct tl_settings *settings, tl_avatar *out, tl_error *error)
{
    const struct tl_scene_params *scene = &settings->scene;
    if (!tl_avatar_load_in(tl_settings_avatar(scene), (enum tl_units)scene->avatar_units, out, error))
        return false;
    bool turns = scene->avatar_up == TL_UP_AUTO && !out->model.rig && out->model.units.z_up;
    const struct tl_placing placing = {.z_up = turns || scene->avatar_up == TL_UP_Z, .scale = 1};
    tl_placing_apply(&placing, &out->model.mesh);
    return true;
}

/* Finds the clip that the scene names; -1: the rest pose. */
static bool find_clip(const struct tl_settings *settings, const tl_model *model, int *clip, tl_error *error)
{
    const char *name = settings->scene.clip;
    *clip = -1;
    if (strcmp(name, "none") == 0)
        return true;
    *clip = tl_model_find_clip(model, name);
    if (*clip >= 0 || name[0] == '\0')
        return true;
    const char *file = settings->scene.avatar;
    if (model->clip_count == 0)
        return tl_fail(error, TL_INPUT, "%s: has no animation \"%s\", nor any other: leave scene.clip out",
                       file, name);
    return tl_fail(error, TL_INPUT,
                   "%s: has no animation \"%s\": its first is \"%s\", `toile info` lists them all", file,
                   name, model->clips[0].name);
}

bool tl_scene_load_avatar(const struct tl_settings *settings, tl_model *loaded, tl_avatar **out, int *clip,
                          tl_error *error)
{
    tl_avatar made = {0};
    *out = NULL;
    *clip = -1;
    if (strcmp(tl_settings_avatar(&settings->scene), "none") == 0)
        return true;
    if (!make_avatar(settings, loaded, &made, error))
        return false;
    *out = TL_NEW(tl_avatar);
    **out = made;
    return find_clip(settings, &made.model, clip, error);
}

bool tl_scene_plays_motion(const struct tl_settings *settings)
{
    return strcmp(settings->scene.motion, "none") != 0;
}

/* Splits long edges, across which cloth cannot fold. A garment that is played back is left as it is: its
 * motion has one position for each vertex of the file. So is one with seams, whose sides are divided alike.
 */
static bool refine_garment(const struct tl_settings *settings, tl_garment *garment, tl_error *error)
{
    float max_m = settings->cloth.longest_edge_m;
    const tl_mesh *mesh = &garment->model.mesh;
    size_t triangles = mesh->index_count / 3;
    float longest_m = tl_mesh_longest_edge(mesh);
    if (tl_scene_plays_motion(settings) || !(max_m > 0) || !(longest_m > max_m) || garment->seam_count > 0)
        return true;
    if (!tl_garment_refine(garment, max_m, error))
        return false;
    tl_info("%s: edges of up to %.3g m cannot fold: %zu triangles were split into %zu with none above %g m; "
            "cloth.longest_edge_m=0 leaves them as they are",
            garment->model.name, (double)longest_m, triangles, mesh->index_count / 3, (double)max_m);
    return true;
}

/* Decides between UVs and mesh, for the mesh as it stands and is split. */
static bool take_rest(const struct tl_settings *settings, tl_garment *garment, tl_error *error)
{
    struct tl_charts charts = tl_charts_find(&garment->model.mesh);
    enum tl_rest_choice choice = (enum tl_rest_choice)settings->cloth.rest;
    bool taken = tl_rest_take(choice, &charts, garment, error);
    if (taken && choice == TL_REST_AUTO && charts.whole.verdict == TL_CHART_IS_PATTERN)
        report_line(tl_rest_describe(garment->model.name, &charts));
    tl_charts_release(&charts);
    return taken;
}

/* Lifts a garment without an avatar onto the ground. No body places it, and below the ground it would be
 * hidden, and pushed out at the first step. Returns by how much, in metres. */
static float lift_garment(const struct tl_settings *settings, const tl_avatar *wearer, tl_garment *garment)
{
    tl_mesh *mesh = &garment->model.mesh;
    float lowest_m = tl_box_of(mesh->positions, mesh->vertex_count).lower.y;
    if (wearer || !settings->image.ground || tl_scene_plays_motion(settings) || !(lowest_m < 0))
        return 0;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        mesh->positions[i].y -= lowest_m;
    tl_info("%s: reached %.2g m below the ground: lifted onto it; image.ground=false leaves it where it was",
            garment->model.name, (double)-lowest_m);
    return -lowest_m;
}

static bool place_garment(const struct tl_settings *settings, const tl_avatar *wearer, tl_garment *garment,
                          tl_error *error)
{
    const struct tl_scene_params *scene = &settings->scene;
    const tl_mesh *mesh = &garment->model.mesh;
    struct tl_units_reading *reading = &garment->model.units;
    if (wearer && !reading->metric) {
        struct tl_box box = tl_box_of(mesh->positions, mesh->vertex_count);
        struct tl_box body = tl_box_of(wearer->model.mesh.positions, wearer->model.mesh.vertex_count);
        reading->z_up |= tl_units_lies_z_up(box, body);
        reading->deep &= !tl_units_lies_y_up(box, body);
    }
    const struct tl_placing placing = {
        .z_up = is_z_up(&garment->model, scene->up, tl_scene_plays_motion(settings), "--up"),
        .scale = scene->scale,
        .turn_deg = scene->turn_deg,
        .move_m = {{scene->move_m[0], scene->move_m[1], scene->move_m[2]}},
    };
    if (tl_scene_plays_motion(settings) && tl_placing_moves(&placing))
        return tl_fail(error, TL_USAGE,
                       "scene.motion: plays where it was recorded: leave up, turn_deg, scale and move_m out");
    tl_placing_apply(&placing, &garment->model.mesh);
    return true;
}

/* Sews panels by the file's stitches. Their recorded motion is of the file's own vertices. */
static void take_stitches(const struct tl_settings *settings, tl_garment *garment)
{
    if (tl_scene_plays_motion(settings))
        return;
    const struct tl_stitches_report report = tl_stitches_sew(garment);
    if (report.sewn == 0)
        return;
    char *added = report.added > 0 ? tl_format("; %zu vertices were added, so that both sides of every seam "
                                               "have as many",
                                               report.added)
                                   : tl_copy_string("");
    tl_info("%s: its %zu stitches join %zu pairs of vertices%s", garment->model.name,
            garment->model.stitch_count, report.sewn, added);
    free(added);
}

/* The foot of the neck, as a share of the height: the head takes an eighth of it. */
#define SHOULDER 0.83f

/* Panels hang around the body that their maker had, which may have stood elsewhere. */
static void report_hanging(const tl_garment *garment, const tl_avatar *wearer)
{
    if (!wearer || garment->seam_count == 0)
        return;
    struct tl_box panels = tl_box_of(garment->model.mesh.positions, garment->model.mesh.vertex_count);
    struct tl_box body = tl_box_of(wearer->model.mesh.positions, wearer->model.mesh.vertex_count);
    vec3s middle = glms_vec3_lerp(panels.lower, panels.upper, 0.5f);
    float shoulder_m = body.lower.y + SHOULDER * (body.upper.y - body.lower.y);
    bool is_around = middle.x > body.lower.x && middle.x < body.upper.x && middle.z > body.lower.z &&
                     middle.z < body.upper.z;
    if (!is_around || panels.lower.y < body.lower.y || panels.lower.y > body.upper.y)
        tl_info(
            "%s: its panels hang from %.2f to %.2f m, and %s stands from %.2f to %.2f m: --move %.2f,%.2f,"
            "%.2f would hang their top at its shoulders",
            garment->model.name, (double)panels.lower.y, (double)panels.upper.y, wearer->model.name,
            (double)body.lower.y, (double)body.upper.y,
            (double)(0.5f * (body.lower.x + body.upper.x) - middle.x), (double)(shoulder_m - panels.upper.y),
            (double)(0.5f * (body.lower.z + body.upper.z) - middle.z));
}

static void report_size(char *line, struct tl_scene_standing *standing)
{
    standing->size = line;
    if (line)
        tl_info("%s", line);
}

/* Reads the garment from a file, places, lifts, sews and refines it. */
static bool read_garment(const struct tl_settings *settings, tl_model *loaded, const tl_avatar *wearer,
                         tl_garment *out, struct tl_scene_standing *standing, tl_error *error)
{
    const struct tl_scene_params *scene = &settings->scene;
    *out = (tl_garment){0};
    if (take_loaded(loaded, &out->model))
        tl_garment_take_pins(out);
    else if (!tl_garment_load_in(scene->garment, (enum tl_units)scene->units, out, error))
        return false;
    report_line(tl_units_describe(out->model.name, &out->model.units, "--units"));
    bool placed = place_garment(settings, wearer, out, error);
    if (placed)
        standing->lifted_m = lift_garment(settings, wearer, out);
    if (placed) {
        take_stitches(settings, out);
        report_hanging(out, wearer);
    }
    if (placed && wearer && out->seam_count == 0)
        report_size(
            tl_describe_size(out->model.name, &out->model.mesh, wearer->model.name, &wearer->model.mesh),
            standing);
    if (placed && refine_garment(settings, out, error) && take_rest(settings, out, error))
        return true;
    tl_garment_release(out);
    return false;
}

/* Edges of a pattern as a share of cloth.edge_m. Panels that are sewn from flat bend along lines that are
 * nobody's edges; triangles too large for that lock, and stiff cloth stands like card: the front hem of a
 * cotton shirt is 24, 21, 16, 14 and 14 cm before its middle with edges of 20, 16, 14, 12 and 10 mm, where
 * the body is at 13 cm. */
#define PATTERN_EDGE 0.7f

static double distance_to_body(const void *body, const double point[3])
{
    const double reach_m = 0.3; /* farther points are as far as that */
    struct tl_contact contact;
    return tl_collider_query(body, point, reach_m, &contact) ? contact.distance_m : reach_m;
}

static bool make_garment(const struct tl_settings *settings, tl_model *loaded, const tl_avatar *wearer,
                         tl_garment *out, struct tl_scene_standing *standing, tl_error *error)
{
    const char *name = settings->scene.garment, *wearer_name = tl_settings_avatar(&settings->scene);
    const float edge_m = settings->cloth.edge_m;
    const tl_mesh *mesh = wearer ? &wearer->model.mesh : NULL;
    if (tl_specimen_make(name, edge_m, out))
        return true;
    if (tl_pattern_is_file(name))
        return tl_pattern_worn(name, &(struct tl_pattern_wearer){wearer_name, mesh}, PATTERN_EDGE * edge_m,
                               out, error);
    if (!is_built_in_garment(name)) {
        if (settings->cut.ease_m != 0 || settings->cut.longer_m != 0 || settings->cut.sleeve_m != 0)
            tl_warn("%s: the table cut is for built-in garments: --scale alters the size of a file's", name);
        return read_garment(settings, loaded, wearer, out, standing, error);
    }
    if (!wearer || strcmp(wearer_name, "form") == 0)
        return tl_garment_cut_sized(name, edge_m, &settings->cut, NULL, out, error);
    tl_collider *body = tl_collider_create(mesh, false, error);
    const struct tl_wearer worn_by = {
        wearer->model.name, mesh, {distance_to_body, body}, settings->scene.refit};
    bool good = body && tl_garment_cut_sized(name, edge_m, &settings->cut, &worn_by, out, error);
    tl_collider_destroy(&body);
    if (good && !settings->scene.refit && !tl_garment_is_for_figure(name))
        report_size(tl_describe_waist(name, wearer->model.name, mesh), standing);
    return good;
}

bool tl_scene_load_garment(const struct tl_settings *settings, tl_model *loaded, const tl_avatar *wearer,
                           tl_garment **out, struct tl_scene_standing *standing, tl_error *error)
{
    tl_garment made;
    *out = NULL;
    *standing = (struct tl_scene_standing){0};
    if (strcmp(settings->scene.garment, "none") == 0)
        return true;
    if (!make_garment(settings, loaded, wearer, &made, standing, error))
        return false;
    if (!tl_sewn_pin(settings->cloth.pin_openings, &made, error)) {
        tl_garment_release(&made);
        return false;
    }
    *out = TL_NEW(tl_garment);
    **out = made;
    return true;
}
