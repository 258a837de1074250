// Arithmetic of vectors for texts that are GLSL and C (vectors.h): C has no operators for them. GCC's and Clang's vector
// types have some, but loops over lanes of such types do not become vector code.
#ifdef GL_core_profile
#ifndef TERM
#define TERM
#endif
vec3 vec3_add(vec3 a, vec3 b)
{
    return a + b;
}

vec3 vec3_subtract(vec3 a, vec3 b)
{
    return a - b;
}

vec3 vec3_multiply(vec3 a, vec3 b)
{
    return a * b;
}

vec3 vec3_scale(vec3 a, float factor)
{
    return a * factor;
}
#endif

// A direction that is never NaN: vectors too short or too long to have one become `fallback`.
TERM vec3 direction_or(vec3 v, vec3 fallback)
{
    float square = dot(v, v), scale = inversesqrt(square);
    bool has_one = square > 1e-30f && square < 3e38f;
    return vec3(has_one ? scale * v.x : fallback.x, has_one ? scale * v.y : fallback.y,
                has_one ? scale * v.z : fallback.z);
}
