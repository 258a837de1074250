/* Shadows of lamps by rays: one from every sample towards the lamp. Pure; OpenMP inside. */
#ifndef TOILE_RENDER_LOCAL_LAMP_RAYS_H
#define TOILE_RENDER_LOCAL_LAMP_RAYS_H

#include "render/gbuffer/samples.h"
#include "render/local/lamp.h"
#include "render/trace/trace.h"

/* How much of the lamp each of the camera's samples sees, 0 to 255, by texel: out[height][width], 0 where
 * nothing is. The ground, or NULL, stops light from below. */
void tl_lamp_rays(const struct tl_lamp *lamp, const struct tl_trace *trace, const struct tl_samples *samples,
                  const struct tl_triangle_ranges *ranges, const struct tl_ground *ground, uint8_t *out);

/* The same for one sample, with its light: irradiance times what is seen of the lamp, and the direction
 * towards it. NULL for `trace`: nothing is in the way. */
vec3s tl_lamp_irradiance_at(const struct tl_lamp *lamp, const tl_trace *trace, const tl_sample *sample,
                            const struct tl_triangle_ranges *ranges, const struct tl_ground *ground,
                            vec3s *direction);

#endif
