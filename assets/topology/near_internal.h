/* The borders that can be nearest to a point of each triangle. */
#ifndef TOILE_ASSETS_TOPOLOGY_NEAR_INTERNAL_H
#define TOILE_ASSETS_TOPOLOGY_NEAR_INTERNAL_H

#include "assets/topology/pieces_internal.h"

/* Fills `firsts` and `near` from `borders`; `sides` [border_count] are those of the pieces. Seams, hems and
 * darts are listed apart: the nearest of each is wanted. */
void tl_borders_list_near(const tl_mesh *mesh, const struct tl_pieces *pieces, const uint32_t *sides,
                          tl_borders *borders);

#endif
