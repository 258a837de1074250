// The series of a reciprocal root; and Newton's step, dot products and powers as register combiners compute them, in 8 bits
// and a sign [Schroecker 2002, 4.2.3 and 5.2]. Written once for GLSL and C (normalise.h).
#ifdef GL_core_profile
#include "vectors.glsl"
#endif
#ifndef TERM
#define TERM
#endif

// The factor that makes a vector unit whose square is nearly 1, with 1 to 3 terms after the first [op. cit., eq. 5]. One is
// Newton's step.
TERM float unit_series(float square, int terms)
{
    float x = square - 1.0f, sum = terms > 2 ? -0.3125f * x : 0.0f;
    sum = terms > 1 ? (sum + 0.375f) * x : 0.0f;
    return 1.0f + (sum - 0.5f) * x;
}

// The nearest whole number of steps; a register has 255 either way. Its products are whole numbers that a float holds, so
// that only their quotients are rounded.
TERM float register_steps(float x)
{
    float bounded = clamp(x, -255.0f, 255.0f);
    return bounded < 0.0f ? -floor(0.5f - bounded) : floor(bounded + 0.5f);
}

TERM float register_value(float x)
{
    return register_steps(255.0f * x) / 255.0f;
}

TERM float register_newton(float steps, float missing)
{
    return register_steps(steps + register_steps(steps * missing / 510.0f)) / 255.0f;
}

// v + v/2 (1 - v.v) [op. cit., eq. 6]: v, and each dot product, product and sum, is rounded to a register.
TERM vec3 register_newton_vector(vec3 v)
{
    vec3 steps = vec3(register_steps(255.0f * v.x), register_steps(255.0f * v.y), register_steps(255.0f * v.z));
    float missing = 255.0f - register_steps(dot(steps, steps) / 255.0f);
    return vec3(register_newton(steps.x, missing), register_newton(steps.y, missing), register_newton(steps.z, missing));
}

// cosine^(2^squarings).
TERM float register_power(float cosine, int squarings)
{
    float steps = register_steps(255.0f * max(cosine, 0.0f));
    for (int i = 0; i < squarings; i++)
        steps = register_steps(steps * steps / 255.0f);
    return steps / 255.0f;
}
