#include "app/scene/appearance.h"

#include "app/textures/height_picture.h"
#include "assets/garment.h"
#include "config/base/memory.h"
#include "config/base/words.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Materials ---- */

static struct tl_gloss gloss_of(const struct tl_material_params *swatch)
{
    return (struct tl_gloss){.model = swatch->model,
                             .facets = swatch->facets,
                             .masking = swatch->masking,
                             .ward = swatch->ward,
                             .fresnel = swatch->fresnel,
                             .index = swatch->index,
                             .extinction = swatch->extinction,
                             .width_weft = swatch->width_weft,
                             .width_warp = swatch->width_warp,
                             .rotation = glm_rad(swatch->rotation_deg)};
}

static struct tl_material_params params_of(const tl_material *material)
{
    const struct tl_gloss *gloss = &material->gloss;
    struct tl_material_params params = {.use_file = true,
                                        .diffuse_roughness = material->diffuse_roughness,
                                        .glossiness = material->glossiness,
                                        .model = gloss->model,
                                        .facets = gloss->facets,
                                        .masking = gloss->masking,
                                        .ward = gloss->ward,
                                        .fresnel = gloss->fresnel,
                                        .index = gloss->index,
                                        .extinction = gloss->extinction,
                                        .width_weft = gloss->width_weft,
                                        .width_warp = gloss->width_warp,
                                        .rotation_deg = glm_deg(gloss->rotation),
                                        .coat = material->coat,
                                        .coat_glossiness = material->coat_glossiness,
                                        .openness = material->openness};
    memcpy(params.diffuse, material->diffuse.raw, sizeof params.diffuse);
    memcpy(params.specular, material->specular.raw, sizeof params.specular);
    memcpy(params.transmission, material->transmission.raw, sizeof params.transmission);
    params.fuzz = glms_vec3_max(material->fuzz.colour);
    params.fuzz_roughness = material->fuzz.roughness;
    params.fuzz_follow = material->fuzz.follow;
    for (int c = 0; c < 3; c++)
        params.fuzz_colour[c] = params.fuzz > 0 ? material->fuzz.colour.raw[c] / params.fuzz : 1;
    return params;
}

/* Whether light from inside threads is a lobe of its own (tl_thread), instead of a part of the surface's. */
static bool has_threads(const struct tl_material_params *params)
{
    return params->model != TL_REFLECT_PHONG && params->thread > 0 && params->thread_along > 0 &&
           params->thread_across > 0;
}

/* The share of the colour that threads send back as gloss. The rest is even, and the lobes' colours are
 * stored as ratios to it, so it cannot be nothing. */
static float thread_share(const struct tl_material_params *params)
{
    return has_threads(params) ? fminf(params->thread, 0.95f) : params->thread;
}

/* The colour of warps or wefts. */
static vec3s system_colour(const struct tl_material_params *params, bool is_weft)
{
    const float *weft = params->weft_colour;
    const bool is_given = weft[0] > 0 || weft[1] > 0 || weft[2] > 0;
    const float *colour = is_weft && is_given ? weft : params->diffuse;
    return (vec3s){{colour[0], colour[1], colour[2]}};
}

static vec3s cloth_colour(const struct tl_material_params *params)
{
    if (!has_threads(params))
        return system_colour(params, false);
    return glms_vec3_lerp(system_colour(params, true), system_colour(params, false), params->warp_share);
}

static vec3s even_colour(const struct tl_material_params *params)
{
    return glms_vec3_scale(cloth_colour(params), 1 - thread_share(params));
}

/* Warps run along v, so their band is narrow along it; that of the wefts is turned by a right angle. */
static void add_thread(const struct tl_material_params *params, bool is_weft, tl_material *material)
{
    const float area = is_weft ? 1 - params->warp_share : params->warp_share;
    if (!(area > 0))
        return;
    const vec3s colour = system_colour(params, is_weft), even = even_colour(params);
    struct tl_thread *thread = &material->threads[material->thread_count++];
    for (int c = 0; c < 3; c++)
        thread->ratio.raw[c] =
            even.raw[c] > 0 ? area * thread_share(params) * colour.raw[c] / even.raw[c] : 0;
    thread->width_weft = is_weft ? params->thread_along : params->thread_across;
    thread->width_warp = is_weft ? params->thread_across : params->thread_along;
}

static void set_params(const struct tl_material_params *params, tl_material *material)
{
    memcpy(material->transmission.raw, params->transmission, sizeof material->transmission.raw);
    material->diffuse = even_colour(params);
    material->diffuse_roughness = params->diffuse_roughness;
    material->thread_count = 0;
    for (int weft = 0; has_threads(params) && weft < 2; weft++)
        add_thread(params, weft == 1, material);
    for (int c = 0; c < 3; c++) { /* light from inside a thread is gloss of the thread's colour */
        const float joined = has_threads(params) ? 0 : params->thread * params->diffuse[c];
        material->specular.raw[c] = fminf(params->specular[c] + joined, 1);
        material->fuzz.colour.raw[c] = params->fuzz * params->fuzz_colour[c];
    }
    material->fuzz.roughness = params->fuzz_roughness;
    material->fuzz.follow = params->fuzz_follow;
    material->glossiness = params->glossiness;
    material->gloss = gloss_of(params);
    material->coat = params->coat;
    material->coat_glossiness = params->coat_glossiness;
    material->openness = params->openness;
}

/* A back of a colour of its own, whose threads are those of the front. */
static void set_back(const struct tl_material_params *params, tl_material *material)
{
    material->back.is_given = params->back[0] > 0 || params->back[1] > 0 || params->back[2] > 0;
    if (!material->back.is_given)
        return;
    for (int c = 0; c < 3; c++) {
        const float joined = has_threads(params) ? 0 : params->thread * params->back[c];
        material->back.diffuse.raw[c] = (1 - thread_share(params)) * params->back[c];
        material->back.specular.raw[c] = fminf(params->specular[c] + joined, 1);
    }
}

/* A file's own normal map has its seams in it. */
static void set_construction(const struct tl_construction_params *params, tl_material *material)
{
    bool has_own = params->show == TL_CONSTRUCTION_AUTO && material->normal_map.image;
    if (params->show != TL_CONSTRUCTION_NEVER && !has_own)
        material->construction = tl_construction_of(params);
}

/* Thread that is chosen to match the cloth follows it into another colour, as light or dark beside it as
 * before. One of another hue, as on denim, is a contrast that the maker wants, and stays. */
#define MATCHING_RATIO 2.0f /* of the channels' ratios to the cloth's, largest to smallest */
static void match_stitches(const float cloth[3], const float dyed[3], tl_material *material)
{
    const vec3s thread = material->construction.thread;
    float minimum = INFINITY, maximum = 0;
    for (int c = 0; c < 3; c++) {
        const float ratio = (thread.raw[c] + 1e-3f) / (cloth[c] + 1e-3f);
        minimum = fminf(minimum, ratio);
        maximum = fmaxf(maximum, ratio);
    }
    for (int c = 0; c < 3 && maximum < MATCHING_RATIO * minimum; c++)
        material->construction.thread.raw[c] = fminf(thread.raw[c] / fmaxf(cloth[c], 1e-3f) * dyed[c], 1);
}

/* The weave of a fabric; NULL when it has none. */
static bool take_weave(struct tl_appearance *appearance, const struct tl_weave_params *params,
                       const struct tl_fabric_pictures **out, tl_error *error)
{
    if (!tl_weaves_take(params, out, error))
        return false;
    appearance->weaves =
        tl_resize((void *)appearance->weaves, appearance->weave_count + 1,
                  sizeof *appearance->weaves); // NOLINT(bugprone-sizeof-expression): of a pointer
    appearance->weaves[appearance->weave_count++] = *out;
    return true;
}

/* Adds an image that the appearance owns. */
static const tl_image *keep_image(struct tl_appearance *appearance, const tl_image *image)
{
    tl_image *kept = TL_NEW(tl_image);
    *kept = *image;
    appearance->images = tl_resize(appearance->images, appearance->image_count + 1, sizeof(tl_image *));
    return appearance->images[appearance->image_count++] = kept;
}

/* Replaces a colour map by its alpha alone: a material without its print keeps its holes. */
static void drop_print(struct tl_appearance *appearance, tl_material *material)
{
    const tl_image *print = material->diffuse_map.image;
    material->diffuse_map.image = NULL;
    if (!print || !(material->alpha_cutoff > 0) || print->channels != 4)
        return;
    tl_image plain = tl_image_create(print->width, print->height, 4, TL_IMAGE_U8);
    size_t texels = (size_t)print->width * (size_t)print->height;
    memset(plain.texels, 255, 4 * texels);
    for (size_t i = 0; i < texels; i++)
        tl_image_bytes(&plain)[4 * i + 3] = tl_image_bytes(print)[4 * i + 3];
    material->diffuse_map.image = keep_image(appearance, &plain);
}

/* The measured reflectance of a material, if it has any. It is of the whole cloth, on both sides: no map and
 * no back changes it. */
static bool take_measured(struct tl_appearance *appearance, const struct tl_material_params *params,
                          tl_material *material, tl_error *error)
{
    if (!tl_text_is_given(params->samples))
        return true;
    if (!tl_measured_take(params->samples, material, error))
        return false;
    appearance->measured =
        tl_resize((void *)appearance->measured, appearance->measured_count + 1,
                  sizeof *appearance->measured); // NOLINT(bugprone-sizeof-expression): of a pointer
    appearance->measured[appearance->measured_count++] = material->measured;
    drop_print(appearance, material);
    material->gloss_map.image = material->specular_map.image = NULL;
    return true;
}

/* A fabric replaces how the surface reflects, and a print, unless it is to be tinted or kept. */
static void set_fabric(struct tl_appearance *appearance, const struct tl_material_params *fabric,
                       const tl_weave *weave, tl_material *material)
{
    if (fabric->use_file)
        return;
    vec3s file_diffuse = material->diffuse;
    set_params(fabric, material);
    if (material->diffuse_map.image && fabric->on_print == TL_ON_PRINT_KEEP)
        material->diffuse = glms_vec3_scale(file_diffuse, has_threads(fabric) ? 1 - thread_share(fabric) : 1);
    if (fabric->on_print == TL_ON_PRINT_REPLACE)
        drop_print(appearance, material);
    material->gloss_map.image = NULL;
    material->specular_map.image = NULL;
    material->weave = weave;
}

/* A material in the making: `params` and `weave` are the fabric's or, where `is_file`, the file's own. */
struct making {
    const tl_material *file;
    struct tl_material_params params;
    struct tl_weave_params weave;
    bool is_file, is_changed, is_woven, is_dyed, is_plain;
    const struct tl_fabric_pictures *pictures; /* once finished; NULL: no weave */
};

static struct making begin(const struct tl_settings *settings, const tl_material *file)
{
    struct making making = {.file = file, .params = settings->material, .weave = settings->weave};
    making.is_file = making.params.use_file;
    making.is_woven = !making.is_file;
    if (making.is_file) {
        making.params = params_of(file);
        memcpy(making.params.back, settings->material.back, sizeof making.params.back);
        making.params.samples = settings->material.samples;
    }
    return making;
}

static void change(const struct tl_swatch *swatch, struct making *making)
{
    tl_swatch_apply(swatch, &making->params, &making->weave);
    making->is_changed = true;
    making->is_woven = making->is_woven || tl_swatch_is_woven(swatch);
    making->is_dyed = making->is_dyed || tl_swatch_is_dyed(swatch);
    making->is_plain = making->is_plain || !swatch->print;
    if (!swatch->has_fabric)
        return;
    making->is_file = making->params.use_file;
    making->is_woven = !making->is_file;
    /* In a colourway the key `print` decides, unless the fabric has a picture of its own. */
    if (swatch->print && making->params.on_print == TL_ON_PRINT_REPLACE &&
        !tl_text_is_given(making->weave.pictures))
        making->params.on_print = TL_ON_PRINT_KEEP;
    if (making->is_file)
        making->params = params_of(making->file);
}

static bool finish(struct tl_appearance *appearance, const struct tl_settings *settings,
                   struct making *making, tl_material *out, tl_error *error)
{
    tl_material made = *making->file;
    if (making->is_woven && !take_weave(appearance, &making->weave, &making->pictures, error))
        return false;
    const tl_weave *weave = making->pictures ? &making->pictures->weave : NULL;
    if (!making->is_file)
        set_fabric(appearance, &making->params, weave, &made);
    else if (making->is_changed)
        set_params(&making->params, &made);
    if (making->is_woven)
        made.weave = weave;
    if (making->is_plain)
        drop_print(appearance, &made);
    if (making->is_dyed || making->is_plain)
        made.diffuse = even_colour(&making->params);
    set_back(&making->params, &made);
    if (!take_measured(appearance, &making->params, &made, error))
        return false;
    set_construction(&settings->construction, &made);
    if (making->is_changed)
        match_stitches(settings->material.diffuse, making->params.diffuse, &made);
    *out = made;
    return true;
}

static bool is_meant(const struct tl_swatch *swatch, const tl_material *material)
{
    return strcmp(swatch->material, TL_SWATCH_ALL) == 0 || strcmp(swatch->material, material->name) == 0;
}

/* The maps of detail.normals and detail.heights in place of all materials' own. */
static bool set_baked_maps(struct tl_appearance *appearance, const struct tl_detail_params *detail,
                           tl_error *error)
{
    const struct tl_map lying = {.transform = {.scale = {1, 1}}, .clamp_u = true, .clamp_v = true};
    struct tl_map normals = lying, heights = lying;
    float limits_m[2] = {0, 0};
    tl_image image;
    if (tl_text_is_given(detail->normals)) {
        if (!tl_normal_picture_load(detail->normals, &image, error))
            return false;
        normals.image = keep_image(appearance, &image);
    }
    if (tl_text_is_given(detail->heights)) {
        if (!tl_height_picture_metres(detail->heights, &image, limits_m, error))
            return false;
        heights.image = keep_image(appearance, &image);
    }
    for (size_t i = 0; i < appearance->garment.material_count; i++) {
        tl_material *material = &appearance->garment.materials[i];
        if (normals.image) {
            material->normal_map = normals;
            material->normal_scale = 1;
        }
        if (heights.image) {
            material->height_map = heights;
            material->height_m = limits_m[1] - limits_m[0];
            material->height_top_m = limits_m[1];
        }
    }
    return true;
}

/* Cover and specular of a fabric's pictures, which a weave has not, are maps of the material. They lie to
 * scale for one length of a UV unit, so parts of another one get a material of their own. */
static void place_pictures(struct tl_dressing *dressing, const tl_model *model, size_t index,
                           const struct tl_fabric_pictures *pictures)
{
    tl_material plain = dressing->materials[index];
    if (!pictures->cover.texels && !pictures->specular.texels)
        return;
    for (size_t p = 0; p < model->mesh.part_count; p++) {
        struct tl_mesh_part *part = &dressing->parts[p];
        if (part->material != (int)index || !(part->uv_metres > 0))
            continue;
        const struct tl_uv_transform transform = tl_fabric_pictures_transform(plain.weave, part->uv_metres);
        tl_material placed = plain;
        if (pictures->specular.texels)
            placed.specular_map = (struct tl_map){.image = &pictures->specular, .transform = transform};
        if (pictures->cover.texels && !plain.diffuse_map.image) {
            placed.diffuse_map = (struct tl_map){.image = &pictures->cover, .transform = transform};
            placed.alpha_cutoff = 0.5f;
        }
        dressing->materials[dressing->material_count] = placed;
        part->material = (int)dressing->material_count++;
    }
}

static bool make_materials(const struct tl_settings *settings, const tl_model *model,
                           struct tl_appearance *appearance, tl_error *error)
{
    const struct tl_colourways *colourways = settings->colourways;
    for (size_t i = 0; i < model->material_count; i++) {
        struct making making = begin(settings, &model->materials[i]);
        for (size_t k = 0; k < colourways->swatch_count; k++)
            if (is_meant(&colourways->swatches[k], making.file))
                change(&colourways->swatches[k], &making);
        if (!finish(appearance, settings, &making, &appearance->garment.materials[i], error))
            return false;
        if (making.pictures)
            place_pictures(&appearance->garment, model, i, making.pictures);
    }
    return set_baked_maps(appearance, &settings->detail, error);
}

/* ---- The colourway ---- */

static void add_name(struct tl_appearance *appearance, const char *name)
{
    for (size_t i = 0; i < appearance->name_count; i++)
        if (strcmp(appearance->names[i], name) == 0)
            return;
    appearance->names = tl_resize(appearance->names, appearance->name_count + 1, sizeof(char *));
    appearance->names[appearance->name_count++] = tl_copy_string(name);
}

static void gather_names(const struct tl_settings *settings, const tl_model *garment, const tl_model *avatar,
                         struct tl_appearance *appearance)
{
    const tl_model *models[] = {garment, avatar};
    for (size_t i = 0; i < settings->colourways->name_count; i++)
        add_name(appearance, settings->colourways->names[i]);
    for (size_t m = 0; m < TL_COUNT(models); m++)
        for (size_t i = 0; models[m] && i < models[m]->variant_count; i++)
            add_name(appearance, models[m]->variants[i].name);
}

static bool fail_name(const char *what, const char *name, const char *const *names, size_t count,
                      tl_error *error)
{
    const char *near = tl_nearest_word(name, names, count);
    char *list = tl_join_words(names, count, ", ", ", ");
    if (near)
        tl_fail(error, TL_USAGE, "%s: did you mean %s?", what, near);
    else if (count)
        tl_fail(error, TL_USAGE, "%s: there are %s", what, list);
    else
        tl_fail(error, TL_USAGE, "%s: there are none", what);
    free(list);
    return false;
}

static bool check_colourway(const struct tl_settings *settings, const struct tl_appearance *appearance,
                            tl_error *error)
{
    const char *name = settings->scene.colourway;
    for (size_t i = 0; i < appearance->name_count; i++)
        if (strcmp(appearance->names[i], name) == 0)
            return true;
    if (name[0] == '\0')
        return true;
    char *what =
        tl_format("scene.colourway: \"%s\": neither the scene nor a model has such a colourway", name);
    fail_name(what, name, (const char *const *)appearance->names, appearance->name_count, error);
    free(what);
    return false;
}

static bool check_swatch(const struct tl_settings *settings, const struct tl_swatch *swatch,
                         const tl_model *garment, tl_error *error)
{
    const char **names = TL_NEW_ARRAY(const char *, garment->material_count + 1);
    bool known = false;
    for (size_t i = 0; i < garment->material_count; i++) {
        known = known || is_meant(swatch, &garment->materials[i]);
        names[i] = garment->materials[i].name;
    }
    names[garment->material_count] = TL_SWATCH_ALL;
    char *what = tl_format("%s:%d: colourways.%s.%s: the garment %s has no such material",
                           tl_settings_colourways_source(settings), swatch->line, settings->scene.colourway,
                           swatch->material, garment->name);
    if (!known)
        fail_name(what, swatch->material, names, garment->material_count + 1, error);
    free(what);
    free((void *)names);
    return known;
}

/* The model's materials and parts, the latter as its variant has them if it has one of this name. */
static void dress(const tl_model *model, const char *variant_name, struct tl_dressing *out)
{
    const tl_mesh *mesh = &model->mesh;
    const struct tl_variant *variant = tl_model_find_variant(model, variant_name);
    out->materials = TL_NEW_ARRAY(tl_material, model->material_count + mesh->part_count);
    out->material_count = model->material_count;
    memcpy(out->materials, model->materials, model->material_count * sizeof *out->materials);
    out->parts = TL_NEW_ARRAY(struct tl_mesh_part, mesh->part_count);
    for (size_t p = 0; p < mesh->part_count; p++) {
        out->parts[p] = mesh->parts[p];
        if (variant)
            out->parts[p].material = variant->materials[p];
    }
}

bool tl_appearance_make(const struct tl_settings *settings, const tl_model *garment, const tl_model *avatar,
                        struct tl_appearance *out, tl_error *error)
{
    *out = (struct tl_appearance){0};
    gather_names(settings, garment, avatar, out);
    bool good = check_colourway(settings, out, error);
    for (size_t i = 0; good && garment && i < settings->colourways->swatch_count; i++)
        good = check_swatch(settings, &settings->colourways->swatches[i], garment, error);
    if (!good) {
        tl_appearance_release(out);
        return false;
    }
    if (avatar)
        dress(avatar, settings->scene.colourway, &out->avatar);
    if (garment) {
        dress(garment, settings->scene.colourway, &out->garment);
        if (!make_materials(settings, garment, out, error)) {
            tl_appearance_release(out);
            return false;
        }
    }
    return true;
}

void tl_appearance_release(struct tl_appearance *appearance)
{
    for (size_t i = 0; i < appearance->weave_count; i++)
        tl_weaves_give(appearance->weaves[i]);
    for (size_t i = 0; i < appearance->measured_count; i++)
        tl_measured_give(appearance->measured[i]);
    for (size_t i = 0; i < appearance->image_count; i++) {
        tl_image_release(appearance->images[i]);
        free(appearance->images[i]);
    }
    for (size_t i = 0; i < appearance->name_count; i++)
        free(appearance->names[i]);
    struct tl_dressing *dressings[] = {&appearance->garment, &appearance->avatar};
    for (size_t i = 0; i < TL_COUNT(dressings); i++) {
        free(dressings[i]->materials);
        free(dressings[i]->parts);
    }
    free((void *)appearance->weaves);
    free((void *)appearance->measured);
    free((void *)appearance->images);
    free((void *)appearance->names);
    *appearance = (struct tl_appearance){0};
}

bool tl_appearance_is_same(const struct tl_settings *a, const struct tl_settings *b)
{
    return a->colourways == b->colourways &&
           !tl_settings_differ(a, b, (struct tl_option_filter){.any_of = TL_AFFECTS_MATERIALS});
}

struct tl_spare_appearance *tl_spare_find(struct tl_spare_appearance spares[TL_SPARE_APPEARANCES],
                                          const struct tl_settings *settings)
{
    for (size_t i = 0; i < TL_SPARE_APPEARANCES; i++)
        if (spares[i].is_kept && tl_appearance_is_same(&spares[i].made_of, settings))
            return &spares[i];
    return NULL;
}

void tl_spare_add(struct tl_spare_appearance spares[TL_SPARE_APPEARANCES], const struct tl_settings *made_of,
                  const struct tl_appearance *appearance, uint64_t revision)
{
    const size_t last = TL_SPARE_APPEARANCES - 1;
    tl_appearance_release(&spares[last].appearance);
    memmove(spares + 1, spares, last * sizeof *spares);
    spares[0] = (struct tl_spare_appearance){true, *appearance, revision, *made_of};
}

struct tl_option_filter tl_appearance_filter(const struct tl_settings *a, const struct tl_settings *b)
{
    bool same_garment = strcmp(a->scene.garment, b->scene.garment) == 0;
    return (struct tl_option_filter){.any_of = TL_AFFECTS_APPEARANCE,
                                     .none_of = same_garment ? 0 : TL_AFFECTS_GARMENT};
}

/* Takes the colourways, which follow from options, with them. */
void tl_appearance_take(const struct tl_settings *from, struct tl_settings *settings)
{
    const struct tl_option_filter filter = tl_appearance_filter(from, settings);
    tl_settings_take(from, settings, filter);
    if (!filter.none_of)
        settings->colourways = from->colourways;
}
