/* Sums of cosine lobes that stand for a gloss of facets, for passes that look PEMs up lobe by lobe
 * [Knuth et al. 2014, 6]. The lobes of every sample are fitted on the CPU (render/brdf/lobe_fit.h) and kept
 * in a texture of the target's size.
 *
 * World space. Errors: none. Lifetime: the caller releases what was made. Threads: the renderer's. */
#ifndef TOILE_RENDER_LIGHT_LOBE_SUMS_H
#define TOILE_RENDER_LIGHT_LOBE_SUMS_H

#include "render/gbuffer/samples.h"

#define TL_LOBE_SUMS_MAX 16 /* lobes of a sample; more are left out */

struct tl_lobe_sums {
    /* RGBA16F, two layers a lobe: direction and 1 / exponent; weight, and 1 where there is a lobe. A sample
     * whose gloss is not of facets has none. */
    tl_texture lobes;
    int count;
};

struct tl_lobe_sums_request {
    const struct tl_samples
        *samples; /* of the nearest surfaces, read from a G-buffer with the layer of facets */
    const struct tl_triangle_ranges *ranges;
    vec3s eye;
    int max_count; /* for each gloss */
};

/* Replaces what `sums` held. */
void tl_lobe_sums_make(struct tl_lobe_sums *sums, tl_gpu *gpu, const struct tl_lobe_sums_request *request);
void tl_lobe_sums_release(struct tl_lobe_sums *sums);
size_t tl_lobe_sums_bytes(const struct tl_lobe_sums *sums);

#endif
