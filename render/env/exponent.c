#include "render/env/exponent.h"

#include <math.h>

float tl_lobe_exponent(float glossiness)
{
    float matt = 1 - fminf(fmaxf(glossiness, 0), 1);
    return matt > 1e-6f ? 1 / matt : 1e6f;
}

float tl_lobe_cosine(float exponent, float cosine)
{
    return cosine > 0 ? (exponent + 1) / (float)(2 * M_PI) * powf(cosine, exponent) : 0;
}
