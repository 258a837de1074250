/* The error of gloss from tables against the formula: the cost of precision, size and clamping of the
 * singular factor. Pure; results are the same on every machine.
 *
 * Viewers are spread evenly in the cosine of their angle and in azimuth. For each viewer half of the lights
 * are importance sampled by the gloss and half are spread evenly over the hemisphere:
 *
 *     relative RMSE = sqrt(sum (table - direct)^2 / sum direct^2)
 *     darkening     = 1 - sum table / sum direct, over the grazing pairs only */
#ifndef TOILE_RENDER_BRDF_TABLES_TABLE_ERROR_H
#define TOILE_RENDER_BRDF_TABLES_TABLE_ERROR_H

#include "render/brdf/tables/tables.h"

/* Pairs whose n.l or n.v is smaller count as grazing (beyond 78.5 degrees). */
#define TL_GRAZING_COSINE 0.2f

struct tl_table_error {
    double steep, grazing; /* relative RMSE of pairs that are not grazing, and of those that are */
    double darkening;
    size_t bytes; /* size of the tables */
};
/* Errors of the tables made with these parameters. Folded tables are compared with ambient + diffuse n.l / pi
 * + F at normal incidence times the white lobe. */
struct tl_table_error tl_brdf_table_error(const struct tl_brdf *brdf,
                                          const struct tl_brdf_table_params *params);

/* The artefact of [Heidrich and Seidel 1999, figure 2]: the sum over lights of the gloss from tables at one
 * angle of the viewer, divided by that of the formula. 1 is exact, less is too dark. */
double tl_brdf_table_ratio(const struct tl_brdf *brdf, const struct tl_brdf_tables *tables, float n_dot_v);

#endif
