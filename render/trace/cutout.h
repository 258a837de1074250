/* The holes that a material's alpha map cuts: what the surfaces' shaders discard, without mip levels, for a
 * ray has no footprint. Pure. */
#ifndef TOILE_RENDER_TRACE_CUTOUT_H
#define TOILE_RENDER_TRACE_CUTOUT_H

#include "assets/base/material.h"

/* Whether there is a hole at mesh coordinates `uv`: alpha, bilinear at full size, below the cutoff. */
bool tl_cutout_at(const tl_material *material, vec2s uv);

#endif
