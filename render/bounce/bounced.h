/* Bounced light of one place: what arrives in the mean, and from where, in spherical harmonics of bands 0
 * to 3.
 *
 * Only directions above the surface have light. A lobe of light that is cut off at a horizon rings in so few
 * bands, so what comes through a lobe is compared with what would if the hemisphere above the surface were
 * even:
 *
 *     light through K_s(d) = (terms through K_s(d)) / (hemisphere through K_s(d)) * share above
 *
 * which for even light is the share of the lobe above the horizon. In these bands the hemisphere of n is 1/2
 * + 3/4 P_1 - 7/16 P_3 of d.n, and K_s keeps 1, (s + 1) / (s + 2), s / (s + 3) and (s + 1) (s - 1) / (s + 2)
 * (s + 4) of them [Ramamoorthi and Hanrahan 2001].
 *
 * Linear radiance, Rec. 709; world space. Errors: none. Pure; threads: any. */
#ifndef TOILE_RENDER_BOUNCE_BOUNCED_H
#define TOILE_RENDER_BOUNCE_BOUNCED_H

#include "config/base/simd.h"

#include <cglm/struct.h>
#include <math.h>

#define TL_BOUNCED_TERMS TL_LANES

/* Terms: light by channel; and luminances of the sky, of what is seen of it and of all that
 * is above the surface. */
enum { TL_BOUNCED_OPEN_SKY = 3, TL_BOUNCED_ALL_SKY, TL_BOUNCED_KINDS };

struct tl_bounced {
    vec3s arrives; /* E_b / pi */
    float terms[TL_BOUNCED_KINDS][TL_BOUNCED_TERMS];
};

/* sum += share * light, of the light alone. */
TL_INLINE void tl_bounced_add_light(struct tl_bounced *sum, const struct tl_bounced *light, float share)
{
    sum->arrives = glms_vec3_muladds(light->arrives, share, sum->arrives);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < TL_BOUNCED_TERMS; i++)
            sum->terms[c][i] += share * light->terms[c][i];
}

/* ... and of the sky. */
TL_INLINE void tl_bounced_add(struct tl_bounced *sum, const struct tl_bounced *light, float share)
{
    tl_bounced_add_light(sum, light, share);
    for (int kind = TL_BOUNCED_OPEN_SKY; kind < TL_BOUNCED_KINDS; kind++)
        for (int i = 0; i < TL_BOUNCED_TERMS; i++)
            sum->terms[kind][i] += share * light->terms[kind][i];
}

/* The real spherical harmonics of a unit direction, orthonormal over the sphere. */
TL_INLINE void tl_bounced_basis(vec3s d, float basis[TL_BOUNCED_TERMS])
{
    const float x2 = d.x * d.x, y2 = d.y * d.y, z2 = d.z * d.z;
    basis[0] = 0.28209479f;
    basis[1] = 0.48860251f * d.y;
    basis[2] = 0.48860251f * d.z;
    basis[3] = 0.48860251f * d.x;
    basis[4] = 1.0925484f * d.x * d.y;
    basis[5] = 1.0925484f * d.y * d.z;
    basis[6] = 0.31539157f * (3 * z2 - 1);
    basis[7] = 1.0925484f * d.x * d.z;
    basis[8] = 0.54627422f * (x2 - y2);
    basis[9] = 0.59004359f * d.y * (3 * x2 - y2);
    basis[10] = 2.8906114f * d.x * d.y * d.z;
    basis[11] = 0.45704580f * d.y * (5 * z2 - 1);
    basis[12] = 0.37317633f * d.z * (5 * z2 - 3);
    basis[13] = 0.45704580f * d.x * (5 * z2 - 1);
    basis[14] = 1.4453057f * d.z * (x2 - y2);
    basis[15] = 0.59004359f * d.x * (x2 - 3 * y2);
}

/* The cosine lobe K_s about a direction, above the surface with a normal. */
struct tl_bounced_lobe {
    float basis[TL_BOUNCED_TERMS]; /* what the lobe keeps of it */
    float even;                    /* what comes through it from the hemisphere above the surface */
    float above;                   /* the share of it that is above the surface */
};

/* Below this share of the hemisphere nothing is divided by it: the lobe points into the surface. */
#define TL_BOUNCED_MIN_EVEN 0.3f

/* The share of K_s above the horizon is (1 + cosine) / 2 for s = 1, and for narrow lobes the integral of a
 * Gaussian; in between it is interpolated: within 0.012 of the integral (tests/render/bounce/test_bounced.c).
 */
TL_INLINE float tl_share_above(float cosine, float exponent)
{
    const float narrow = tl_maxf(exponent - 1, 0), square = cosine * cosine;
    const float steep = cosine * sqrtf(1 + 0.6366f * narrow) * (1 + 0.25f * narrow * square);
    return 0.5f + 0.5f * steep / sqrtf(tl_maxf(1 - square, 0) + steep * steep + 1e-12f);
}

/* The terms show light as a lobe of this exponent would, and so they do a horizon. Where it is cut off as
 * sharply as K_s has it, pleats of metal were 4 to 5 % brighter, and too bright (docs/notes/bounce.md). */
#define TL_BOUNCED_BLUR 6

TL_INLINE struct tl_bounced_lobe tl_bounced_lobe_of(vec3s normal, vec3s direction, float exponent)
{
    const float s = exponent, one = (s + 1) / (s + 2), two = s / (s + 3), three = one * (s - 1) / (s + 4);
    const float cosine = glms_vec3_dot(normal, direction);
    struct tl_bounced_lobe lobe;
    tl_bounced_basis(direction, lobe.basis);
    for (int i = 1; i < TL_BOUNCED_TERMS; i++)
        lobe.basis[i] *= i < 4 ? one : i < 9 ? two : three;
    lobe.even = 0.5f + 0.75f * one * cosine - 0.21875f * three * cosine * (5 * cosine * cosine - 3);
    lobe.even = tl_maxf(lobe.even, TL_BOUNCED_MIN_EVEN);
    lobe.above = tl_share_above(cosine, s * TL_BOUNCED_BLUR / (s + TL_BOUNCED_BLUR));
    return lobe;
}

/* The terms of one kind through a lobe. */
TL_INLINE float tl_bounced_sum(const float terms[TL_BOUNCED_TERMS], const struct tl_bounced_lobe *lobe)
{
    float products[TL_BOUNCED_TERMS];
    for (int i = 0; i < TL_BOUNCED_TERMS; i++)
        products[i] = terms[i] * lobe->basis[i];
    return tl_maxf(tl_sum_lanes(products), 0);
}

/* Bounced light through a lobe. */
TL_INLINE vec3s tl_bounced_through(const struct tl_bounced *bounced, const struct tl_bounced_lobe *lobe)
{
    const float scale = lobe->above / lobe->even;
    vec3s light;
    for (int c = 0; c < 3; c++)
        light.raw[c] = tl_bounced_sum(bounced->terms[c], lobe) * scale;
    return light;
}

/* The share of the sky's light through a lobe that is seen. Where the terms ring to nothing, the mean over
 * the hemisphere; of a black sky all. */
TL_INLINE float tl_bounced_open_share(const struct tl_bounced *bounced, const struct tl_bounced_lobe *lobe)
{
    const float *open_sky = bounced->terms[TL_BOUNCED_OPEN_SKY],
                *all_sky = bounced->terms[TL_BOUNCED_ALL_SKY];
    float open = tl_bounced_sum(open_sky, lobe), all = tl_bounced_sum(all_sky, lobe);
    if (!(all > 0)) {
        open = open_sky[0];
        all = all_sky[0];
    }
    return lobe->above * (open < all ? open / all : 1);
}

#endif
