/* Environments: light from infinitely far away, as linear Rec. 709 radiance in float.
 *
 * Lat-long: u = 0.5 + atan2(x, -z)/2pi, v = acos(y)/pi, so the image's centre looks along -Z and +X is right
 * of it. Cube: six square faces stacked from the top in GL order and GL orientation (+X -X +Y -Y +Z -Z; on
 * each face, texel row 0 is t = 0 of the GL cube map specification, table 8.19 of OpenGL 4.5). Real files
 * hold negative values, NaN, Inf: these are cleaned (negative and NaN -> 0, +Inf -> the largest finite value
 * of the file) and counted. Values beyond the half range are kept. Immutable once made.
 *
 * The other layouts are those of files that `toile env` wrote (render/env/layout.h): app/scene/moving_light.h
 * converts them to lat-long before anything is drawn with them. */
#ifndef TOILE_ASSETS_BASE_ENVIRONMENT_H
#define TOILE_ASSETS_BASE_ENVIRONMENT_H

#include "assets/base/image.h"

#include <cglm/struct.h>

#include <stdbool.h>

enum tl_env_layout { TL_ENV_LATLONG, TL_ENV_CUBE, TL_ENV_SPHERE, TL_ENV_PARABOLOID, TL_ENV_OCTAHEDRAL };

typedef struct tl_environment {
    char *name; /* file name or "studio" */
    enum tl_env_layout layout;
    tl_image image;                              /* F32, RGB */
    tl_image backdrop;                           /* the same in size, without the lamps that a picture should
                                                    not show behind the figure; no texels: `image` */
    size_t negative_count, nan_count, inf_count; /* channel values cleaned on reading */
    float peak;                                  /* largest channel value */
    vec3s ground;                                /* reflectance of the place's own ground (assets/
                                                    adaptation); 0: unknown */
    vec3s shown;                                 /* factors of its light in pictures (assets/adaptation); 0:
                                                    1, as for what is built in */
} tl_environment;

/* Whether no texel of a picture has light. It looks until it finds some.
 *
 * Errors: none. Threads: any. */
bool tl_environment_is_black(const tl_environment *environment);

/* Frees what the environment owns and zeroes it; a zeroed environment is accepted.
 *
 * Errors: none. Lifetime: pointers into the environment end here. Threads: one, while no other uses it. */
void tl_environment_release(tl_environment *environment);

#endif
