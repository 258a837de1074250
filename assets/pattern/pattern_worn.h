/* A pattern's file as a garment around the body that will wear it. Threads: any. */
#ifndef TOILE_ASSETS_PATTERN_PATTERN_WORN_H
#define TOILE_ASSETS_PATTERN_PATTERN_WORN_H

#include "assets/base/garment.h"
#include "config/base/error.h"

/* The mesh in its rest pose, on y = 0. */
struct tl_pattern_wearer {
    const char *name;    /* its file, or a built-in name */
    const tl_mesh *mesh; /* NULL: nobody */
};

/* Reads, places and cuts a pattern, with edges of about edge_m. Panels that belong at the waist are raised to
 * the wearer's; logs where that is and by what.
 *
 * Errors: as tl_pattern_load and tl_pattern_cut. Lifetime: *out owns all of it. */
bool tl_pattern_worn(const char *path, const struct tl_pattern_wearer *wearer, float edge_m, tl_garment *out,
                     tl_error *error);

#endif
