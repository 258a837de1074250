/* How far gloss from tables is from the formula: what precision, size and the cut of the singular factor
 * cost. Pure; the same on every machine.
 *
 * Over pairs of viewers, even in the cosine of their angle and in azimuth, and lights drawn as the gloss
 * spreads them, half of them, or evenly over the hemisphere, the other half:
 *
 *     relative RMSE = sqrt(sum (table - direct)^2 / sum direct^2)
 *     darkening     = 1 - sum table / sum direct, in the grazing pairs alone */
#ifndef TOILE_RENDER_BRDF_TABLE_ERROR_H
#define TOILE_RENDER_BRDF_TABLE_ERROR_H

#include "render/brdf/tables.h"

/* Pairs whose n.l or n.v is below are grazing: 78.5 degrees. */
#define TL_GRAZING_COSINE 0.2f

struct tl_table_error {
    double away, grazing; /* relative RMSE */
    double darkening;
    size_t bytes; /* of the tables */
};
/* Folded tables are compared with ambient + diffuse n.l / pi + f0 times the white lobe. */
struct tl_table_error tl_brdf_table_error(const struct tl_brdf *brdf,
                                          const struct tl_brdf_table_params *params);

/* [000, figure 2's artefact] What tables show at one angle of the viewer over what they should, summed over
 * lights: 1 is right, less is too dark. */
double tl_brdf_table_ratio(const struct tl_brdf *brdf, const struct tl_brdf_tables *tables, float n_dot_v);

#endif
