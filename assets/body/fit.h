/* Built-in garments on other bodies: girths measured on the body's mesh, and the garment scaled and moved to
 * them. */
#ifndef TOILE_ASSETS_BODY_FIT_H
#define TOILE_ASSETS_BODY_FIT_H

#include "assets/base/garment.h"

struct tl_girth {
    float length_m; /* of the section's convex hull, as a tape measure reads it */
    vec2s centre;   /* x, z of the middle of the section's bounding box, metres */
};

/* Measures the largest connected section of the mesh with the plane y = `y_m`: the trunk, not an arm. False
 * when the plane misses the mesh. */
bool tl_mesh_girth(const tl_mesh *mesh, float y_m, struct tl_girth *out);

struct tl_waist {
    float y_m;
    struct tl_girth girth;
};

/* The waist of a standing person: the narrowest section between 0.56 and 0.66 of the mesh's height. False
 * when the mesh has none there. */
bool tl_mesh_waist(const tl_mesh *mesh, struct tl_waist *out);

/* Reports that a garment is of another size than the body: at its longest it is more than 1.25 times as long
 * as the body, or less than a tenth of it; or by girths: at its widest it does not go round the waist, or at
 * its narrowest it is wider by a third than the body is anywhere. NULL: none of these, or one of them has no
 * sections to be measured. The caller frees it. */
char *tl_describe_size(const char *name, const tl_mesh *garment, const char *body_name, const tl_mesh *body);

/* Reports that a garment cut for the built-in form is worn by a body with another waist. NULL: the waists
 * differ by less than 3 %, or the body has none. The caller frees it. */
char *tl_describe_waist(const char *name, const char *body_name, const tl_mesh *body);

/* Moves a garment cut for the built-in form from the form's waist to the body's. `scaled`: scales it about
 * the waist, pattern included, by the ratio of the waist girths; else it keeps its size. The body stands on y
 * = 0 in its rest pose, is upright and has human proportions: the waist is the narrowest section between 0.56
 * and 0.66 of its height. */
bool tl_garment_fit(tl_garment *garment, const char *body_name, const tl_mesh *body, bool scaled,
                    tl_error *error);

#endif
