/* The light of a light map (light_map.h), gathered on the CPU. Pure; OpenMP inside; results do not depend on
 * the number of threads. */
#ifndef TOILE_RENDER_ENVMAP_LIGHT_MAP_BAKE_H
#define TOILE_RENDER_ENVMAP_LIGHT_MAP_BAKE_H

#include "render/reference/request.h"
#include "render/reference/scene.h"

/* A point that receives light. */
struct tl_baked_point {
    vec3s point, normal;
    size_t at; /* index of its light */
};

/* Gathers E(normal, 1), the mean of the light about the normal by its cosine, shadowed. light[4 at]: RGB, 1.
 * An interrupt (config/base/interrupt.h) leaves out the rest. */
void tl_light_map_gather(const struct tl_reference_scene *scene, int directions,
                         const struct tl_baked_point *points, size_t count, float *light);
/* Fills texels whose last number is 0 from neighbours that have light, so that bilinear look-ups near the
 * edge of a chart read light of that chart. */
void tl_light_map_pad(float *light, int side, int rounds);

#endif
