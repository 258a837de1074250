/* The clear coat of a material: a film of index 1.5 over everything else, Lo = F Lm + (1 - F) Lbase [Heidrich
 * and Seidel 1999, 4.4]. Pure; threads: any. */
#ifndef TOILE_RENDER_BRDF_COAT_H
#define TOILE_RENDER_BRDF_COAT_H

#define TL_COAT_INDEX 1.5f

/* Fresnel reflectance F of the film, in [0, 1], for the cosine of the angle between its normal and the
 * light. */
float tl_coat_reflectance(float cosine);

#endif
