/* Environments: light from infinitely far away, as linear Rec. 709 radiance in float.
 *
 * Lat-long: u = 0.5 + atan2(x, -z)/2pi, v = acos(y)/pi, so the image's centre looks along -Z and +X is right
 * of it. Cube: six square faces stacked from the top in GL order and GL orientation (+X -X +Y -Y +Z -Z; on
 * each face, texel row 0 is t = 0 of the GL cube map specification, table 8.19 of OpenGL 4.5). Real files
 * hold negative values, NaN, Inf: these are cleaned (negative and NaN -> 0, +Inf -> the largest finite value
 * of the file) and counted. Values beyond the half range are kept. Immutable once made. */
#ifndef TOILE_ASSETS_ENVIRONMENT_H
#define TOILE_ASSETS_ENVIRONMENT_H

#include "assets/base/image.h"

enum tl_env_layout { TL_ENV_LATLONG, TL_ENV_CUBE };

typedef struct tl_environment {
    char *name; /* file name or "studio" */
    enum tl_env_layout layout;
    tl_image image;                              /* F32, RGB */
    size_t negative_count, nan_count, inf_count; /* channel values cleaned on reading */
    float peak;                                  /* largest channel value */
} tl_environment;

/* .exr (lat-long, or cube by its envmap attribute or its 1:6 / 6:1 shape) or Radiance .hdr. */
bool tl_environment_load(const char *path, tl_environment *out, tl_error *error);
void tl_environment_release(tl_environment *environment);

/* Built-in lights that need no file (assets/builtin/studio.c): soft boxes and one strong small lamp in a grey
 * room, 512 x 256 lat-long. */
tl_environment tl_environment_studio(void);

/* The same radiance from everywhere; the furnace. */
tl_environment tl_environment_constant(float red, float green, float blue);

#endif
