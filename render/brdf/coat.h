/* The clear coat of a material: a film of index 1.5 over all else, Lo = F Lm + (1 - F) Lbase [Heidrich and
 * Seidel 1999, section 4.3]. Pure. */
#ifndef TOILE_RENDER_BRDF_COAT_H
#define TOILE_RENDER_BRDF_COAT_H

#define TL_COAT_INDEX 1.5f

/* F: what a film reflects of light at this cosine to its normal, in [0, 1]. */
float tl_coat_reflectance(float cosine);

#endif
