/* Transparency of cloth: the surfaces behind open cloth, and light that comes through from the other side.
 *
 * Behind an open sample the camera's own ray goes on: the G-buffer is drawn again without what is nearer, up
 * to TL_TRANSPARENCY_LAYERS times, so that what lies behind has all of its maps. Every sample counts for what
 * is let through to it, less what it lets through itself:
 *
 *     c = sum over layers k of (o_0 ... o_k-1) (1 - o_k) cover_k c_k
 *
 * and what the last layer lets through is left to the background. Openness is of the area as it is seen
 * straight on: it does not fall with the angle, as that of real threads does. Light through the cloth itself
 * is the diffuse light of the layer's other side, which becomes a sample too: kt K_1(-n), lit as any back is.
 * Light that bounces between layers is not followed. World space, metres. */
#ifndef TOILE_RENDER_LIGHT_TRANSPARENCY_H
#define TOILE_RENDER_LIGHT_TRANSPARENCY_H

#include "render/gbuffer/samples.h"

struct tl_transparency {
    struct tl_gbuffer behind;
    tl_texture passed;        /* depth of the layers that have been passed, from the second on */
    struct tl_samples nearer; /* one layer's, as they are read */
    uint32_t *opens;          /* [height][width]: 1 + the last open sample of a texel; 0: none */
    size_t open_capacity;
    float
        *shares; /* by sample that the camera sees, through and through: what it counts for, with its cover */
    size_t share_capacity;
};

struct tl_transparency_request {
    const struct tl_gbuffer *gbuffer; /* as drawn: `draw` again, but for what is passed */
    struct tl_gbuffer_request draw;
    const struct tl_triangle_ranges *ranges;
};

/* Whether any sample can be looked through, or is lit from behind. */
bool tl_material_shows_more(const tl_material *material);

/* Appends to `samples`, whose primary ones are left as they are. */
bool tl_transparency_find(struct tl_transparency *transparency, tl_gpu *gpu,
                          const struct tl_transparency_request *request, struct tl_samples *samples,
                          tl_error *error);
void tl_transparency_release(struct tl_transparency *transparency);
size_t tl_transparency_bytes(const struct tl_transparency *transparency);

#endif
