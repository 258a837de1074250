/* The ground: a matt disc at y = 0 under whatever stands there, so that a figure casts a shadow on
 * something. It fades towards its rim and so melts into the background; light from below is stopped by as
 * much as the disc covers where the ray meets it (ground.glsl). Who looks from below sees through it. Pure.
 */
#ifndef TOILE_RENDER_SURFACES_GROUND_H
#define TOILE_RENDER_SURFACES_GROUND_H

#include "assets/base/surface.h"

/* The bounding sphere of the shadow casters, to which shadow maps are fitted. Metres. */
struct tl_casters {
    vec3s centre;
    float radius; /* at least TL_CASTERS_RADIUS_MIN */
};
#define TL_CASTERS_RADIUS_MIN 1e-4f

/* The factor of lengths in shadow maps (bias, blur) that options state for garments: 1 where the casters'
 * radius is half a metre or more, and in proportion to it below. 4 mm are more than all of a garment
 * of 1 mm. */
float tl_casters_scale(const struct tl_casters *casters);

/* Sphere about the middle of the box of all positions. False when a position is not finite. */
bool tl_casters_measure(const tl_surface *surfaces, size_t count, struct tl_casters *out, tl_error *error);

/* Rings about the middle, close together there: what is kept at vertices (visibility) follows a figure's
 * shadow. */
enum {
    TL_GROUND_RINGS = 32,
    TL_GROUND_SEGMENTS = 48,
    TL_GROUND_VERTICES = 1 + TL_GROUND_RINGS * TL_GROUND_SEGMENTS,
    TL_GROUND_INDICES = 3 * TL_GROUND_SEGMENTS * (2 * TL_GROUND_RINGS - 1)
};

struct tl_ground {
    tl_surface surface; /* points into this struct */
    vec3s centre;
    float radius; /* metres; nothing is left of the disc beyond it */
    tl_material material;
    struct tl_mesh_part part;
    vec3s positions[TL_GROUND_VERTICES], normals[TL_GROUND_VERTICES];
    vec4s tangents[TL_GROUND_VERTICES];
    vec2s uvs[TL_GROUND_VERTICES]; /* place over radius */
    uint32_t indices[TL_GROUND_INDICES];
};

/* The reflectance of a ground that is no real place's. */
#define TL_GROUND_GREY ((vec3s){{0.4f, 0.4f, 0.4f}})

/* Fills `out` in place; it must not be moved while its surface is used. `colour` is its reflectance. */
void tl_ground_make(const struct tl_casters *casters, vec3s colour, struct tl_ground *out);

/* The terms of ground.glsl: the opacity of the disc at a point of its plane; and its transmittance for
 * light from `direction` at `point`. NULL: there is no ground. */
float tl_ground_cover(const struct tl_ground *ground, float x, float z);
float tl_ground_visibility(const struct tl_ground *ground, vec3s point, vec3s direction);
/* The same for light that comes from `distance_m` away: what it meets beyond does not count. */
float tl_ground_visibility_to(const struct tl_ground *ground, vec3s point, vec3s direction, float distance_m);

/* The distance of a ray from above to the plane of the ground; infinite when it never does. */
float tl_ground_distance(const struct tl_ground *ground, vec3s origin, vec3s direction);
/* Intersects a ray from above with the disc: the point, the mesh's triangle there and the barycentric
 * weights. False when it misses or there is no ground. */
bool tl_ground_meet(const struct tl_ground *ground, vec3s origin, vec3s direction, vec3s *point,
                    uint32_t *triangle, float weights[3]);

#endif
