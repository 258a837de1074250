/* Garments that need no file. Threads: pure. */
#ifndef TOILE_ASSETS_CUT_GARMENT_CUT_H
#define TOILE_ASSETS_CUT_GARMENT_CUT_H

#include "assets/base/garment.h"
#include "assets/body/body.h"
#include "assets/cut/options.h"
#include "config/base/error.h"

/* Built-in garments, cut as flat panels: around the built-in dress form (assets/body/form.h) "dress",
 * "skirt", and "layers": the dress behind a curtain, whose material is named "overlay"; and drafted
 * from the measures of the figure "trousers" and "shirt". `edge_m` is the target length of an edge. False
 * when the name is unknown (the message lists the names). */
bool tl_garment_cut(const char *name, float edge_m, tl_garment *out, tl_error *error);

/* Whether the garment needs arms or legs: it is cut for the figure instead of the form. */
bool tl_garment_is_for_figure(const char *name);

/* The same for another body, in its rest pose: drafted from its measures, or cut for the form and moved
 * to its waist (assets/body/fit.h). Fails too when the body lacks what the garment hangs on. */
struct tl_wearer {
    const char *name; /* for messages */
    const tl_mesh *mesh;
    struct tl_body_distance distance;
    bool refits; /* what is cut for the form is also scaled to it */
};
bool tl_garment_cut_for(const char *name, float edge_m, const struct tl_wearer *wearer, tl_garment *out,
                        tl_error *error);

/* Either, with sizes of its own; `wearer` NULL: the form or the figure. What is scaled to a body is
 * scaled with its sizes. Errors: also TL_USAGE for a length that the garment cannot have on this
 * body; the message states the limit. */
bool tl_garment_cut_sized(const char *name, float edge_m, const struct tl_cut_params *sizes,
                          const struct tl_wearer *wearer, tl_garment *out, tl_error *error);

extern const char *const tl_garment_names[]; /* NULL-terminated */

#endif
