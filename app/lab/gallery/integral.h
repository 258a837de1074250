/* The exact picture of light.method maps (render/envmap/envmap.h): at every sample of the surfaces the terms
 * are evaluated from the environment's own texels. A lobe is summed over all directions, each texel by its
 * solid angle; a mirrored or refracted ray reads the environment where it points. No map, no filtered copy
 * and no table takes part, so that what the maps lose is what the difference shows.
 *
 * It shares with the maps the normals and positions of the samples, which are those of the G-buffer.
 * Environments of layout lat-long only. World space. Pure; results do not depend on the number of threads. */
#ifndef TOILE_APP_LAB_GALLERY_INTEGRAL_H
#define TOILE_APP_LAB_GALLERY_INTEGRAL_H

#include "app/settings/settings.h"

struct tl_integral_request {
    const tl_environment *environment;
    float environment_yaw; /* rad */
    vec3s eye;
    const struct tl_settings *settings; /* maps and material */
    const tl_image *normals, *points;   /* F32 x3 (render/inspect/aovs.h) */
    const tl_image *diffuse;            /* F32 x3: kd */
    const tl_image *covered;            /* F32 x4: alpha above 0 where there is a surface */
};

/* F32 RGBA, premultiplied, of half the size: each pixel is the mean of 2 x 2 samples. */
tl_image tl_integral_make(const struct tl_integral_request *request);

#endif
