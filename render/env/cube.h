/* Cube maps on the CPU, the form in which the renderer processes an environment. Faces are in GL order +X -X
 * +Y -Y +Z -Z, rows as GL uploads them (t from 0). Texel (x, y) of a face is centred at s = (x + 0.5) / size,
 * t = (y + 0.5) / size. RGB float, linear radiance. Pure; threads: any. */
#ifndef TOILE_RENDER_ENV_CUBE_H
#define TOILE_RENDER_ENV_CUBE_H

#include "render/gpu/vectors.h"

#include "render/gpu/terms_begin.h"

#include "render/env/directions_terms.glsl"

#include "render/gpu/terms_end.h"

typedef struct tl_cube {
    int size;      /* texels per face side */
    float *texels; /* [6][size][size][3] */
} tl_cube;

/* A black cube. It is owned by the caller; tl_cube_release frees and zeroes. */
tl_cube tl_cube_create(int size);
tl_cube tl_cube_copy(const tl_cube *cube);
void tl_cube_release(tl_cube *cube);
/* Whether no texel has light. */
bool tl_cube_is_black(const tl_cube *cube);

/* Direction (not normalised; its largest component is 1) of face coordinates s, t in [0, 1]. Outside of that
 * range the plane of the face is continued. Inverse of OpenGL 4.5, table 8.19. */
vec3s tl_cube_direction(int face, float s, float t);
/* Face and face coordinates of a direction. */
void tl_cube_locate(vec3s direction, int *face, float *s, float *t);
/* Coordinates of the point in which a direction intersects the plane of a given face. */
void tl_cube_project(int face, vec3s direction, float *s, float *t);
/* Index of the texel in a direction: (face * size + y) * size + x. */
int tl_cube_texel(int size, vec3s direction);
/* Unit direction of the centre of a texel. */
vec3s tl_cube_texel_direction(int size, int texel);
/* Index of texel (x, y) of a face. (x, y) may lie one step outside of the face; then it is the texel of the
 * neighbouring face that touches the border there. */
int tl_cube_texel_across(int size, int face, int x, int y);

/* The world direction of a direction in the environment, which is turned by `yaw` (rad) about +Y,
 * counter-clockwise from above. -yaw is the inverse. */
vec3s tl_turn_direction(vec3s direction, float yaw);

/* Exact solid angle (sr) of the rectangle [s0, s1] x [t0, t1] of any face: the sum of its corners' signed
 * atan2(u v, sqrt(u^2 + v^2 + 1)), (u, v) being the point of the face's plane at distance 1. */
double tl_cube_rectangle_solid_angle(double s0, double t0, double s1, double t1);
/* Exact solid angle (sr) of texel (x, y) of any face. */
float tl_cube_solid_angle(int size, int x, int y);
/* Solid angles (sr) of all texels of a face, which are the same for each face: [size][size]. Bit-identical
 * among the eight mirror images of a texel. */
void tl_cube_solid_angles(int size, float *out);

/* The texels and weights of a seamless bilinear fetch. They depend on the size and the direction only. */
struct tl_cube_taps {
    int texel[4]; /* (face * size + y) * size + x */
    float weight[4];
};
/* The taps of a direction. */
struct tl_cube_taps tl_cube_taps(int size, vec3s direction);
/* Weighted sum of the taps. */
vec3s tl_cube_fetch(const tl_cube *cube, const struct tl_cube_taps *taps);

/* Seamless bilinear fetch, as GL with GL_TEXTURE_CUBE_MAP_SEAMLESS. At a corner the missing texel is the mean
 * of the three texels that exist. */
vec3s tl_cube_sample(const tl_cube *cube, vec3s direction);

#endif
