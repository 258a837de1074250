/* Luminance of linear Rec. 709 [ITU-R BT.709-6], in the unit of its channels. Pure; threads: any. */
#ifndef TOILE_CONFIG_COLOUR_LUMINANCE_H
#define TOILE_CONFIG_COLOUR_LUMINANCE_H

static inline float tl_luminance(const float rgb[3])
{
    return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
}

/* In double precision, for sums over an environment: a change of the last place cuts other regions. */
static inline double tl_luminance_exact(const float rgb[3])
{
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

#endif
