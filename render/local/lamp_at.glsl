// The light of a lamp at a point (render/scene/lamp.h). `lamp`: its position, 1; or the direction towards it, 0.
#include "vectors.glsl"
const float NEAREST_M = 1e-3; // TL_LAMP_NEAREST_M

vec3 towards_lamp(vec4 lamp, vec3 point, vec3 otherwise)
{
    return direction_or(lamp.w > 0.0 ? lamp.xyz - point : lamp.xyz, otherwise);
}

// The factor on its irradiance.
float lamp_falloff(vec4 lamp, vec3 point)
{
    vec3 away = lamp.xyz - point;
    return lamp.w > 0.0 ? 1.0 / max(dot(away, away), NEAREST_M * NEAREST_M) : 1.0;
}
