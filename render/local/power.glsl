// Powers of cosines.
#include "normalise_terms.glsl"

// log(1 - x) by its series where x is small, so that no digits are lost.
float log_of_rest(float x)
{
    float y = x / (2.0 - x), y2 = y * y;
    return x < 0.1 ? -2.0 * y * (1.0 + y2 * (1.0 / 3.0 + y2 * (0.2 + y2 / 7.0))) : log(1.0 - x);
}

float exact_power(float cosine, float sine2, float exponent)
{
    return cosine > 0.0 ? exp(exponent * (sine2 < 0.5 ? 0.5 * log_of_rest(sine2) : log(cosine))) : 0.0;
}

#ifdef POWER_TABLE
layout(binding = 23) uniform sampler2D power_table; // of the material's exponent
#endif

// POWER_FIXED8 repeats the squaring of register combiners in 8 bits and a sign, as often as the nearest power of two
// requires. POWER_TABLE interpolates a table of 8-bit values.
float power(float cosine, float sine2, float exponent)
{
#if defined(POWER_FIXED8)
    return register_power(cosine, int(log2(exponent) + 0.5));
#elif defined(POWER_TABLE)
    float count = float(textureSize(power_table, 0).x);
    return textureLod(power_table, vec2((clamp(cosine, 0.0, 1.0) * (count - 1.0) + 0.5) / count, 0.5), 0.0).r;
#else
    return exact_power(cosine, sine2, exponent);
#endif
}
