/* Measured reflectance as a material refers to it. Lamps read even light, and tables for the rest: of cloth
 * both are there, and their sum has not the form of the tables' product, which the rest may have. All other
 * light reads the material of lobes. Immutable; threads: any.
 *
 *     f_r(l, v) = diffuse / pi + p(l) p(v) q(h) r(h.l, n.h)                        (factor.h) */
#ifndef TOILE_RENDER_BRDF_TABLES_MEASURED_H
#define TOILE_RENDER_BRDF_TABLES_MEASURED_H

#include "render/brdf/tables/factor.h"
#include "render/brdf/tables/measured_lobes.h"

#include <stdint.h>

#define TL_MEASURED_HALF 2 /* the table over h, the largest of them */

struct tl_measured {
    vec3s diffuse; /* pi times what all but the darkest 2 % of the samples exceed */
    struct tl_brdf_tables tables;
    uint64_t hash;   /* of the samples: the key of copies on the GPU; never 0 */
    double rel_rmse; /* of f_r cos a over the samples, all channels together */
    double bridged;  /* share of directions that no sample reaches */
    struct tl_measured_lobes lobes;
};

/* Makes tables of the size that the samples determine (tl_factor_size). Release it. */
struct tl_measured tl_measured_make(const struct tl_reflectance_samples *samples);
void tl_measured_release(struct tl_measured *measured); /* frees and zeroes */

/* f_r cos a of everything that the surface reflects. The bitangent of `frame` is the surface's own on both
 * sides: where the normal is turned over, so is the handedness that tl_brdf_frame_make takes. */
vec3s tl_measured_reflected(const struct tl_measured *measured, const struct tl_brdf_frame *frame, vec3s l,
                            vec3s v);

#endif
