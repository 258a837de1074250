#ifndef TOILE_RENDER_BRDF_GGX_GGX_LOBES_INTERNAL_H
#define TOILE_RENDER_BRDF_GGX_GGX_LOBES_INTERNAL_H

/* The table: thousandths of the angle over the width, of the base-2 logarithm of the variance over the
 * squared width, and of the cosine; ten-thousandths of the weight. */
#define TL_GGX_ROUGHNESSES     10
#define TL_GGX_FIRST_ROUGHNESS 0.1f
#define TL_GGX_ELEVATIONS      12
#define TL_GGX_FIRST_ELEVATION 0.113f /* the root of its share of a right angle, in which rows are even */
#define TL_GGX_FIGURES         4
#define TL_GGX_LOBES_ALL       16 /* 1 + 3 + 5 + 7 */
extern const short tl_ggx_table[TL_GGX_ROUGHNESSES * TL_GGX_ELEVATIONS * TL_GGX_LOBES_ALL * TL_GGX_FIGURES];

/* The figures of the first lobe of a row. */
static inline const short *tl_ggx_row(int roughness, int elevation)
{
    return &tl_ggx_table[(roughness * TL_GGX_ELEVATIONS + elevation) * TL_GGX_LOBES_ALL * TL_GGX_FIGURES];
}

#endif
