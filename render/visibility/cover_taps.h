/* Taps across the edge of what covers. Where cloth begins to lie on a body, a triangle has corners in the
 * open and corners under the cloth, and whatever lies between them would be half dark. A sample reads only
 * those that lie as it does. Part of points.c. */
#ifndef TOILE_RENDER_VISIBILITY_COVER_TAPS_H
#define TOILE_RENDER_VISIBILITY_COVER_TAPS_H

#include "render/visibility/points_request.h"

/* Bit i of covered[c]: something lies close above point c x TL_CLUSTER + i. */
void tl_taps_match_cover(const struct tl_points_request *request, const uint16_t *covered,
                         struct tl_taps *taps);

#endif
