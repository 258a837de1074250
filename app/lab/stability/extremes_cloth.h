/* The extremes that touch cloth, one by one, beside the envelope: broken garments, numbers that are none,
 * avatars that jump, denormals, sizes from a millimetre to a hundred metres.
 *
 * Each starts from an ordinary trial, a sheet of 1 m that hangs by an edge, and changes one thing. */
#ifndef TOILE_APP_LAB_STABILITY_EXTREMES_CLOTH_H
#define TOILE_APP_LAB_STABILITY_EXTREMES_CLOTH_H

#include "app/lab/stability/outcome.h"
#include "config/error.h"

extern const size_t tl_cloth_extreme_count;

const char *tl_cloth_extreme_name(size_t index);
bool tl_cloth_extreme_is_slow(size_t index); /* seconds, with any solver but preview */

/* `found` tells why it was refused, what is wrong, or what was measured. */
enum tl_outcome tl_cloth_extreme_run(size_t index, int solver, tl_error *found);

#endif
