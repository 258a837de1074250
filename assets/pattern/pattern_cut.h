/* A sewing pattern cut out of cloth: its panels as a garment, flat and apart, with the seams that will join
 * them. Threads: pure. */
#ifndef TOILE_ASSETS_PATTERN_PATTERN_CUT_H
#define TOILE_ASSETS_PATTERN_PATTERN_CUT_H

#include "assets/base/garment.h"
#include "assets/pattern/pattern.h"

/* Most vertices of the garments that this makes: finer ones are refused. */
#define TL_LIMIT_PATTERN_VERTICES ((size_t)1 << 20)

/* Cuts every panel with edges of about edge_m, as many on both sides of a stitch, and hangs it where the
 * pattern says. One material and one part a panel, of its name; UVs in metres, on one cutting table.
 *
 * Errors: TL_INPUT for an outline that crosses or touches itself; TL_USAGE for edges so short that there
 * would be too many vertices. *out is zeroed then. Lifetime: *out owns all of it, and does not refer to
 * `pattern`. */
bool tl_pattern_cut(const tl_pattern *pattern, float edge_m, tl_garment *out, tl_error *error);

#endif
