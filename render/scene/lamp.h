/* A lamp of a frame: world space, metres. Pure; threads: any. */
#ifndef TOILE_RENDER_SCENE_LAMP_H
#define TOILE_RENDER_SCENE_LAMP_H

#include "assets/base/surface.h"
#include "render/gpu/vectors.h"

#include "render/gpu/terms_begin.h"

#include "render/scene/lamp_terms.glsl"

#include "render/gpu/terms_end.h"

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

/* The `lamp` of lamp_terms.glsl. */
TL_INLINE vec4s tl_lamp_place(const struct tl_lamp *lamp)
{
    const bool is_near = lamp->kind == TL_LAMP_POINT;
    const vec3s at = is_near ? lamp->position : lamp->direction;
    return (vec4s){{at.x, at.y, at.z, is_near}};
}

/* The light of a lamp at a point. */
struct tl_lamplight {
    vec3s direction;  /* towards the lamp, unit; `otherwise` where the two coincide */
    float distance_m; /* infinite for DIRECTIONAL */
    vec3s irradiance; /* on a surface that faces it */
};
/* Unshadowed light at `point`. */
struct tl_lamplight tl_lamp_at(const struct tl_lamp *lamp, vec3s point, vec3s otherwise);

#endif
