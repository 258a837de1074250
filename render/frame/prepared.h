/* Prepares an environment on a worker thread: the cube, lobes and lights that a renderer needs before it can
 * light anything. That takes up to a second, during which the renderer goes on drawing. Light that new
 * materials need is prepared in the same way. The result is bit for bit what the renderer would make; what it
 * lacks, the renderer makes itself. Pure. Threads: any. */
#ifndef TOILE_RENDER_FRAME_PREPARED_H
#define TOILE_RENDER_FRAME_PREPARED_H

#include "render/env/sun.h"
#include "render/frame/light_cache.h"
#include "render/frame/settings.h"

#define TL_PREPARED_COUNTS_MAX TL_LIGHTS_KEPT

typedef struct tl_prepared tl_prepared;

struct tl_prepared_request {
    /* Borrowed until tl_prepared_make returns. */
    const tl_environment *environment;
    /* Results for the same environment (tl_renderer_copy_prepared), which are not made again. They are taken
     * over and set to NULL. NULL: everything is made. */
    tl_prepared *known;
    /* The settings of the frames to come. */
    struct tl_render_settings settings;
    /* light.regions of the frames to come; 0: none. */
    int region_counts[TL_PREPARED_COUNTS_MAX];
    /* Exponents of the lobes to make: tl_prepared_exponents. 0: none. */
    uint32_t exponents;
};

/* The exponents of the lobes that the frame's materials need, as bits of render/env/lobes.h. */
uint32_t tl_prepared_exponents(const tl_frame *frame, const struct tl_render_settings *settings);

/* Prepares an environment and reports progress. When it is interrupted, the result holds less. */
tl_prepared *tl_prepared_make(struct tl_prepared_request *request);
void tl_prepared_destroy(tl_prepared **prepared); /* null is fine */

/* Between a renderer and what was prepared for it (render/renderer.h). A copy of what a cache holds of a
 * cube, `light` being the options that it was made with. */
tl_prepared *tl_prepared_copy_cache(const struct tl_light_cache *cache, const tl_cube *cube,
                                    const struct tl_suns *suns, const struct tl_light_params *light);
/* Whether the cube would be the same for this environment and these options. */
bool tl_prepared_fits(const tl_prepared *prepared, uint64_t environment_revision, int pem_size, bool sun);
void tl_prepared_set_revision(tl_prepared *prepared, uint64_t environment_revision);
/* Moves the lobes and lights into a cache of the same cube; or the cube and its suns to the renderer. */
void tl_prepared_give_lights(tl_prepared *prepared, struct tl_light_cache *cache);
void tl_prepared_give_cube(tl_prepared *prepared, tl_cube *cube, struct tl_suns *suns);

#endif
