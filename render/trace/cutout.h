/* The holes that the alpha map of a material cuts, as the shaders of surfaces discard them, but without mip
 * levels, because rays have no footprint. Pure; threads: any. */
#ifndef TOILE_RENDER_TRACE_CUTOUT_H
#define TOILE_RENDER_TRACE_CUTOUT_H

#include "assets/base/material.h"

/* True where there is a hole at mesh coordinates `uv`: alpha, bilinear at full resolution, is below the
 * cutoff. */
bool tl_cutout_at(const tl_material *material, vec2s uv);

#endif
