/* A view's colours, sample by sample. Pure; results do not depend on the number of threads. */
#ifndef TOILE_RENDER_INSPECT_PAINT_H
#define TOILE_RENDER_INSPECT_PAINT_H

#include "render/gbuffer/samples.h"
#include "render/inspect/legend.h"
#include "render/inspect/seen.h"

struct tl_paint_request {
    const struct tl_legend *legend;
    enum tl_image_view view;
    const struct tl_samples *samples;
    const struct tl_triangle_ranges *ranges;
    vec3s eye;
    float texel; /* side of a texel at distance 1 */
    /* Inputs of the views of visibility. */
    const struct tl_seen_regions *regions;
    const uint16_t *values;
    size_t stride;
    const struct tl_taps *taps; /* by sample */
    int region;                 /* -1: all */
};

/* Writes light[4 * texel] of every nearest sample: linear, premultiplied by cover, nothing looked through.
 * On a screen the result has the colours of the legend. */
void tl_paint(const struct tl_paint_request *request, float *light);

/* The smallest of 0.1, 0.15, 0.2, 0.3, 0.5, 0.7, 1, 1.5 ... 100 and 1000 % within which 99 % of the vertices'
 * strains along `axis` (warp, weft, shear) lie; the smallest of all where no surface knows its strains. As a
 * share of 1. */
float tl_paint_strain_range(const tl_surface *const *surfaces, size_t count, int axis);

/* The signed share of a period's first half in a box about `place`: 1 within it, -1 within the other, between
 * them where the box covers both. All lengths in periods. */
float tl_paint_square_wave(float place, float width);

/* A vertex attribute at a sample's weights. */
vec3s tl_paint_mix(const vec3s *values, const uint32_t corners[3], const float weights[3]);

#endif
