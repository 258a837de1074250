/* Shadows of suns and lamps at every pixel, layer by layer, by rays where they are needed: from every fourth
 * pixel each way first, or every eighth on the ground; where the corners of a cell agree and are of one
 * surface, its pixels take their answer; the other pixels are traced themselves, and so are the pixels of
 * cells beside one that turns out otherwise. Pixels near an edge of the shadow get more rays to other places
 * of the sun, and so do those near a pixel that sees a part of it: the penumbra; fewer where a difference is
 * hardly seen, because it is one of sheer cloth's shadows or lies behind sheer cloth. What is missed are
 * shadows narrower than a cell along all of their length (tests/render/shade/test_sun_pixels.c counts the
 * pixels).
 *
 * Lifetime: owns its arrays. Threads: one call at a time; results do not depend on their number. */
#ifndef TOILE_RENDER_SHADE_SUN_PIXELS_H
#define TOILE_RENDER_SHADE_SUN_PIXELS_H

#include "render/shade/pixel_lights.h"
#include "render/shade/triangles.h"
#include "render/surfaces/ground.h"
#include "render/trace/trace.h"

struct tl_sun_pixels {
    size_t capacity; /* pixels */
    /* Shares by layer of the ID buffer, [height][width], in [0, 1]; of pixels that face the sun, with either
     * side where light comes through. */
    float *visible[1 + TL_TRANSPARENCY_LAYERS][TL_PIXEL_LIGHTS_MAX];
    uint8_t *states;            /* of a layer: what was seen */
    uint8_t *minimum, *maximum; /* ... there and in the rows above and below */
    uint8_t *marks;             /* ... whether it lies beside an edge */
    uint32_t *pixels;           /* those that may lie in a penumbra */
    uint8_t *is_partial;        /* ... and whether they do */
    size_t cell_capacity;
    uint8_t *cells; /* how the pixels of a cell got their answers */
    uint32_t *late; /* cells that are traced as their neighbours turned out otherwise */
    int row_capacity;
    size_t *block_counts; /* listed pixels by block of rows */
    size_t rays;          /* of the last update */
    /* State of the layer at work: rows that hold something; the difference between shares of the sun that is
     * softened at the edge of a shadow. */
    int first_row, end_row;
    float contrast;
};

struct tl_sun_pixels_request {
    const struct tl_id_buffer *ids;
    const struct tl_pixel_triangles *triangles; /* of `ids` */
    const struct tl_triangle_ranges *ranges;
    const struct tl_pixel_lights *lights;
    const tl_trace *trace;
    const struct tl_ground *ground; /* NULL: none */
    float openness;                 /* the greatest of a material: a layer's weight is that of the one before,
                                       times this */
};

void tl_sun_pixels_update(struct tl_sun_pixels *pixels, const struct tl_sun_pixels_request *request);
void tl_sun_pixels_release(struct tl_sun_pixels *pixels);
size_t tl_sun_pixels_bytes(const struct tl_sun_pixels *pixels);

#endif
