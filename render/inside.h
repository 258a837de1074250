/* Read-only access to the resources of a renderer's last frame, for checks and tests. */
#ifndef TOILE_RENDER_INSIDE_H
#define TOILE_RENDER_INSIDE_H

#include "render/frame/facts.h"
#include "render/frame/resources.h"
#include "render/renderer.h"

/* Returns the resources. Lifetime: borrowed, until the renderer is destroyed. Only resources in `valid`
 * belong to the last frame. */
const struct tl_resources *tl_renderer_frame_resources(const tl_renderer *renderer);

#endif
