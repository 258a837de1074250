#include "render/env/exponent.h"

#include "render/env/lobes_fetch.h"

#include <math.h>

float tl_lobe_exponent(float glossiness)
{
    return lobe_exponent(glossiness);
}

float tl_lobe_cosine(float exponent, float cosine)
{
    return cosine > 0 ? (exponent + 1) / (float)(2 * M_PI) * powf(cosine, exponent) : 0;
}
