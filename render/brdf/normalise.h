/* Renormalisation of interpolated vectors by several methods [Schroecker 2002, 4.2 and figure 9].
 *
 * Linear interpolation between two unit vectors leaves the sphere and slows down towards the middle of the
 * arc; slerp is the exact interpolation that it approximates. The cube maps hold directions in n bits a
 * channel, range compressed from [-1, 1], and are looked up as GL does. Newton's step is v/2 (3 - v.v), which
 * needs v to be nearly unit; NEWTON8 is that step of register combiners (normalise_terms.glsl). Pure; results
 * are the same on every machine. */
#ifndef TOILE_RENDER_BRDF_NORMALISE_H
#define TOILE_RENDER_BRDF_NORMALISE_H

#include "render/gpu/vectors.h"

#include "render/gpu/terms_begin.h"

#include "render/brdf/normalise_terms.glsl"

#include "render/gpu/terms_end.h"

enum tl_normalisation {
    TL_NORMALISE_NONE,
    TL_NORMALISE_CUBE8,
    TL_NORMALISE_CUBE16,
    TL_NORMALISE_NEWTON,
    TL_NORMALISE_TAYLOR2, /* Newton's step is the series' linear term */
    TL_NORMALISE_TAYLOR3,
    TL_NORMALISE_NEWTON8,
    TL_NORMALISE_SLERP, /* of corners (render/local/slerp.glsl); EXACT of one vector */
    TL_NORMALISE_EXACT,
    TL_NORMALISE_COUNT
};
extern const char *const tl_normalisation_names[]; /* ends with NULL */

/* A cube map of unit vectors: round((n + 1)/2 * (2^bits - 1)) in three channels, faces and rows as in GL.
 * Released by tl_normal_cube_release. */
struct tl_normal_cube {
    int size, bits; /* texels a side; 8 or 16 */
    void *texels;   /* [face][y][x][3], uint8_t or uint16_t */
};
struct tl_normal_cube tl_normal_cube_make(int size, int bits);
void tl_normal_cube_release(struct tl_normal_cube *cube);
/* The vector in a direction, as GL_LINEAR reads a seamless cube map; expanded to [-1, 1]. */
vec3s tl_normal_cube_at(const struct tl_normal_cube *cube, vec3s v);

/* Renormalises v by a method of enum tl_normalisation. `cube` is used by CUBE8 and CUBE16 only. A zero vector
 * stays zero. */
vec3s tl_normalise(int method, const struct tl_normal_cube *cube, vec3s v);

/* Errors of a method along arcs of `angle` rad between two unit vectors, over many arcs and positions on
 * each. */
struct tl_normalise_error {
    double length;    /* largest | |v| - 1 | */
    double direction; /* rad, largest angle to the exactly normalised vector */
    double vector; /* root mean square distance from the exactly normalised vector: the method's own error */
    double slerp;  /* the same from slerp: includes the uneven speed of linear interpolation */
    double highlight; /* largest error of (v.h)^8 against slerp, h anywhere on the arc */
};
#define TL_NORMALISE_CUBE_SIZE 256 /* texels along a face of the cubes measured */
struct tl_normalise_error tl_normalise_error(int method, double angle);
/* The largest angle between vertices (rad) up to which the own error of `method` is below that of `against`,
 * which must not depend on the angle. */
double tl_normalise_limit(int method, int against);

#endif
