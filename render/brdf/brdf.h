/* Reflectance of gloss under one light, evaluated directly: the exact value that every table, interpolation
 * and reduced precision of this folder is measured against.
 *
 * With l towards the light and v towards the viewer, unit, h = (l + v) / |l + v|, r = v reflected about n,
 * cosines a = n.l, b = n.v, t = h.l (all clamped to [0, 1]), d the angle of n and h, p the azimuth of h from
 * the tangent, the functions return f_r(l, v) cos a:
 *
 *     PHONG             F (s + 1)/2pi (r.l)^s                          the PEM method's K_s; not reciprocal
 *     BLINN_PHONG       F (s' + 2)/8pi (n.h)^s' , s' = 4 s             [Blinn 1977]; not reciprocal
 *     COSINE_LOBE       F (s + 2)/2pi (r.l)^s cos a                    [Lewis 1993]; reciprocal
 *     TORRANCE_SPARROW  F D(d) G(a, b) / (pi cos b)                    [Heidrich and Seidel 1999, eq. 1]
 *     WARD              F exp(-tan^2 d (cos^2 p/w_u^2 + sin^2 p/w_v^2)) / (4 pi w_u w_v) sqrt(cos a / cos b)
 *                                                                      [Ward 1992, eq. 5a]; reciprocal
 *     BANKS             F c(s) (sin(t,l) sin(t,v) - (t.l)(t.v))^s cos a        [op. cit., 3.2]
 *
 * D has width w = w_u and the integral of D cos d over h is pi/4, which makes a white surface send back what
 * it gets: GAUSSIAN exp(-(d/w)^2) / (4 w^2 P(w^2)), BECKMANN exp(-(tan d/w)^2) / (4 w^2 cos^4 d). G is
 * SMITH's for Beckmann's slopes, heights correlated: 1 / (1 + L(a) + L(b)), L(x) = (exp(-k^2)/(k sqrt pi) -
 * erfc k)/2, k = 1/(w tan x); or of V_GROOVES: min(1, 2 cos d min(cos a, cos b)/cos t). Reciprocal.
 *
 * BANKS is no physical model. (sin sin - cos cos) is the cosine of l with the nearest mirror direction of a
 * thread along t; c(s) = Gamma(s/2 + 2) / (2 sqrt(pi) Gamma(s/2 + 3/2)) is the factor at which a white thread
 * seen at right angles sends back what it gets.
 *
 * Energy, F = 1: no model sends back more than it gets, but for two: WARD, as its author wrote it, grows
 * without bound in the last degree of grazing views, and TORRANCE_SPARROW by GAUSSIAN and SMITH, which do not
 * belong together, sends back up to 5 % too much there if its facets are wide.
 *
 * F is by `fresnel`: Schlick's from f0, f90 = min(50 f0, 1); or a dielectric's or conductor's from its index,
 * times f0. PHONG and BANKS take it at n.v, as the frame's G-buffer does, so BANKS is reciprocal but for F;
 * the others at h.l. Pure; threads: any. */
#ifndef TOILE_RENDER_BRDF_BRDF_H
#define TOILE_RENDER_BRDF_BRDF_H

#include "assets/base/material.h"

/* A surface's frame: unit, at right angles; `tangent` along u (weft), turned already by gloss.rotation. */
struct tl_brdf_frame {
    vec3s normal, tangent, bitangent;
};

struct tl_brdf {
    struct tl_gloss gloss; /* widths filled in: none is 0 */
    vec3s f0;
    float exponent; /* s = 1 / (1 - g) */
};

/* What a material does where its maps say glossiness g and reflectance f0. Widths of 0 become
 * sqrt(2 / (4 s + 2)), the Gaussian slopes of the Blinn-Phong lobe with the same peak; kept in [1e-3, 1]. */
struct tl_brdf tl_brdf_of(const tl_material *material, vec3s f0, float glossiness);

/* `tangent` need not be at right angles to the normal and may be zero (then any will do). */
struct tl_brdf_frame tl_brdf_frame_make(vec3s normal, vec3s tangent, float handedness, float rotation);

/* f_r cos a by channel; 0 where light or viewer lie below the surface. Finite for all finite input. */
vec3s tl_brdf_gloss(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s l, vec3s v);

/* Its factors, for tables. D(d) of TORRANCE_SPARROW from tan^2 d; G; the cosine to a power from the sine
 * squared, which keeps its digits near the peak; the factor that stands before a lobe: (s + 1)/2pi and so on.
 */
float tl_brdf_facets(const struct tl_brdf *brdf, float tangent_squared);
float tl_brdf_smith(const struct tl_brdf *brdf, float cos_a, float cos_b);
float tl_brdf_v_grooves(float cos_a, float cos_b, float cos_t, float cos_d);
float tl_brdf_lobe_scale(const struct tl_brdf *brdf);

/* Fresnel reflectance for the cosine of the angle to the facet, in [0, 1] (render/brdf/fresnel.c). */
vec3s tl_brdf_fresnel(const struct tl_brdf *brdf, float cosine);
/* Of one interface, unpolarised; a dielectric's extinction is 0. */
float tl_fresnel_dielectric(float index, float cosine);
float tl_fresnel_conductor(float index, float extinction, float cosine);
float tl_fresnel_schlick(float f0, float cosine);

/* A direction drawn for light in proportion to the gloss, or nearly so, from two uniform numbers in [0, 1);
 * its density by solid angle in *density (0: no direction, below the surface). And the density of any
 * direction. (render/brdf/sample.c) */
vec3s tl_brdf_sample(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s v, float u1,
                     float u2, float *density);
float tl_brdf_pdf(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s l, vec3s v);

#endif
