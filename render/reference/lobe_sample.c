#include "render/reference/lobe_sample.h"

#include "render/gpu/vectors.h"

#include "render/gpu/terms_begin.h"

#include "render/brdf/sample_terms.glsl"

#include "render/gpu/terms_end.h"

#include <math.h>

#define LOBE_END 40.0f /* a lobe counts as zero below exp(-40) of its peak */

/* log1p keeps the digits of narrow lobes near the peak. */
float tl_lobe_value(float exponent, float off)
{
    if (off >= 1 || exponent * off > LOBE_END)
        return 0;
    return (exponent + 1) / (2 * (float)M_PI) * expf(exponent * log1pf(-off));
}

vec3s tl_lobe_sample(vec3s axis, float exponent, double height, double turn, float *off)
{
    *off = lobe_off_axis(exponent, (float)height);
    return lobe_direction(axis, *off, (float)(turn - floor(turn)));
}
