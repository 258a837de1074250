/* A garment: the mesh to draw, what it is at rest as flat cloth, what is sewn to what, and what is pinned.
 *
 * Physics vertices are not listed: cloth welds render vertices of bitwise equal start position, and those
 * that seams join. Immutable once made. */
#ifndef TOILE_ASSETS_GARMENT_H
#define TOILE_ASSETS_GARMENT_H

#include "assets/model.h"

struct tl_seam_pair {
    uint32_t a, b;
}; /* render vertices to be drawn together and then welded */

typedef struct tl_garment {
    tl_model model; /* mesh.positions is where the cloth starts */
    /* Rest shape as flat cloth, metres: x along the weft, y along the warp, one per render vertex; NULL when
     * the file has no pattern: then each triangle's start shape is its rest shape and UV directions give warp
     * and weft. */
    vec2s *pattern;
    size_t seam_count;
    struct tl_seam_pair *seams;
    size_t pin_count;
    uint32_t *pins; /* render vertices held where they start (on the avatar, they follow its nearest point) */
    bool solid;     /* no cloth: it keeps its shape (assets/builtin/specimen.h) */
} tl_garment;

/* A glTF or OBJ file as a garment, with its model's pins; its units as in tl_model_load and tl_model_load_in.
 */
bool tl_garment_load(const char *path, tl_garment *out, tl_error *error);
bool tl_garment_load_in(const char *path, enum tl_units units, tl_garment *out, tl_error *error);
void tl_garment_release(tl_garment *garment);
/* Lists the vertices that model.pins holds, if the file has any. */
void tl_garment_take_pins(tl_garment *garment);

/* Built-in garments, cut as flat panels around the built-in dress form (assets/builtin/form.h): "dress",
 * "skirt", and "layers": the dress behind a curtain, whose material is named TL_GARMENT_OVERLAY. Their other
 * materials are "bodice" and "skirt". `edge_m` is the wanted length of an edge. False when the name is
 * unknown (the message lists the names). */
bool tl_garment_cut(const char *name, float edge_m, tl_garment *out, tl_error *error);
#define TL_GARMENT_OVERLAY "overlay"
extern const char *const tl_garment_names[]; /* NULL-terminated */

#endif
