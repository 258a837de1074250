/* The rest shape of a garment from a file: its UVs where they are its pattern, else the shape of its mesh.
 * Metres. Threads: one per garment. */
#ifndef TOILE_ASSETS_SEWING_REST_H
#define TOILE_ASSETS_SEWING_REST_H

#include "assets/base/garment.h"
#include "assets/sewing/charts.h"
#include "config/base/error.h"

/* Decides by the charts of the garment's mesh, and sets its pattern. AUTO: the charts that are a pattern, if
 * they are at least half of the area; the rest of the garment keeps its shape. UV: whatever is mapped. MESH:
 * nothing.
 *
 * Errors: TL_USAGE for UV where nothing is mapped. Lifetime: the garment owns its pattern; charts are only
 * read. */
bool tl_rest_take(enum tl_rest_choice choice, const struct tl_charts *charts, tl_garment *garment,
                  tl_error *error);

/* One line: what AUTO takes and why, with the figures: new string. */
char *tl_rest_describe(const char *name, const struct tl_charts *charts);

#endif
