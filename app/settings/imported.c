#include "app/settings/imported.h"

#include "assets/base/material.h"
#include "assets/fabric/fabric_maps.h"
#include "assets/weave/weave.h"
#include "cloth/energy/fabric.h"
#include "config/base/file.h"
#include "config/base/intern.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "render/brdf/options.h"
#include "render/construction/options.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

char *tl_imported_own_file(const char *path)
{
    size_t length = strlen(path);
    char *file = tl_format("%s%s%s", path, length && path[length - 1] == '/' ? "" : "/", TL_FABRIC_OWN_FILE);
    if (tl_file_exists(file))
        return file;
    free(file);
    return NULL;
}

static void *bound(const struct tl_binding *bindings, size_t count, const struct tl_option_table *table)
{
    for (size_t i = 0; i < count; i++)
        if (bindings[i].table == table)
            return bindings[i].params;
    return NULL;
}

static void set_number(double *field, double value, double low, double high)
{
    if (!isnan(value))
        *field = fmin(fmax(value, low), high);
}

/* The ranges are those of the options. */
static void set_physics(const struct tl_fabric_physics *physics, struct tl_cloth_fabric *fabric)
{
    set_number(&fabric->areal_density, physics->weight_kg_m2, 1e-4, 100);
    set_number(&fabric->stretch_weft, physics->stretch_weft, 0, 1e9);
    set_number(&fabric->stretch_warp, physics->stretch_warp, 0, 1e9);
    set_number(&fabric->shear, physics->shear, 0, 1e9);
    set_number(&fabric->bend_weft, physics->bend_weft, 0, 1e3);
    set_number(&fabric->bend_warp, physics->bend_warp, 0, 1e3);
}

static bool set_weave(const char *path, const tl_fabric_file *file, float depth_mm,
                      struct tl_weave_params *weave, tl_error *error)
{
    static const int patterns[] = {[TL_FABRIC_PATTERN_NONE] = TL_WEAVE_NONE,
                                   [TL_FABRIC_PATTERN_PLAIN] = TL_WEAVE_PLAIN,
                                   [TL_FABRIC_PATTERN_TWILL] = TL_WEAVE_TWILL,
                                   [TL_FABRIC_PATTERN_SATIN] = TL_WEAVE_SATIN};
    weave->pattern = patterns[file->pattern];
    if (!tl_fabric_file_has_pictures(file))
        return true;
    if (strlen(path) >= TL_STRING_SIZE)
        return tl_fail(error, TL_INPUT, "%.60s...: the path is too long: move the fabric nearer", path);
    weave->pictures = tl_intern(path);
    weave->pattern = TL_WEAVE_NONE;
    weave->picture_mm = file->width_mm;
    weave->picture_length_mm = file->length_mm;
    weave->picture_mirror =
        (file->mirrors_u ? TL_PICTURE_MIRROR_WEFT : 0) | (file->mirrors_v ? TL_PICTURE_MIRROR_WARP : 0);
    if (depth_mm > 0 && file->width_mm > 0) /* a folder's heights have no scale */
        weave->depth_mm = fminf(depth_mm, 1e4f);
    return true;
}

static float clamped(float value, float high)
{
    return fminf(fmaxf(value, 0), high);
}

/* The base is a mixture of cloth and metal; maps that vary the mixture bring its colours themselves. */
static void set_colours(const tl_fabric_file *file, struct tl_material_params *material)
{
    const struct tl_fabric_surface *surface = &file->surface;
    bool by_map = file->pictures[TL_PICTURE_METALNESS].file || file->pictures[TL_PICTURE_SPECULAR].file;
    float metal = by_map ? 0 : surface->metalness;
    for (int c = 0; c < 3; c++) {
        float own = clamped(surface->colour[c], 1);
        material->diffuse[c] = (1 - metal) * own;
        material->specular[c] = by_map ? 1 : clamped((1 - metal) * surface->specular + metal * own, 1);
        material->transmission[c] = surface->transmission;
        material->fuzz_colour[c] = 1 - surface->sheen_tint * (1 - own);
    }
}

static void set_anisotropy(const struct tl_fabric_surface *surface, struct tl_material_params *material)
{
    float aspect = sqrtf(1 - 0.9f * clamped(surface->anisotropy, 1)),
          width = surface->roughness * surface->roughness;
    if (!(surface->anisotropy > 0)) { /* GGX, whose width follows the pictures' glossiness */
        const struct tl_gloss gloss = tl_gloss_from_roughness(surface->roughness, true);
        material->model = gloss.model;
        material->facets = gloss.facets;
        material->masking = gloss.masking;
        return;
    }
    material->model = TL_REFLECT_WARD;
    material->ward = TL_WARD_BOUNDED;
    material->width_weft = clamped(width / aspect, 1);
    material->width_warp = clamped(width * aspect, 1);
    material->rotation_deg = surface->rotation_deg;
}

static void set_material(const tl_fabric_file *file, const struct tl_fabric_means *means,
                         struct tl_material_params *material)
{
    const struct tl_fabric_surface *surface = &file->surface;
    material->use_file = !file->has_surface;
    if (material->use_file)
        return;
    set_colours(file, material);
    set_anisotropy(surface, material);
    material->glossiness = means->glossiness;
    material->fuzz = surface->sheen;
    material->coat = surface->coat;
    if (surface->coat > 0)
        material->coat_glossiness = tl_glossiness_from_roughness(surface->coat_roughness);
    material->openness = file->pictures[TL_PICTURE_OPACITY].file ? 0 : clamped(1 - surface->alpha, 0.99f);
    for (int c = 0; file->has_back && c < 3; c++)
        material->back[c] = clamped(means->back[c], 1);
}

bool tl_imported_apply_file(const char *path, const tl_fabric_file *file, const struct tl_binding *bindings,
                            size_t count, tl_error *error)
{
    struct tl_cloth_fabric *fabric = bound(bindings, count, &tl_cloth_fabric_options);
    struct tl_weave_params *weave = bound(bindings, count, &tl_weave_options);
    struct tl_material_params *material = bound(bindings, count, &tl_material_options);
    struct tl_construction_params *construction = bound(bindings, count, &tl_construction_options);
    struct tl_fabric_means means;
    if (!tl_fabric_maps_means(file, &means, error))
        return false;
    if (fabric)
        set_physics(&file->physics, fabric);
    if (material)
        set_material(file, &means, material);
    if (construction && !isnan(file->physics.thickness_m))
        construction->thickness_mm = (float)fmin(fmax(1e3 * file->physics.thickness_m, 0.02), 5);
    return !weave || set_weave(path, file, means.depth_mm, weave, error);
}

bool tl_imported_apply(const char *path, const struct tl_binding *bindings, size_t count, tl_error *error)
{
    tl_fabric_file file;
    if (!tl_fabric_file_open(path, &file, error))
        return false;
    bool applied = tl_imported_apply_file(path, &file, bindings, count, error);
    if (applied && file.missing_count > 0)
        tl_warn("%s: %zu of the files that it names are missing: `toile fabric %s` lists them", path,
                file.missing_count, path);
    tl_fabric_file_release(&file);
    return applied;
}
