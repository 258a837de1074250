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

float tl_fresnel_conductor(float index, float extinction, float cosine)
{
    return fresnel_conductor(index, extinction, clamp01(cosine));
}
