/* The environment as it is seen behind: as it is, or blurred; on the CPU for images that are shown there, and
 * as textures once a pass asks for them. Threads: that of the tl_gpu's context. */
#ifndef TOILE_RENDER_PRESENT_BACKDROP_H
#define TOILE_RENDER_PRESENT_BACKDROP_H

#include "render/gpu/gpu.h"
#include "render/present/behind.h"

struct tl_backdrop {
    tl_cube blurred;                           /* radiance */
    uint64_t revision;                         /* of the environment */
    struct tl_behind behind;                   /* the last camera's */
    tl_texture sharp_texture, blurred_texture; /* id 0: not asked for */
};

/* Takes an environment, as the cube that `filter` (enum tl_chain_filter) blurs; textures of the last one are
 * destroyed. `ground`: radiance of a ground that is drawn, where no shadow falls on it; NULL: there is none.
 * The blurred picture has it below the horizon and passes into the environment above it, as a photographer's
 * cyclorama does: all that is seen of the ground are its shadows. */
void tl_backdrop_set(struct tl_backdrop *backdrop, const tl_cube *cube, int filter, const vec3s *ground);

/* The environment in its own layout; NULL, with `error` set, when it is larger than GL can hold. */
const tl_texture *tl_backdrop_sharp(struct tl_backdrop *backdrop, tl_gpu *gpu,
                                    const tl_environment *environment, tl_error *error);
/* The blurred environment as a cube map. */
const tl_texture *tl_backdrop_blurred(struct tl_backdrop *backdrop, tl_gpu *gpu);

void tl_backdrop_release(struct tl_backdrop *backdrop);
size_t tl_backdrop_bytes(const struct tl_backdrop *backdrop);

#endif
