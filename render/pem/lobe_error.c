#include "render/pem/lobe_error.h"

#include "config/base/memory.h"
#include "render/env/exponent.h"
#include "render/pem/chain.h"
#include "render/pem/lobe.h"
#include "render/pem/slices.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define POINTS_ALONG 3 /* TL_LOBE_SOURCE_POINTS is its square */

struct tl_lobe_source tl_lobe_source(int cube_size, vec3s direction)
{
    int texel = tl_cube_texel(cube_size, direction);
    int face = texel / (cube_size * cube_size), y = texel / cube_size % cube_size, x = texel % cube_size;
    struct tl_lobe_source source = {.texel = texel, .radiance = 1 / tl_cube_solid_angle(cube_size, x, y)};
    for (int i = 0; i < TL_LOBE_SOURCE_POINTS; i++) {
        int fine_x = POINTS_ALONG * x + i % POINTS_ALONG, fine_y = POINTS_ALONG * y + i / POINTS_ALONG;
        float step = 1 / (float)(POINTS_ALONG * cube_size);
        source.points[i] = glms_vec3_normalize(
            tl_cube_direction(face, ((float)fine_x + 0.5f) * step, ((float)fine_y + 0.5f) * step));
        source.weights[i] =
            (double)(tl_cube_solid_angle(POINTS_ALONG * cube_size, fine_x, fine_y) * source.radiance);
    }
    return source;
}

static double exact_lobe(const struct tl_lobe_source *source, float s, vec3s direction)
{
    double sum = 0;
    for (int i = 0; i < TL_LOBE_SOURCE_POINTS; i++)
        sum += source->weights[i] * (double)tl_lobe_cosine(s, glms_vec3_dot(source->points[i], direction));
    return sum;
}

static vec3s source_axis(const struct tl_lobe_source *source)
{
    return source->points[TL_LOBE_SOURCE_POINTS / 2];
}

/* A direction with a given cosine to the axis, turned by phi about it. */
static vec3s around(vec3s axis, double cosine, double phi)
{
    vec3s right = glms_vec3_normalize(glms_vec3_ortho(axis)), up = glms_vec3_cross(axis, right);
    double sine = sqrt(fmax(1 - cosine * cosine, 0));
    vec3s direction = glms_vec3_scale(axis, (float)cosine);
    direction = glms_vec3_muladds(right, (float)(sine * cos(phi)), direction);
    return glms_vec3_muladds(up, (float)(sine * sin(phi)), direction);
}

/* Rings and spokes of the quadrature. The rings are as dense as a cosine lobe of half the exponent, so that
 * the tail is represented, up to a thousandth of its volume; from there to the antipode they get wider
 * geometrically. */
#define RINGS_NEAR 64
#define RINGS_FAR  16
#define RINGS      (RINGS_NEAR + RINGS_FAR)
#define SPOKES     48

/* 1 - cosine at the start of ring `place`; a half number is the middle of a ring. */
static double ring_place(double place, double s)
{
    const double left = 1e-3;
    double power = 1 / (s / 2 + 1), near = 1 - pow(left, power);
    if (place <= RINGS_NEAR)
        return 1 - pow(1 - (1 - left) * place / RINGS_NEAR, power);
    return near * pow(2 / near, (place - RINGS_NEAR) / RINGS_FAR);
}

#define SAMPLES (RINGS * SPOKES)

/* The nodes at which the lobes are compared: directions, exact values, and solid angles divided by the volume
 * of the lobe. */
struct quadrature {
    vec3s directions[SAMPLES];
    double exact[SAMPLES], shares[SAMPLES];
};

static void make_quadrature(const struct tl_lobe_source *source, float s, struct quadrature *out)
{
    double volume = 0;
    for (int i = 0; i < SAMPLES; i++) {
        int ring = i / SPOKES, spoke = i % SPOKES;
        double cosine = 1 - ring_place(ring + 0.5, (double)s);
        /* Each ring is turned by the golden ratio, so that spokes do not follow the grid of texels. */
        double turn = fmod(ring * 0.6180339887498949, 1);
        out->directions[i] = around(source_axis(source), cosine, 2 * M_PI * (turn + spoke) / SPOKES);
        out->exact[i] = exact_lobe(source, s, out->directions[i]);
        out->shares[i] = 2 * M_PI * (ring_place(ring + 1, (double)s) - ring_place(ring, (double)s)) / SPOKES;
        volume += out->shares[i] * out->exact[i];
    }
    for (int i = 0; i < SAMPLES; i++)
        out->shares[i] /= volume;
}

static struct tl_lobe_error compare(const struct quadrature *quadrature, const double response[SAMPLES])
{
    struct tl_lobe_error result = {0};
    double exact_solid = 0, shown_solid = 0;
    for (int i = 0; i < SAMPLES; i++) {
        double share = quadrature->shares[i], exact = quadrature->exact[i];
        result.energy += share * response[i];
        exact_solid += share * exact * exact * exact;
        shown_solid += share * response[i] * response[i] * response[i];
    }
    for (int i = 0; i < SAMPLES; i++) {
        double share = quadrature->shares[i], exact = quadrature->exact[i];
        double shown = response[i] * response[i] * response[i] / shown_solid;
        result.error += share * fabs(response[i] - exact);
        result.same_volume += share * fabs(response[i] / result.energy - exact);
        result.radial += share * fabs(shown - exact * exact * exact / exact_solid);
    }
    return result;
}

struct tl_lobe_error tl_lobe_measure(const struct tl_lobe_source *source, float s, tl_lobe_response *evaluate,
                                     const void *prefilter)
{
    struct quadrature quadrature;
    double response[SAMPLES];
    make_quadrature(source, s, &quadrature);
    for (int i = 0; i < SAMPLES; i++)
        response[i] = evaluate(prefilter, quadrature.directions[i]);
    return compare(&quadrature, response);
}

const char *const tl_lobe_method_names[] = {"none",        "gauss",  "cosine", "box",
                                            "sqrt_cosine", "slices", "whole",  NULL};

vec3s tl_lobe_probe(int i, int count)
{
    const int awkward = 26;
    if (i < awkward) { /* the points of a 3 x 3 x 3 grid except its centre */
        int place = i < awkward / 2 ? i : i + 1;
        int x = place % 3 - 1, y = place / 3 % 3 - 1, z = place / 9 - 1;
        return glms_vec3_normalize((vec3s){{(float)x, (float)y, (float)z}});
    }
    float y = 1 - 2 * ((float)(i - awkward) + 0.5f) / (float)(count - awkward);
    float phi = 2.39996323f * (float)i, radius = sqrtf(1 - y * y); /* golden angle */
    return (vec3s){{radius * cosf(phi), y, radius * sinf(phi)}};
}

/* One prefilter of one lit texel: the chain, the whole environment, or the slices of all regions, of which
 * one is looked up. */
struct prefilter {
    int method;
    struct tl_lobe_table table;
    struct tl_chain chain;
    struct tl_lobes lobes;
    const struct tl_slices *slices;
    int region;
    /* The look-up. */
    float level;
    struct tl_exponent_blend blend;
};

static double fetch_response(const void *data, vec3s direction)
{
    const struct prefilter *prefilter = data;
    if (prefilter->method == TL_LOBE_SLICES)
        return (double)tl_slices_fetch(prefilter->slices, prefilter->region, direction, prefilter->blend).x;
    if (prefilter->method == TL_LOBE_WHOLE)
        return (double)tl_lobes_fetch(&prefilter->lobes, direction, prefilter->blend).x;
    return (double)tl_chain_sample(&prefilter->chain, direction, prefilter->level).x;
}

/* The level as the light pass looks it up: interpolated between steps of the table. */
static float chain_level(const struct tl_lobe_table *table, float s)
{
    float place = (1 - 1 / s) * (TL_LOBE_STEPS - 1);
    int step = place < TL_LOBE_STEPS - 2 ? (int)place : TL_LOBE_STEPS - 2;
    float part = place - (float)step;
    return table->level[step] + part * (table->level[step + 1] - table->level[step]);
}

static void aim(struct prefilter *prefilter, float s)
{
    prefilter->blend = tl_exponent_blend(s);
    if (prefilter->method < TL_LOBE_SLICES)
        prefilter->level = chain_level(&prefilter->table, s);
}

/* Bit mask of the exponents that the blends need. */
static uint32_t exponents_of(const float *exponents, int count)
{
    uint32_t needed = 0;
    for (int i = 0; i < count; i++) {
        struct tl_exponent_blend blend = tl_exponent_blend(exponents[i]);
        needed |= 1u << blend.index | (blend.weight > 0 ? 2u << blend.index : 0);
    }
    return needed;
}

static void light_texel(tl_cube *cube, const struct tl_lobe_source *source)
{
    for (int c = 0; c < 3; c++)
        cube->texels[3 * (size_t)source->texel + (size_t)c] = source->radiance;
}

static void prepare(struct prefilter *prefilter, int cube_size, const struct tl_lobe_source *source,
                    uint32_t needed)
{
    tl_cube cube = tl_cube_create(cube_size);
    light_texel(&cube, source);
    if (prefilter->method == TL_LOBE_WHOLE)
        tl_lobes_make(&prefilter->lobes, &cube, needed);
    else
        prefilter->chain = tl_chain_build(&cube, (enum tl_chain_filter)prefilter->method);
    tl_cube_release(&cube);
}

static void measure_all(const struct tl_lobe_curves *curves, const struct tl_lobe_source *source,
                        struct prefilter *prefilter, struct tl_lobe_error *out)
{
    for (int i = 0; i < curves->exponent_count; i++) {
        aim(prefilter, curves->exponents[i]);
        out[i] = tl_lobe_measure(source, curves->exponents[i], fetch_response, prefilter);
    }
}

/* Measures each direction separately. */
static void measure_one_by_one(const struct tl_lobe_curves *curves, int method, struct tl_lobe_error *errors)
{
    struct tl_lobe_table table = {0};
    if (method < TL_LOBE_SLICES)
        tl_lobe_calibrate(curves->cube_size, (enum tl_chain_filter)method, &table);
    uint32_t needed = exponents_of(curves->exponents, curves->exponent_count);
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < curves->direction_count; i++) {
        struct tl_lobe_source source =
            tl_lobe_source(curves->cube_size, tl_lobe_probe(i, curves->direction_count));
        struct prefilter prefilter = {.method = method, .table = table};
        prepare(&prefilter, curves->cube_size, &source, needed);
        measure_all(curves, &source, &prefilter, errors + (size_t)i * (size_t)curves->exponent_count);
        tl_chain_release(&prefilter.chain);
        tl_lobes_release(&prefilter.lobes);
    }
}

/* Radiance so small that it does not count, but keeps the regions from being black. */
#define FAINT 1e-6f

static tl_cube even_cube(int size, float radiance)
{
    tl_cube cube = tl_cube_create(size);
    for (size_t i = 0; i < 18 * (size_t)size * (size_t)size; i++)
        cube.texels[i] = radiance;
    return cube;
}

/* Regions are filtered independently, so one direction per region is measured at a time. `done` marks the
 * directions that were measured. */
static void measure_round(const struct tl_lobe_curves *curves, const struct tl_regions *regions, bool *done,
                          struct tl_lobe_error *errors)
{
    tl_cube cube = even_cube(curves->cube_size, FAINT);
    int directions[TL_REGIONS_MAX];
    memset(directions, -1, sizeof directions);
    for (int i = 0; i < curves->direction_count; i++) {
        struct tl_lobe_source source =
            tl_lobe_source(curves->cube_size, tl_lobe_probe(i, curves->direction_count));
        int region = regions->labels[source.texel];
        if (done[i] || directions[region] >= 0)
            continue;
        directions[region] = i;
        done[i] = true;
        light_texel(&cube, &source);
    }
    struct tl_slices *slices = TL_NEW(struct tl_slices);
    tl_slices_make(slices, &cube, regions, exponents_of(curves->exponents, curves->exponent_count));
#pragma omp parallel for schedule(dynamic)
    for (int region = 0; region < regions->count; region++) {
        int i = directions[region];
        if (i < 0)
            continue;
        struct tl_lobe_source source =
            tl_lobe_source(curves->cube_size, tl_lobe_probe(i, curves->direction_count));
        struct prefilter prefilter = {.method = TL_LOBE_SLICES, .slices = slices, .region = region};
        measure_all(curves, &source, &prefilter, errors + (size_t)i * (size_t)curves->exponent_count);
    }
    tl_slices_release(slices);
    free(slices);
    tl_cube_release(&cube);
}

static void measure_slices(const struct tl_lobe_curves *curves, struct tl_lobe_error *errors)
{
    struct tl_regions *regions = TL_NEW(struct tl_regions);
    tl_cube even = even_cube(curves->cube_size, 1);
    tl_regions_cut_sphere(&even, curves->region_count, regions);
    tl_cube_release(&even);
    bool *done = TL_NEW_ARRAY(bool, (size_t)curves->direction_count);
    for (int i = 0; i < curves->direction_count; i++)
        if (!done[i])
            measure_round(curves, regions, done, errors);
    free(done);
    tl_regions_release(regions);
    free(regions);
}

void tl_lobe_curve(const struct tl_lobe_curves *curves, int method, struct tl_lobe_curve_point *out)
{
    size_t exponents = (size_t)curves->exponent_count, directions = (size_t)curves->direction_count;
    struct tl_lobe_error *errors = TL_NEW_ARRAY(struct tl_lobe_error, exponents * directions);
    if (method == TL_LOBE_SLICES)
        measure_slices(curves, errors);
    else
        measure_one_by_one(curves, method, errors);
    for (size_t i = 0; i < exponents; i++) {
        struct tl_lobe_curve_point point = {.energy_low = INFINITY};
        for (size_t k = 0; k < directions; k++) {
            const struct tl_lobe_error *error = &errors[k * exponents + i];
            point.mean += error->error / (double)directions;
            point.worst = fmax(point.worst, error->error);
            point.same_volume_mean += error->same_volume / (double)directions;
            point.same_volume_worst = fmax(point.same_volume_worst, error->same_volume);
            point.radial_mean += error->radial / (double)directions;
            point.energy_low = fmin(point.energy_low, error->energy);
            point.energy_high = fmax(point.energy_high, error->energy);
        }
        out[i] = point;
    }
    free(errors);
}

/* Levels tried between every two levels of the chain. */
#define LEVEL_STEPS 8

static double min_error(const struct tl_chain *chain, const struct tl_lobe_source *source, float s)
{
    struct quadrature quadrature;
    make_quadrature(source, s, &quadrature);
    double(*levels)[SAMPLES] = tl_alloc((size_t)chain->level_count, sizeof *levels), min = INFINITY;
    for (int level = 0; level < chain->level_count; level++)
        for (int i = 0; i < SAMPLES; i++)
            levels[level][i] = (double)tl_cube_sample(&chain->levels[level], quadrature.directions[i]).x;
    for (int step = 0; step < (chain->level_count - 1) * LEVEL_STEPS; step++) {
        const double *fine = levels[step / LEVEL_STEPS], *coarse = levels[step / LEVEL_STEPS + 1];
        double part = (double)(step % LEVEL_STEPS) / LEVEL_STEPS, response[SAMPLES];
        for (int i = 0; i < SAMPLES; i++)
            response[i] = fine[i] + part * (coarse[i] - fine[i]);
        min = fmin(min, compare(&quadrature, response).same_volume);
    }
    free(levels);
    return min;
}

void tl_lobe_min_error(const struct tl_lobe_curves *curves, int method, double *mean, double *worst)
{
    assert(method < TL_LOBE_SLICES);
    size_t exponents = (size_t)curves->exponent_count, directions = (size_t)curves->direction_count;
    double *errors = TL_NEW_ARRAY(double, exponents *directions);
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < curves->direction_count; i++) {
        struct tl_lobe_source source =
            tl_lobe_source(curves->cube_size, tl_lobe_probe(i, curves->direction_count));
        struct prefilter prefilter = {.method = method};
        prepare(&prefilter, curves->cube_size, &source, 0);
        for (size_t k = 0; k < exponents; k++)
            errors[k * directions + (size_t)i] = min_error(&prefilter.chain, &source, curves->exponents[k]);
        tl_chain_release(&prefilter.chain);
    }
    for (size_t k = 0; k < exponents; k++) {
        mean[k] = worst[k] = 0;
        for (size_t i = 0; i < directions; i++) {
            mean[k] += errors[k * directions + i] / (double)directions;
            worst[k] = fmax(worst[k], errors[k * directions + i]);
        }
    }
    free(errors);
}

void tl_lobe_section(int cube_size, int method, float s, int count, float *response, float *exact)
{
    assert(method !=
           TL_LOBE_SLICES); /* with a single light the slices equal those of the whole environment */
    struct tl_lobe_source source = tl_lobe_source(cube_size, (vec3s){{0.01f, 0.01f, 1}});
    struct prefilter prefilter = {.method = method};
    if (method < TL_LOBE_SLICES)
        tl_lobe_calibrate(cube_size, (enum tl_chain_filter)method, &prefilter.table);
    prepare(&prefilter, cube_size, &source, exponents_of(&s, 1));
    aim(&prefilter, s);
    for (int i = 0; i < count; i++) {
        double angle = -M_PI + 2 * M_PI * i / (count - 1);
        vec3s direction = around(source_axis(&source), cos(angle), angle < 0 ? M_PI : 0);
        response[i] = (float)fetch_response(&prefilter, direction);
        exact[i] = (float)exact_lobe(&source, s, direction);
    }
    tl_chain_release(&prefilter.chain);
    tl_lobes_release(&prefilter.lobes);
}
