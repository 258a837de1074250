/* sRGB [IEC 61966-2-1] and linear Rec. 709, which have the same primaries and white (D65). Pure; threads:
 * any. */
#ifndef TOILE_CONFIG_COLOUR_SRGB_H
#define TOILE_CONFIG_COLOUR_SRGB_H

#include <stdint.h>

/* The transfer function of one channel. */
float tl_srgb_to_linear(float encoded);
float tl_srgb_from_linear(float linear);

/* Linear Rec. 709 of an sRGB colour 0xRRGGBB. */
void tl_srgb_decode(uint32_t rgb, float linear[3]);
/* The nearest 0xRRGGBB; channels outside of [0, 1] are clamped. */
uint32_t tl_srgb_encode(const float linear[3]);

/* The same as text: "#a1b2c3". */
struct tl_hex {
    char text[8];
};
struct tl_hex tl_hex_of(const float linear[3]);

#endif
