/* toile info: prints what a file holds and how it is read, or what is built in. */
#include "app/audit/audit_json.h"
#include "app/batch/commands.h"
#include "app/batch/info/info_garment.h"
#include "app/cli/json.h"
#include "app/settings/settings.h"
#include "assets/environment/environment.h"
#include "assets/model.h"
#include "assets/motion/point_cache.h"
#include "assets/pattern/pattern_place.h"
#include "assets/specimen/specimen.h"
#include "assets/topology/simplify.h"
#include "cloth/cloth.h"
#include "cloth/mesh/topology.h"
#include "config/base/file.h"
#include "config/base/memory.h"
#include "render/gpu/gpu.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Both outputs are printed from one JSON object: --json prints it as it is, else each member becomes a line.
 */
static void print_value(const cJSON *value, int indent)
{
    const cJSON *child;
    if (cJSON_IsString(value))
        printf("%s\n", value->valuestring);
    else if (cJSON_IsBool(value))
        printf("%s\n", cJSON_IsTrue(value) ? "yes" : "no");
    else if (cJSON_IsNumber(value))
        printf("%.7g\n", value->valuedouble);
    else if (!value->child)
        printf("none\n");
    else {
        printf("\n");
        cJSON_ArrayForEach(child, value)
        {
            printf("%*s", indent + 2, "");
            if (child->string)
                printf("%-*s ", 20 - indent, child->string);
            print_value(child, indent + 2);
        }
    }
}

/* audit NULL: what was described is no file. */
static void print_object(cJSON *object, const tl_audit *audit, bool json)
{
    if (json) {
        if (audit)
            tl_audit_add_json(audit, object);
        tl_json_print(object);
        return;
    }
    const cJSON *child;
    cJSON_ArrayForEach(child, object)
    {
        printf("%-20s ", child->string);
        print_value(child, 0);
    }
    cJSON_Delete(object);
    if (audit)
        tl_audit_print(audit, stdout);
}

static cJSON *describe_vector(vec3s vector)
{
    return cJSON_CreateFloatArray(vector.raw, 3);
}

/* Describes the features that few materials have. */
static void describe_layers(cJSON *object, const tl_material *material)
{
    const struct tl_gloss *gloss = &material->gloss;
    if (gloss->model == TL_REFLECT_WARD) {
        cJSON_AddStringToObject(object, "model", "ward");
        cJSON_AddNumberToObject(object, "width_weft", (double)gloss->width_weft);
        cJSON_AddNumberToObject(object, "width_warp", (double)gloss->width_warp);
        cJSON_AddNumberToObject(object, "rotation_deg", (double)gloss->rotation * 180 / M_PI);
    }
    if (material->coat > 0) {
        cJSON_AddNumberToObject(object, "coat", (double)material->coat);
        cJSON_AddNumberToObject(object, "coat_glossiness", (double)material->coat_glossiness);
    }
    if (material->transmission.x + material->transmission.y + material->transmission.z > 0)
        cJSON_AddItemToObject(object, "transmission", describe_vector(material->transmission));
    if (tl_material_emits(material))
        cJSON_AddItemToObject(object, "emission", describe_vector(material->emission));
    if (material->openness > 0)
        cJSON_AddNumberToObject(object, "openness", (double)material->openness);
}

static cJSON *describe_material(const tl_model *model, size_t index)
{
    const tl_material *material = &model->materials[index];
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "name", material->name);
    cJSON_AddNumberToObject(object, "glossiness", (double)material->glossiness);
    describe_layers(object, material);
    cJSON_AddBoolToObject(object, "double_sided", material->double_sided);
    cJSON_AddNumberToObject(object, "alpha_cutoff", (double)material->alpha_cutoff);
    const struct {
        const char *name;
        const tl_image *image;
    } maps[] = {
        {"diffuse_map", material->diffuse_map.image},   {"normal_map", material->normal_map.image},
        {"gloss_map", material->gloss_map.image},       {"specular_map", material->specular_map.image},
        {"emission_map", material->emission_map.image}, {"occlusion_map", material->occlusion_map.image}};
    for (size_t i = 0; i < sizeof maps / sizeof maps[0]; i++) {
        if (!maps[i].image)
            continue;
        char size[32];
        snprintf(size, sizeof size, "%d x %d", maps[i].image->width, maps[i].image->height);
        cJSON_AddStringToObject(object, maps[i].name, size);
    }
    for (size_t i = 0; i < model->extension_count; i++)
        if (model->extensions[i].material == index)
            cJSON_AddStringToObject(object, model->extensions[i].name, model->extensions[i].shown);
    return object;
}

static void describe_units(cJSON *object, const tl_model *model)
{
    cJSON_AddStringToObject(object, "units", tl_units_names[model->units.units]);
    char *lines[] = {tl_units_describe(model->name, &model->units, "--units"),
                     tl_units_describe_up(model->name, &model->units, "--up")};
    const char *const keys[] = {"units_note", "up_note"};
    for (size_t i = 0; i < TL_COUNT(lines); i++) {
        if (lines[i])
            cJSON_AddStringToObject(object, keys[i], lines[i]);
        free(lines[i]);
    }
}

static void describe_notes(cJSON *object, const char *key, char *const *notes, size_t count)
{
    cJSON *array = cJSON_AddArrayToObject(object, key);
    for (size_t i = 0; i < count; i++)
        cJSON_AddItemToArray(array, cJSON_CreateString(notes[i]));
}

static bool varies(const tl_model *model, size_t part)
{
    for (size_t i = 0; i < model->variant_count; i++)
        if (model->variants[i].materials[part] != model->mesh.parts[part].material)
            return true;
    return false;
}

/* Describes the file's colourways: the materials of those parts that differ between colourways. */
static void describe_variants(cJSON *object, const tl_model *model)
{
    cJSON *variants = cJSON_AddObjectToObject(object, "colourways");
    for (size_t i = 0; i < model->variant_count; i++) {
        const struct tl_variant *variant = &model->variants[i];
        cJSON *names = cJSON_AddArrayToObject(variants, variant->name);
        for (size_t p = 0; p < model->mesh.part_count; p++)
            if (varies(model, p))
                cJSON_AddItemToArray(names, cJSON_CreateString(model->materials[variant->materials[p]].name));
    }
}

/* Counts the vertices that the file pins, and those that cloth.pin_colour would pin by their colour. */
static void describe_pins(cJSON *object, const tl_model *model)
{
    size_t pinned = 0, painted[3] = {0};
    for (size_t i = 0; i < model->mesh.vertex_count; i++) {
        pinned += model->pins && model->pins[i] > 0.5f;
        for (int channel = 0; model->colours && channel < 3; channel++)
            painted[channel] += tl_model_is_painted(model, i, channel);
    }
    cJSON_AddNumberToObject(object, "pins", (double)pinned);
    if (!model->colours)
        return;
    cJSON *colours = cJSON_AddObjectToObject(object, "painted_vertices");
    for (int channel = 0; channel < 3; channel++)
        cJSON_AddNumberToObject(colours, tl_pin_colour_names[TL_PIN_RED + channel], (double)painted[channel]);
}

/* Describes a heavy model as an avatar; simplifies it. Panels that were sewn are no body. */
static void describe_simplified(cJSON *object, tl_model *model)
{
    if (model->mesh.index_count / 3 <= TL_SIMPLIFY_ABOVE || model->stitch_count > 0)
        return;
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, model->mesh.vertex_count);
    tl_weld_positions(model->mesh.positions, model->mesh.vertex_count, weld);
    const struct tl_simplified simplified = tl_simplify_model(model, weld);
    char *line = tl_simplified_describe(model->name, &simplified);
    cJSON_AddStringToObject(object, "as_avatar", line ? line : "cannot be simplified: drawn as it is");
    free(line);
    free(weld);
}

static cJSON *describe_model(tl_model *model, tl_audit *audit)
{
    cJSON *object = cJSON_CreateObject();
    struct tl_box box = tl_box_of(model->mesh.positions, model->mesh.vertex_count);
    cJSON_AddStringToObject(object, "kind", "model");
    cJSON_AddStringToObject(object, "name", model->name);
    cJSON_AddNumberToObject(object, "vertices", (double)model->mesh.vertex_count);
    cJSON_AddNumberToObject(object, "triangles", (double)model->mesh.index_count / 3);
    cJSON_AddNumberToObject(object, "points", (double)tl_model_point_count(model));
    cJSON_AddNumberToObject(object, "parts", (double)model->mesh.part_count);
    describe_pins(object, model);
    describe_units(object, model);
    cJSON_AddItemToObject(object, "lower_m", describe_vector(box.lower));
    cJSON_AddItemToObject(object, "upper_m", describe_vector(box.upper));
    tl_info_describe_garment(object, model, audit);
    cJSON *materials = cJSON_AddArrayToObject(object, "materials");
    for (size_t i = 0; i < model->material_count; i++)
        cJSON_AddItemToArray(materials, describe_material(model, i));
    describe_variants(object, model);
    cJSON *clips = cJSON_AddArrayToObject(object, "clips");
    for (size_t i = 0; i < model->clip_count; i++) {
        cJSON *clip = cJSON_CreateObject();
        cJSON_AddStringToObject(clip, "name", model->clips[i].name);
        cJSON_AddNumberToObject(clip, "duration_s", model->clips[i].duration_s);
        cJSON_AddItemToArray(clips, clip);
    }
    describe_notes(object, "defects", model->defects, model->defect_count);
    describe_notes(object, "approximated", model->approximated, model->approximated_count);
    describe_notes(object, "ignored", model->ignored, model->ignored_count);
    describe_simplified(object, model);
    return object;
}

/* Describes a recorded motion in the file's own units, which depend on the garment that it moves. */
static cJSON *describe_motion(const char *path, const struct tl_point_cache_facts *facts)
{
    cJSON *object = cJSON_CreateObject();
    const char *slash = strrchr(path, '/');
    cJSON_AddStringToObject(object, "kind", "motion");
    cJSON_AddStringToObject(object, "name", slash ? slash + 1 : path);
    cJSON_AddStringToObject(object, "format", facts->format);
    cJSON_AddNumberToObject(object, "points", (double)facts->point_count);
    cJSON_AddNumberToObject(object, "samples", (double)facts->sample_count);
    cJSON_AddNumberToObject(object, facts->in_seconds ? "first_s" : "first_frame", facts->first);
    cJSON_AddNumberToObject(object, facts->in_seconds ? "last_s" : "last_frame", facts->last);
    const char *per = facts->in_seconds ? "second" : "frame";
    bool even = facts->step > 0 || facts->sample_count == 1;
    cJSON_AddNumberToObject(object, "rate", facts->step > 0 ? 1 / facts->step : 0);
    cJSON_AddStringToObject(object, "rate_per", even ? per : "samples are not evenly spaced");
    cJSON_AddItemToObject(object, "lower", describe_vector(facts->box.lower));
    cJSON_AddItemToObject(object, "upper", describe_vector(facts->box.upper));
    return object;
}

static cJSON *describe_environment(const tl_environment *environment)
{
    static const char *const layouts[] = {"lat-long", "cube", "sphere", "paraboloid", "octahedral"};
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "kind", "environment");
    cJSON_AddStringToObject(object, "name", environment->name);
    cJSON_AddStringToObject(object, "layout", layouts[environment->layout]);
    cJSON_AddNumberToObject(object, "width", environment->image.width);
    cJSON_AddNumberToObject(object, "height", environment->image.height);
    cJSON_AddNumberToObject(object, "peak", (double)environment->peak);
    cJSON_AddNumberToObject(object, "negative_cleaned", (double)environment->negative_count);
    cJSON_AddNumberToObject(object, "nan_cleaned", (double)environment->nan_count);
    cJSON_AddNumberToObject(object, "inf_cleaned", (double)environment->inf_count);
    return object;
}

static void add_colourways(cJSON *object, const char *key, const struct tl_settings *settings)
{
    cJSON *names = cJSON_AddArrayToObject(object, key);
    for (size_t i = 0; i < settings->colourways->name_count; i++)
        cJSON_AddItemToArray(names, cJSON_CreateString(settings->colourways->names[i]));
}

/* Fabrics and presets were read already: a scene without them is refused. */
static void audit_scene(const struct tl_scene_params *scene, tl_audit *audit)
{
    const char *const files[][2] = {{"scene.garment", scene->garment},
                                    {"scene.avatar", scene->avatar},
                                    {"scene.environment", scene->environment},
                                    {"scene.motion", scene->motion}};
    for (size_t i = 0; i < TL_COUNT(files); i++) {
        const char *file = files[i][1];
        bool is_file = tl_option_is_file_name(file) && !strchr(file, '#'); /* else a name, or a sequence */
        if (is_file && !tl_file_exists(file))
            tl_audit_add_file(audit, TL_AUDIT_FILE_MISSING, file, files[i][0]);
    }
}

/* Describes a scene file by the names in it, with its colourways. */
static cJSON *describe_scene(const char *path, tl_audit *audit, tl_error *error)
{
    struct tl_settings settings;
    if (!tl_settings_load(&settings, &(struct tl_settings_source){.scene_file = path}, error))
        return NULL;
    const struct tl_scene_params *scene = &settings.scene;
    const char *const rows[][2] = {{"kind", "scene"},
                                   {"name", path},
                                   {"garment", scene->garment},
                                   {"avatar", scene->avatar},
                                   {"environment", scene->environment},
                                   {"fabric", scene->fabric},
                                   {"preset", scene->preset}};
    cJSON *object = cJSON_CreateObject();
    for (size_t i = 0; i < TL_COUNT(rows); i++)
        cJSON_AddStringToObject(object, rows[i][0], rows[i][1]);
    audit_scene(scene, audit);
    add_colourways(object, "colourways", &settings);
    return object;
}

static void list_embedded(cJSON *object, const char *key, const struct tl_embedded *list)
{
    cJSON *names = cJSON_AddArrayToObject(object, key);
    for (const struct tl_embedded *entry = list; entry->name; entry++) {
        char name[64];
        snprintf(name, sizeof name, "%.*s", (int)strcspn(entry->name, "."), entry->name);
        cJSON_AddItemToArray(names, cJSON_CreateString(name));
    }
}

/* Lists devices by the numbers that --device takes. */
static bool list_devices(cJSON *object, const char *key, tl_error *error)
{
    struct tl_gpu_device devices[TL_GPU_DEVICES_MAX];
    cJSON *list = cJSON_AddObjectToObject(object, key);
    const int count = tl_gpu_devices(devices, error);
    for (int i = 0; i < count; i++) {
        char number[16];
        snprintf(number, sizeof number, "%d", i + 1);
        cJSON_AddStringToObject(list, number, devices[i].name);
    }
    return count >= 0;
}

static cJSON *describe_built_in(const char *what, tl_error *error)
{
    bool listed = true;
    cJSON *object = cJSON_CreateObject();
    if (strcmp(what, "fabrics") == 0)
        list_embedded(object, what, tl_embedded_fabrics);
    else if (strcmp(what, "presets") == 0)
        list_embedded(object, what, tl_embedded_presets);
    else if (strcmp(what, "devices") == 0)
        listed = list_devices(object, what, error);
    else if (strcmp(what, "findings") == 0)
        cJSON_AddItemToObject(object, what, tl_audit_codes_json());
    else {
        cJSON *names = cJSON_AddArrayToObject(object, what);
        for (const char *const *name = tl_garment_names; *name; name++)
            cJSON_AddItemToArray(names, cJSON_CreateString(*name));
        for (const char *const *name = tl_specimen_names; *name; name++)
            cJSON_AddItemToArray(names, cJSON_CreateString(*name));
    }
    if (!listed) {
        cJSON_Delete(object);
        return NULL;
    }
    return object;
}

static cJSON *describe_fabric(const tl_fabric_file *fabric)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "kind", "fabric");
    cJSON_AddStringToObject(object, "name", fabric->name);
    cJSON *pictures = cJSON_AddObjectToObject(object, "pictures");
    for (int use = 0; use < TL_PICTURE_USES; use++)
        if (fabric->pictures[use].file)
            cJSON_AddStringToObject(pictures, tl_picture_names[use], fabric->pictures[use].file);
    cJSON_AddNumberToObject(object, "width_mm", (double)fabric->width_mm);
    cJSON_AddNumberToObject(object, "length_mm", (double)fabric->length_mm);
    return object;
}

/* A new object about a file by its extension; NULL with an error. */
static cJSON *describe_file(const char *path, tl_audit *audit, tl_error *error)
{
    cJSON *object = NULL;
    if (tl_point_cache_is_file(path)) {
        tl_point_cache *cache = tl_point_cache_open(path, 1, error);
        if (!cache)
            return NULL;
        object = describe_motion(path, tl_point_cache_facts(cache));
        tl_point_cache_destroy(&cache);
    } else if (tl_fabric_file_is(path) && !tl_pattern_is_file(path)) {
        tl_fabric_file fabric;
        if (!tl_fabric_file_open(path, &fabric, error))
            return NULL;
        object = describe_fabric(&fabric);
        tl_audit_fabric(audit, &fabric);
        tl_fabric_file_release(&fabric);
    } else if (!tl_file_check(path, error)) {
        return NULL;
    } else if (tl_model_is_file(path)) {
        tl_model model;
        if (!tl_model_load(path, &model, error))
            return NULL;
        object = describe_model(&model, audit);
        tl_model_release(&model);
    } else if (tl_pattern_is_file(path)) {
        tl_pattern pattern;
        if (!tl_pattern_load(path, &pattern, error))
            return NULL;
        object = tl_info_describe_pattern(&pattern, audit);
        tl_pattern_release(&pattern);
    } else if (tl_path_has_extension(path, "yaml") || tl_path_has_extension(path, "yml")) {
        object = describe_scene(path, audit, error);
    } else if (tl_path_has_extension(path, "exr") || tl_path_has_extension(path, "hdr")) {
        tl_environment environment;
        if (!tl_environment_load(path, &environment, error))
            return NULL;
        object = describe_environment(&environment);
        tl_environment_release(&environment);
    } else {
        tl_fail(error, TL_INPUT,
                "%s: unknown kind of file: expected .glb, .gltf, .obj, .ply, .stl, .off, .json (a sewing "
                "pattern), .u3m, .u3ma, a folder of texture maps, .pc2, .mdd, .exr, .hdr or a scene's .yaml",
                path);
    }
    return object;
}

static bool is_built_in(const char *what)
{
    static const char *const lists[] = {"fabrics", "presets", "garments", "devices", "findings"};
    for (size_t i = 0; i < TL_COUNT(lists); i++)
        if (strcmp(what, lists[i]) == 0)
            return true;
    return false;
}

bool tl_command_info(const struct tl_arguments *arguments, tl_error *error)
{
    if (arguments->positional_count != 1)
        return tl_fail(error, TL_USAGE, "info: expected one file: toile info FILE");
    const char *path = arguments->positionals[0];
    tl_audit audit = {0};
    bool is_list = is_built_in(path);
    cJSON *object = is_list ? describe_built_in(path, error) : describe_file(path, &audit, error);
    if (!object)
        return false;
    print_object(object, is_list ? NULL : &audit, arguments->json);
    bool passed = !arguments->strict || tl_audit_count(&audit, true) == 0;
    tl_audit_release(&audit);
    if (!passed)
        *error = (tl_error){.code = TL_UNSTABLE}; /* the findings have been printed */
    return passed;
}
