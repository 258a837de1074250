#include "render/brdf/fresnel.h"

#include "render/brdf/facets.h"

#include <math.h>

static float clamp01(float x)
{
    return x > 0 ? fminf(x, 1) : 0; /* NaN: 0 */
}

float tl_fresnel_schlick(float f0, float cosine)
{
    return schlick_reflectance(f0, schlick_share(clamp01(cosine)));
}

float tl_fresnel_dielectric(float index, float cosine)
{
    return fresnel_dielectric(index, clamp01(cosine));
}

/* Fresnel's equations with a complex index [Born and Wolf 1999, 14.4], in the real form: (p + iq)^2 = (n +
 * ik)^2 - sin^2. Computed in double, because n^2 + k^2 of metals is large compared with the differences taken
 * from it. */
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
