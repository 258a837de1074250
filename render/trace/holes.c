#include "render/trace/holes.h"

#include "config/base/memory.h"

#include <math.h>
#include <string.h>

struct words {
    uint32_t *items;
    size_t count;
};

static uint32_t *add(struct words *words, size_t count)
{
    words->items = tl_resize(words->items, words->count + count, sizeof *words->items);
    uint32_t *added = words->items + words->count;
    memset(added, 0, count * sizeof *added);
    words->count += count;
    return added;
}

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static bool has_holes(const tl_surface *surface, const tl_material *material)
{
    const tl_image *image = material->diffuse_map.image;
    return material->alpha_cutoff > 0 && surface->uvs && image &&
           (image->channels == 2 || image->channels == 4);
}

/* Adds the alpha of a map. Returns its first word. */
static uint32_t add_image(struct words *words, const struct tl_map *map)
{
    const tl_image *image = map->image;
    const size_t texels = (size_t)image->width * (size_t)image->height, channels = (size_t)image->channels;
    const uint32_t first = (uint32_t)words->count;
    uint32_t *to = add(words, 3 + (texels + 3) / 4);
    to[0] = (uint32_t)image->width;
    to[1] = (uint32_t)image->height;
    to[2] = (map->clamp_u ? 1u : 0) | (map->clamp_v ? 2u : 0);
    for (size_t i = 0; i < texels; i++) {
        const size_t at = i * channels + channels - 1;
        const uint32_t alpha = image->type == TL_IMAGE_U8
                                   ? tl_image_bytes(image)[at]
                                   : (uint32_t)lroundf(255 * fminf(fmaxf(tl_image_floats(image)[at], 0), 1));
        to[3 + i / 4] |= alpha << 8 * (i % 4);
    }
    return first;
}

/* [8] */
static void fill_record(const tl_surface *surface, size_t triangle, const tl_material *material,
                        uint32_t image, uint32_t *to)
{
    const struct tl_map *map = &material->diffuse_map;
    to[0] = image;
    to[1] = bits_of(material->alpha_cutoff);
    for (size_t k = 0; k < 3; k++) {
        const vec2s at = tl_uv_transformed(&map->transform, surface->uvs[surface->indices[3 * triangle + k]]);
        to[2 + 2 * k] = bits_of(at.x * (float)map->image->width - 0.5f);
        to[3 + 2 * k] = bits_of(at.y * (float)map->image->height - 0.5f);
    }
}

uint32_t *tl_holes_make(const tl_surface *const *surfaces, size_t surface_count, size_t *count)
{
    struct words words = {0};
    size_t triangles = 0, surface_first = 0;
    for (size_t s = 0; s < surface_count; s++)
        triangles += surfaces[s]->index_count / 3;
    add(&words, 1 + triangles);
    for (size_t s = 0; s < surface_count; surface_first += surfaces[s]->index_count / 3, s++) {
        const tl_surface *surface = surfaces[s];
        for (size_t p = 0; p < surface->part_count; p++) {
            const struct tl_mesh_part *part = &surface->parts[p];
            const tl_material *material = &surface->materials[part->material];
            if (!has_holes(surface, material))
                continue;
            const uint32_t image = add_image(&words, &material->diffuse_map);
            const size_t begin = part->first_index / 3, all = part->index_count / 3, first = words.count;
            add(&words, 8 * all);
            words.items[0] = (uint32_t)triangles;
            for (size_t t = 0; t < all; t++) {
                words.items[1 + surface_first + begin + t] = (uint32_t)(first + 8 * t);
                fill_record(surface, begin + t, material, image, words.items + first + 8 * t);
            }
        }
    }
    *count = words.items[0] > 0 ? words.count : 1;
    return words.items;
}
