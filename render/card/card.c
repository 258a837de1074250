#include "render/card/card_internal.h"

#include "config/base/memory.h"

#include <stdlib.h>

tl_graphics_card *tl_card_create(tl_gpu *gpu)
{
    tl_graphics_card *card = TL_NEW(tl_graphics_card);
    card->gpu = gpu;
    return card;
}

void tl_card_destroy(tl_graphics_card **card)
{
    tl_graphics_card *c = *card;
    if (!c)
        return;
    tl_card_release_programs(c);
    tl_card_release_materials(c);
    tl_card_points_release(&c->points);
    tl_card_release_light(c);
    for (int i = 0; i < CARD_BUFFERS; i++)
        tl_buffer_destroy(&c->buffers[i]);
    for (int i = 0; i < TL_CARD_LAYERS; i++) {
        tl_texture_destroy(&c->ids[i]);
        tl_texture_destroy(&c->sun_seen[i]);
    }
    tl_texture_destroy(&c->depth);
    tl_texture_destroy(&c->light);
    tl_texture_destroy(&c->no_map);
    tl_texture_destroy(&c->coarse);
    tl_texture_destroy(&c->sky_texels);
    tl_texture_destroy(&c->sky_curve);
    tl_texture_destroy(&c->round);
    tl_buffer_destroy(&c->frame_buffer);
    tl_buffer_destroy(&c->blends);
    glDeleteVertexArrays(1, &c->vertex_array);
    glDeleteFramebuffers(1, &c->ids_framebuffer);
    free(c);
    *card = NULL;
}

void tl_card_forget(tl_graphics_card *card)
{
    card->bounce_frames = 0;
}

size_t tl_card_bytes(const tl_graphics_card *card)
{
    if (!card)
        return 0;
    size_t bytes = tl_texture_bytes(&card->depth) + tl_texture_bytes(&card->light) +
                   tl_texture_bytes(&card->no_map) + tl_texture_bytes(&card->sky_texels) +
                   tl_texture_bytes(&card->sky_curve) + tl_texture_bytes(&card->round) +
                   tl_texture_bytes(&card->lobe_atlas) + tl_texture_bytes(&card->gain_atlas) +
                   card->frame_buffer.bytes + card->blends.bytes + tl_card_points_bytes(&card->points);
    for (int i = 0; i < CARD_BUFFERS; i++)
        bytes += card->buffers[i].bytes;
    bytes += tl_texture_bytes(&card->coarse);
    for (int i = 0; i < TL_CARD_LAYERS; i++)
        bytes += tl_texture_bytes(&card->ids[i]) + tl_texture_bytes(&card->sun_seen[i]);
    for (int i = 0; i < card->class_count; i++) {
        const struct tl_card_class *class = &card->classes[i];
        for (int k = 0; k < TL_CARD_MAPS; k++)
            bytes += tl_texture_bytes(&class->maps[k]);
        bytes += class->firsts.bytes + class->near.bytes + class->borders.bytes + class->profiles.bytes +
                 class->yarns.bytes;
    }
    return bytes;
}
