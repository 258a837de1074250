/* Garments that need no file. Threads: pure. */
#ifndef TOILE_ASSETS_CUT_GARMENT_CUT_H
#define TOILE_ASSETS_CUT_GARMENT_CUT_H

#include "assets/base/garment.h"
#include "config/error.h"

/* Built-in garments, cut as flat panels around the built-in dress form (assets/builtin/form.h): "dress",
 * "skirt", and "layers": the dress behind a curtain, whose material is named TL_GARMENT_OVERLAY. Their other
 * materials are "bodice" and "skirt". `edge_m` is the target length of an edge. False when the name is
 * unknown (the message lists the names). */
bool tl_garment_cut(const char *name, float edge_m, tl_garment *out, tl_error *error);
#define TL_GARMENT_OVERLAY "overlay"
extern const char *const tl_garment_names[]; /* NULL-terminated */

#endif
