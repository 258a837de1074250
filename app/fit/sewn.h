/* A garment as its maker sewed it: vertices at one place are one, and so are those that a seam joins. Metres.
 * Threads: pure. */
#ifndef TOILE_APP_FIT_SEWN_H
#define TOILE_APP_FIT_SEWN_H

#include "assets/base/garment.h"
#include "assets/sewing/openings.h"
#include "config/base/error.h"

/* Writes the sewn vertex of each render vertex to `weld` [mesh.vertex_count]; returns how many there are. */
size_t tl_sewn_weld(const tl_garment *garment, uint32_t *weld);

/* The garment's openings, with its vertices at `positions` [mesh.vertex_count]. `weld` [mesh.vertex_count]
 * receives the sewn vertex of each render vertex, which the openings count by. */
struct tl_openings tl_sewn_openings(const tl_garment *garment, const vec3s *positions, uint32_t *weld);

/* Is tl_sewn_openings for a file's model; one that stands along Z is turned as it will be: names depend on
 * it. */
struct tl_openings tl_sewn_openings_of_model(const tl_model *model);

/* Whether a model has the shape of something worn: an opening that is a neck or a waist, where bodies are
 * closed; or it is one piece of cloth in whatever pose, with few and long openings. What a rig or a clip
 * moves is a figure. */
bool tl_sewn_is_worn(const tl_model *model);

/* Pins the openings that `names` lists, with commas between them, in addition to the garment's own pins; "":
 * none.
 *
 * Errors: TL_USAGE for a name that no opening has; the message lists those there are. Lifetime: the garment
 * owns its pins. */
bool tl_sewn_pin(const char *names, tl_garment *garment, tl_error *error);

#endif
