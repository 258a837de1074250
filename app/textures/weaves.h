/* The weaves of fabrics, by their options, and kept for further use: generated yarns, a picture of heights,
 * or pictures of the whole surface. To generate a felt or to decode a set of pictures takes up to a second,
 * and a change of colour needs neither again.
 *
 * A weave is shared: equal options give the same one, as long as the files behind them have the same sizes
 * and times. Weaves that nobody uses are kept up to TL_WEAVES_KEPT_BYTES together, the last used ones first.
 *
 * Errors: those of tl_height_picture_weave and tl_fabric_pictures_make. Threads: any; the weaves themselves
 * are not written to. */
#ifndef TOILE_APP_TEXTURES_WEAVES_H
#define TOILE_APP_TEXTURES_WEAVES_H

#include "app/textures/fabric_pictures.h"

#define TL_WEAVES_KEPT_BYTES ((size_t)256 << 20)

/* *out: of yarns its weave alone; NULL for options without a weave. Give it back with tl_weaves_give. */
bool tl_weaves_take(const struct tl_weave_params *params, const struct tl_fabric_pictures **out,
                    tl_error *error);
void tl_weaves_give(const struct tl_fabric_pictures *weave); /* NULL is accepted */

/* The size of the weaves that are kept though nobody uses them. */
size_t tl_weaves_unused_bytes(void);

#endif
