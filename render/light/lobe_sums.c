#include "render/light/lobe_sums.h"

#include "config/base/memory.h"
#include "render/light/compose.h"

#include <epoxy/gl.h>

#include <stdlib.h>
#include <string.h>

#define LAYERS    2 /* of a lobe */
#define CHANNELS  4
#define BYTES_MAX ((size_t)512 << 20) /* of the texture: fewer lobes are kept in a larger image */

static const tl_material *material_of(const struct tl_lobe_sums_request *request, const tl_sample *sample)
{
    return tl_triangle_material(request->ranges, sample->triangle & ~TL_SAMPLE_BACK);
}

/* The most lobes that a sample of the surfaces can have. */
static int most_lobes(const struct tl_lobe_sums_request *request)
{
    int most = 1;
    for (size_t s = 0; s < request->ranges->surface_count; s++) {
        const tl_surface *surface = request->ranges->surfaces[s];
        for (size_t p = 0; p < surface->part_count; p++) {
            const tl_material *material = &surface->materials[surface->parts[p].material];
            const int lobes = (1 + material->thread_count) * request->max_count;
            if (material->gloss.model != TL_REFLECT_PHONG && lobes > most)
                most = lobes;
        }
    }
    return most < TL_LOBE_SUMS_MAX ? most : TL_LOBE_SUMS_MAX;
}

static int count_layers(const struct tl_lobe_sums_request *request)
{
    const size_t texels = (size_t)request->samples->width * (size_t)request->samples->height;
    const int fit = (int)(BYTES_MAX / (sizeof(uint16_t) * LAYERS * CHANNELS) / (texels + 1));
    const int most = most_lobes(request);
    return LAYERS * (most < fit ? most : fit > 1 ? fit : 1);
}

static int by_weight(const void *a, const void *b)
{
    const float first = glms_vec3_max(((const struct tl_fitted_lobe *)a)->weight);
    const float second = glms_vec3_max(((const struct tl_fitted_lobe *)b)->weight);
    return (first < second) - (first > second);
}

/* Writes the lobes of a sample into its texel of each layer; the lightest ones are left out where there are
 * too many. A sample that reflects nothing has one of weight 0. */
static void write_sample(const struct tl_lobe_sums_request *request, const tl_sample *sample, int count,
                         float *texels)
{
    const size_t layer = CHANNELS * (size_t)request->samples->width * (size_t)request->samples->height;
    const tl_material *material = material_of(request, sample);
    struct tl_fitted_lobe lobes[TL_LOBE_FIT_SUM_MAX] = {{.direction = sample->normal, .exponent = 1}};
    if (material->gloss.model == TL_REFLECT_PHONG)
        return;
    /* Passes do not draw coat and fuzz, which take nothing from these. */
    const struct tl_material_sample seen =
        tl_sample_material(sample, material, request->ranges, request->eye);
    const int fitted = tl_material_gloss_fit(&seen, request->max_count, lobes);
    if (fitted > count)
        qsort(lobes, (size_t)fitted, sizeof *lobes, by_weight);
    for (int k = 0; k < count && (k == 0 || k < fitted); k++) {
        const struct tl_fitted_lobe *lobe = &lobes[k];
        float *place = texels + LAYERS * (size_t)k * layer + CHANNELS * (size_t)sample->texel,
              *weight = place + layer;
        memcpy(place, lobe->direction.raw, sizeof lobe->direction);
        memcpy(weight, lobe->weight.raw, sizeof lobe->weight);
        place[3] = 1 / lobe->exponent;
        weight[3] = 1;
    }
}

static void allocate(struct tl_lobe_sums *sums, tl_gpu *gpu, int width, int height, int layers)
{
    tl_texture *texture = &sums->lobes;
    if (texture->width == width && texture->height == height && texture->layers == layers)
        return;
    tl_texture_destroy(texture);
    *texture = tl_texture_create(gpu, GL_TEXTURE_2D_ARRAY, GL_RGBA16F, width, height, layers, 1);
}

void tl_lobe_sums_make(struct tl_lobe_sums *sums, tl_gpu *gpu, const struct tl_lobe_sums_request *request)
{
    const struct tl_samples *samples = request->samples;
    const int layers = count_layers(request);
    float *texels =
        TL_NEW_ARRAY(float, CHANNELS *(size_t)layers *(size_t)samples->width *(size_t)samples->height);
    sums->count = layers / LAYERS;
#pragma omp parallel for schedule(dynamic, 64)
    for (size_t i = 0; i < samples->primary_count; i++)
        write_sample(request, &samples->items[i], sums->count, texels);
    allocate(sums, gpu, samples->width, samples->height, layers);
    glTextureSubImage3D(sums->lobes.id, 0, 0, 0, 0, samples->width, samples->height, layers, GL_RGBA,
                        GL_FLOAT, texels);
    free(texels);
}

void tl_lobe_sums_release(struct tl_lobe_sums *sums)
{
    tl_texture_destroy(&sums->lobes);
}

size_t tl_lobe_sums_bytes(const struct tl_lobe_sums *sums)
{
    return tl_texture_bytes(&sums->lobes);
}
