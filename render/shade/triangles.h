/* The triangles of an ID buffer, prepared for the pixels that they cover: homogeneous edge functions [Olano
 * and Greer 1997], which need no clipping, and the weights of a triangle's corners at a pixel. Borrows the
 * surfaces. Pure; threads: any. */
#ifndef TOILE_RENDER_SHADE_TRIANGLES_H
#define TOILE_RENDER_SHADE_TRIANGLES_H

#include "config/base/simd.h"
#include "render/gbuffer/ids.h"
#include "render/scene/view.h"
#include "render/shade/materials.h"

struct tl_pixel_triangle {
    float edges[3][3]; /* weights of the corners, not normalised: a (x - x0) + b (y - y0) + c, pixels */
    float x0, y0;
    const tl_surface *surface;
    uint32_t corners[3];
    uint32_t number;            /* the surface's own */
    size_t surface_index, part; /* part: index into the materials' parts */
    bool back;
    float slopes[2]; /* factors on a weave's slopes along u and v (tl_slope_factors) */
    bool transmits;  /* light comes through it from its other side */
};

/* Triangles of all layers, in the order of `ids->seen`. Owns its array, which is reused by every frame. */
struct tl_pixel_triangles {
    struct tl_pixel_triangle *items;
    size_t capacity;
};

/* Prepares the triangles that are seen. */
void tl_pixel_triangles_make(struct tl_pixel_triangles *triangles, const struct tl_id_buffer *ids,
                             const struct tl_view *view, const struct tl_triangle_ranges *ranges,
                             const struct tl_shade_materials *materials);
void tl_pixel_triangles_release(struct tl_pixel_triangles *triangles);

/* Values of a pixel: weights of the corners, which sum to 1. With e the edge functions' slopes their changes
 * to the next pixel are scale (e[i] - at[i] (e[0] + e[1] + e[2])). */
struct tl_pixel_weights {
    float at[3], scale;
};

/* At (x, y) in pixels from the lower left corner; pixel centres lie at halves. */
TL_INLINE struct tl_pixel_weights tl_pixel_weigh(const struct tl_pixel_triangle *triangle, float x, float y)
{
    struct tl_pixel_weights weights;
    float sum = 0;
    for (int i = 0; i < 3; i++) {
        const float *e = triangle->edges[i];
        float value = e[0] * (x - triangle->x0) + e[1] * (y - triangle->y0) + e[2];
        weights.at[i] = value > 0 ? value : 0; /* rounding at the edge */
        sum += weights.at[i];
    }
    weights.scale = sum > 0 ? 1 / sum : 0;
    for (int i = 0; i < 3; i++)
        weights.at[i] = sum > 0 ? weights.at[i] * weights.scale : 1 / 3.0f;
    return weights;
}

#endif
