#include "render/env/exponent.h"

float tl_lobe_exponent(float glossiness)
{
    return lobe_exponent(glossiness);
}

float tl_lobe_cosine(float exponent, float cosine)
{
    return cosine > 0 ? lobe_cosine(exponent, cosine) : 0;
}
