/* Cubes from environments, and look-ups in an environment in its own layout. Pure, but for the cache of files
 * (config/cache/cache.h), which cubes are kept in between runs; results depend neither on it nor on the
 * number of threads.
 *
 * Environments must hold RGB floats. Directions are in the environment's own frame (before its yaw). */
#ifndef TOILE_RENDER_ENV_FROM_ENVIRONMENT_H
#define TOILE_RENDER_ENV_FROM_ENVIRONMENT_H

#include "assets/environment/environment.h"
#include "render/env/cube.h"
#include "render/env/resample.h"

/* Area average of the environment over every texel of a new cube. No source texel is missed: a single bright
 * texel keeps its energy within 1 %. The caller releases the cube. */
tl_cube tl_cube_from_environment(const tl_environment *environment, int size);
/* The same, to the bit, for a sequence of environments. The weights that depend on the sizes only are cached
 * in `weights` (zeroed at first; released by tl_resampling_release), which makes later calls about fifty
 * times as fast. */
tl_cube tl_cube_from_environment_with(const tl_environment *environment, int size,
                                      struct tl_resampling *weights);

/* Radiance of the environment's texel in a unit direction. The reference takes it as constant over the texel.
 */
vec3s tl_environment_texel(const tl_environment *environment, vec3s direction);

/* Place of a unit direction in a lat-long picture: u and v in [0, 1]. */
void tl_environment_place(vec3s direction, float *u, float *v);
/* Bilinear fetch from a lat-long picture (F32, RGB), whose left and right edges meet. */
vec3s tl_environment_fetch(const tl_image *latlong, float u, float v);

/* Bilinear fetch from the environment in its own layout. */
vec3s tl_environment_sample(const tl_environment *environment, vec3s direction);

#endif
