#include "render/light/transparency.h"

#include "config/base/memory.h"
#include "render/brdf/material_lobes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool tl_material_shows_more(const tl_material *material)
{
    return material->openness > 0 || tl_material_transmits(material);
}

static const tl_material *material_of(const struct tl_transparency_request *request, const tl_sample *sample)
{
    return tl_triangle_material(request->ranges, sample->triangle & ~TL_SAMPLE_BACK);
}

static void reserve_shares(struct tl_transparency *transparency, size_t count)
{
    if (count <= transparency->share_capacity)
        return;
    transparency->share_capacity = tl_room_for(count, transparency->share_capacity);
    transparency->shares = tl_resize(transparency->shares, transparency->share_capacity, sizeof(float));
}

/* Gives sample `index` its own part of the weight `through` that reaches it, and records whether a layer lies
 * behind it. Returns whether one does. */
static bool share_out(struct tl_transparency *transparency, const struct tl_transparency_request *request,
                      const struct tl_samples *samples, size_t index, float through, bool last)
{
    const tl_sample *sample = &samples->items[index];
    float openness = last ? 0 : material_of(request, sample)->openness;
    transparency->shares[index] = through * sample->cover * (1 - openness);
    transparency->opens[sample->texel] = openness > 0 ? (uint32_t)index + 1 : 0;
    return openness > 0;
}

static bool share_out_primary(struct tl_transparency *transparency,
                              const struct tl_transparency_request *request, const struct tl_samples *samples)
{
    size_t texel_count = (size_t)samples->width * (size_t)samples->height;
    bool more = false;
    if (texel_count > transparency->open_capacity) {
        free(transparency->opens);
        transparency->opens = TL_NEW_ARRAY(uint32_t, texel_count);
        transparency->open_capacity = texel_count;
    }
    memset(transparency->opens, 0, texel_count * sizeof *transparency->opens);
    reserve_shares(transparency, samples->primary_count);
    for (size_t i = 0; i < samples->primary_count; i++)
        more |= share_out(transparency, request, samples, i, 1, false);
    return more;
}

static size_t append(struct tl_samples *samples, const tl_sample *sample)
{
    size_t index = samples->count++;
    tl_samples_reserve(samples, samples->count);
    samples->items[index] = *sample;
    return index;
}

/* Adds the samples of the next layer where the last one is open. Returns whether some of them are open again.
 */
static bool append_behind(struct tl_transparency *transparency, const struct tl_transparency_request *request,
                          bool last, struct tl_samples *samples)
{
    const struct tl_samples *found = &transparency->nearer;
    bool more = false;
    for (size_t i = 0; i < found->count; i++) {
        uint32_t parent = transparency->opens[found->items[i].texel];
        if (parent == 0)
            continue;
        const tl_sample *before = &samples->items[parent - 1];
        float openness = material_of(request, before)->openness;
        float through = transparency->shares[parent - 1] * openness / (before->cover * (1 - openness));
        size_t index = append(samples, &found->items[i]);
        reserve_shares(transparency, samples->count);
        more |= share_out(transparency, request, samples, index, through, last);
        samples->behind_count++;
    }
    return more;
}

static bool gather_behind(struct tl_transparency *transparency, tl_gpu *gpu,
                          const struct tl_transparency_request *request, struct tl_samples *samples,
                          tl_error *error)
{
    struct tl_gbuffer_request draw = request->draw;
    bool more = true;
    draw.passed = &request->gbuffer->target.depth;
    for (int layer = 1; more && layer <= TL_TRANSPARENCY_LAYERS; layer++) {
        if (!tl_gbuffer_draw(&transparency->behind, gpu, &draw, error))
            return false;
        tl_samples_read(&transparency->behind, request->ranges, draw.view->eye, &transparency->nearer);
        more = append_behind(transparency, request, layer == TL_TRANSPARENCY_LAYERS, samples);
        if (more) {
            tl_gbuffer_keep_depth(&transparency->behind, gpu, &transparency->passed);
            draw.passed = &transparency->passed;
        }
    }
    return true;
}

/* The other side of a layer, where it is lit by what it lets through. */
static tl_sample other_side(const tl_sample *sample, const tl_material *material, vec3s eye)
{
    const struct tl_material_sample seen = {.material = material,
                                            .smooth = sample->smooth,
                                            .normal = sample->normal,
                                            .viewer = glms_vec3_normalize(glms_vec3_sub(eye, sample->point))};
    tl_sample other = *sample;
    other.triangle ^= TL_SAMPLE_BACK;
    other.normal = glms_vec3_negate(sample->normal);
    other.smooth = glms_vec3_negate(sample->smooth);
    other.mirror = other.normal;
    other.glossiness = 0;
    other.diffuse = glms_vec3_scale(material->transmission, tl_material_base(&seen));
    other.specular = (vec3s){{0, 0, 0}};
    return other;
}

static void append_other_sides(struct tl_transparency *transparency,
                               const struct tl_transparency_request *request, struct tl_samples *samples)
{
    size_t count = samples->count;
    for (size_t i = 0; i < count; i++) {
        const tl_material *material = material_of(request, &samples->items[i]);
        if (!tl_material_transmits(material))
            continue;
        tl_sample other = other_side(&samples->items[i], material, request->draw.view->eye);
        size_t index = append(samples, &other);
        reserve_shares(transparency, samples->count);
        transparency->shares[index] = transparency->shares[i];
        samples->other_count++;
    }
}

bool tl_transparency_find(struct tl_transparency *transparency, tl_gpu *gpu,
                          const struct tl_transparency_request *request, struct tl_samples *samples,
                          tl_error *error)
{
    samples->count = samples->primary_count;
    samples->behind_count = samples->other_count = 0;
    if (share_out_primary(transparency, request, samples) &&
        !gather_behind(transparency, gpu, request, samples, error))
        return false;
    append_other_sides(transparency, request, samples);
    return true;
}

void tl_transparency_release(struct tl_transparency *transparency)
{
    tl_gbuffer_release(&transparency->behind);
    tl_texture_destroy(&transparency->passed);
    tl_samples_release(&transparency->nearer);
    free(transparency->opens);
    free(transparency->shares);
    *transparency = (struct tl_transparency){0};
}

size_t tl_transparency_bytes(const struct tl_transparency *transparency)
{
    return tl_gbuffer_bytes(&transparency->behind) + tl_texture_bytes(&transparency->passed) +
           transparency->nearer.capacity * sizeof(tl_sample) + transparency->nearer.staging_bytes +
           transparency->open_capacity * sizeof *transparency->opens +
           transparency->share_capacity * sizeof *transparency->shares;
}
