#include "render/brdf/tables/tables.h"

#include <math.h>

/* Coordinates on a paraboloid map; directions below the surface are clamped. */
static void map_direction(float x, float y, float z, float out[2])
{
    float down = 1 / (1 + fmaxf(z, 0));
    out[0] = x * down;
    out[1] = y * down;
}

static void map_own(const struct tl_brdf_frame *frame, vec3s direction, float out[2])
{
    map_direction(glms_vec3_dot(frame->tangent, direction), glms_vec3_dot(frame->bitangent, direction),
                  glms_vec3_dot(frame->normal, direction), out);
}

static void map_half(vec3s h, float out[2])
{
    map_direction(h.x, h.y, h.z, out);
    float stretch = 1 / sqrtf(fmaxf(hypotf(out[0], out[1]), 1e-12f));
    out[0] *= stretch;
    out[1] *= stretch;
}

void tl_brdf_inputs(const struct tl_brdf_frame *frame, vec3s l, vec3s v, float inputs[TL_AXIS_COUNT])
{
    struct tl_brdf_angles at = tl_brdf_angles_of(frame, l, v);
    inputs[TL_AXIS_NONE] = 0;
    inputs[TL_AXIS_N_DOT_L] = at.cos_a;
    inputs[TL_AXIS_N_DOT_V] = at.cos_b;
    inputs[TL_AXIS_N_DOT_H] = at.h.z;
    inputs[TL_AXIS_H_DOT_L] = at.cos_t;
    inputs[TL_AXIS_R_DOT_L] = glms_vec3_dot(tl_brdf_mirror(frame->normal, v), l);
    inputs[TL_AXIS_H_DOT_T] = at.h.x;
    inputs[TL_AXIS_H_DOT_B] = at.h.y;
    inputs[TL_AXIS_T_DOT_L] = glms_vec3_dot(frame->tangent, l);
    inputs[TL_AXIS_T_DOT_V] = glms_vec3_dot(frame->tangent, v);
    inputs[TL_AXIS_GROOVES] = at.cos_t > 0 ? tl_brdf_v_grooves(at.cos_a, at.cos_b, at.cos_t, at.h.z) : 0;
    map_own(frame, l, &inputs[TL_AXIS_L_U]);
    map_own(frame, v, &inputs[TL_AXIS_V_U]);
    map_half(at.h, &inputs[TL_AXIS_H_U]);
    inputs[TL_AXIS_H_RADIUS] = hypotf(inputs[TL_AXIS_H_U], inputs[TL_AXIS_H_V]);
}

static float texel(const struct tl_brdf_table *table, int x, int y, int channel)
{
    size_t i = ((size_t)y * (size_t)table->width + (size_t)x) * (size_t)table->channels +
               (size_t)(table->channels == 1 ? 0 : channel);
    if (table->precision == TL_PRECISION_FIXED8)
        return (float)((const uint8_t *)table->texels)[i] / 255;
    if (table->precision == TL_PRECISION_FIXED16)
        return (float)((const uint16_t *)table->texels)[i] / 65535;
    return ((const float *)table->texels)[i];
}

/* The two neighbouring texels and the position between them, clamped to the edge. */
static float neighbours(float coordinate, int count, int out[2])
{
    float place = fminf(fmaxf(coordinate * (float)count - 0.5f, 0), (float)(count - 1)); /* NaN: 0 */
    out[0] = (int)place;
    out[1] = out[0] + 1 < count ? out[0] + 1 : out[0];
    return place - (float)out[0];
}

vec3s tl_brdf_table_at(const struct tl_brdf_table *table, float u, float v)
{
    int x[2], y[2];
    float right = neighbours(u, table->width, x), up = neighbours(v, table->height, y);
    vec3s out;
    for (int c = 0; c < 3; c++) {
        float low = texel(table, x[0], y[0], c), high = texel(table, x[0], y[1], c);
        low += right * (texel(table, x[1], y[0], c) - low);
        high += right * (texel(table, x[1], y[1], c) - high);
        out.raw[c] = table->scale * (low + up * (high - low));
    }
    return out;
}

static float coordinate(const struct tl_brdf_axis *axis, const float inputs[TL_AXIS_COUNT])
{
    float input = inputs[axis->input];
    return axis->scale * (axis->angle ? acosf(fminf(fmaxf(input, -1), 1)) : input) + axis->bias;
}

vec3s tl_brdf_tables_gloss(const struct tl_brdf_tables *tables, const float inputs[TL_AXIS_COUNT])
{
    bool ambient_remains = tables->tables[0].y.input == TL_AXIS_N_DOT_L && tables->count == 1;
    if (!(inputs[TL_AXIS_N_DOT_V] > 0 && (inputs[TL_AXIS_N_DOT_L] > 0 || ambient_remains)))
        return (vec3s){{0, 0, 0}};
    vec3s product = {{1, 1, 1}};
    for (int i = 0; i < tables->count; i++) {
        const struct tl_brdf_table *table = &tables->tables[i];
        product = glms_vec3_mul(
            product, tl_brdf_table_at(table, coordinate(&table->x, inputs), coordinate(&table->y, inputs)));
    }
    return tables->times_cos_a ? glms_vec3_scale(product, inputs[TL_AXIS_N_DOT_L]) : product;
}
