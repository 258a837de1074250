/* A garment as its maker sewed it: vertices at one place are one, and so are those that a seam joins. Metres.
 * Threads: pure. */
#ifndef TOILE_APP_FIT_SEWN_H
#define TOILE_APP_FIT_SEWN_H

#include "assets/base/garment.h"
#include "assets/openings/openings.h"
#include "config/error.h"

/* The garment's openings, with its vertices at `positions` [mesh.vertex_count]. `weld` [mesh.vertex_count]
 * receives the sewn vertex of each render vertex, which the openings count by. */
struct tl_openings tl_sewn_openings(const tl_garment *garment, const vec3s *positions, uint32_t *weld);

/* Pins the openings that `names` lists, with commas between them, in addition to the garment's own pins; "":
 * none.
 *
 * Errors: TL_USAGE for a name that no opening has; the message lists those there are. Lifetime: the garment
 * owns its pins. */
bool tl_sewn_pin(const char *names, tl_garment *garment, tl_error *error);

#endif
