/* The light that a material sends to a viewer, as lobes over one another: fibres, over a clear coat, over
 * gloss and diffuse colour (layers_terms.glsl). The coat is a film of index 1.5, Lo = F Lm + (1 - F) Lbase
 * [Heidrich and Seidel 1999, 4.4]. The two lobes of every material, K_1 about the normal and K_s about the
 * mirror direction, are not listed: their owner multiplies them by `over.base`, and has only the first where
 * `is_faceted`.
 *
 * Directions are unit, all in one space, whichever. Errors: none. Pure; threads: any. */
#ifndef TOILE_RENDER_BRDF_MATERIAL_LOBES_H
#define TOILE_RENDER_BRDF_MATERIAL_LOBES_H

#include "render/brdf/facets.h"
#include "render/brdf/fuzz.h"
#include "render/brdf/lobe_fit.h"
#include "render/env/exponent.h"

typedef struct MaterialLayers MaterialLayers;

#include "render/gpu/terms_begin.h"

#include "render/brdf/layers_terms.glsl"

#include "render/gpu/terms_end.h"

/* A sample's surface, on the side that is seen. */
struct tl_material_sample {
    const tl_material *material;
    vec3s smooth, normal; /* without and with bumps */
    vec3s viewer;
    /* The lobes of facets: */
    vec3s tangent;     /* along u */
    float handedness;  /* bitangent = handedness * cross(normal, tangent) */
    float side;        /* 1; -1: the back is seen */
    vec3s diffuse, f0; /* with maps */
    float glossiness;
    const float *widening; /* [3] (tl_brdf_bumped) */
};

struct tl_material_lobes {
    MaterialLayers over;
    bool is_faceted; /* the gloss is this, and no lobe about the mirror direction: */
    struct tl_brdf_sum gloss;
    struct tl_brdf_frame frame; /* of facets, or of a measured material */
};

struct tl_material_lobes tl_material_lobes_of(const struct tl_material_sample *sample);
/* The lobes of gloss alone, whichever its model, without what covers it; at most `max_count` for each gloss.
 * Returns how many. */
int tl_material_gloss_fit(const struct tl_material_sample *sample, int max_count,
                          struct tl_fitted_lobe items[TL_LOBE_FIT_SUM_MAX]);
/* The share that the layers leave of what is below them; nothing of facets is read. */
float tl_material_base(const struct tl_material_sample *sample);
/* Its law of diffuse reflectance (layers_terms.glsl). */
vec4s tl_material_law(const tl_material *material);

/* The lobes for which prefiltered light can be looked up: those that stand for facets, at most `max_count`
 * for each gloss, then the coat. Returns how many; *facets: of facets. */
#define TL_MATERIAL_LOBES_MAX (TL_LOBE_FIT_SUM_MAX + 1)
int tl_material_lobes_fit(const struct tl_material_lobes *lobes, int max_count,
                          struct tl_fitted_lobe items[TL_MATERIAL_LOBES_MAX], int *facets);

/* f_r cos of facets alone, 0 without, for a light that is a disc of angular radius `radius` (rad; 0: a point)
 * about l. */
vec3s tl_material_facets(const struct tl_material_lobes *lobes, vec3s l, float radius);

#endif
