/* Making interpolated vectors unit again, five ways [001, section 4.2 and figure 9].
 *
 * Between two unit vectors at an angle, linear interpolation leaves the sphere and slows down towards the
 * middle of the arc; slerp is what it stands for. The cube maps hold directions in n bits a channel, range
 * compressed from [-1, 1], and are looked up as GL does. Newton's step is v/2 (3 - v.v), which needs v nearly
 * unit. Pure; the same on every machine. */
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
    TL_NORMALISE_COUNT
};
extern const char *const tl_normalisation_names[]; /* none cube8 cube16 newton exact, NULL */

/* Unit vectors over a cube's faces as texels: round((n + 1)/2 * (2^bits - 1)) in three channels, faces and rows
 * as GL has them. */
struct tl_normal_cube {
    int size, bits; /* texels a side; 8 or 16 */
    void *texels;   /* [face][y][x][3], uint8_t or uint16_t */
};
struct tl_normal_cube tl_normal_cube_make(int size, int bits);
void tl_normal_cube_release(struct tl_normal_cube *cube);
/* GL_LINEAR inside the face, GL_CLAMP_TO_EDGE; expanded to [-1, 1]. */
vec3s tl_normal_cube_at(const struct tl_normal_cube *cube, vec3s v);

/* `cube` for the cube maps. A zero vector stays zero. */
vec3s tl_normalise(int method, const struct tl_normal_cube *cube, vec3s v);

/* Along an arc of `angle` rad between two unit vectors, over many arcs and 65 places on each. */
struct tl_normalise_error {
    double length;    /* largest | |v| - 1 | */
    double direction; /* largest angle to slerp's direction, rad: what none of them mends but by its own error */
    double vector;    /* root mean square distance from the exactly normalised vector: the method's own error */
    double highlight; /* largest error of (n.h)^n, n = 8, h = the arc's middle, against slerp */
};
#define TL_NORMALISE_CUBE_SIZE 256 /* texels, of the cubes measured */
struct tl_normalise_error tl_normalise_error(int method, double angle);

#endif
