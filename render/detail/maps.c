#include "render/detail/maps.h"

#include "config/base/memory.h"
#include "render/detail/bake.h"
#include "render/detail/cones.h"
#include "render/detail/detail.h"

#include <epoxy/gl.h>

#include <stdlib.h>
#include <string.h>

/* Bits of detail_flags: the existing maps (cones exist where heights do). The same numbers as in
 * detail.glsl. */
enum {
    FLAG_OWN_MOMENTS = 1,
    FLAG_WEAVE_MOMENTS = 2,
    FLAG_HEIGHTS = 4,
    FLAG_HORIZONS = 8,
    FLAG_CLAMP_U = 16,
    FLAG_CLAMP_V = 32
};
static const int unit_flags[TL_DETAIL_UNITS] = {[TL_DETAIL_HEIGHTS] = FLAG_HEIGHTS,
                                                [TL_DETAIL_HORIZONS] = FLAG_HORIZONS,
                                                [TL_DETAIL_OWN_MOMENTS] = FLAG_OWN_MOMENTS,
                                                [TL_DETAIL_WEAVE_MOMENTS] = FLAG_WEAVE_MOMENTS};

struct tl_detail_entry {
    const tl_material
        *material; /* of the part for which it was made; compared, and read while maps are made */
    float uv_metres;
    float low_m, high_m;
    float rows[6];
    int flags;
    tl_texture textures[TL_DETAIL_UNITS];
};

static bool same_transform(const struct tl_uv_transform *a, const struct tl_uv_transform *b)
{
    return a->offset[0] == b->offset[0] && a->offset[1] == b->offset[1] && a->scale[0] == b->scale[0] &&
           a->scale[1] == b->scale[1] && a->rotation == b->rotation;
}

static bool same_map(const struct tl_map *a, const struct tl_map *b)
{
    return a->image == b->image && same_transform(&a->transform, &b->transform) && a->clamp_u == b->clamp_u &&
           a->clamp_v == b->clamp_v;
}

static bool same_detail(const struct tl_detail_entry *entry, const tl_material *material, float uv_metres)
{
    const tl_material *made = entry->material;
    return made->weave == material->weave && entry->uv_metres == uv_metres &&
           same_map(&made->normal_map, &material->normal_map) &&
           same_map(&made->height_map, &material->height_map) && made->height_m == material->height_m &&
           made->height_top_m == material->height_top_m;
}

static void set_wrap(const tl_texture *texture, bool clamp_u, bool clamp_v)
{
    glTextureParameteri(texture->id, GL_TEXTURE_WRAP_S, clamp_u ? GL_CLAMP_TO_EDGE : GL_REPEAT);
    glTextureParameteri(texture->id, GL_TEXTURE_WRAP_T, clamp_v ? GL_CLAMP_TO_EDGE : GL_REPEAT);
}

static tl_texture upload_heights(tl_gpu *gpu, const tl_image *image)
{
    tl_texture texture = tl_texture_create(gpu, GL_TEXTURE_2D, GL_R32F, image->width, image->height, 1,
                                           tl_texture_full_levels(image->width, image->height));
    tl_texture_fill(&texture, 0, image, false);
    return texture;
}

/* Half floats do not resolve the small variances of narrow lobes. Large maps use them nevertheless, because
 * of their size. */
#define FLOAT_MOMENTS_SIDE 512

/* Fills a layer with `count` channels of an image, the first being `first`. */
static void fill_channels(const tl_texture *texture, int layer, const tl_image *image, int first, int count)
{
    tl_image some = tl_image_create(image->width, image->height, count, TL_IMAGE_F32);
    const size_t texels = (size_t)image->width * (size_t)image->height, stride = (size_t)image->channels;
    for (size_t i = 0; i < texels; i++)
        memcpy(tl_image_floats(&some) + (size_t)count * i, tl_image_floats(image) + stride * i + first,
               (size_t)count * sizeof(float));
    tl_texture_fill(texture, layer, &some, false);
    tl_image_release(&some);
}

/* Layers: (x, y), (x^2, y^2), and where it is read (x y, 0). */
static tl_texture upload_moments(tl_gpu *gpu, const tl_image *normals, const struct tl_detail_params *params)
{
    const bool is_lean = params->minify == TL_DETAIL_MINIFY_LEAN;
    const bool offsets = tl_detail_has_offsets(params);
    const bool has_squares = !offsets || params->minify != TL_DETAIL_MINIFY_NONE;
    tl_image moments = tl_bake_moments(normals, offsets);
    int width = moments.width, height = moments.height;
    GLenum format = width <= FLOAT_MOMENTS_SIDE && height <= FLOAT_MOMENTS_SIDE ? GL_RG32F : GL_RG16F;
    tl_texture texture = tl_texture_create(gpu, GL_TEXTURE_2D_ARRAY, format, width, height,
                                           1 + has_squares + is_lean, tl_texture_full_levels(width, height));
    fill_channels(&texture, 0, &moments, 0, 2);
    if (has_squares)
        fill_channels(&texture, 1, &moments, 2, 2);
    tl_image_release(&moments);
    if (is_lean) {
        moments = tl_bake_cross_moments(normals, offsets);
        tl_texture_fill(&texture, 2, &moments, false);
        tl_image_release(&moments);
    }
    return texture;
}

/* Averages heights until no side is longer than `full_size`. */
static tl_image shrunk(const tl_image *image, int full_size)
{
    int longest = image->width > image->height ? image->width : image->height;
    int factor = (longest + full_size - 1) / full_size;
    int width = image->width / factor > 1 ? image->width / factor : 1;
    int height = image->height / factor > 1 ? image->height / factor : 1;
    return tl_bake_smaller(image, width, height);
}

/* Uploads cone maps. Each mip level is computed from the heights of its own resolution, because an average of
 * cones is not a bound. */
static tl_texture upload_cones(tl_gpu *gpu, const struct tl_height_field *field)
{
    tl_image full_size = shrunk(field->heights, TL_CONE_SIDE_MAX);
    tl_texture texture = tl_texture_create(gpu, GL_TEXTURE_2D, GL_RG8, full_size.width, full_size.height, 1,
                                           tl_texture_full_levels(full_size.width, full_size.height));
    glTextureParameteri(texture.id, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTextureParameteri(texture.id, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    for (int level = 0; level < texture.levels; level++) {
        int width = full_size.width >> level > 1 ? full_size.width >> level : 1;
        int height = full_size.height >> level > 1 ? full_size.height >> level : 1;
        tl_image small = tl_bake_smaller(&full_size, width, height);
        struct tl_height_field baked = *field;
        baked.heights = &small;
        tl_image cones = tl_bake_cones(&baked, (float)field->heights->width / (float)width);
        glTextureSubImage2D(texture.id, level, 0, 0, width, height, GL_RG, GL_UNSIGNED_BYTE, cones.texels);
        tl_image_release(&cones);
        tl_image_release(&small);
    }
    tl_image_release(&full_size);
    return texture;
}

/* Uploads the horizons of both sides of the sheet at all angles. */
static tl_texture upload_horizons(tl_gpu *gpu, const struct tl_detail_heights *heights, int angle_count)
{
    int layers = angle_count / 4;
    tl_image small = shrunk(&heights->image, TL_HORIZON_SIDE_MAX);
    const struct tl_height_field *sides[] = {&heights->field, &heights->back};
    tl_texture texture = tl_texture_create(gpu, GL_TEXTURE_2D_ARRAY, GL_RGBA8, small.width, small.height,
                                           2 * layers, tl_texture_full_levels(small.width, small.height));
    for (int side = 0; side < 2; side++) {
        struct tl_height_field baked = *sides[side];
        baked.heights = &small;
        struct tl_horizon_maps maps = tl_bake_horizons(&baked, angle_count);
        for (int i = 0; i < layers; i++)
            tl_texture_fill(&texture, side * layers + i, &maps.images[i], false);
        tl_horizon_maps_release(&maps);
    }
    tl_image_release(&small);
    return texture;
}

static void add_heights(struct tl_detail_entry *entry, tl_gpu *gpu, const struct tl_detail_params *params)
{
    struct tl_detail_heights heights;
    bool own_normals = tl_detail_has_own_normals(entry->material);
    if (!tl_detail_wants_heights(params) && !tl_detail_wants_horizons(params) && !own_normals)
        return;
    if (!tl_detail_heights_make(entry->material, entry->uv_metres, params->height_scale, &heights))
        return;
    entry->low_m = heights.field.low_m;
    entry->high_m = heights.field.high_m;
    memcpy(entry->rows, heights.rows, sizeof entry->rows);
    if (tl_detail_wants_heights(params))
        entry->textures[TL_DETAIL_HEIGHTS] = upload_heights(gpu, &heights.image);
    if (tl_detail_wants_cones(params))
        entry->textures[TL_DETAIL_CONES] = upload_cones(gpu, &heights.field);
    if (tl_detail_wants_horizons(params))
        entry->textures[TL_DETAIL_HORIZONS] = upload_horizons(gpu, &heights, tl_detail_angle_count(params));
    if (own_normals) {
        tl_image slopes = tl_bake_slopes(&heights.field), normals = tl_bake_normals(&slopes, 1);
        entry->textures[TL_DETAIL_OWN_MOMENTS] = upload_moments(gpu, &normals, params);
        tl_image_release(&slopes);
        tl_image_release(&normals);
    }
    entry->flags |= (heights.field.clamp_u ? FLAG_CLAMP_U : 0) | (heights.field.clamp_v ? FLAG_CLAMP_V : 0);
    for (int i = 0; i < TL_DETAIL_UNITS; i++)
        if (entry->textures[i].id)
            set_wrap(&entry->textures[i], heights.field.clamp_u, heights.field.clamp_v);
    tl_detail_heights_release(&heights);
}

static void add_moments(struct tl_detail_entry *entry, tl_gpu *gpu, const struct tl_detail_params *params)
{
    const struct tl_map *map = &entry->material->normal_map;
    const tl_weave *weave = entry->material->weave;
    if (map->image) {
        entry->textures[TL_DETAIL_OWN_MOMENTS] = upload_moments(gpu, map->image, params);
        set_wrap(&entry->textures[TL_DETAIL_OWN_MOMENTS], map->clamp_u, map->clamp_v);
    }
    if (weave && weave->normal.texels) {
        entry->textures[TL_DETAIL_WEAVE_MOMENTS] = upload_moments(gpu, &weave->normal, params);
        set_wrap(&entry->textures[TL_DETAIL_WEAVE_MOMENTS], false, false);
    }
}

static struct tl_detail_entry make_entry(tl_gpu *gpu, const tl_material *material, float uv_metres,
                                         const struct tl_detail_params *params)
{
    struct tl_detail_entry entry = {.material = material, .uv_metres = uv_metres};
    add_heights(&entry, gpu, params);
    if (tl_detail_wants_moments(params) || tl_detail_has_offsets(params))
        add_moments(&entry, gpu, params);
    for (int i = 0; i < TL_DETAIL_UNITS; i++)
        entry.flags |= entry.textures[i].id ? unit_flags[i] : 0;
    return entry;
}

static bool check_size(tl_gpu *gpu, const tl_surface *surface, const tl_material *material, tl_error *error)
{
    const tl_image *image = material->height_map.image;
    int limit = tl_gpu_texture_side_max(gpu);
    if (image && (image->width > limit || image->height > limit))
        return tl_fail(error, TL_INPUT,
                       "%s: a height map of %d x %d texels is larger than GL holds: scale it to %d",
                       surface->name, image->width, image->height, limit);
    return true;
}

static int entry_for(struct tl_detail_maps *maps, tl_gpu *gpu, const tl_material *material, float uv_metres)
{
    if (!tl_detail_wants_maps(&maps->params, material))
        return -1;
    for (size_t i = 0; i < maps->entry_count; i++)
        if (same_detail(&maps->entries[i], material, uv_metres))
            return (int)i;
    maps->entries = tl_resize(maps->entries, maps->entry_count + 1, sizeof *maps->entries);
    maps->entries[maps->entry_count] = make_entry(gpu, material, uv_metres, &maps->params);
    return (int)maps->entry_count++;
}

bool tl_detail_maps_make(struct tl_detail_maps *maps, tl_gpu *gpu, const tl_surface *const *surfaces,
                         size_t count, const struct tl_detail_params *params, tl_error *error)
{
    tl_detail_maps_release(maps);
    maps->params = *params;
    maps->surface_count = count;
    maps->first_parts = TL_NEW_ARRAY(size_t, count);
    for (size_t s = 0; s < count; s++) {
        maps->first_parts[s] = maps->part_count;
        maps->part_count += surfaces[s]->part_count;
    }
    maps->entry_of_part = TL_NEW_ARRAY(int, maps->part_count);
    for (size_t s = 0; s < count; s++)
        for (size_t p = 0; p < surfaces[s]->part_count; p++) {
            const struct tl_mesh_part *part = &surfaces[s]->parts[p];
            const tl_material *material = &surfaces[s]->materials[part->material];
            if (!check_size(gpu, surfaces[s], material, error)) {
                tl_detail_maps_release(maps);
                return false;
            }
            maps->entry_of_part[maps->first_parts[s] + p] = entry_for(maps, gpu, material, part->uv_metres);
        }
    return true;
}

void tl_detail_maps_release(struct tl_detail_maps *maps)
{
    for (size_t i = 0; i < maps->entry_count; i++)
        for (int unit = 0; unit < TL_DETAIL_UNITS; unit++)
            tl_texture_destroy(&maps->entries[i].textures[unit]);
    free(maps->entries);
    free(maps->entry_of_part);
    free(maps->first_parts);
    maps->entries = NULL;
    maps->entry_of_part = NULL;
    maps->first_parts = NULL;
    maps->surface_count = maps->part_count = maps->entry_count = 0;
}

static const struct tl_detail_entry *entry_of(const struct tl_detail_maps *maps, size_t surface, size_t part)
{
    if (!maps || surface >= maps->surface_count)
        return NULL;
    size_t number = maps->first_parts[surface] + part;
    int entry = number < maps->part_count ? maps->entry_of_part[number] : -1;
    return entry >= 0 ? &maps->entries[entry] : NULL;
}

void tl_detail_maps_bind(const struct tl_detail_maps *maps, size_t surface, size_t part, float uv_metres,
                         int first_location, int first_unit)
{
    static const struct tl_detail_entry none;
    const struct tl_detail_entry *entry = entry_of(maps, surface, part);
    float scale = maps ? maps->params.height_scale : 1;
    entry = entry ? entry : &none;
    glUniform1i(first_location + TL_DETAIL_FLAGS, entry->flags);
    glUniform4f(first_location + TL_DETAIL_RANGE, entry->low_m, entry->high_m, uv_metres, scale);
    glUniform3fv(first_location + TL_DETAIL_ROWS, 2, entry->rows);
    if (maps)
        glUniform2i(first_location + TL_DETAIL_STEPS, maps->params.steps, maps->params.refine);
    for (int i = 0; i < TL_DETAIL_UNITS; i++) /* also of missing maps: see set_material in surfaces.c */
        glBindTextureUnit((GLuint)(first_unit + i), entry->textures[i].id);
}

size_t tl_detail_maps_bytes(const struct tl_detail_maps *maps)
{
    size_t bytes = 0;
    for (size_t i = 0; i < maps->entry_count; i++)
        for (int unit = 0; unit < TL_DETAIL_UNITS; unit++)
            bytes += tl_texture_bytes(&maps->entries[i].textures[unit]);
    return bytes;
}
