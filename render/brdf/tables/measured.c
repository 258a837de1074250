#include "render/brdf/tables/measured.h"

#include "config/base/hash.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

/* The share of samples that may be darker than the even light: noise, and directions near the horizon. */
#define DARKEST 0.02
#define PI      ((float)M_PI)

static int compare(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static vec3s even_light(const struct tl_reflectance_samples *samples)
{
    float *values = TL_NEW_ARRAY(float, samples->count);
    vec3s even;
    for (int c = 0; c < 3; c++) {
        for (size_t i = 0; i < samples->count; i++)
            values[i] = samples->items[i].value.raw[c];
        qsort(values, samples->count, sizeof *values, compare);
        even.raw[c] = fminf(values[(size_t)(DARKEST * (double)samples->count)], 1 / PI);
    }
    free(values);
    return even;
}

/* Gloss of the samples beyond the even light. */
static struct tl_reflectance_samples rest_of(const struct tl_reflectance_samples *samples, vec3s even)
{
    struct tl_reflectance_samples rest = {TL_NEW_ARRAY(struct tl_reflectance_sample, samples->count),
                                          samples->count};
    for (size_t i = 0; i < samples->count; i++) {
        rest.items[i] = samples->items[i];
        rest.items[i].value = glms_vec3_maxv(glms_vec3_sub(rest.items[i].value, even), glms_vec3_zero());
    }
    return rest;
}

static double error_of(const struct tl_measured *measured, const struct tl_reflectance_samples *samples)
{
    static const struct tl_brdf_frame frame = {{{0, 0, 1}}, {{1, 0, 0}}, {{0, 1, 0}}};
    double off = 0, all = 0;
    for (size_t i = 0; i < samples->count; i++) {
        const struct tl_reflectance_sample *sample = &samples->items[i];
        vec3s drawn = tl_measured_reflected(measured, &frame, sample->l, sample->v);
        vec3s wanted = glms_vec3_scale(sample->value, sample->v.z > 0 ? sample->l.z : 0);
        off += (double)glms_vec3_norm2(glms_vec3_sub(drawn, wanted));
        all += (double)glms_vec3_norm2(wanted);
    }
    return sqrt(off / fmax(all, 1e-30));
}

struct tl_measured tl_measured_make(const struct tl_reflectance_samples *samples)
{
    vec3s even = even_light(samples);
    struct tl_reflectance_samples rest = rest_of(samples, even);
    struct tl_measured made = {
        .diffuse = glms_vec3_scale(even, PI),
        .hash = tl_hash(TL_HASH_START, samples->items, samples->count * sizeof *samples->items) | 1};
    made.tables = tl_brdf_tables_factor(&rest, tl_factor_size(rest.count), &made.bridged);
    made.rel_rmse = error_of(&made, samples);
    made.lobes = tl_measured_lobes_fit(samples);
    tl_reflectance_samples_release(&rest);
    return made;
}

void tl_measured_release(struct tl_measured *measured)
{
    tl_brdf_tables_release(&measured->tables);
    *measured = (struct tl_measured){0};
}

vec3s tl_measured_reflected(const struct tl_measured *measured, const struct tl_brdf_frame *frame, vec3s l,
                            vec3s v)
{
    float inputs[TL_AXIS_COUNT];
    tl_brdf_inputs(frame, l, v, inputs);
    vec3s even = glms_vec3_scale(measured->diffuse, fmaxf(inputs[TL_AXIS_N_DOT_L], 0) / PI);
    return glms_vec3_add(even, tl_brdf_tables_gloss(&measured->tables, inputs));
}
