/* Light of lamps reflected by a shading point: delta lights, with a shadow ray each, and the exact
 * reflectance of render/brdf. Pure; threads: any. */
#ifndef TOILE_RENDER_REFERENCE_LAMPS_H
#define TOILE_RENDER_REFERENCE_LAMPS_H

#include "render/reference/shading_point.h"

/* Radiance towards point.viewer: what the point reflects of lamps, and what it emits; finite. Adds the number
 * of rays to *rays. */
vec3s tl_reference_lamps(const struct tl_reference_scene *scene, const struct tl_shading_point *point,
                         size_t *rays);

#endif
