// Gloss from the tables of render/brdf/tables/tables.h. There are TABLES of them; a pass multiplies FIRST_TABLE to LAST_TABLE.
// TABLE0_X and so on are numbers of enum tl_table_input; TABLE0_ANGLES: the axes are angles.
layout(location = 94) uniform vec4 table_axes[4]; // scale and bias of x, of y: the texture matrix
layout(location = 83) uniform vec4 table_scales;
layout(location = 105) uniform vec3 table_ambient; // FOLDED: even light that is in all of the table

layout(binding = 20) uniform sampler2D table0;
layout(binding = 21) uniform sampler2D table1;
layout(binding = 22) uniform sampler2D table2;
layout(binding = 26) uniform sampler2D table3;

#if TABLES > 0
vec2 paraboloid(float x, float y, float z)
{
    return vec2(x, y) / (1.0 + max(z, 0.0));
}

float table_input(int wanted, bool is_angle, Cosines c)
{
    float grooves = min(1.0, 2.0 * c.half_normal * min(c.a, c.b) / max(c.t, 1e-6));
    vec2 light = paraboloid(c.thread.x, c.hand * c.across.x, c.a);
    vec2 viewer = paraboloid(c.thread.y, c.hand * c.across.y, c.b);
    vec2 half_way = paraboloid(c.half_plane.x, c.hand * c.half_plane.y, c.half_normal);
    half_way *= inversesqrt(max(length(half_way), 1e-12));
    float inputs[18] = float[](0.0, c.a, c.b, c.half_normal, c.t, c.mirror, c.half_plane.x, c.half_plane.y, c.thread.x,
                               c.thread.y, grooves, light.x, light.y, viewer.x, viewer.y, half_way.x, half_way.y,
                               length(half_way));
    return is_angle ? acos(clamp(inputs[wanted], -1.0, 1.0)) : inputs[wanted];
}

vec3 table_value(sampler2D table, vec4 axes, float x, float y)
{
    return textureLod(table, vec2(axes.x * x + axes.y, axes.z * y + axes.w), 0.0).rgb;
}

#define TABLE_AT(number)                                                                                               \
    table_value(table##number, table_axes[number], table_input(TABLE##number##_X, TABLE##number##_ANGLES, c),          \
                table_input(TABLE##number##_Y, TABLE##number##_ANGLES, c))

// The product of the tables of this pass, without their scales.
vec3 tables_product(Cosines c)
{
    vec3 product = vec3(1.0);
#if FIRST_TABLE <= 0 && LAST_TABLE >= 0
    product *= TABLE_AT(0);
#endif
#if FIRST_TABLE <= 1 && LAST_TABLE >= 1
    product *= TABLE_AT(1);
#endif
#if FIRST_TABLE <= 2 && LAST_TABLE >= 2
    product *= TABLE_AT(2);
#endif
#if FIRST_TABLE <= 3 && LAST_TABLE >= 3
    product *= TABLE_AT(3);
#endif
    return product;
}

// f_r cos a from the product of all tables.
vec3 tables_gloss(Cosines c, vec3 product)
{
    if (!(c.a > 0.0 && c.b > 0.0))
        return vec3(0.0);
    float scale = table_scales.x * (TABLES > 1 ? table_scales.y : 1.0) * (TABLES > 2 ? table_scales.z : 1.0) *
                  (TABLES > 3 ? table_scales.w : 1.0);
#ifdef TIMES_COS_A
    scale *= c.a;
#endif
    return scale * product;
}

#ifdef FOLDED
// Diffuse light and gloss from a table that holds the ambient light, too, without that: it stays where the lamp's is
// shadowed. Where only the back would shine the table is read beside its lobe.
vec3 tables_folded(Cosines c)
{
    if (!(c.b > 0.0))
        c.mirror = c.half_normal = -1.0;
    return c.a > 0.0 ? table_scales.x * tables_product(c) - table_ambient : vec3(0.0);
}
#endif
#endif
