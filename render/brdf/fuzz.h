/* Fuzz: the sheen of short fibres that stand on a cloth, over everything else of its material:
 *
 *     Lo = colour Lfuzz + (1 - R max colour) Lbase        [Zeltner et al. 2022; MaterialX]
 *
 * fuzz_terms.glsl has its lobe, which lamps, suns and the reference evaluate. For light from an environment
 * the lobe is replaced by its mean over the azimuth of the light, as a signed sum of cosine powers about the
 * smooth normal, each of which is a prefiltered map that exists:
 *
 *     Lfuzz = R sum over k of w_k E(n, s_k),  s = 1, 2, 4, 8,  sum of w = 1
 *
 * The w_k minimise the integral over the cosine of the squared difference. Light that is the same from
 * everywhere is exact. The fibres stand over weave and seams on the smooth normal, those of a pile lean with
 * its bumps (tl_fuzz_axis): n is their axis. The lobe is not
 * reciprocal. tests/render/brdf/test_fuzz.c has the errors. Pure; threads: any. */
#ifndef TOILE_RENDER_BRDF_FUZZ_H
#define TOILE_RENDER_BRDF_FUZZ_H

#include "assets/base/material.h"
#include "config/base/simd.h"
#include "render/gpu/vectors.h"

#include "render/gpu/terms_begin.h"

#include "render/brdf/fuzz_terms.glsl"

#include "render/gpu/terms_end.h"

#define TL_FUZZ_POWERS 4
/* Indices of the exponents in env/lobes.h. */
#define TL_FUZZ_INDEX(k)  (3 * (k))
#define TL_FUZZ_EXPONENTS (1u | 1u << 3 | 1u << 6 | 1u << 9)

/* The lobes towards one viewer. */
struct tl_fuzz_lobes {
    float weights[TL_FUZZ_POWERS]; /* R w_k */
    float under;                   /* what is left to the rest of the material */
};

TL_INLINE struct tl_fuzz_lobes tl_fuzz_lobes_of(const struct tl_fuzz *fuzz, float facing)
{
    /* Gauss-Legendre nodes over the cosine. With phi_k = (s_k + 1) z^s_k, G their Gram matrix and u = G^-1 1:
     * w = constant + (G^-1 - u u^T / sum u) b, where b_k are the integrals of phi_k times the ring. */
    enum { NODES = 6 };
    static const float nodes[NODES] = {0.03376524f, 0.1693953f, 0.3806904f,
                                       0.6193096f,  0.8306047f, 0.9662348f};
    static const float shares[TL_FUZZ_POWERS][NODES] = {
        {0.4182107f, 2.48853f, 0.49924f, -2.986402f, 0.1732791f, -0.5928578f},
        {-0.8351584f, -4.785745f, -0.08393909f, 6.302224f, -1.702497f, 1.105116f},
        {0.5469839f, 2.96177f, -0.7703559f, -4.243433f, 2.497196f, -0.9921611f},
        {-0.1300362f, -0.6645553f, 0.355055f, 0.927612f, -0.9679779f, 0.4799024f}};
    static const float constant[TL_FUZZ_POWERS] = {4.305398f, -5.371781f, 2.57113f, -0.5047464f};
    const float x = tl_minf(tl_maxf(facing, 0), 1), y = fuzz->roughness;
    const float a = fuzz_stretch(x, y), b = fuzz_slant(x, y), albedo = fuzz_albedo(x, y);
    struct tl_fuzz_lobes lobes = {.under = 1 - albedo * glms_vec3_max(fuzz->colour)};
    float rings[NODES];
    for (int i = 0; i < NODES; i++)
        rings[i] = 6.28318531f * fuzz_ring(nodes[i], a, b);
    for (int k = 0; k < TL_FUZZ_POWERS; k++) {
        float weight = constant[k];
        for (int i = 0; i < NODES; i++)
            weight += shares[k][i] * rings[i];
        lobes.weights[k] = albedo * weight;
    }
    return lobes;
}

/* The sum of the lobes for light from a small region, of this mean cosine above the horizon; never below 0.
 */
TL_INLINE float tl_fuzz_lobes_at(const float weights[TL_FUZZ_POWERS], float cosine)
{
    const float z = tl_maxf(cosine, 0), z2 = z * z, z4 = z2 * z2;
    const float sum =
        2 * weights[0] * z + 3 * weights[1] * z2 + 5 * weights[2] * z4 + 9 * weights[3] * z4 * z4;
    return 0.159154943f * tl_maxf(sum, 0);
}

/* The direction in which the fibres stand: the smooth normal, or for those that follow the bumps towards the
 * shading normal `shown`; all unit. */
TL_INLINE vec3s tl_fuzz_axis(const struct tl_fuzz *fuzz, vec3s smooth, vec3s shown)
{
    if (!(fuzz->follow > 0))
        return smooth;
    const vec3s axis =
        glms_vec3_add(glms_vec3_scale(smooth, 1 - fuzz->follow), glms_vec3_scale(shown, fuzz->follow));
    const float length = glms_vec3_norm(axis);
    return length > 1e-3f ? glms_vec3_scale(axis, 1 / length) : smooth;
}

/* The share left to the rest of the material, for the cosine of viewer and smooth normal; 1 without fuzz.
 */
float tl_fuzz_under(const tl_material *material, float facing);

/* f_r cos of light, of white fibres, for light from l; n is the smooth normal, all unit. */
float tl_fuzz_value(const struct tl_fuzz *fuzz, vec3s n, vec3s l, vec3s v);

#endif
