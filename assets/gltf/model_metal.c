/* Metalness that varies over a texture: the colours of both lobes become maps of their own. */
#include "assets/gltf/model_internal.h"
#include "config/base/memory.h"
#include "config/colour/srgb.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The texel of an image at the place of a texel of a larger one; white without an image. */
static const uint8_t *texel_at(const tl_image *image, const tl_image *of, size_t texel)
{
    static const uint8_t white[4] = {255, 255, 255, 255};
    if (!image)
        return white;
    size_t x = texel % (size_t)of->width * (size_t)image->width / (size_t)of->width;
    size_t y = texel / (size_t)of->width * (size_t)image->height / (size_t)of->height;
    return tl_image_bytes(image) + (y * (size_t)image->width + x) * (size_t)image->channels;
}

/* Converts linear to sRGB by a table, 65,536 steps of which the darkest byte has twenty. */
#define STEPS 65535

static uint8_t *srgb_table(void)
{
    uint8_t *table = TL_NEW_ARRAY(uint8_t, STEPS + 1);
    for (int i = 0; i <= STEPS; i++)
        table[i] = (uint8_t)lrintf(255 * tl_srgb_from_linear((float)i / STEPS));
    return table;
}

static uint8_t encoded(const uint8_t *table, float linear)
{
    return table[lrintf(STEPS * fminf(fmaxf(linear, 0), 1))];
}

/* Both maps must lie on the surface alike to be combined texel by texel. */
static bool lie_alike(const struct tl_map *a, const struct tl_map *b)
{
    return memcmp(&a->transform, &b->transform, sizeof a->transform) == 0 && a->clamp_u == b->clamp_u &&
           a->clamp_v == b->clamp_v;
}

bool model_bake_metal(const struct material_build *build, float factor, vec3s f0)
{
    tl_material *to = build->to;
    tl_model *model = build->model;
    struct tl_map metal = {0};
    const tl_image *base = to->diffuse_map.image;
    texture_read_map(build->textures, &build->from->metallic_roughness_map, TEXTURE_METAL, 0, &metal);
    if (!metal.image || to->specular_map.image ||
        (base && (base->channels < 3 || !lie_alike(&to->diffuse_map, &metal))))
        return false;
    const tl_image *larger = base && base->width > metal.image->width ? base : metal.image;
    size_t texels = (size_t)larger->width * (size_t)larger->height,
           channels = base && base->channels == 4 ? 4 : 3;
    tl_image *diffuse = &model->images[model->image_count++],
             *specular = &model->images[model->image_count++];
    *diffuse = tl_image_create(larger->width, larger->height, (int)channels, TL_IMAGE_U8);
    *specular = tl_image_create(larger->width, larger->height, 3, TL_IMAGE_U8);
    uint8_t *table = srgb_table();
    float linear[256];
    for (int i = 0; i < 256; i++)
        linear[i] = tl_srgb_to_linear((float)i / 255);
    for (size_t i = 0; i < texels; i++) {
        const uint8_t *colour = texel_at(base, larger, i);
        float m = factor * (float)*texel_at(metal.image, larger, i) / 255;
        for (size_t c = 0; c < 3; c++) {
            float own = build->base[c] * linear[colour[c]];
            tl_image_bytes(diffuse)[channels * i + c] = encoded(table, own * (1 - m));
            tl_image_bytes(specular)[3 * i + c] = encoded(table, f0.raw[c] * (1 - m) + own * m);
        }
        if (channels == 4)
            tl_image_bytes(diffuse)[4 * i + 3] = colour[3];
    }
    free(table);
    metal.image = specular;
    to->specular_map = metal;
    to->diffuse_map = metal;
    to->diffuse_map.image = diffuse;
    to->diffuse = to->specular = (vec3s){{1, 1, 1}};
    return true;
}
