/* Lobes that stand for GGX facets, with Smith's masking, towards one viewer (lobe_fit.h): looked up in a
 * table of fits by least L1 over the hemisphere [as Heitz et al. 2016]. All lie in the plane of incidence,
 * along which a grazing viewer sees light spread.
 *
 * Rows are of roughness, the root of the width, and of the viewer's elevation, closer to one another near the
 * horizon. Narrower facets than the first row's have its lobes in proportion to their width.
 *
 * tests/render/brdf/ggx/test_ggx_lobes.c made the table, repeats its fits, and says how to make it again.
 * Pure; threads: any. */
#ifndef TOILE_RENDER_BRDF_GGX_GGX_LOBES_H
#define TOILE_RENDER_BRDF_GGX_GGX_LOBES_H

#define TL_GGX_LOBES_MAX 7

struct tl_ggx_lobe {
    float facet; /* angle from the normal of the facet in whose mirror direction it lies; towards the viewer,
                    rad */
    float exponent;
    float weight; /* of white facets */
    float cosine; /* of the light's angle with the facets: Fresnel's term is evaluated there */
};

/* 1, 3, 5 or 7 lobes, as many as `max_count` allows; returns their number. `width` in (0, 1]; `sine`: of the
 * viewer's elevation. */
int tl_ggx_lobes(float width, float sine, int max_count, struct tl_ggx_lobe lobes[TL_GGX_LOBES_MAX]);

/* The smallest and the largest exponent of any lobe of facets of this width. */
void tl_ggx_exponents(float width, float *min, float *max);

#endif
