/* Strains of a garment against its flat rest shape, the measures that the membrane energy penalises
 * (cloth/energy/energy.h). With the deformation gradient F = [F_u F_v]:
 *
 *     warp |F_v| - 1,  weft |F_u| - 1,  shear F_u.F_v / (|F_u| |F_v|)
 *
 * Only positions are needed, so that a garment whose motion is played back has strains too. Lifetime: the
 * garment may be released after creation. Threads: one update at a time per object, parallel inside. */
#ifndef TOILE_CLOTH_ENERGY_STRAIN_H
#define TOILE_CLOTH_ENERGY_STRAIN_H

#include "assets/garment.h"

typedef struct tl_strains tl_strains;

/* Cannot fail. End with tl_strains_destroy. */
tl_strains *tl_strains_create(const tl_garment *garment);
void tl_strains_destroy(tl_strains **strains); /* sets it to NULL; NULL is ignored */

/* Computes warp, weft and shear strain of each render vertex from positions [vertex_count], metres: the mean
 * over its triangles weighted by their rest area, written to `out` [vertex_count]. There is no averaging
 * across seams, where each panel has vertices of its own. Slivers are ignored; a vertex with slivers only has
 * strain 0. */
void tl_strains_update(tl_strains *strains, const vec3s *positions, vec3s *out);

/* Strains of a triangle of the garment's mesh, as of the last update. Zero of slivers. */
struct tl_triangle_strain {
    double warp, weft, shear;
    double area; /* m^2, at rest; 0: a sliver */
};
struct tl_triangle_strain tl_strains_of_triangle(const tl_strains *strains, size_t triangle);

#endif
