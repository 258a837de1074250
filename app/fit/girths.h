/* Girths of a body at bust, waist and hip, and of the cloth around it there. Metres. Threads: pure. */
#ifndef TOILE_APP_FIT_GIRTHS_H
#define TOILE_APP_FIT_GIRTHS_H

#include "app/fit/measures.h"
#include "cloth/mesh/topology.h"

/* Fills heights and the body's girths: the waist as built-in cuts find it (assets/body/fit.h), the widest
 * section down to the legs, and the widest up to where arms join. Zero where the body has no waist. */
void tl_girths_of_body(const tl_mesh *body, struct tl_girth_measures girths[TL_GIRTHS]);

/* Adds the cloth's: the longest closed line around the middle of the body, in rest and in worn length; at the
 * bust up to 8 cm lower, below its sleeves. `rest` [topology.triangle_count], `positions`
 * [topology.vertex_count]. */
void tl_girths_of_cloth(const tl_mesh *body, const struct tl_topology *topology, const vec2s (*rest)[3],
                        const vec3s *positions, struct tl_girth_measures girths[TL_GIRTHS]);

#endif
