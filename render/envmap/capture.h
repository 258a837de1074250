/* A cube map of the scene itself: six views from a point, over the environment. What holds the point inside
 * of its box is left out, as an object in the middle of its own map always is. The views are drawn in a cheap
 * form: the G-buffer, lit without shadows by the environment alone, four samples a texel.
 *
 * World axes (unlike the environment's own cube, which does not turn with its yaw). Needs the context of its
 * tl_gpu. */
#ifndef TOILE_RENDER_ENVMAP_CAPTURE_H
#define TOILE_RENDER_ENVMAP_CAPTURE_H

#include "render/envmap/envmap.h"
#include "render/light/light.h"

struct tl_capture {
    struct tl_gbuffer gbuffer;
    struct tl_lighting lighting; /* its target only */
    struct tl_envmap around;     /* the environment, which lights what is captured */
    tl_cube cube;
    struct tl_lobes lobes; /* of the cube */
};

struct tl_capture_request {
    vec3s point;
    int size;                   /* texels along a face of the cube */
    const tl_cube *environment; /* ... of the same size, in its own axes */
    const struct tl_lobes *lobes;
    float environment_yaw;             /* rad */
    const mat3s *into_world;           /* the environment's axes -> world */
    uint32_t exponents;                /* that are wanted of the capture's own lobes */
    const tl_texture *exponent_levels; /* of tl_lighting */
    tl_surfaces *surfaces;
    const struct tl_triangle_ranges *ranges; /* of what is drawn, with the ground last */
    const struct tl_ground *ground;          /* NULL: none */
    float near_m, far_m;
};

bool tl_capture_draw(struct tl_capture *capture, tl_gpu *gpu, const struct tl_capture_request *request,
                     tl_error *error);
void tl_capture_release(struct tl_capture *capture);
bool tl_capture_reload(struct tl_capture *capture, tl_error *error);
size_t tl_capture_bytes(const struct tl_capture *capture);

#endif
