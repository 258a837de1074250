/* Building the state of a cloth from its garment, and rebuilding what depends on its mesh, fabric or solver.
 * Threads: one at a time per cloth. */
#ifndef TOILE_CLOTH_BUILD_H
#define TOILE_CLOTH_BUILD_H

#include "cloth/state.h"

/* Fills a cloth that has its garment, fabric and params, and nothing else. */
void tl_cloth_build_state(tl_cloth *cloth);

/* Rebuilds all that follows from a numbering of the physics vertices, of which there are `vertex_count`:
 * `weld` [render vertex]. Particles, pins and seams are left; tl_cloth_set_constants must follow. */
void tl_cloth_build_mesh(tl_cloth *cloth, const uint32_t *weld, size_t vertex_count);

/* Frees what tl_cloth_build_state made; the garment, fabric, params and marked start stay. */
void tl_cloth_release_state(tl_cloth *cloth);

/* Recomputes what depends on fabric, params and pins: inverse masses, stiffnesses, strain limits, the
 * critical step. Forgets all contacts. */
void tl_cloth_set_constants(tl_cloth *cloth);

/* Rebuilds the list of pins: the garment's own, and the vertices that cloth.pin_above_m or cloth.pin_colour
 * choose, where they are now. tl_cloth_set_constants must follow. */
void tl_cloth_make_pins(tl_cloth *cloth);

/* Appends one pin at the particle's present position. tl_cloth_set_constants must follow. */
void tl_cloth_add_pin(tl_cloth *cloth, uint32_t particle, bool by_hand);

/* Prestresses `preview` at the present positions (tl_energy_set_prestress), or takes that back. */
void tl_cloth_set_prestress(tl_cloth *cloth, bool is_prestressed);

/* Switches to the solver, time step and substeps of `params`, which must equal the cloth's own in all else.
 */
void tl_cloth_use_solver(tl_cloth *cloth, const struct tl_cloth_params *params);

/* Replaces topology, energy and particles by those of a mesh in which physics vertex i has become joined[i]:
 * masses add up, joined particles meet at their centre of mass, momentum is kept. */
void tl_cloth_join(tl_cloth *cloth, const uint32_t *joined, size_t joined_count);

#endif
