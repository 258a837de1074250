// The light of a lamp at a point (lamp.h), for GLSL and C. `lamp`: its position, 1; or the unit direction towards it, 0.
#ifdef GL_core_profile
#include "vectors.glsl"
#endif
#ifndef TERM
#define TERM
#endif

#define TL_LAMP_NEAREST_M 1e-3f // points that are nearer are lit as at that distance

TERM vec3 towards_lamp(vec4 lamp, vec3 point, vec3 otherwise)
{
    vec3 at = vec3(lamp.x, lamp.y, lamp.z), towards = direction_or(vec3_subtract(at, point), otherwise);
    return vec3(lamp.w > 0.0f ? towards.x : at.x, lamp.w > 0.0f ? towards.y : at.y, lamp.w > 0.0f ? towards.z : at.z);
}

// The factor on its irradiance.
TERM float lamp_falloff(vec4 lamp, vec3 point)
{
    vec3 away = vec3_subtract(vec3(lamp.x, lamp.y, lamp.z), point);
    return lamp.w > 0.0f ? 1.0f / max(dot(away, away), TL_LAMP_NEAREST_M * TL_LAMP_NEAREST_M) : 1.0f;
}
