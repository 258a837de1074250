/* Extreme cases of cloth that are not part of the envelope: broken garments, NaN and infinite inputs, avatars
 * that jump, denormals, sizes from a millimetre to a hundred metres.
 *
 * Each starts from an ordinary trial, a sheet of 1 m that hangs by an edge, and changes one thing. */
#ifndef TOILE_TESTS_APP_STABILITY_EXTREMES_CLOTH_H
#define TOILE_TESTS_APP_STABILITY_EXTREMES_CLOTH_H

#include "config/base/error.h"
#include "tests/app/stability/outcome.h"

extern const size_t tl_cloth_extreme_count;

const char *tl_cloth_extreme_name(size_t index);
bool tl_cloth_extreme_is_slow(size_t index); /* takes seconds with any solver but preview */

/* Runs one case. `found` says why it was refused, what is wrong, or what was measured; `error` is by how much
 * its promise is missed: mm, and a share of the cloth's own size. */
enum tl_outcome tl_cloth_extreme_run(size_t index, int solver, struct tl_cell_error *error, tl_error *found);

#endif
