#include "render/scene/lamp.h"

#include <math.h>

struct tl_lamplight tl_lamp_at(const struct tl_lamp *lamp, vec3s point, vec3s otherwise)
{
    if (lamp->kind == TL_LAMP_DIRECTIONAL)
        return (struct tl_lamplight){lamp->direction, INFINITY, lamp->irradiance};
    vec3s towards = glms_vec3_sub(lamp->position, point);
    float distance = glms_vec3_norm(towards), counted = fmaxf(distance, TL_LAMP_NEAREST_M);
    return (struct tl_lamplight){
        .direction = distance > 0 ? glms_vec3_divs(towards, distance) : otherwise,
        .distance_m = distance,
        .irradiance = glms_vec3_divs(lamp->irradiance, counted * counted),
    };
}
