/* What the renderer's samples tell, one by one. Inside of a renderer; threads: any, while nothing is drawn.
 */
#ifndef TOILE_RENDER_INSPECT_FIND_H
#define TOILE_RENDER_INSPECT_FIND_H

#include "render/frame/frame.h"
#include "render/inspect/inspect.h"

/* The nearest sample of the texel in a pixel's middle; primary_count where nothing is. The samples must be
 * there. */
size_t tl_inspect_find(const tl_renderer *renderer, int x, int y);
/* All that is known of a sample. */
void tl_inspect_sample(const tl_renderer *renderer, size_t number, struct tl_inspection *out);

#endif
