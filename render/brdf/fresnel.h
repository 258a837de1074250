/* Fresnel reflectance of one interface, from the cosine of the angle to its normal, clamped to [0, 1]. Pure;
 * threads: any. */
#ifndef TOILE_RENDER_BRDF_FRESNEL_H
#define TOILE_RENDER_BRDF_FRESNEL_H

/* Unpolarised reflectance of one interface by Fresnel's equations [Born and Wolf 1999, 1.5.2 and 14.4];
 * `index` and `extinction` are the real and imaginary part of the refractive index. */
float tl_fresnel_dielectric(float index, float cosine);
float tl_fresnel_conductor(float index, float extinction, float cosine);
/* Schlick's approximation [Schlick 1994, eq. 15] with f90 = min(50 f0, 1). */
float tl_fresnel_schlick(float f0, float cosine);

#endif
