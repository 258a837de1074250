/* How far a ray over a height field may go at once: relaxed cones [Policarpo and Oliveira 2007, after Dummer
 * 2006].
 *
 * Over every texel stands a cone, its apex on the field, so wide that a ray which comes down into it from
 * above goes under the field at most once before it leaves it. A search that walks from cone to cone steps
 * over no crest, and once it is under the field, halving its last step finds the place where it went under
 * and no other. Two points of the field bound a cone: only where the field falls away from the apex can a ray
 * that was under it be over it again, so that slopes which rise do not count, however steep.
 *
 * Pure; deterministic at any thread count. */
#ifndef TOILE_RENDER_DETAIL_CONES_H
#define TOILE_RENDER_DETAIL_CONES_H

#include "render/detail/field.h"

/* Of the field's heights, one texel for each of theirs: U8 x2, of the sheet from above and from below. A cone
 * opens by r = DETAIL_CONE_TEXELS / depth * q / (1 - q) texels for a metre of height, q being a byte's share
 * of 255, rounded down; depth is high_m - low_m. `texel`: how many texels of the map that is not made smaller
 * one of these is; r counts the former. */
tl_image tl_bake_cones(const struct tl_height_field *field, float texel);

#endif
