#include "render/bounce/bounce_internal.h"

#include "config/base/memory.h"
#include "config/colour/srgb.h"
#include "render/brdf/material_lobes.h"
#include "render/env/exponent.h"

#include <math.h>

static vec3s mean_colour(const struct tl_map *map, vec3s colour)
{
    const tl_image *image = map->image;
    if (!image || image->type != TL_IMAGE_U8 || image->channels < 3)
        return colour;
    const size_t maximum = 4096, count = (size_t)image->width * (size_t)image->height;
    const size_t step = count / maximum + 1;
    double sums[3] = {0};
    size_t taken = 0;
    for (size_t i = 0; i < count; i += step, taken++)
        for (int c = 0; c < 3; c++)
            sums[c] += (double)tl_srgb_to_linear(
                (float)((const uint8_t *)image->texels)[i * (size_t)image->channels + (size_t)c] / 255);
    for (int c = 0; c < 3 && taken > 0; c++)
        colour.raw[c] *= (float)(sums[c] / (double)taken);
    return colour;
}

/* Limit of a material that reflects more than it receives: light between two of them would grow for ever.
 */
#define ALBEDO_MAX 0.98f

/* All light that a surface sends back in even light: matt, and the mean over all directions of Schlick's
 * reflectance; without what a lobe of exponent s about the mirrored view has below the horizon: 1 / (2 s + 4)
 * in the mean over views by their cosine. (At s = 1, where a view at angle a loses (1 - cos a) / 2, it is
 * 1/6; at 2, 4, 10, 30 and 100 sampling agrees within 1e-4.) */
static vec3s albedo_of(vec3s diffuse, vec3s specular, float glossiness)
{
    vec3s albedo;
    float above = 1 - 1 / (2 * tl_lobe_exponent(glossiness) + 4);
    for (int c = 0; c < 3; c++) {
        float f0 = specular.raw[c];
        float gloss = f0 > 0 ? above * (f0 + (1 - f0) / 21) : 0;
        albedo.raw[c] = fminf(diffuse.raw[c] + gloss, ALBEDO_MAX);
    }
    return albedo;
}

static struct tl_bounce_material material_of(const tl_material *material)
{
    const struct tl_back *back = &material->back;
    const float matt = matt_albedo_mean(tl_material_law(material));
    const vec3s front = glms_vec3_scale(mean_colour(&material->diffuse_map, material->diffuse), matt);
    struct tl_bounce_material read = {
        .diffuse = {front, back->is_given ? glms_vec3_scale(back->diffuse, matt) : front},
        .specular[0] = mean_colour(&material->specular_map, material->specular),
        .emission = mean_colour(&material->emission_map, material->emission),
        .openness = material->openness,
    };
    read.specular[1] = back->is_given ? back->specular : read.specular[0];
    for (int side = 0; side < 2; side++) {
        const vec3s coloured = side && back->is_given
                                   ? back->diffuse
                                   : mean_colour(&material->diffuse_map, tl_material_colour(material));
        read.has_lobes = read.has_lobes || glms_vec3_max(read.specular[side]) > glms_vec3_max(coloured);
        read.whole[side] =
            albedo_of(glms_vec3_scale(coloured, matt), read.specular[side], material->glossiness);
    }
    for (int side = 0; side < 2; side++)
        read.albedo[side] =
            read.has_lobes ? glms_vec3_minv(read.diffuse[side], read.whole[side]) : read.whole[side];
    const vec3s maximum = glms_vec3_maxv(read.whole[0], read.whole[1]);
    read.transmission =
        glms_vec3_minv(material->transmission, glms_vec3_subs(glms_vec3_negate(maximum), -ALBEDO_MAX));
    return read;
}

struct tl_bounce_material *tl_bounce_materials_read(const struct tl_triangle_ranges *ranges)
{
    size_t count = 0, at = 0;
    for (size_t s = 0; s < ranges->surface_count; s++)
        count += ranges->surfaces[s]->part_count;
    struct tl_bounce_material *materials = TL_NEW_ARRAY(struct tl_bounce_material, count);
    for (size_t s = 0; s < ranges->surface_count; s++)
        for (size_t p = 0; p < ranges->surfaces[s]->part_count; p++, at++)
            materials[at] =
                material_of(&ranges->surfaces[s]->materials[ranges->surfaces[s]->parts[p].material]);
    return materials;
}
