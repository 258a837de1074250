/* Finds the first triangle that a ray hits by testing all of them: for one pixel of an image whose samples
 * were not kept. Pure.
 */
#ifndef TOILE_RENDER_INSPECT_PICK_H
#define TOILE_RENDER_INSPECT_PICK_H

#include "render/gbuffer/samples.h"

/* Metres; `direction` unit. Both sides of a triangle count. Fills triangle, weights, point and smooth of
 * `out`, and takes `normal` from the latter. False when it misses. */
bool tl_pick(const struct tl_triangle_ranges *ranges, vec3s origin, vec3s direction, tl_sample *out);

#endif
