/* Maps as the shaders of surfaces read them, but without mip levels, because rays have no footprint: the
 * holes that alpha cuts, and colours. Bilinear at full resolution. Pure; threads: any. */
#ifndef TOILE_RENDER_TRACE_CUTOUT_H
#define TOILE_RENDER_TRACE_CUTOUT_H

#include "assets/base/material.h"

/* True where there is a hole at mesh coordinates `uv`: alpha is below the cutoff. */
bool tl_cutout_at(const tl_material *material, vec2s uv);

/* The linear colour of a map; white where there is none. */
vec3s tl_map_colour_at(const struct tl_map *map, vec2s uv);

#endif
