/* Bounced light of one place: what arrives in the mean, and from where, in spherical harmonics of bands 0
 * to 3.
 * bounced_terms.glsl has what comes through a lobe.
 *
 * Linear radiance, Rec. 709; world space. Errors: none. Pure; threads: any. */
#ifndef TOILE_RENDER_BOUNCE_BOUNCED_H
#define TOILE_RENDER_BOUNCE_BOUNCED_H

#include "render/gpu/vectors.h"

#define TL_BOUNCED_TERMS TL_LANES /* BOUNCED_TERMS */
typedef struct BouncedShares BouncedShares;

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

#include "render/gpu/terms_begin.h"

#include "render/bounce/bounced_terms.glsl"

#include "render/gpu/terms_end.h"

/* The cosine lobe K_s about a direction, above the surface with a normal. */
struct tl_bounced_lobe {
    float basis[TL_BOUNCED_TERMS]; /* what the lobe keeps of it */
    BouncedShares shares;
};

TL_INLINE struct tl_bounced_lobe tl_bounced_lobe_of(vec3s normal, vec3s direction, float exponent)
{
    struct tl_bounced_lobe lobe;
    lobe.shares = bounced_lobe(normal, direction, exponent, lobe.basis);
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
    const float scale = lobe->shares.above / lobe->shares.even;
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
    return lobe->shares.above * (open < all ? open / all : 1);
}

#endif
