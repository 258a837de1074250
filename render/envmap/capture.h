/* A cube map of the scene itself: six views from a point, over the environment. Surfaces whose bounding box
 * contains the point are left out, as an object inside its own map always is. The views are simplified: the
 * G-buffer, lit by the environment and the lamps without shadows, and by what surfaces emit; four samples per
 * texel.
 *
 * World axes (the environment's own cube does not turn with its yaw). Needs the GL context of its tl_gpu. */
#ifndef TOILE_RENDER_ENVMAP_CAPTURE_H
#define TOILE_RENDER_ENVMAP_CAPTURE_H

#include "render/envmap/envmap.h"
#include "render/light/light_buffer.h"
#include "render/local/local.h"

struct tl_capture {
    struct tl_gbuffer gbuffer;
    struct tl_light_buffer light;
    struct tl_envmap around; /* the environment, which lights the captured surfaces */
    struct tl_local lamps;   /* adds the light of the lamps, without shadows */
    tl_cube cube;
    struct tl_lobes lobes; /* lobes of the cube */
};

struct tl_capture_request {
    vec3s point;
    int size;                   /* texels along a face of the cube */
    const tl_cube *environment; /* a cube of the environment of the same size, in its own axes */
    const struct tl_lobes *lobes;
    float environment_yaw;             /* rad */
    const mat3s *into_world;           /* from the environment's axes to world axes */
    uint32_t exponents;                /* bit mask of the exponents that the lobes of the capture need */
    const tl_texture *exponent_levels; /* of tl_lighting */
    tl_surfaces *surfaces;
    const struct tl_triangle_ranges *ranges; /* of the drawn surfaces; the ground comes last */
    const struct tl_ground *ground;          /* NULL: none */
    struct tl_casters casters;
    const struct tl_lamp *lamps;
    size_t lamp_count;
    float near_m, far_m;
};

/* Draws the six views and convolves the cube. False when a shader cannot be compiled. */
bool tl_capture_draw(struct tl_capture *capture, tl_gpu *gpu, const struct tl_capture_request *request,
                     tl_error *error);
/* Releases all resources. */
void tl_capture_release(struct tl_capture *capture);
/* Recompiles the shaders from their files; keeps the old ones and returns false on an error. */
bool tl_capture_reload(struct tl_capture *capture, tl_error *error);
/* Size of textures and lobes. */
size_t tl_capture_bytes(const struct tl_capture *capture);

#endif
