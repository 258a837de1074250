/* A lamp of a frame: world space, metres. */
#ifndef TOILE_RENDER_SCENE_LAMP_H
#define TOILE_RENDER_SCENE_LAMP_H

#include "assets/base/surface.h"

/* A light that is no part of the environment. Its irradiance on a surface that faces it is `irradiance`, at
 * every distance if it is directional, and at 1 m, falling with the square of the distance, if it is a point.
 */
enum tl_lamp_kind { TL_LAMP_NONE, TL_LAMP_DIRECTIONAL, TL_LAMP_POINT };
struct tl_lamp {
    enum tl_lamp_kind kind;
    vec3s direction;  /* DIRECTIONAL: towards the light, unit */
    vec3s position;   /* POINT: metres */
    vec3s irradiance; /* linear Rec. 709, pi times the radiance that a white matt surface facing it sends back
                       */
};
#define TL_LAMPS_MAX 4

#endif
