#include "app/settings/settings.h"

#include "app/settings/layers.h"
#include "assets/base/units.h"
#include "assets/environment/studio.h"
#include "assets/model.h"
#include "assets/motion/motion_mesh.h"
#include "assets/motion/point_cache.h"
#include "assets/pattern/pattern.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "config/embedded.h"
#include "render/light/light.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Names that stand for built-in assets (assets/garment.h, assets/specimen/specimen.h, assets/avatar.h,
 * assets/environment/studio.h), and "none". */
static const char *const garment_names[] = {"dress", "skirt",  "layers", "trousers", "shirt", "sheet",
                                            "disc",  "sphere", "torus",  "plate",    "none",  NULL};
static const char *const avatar_names[] = {"auto", "form", "figure", "ball", "none", NULL};
static const char *const drape_names[] = {"auto", "authored", "settle", NULL};
static const char *const body_detail_names[] = {"auto", "full", NULL};
static const char *const environment_names[] = {"studio", "white", "none", NULL};
static const char *const motion_names[] = {"none", NULL};

#define OWN "own"
static const char *const colourways_names[] = {OWN, "dress", "skirt", "trousers", "shirt", "composed", NULL};

#define TL_SCENE_DEFAULTS                                                                                    \
    .garment = "dress", .avatar = "auto", .motion = "none", .environment = "studio", .environment_rate = -1, \
    .colourways = OWN, .preset = "review", .scale = 1, .smooth = true

static const struct tl_option scene_rows[] = {
    TL_OPTION_NAME_OR_PATH(struct tl_scene_params, garment,
                           TL_AFFECTS_SCENE | TL_AFFECTS_DRAPE | TL_AFFECTS_WORK, garment_names,
                           "garment: built in, or a glTF or OBJ file"),
    TL_OPTION_ENUM(struct tl_scene_params, units, TL_AFFECTS_SCENE | TL_AFFECTS_DRAPE | TL_AFFECTS_WORK,
                   tl_units_names,
                   "length unit of the garment's file and its motion; auto: metres for glTF, guessed from "
                   "the size for OBJ"),
    TL_OPTION_ENUM(
        struct tl_scene_params, up, TL_AFFECTS_SCENE | TL_AFFECTS_DRAPE | TL_AFFECTS_WORK, tl_up_names,
        "axis of the garment's file that points up; auto: y, or z for an OBJ file that stands along "
        "it"),
    TL_OPTION_FLOAT(struct tl_scene_params, turn_deg, TL_AFFECTS_SCENE | TL_AFFECTS_DRAPE, -3600, 3600,
                    "degrees", "turns the garment's file about the vertical, its front towards +X"),
    TL_OPTION_FLOAT(struct tl_scene_params, scale, TL_AFFECTS_SCENE | TL_AFFECTS_DRAPE | TL_AFFECTS_WORK,
                    0.001, 1000, "", "size of the garment's file, about its origin"),
    TL_OPTION_VECTOR(struct tl_scene_params, move_m, TL_AFFECTS_SCENE | TL_AFFECTS_DRAPE, -1000, 1000, "m",
                     "moves the garment's file, after turn_deg and scale"),
    TL_OPTION_NAME_OR_PATH(struct tl_scene_params, motion, TL_AFFECTS_SCENE | TL_AFFECTS_WORK, motion_names,
                           "recorded motion of the garment, in place of simulation: a .pc2 or .mdd point "
                           "cache, a sequence of OBJ files, frame.####.obj, or a glTF file whose clip moves "
                           "the same vertices"),
    TL_OPTION_FLOAT(struct tl_scene_params, motion_rate, TL_AFFECTS_SCENE, 0, 100000, "1/s",
                    "frames of the motion per second; 0: as its file states, or one per frame of the "
                    "animation; glTF files "
                    "state seconds"),
    TL_OPTION_NAME_OR_PATH(
        struct tl_scene_params, avatar, TL_AFFECTS_SCENE | TL_AFFECTS_DRAPE | TL_AFFECTS_WORK, avatar_names,
        "avatar that wears the garment: built in, or a glTF, OBJ, PLY, STL or OFF file; auto: form for "
        "built-in garments, none for garment files"),
    TL_OPTION_ENUM(struct tl_scene_params, avatar_units, TL_AFFECTS_SCENE | TL_AFFECTS_DRAPE, tl_units_names,
                   "length unit of the avatar's file, as units"),
    TL_OPTION_ENUM(struct tl_scene_params, avatar_up, TL_AFFECTS_SCENE | TL_AFFECTS_DRAPE, tl_up_names,
                   "axis of the avatar's file that points up, as up"),
    TL_OPTION_ENUM(struct tl_scene_params, body_detail, TL_AFFECTS_SCENE | TL_AFFECTS_DRAPE | TL_AFFECTS_WORK,
                   body_detail_names,
                   "triangles of an avatar that wears a garment: auto: above 100000 fewer, within 0.3 mm of "
                   "the file's; full: all"),
    TL_OPTION_BOOL(struct tl_scene_params, refit, TL_AFFECTS_SCENE | TL_AFFECTS_DRAPE | TL_AFFECTS_WORK,
                   "scales dress and skirt, which are cut for the form, to the avatar's waist; false: they "
                   "are worn in their own size, and a bad fit shows"),
    TL_OPTION_ENUM(struct tl_scene_params, drape, TL_AFFECTS_SCENE | TL_AFFECTS_DRAPE | TL_AFFECTS_WORK,
                   drape_names,
                   "how the garment starts: authored: as its file has it; settle: at rest on its avatar; "
                   "auto: files as authored, the rest settled, or only sewn when nobody wears it"),
    TL_OPTION_BOOL(struct tl_scene_params, pattern, TL_AFFECTS_MATERIALS,
                   "shows the garment's flat pieces beside it, where its pattern is known: views of strain "
                   "colour both"),
    TL_OPTION_BOOL(
        struct tl_scene_params, smooth, TL_AFFECTS_MATERIALS,
        "draws cloth of up to 40,000 triangles as a smooth surface, each triangle as four; creases stay at "
        "seams and hard edges; files, measures and contacts have the mesh itself"),
    TL_OPTION_NAME_OR_PATH(struct tl_scene_params, environment, TL_AFFECTS_ENVIRONMENT, environment_names,
                           "light: built in (white: radiance 1 from everywhere), an .exr or .hdr file, or a "
                           "sequence of files, sky.####.exr, where each # is a digit of the frame's number; "
                           "or a film, .mp4; or - for "
                           "a film on stdin, of which the newest frame is light"),
    TL_OPTION_NAME_OR_PATH(
        struct tl_scene_params, fabric, TL_AFFECTS_APPEARANCE, tl_embedded_fabrics_names,
        "fabric, which sets the tables fabric, weave and material: built in, a YAML file, a U3M file or "
        "archive, measurements (.json), or a folder or .zip of texture maps; empty: that of the garment's "
        "kind (cotton_plain for shirts and patterns, denim "
        "for trousers, else satin), none on garment files"),
    TL_OPTION_STRING(struct tl_scene_params, colourway,
                     TL_AFFECTS_MATERIALS | TL_AFFECTS_APPEARANCE | TL_AFFECTS_GARMENT,
                     "colourway by its name in the scene or among a glTF file's variants; empty: the "
                     "original fabrics and colours"),
    TL_OPTION_NAME_OR_PATH(struct tl_scene_params, colourways, TL_AFFECTS_APPEARANCE | TL_AFFECTS_GARMENT,
                           colourways_names,
                           "source of colourways: this scene or, if it has none, its built-in garment (own); "
                           "or another scene, built in or a YAML file"),
    TL_OPTION_NAME_OR_PATH(
        struct tl_scene_params, preset, TL_AFFECTS_APPEARANCE, tl_embedded_presets_names,
        "quality, which sets options of the tables cloth, light and image: built in, or a YAML file"),
    TL_OPTION_STRING(struct tl_scene_params, clip, TL_AFFECTS_SCENE | TL_AFFECTS_DRAPE | TL_AFFECTS_WORK,
                     "animation of the avatar; empty: the first one; none: the rest pose"),
    TL_OPTION_FLOAT(struct tl_scene_params, environment_yaw_deg, TL_AFFECTS_AT_ONCE, -3600, 3600, "degrees",
                    "rotation of the environment about the vertical, counter-clockwise seen from above; not "
                    "given: 0, but the studio's lights stand as the first view needs them"),
    TL_OPTION_FLOAT(
        struct tl_scene_params, environment_rate, TL_AFFECTS_NOTHING, -1, 1000, "1/s",
        "frames per second of a sequence of environments; 0: its first frame only; -1: a film's own, 30 "
        "of files"),
};
static const struct tl_option_table scene_table =
    TL_OPTION_TABLE("scene", "garment, avatar, light, fabric and quality", scene_rows, struct tl_scene_params,
                    TL_SCENE_DEFAULTS);

#define TL_CAMERA_DEFAULTS .yaw_deg = 25, .pitch_deg = 8, .distance_m = 0, .fov_deg = 30

static const struct tl_option camera_rows[] = {
    TL_OPTION_FLOAT(struct tl_camera_params, yaw_deg, TL_AFFECTS_AT_ONCE, -3600, 3600, "degrees",
                    "direction of the eye about the vertical: 0 is +Z, positive turns towards +X"),
    TL_OPTION_FLOAT(struct tl_camera_params, pitch_deg, TL_AFFECTS_AT_ONCE, -90, 90, "degrees",
                    "elevation of the eye; positive looks down"),
    TL_OPTION_FLOAT(struct tl_camera_params, distance_m, TL_AFFECTS_AT_ONCE, 0, 10000, "m",
                    "distance to the target; 0: the avatar and the garment fill the image"),
    TL_OPTION_VECTOR(
        struct tl_camera_params, target, TL_AFFECTS_AT_ONCE, -10000, 10000, "m",
        "centre of the view and of the orbit, if distance_m is not 0; 0 0 0: the centre of the scene"),
    TL_OPTION_FLOAT(struct tl_camera_params, fov_deg, TL_AFFECTS_AT_ONCE, 1, 150, "degrees",
                    "vertical field of view; larger: wider"),
};
const struct tl_option_table tl_camera_options = TL_OPTION_TABLE(
    "camera", "an orbit about a target", camera_rows, struct tl_camera_params, TL_CAMERA_DEFAULTS);

/* The reference page's order. A preset sets CLOTH, LIGHT and IMAGE; a fabric FABRIC to
 * CONSTRUCTION. */
enum {
    SCENE,
    CAMERA,
    CUT,
    CLOTH,
    FABRIC,
    WEAVE,
    MATERIAL,
    CONSTRUCTION,
    LIGHT,
    MAPS,
    LAMP,
    FILL,
    SHADING,
    DETAIL,
    IMAGE,
    REFERENCE
};

void tl_settings_bind(struct tl_settings *settings, struct tl_binding bindings[TL_SETTINGS_TABLES])
{
    bindings[SCENE] = (struct tl_binding){&scene_table, &settings->scene};
    bindings[CAMERA] = (struct tl_binding){&tl_camera_options, &settings->camera};
    bindings[CUT] = (struct tl_binding){&tl_cut_options, &settings->cut};
    bindings[CLOTH] = (struct tl_binding){&tl_cloth_options, &settings->cloth};
    bindings[FABRIC] = (struct tl_binding){&tl_cloth_fabric_options, &settings->fabric};
    bindings[WEAVE] = (struct tl_binding){&tl_weave_options, &settings->weave};
    bindings[MATERIAL] = (struct tl_binding){&tl_material_options, &settings->material};
    bindings[CONSTRUCTION] = (struct tl_binding){&tl_construction_options, &settings->construction};
    bindings[LIGHT] = (struct tl_binding){&tl_light_options, &settings->light};
    bindings[DETAIL] = (struct tl_binding){&tl_detail_options, &settings->detail};
    bindings[MAPS] = (struct tl_binding){&tl_maps_options, &settings->maps};
    bindings[LAMP] = (struct tl_binding){&tl_lamp_options, &settings->lamp};
    bindings[FILL] = (struct tl_binding){&tl_fill_options, &settings->fill};
    bindings[SHADING] = (struct tl_binding){&tl_shading_options, &settings->shading};
    bindings[IMAGE] = (struct tl_binding){&tl_image_options, &settings->image};
    bindings[REFERENCE] = (struct tl_binding){&tl_reference_options, &settings->reference};
}

void tl_settings_reset(struct tl_settings *settings)
{
    struct tl_binding all[TL_SETTINGS_TABLES];
    *settings = (struct tl_settings){.colourways = &tl_colourways_none};
    tl_settings_bind(settings, all);
    tl_options_reset(all, TL_SETTINGS_TABLES);
}

struct tl_render_settings tl_settings_render(const struct tl_settings *settings)
{
    struct tl_render_settings drawn = {.light = settings->light,
                                       .detail = settings->detail,
                                       .maps = settings->maps,
                                       .shading = settings->shading,
                                       .image = settings->image,
                                       .reference = settings->reference};
    if (drawn.light.visibility == TL_VISIBILITY_AUTO)
        drawn.light.visibility = TL_VISIBILITY_RAYS;
    return drawn;
}

static bool apply_preset(const struct tl_binding *all, const char *name, tl_error *error)
{
    const struct tl_binding bindings[] = {all[CLOTH], all[LIGHT], all[IMAGE]};
    return tl_option_layer_apply(&tl_option_layer_preset, name, bindings, TL_COUNT(bindings), NULL, error);
}

static bool apply_fabric(const struct tl_binding *all, const char *name, tl_error *error)
{
    const struct tl_binding bindings[] = {all[FABRIC], all[WEAVE], all[MATERIAL], all[CONSTRUCTION]};
    return tl_option_layer_apply(&tl_option_layer_fabric, name, bindings, TL_COUNT(bindings), NULL, error);
}

bool tl_settings_assign(struct tl_settings *settings, const char *const *assignments, size_t maximum,
                        tl_error *error)
{
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    tl_settings_bind(settings, bindings);
    for (size_t i = 0; i < maximum && assignments[i]; i++)
        if (!tl_options_set_assignment(bindings, TL_SETTINGS_TABLES, assignments[i], error))
            return false;
    return true;
}

/* A model in place of a scene is shown as it is: no garment to drape, its own materials. */
static bool apply_model(const struct tl_binding *all, const char *path, tl_error *error)
{
    return tl_options_set(all, TL_SETTINGS_TABLES, "scene.avatar", path, "SCENE", NULL, error) &&
           tl_options_set(all, TL_SETTINGS_TABLES, "scene.garment", "none", "SCENE", NULL, error) &&
           tl_options_set(all, TL_SETTINGS_TABLES, "scene.fabric", "none", "SCENE", NULL, error);
}

/* The model is a garment where the options state who wears it, or none. A fabric that they name stays. */
static bool wear_model(const struct tl_binding *all, const char *path, tl_error *error)
{
    const struct tl_scene_params *scene = all[SCENE].params;
    bool is_worn = strcmp(scene->garment, "none") == 0 && strcmp(scene->avatar, path) != 0;
    return !is_worn || tl_options_set(all, TL_SETTINGS_TABLES, "scene.garment", path, "SCENE", NULL, error);
}

/* A pattern or a garment in place of a scene is worn by the body that the options name. */
static bool apply_garment(const struct tl_binding *all, const char *path, tl_error *error)
{
    return tl_options_set(all, TL_SETTINGS_TABLES, "scene.garment", path, "SCENE", NULL, error);
}

/* A point cache in place of a scene moves the mesh beside it. */
static bool apply_motion(const struct tl_binding *all, const char *path, tl_error *error)
{
    char *mesh = tl_motion_find_mesh(path, error);
    bool applied = mesh &&
                   tl_options_set(all, TL_SETTINGS_TABLES, "scene.garment", mesh, "SCENE", NULL, error) &&
                   tl_options_set(all, TL_SETTINGS_TABLES, "scene.motion", path, "SCENE", NULL, error);
    free(mesh);
    return applied;
}

static bool has_own_colourways(const struct tl_scene_params *scene)
{
    return strcmp(scene->colourways, OWN) == 0;
}

/* A scene's tables. A file's own colourways are meant unless it names others; those of a built-in scene
 * belong to its garment. */
static bool apply_scene(const struct tl_binding *all, const char *name, tl_error *error)
{
    struct tl_colourways found;
    struct tl_colourways_reader reader;
    tl_colourways_begin(&reader, "", &found);
    const struct tl_record_section section = tl_colourways_section(&reader);
    if (!tl_option_layer_apply(&tl_option_layer_scene, name, all, TL_SETTINGS_TABLES, &section, error))
        return false;
    bool brings = found.name_count > 0 && tl_option_is_file_name(name);
    return !brings || !has_own_colourways(all[SCENE].params) ||
           tl_options_set(all, TL_SETTINGS_TABLES, "scene.colourways", name, "SCENE", NULL, error);
}

bool tl_settings_is_scene(const char *name)
{
    return !tl_model_is_file(name) && !tl_pattern_is_file(name) && !tl_point_cache_is_file(name);
}

/* The two topmost layers. */
/* A second fabric had options of its own up to 0.1.0. */
static void refer_to_colourways(tl_error *error)
{
    static const char *const names[] = {"scene.overlay_fabric: ", " overlay: "};
    for (size_t i = 0; i < TL_COUNT(names); i++) {
        char *name = strstr(error->message, names[i]), *rest = name ? name + strlen(names[i]) : NULL;
        if (rest && strncmp(rest, "no such", strlen("no such")) == 0)
            snprintf(rest, sizeof error->message - (size_t)(rest - error->message),
                     "a second fabric is part of a colourway: write `colourways: {NAME: {overlay: {fabric: "
                     "voile}}}` and `scene: {colourway: NAME}`");
    }
}

static bool apply_source(const struct tl_binding *all, const struct tl_settings_source *source,
                         tl_error *error)
{
    const char *scene = source->scene_file ? source->scene_file : "dress";
    bool is_garment = tl_pattern_is_file(scene);
    bool is_model = tl_model_is_file(scene);
    bool applied = tl_point_cache_is_file(scene) ? apply_motion(all, scene, error)
                   : is_garment                  ? apply_garment(all, scene, error)
                   : is_model                    ? apply_model(all, scene, error)
                                                 : apply_scene(all, scene, error);
    for (size_t i = 0; applied && i < source->assignment_count; i++)
        applied = tl_options_set_assignment(all, TL_SETTINGS_TABLES, source->assignments[i], error);
    if (applied && is_model)
        applied = wear_model(all, scene, error);
    if (!applied)
        refer_to_colourways(error);
    return applied;
}

/* A file that holds a garment's shape, not its pattern. */
static bool is_garment_file(const char *garment)
{
    return tl_option_is_file_name(garment) && !tl_pattern_is_file(garment);
}

struct tl_cloth_fabric tl_settings_fabric(const struct tl_settings *settings)
{
    struct tl_cloth_fabric fabric = settings->fabric;
    fabric.ply_m = 1e-3 * (double)settings->construction.thickness_mm;
    return fabric;
}

const char *tl_settings_own_fabric(const char *garment)
{
    static const char *const own[][2] = {{"shirt", "cotton_plain"}, {"trousers", "denim"}};
    for (size_t i = 0; i < TL_COUNT(own); i++)
        if (strcmp(garment, own[i][0]) == 0)
            return own[i][1];
    return is_garment_file(garment) ? "none" : tl_pattern_is_file(garment) ? "cotton_plain" : "satin";
}

static void choose_fabric(struct tl_scene_params *scene)
{
    if (scene->fabric[0] == '\0')
        scene->fabric = tl_settings_own_fabric(scene->garment);
}

const char *tl_settings_avatar(const struct tl_scene_params *scene)
{
    if (strcmp(scene->avatar, "auto") != 0)
        return scene->avatar;
    return is_garment_file(scene->garment) ? "none" : "form";
}

/* The built-in scene that shows a built-in garment has its colourways too. */
const char *tl_settings_colourways_source(const struct tl_settings *settings)
{
    static const char *const sources[][2] = {{"dress", "dress"},
                                             {"skirt", "skirt"},
                                             {"trousers", "trousers"},
                                             {"shirt", "shirt"},
                                             {"layers", "composed"}};
    const struct tl_scene_params *scene = &settings->scene;
    if (!has_own_colourways(scene))
        return scene->colourways;
    for (size_t i = 0; i < TL_COUNT(sources); i++)
        if (strcmp(scene->garment, sources[i][0]) == 0)
            return sources[i][1];
    return "";
}

/* Reads the section of colourways of the source and ignores its other sections. */
static bool read_colourways(struct tl_settings *settings, tl_error *error)
{
    const char *source = tl_settings_colourways_source(settings);
    struct tl_colourways found;
    struct tl_colourways_reader reader;
    tl_colourways_begin(&reader, settings->scene.colourway, &found);
    const struct tl_record_section section = tl_colourways_section(&reader);
    struct tl_settings unused;
    struct tl_binding all[TL_SETTINGS_TABLES];
    tl_settings_bind(&unused, all);
    if (source[0] &&
        !tl_option_layer_apply(&tl_option_layer_scene, source, all, TL_SETTINGS_TABLES, &section, error))
        return false;
    settings->colourways = tl_colourways_keep(&found);
    return true;
}

void tl_settings_wear(struct tl_scene_params *scene)
{
    scene->garment = scene->avatar;
    scene->avatar = "auto";
    scene->is_undecided = false;
}

/* A model alone is what a motion moves; else its shape decides. */
static void choose_role(struct tl_scene_params *scene)
{
    bool is_alone = strcmp(scene->garment, "none") == 0 && tl_option_is_file_name(scene->avatar);
    bool moves = strcmp(scene->motion, "none") != 0;
    scene->is_undecided = is_alone && !moves;
    if (is_alone && moves) {
        scene->garment = scene->avatar;
        scene->avatar = "none";
    } else if (strcmp(scene->garment, scene->avatar) == 0) {
        scene->avatar = "auto";
    }
}

/* Parts of a material that no pass over shadow maps shows ... */
static bool is_more_than_chains_show(const struct tl_material_params *material)
{
    return material->openness > 0 || material->fuzz > 0 || material->diffuse_roughness > 0 ||
           material->model == TL_REFLECT_BANKS;
}

/* ... and those beyond two lobes: environment maps do not show them; what reads nothing but filter chains
 * draws any gloss. */
static bool is_more_than_maps_show(const struct tl_material_params *material)
{
    return material->model != TL_REFLECT_PHONG || is_more_than_chains_show(material);
}

static bool is_layered(const struct tl_material_params *material)
{
    return material->coat > 0 || material->transmission[0] > 0 || material->transmission[1] > 0 ||
           material->transmission[2] > 0;
}

/* Whether a material of the scene is such; a swatch's options that are not given are zero. */
static bool has(const struct tl_settings *settings, bool (*is_such)(const struct tl_material_params *))
{
    const struct tl_colourways *colourways = settings->colourways;
    bool found = is_such(&settings->material);
    for (size_t i = 0; !found && i < colourways->swatch_count; i++)
        found = is_such(&colourways->swatches[i].params);
    return found;
}

bool tl_settings_need_rays(const struct tl_settings *settings)
{
    return has(settings, is_more_than_maps_show) || has(settings, is_layered);
}

/* Warns of options that the chosen method does not use. */
static void warn_of_unused_options(const struct tl_settings *settings)
{
    const struct tl_render_settings drawn = tl_settings_render(settings);
    const struct tl_light_params *light = &drawn.light;
    bool by_maps = light->method == TL_METHOD_MAPS;
    bool layers = has(settings, is_layered);
    bool others =
        has(settings, tl_light_sums_lobes(light) ? is_more_than_chains_show : is_more_than_maps_show);
    bool shows_all =
        light->method == TL_METHOD_REFERENCE || (!by_maps && light->visibility == TL_VISIBILITY_RAYS);
    if (by_maps && others)
        tl_warn("material: model, openness and fuzz are shown by light.visibility rays and by light.method "
                "reference only: environment maps show two lobes, a coat and light that comes through");
    else if (!by_maps && !shows_all && (layers || others))
        tl_warn(
            "material: model, coat, fuzz, transmission and openness are shown by light.visibility rays and "
            "by light.method reference only: shadow maps know two plain lobes, and the gloss of model where "
            "light comes from filter chains alone, as in preset paper; light.method maps shows coat and "
            "transmission, without shadows");
    if (light->method == TL_METHOD_PEM && light->visibility == TL_VISIBILITY_RAYS &&
        light->composition != TL_COMPOSE_RATIO)
        tl_warn("light.composition: rays always compose by ratio; this option is for light.visibility vsm "
                "and depth");
}

/* The material's options that hold for a file's own materials too. */
static bool is_of_file_too(const char *assignment)
{
    static const char *const keys[] = {"material.use_file=", "material.back=", "material.samples="};
    for (size_t i = 0; i < TL_COUNT(keys); i++)
        if (strncmp(assignment, keys[i], strlen(keys[i])) == 0)
            return true;
    return false;
}

/* Warns of the first assignment to a material that the garment's own take the place of. */
static void warn_of_hidden_material(const struct tl_settings *settings,
                                    const struct tl_settings_source *source)
{
    for (size_t i = 0; settings->material.use_file && i < source->assignment_count; i++) {
        const char *assignment = source->assignments[i];
        if (strncmp(assignment, "material.", strlen("material.")) != 0 || is_of_file_too(assignment))
            continue;
        tl_warn("%.*s: has no effect on materials that the garment comes with: name a fabric (--fabric "
                "cotton_plain), or add --set material.use_file=false",
                (int)strcspn(assignment, "="), assignment);
        return;
    }
}

/* Logs the width that is assumed of pictures whose file states none. */
static void log_assumed_width(const struct tl_weave_params *weave)
{
    if (tl_text_is_given(weave->pictures) && !(weave->picture_mm > 0))
        tl_info("%s: states no width: %d mm are assumed for a repeat; set weave.picture_mm", weave->pictures,
                TL_PICTURE_ASSUMED_MM);
}

/* A photographer places the lights for the view. They stay as the camera turns from there. */
static void turn_studio(struct tl_settings *settings)
{
    struct tl_scene_params *scene = &settings->scene;
    if (!isnan(scene->environment_yaw_deg))
        return;
    scene->environment_yaw_deg = 0;
    tl_settings_turn_studio(settings, TL_STUDIO_VIEW_DEG);
}

void tl_settings_turn_studio(struct tl_settings *settings, float from_deg)
{
    if (strcmp(settings->scene.environment, "studio") == 0)
        settings->scene.environment_yaw_deg += settings->camera.yaw_deg - from_deg;
}

/* The topmost layers name the preset and the fabric that lie below them, so they are read twice: once to
 * learn these names, and once more in their place. */
bool tl_settings_load(struct tl_settings *out, const struct tl_settings_source *source, tl_error *error)
{
    struct tl_settings settings;
    struct tl_binding all[TL_SETTINGS_TABLES];
    tl_settings_reset(&settings);
    tl_settings_bind(&settings, all);
    settings.scene.environment_yaw_deg = NAN; /* not given */
    if (!apply_source(all, source, error))
        return false;
    struct tl_scene_params named = settings.scene;
    choose_fabric(&named);
    tl_options_reset(all, TL_SETTINGS_TABLES);
    if (!apply_preset(all, named.preset, error) || !apply_fabric(all, named.fabric, error) ||
        !apply_source(all, source, error))
        return false;
    if (source->scene_file && tl_model_is_file(source->scene_file))
        choose_role(&named);
    settings.scene = named;
    turn_studio(&settings);
    if (!read_colourways(&settings, error))
        return false;
    warn_of_unused_options(&settings);
    warn_of_hidden_material(&settings, source);
    log_assumed_width(&settings.weave);
    *out = settings;
    return true;
}

/* Resets the fabric's tables first, so that no value of the last fabric remains. */
bool tl_settings_apply_fabric(struct tl_settings *settings, const char *name, tl_error *error)
{
    struct tl_settings changed = *settings;
    struct tl_binding all[TL_SETTINGS_TABLES];
    tl_settings_bind(&changed, all);
    tl_options_reset(&all[FABRIC], 1);
    tl_options_reset(&all[WEAVE], 1);
    tl_options_reset(&all[MATERIAL], 1);
    tl_options_reset(&all[CONSTRUCTION], 1);
    if (!tl_options_set(all, TL_SETTINGS_TABLES, "scene.fabric", name, "fabric", NULL, error) ||
        !apply_fabric(all, name, error))
        return false;
    log_assumed_width(&changed.weave);
    *settings = changed;
    return true;
}

bool tl_settings_apply_colourway(struct tl_settings *settings, const char *name, tl_error *error)
{
    struct tl_settings changed = *settings;
    struct tl_binding all[TL_SETTINGS_TABLES];
    tl_settings_bind(&changed, all);
    if (!tl_options_set(all, TL_SETTINGS_TABLES, "scene.colourway", name, "colourway", NULL, error) ||
        !read_colourways(&changed, error))
        return false;
    *settings = changed;
    return true;
}

/* Resets the table light only: cloth and image hold more than quality (the picture's size, for instance). */
bool tl_settings_apply_preset(struct tl_settings *settings, const char *name, tl_error *error)
{
    struct tl_settings changed = *settings;
    struct tl_binding all[TL_SETTINGS_TABLES];
    tl_settings_bind(&changed, all);
    tl_options_reset(&all[LIGHT], 1);
    if (!tl_options_set(all, TL_SETTINGS_TABLES, "scene.preset", name, "preset", NULL, error) ||
        !apply_preset(all, name, error))
        return false;
    *settings = changed;
    return true;
}
