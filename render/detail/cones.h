/* Relaxed cone maps for ray marching of height fields [Policarpo and Oliveira 2007; Dummer 2006].
 *
 * Every texel stores the width of a cone with its apex on the field, such that a ray which enters the cone
 * from above crosses the field at most once before it leaves the cone. A march from cone to cone does not
 * step over a crest, and once it is below the field, bisection of the last step finds the only crossing. Each
 * pair of points of the field bounds a cone: only where the field falls away from the apex can a ray that was
 * below it come above it again, so rising slopes do not bound the cone, however steep they are.
 *
 * Pure; deterministic at any number of threads. */
#ifndef TOILE_RENDER_DETAIL_CONES_H
#define TOILE_RENDER_DETAIL_CONES_H

#include "render/detail/field.h"

/* The cone map of a field, one texel per height: U8 x2, for the sheet from above and from below. A cone opens
 * by r = DETAIL_CONE_TEXELS / depth * q / (1 - q) texels per metre of height, where q is byte / 255, rounded
 * down, and depth is high_m - low_m. `texel` is the size of a texel of this field in texels of the full map,
 * in which r is measured. */
tl_image tl_bake_cones(const struct tl_height_field *field, float texel);

#endif
