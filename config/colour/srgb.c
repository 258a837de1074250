#include "config/colour/srgb.h"

#include <math.h>
#include <stdio.h>

float tl_srgb_to_linear(float encoded)
{
    return encoded <= 0.04045f ? encoded / 12.92f : powf((encoded + 0.055f) / 1.055f, 2.4f);
}

float tl_srgb_from_linear(float linear)
{
    return linear <= 0.0031308f ? linear * 12.92f : 1.055f * powf(linear, 1 / 2.4f) - 0.055f;
}

void tl_srgb_decode(uint32_t rgb, float linear[3])
{
    for (int c = 0; c < 3; c++)
        linear[c] = tl_srgb_to_linear((float)(rgb >> (16 - 8 * c) & 255) / 255);
}

uint32_t tl_srgb_encode(const float linear[3])
{
    uint32_t rgb = 0;
    for (int c = 0; c < 3; c++)
        rgb = rgb << 8 | (uint32_t)(255 * tl_srgb_from_linear(fminf(fmaxf(linear[c], 0), 1)) + 0.5f);
    return rgb;
}

struct tl_hex tl_hex_of(const float linear[3])
{
    struct tl_hex hex;
    snprintf(hex.text, sizeof hex.text, "#%06x", (unsigned)tl_srgb_encode(linear) & 0xFFFFFFu);
    return hex;
}
