#include "render/brdf/brdf.h"

#include <math.h>

static float clamp01(float x)
{
    return x > 0 ? fminf(x, 1) : 0; /* NaN: 0 */
}

float tl_fresnel_schlick(float f0, float cosine)
{
    float away = 1 - clamp01(cosine), fifth = away * away * away * away * away;
    return f0 + (fminf(50 * f0, 1) - f0) * fifth;
}

/* Fresnel's equations [Born and Wolf, 1.5.2]; an index below 1 reflects totally beyond its critical angle. */
float tl_fresnel_dielectric(float index, float cosine)
{
    float c = clamp01(cosine), inside_squared = index * index - (1 - c * c);
    if (!(inside_squared > 0))
        return 1;
    float g = sqrtf(inside_squared); /* index times the refracted ray's cosine */
    if (c <= 0)
        return 1;
    float s = (c - g) / (c + g), p = (index * index * c - g) / (index * index * c + g);
    return clamp01((s * s + p * p) / 2);
}

/* The same with a complex index [Born and Wolf, 14.4; in this real form: Hecht and others]: (p + iq)^2 = (n +
 * ik)^2 - sin^2. In double: n^2 + k^2 of metals is large against what is left of it. */
float tl_fresnel_conductor(float index, float extinction, float cosine)
{
    double c = (double)clamp01(cosine), s2 = 1 - c * c, n = (double)index, k = (double)extinction;
    if (k == 0)
        return tl_fresnel_dielectric(index, cosine);
    if (c <= 0)
        return 1;
    double real = n * n - k * k - s2, size = hypot(real, 2 * n * k);
    double p = sqrt(fmax((size + real) / 2, 0));
    double across = (size - 2 * p * c + c * c) / (size + 2 * p * c + c * c);
    double along =
        across * (c * c * size - 2 * p * c * s2 + s2 * s2) / (c * c * size + 2 * p * c * s2 + s2 * s2);
    return clamp01((float)((across + along) / 2));
}

vec3s tl_brdf_fresnel(const struct tl_brdf *brdf, float cosine)
{
    const struct tl_gloss *gloss = &brdf->gloss;
    vec3s reflectance = brdf->f0;
    if (gloss->fresnel == TL_FRESNEL_DIELECTRIC)
        return glms_vec3_scale(reflectance, tl_fresnel_dielectric(gloss->index, cosine));
    if (gloss->fresnel == TL_FRESNEL_CONDUCTOR)
        return glms_vec3_scale(reflectance, tl_fresnel_conductor(gloss->index, gloss->extinction, cosine));
    for (int c = 0; c < 3; c++)
        reflectance.raw[c] = tl_fresnel_schlick(reflectance.raw[c], cosine);
    return reflectance;
}
