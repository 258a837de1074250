/* Making interpolated vectors unit again, five ways [001, section 4.2 and figure 9].
 *
 * Between two unit vectors at an angle, linear interpolation leaves the sphere and slows down towards the
 * middle of the arc; slerp is what it stands for. The cube maps hold directions in n bits a channel, range
 * compressed from [-1, 1], and are looked up as GL does. Newton's step is v/2 (3 - v.v), which needs v nearly
 * unit; register combiners do it in 8 bits and a sign, each product and sum rounded. Pure; the same on every
 * machine. */
#ifndef TOILE_RENDER_BRDF_NORMALISE_H
#define TOILE_RENDER_BRDF_NORMALISE_H

#include <cglm/struct.h>

#include <stdint.h>

enum tl_normalisation {
    TL_NORMALISE_NONE,
    TL_NORMALISE_CUBE8,
    TL_NORMALISE_CUBE16,
    TL_NORMALISE_NEWTON,
    TL_NORMALISE_EXACT,
    TL_NORMALISE_NEWTON_FIXED, /* measured only */
    TL_NORMALISE_COUNT
};
extern const char *const tl_normalisation_names[]; /* none cube8 cube16 newton exact newton_fixed, NULL */

/* Unit vectors over a cube's faces as texels: round((n + 1)/2 * (2^bits - 1)) in three channels, faces and
 * rows as GL has them. */
struct tl_normal_cube {
    int size, bits; /* texels a side; 8 or 16 */
    void *texels;   /* [face][y][x][3], uint8_t or uint16_t */
};
struct tl_normal_cube tl_normal_cube_make(int size, int bits);
void tl_normal_cube_release(struct tl_normal_cube *cube);
/* GL_LINEAR, seamless; expanded to [-1, 1]. */
vec3s tl_normal_cube_at(const struct tl_normal_cube *cube, vec3s v);

/* `cube` for the cube maps. A zero vector stays zero. */
vec3s tl_normalise(int method, const struct tl_normal_cube *cube, vec3s v);

/* Along arcs of `angle` rad between two unit vectors, over many arcs and places on each. */
struct tl_normalise_error {
    double length;    /* largest | |v| - 1 | */
    double direction; /* rad, largest angle to the exactly normalised vector */
    double vector; /* root mean square distance from the exactly normalised vector: the method's own error */
    double slerp;  /* ... from slerp: with what linear interpolation does to the speed */
    double highlight; /* largest error of (v.h)^8 against slerp, h anywhere on the arc [001, figure 9] */
};
#define TL_NORMALISE_CUBE_SIZE 256 /* texels, of the cubes measured */
struct tl_normalise_error tl_normalise_error(int method, double angle);
/* rad: up to which angle between vertices one method's own error is below another's, which does not grow. */
double tl_normalise_limit(int method, int against);

#endif
