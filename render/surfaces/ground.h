/* The ground: a matt grey disc at y = 0 under whatever stands there, so that a figure casts a shadow on
 * something. It fades towards its rim and so melts into the background; light from below is stopped by as
 * much as the disc covers where the ray meets it (ground.glsl). Pure. */
#ifndef TOILE_RENDER_SURFACES_GROUND_H
#define TOILE_RENDER_SURFACES_GROUND_H

#include "assets/surface.h"

/* What casts shadows: the sphere that the shadow maps are fitted to. Metres. */
struct tl_casters {
    vec3s centre;
    float radius; /* at least TL_CASTERS_RADIUS_MIN */
};
#define TL_CASTERS_RADIUS_MIN 1e-4f

/* Sphere about the middle of the box of all positions. False when a position is not finite. */
bool tl_casters_measure(const tl_surface *surfaces, size_t count, struct tl_casters *out, tl_error *error);

struct tl_ground {
    tl_surface surface; /* points into this struct */
    vec3s centre;
    float radius; /* metres; nothing is left of the disc beyond it */
    tl_material material;
    struct tl_mesh_part part;
    vec3s positions[4], normals[4];
    vec4s tangents[4];
    vec2s uvs[4];
    uint32_t indices[6];
};

/* Fills `out` in place; it must not be moved while its surface is used. */
void tl_ground_make(const struct tl_casters *casters, struct tl_ground *out);

#endif
