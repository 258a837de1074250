#include "render/local/lamp_samples.h"

#include "config/base/memory.h"
#include "render/brdf/tables/measured.h"
#include "render/env/exponent.h"
#include "render/light/compose.h"
#include "render/trace/cutout.h"

#include <math.h>
#include <stdlib.h>

/* The material of a sample for lamps. */
struct lit {
    const tl_sample *sample;
    const tl_material *material;
    bool has_two; /* nothing but its two lobes; else: */
    struct tl_material_lobes lobes;
};

static struct lit lit_of(const struct tl_lamp_samples_request *request, size_t index)
{
    const struct tl_samples *samples = request->samples;
    const tl_sample *sample = &samples->items[index];
    struct lit lit = {.sample = sample,
                      .material = tl_triangle_material(request->ranges, sample->triangle & ~TL_SAMPLE_BACK),
                      /* Samples on other sides are diffuse and include their coat already. */
                      .has_two = index >= samples->primary_count + samples->behind_count};
    if (lit.has_two)
        return lit;
    const struct tl_material_sample seen =
        tl_sample_material(sample, lit.material, request->ranges, request->eye);
    lit.lobes = tl_material_lobes_of(&seen);
    return lit;
}

static vec3s reflected(const struct lit *lit, vec3s l)
{
    const tl_sample *sample = lit->sample;
    const float lambert = fmaxf(glms_vec3_dot(sample->normal, l), 0) / (float)M_PI;
    const float matt = lit->has_two ? lambert : lambert * material_matt(lit->lobes.over, l);
    const float shine =
        tl_lobe_cosine(tl_lobe_exponent(sample->glossiness), glms_vec3_dot(sample->mirror, l));
    const vec3s gloss = lit->lobes.is_faceted ? tl_material_facets(&lit->lobes, l, 0)
                                              : glms_vec3_scale(sample->specular, shine);
    const vec3s sent = glms_vec3_add(glms_vec3_scale(sample->diffuse, matt), gloss);
    if (lit->has_two)
        return sent;
    const struct tl_measured *measured = lit->material->measured;
    return material_over(
        lit->lobes.over,
        measured ? tl_measured_reflected(measured, &lit->lobes.frame, l, lit->lobes.over.viewer) : sent, l,
        0);
}

/* The order of local.frag: emission times its map, below the coat. */
static vec3s emitted(const struct tl_lamp_samples_request *request, const struct lit *lit)
{
    uint32_t corners[3];
    size_t index;
    const tl_surface *surface =
        tl_triangle_find(request->ranges, lit->sample->triangle & ~TL_SAMPLE_BACK, corners, &index);
    vec2s uv = {{0, 0}};
    for (int i = 0; surface->uvs && i < 3; i++)
        uv = glms_vec2_add(uv, glms_vec2_scale(surface->uvs[corners[i]], lit->sample->weights[i]));
    vec3s colour = tl_map_colour_at(&lit->material->emission_map, uv);
    return glms_vec3_scale(glms_vec3_mul(lit->material->emission, colour),
                           lit->has_two ? 1 : lit->lobes.over.base);
}

static vec3s light_of_sample(const struct tl_lamp_samples_request *request, size_t index)
{
    const struct lit lit = lit_of(request, index);
    const struct tl_samples *samples = request->samples;
    bool is_other_side =
        index >= samples->primary_count + samples->behind_count && index < tl_samples_seen(samples);
    vec3s sum =
        is_other_side || !tl_material_emits(lit.material) ? (vec3s){{0, 0, 0}} : emitted(request, &lit);
    for (size_t i = 0; i < request->lamp_count; i++) {
        vec3s l;
        vec3s arriving = tl_lamp_irradiance_at(&request->lamps[i], request->shadowed ? request->trace : NULL,
                                               lit.sample, request->ranges, request->ground, &l);
        if (!(arriving.x > 0 || arriving.y > 0 || arriving.z > 0))
            continue;
        sum = glms_vec3_add(sum, glms_vec3_mul(arriving, reflected(&lit, l)));
    }
    return sum;
}

static float share_of(const struct tl_lamp_samples_request *request, size_t index)
{
    bool is_seen = index < tl_samples_seen(request->samples);
    return request->shares && is_seen ? request->shares[index] : request->samples->items[index].cover;
}

/* The light of lamps on other samples that sample `index` reflects, if it is a near mirror. */
static vec3s mirrored(const struct tl_lamp_samples_request *request, const vec3s *lit, size_t index)
{
    const struct tl_mirror *mirror = &request->mirrors[index];
    vec3s sum = {{0, 0, 0}};
    for (int m = 0; m < mirror->ray_count; m++) {
        uint32_t hit = mirror->hits[m];
        if (hit < TL_MIRROR_BLACK)
            sum = glms_vec3_add(sum, glms_vec3_scale(lit[hit - request->samples->primary_count],
                                                     request->samples->items[hit].cover));
    }
    float each = mirror->ray_count > 0 ? 1 / (float)mirror->ray_count : 0;
    return glms_vec3_scale(glms_vec3_mul(sum, request->samples->items[index].specular), each);
}

static void add_at(const struct tl_lamp_samples_request *request, size_t index, vec3s light, float *out)
{
    float *texel = out + 4 * (size_t)request->samples->items[index].texel;
    for (int c = 0; c < 3; c++)
        texel[c] += share_of(request, index) * light.raw[c];
}

void tl_lamp_samples_add(const struct tl_lamp_samples_request *request, float *light)
{
    const struct tl_samples *samples = request->samples;
    size_t first = samples->primary_count, count = samples->count - first, seen = tl_samples_seen(samples);
    vec3s *lit = TL_NEW_ARRAY(vec3s, count);
#pragma omp parallel for schedule(dynamic, 64)
    for (size_t i = 0; i < count; i++)
        lit[i] = light_of_sample(request, first + i);
    for (size_t i = first; i < seen; i++) /* several samples share a texel, so one thread adds them */
        add_at(request, i, lit[i - first], light);
    for (size_t i = 0; request->mirrors && i < seen; i++)
        if (request->mirrors[i].ray_count > 0)
            add_at(request, i, mirrored(request, lit, i), light);
    free(lit);
}
