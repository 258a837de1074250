/* Plane sections of a mesh: a trunk, two arms, two legs. Metres. Threads: pure. */
#ifndef TOILE_ASSETS_BODY_SECTION_H
#define TOILE_ASSETS_BODY_SECTION_H

#include "assets/base/mesh.h"
#include "assets/body/wrap.h"

/* A section has coordinates along `across` and `onward`, from `point`. Unit vectors, at right angles. */
struct tl_plane {
    vec3s point, across, onward;
};
struct tl_plane tl_plane_level(float y_m); /* coordinates (x, z) */

/* One connected part of a section. */
struct tl_section {
    float girth_m;      /* length of the convex hull, as a tape measure reads it */
    vec2s lower, upper; /* the bounding box */
    size_t hull_count;
    vec2s *hull; /* across to the right, onward up: counter-clockwise */
};

/* The parts of the mesh's section with a plane, in the order of their first triangles; returns how many. *out
 * is a new array, to be released. */
size_t tl_mesh_sections(const tl_mesh *mesh, const struct tl_plane *plane, struct tl_section **out);
void tl_sections_release(struct tl_section **sections, size_t count);

/* A ring of the given length around a section; 0: of its girth. */
void tl_section_ring(const struct tl_section *section, bool symmetric, double length, struct tl_ring *out);

#endif
