/* Reflectance of gloss under one light, evaluated directly: the exact value that every table, interpolation
 * and reduced precision of this folder is measured against.
 *
 * With l towards the light and v towards the viewer, unit, h = (l + v) / |l + v|, r = v reflected about n,
 * cosines a = n.l, b = n.v, t = h.l (all clamped to [0, 1]), the functions return f_r(l, v) cos a:
 *
 *     PHONG             F (s + 1)/2pi (r.l)^s                    the PEM method's K_s; not reciprocal
 *     BLINN_PHONG       F (s' + 2)/8pi (n.h)^s' , s' = 4 s       [Blinn 1977]; not reciprocal
 *     COSINE_LOBE       F (s + 2)/2pi (r.l)^s cos a              [Lewis 1993]; reciprocal
 *     TORRANCE_SPARROW  F D(d) G(a, b) / (pi cos b)              [Heidrich and Seidel 1999, eq. 1]; d: angle
 * of n, h; D normalised so that the integral of D cos d over h is pi WARD              F exp(-tan^2 d (cos^2
 * p/w_u^2 + sin^2 p/w_v^2)) / (4 pi w_u w_v sqrt(cos a cos b)) cos a [Ward 1992, eq. 5a]; p: azimuth of h
 * from the tangent BANKS             F (s + 1)/2pi (t.l t.v related: sin sin - cos cos)^s cos a, with the
 * shading normal of the thread: l projected into the plane at right angles to t [op. cit. 3.2]
 *
 * F is by `fresnel`: Schlick's from f0, or a dielectric's or conductor's from its index, times f0. PHONG and
 * BANKS take it at n.v, as the frame's G-buffer does, the others at h.l. Pure; threads: any. */
#ifndef TOILE_RENDER_BRDF_BRDF_H
#define TOILE_RENDER_BRDF_BRDF_H

#include "assets/material.h"

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
 * sqrt(2 / (4 s + 2)), the Gaussian slopes of the Blinn-Phong lobe with the same peak; at least 1e-3. */
struct tl_brdf tl_brdf_of(const tl_material *material, vec3s f0, float glossiness);

/* `tangent` need not be at right angles to the normal and may be zero (then any will do). */
struct tl_brdf_frame tl_brdf_frame_make(vec3s normal, vec3s tangent, float handedness, float rotation);

/* f_r cos a by channel; 0 where light or viewer lie below the surface. Finite for all finite input. */
vec3s tl_brdf_gloss(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s l, vec3s v);

/* Fresnel reflectance for the cosine of the angle to the facet, in [0, 1] (render/brdf/fresnel.c). */
vec3s tl_brdf_fresnel(const struct tl_brdf *brdf, float cosine);

/* A direction drawn for light in proportion to the gloss, or nearly so, from two uniform numbers; its density
 * by solid angle in *density (0: no direction, below the surface). And the density of any direction. */
vec3s tl_brdf_draw(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s v, float u1, float u2,
                   float *density);
float tl_brdf_density(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s l, vec3s v);

#endif
