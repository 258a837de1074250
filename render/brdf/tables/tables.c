#include "render/brdf/tables/tables.h"

#include "config/base/memory.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#define PI ((float)M_PI)

/* A lobe counts as dark below this fraction of its peak; the range of its axis ends there. */
#define DARK     1e-6f
#define LOG_DARK 13.815511f
/* Facets wider than this fill the whole range of cosines. */
#define WIDE 0.25f

/* A factor of a model: its value by channel as a function of the inputs on its axes. */
struct factor {
    const struct tl_brdf *brdf;
    const struct tl_brdf_table_params *params;
    void (*value)(const struct factor *factor, float x, float y, float out[3]);
    struct range {
        int input;
        bool angle;
        float low, high;
    } x, y;
    int channels;
    bool singular; /* unbounded, or with a bound that grows as facets get narrow */
};

static void all_channels(float value, float out[3])
{
    out[0] = out[1] = out[2] = value;
}

/* K as a power of a cosine; for BANKS the cosine is that of the angle to the mirror cone. */
static float lobe_at(const struct tl_brdf *brdf, float cosine)
{
    float exponent = brdf->gloss.model == TL_REFLECT_BLINN_PHONG ? 4 * brdf->exponent : brdf->exponent;
    return cosine > 0 ? tl_brdf_lobe_scale(brdf) * powf(cosine, exponent) : 0;
}

static void lobe_and_fresnel(const struct factor *factor, float x, float y, float out[3])
{
    vec3s value = glms_vec3_scale(tl_brdf_fresnel(factor->brdf, y), lobe_at(factor->brdf, x));
    for (int c = 0; c < 3; c++)
        out[c] = value.raw[c];
}

static void folded(const struct factor *factor, float x, float n_dot_l, float out[3])
{
    const struct tl_brdf *brdf = factor->brdf;
    const struct tl_brdf_table_params *params = factor->params;
    const vec3s fresnel = tl_brdf_fresnel(brdf, 1);
    float gloss = n_dot_l > 0 ? lobe_at(brdf, x) : 0;
    if (brdf->gloss.model == TL_REFLECT_COSINE_LOBE)
        gloss *= n_dot_l;
    for (int c = 0; c < 3; c++)
        out[c] = params->ambient.raw[c] + params->diffuse.raw[c] * n_dot_l / PI + fresnel.raw[c] * gloss;
}

static void fresnel_and_facets(const struct factor *factor, float h_dot_l, float n_dot_h, float out[3])
{
    float tangent_squared = fmaxf(1 - n_dot_h * n_dot_h, 0) / (n_dot_h * n_dot_h);
    float facets = n_dot_h > 0 ? tl_brdf_facets(factor->brdf, tangent_squared) : 0;
    vec3s value = glms_vec3_scale(tl_brdf_fresnel(factor->brdf, h_dot_l), facets);
    for (int c = 0; c < 3; c++)
        out[c] = value.raw[c];
}

static void fresnel_alone(const struct factor *factor, float cosine, float none, float out[3])
{
    (void)none;
    vec3s value = tl_brdf_fresnel(factor->brdf, cosine);
    for (int c = 0; c < 3; c++)
        out[c] = value.raw[c];
}

/* Smith's term vanishes as fast as n.v, so the quotient has a limit at n.v = 0, which is evaluated at
 * 1e-5. */
static void each_over_cosine(const struct factor *factor, float n_dot_l, float n_dot_v, float out[3])
{
    float b = fmaxf(n_dot_v, 1e-5f);
    all_channels(n_dot_l > 0 ? tl_brdf_masking(factor->brdf, n_dot_l, b, 1, 1) / (PI * b) : 0, out);
}

/* Quotients without a limit at n.v = 0 are evaluated half a texel away from it in the texels there. */
static float off_zero(const struct factor *factor, float n_dot_v)
{
    return fmaxf(n_dot_v, 0.5f / (float)(factor->params->size - 1));
}

static void grooves_over_cosine(const struct factor *factor, float grooves, float n_dot_v, float out[3])
{
    all_channels(grooves / (PI * off_zero(factor, n_dot_v)), out);
}

static void root_of_cosines(const struct factor *factor, float n_dot_l, float n_dot_v, float out[3])
{
    all_channels(sqrtf(n_dot_l / off_zero(factor, n_dot_v)), out);
}

static void ward_facets(const struct factor *factor, float h_dot_t, float h_dot_b, float out[3])
{
    float u = factor->brdf->gloss.width_weft, v = factor->brdf->gloss.width_warp;
    float up_squared = 1 - h_dot_t * h_dot_t - h_dot_b * h_dot_b, x = h_dot_t / u, y = h_dot_b / v;
    all_channels(up_squared > 0 ? expf(-(x * x + y * y) / up_squared) / (4 * PI * u * v) : 0, out);
}

static void thread(const struct factor *factor, float t_dot_l, float t_dot_v, float out[3])
{
    float angle = factor->params->angles ? t_dot_l + t_dot_v - PI : tl_brdf_thread_angle(t_dot_l, t_dot_v);
    all_channels(lobe_at(factor->brdf, cosf(angle)), out);
}

static struct range cosines(int input)
{
    return (struct range){.input = input, .high = 1};
}

/* The range in which cosine^exponent is not dark. */
static struct range lobe_range(int input, float exponent)
{
    return (struct range){.input = input, .low = powf(DARK, 1 / exponent), .high = 1};
}

static struct range facets_range(const struct tl_brdf *brdf)
{
    float width = brdf->gloss.width_weft,
          end = width * sqrtf(LOG_DARK); /* a slope (Beckmann) or an angle (Gaussian) */
    struct range range = cosines(TL_AXIS_N_DOT_H);
    if (width <= WIDE && brdf->gloss.facets != TL_FACETS_GGX) /* whose tails end nowhere */
        range.low = brdf->gloss.facets == TL_FACETS_BECKMANN ? 1 / sqrtf(1 + end * end) : cosf(end);
    return range;
}

static struct range slope_range(int input, float width)
{
    float slope = width * sqrtf(LOG_DARK), sine = slope / sqrtf(1 + slope * slope);
    return (struct range){.input = input, .low = -sine, .high = sine};
}

static struct range thread_range(int input, bool angle)
{
    return angle ? (struct range){.input = input, .angle = true, .high = PI}
                 : (struct range){.input = input, .low = -1, .high = 1};
}

/* Lists the factors of a model and returns their number. */
static int factors_of(const struct tl_brdf *brdf, const struct tl_brdf_table_params *params,
                      struct factor out[TL_BRDF_TABLES_MAX])
{
    struct factor fresnel = {.value = fresnel_alone, .x = cosines(TL_AXIS_H_DOT_L), .channels = 3};
    switch (brdf->gloss.model) {
    case TL_REFLECT_TORRANCE_SPARROW: {
        bool grooves = brdf->gloss.masking == TL_MASKING_V_GROOVES;
        out[0] = (struct factor){.value = fresnel_and_facets,
                                 .x = cosines(TL_AXIS_H_DOT_L),
                                 .y = facets_range(brdf),
                                 .channels = 3};
        out[1] = (struct factor){.value = grooves ? grooves_over_cosine : each_over_cosine,
                                 .x = cosines(grooves ? TL_AXIS_GROOVES : TL_AXIS_N_DOT_L),
                                 .y = cosines(TL_AXIS_N_DOT_V),
                                 .channels = 1,
                                 .singular = true};
        return 2;
    }
    case TL_REFLECT_WARD:
        out[0] = (struct factor){.value = ward_facets,
                                 .x = slope_range(TL_AXIS_H_DOT_T, brdf->gloss.width_weft),
                                 .y = slope_range(TL_AXIS_H_DOT_B, brdf->gloss.width_warp),
                                 .channels = 1};
        out[1] = (struct factor){.value = root_of_cosines,
                                 .x = cosines(TL_AXIS_N_DOT_L),
                                 .y = cosines(TL_AXIS_N_DOT_V),
                                 .channels = 1,
                                 .singular = true};
        out[2] = fresnel;
        return 3;
    case TL_REFLECT_BANKS:
        out[0] = (struct factor){.value = thread,
                                 .x = thread_range(TL_AXIS_T_DOT_L, params->angles),
                                 .y = thread_range(TL_AXIS_T_DOT_V, params->angles),
                                 .channels = 1};
        out[1] = fresnel;
        out[1].x.input = TL_AXIS_N_DOT_V;
        return 2;
    default: {
        bool half = brdf->gloss.model == TL_REFLECT_BLINN_PHONG,
             phong = brdf->gloss.model == TL_REFLECT_PHONG;
        out[0] = (struct factor){.value = params->folded ? folded : lobe_and_fresnel,
                                 .x = half ? lobe_range(TL_AXIS_N_DOT_H, 4 * brdf->exponent)
                                           : lobe_range(TL_AXIS_R_DOT_L, brdf->exponent),
                                 .y = cosines(params->folded ? TL_AXIS_N_DOT_L
                                              : phong        ? TL_AXIS_N_DOT_V
                                                             : TL_AXIS_H_DOT_L),
                                 .channels = 3};
        return 1;
    }
    }
}

static float at_texel(const struct range *range, int i, int count)
{
    return range->low + (range->high - range->low) * (float)i / (float)(count - 1);
}

/* Maps the ends of the range to the centres of the first and the last texel. */
static struct tl_brdf_axis axis_of(const struct range *range, int count)
{
    if (count == 1)
        return (struct tl_brdf_axis){.input = TL_AXIS_NONE, .bias = 0.5f};
    float scale = (float)(count - 1) / (float)count / (range->high - range->low);
    return (struct tl_brdf_axis){range->input, range->angle, scale, 0.5f / (float)count - range->low * scale};
}

static size_t texel_bytes(int precision)
{
    return precision == TL_PRECISION_FIXED8 ? 1 : precision == TL_PRECISION_FIXED16 ? 2 : 4;
}

static size_t value_count(const struct tl_brdf_table *table)
{
    return (size_t)table->width * (size_t)table->height * (size_t)table->channels;
}

static float max_value(const float *values, size_t count)
{
    float max = 0;
    for (size_t i = 0; i < count; i++)
        max = fmaxf(max, values[i]);
    return max > 0 ? max : 1;
}

/* The factor on the texels. */
static float scale_of(const struct factor *factor, const float *values, size_t count)
{
    const struct tl_brdf_table_params *params = factor->params;
    if (params->precision == TL_PRECISION_FLOAT || (factor->singular && params->range == TL_RANGE_CLAMPED))
        return 1;
    return factor->singular && params->constant > 0 ? params->constant : max_value(values, count);
}

static void store(struct tl_brdf_table *table, float *values)
{
    size_t count = value_count(table);
    if (table->precision == TL_PRECISION_FLOAT) {
        table->texels = values;
        return;
    }
    float max = table->precision == TL_PRECISION_FIXED8 ? 255 : 65535;
    table->texels = tl_alloc(count, texel_bytes(table->precision));
    for (size_t i = 0; i < count; i++) {
        float level = roundf(fminf(fmaxf(values[i] / table->scale, 0), 1) * max);
        if (table->precision == TL_PRECISION_FIXED8)
            ((uint8_t *)table->texels)[i] = (uint8_t)level;
        else
            ((uint16_t *)table->texels)[i] = (uint16_t)level;
    }
    free(values);
}

static struct tl_brdf_table make_table(const struct factor *factor)
{
    int size = factor->params->size;
    assert(size >= 2);
    struct tl_brdf_table table = {.width = size,
                                  .height = factor->y.input == TL_AXIS_NONE ? 1 : size,
                                  .channels = factor->channels,
                                  .precision = factor->params->precision};
    table.x = axis_of(&factor->x, table.width);
    table.y = axis_of(&factor->y, table.height);
    float *values = TL_NEW_ARRAY(float, value_count(&table));
#pragma omp parallel for schedule(static)
    for (int j = 0; j < table.height; j++) {
        float y = table.height > 1 ? at_texel(&factor->y, j, table.height) : 0;
        for (int i = 0; i < table.width; i++) {
            float value[3];
            factor->value(factor, at_texel(&factor->x, i, table.width), y, value);
            for (int c = 0; c < table.channels; c++)
                values[((size_t)j * (size_t)table.width + (size_t)i) * (size_t)table.channels + (size_t)c] =
                    value[c];
        }
    }
    table.scale = scale_of(factor, values, value_count(&table));
    store(&table, values);
    return table;
}

struct tl_brdf_tables tl_brdf_tables_make(const struct tl_brdf *brdf,
                                          const struct tl_brdf_table_params *params)
{
    struct factor factors[TL_BRDF_TABLES_MAX];
    int model = brdf->gloss.model;
    struct tl_brdf_tables tables = {.count = factors_of(brdf, params, factors),
                                    .times_cos_a = model == TL_REFLECT_BANKS ||
                                                   (model == TL_REFLECT_COSINE_LOBE && !params->folded)};
    for (int i = 0; i < tables.count; i++) {
        factors[i].brdf = brdf;
        factors[i].params = params;
        tables.tables[i] = make_table(&factors[i]);
    }
    return tables;
}

void tl_brdf_tables_release(struct tl_brdf_tables *tables)
{
    for (int i = 0; i < tables->count; i++)
        free(tables->tables[i].texels);
    *tables = (struct tl_brdf_tables){0};
}

size_t tl_brdf_tables_bytes(const struct tl_brdf_tables *tables)
{
    size_t bytes = 0;
    for (int i = 0; i < tables->count; i++)
        bytes += value_count(&tables->tables[i]) * texel_bytes(tables->tables[i].precision);
    return bytes;
}
