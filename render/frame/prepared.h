/* What a renderer makes of an environment before it can light anything, made ready beside it: that takes up
 * to a second, in which images go on. So does what it lacks for materials that are new to it. Pure; on any
 * thread. What it holds is bit for bit what the renderer would have made, and what it does not hold the
 * renderer makes itself. */
#ifndef TOILE_RENDER_FRAME_PREPARED_H
#define TOILE_RENDER_FRAME_PREPARED_H

#include "render/frame/settings.h"

#define TL_PREPARED_COUNTS_MAX 4 /* as many as a renderer keeps */

typedef struct tl_prepared tl_prepared;

struct tl_prepared_request {
    const tl_environment *environment; /* borrowed while it is made */
    tl_prepared *known; /* of the same environment, from tl_renderer_copy_prepared, and taken: what it has is
                           not made again; NULL: nothing */
    struct tl_render_settings settings;
    int region_counts[TL_PREPARED_COUNTS_MAX]; /* light.regions of the frames to come; what is 0 is left out
                                                */
    uint32_t exponents;                        /* tl_prepared_exponents */
};

/* Of the lobes that the frame's materials need, as bits of render/env/lobes.h. */
uint32_t tl_prepared_exponents(const tl_frame *frame, const struct tl_render_settings *settings);

/* Shows progress. One that is interrupted holds less. */
tl_prepared *tl_prepared_make(struct tl_prepared_request *request);
void tl_prepared_destroy(tl_prepared **prepared); /* null is fine */

#endif
