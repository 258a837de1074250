/* The parts of an audit. */
#ifndef TOILE_APP_AUDIT_AUDIT_INTERNAL_H
#define TOILE_APP_AUDIT_AUDIT_INTERNAL_H

#include "app/audit/audit.h"
#include "cloth/mesh/topology.h"

/* The audited model: a model and its connectivity, with vertices at one place welded. Stitches are not in it:
 * sewn pleats lie upon themselves. */
struct audited {
    const tl_model *model;
    const tl_mesh *mesh; /* of the model */
    struct tl_topology topology;
    bool *degenerate; /* [triangle of the mesh] has no area, and so no side that it faces */
};

/* Adds a finding; triangle: of the mesh, its place; TL_AUDIT_NOWHERE: none. */
void audit_add(tl_audit *audit, enum tl_audit_code code, const tl_model *model, int64_t triangle,
               const char *format, ...) __attribute__((format(printf, 5, 6)));

/* Corner k of a triangle of the mesh. */
vec3s audit_corner(const tl_mesh *mesh, size_t triangle, size_t k);

/* Triangles that have no area: fills audited->degenerate. (audit_triangles.c) */
void audit_degenerate(tl_audit *audit, struct audited *audited);
/* Triangles that are there twice, and edges of more than two. (audit_triangles.c) */
void audit_repeated(tl_audit *audit, const struct audited *audited);
/* Triangles that are turned over: in space, and against their pattern. (audit_winding.c) */
void audit_winding(tl_audit *audit, const struct audited *audited);
/* Crossing triangles. (audit_crossings.c) */
void audit_crossings(tl_audit *audit, const struct audited *audited);
/* Borders that lie side by side although the garment is sewn. (audit_seams.c) */
void audit_seams(tl_audit *audit, const tl_garment *garment);

#endif
