/* Outlines and folds at a picture's full size where light was computed at fewer samples. Every pixel has its
 * own id, so that what it shows is known exactly; its light is that of samples which show the same: the same
 * part of the same surface, its same side, at a depth that continues the pixel's triangle. This is joint
 * bilateral upsampling [Kopf et al. 2007] with weights of 0 and 1.
 *
 * Pure; results do not depend on the number of threads. */
#ifndef TOILE_RENDER_SHADE_OUTLINES_H
#define TOILE_RENDER_SHADE_OUTLINES_H

#include "render/gbuffer/ids.h"
#include "render/scene/view.h"
#include "render/shade/materials.h"
#include "render/surfaces/ground.h"

struct tl_outlines_request {
    const struct tl_id_buffer *samples; /* where light was computed: fewer than pixels along both sides */
    const struct tl_id_buffer *pixels;
    const float *light; /* of the samples: RGBA [samples->height][samples->width], premultiplied by cover */
    const struct tl_triangle_ranges *ranges;
    const struct tl_shade_materials *materials;
    const struct tl_ground *ground; /* the last of the surfaces, or NULL when none is drawn */
    const struct tl_view *view;
};

/* Pixels, by where their light comes from. */
struct tl_outlines_counts {
    size_t kept;    /* interpolated between samples that all show the same, before */
    size_t blended; /* of their four samples those that fit, bilinear */
    size_t nearest; /* the nearest of 4 x 4 samples that fits; else of those of the same part and side */
    size_t foreign; /* the nearest sample of any part */
    size_t lost;    /* none is near: uncovered */
};

/* Corrects `image`, RGBA [pixels->height][pixels->width], which holds `light` resampled to this size from the
 * 4 x 4 samples about every pixel: pixels stay as they are where these all show the same part, nothing is
 * covered where the pixel's id is 0, and other pixels are computed from the samples that fit. Cover is that
 * of the pixel itself, also where the ground fades. */
struct tl_outlines_counts tl_outlines_draw(const struct tl_outlines_request *request, float *image);

#endif
