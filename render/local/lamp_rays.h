/* Shadows of lamps by ray tracing: one ray from every sample towards the lamp. Pure; OpenMP inside. */
#ifndef TOILE_RENDER_LOCAL_LAMP_RAYS_H
#define TOILE_RENDER_LOCAL_LAMP_RAYS_H

#include "render/gbuffer/samples.h"
#include "render/local/lamp.h"
#include "render/trace/trace.h"

/* The visibility of the lamp for each of the camera's samples, 0 to 255, by texel: out[height][width], 0
 * where there is no sample. The ground (NULL: none) blocks light from below. */
void tl_lamp_rays(const struct tl_lamp *lamp, const struct tl_trace *trace, const struct tl_samples *samples,
                  const struct tl_triangle_ranges *ranges, const struct tl_ground *ground, uint8_t *out);

/* The irradiance that one sample receives: that of the lamp times its visibility; *direction points towards
 * the lamp. With a NULL `trace` nothing is occluded. */
vec3s tl_lamp_irradiance_at(const struct tl_lamp *lamp, const tl_trace *trace, const tl_sample *sample,
                            const struct tl_triangle_ranges *ranges, const struct tl_ground *ground,
                            vec3s *direction);

#endif
