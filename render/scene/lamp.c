#include "render/scene/lamp.h"

struct tl_lamplight tl_lamp_at(const struct tl_lamp *lamp, vec3s point, vec3s otherwise)
{
    const vec4s place = tl_lamp_place(lamp);
    return (struct tl_lamplight){
        .direction = towards_lamp(place, point, otherwise),
        .distance_m = lamp->kind == TL_LAMP_POINT ? glms_vec3_distance(lamp->position, point) : INFINITY,
        .irradiance = glms_vec3_scale(lamp->irradiance, lamp_falloff(place, point)),
    };
}
