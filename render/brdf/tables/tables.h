/* Reflectance from tables: each model factored into functions of two inputs at most, stored as textures, and
 * multiplied [Heidrich and Seidel 1999, 3]. The GPU and the CPU read the same texels.
 *
 *     f_r cos a = product over the tables of  table.scale * bilinear(table, u, v)     [* cos a: times_cos_a]
 *     u = x.scale * input + x.bias,  v = y.scale * input + y.bias,                    clamped to the edge
 *
 * where an input is a dot product, or acos of it if axis.angle is set. The coordinates are GL's: texel i's
 * centre at (i + 0.5) / width; the ends of an axis' range lie on the first and the last texel's centre. Being
 * affine in dot products, they can be computed by one texture matrix or interpolated. The caller sets the
 * result to 0 where n.l <= 0 or n.v <= 0.
 *
 *     PHONG             K(r.l) F(n.v)
 *     BLINN_PHONG       K(n.h) F(h.l)
 *     COSINE_LOBE       K(r.l) F(h.l)                               times_cos_a
 *     TORRANCE_SPARROW  F(h.l) D(n.h)    G(n.l, n.v) / (pi n.v)     V_GROOVES: G / (pi n.v) over (G, n.v)
 *     WARD              D(h.t, h.b)      sqrt(n.l / n.v)   F(h.l)
 *                       as published only: in the bounded form h.l is squared below the line
 *     BANKS             K(t.l, t.v)      F(n.v)                     times_cos_a
 *
 * The axes of K and D end where these have fallen to 1e-6 of their peak, so that all texels cover the visible
 * part. With 512 texels the error is below 0.5 % up to s = 1e4. Beyond that a cosine in float does not
 * resolve the angles of so narrow a lobe (8 to 20 % at s = 1e6); WARD is not affected, because its axes are
 * sines. BANKS, whose ridge runs diagonally across its table, keeps 0.5 % up to s = 500.
 *
 * Folded (PHONG, BLINN_PHONG, COSINE_LOBE): ambient + diffuse n.l / pi + F K [n.l], over (r.l or n.h, n.l),
 * in one table: F stays that of normal incidence. Where n.l <= 0 the table holds the ambient part, so that the caller tests n.v
 * only.
 *
 * `texels` are rows from v = 0 up, without padding (GL_UNPACK_ALIGNMENT 1), `channels` 1 (GL_RED: swizzle to
 * RGB) or 3: uint8_t or uint16_t, normalised (GL_R8, GL_RGB16, ...), or float. Pure; threads: any. */
#ifndef TOILE_RENDER_BRDF_TABLES_TABLES_H
#define TOILE_RENDER_BRDF_TABLES_TABLES_H

#include "render/brdf/brdf.h"

enum tl_precision { TL_PRECISION_FIXED8, TL_PRECISION_FIXED16, TL_PRECISION_FLOAT };

/* The input of an axis; t is the tangent of the frame and b its bitangent. */
enum tl_table_input {
    TL_AXIS_NONE, /* a table of one row, the same for every v */
    TL_AXIS_N_DOT_L,
    TL_AXIS_N_DOT_V,
    TL_AXIS_N_DOT_H,
    TL_AXIS_H_DOT_L,
    TL_AXIS_R_DOT_L, /* r: the direction to the viewer mirrored about n */
    TL_AXIS_H_DOT_T,
    TL_AXIS_H_DOT_B,
    TL_AXIS_T_DOT_L,
    TL_AXIS_T_DOT_V,
    TL_AXIS_GROOVES, /* min(1, 2 n.h min(n.l, n.v) / h.l); not affine, so no texture matrix yields it */
    /* Coordinates on a paraboloid map, x / (1 + z) and y / (1 + z), of a vector with components x, y, z along
     * tangent, bitangent and normal. Those of h are divided by the root of their length, so that texels are
     * small where lobes are narrow. Not affine either. */
    TL_AXIS_L_U,
    TL_AXIS_L_V,
    TL_AXIS_V_U,
    TL_AXIS_V_V,
    TL_AXIS_H_U,
    TL_AXIS_H_V,
    TL_AXIS_H_RADIUS, /* the length of these two */
    TL_AXIS_COUNT
};

/* The texture coordinate along one axis: scale * input + bias. */
struct tl_brdf_axis {
    int input;  /* enum tl_table_input */
    bool angle; /* acos(input), rad, instead of the input */
    float scale, bias;
};

/* One factor as a texture. */
struct tl_brdf_table {
    int width, height, channels;
    int precision; /* enum tl_precision */
    void *texels;
    float scale; /* factor on the texels */
    struct tl_brdf_axis x, y;
};

/* The singular factors, G / (pi n.v) and sqrt(n.l / n.v), in fixed point. CLAMPED clamps them to 1, as the
 * hardware of the paper does, which darkens grazing views. SCALED divides them by `constant` and clamps the
 * result, or by their maximum, without clamping. That maximum is 2 / (w sqrt pi) for SMITH. The others are
 * unbounded, and their maximum is the value of the texels next to n.v = 0, so that a constant of about 4 is
 * better in 8 bits. Float tables are never clamped. */
enum tl_table_range { TL_RANGE_CLAMPED, TL_RANGE_SCALED };

struct tl_brdf_table_params {
    int size;       /* texels, N x N; at least 2 */
    int precision;  /* enum tl_precision */
    int range;      /* enum tl_table_range */
    float constant; /* of TL_RANGE_SCALED; 0: the maximum */
    bool angles; /* BANKS: the axes are angles to the thread, which resolve more detail along it than cosines
                  */
    bool folded; /* ambient, diffuse and gloss in one table (see above) */
    vec3s ambient, diffuse; /* folded tables only */
};

/* The factors of one model, or of measured reflectance (factor.h). */
#define TL_BRDF_TABLES_MAX 4
struct tl_brdf_tables {
    int count;
    struct tl_brdf_table tables[TL_BRDF_TABLES_MAX];
    bool times_cos_a;
};

/* Makes the tables of a model. The caller owns them; tl_brdf_tables_release frees and zeroes. */
struct tl_brdf_tables tl_brdf_tables_make(const struct tl_brdf *brdf,
                                          const struct tl_brdf_table_params *params);
void tl_brdf_tables_release(struct tl_brdf_tables *tables);
/* Size of all texels. */
size_t tl_brdf_tables_bytes(const struct tl_brdf_tables *tables);

/* The functions from here to tl_brdf_tables_gloss: tables_read.c.
 * The value of every enum tl_table_input for unit vectors. Not clamped: T_DOT_L and the like may be
 * negative. */
void tl_brdf_inputs(const struct tl_brdf_frame *frame, vec3s l, vec3s v, float inputs[TL_AXIS_COUNT]);

/* The table at texture coordinates, times `scale`, as a GL sampler with GL_LINEAR and GL_CLAMP_TO_EDGE reads
 * it. */
vec3s tl_brdf_table_at(const struct tl_brdf_table *table, float u, float v);
/* f_r cos a by channel: the product of all tables, or 0 where n.l <= 0 or n.v <= 0. */
vec3s tl_brdf_tables_gloss(const struct tl_brdf_tables *tables, const float inputs[TL_AXIS_COUNT]);

#endif
