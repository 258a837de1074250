// The lobes' exponents that stand for s (env/lobes.h).
layout(binding = 5) uniform sampler2D exponent_levels; // fractional number of the exponent by log2(s) / LOG_RANGE

const float EXPONENT_LOG_RANGE = 15.0; // of light.c

float exponent_level(float s)
{
    float steps = float(textureSize(exponent_levels, 0).x);
    float place = clamp(log2(s) / EXPONENT_LOG_RANGE, 0.0, 1.0);
    return texture(exponent_levels, vec2((place * (steps - 1.0) + 0.5) / steps, 0.5)).r;
}
