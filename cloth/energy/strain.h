/* How far a garment is stretched, triangle by triangle, against its flat rest shape: what the membrane energy
 * is made of (cloth/energy/energy.h). F = [F_u F_v] is the deformation gradient:
 *
 *     warp |F_v| - 1,  weft |F_u| - 1,  shear F_u.F_v / (|F_u| |F_v|)
 *
 * It needs positions alone, so that a garment whose motion is played back has strains as well. Ownership:
 * borrows nothing once made. Threads: one at a time. */
#ifndef TOILE_CLOTH_ENERGY_STRAIN_H
#define TOILE_CLOTH_ENERGY_STRAIN_H

#include "assets/garment.h"

typedef struct tl_strains tl_strains;

tl_strains *tl_strains_create(const tl_garment *garment);
void tl_strains_destroy(tl_strains **strains); /* nulls it; null is fine */

/* From positions [vertex_count] of the garment's render vertices, metres: warp, weft and shear of each, the
 * mean over the triangles that use it, by their area at rest. Seams between panels are not averaged over:
 * each panel has its own vertices there. Slivers, whose shape says nothing, count for nothing; a vertex
 * without any other triangle has 0. */
void tl_strains_update(tl_strains *strains, const vec3s *positions, vec3s *out);

#endif
