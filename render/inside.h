/* A look inside a renderer, for checks: what its last frame's jobs made, read only. */
#ifndef TOILE_RENDER_INSIDE_H
#define TOILE_RENDER_INSIDE_H

#include "render/frame/facts.h"
#include "render/frame/resources.h"
#include "render/renderer.h"

/* Borrowed; valid until the renderer is destroyed. What it holds is of the frame drawn last, as far as `valid`
 * says so. */
const struct tl_resources *tl_renderer_look_inside(const tl_renderer *renderer);

#endif
