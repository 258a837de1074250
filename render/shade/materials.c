#include "render/shade/materials.h"

#include "config/base/memory.h"
#include "render/brdf/material_lobes.h"
#include "render/detail/bake.h"
#include "render/detail/detail.h"

#include <math.h>
#include <stdlib.h>

/* The packed form of an image: its colours, its numbers, the moments of its normals, the mixed
 * one apart; or a weave's tint with
 * its gloss. */
enum packed { PACKED_COLOUR, PACKED_DATA, PACKED_MOMENTS, PACKED_CROSS, PACKED_WEAVE };

struct tl_shade_image {
    const tl_image *image; /* of a weave its tint */
    enum packed kind;
    struct tl_texels texels;
};

/* Materials that differ in colour or maps only share a table. */
struct tl_shade_lobe_set {
    struct tl_gloss gloss;
    float low, high; /* of glossiness */
    int max_count;
    struct tl_lobe_set_table table;
};

static bool fits(const tl_material *material, const struct tl_detail_params *detail)
{
    return !(tl_detail_has_own_normals(material) && material->height_map.image) &&
           (detail->mode == TL_DETAIL_NORMAL || !tl_detail_wants_maps(detail, material)) &&
           (detail->shadow == TL_DETAIL_SHADOW_NONE || !tl_detail_wants_maps(detail, material));
}

bool tl_shade_materials_fit(const tl_surface *surfaces, size_t count, const struct tl_detail_params *detail)
{
    for (size_t s = 0; s < count; s++)
        for (size_t p = 0; p < surfaces[s].part_count; p++)
            if (!fits(&surfaces[s].materials[surfaces[s].parts[p].material], detail))
                return false;
    return true;
}

static struct tl_texels pack_weave(const tl_weave *weave)
{
    const tl_image *tint = &weave->tint;
    size_t count = (size_t)tint->width * (size_t)tint->height;
    tl_image both = tl_image_create(tint->width, tint->height, 4, TL_IMAGE_F32);
    for (size_t i = 0; i < count; i++) {
        for (size_t c = 0; c < 3; c++)
            tl_image_floats(&both)[4 * i + c] = tl_image_floats(tint)[3 * i + c];
        tl_image_floats(&both)[4 * i + 3] = tl_image_floats(&weave->gloss)[i];
    }
    struct tl_texels texels = tl_texels_make(&both, false);
    tl_image_release(&both);
    return texels;
}

static struct tl_texels pack(const tl_image *image, enum packed kind, const tl_weave *weave)
{
    if (kind == PACKED_WEAVE)
        return pack_weave(weave);
    if (kind != PACKED_MOMENTS && kind != PACKED_CROSS)
        return tl_texels_make(image, kind == PACKED_COLOUR);
    tl_image moments =
        kind == PACKED_CROSS ? tl_bake_cross_moments(image, false) : tl_bake_moments(image, false);
    struct tl_texels texels = tl_texels_make(&moments, false);
    tl_image_release(&moments);
    return texels;
}

static const struct tl_texels *find_image(struct tl_shade_materials *materials, const tl_image *image,
                                          enum packed kind, const tl_weave *weave)
{
    if (!image || !image->texels)
        return NULL;
    for (size_t i = 0; i < materials->image_count; i++)
        if (materials->images[i]->image == image && materials->images[i]->kind == kind)
            return &materials->images[i]->texels;
    materials->images =
        tl_resize(materials->images, materials->image_count + 1, sizeof(struct tl_shade_image *));
    struct tl_shade_image *made = TL_NEW(struct tl_shade_image);
    *made = (struct tl_shade_image){image, kind, pack(image, kind, weave)};
    materials->images[materials->image_count++] = made;
    return &made->texels;
}

static bool same_gloss(const struct tl_gloss *a, const struct tl_gloss *b)
{
    return a->model == b->model && a->facets == b->facets && a->masking == b->masking &&
           a->fresnel == b->fresnel && a->index == b->index && a->extinction == b->extinction &&
           a->width_weft == b->width_weft && a->width_warp == b->width_warp;
}

/* The smallest and largest value of a map's last channel. */
static void range_of(const struct tl_texels *texels, float *low, float *high)
{
    *low = INFINITY, *high = -INFINITY;
    size_t count = (size_t)texels->widths[0] * (size_t)texels->heights[0];
    for (size_t i = 0; i < count; i++) {
        float value = tl_texels_at(texels, 0, i)[3];
        *low = fminf(*low, value);
        *high = fmaxf(*high, value);
    }
}

/* Bumps may dull any gloss. */
static void glossiness_range(const struct tl_shade_part *part, float *low, float *high)
{
    *low = *high = part->material->glossiness;
    if (part->maps[TL_MAP_GLOSS].texels)
        *low = 0;
    if (part->weave_tint) {
        float minimum, maximum;
        range_of(part->weave_tint, &minimum, &maximum);
        *low += minimum, *high += maximum;
    }
    *low = part->own_moments || part->weave_moments || part->borders ? 0 : fminf(fmaxf(*low, 0), 1);
    *high = fminf(fmaxf(*high, 0), 1);
}

static const struct tl_lobe_set_table *find_lobe_set(struct tl_shade_materials *materials,
                                                     const struct tl_shade_part *part, int max_count)
{
    float low, high;
    glossiness_range(part, &low, &high);
    for (size_t i = 0; i < materials->lobe_set_count; i++) {
        const struct tl_shade_lobe_set *set = materials->lobe_sets[i];
        if (same_gloss(&set->gloss, &part->material->gloss) && set->low == low && set->high == high &&
            set->max_count == max_count)
            return &set->table;
    }
    materials->lobe_sets =
        tl_resize(materials->lobe_sets, materials->lobe_set_count + 1, sizeof(struct tl_shade_lobe_set *));
    struct tl_shade_lobe_set *made = TL_NEW(struct tl_shade_lobe_set);
    *made = (struct tl_shade_lobe_set){
        .gloss = part->material->gloss, .low = low, .high = high, .max_count = max_count};
    tl_lobe_set_table_make(part->material, low, high, max_count, &made->table);
    materials->lobe_sets[materials->lobe_set_count++] = made;
    return &made->table;
}

static struct tl_shade_map map_of(struct tl_shade_materials *materials, const struct tl_map *map,
                                  enum tl_map_use use)
{
    bool colour = use == TL_MAP_DIFFUSE || use == TL_MAP_SPECULAR;
    struct tl_shade_map made = {
        .texels = find_image(materials, map->image, colour ? PACKED_COLOUR : PACKED_DATA, NULL),
        .clamp_u = map->clamp_u,
        .clamp_v = map->clamp_v};
    tl_uv_transform_rows(&map->transform, made.rows);
    return made;
}

static void add_weave(struct tl_shade_materials *materials, float uv_metres, bool moments,
                      struct tl_shade_part *part)
{
    const tl_weave *weave = part->material->weave;
    if (!weave || !(uv_metres > 0) || !(weave->size_m[0] > 0) || !(weave->size_m[1] > 0))
        return;
    part->weave_scale[0] = uv_metres / weave->size_m[0];
    part->weave_scale[1] = uv_metres / weave->size_m[1];
    part->yarns = weave->yarns;
    part->uv_metres = uv_metres;
    part->weave_tint = find_image(materials, &weave->tint, PACKED_WEAVE, weave);
    if (moments)
        part->weave_moments = find_image(materials, &weave->normal, PACKED_MOMENTS, NULL);
    if (moments && materials->detail.minify == TL_DETAIL_MINIFY_LEAN)
        part->weave_cross = find_image(materials, &weave->normal, PACKED_CROSS, NULL);
    if (!moments)
        part->weave_normal = find_image(materials, &weave->normal, PACKED_DATA, NULL);
}

static void add_construction(struct tl_shade_materials *materials, const tl_borders *borders,
                             struct tl_shade_part *part)
{
    if (!borders || borders->border_count == 0 || !tl_material_is_sewn(part->material))
        return;
    struct tl_construction_tables *made = TL_NEW(struct tl_construction_tables);
    tl_construction_tables_make(&part->material->construction, made);
    materials->constructions = tl_resize(materials->constructions, materials->construction_count + 1,
                                         sizeof(struct tl_construction_tables *));
    materials->constructions[materials->construction_count++] = made;
    part->borders = borders;
    part->construction = made;
}

static void forget_constructions(struct tl_shade_materials *materials)
{
    for (size_t i = 0; i < materials->construction_count; i++)
        free(materials->constructions[i]);
    free(materials->constructions);
    materials->constructions = NULL;
    materials->construction_count = 0;
}

static struct tl_shade_part make_part(struct tl_shade_materials *materials, const tl_material *material,
                                      const tl_borders *borders, float uv_metres, int max_lobes)
{
    const struct tl_map *maps[TL_MAP_USES] = {[TL_MAP_DIFFUSE] = &material->diffuse_map,
                                              [TL_MAP_NORMAL] = &material->normal_map,
                                              [TL_MAP_GLOSS] = &material->gloss_map,
                                              [TL_MAP_SPECULAR] = &material->specular_map,
                                              [TL_MAP_OCCLUSION] = &material->occlusion_map};
    bool moments = tl_detail_wants_moments(&materials->detail);
    struct tl_shade_part part = {.material = material};
    for (enum tl_map_use use = 0; use < TL_MAP_USES; use++) {
        if (use == TL_MAP_NORMAL && moments) {
            part.own_moments = find_image(materials, material->normal_map.image, PACKED_MOMENTS, NULL);
            if (materials->detail.minify == TL_DETAIL_MINIFY_LEAN)
                part.own_cross = find_image(materials, material->normal_map.image, PACKED_CROSS, NULL);
            part.maps[use] = (struct tl_shade_map){.clamp_u = material->normal_map.clamp_u,
                                                   .clamp_v = material->normal_map.clamp_v};
            tl_uv_transform_rows(&material->normal_map.transform, part.maps[use].rows);
        } else {
            part.maps[use] = map_of(materials, maps[use], use);
        }
        part.has_maps |= part.maps[use].texels != NULL;
    }
    part.emission = map_of(materials, &material->emission_map, TL_MAP_DIFFUSE);
    part.has_maps |= part.emission.texels != NULL;
    add_weave(materials, uv_metres, moments, &part);
    add_construction(materials, borders, &part);
    bool woven = part.weave_tint != NULL;
    part.turn_cosine = cosf(material->gloss.rotation);
    part.turn_sine = sinf(material->gloss.rotation);
    part.has_maps |= woven || part.own_moments || part.borders;
    part.has_bumps = woven || part.own_moments || part.borders || part.maps[TL_MAP_NORMAL].texels;
    part.is_glossy = glms_vec3_max(material->specular) > 0;
    part.transmits = tl_material_transmits(material);
    part.is_lambert = tl_material_is_lambert(material);
    part.law = tl_material_law(material);
    part.has_fuzz = tl_material_has_fuzz(material);
    materials->have_fuzz |= part.has_fuzz;
    materials->openness = fmaxf(materials->openness, material->openness);
    part.is_faceted = material->gloss.model != TL_REFLECT_PHONG;
    part.lobe_set_count = max_lobes;
    for (int i = 0; i < material->thread_count; i++) {
        part.thread_squares[i][0] = material->threads[i].width_weft * material->threads[i].width_weft;
        part.thread_squares[i][1] = material->threads[i].width_warp * material->threads[i].width_warp;
    }
    if (material->gloss.model == TL_REFLECT_WARD) {
        const struct tl_brdf brdf = tl_brdf_of(material, material->specular, material->glossiness);
        part.ward_squares[0] = brdf.gloss.width_weft * brdf.gloss.width_weft;
        part.ward_squares[1] = brdf.gloss.width_warp * brdf.gloss.width_warp;
    } else if (part.is_faceted) {
        part.lobe_set = find_lobe_set(materials, &part, max_lobes);
    }
    return part;
}

void tl_shade_materials_make(struct tl_shade_materials *materials, const tl_surface *const *surfaces,
                             size_t count, uint64_t shapes_revision, const struct tl_detail_params *detail,
                             int max_lobes)
{
    if (materials->shapes_revision != shapes_revision) {
        tl_shade_materials_release(materials);
    } else {
        free(materials->first_parts);
        free(materials->parts);
        forget_constructions(materials);
    }
    materials->shapes_revision = shapes_revision;
    materials->detail = *detail;
    materials->surface_count = count;
    materials->openness = 0;
    materials->have_fuzz = false;
    materials->first_parts = TL_NEW_ARRAY(size_t, count + 1);
    for (size_t s = 0; s < count; s++)
        materials->first_parts[s + 1] = materials->first_parts[s] + surfaces[s]->part_count;
    materials->parts = TL_NEW_ARRAY(struct tl_shade_part, materials->first_parts[count]);
    for (size_t s = 0; s < count; s++)
        for (size_t p = 0; p < surfaces[s]->part_count; p++) {
            const struct tl_mesh_part *part = &surfaces[s]->parts[p];
            materials->parts[materials->first_parts[s] + p] =
                make_part(materials, &surfaces[s]->materials[part->material], surfaces[s]->borders,
                          part->uv_metres, max_lobes);
        }
}

void tl_shade_materials_release(struct tl_shade_materials *materials)
{
    for (size_t i = 0; i < materials->image_count; i++) {
        tl_texels_release(&materials->images[i]->texels);
        free(materials->images[i]);
    }
    for (size_t i = 0; i < materials->lobe_set_count; i++) {
        tl_lobe_set_table_release(&materials->lobe_sets[i]->table);
        free(materials->lobe_sets[i]);
    }
    forget_constructions(materials);
    free(materials->images);
    free(materials->lobe_sets);
    free(materials->first_parts);
    free(materials->parts);
    /* one by one: clang's analyser does not follow pointers through the assignment of a whole struct */
    materials->images = NULL;
    materials->lobe_sets = NULL;
    materials->first_parts = NULL;
    materials->parts = NULL;
    materials->image_count = materials->lobe_set_count = materials->surface_count = 0;
    materials->shapes_revision = 0;
}

size_t tl_shade_materials_bytes(const struct tl_shade_materials *materials)
{
    size_t bytes = materials->construction_count * sizeof(struct tl_construction_tables);
    for (size_t i = 0; i < materials->image_count; i++)
        bytes += tl_texels_bytes(&materials->images[i]->texels);
    for (size_t i = 0; i < materials->lobe_set_count; i++)
        bytes += (size_t)materials->lobe_sets[i]->table.gloss_count * TL_LOBE_SET_COSINES *
                 TL_LOBE_SET_AZIMUTHS * sizeof(struct tl_lobe_set_node);
    return bytes;
}

size_t tl_shade_part_at(const struct tl_shade_materials *materials, const tl_surface *surface,
                        size_t surface_index, uint32_t triangle)
{
    return materials->first_parts[surface_index] +
           (size_t)(tl_triangle_part(surface, triangle) - surface->parts);
}
