#include "render/light/sheets.h"

#include "config/memory.h"
#include "render/brdf/coat.h"
#include "render/renderer.h"

#include <epoxy/gl.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool tl_material_shows_more(const tl_material *material)
{
    return material->openness > 0 || tl_material_transmits(material);
}

static const tl_material *material_of(const struct tl_sheets_request *request, const tl_sample *sample)
{
    return tl_triangle_material(request->ranges, sample->triangle & ~TL_SAMPLE_BACK);
}

static void reserve_shares(struct tl_sheets *sheets, size_t count)
{
    if (count <= sheets->share_capacity)
        return;
    sheets->share_capacity = count + count / 4;
    sheets->shares = tl_resize(sheets->shares, sheets->share_capacity, sizeof(float));
}

/* What reaches sample `index` is `through`; it keeps its part of that, and notes when there is more behind.
 * Returns whether there is. */
static bool share_out(struct tl_sheets *sheets, const struct tl_sheets_request *request,
                      const struct tl_samples *samples, size_t index, float through, bool last)
{
    const tl_sample *sample = &samples->items[index];
    float openness = last ? 0 : material_of(request, sample)->openness;
    sheets->shares[index] = through * sample->cover * (1 - openness);
    sheets->opens[sample->texel] = openness > 0 ? (uint32_t)index + 1 : 0;
    return openness > 0;
}

static bool share_out_primary(struct tl_sheets *sheets, const struct tl_sheets_request *request,
                              const struct tl_samples *samples)
{
    size_t texel_count = (size_t)samples->width * (size_t)samples->height;
    bool more = false;
    if (texel_count > sheets->open_capacity) {
        free(sheets->opens);
        sheets->opens = TL_NEW_ARRAY(uint32_t, texel_count);
        sheets->open_capacity = texel_count;
    }
    memset(sheets->opens, 0, texel_count * sizeof *sheets->opens);
    reserve_shares(sheets, samples->primary_count);
    for (size_t i = 0; i < samples->primary_count; i++)
        more |= share_out(sheets, request, samples, i, 1, false);
    return more;
}

static size_t append(struct tl_samples *samples, const tl_sample *sample, const vec4s *tangent)
{
    size_t index = samples->count++;
    tl_samples_reserve(samples, samples->count);
    samples->items[index] = *sample;
    if (samples->tangents)
        samples->tangents[index] = tangent ? *tangent : (vec4s){{0, 0, 0, 1}};
    return index;
}

/* What the next sheet shows where the last one is open. Returns whether some of that is open again. */
static bool append_behind(struct tl_sheets *sheets, const struct tl_sheets_request *request, bool last,
                          struct tl_samples *samples)
{
    const struct tl_samples *found = &sheets->nearer;
    bool more = false;
    for (size_t i = 0; i < found->count; i++) {
        uint32_t parent = sheets->opens[found->items[i].texel];
        if (parent == 0)
            continue;
        const tl_sample *before = &samples->items[parent - 1];
        float openness = material_of(request, before)->openness;
        float through = sheets->shares[parent - 1] * openness / (before->cover * (1 - openness));
        size_t index = append(samples, &found->items[i], found->tangents ? &found->tangents[i] : NULL);
        reserve_shares(sheets, samples->count);
        more |= share_out(sheets, request, samples, index, through, last);
        samples->behind_count++;
    }
    return more;
}

/* Keeps the depth that the next sheet must lie behind. */
static const tl_texture *pass(struct tl_sheets *sheets, tl_gpu *gpu)
{
    const tl_texture *depth = &sheets->behind.target.depth;
    if (sheets->passed.width != depth->width || sheets->passed.height != depth->height) {
        tl_texture_destroy(&sheets->passed);
        sheets->passed =
            tl_texture_create(gpu, GL_TEXTURE_2D, depth->format, depth->width, depth->height, 1, 1);
    }
    glCopyImageSubData(depth->id, GL_TEXTURE_2D, 0, 0, 0, 0, sheets->passed.id, GL_TEXTURE_2D, 0, 0, 0, 0,
                       depth->width, depth->height, 1);
    return &sheets->passed;
}

static bool look_behind(struct tl_sheets *sheets, tl_gpu *gpu, const struct tl_sheets_request *request,
                        struct tl_samples *samples, tl_error *error)
{
    struct tl_gbuffer_request draw = request->draw;
    bool more = true;
    draw.passed = &request->gbuffer->target.depth;
    for (int sheet = 1; more && sheet <= TL_SHEETS_BEHIND; sheet++) {
        if (!tl_gbuffer_draw(&sheets->behind, gpu, &draw, error))
            return false;
        tl_samples_read(&sheets->behind, request->ranges, draw.view->eye, &sheets->nearer);
        more = append_behind(sheets, request, sheet == TL_SHEETS_BEHIND, samples);
        if (more)
            draw.passed = pass(sheets, gpu);
    }
    return true;
}

/* The other side of a sheet, where it is lit by what it lets through. */
static tl_sample other_side(const tl_sample *sample, const tl_material *material, vec3s eye)
{
    vec3s view = glms_vec3_normalize(glms_vec3_sub(eye, sample->point));
    float coat = material->coat * tl_coat_reflectance(fmaxf(glms_vec3_dot(sample->smooth, view), 0));
    tl_sample other = *sample;
    other.triangle ^= TL_SAMPLE_BACK;
    other.normal = glms_vec3_negate(sample->normal);
    other.smooth = glms_vec3_negate(sample->smooth);
    other.mirror = other.normal;
    other.glossiness = 0;
    other.diffuse = glms_vec3_scale(material->transmission, 1 - coat);
    other.specular = (vec3s){{0, 0, 0}};
    return other;
}

static void append_other_sides(struct tl_sheets *sheets, const struct tl_sheets_request *request,
                               struct tl_samples *samples)
{
    size_t count = samples->count;
    for (size_t i = 0; i < count; i++) {
        const tl_material *material = material_of(request, &samples->items[i]);
        if (!tl_material_transmits(material))
            continue;
        tl_sample other = other_side(&samples->items[i], material, request->draw.view->eye);
        size_t index = append(samples, &other, NULL);
        reserve_shares(sheets, samples->count);
        sheets->shares[index] = sheets->shares[i];
        samples->other_count++;
    }
}

bool tl_sheets_find(struct tl_sheets *sheets, tl_gpu *gpu, const struct tl_sheets_request *request,
                    struct tl_samples *samples, tl_error *error)
{
    samples->count = samples->primary_count;
    samples->behind_count = samples->other_count = 0;
    if (share_out_primary(sheets, request, samples) && !look_behind(sheets, gpu, request, samples, error))
        return false;
    append_other_sides(sheets, request, samples);
    return true;
}

void tl_sheets_release(struct tl_sheets *sheets)
{
    tl_gbuffer_release(&sheets->behind);
    tl_texture_destroy(&sheets->passed);
    tl_samples_release(&sheets->nearer);
    free(sheets->opens);
    free(sheets->shares);
    *sheets = (struct tl_sheets){0};
}

size_t tl_sheets_bytes(const struct tl_sheets *sheets)
{
    return tl_gbuffer_bytes(&sheets->behind) + tl_texture_bytes(&sheets->passed) +
           sheets->nearer.capacity * sizeof(tl_sample) + sheets->nearer.staging_bytes +
           sheets->open_capacity * sizeof *sheets->opens + sheets->share_capacity * sizeof *sheets->shares;
}
