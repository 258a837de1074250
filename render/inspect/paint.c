#include "render/inspect/paint.h"

#include "config/base/memory.h"
#include "config/colour/srgb.h"

#include <math.h>
#include <string.h>

#define CURVE_STEPS 1024

/* Tables of values that are too slow to compute for each sample. */
struct palette {
    float linear[CURVE_STEPS + 2]; /* of sRGB values in CURVE_STEPS equal steps from 0 to 1 */
    vec3s checker[2][2];           /* [block][square] */
    vec3s regions[TL_REGIONS_MAX];
};

static void mix_palette(struct palette *palette)
{
    for (int i = 0; i < CURVE_STEPS + 2; i++)
        palette->linear[i] = tl_srgb_to_linear((float)i / CURVE_STEPS);
    for (int i = 0; i < 4; i++)
        palette->checker[i / 2][i % 2] = tl_checker_colour(i / 2, i % 2);
    for (uint32_t i = 0; i < TL_REGIONS_MAX; i++)
        palette->regions[i] = tl_number_colour(i);
}

/* An approximation with an error of 1e-6. */
static float linear_of(const struct palette *palette, float encoded)
{
    float place = CURVE_STEPS * fminf(fmaxf(encoded, 0), 1);
    int before = (int)place;
    float part = place - (float)before;
    return palette->linear[before] + part * (palette->linear[before + 1] - palette->linear[before]);
}

/* A sample's triangle. */
struct surface_point {
    const tl_sample *sample;
    const tl_surface *surface;
    uint32_t triangle; /* of the surface */
    uint32_t corners[3];
    float uv_metres;
};

static struct surface_point find_surface_point(const struct tl_paint_request *request,
                                               const tl_sample *sample)
{
    struct surface_point surface_point = {.sample = sample};
    uint32_t number = sample->triangle & ~TL_SAMPLE_BACK;
    size_t index;
    surface_point.surface = tl_triangle_find(request->ranges, number, surface_point.corners, &index);
    surface_point.triangle = number - request->ranges->first[index];
    surface_point.uv_metres = tl_triangle_part(surface_point.surface, surface_point.triangle)->uv_metres;
    return surface_point;
}

vec3s tl_paint_mix(const vec3s *values, const uint32_t corners[3], const float weights[3])
{
    vec3s sum = {{0, 0, 0}};
    for (int i = 0; i < 3; i++)
        sum = glms_vec3_add(sum, glms_vec3_scale(values[corners[i]], weights[i]));
    return sum;
}

static float facing(const struct tl_paint_request *request, const tl_sample *sample)
{
    vec3s view = glms_vec3_sub(request->eye, sample->point);
    return fmaxf(glms_vec3_dot(view, sample->smooth), 0) / fmaxf(glms_vec3_norm(view), 1e-12f);
}

/* Shades the surface's form without a colour. */
static vec3s unknown(const struct tl_paint_request *request, const tl_sample *sample)
{
    return glms_vec3_scale(tl_legend_unknown, 0.6f + 0.4f * facing(request, sample));
}

/* The side of the area of surface that a texel covers, metres; foreshortened in one direction. */
static float footprint(const struct tl_paint_request *request, const tl_sample *sample)
{
    const float min_cosine = 0.1f;
    float distance = glms_vec3_distance(request->eye, sample->point);
    return distance * request->texel / fmaxf(facing(request, sample), min_cosine);
}

float tl_paint_square_wave(float place, float width)
{
    const float narrow = 1e-4f;
    width = fmaxf(width, narrow);
    /* The wave's integral from 0 is a triangle between 0 and a half. */
    float ends[2] = {place + 0.5f * width, place - 0.5f * width};
    for (int i = 0; i < 2; i++) {
        float part = ends[i] - floorf(ends[i]);
        ends[i] = fminf(part, 1 - part);
    }
    return fminf(fmaxf((ends[0] - ends[1]) / width, -1), 1);
}

/* Millimetres of cloth along u and v. */
static bool millimetres(const struct surface_point *surface_point, float mm[2])
{
    if (!surface_point->surface->uvs || !(surface_point->uv_metres > 0))
        return false;
    mm[0] = mm[1] = 0;
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 2; c++)
            mm[c] += 1000 * surface_point->uv_metres * surface_point->sample->weights[i] *
                     surface_point->surface->uvs[surface_point->corners[i]].raw[c];
    return isfinite(mm[0]) && isfinite(mm[1]);
}

/* +1 and -1 on the squares of a checker, and between them where a texel covers more. */
static float checker(const float mm[2], float width_mm, float side_mm)
{
    float period = 2 * side_mm;
    return tl_paint_square_wave(mm[0] / period, width_mm / period) *
           tl_paint_square_wave(mm[1] / period, width_mm / period);
}

static vec3s uv_colour(const struct tl_paint_request *request, const struct palette *palette,
                       const struct surface_point *surface_point)
{
    float mm[2], width_mm = 1000 * footprint(request, surface_point->sample);
    if (!millimetres(surface_point, mm))
        return unknown(request, surface_point->sample);
    float block = 0.5f - 0.5f * checker(mm, width_mm, TL_CHECKER_BLOCK_MM);
    float square = 0.5f + 0.5f * checker(mm, width_mm, TL_CHECKER_SQUARE_MM);
    vec3s even = glms_vec3_lerp(palette->checker[0][0], palette->checker[0][1], square);
    vec3s odd = glms_vec3_lerp(palette->checker[1][0], palette->checker[1][1], square);
    return glms_vec3_lerp(even, odd, block);
}

/* The share of a texel under dark lines of constant u. */
static float hatch(const struct tl_paint_request *request, const struct surface_point *surface_point)
{
    const float line_share = 0.2f;
    float mm[2], width = 1000 * footprint(request, surface_point->sample) / TL_HATCH_MM;
    if (!millimetres(surface_point, mm))
        return 0;
    /* Two square waves, shifted by a line's width, differ in a line and in its counterpart half a period
     * later. The difference is positive in one of them. */
    float place = mm[0] / TL_HATCH_MM;
    float half = tl_paint_square_wave(place, width), later = tl_paint_square_wave(place - line_share, width);
    float covered = 0.5f * fmaxf(half - later, 0);
    return fminf(covered, 1);
}

static vec3s tangent_colour(const struct tl_paint_request *request, const struct surface_point *surface_point)
{
    vec3s tangent = {{0, 0, 0}};
    for (int i = 0; surface_point->surface->tangents && i < 3; i++)
        tangent = glms_vec3_add(
            tangent, glms_vec3_scale(glms_vec3(surface_point->surface->tangents[surface_point->corners[i]]),
                                     surface_point->sample->weights[i]));
    vec3s smooth = surface_point->sample->smooth;
    tangent = glms_vec3_sub(tangent, glms_vec3_scale(smooth, glms_vec3_dot(smooth, tangent)));
    if (!(glms_vec3_norm(tangent) > 1e-6f && surface_point->uv_metres > 0))
        return unknown(request, surface_point->sample);
    const float ink = 0.75f;
    return glms_vec3_scale(tl_direction_colour(glms_vec3_normalize(tangent)),
                           1 - ink * hatch(request, surface_point));
}

static vec3s strain_colour(const struct tl_paint_request *request, const struct surface_point *surface_point)
{
    if (!surface_point->surface->strains)
        return unknown(request, surface_point->sample);
    vec3s strain =
        tl_paint_mix(surface_point->surface->strains, surface_point->corners, surface_point->sample->weights);
    return tl_legend_colour(request->legend, 100 * strain.raw[tl_view_strain_axis(request->view)]);
}

static vec3s crossing_colour(const struct tl_paint_request *request,
                             const struct surface_point *surface_point)
{
    const bool *crossed = surface_point->surface->crossed;
    return crossed && crossed[surface_point->triangle] ? tl_legend_crossing
                                                       : unknown(request, surface_point->sample);
}

static vec3s visibility_colour(const struct tl_paint_request *request, const struct palette *palette,
                               size_t index)
{
    const tl_sample *sample = &request->samples->items[index];
    const struct tl_taps *taps = &request->taps[index];
    if (request->view == TL_VIEW_VISIBILITY && request->region >= 0)
        return tl_legend_colour(request->legend,
                                tl_seen_region(request->values, request->stride, taps, request->region));
    struct tl_seen seen =
        tl_seen_at(request->regions, request->values, request->stride, taps, sample->smooth);
    if (request->view == TL_VIEW_VISIBILITY)
        return tl_legend_colour(request->legend, seen.visibility);
    return seen.strongest >= 0 ? palette->regions[seen.strongest] : (vec3s){{0, 0, 0}};
}

/* Converts a colour of the legend, sRGB, to linear. */
static vec3s colour_of(const struct tl_paint_request *request, const struct palette *palette, size_t index)
{
    const tl_sample *sample = &request->samples->items[index];
    switch (request->view) {
    case TL_VIEW_NORMAL:
        return tl_direction_colour(sample->normal);
    case TL_VIEW_SMOOTH:
        return tl_direction_colour(sample->smooth);
    case TL_VIEW_GLOSS:
        return tl_legend_colour(request->legend, sample->glossiness);
    case TL_VIEW_VISIBILITY:
    case TL_VIEW_REGION:
        return visibility_colour(request, palette, index);
    default:
        break;
    }
    struct surface_point surface_point = find_surface_point(request, sample);
    return request->view == TL_VIEW_UV         ? uv_colour(request, palette, &surface_point)
           : request->view == TL_VIEW_TANGENT  ? tangent_colour(request, &surface_point)
           : request->view == TL_VIEW_CROSSING ? crossing_colour(request, &surface_point)
                                               : strain_colour(request, &surface_point);
}

static vec3s linear_colour(const struct tl_paint_request *request, const struct palette *palette,
                           size_t index)
{
    if (request->view == TL_VIEW_ALBEDO)
        return request->samples->items[index].diffuse;
    vec3s colour = colour_of(request, palette, index);
    for (int c = 0; c < 3; c++)
        colour.raw[c] = linear_of(palette, colour.raw[c]);
    return colour;
}

void tl_paint(const struct tl_paint_request *request, float *light)
{
    const struct tl_samples *samples = request->samples;
    struct palette palette;
    mix_palette(&palette);
#pragma omp parallel for schedule(dynamic, 256)
    for (size_t i = 0; i < samples->primary_count; i++) {
        float *texel = light + 4 * (size_t)samples->items[i].texel;
        vec3s colour = glms_vec3_scale(linear_colour(request, &palette, i), samples->items[i].cover);
        memcpy(texel, colour.raw, sizeof colour);
        texel[3] = 0;
    }
}

float tl_paint_strain_range(const tl_surface *const *surfaces, size_t count, int axis)
{
    static const float ranges[] = {0.001f, 0.0015f, 0.002f, 0.003f, 0.005f, 0.007f, 0.01f,
                                   0.015f, 0.02f,   0.03f,  0.05f,  0.07f,  0.1f,   0.15f,
                                   0.2f,   0.3f,    0.5f,   0.7f,   1,      10};
    size_t within[TL_COUNT(ranges)] = {0}, all = 0;
    for (size_t s = 0; s < count; s++)
        for (size_t i = 0; surfaces[s]->strains && i < surfaces[s]->vertex_count; i++) {
            float strain = fabsf(surfaces[s]->strains[i].raw[axis]);
            for (size_t k = 0; k < TL_COUNT(ranges); k++)
                within[k] += strain <= ranges[k];
            all++;
        }
    size_t k = 0;
    while (k + 1 < TL_COUNT(ranges) && 100 * within[k] < 99 * all)
        k++;
    return ranges[k];
}
