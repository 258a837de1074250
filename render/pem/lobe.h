/* Calibration of the chain: the level that stands for a glossiness [Knuth et al. 2014, 3.2 and 5].
 *
 * The chain's lobe is the response to one white texel on black. Its volume divided by its peak (sr) is
 * matched to that of the cosine lobe, 2 pi / (s + 1). The response is averaged over texel positions on a
 * face, corner included. Pure; threads: any. */
#ifndef TOILE_RENDER_PEM_LOBE_H
#define TOILE_RENDER_PEM_LOBE_H

#include "render/pem/chain.h"

#define TL_LOBE_STEPS 256

struct tl_lobe_table {
    float level[TL_LOBE_STEPS]; /* fractional chain level for g = i / (TL_LOBE_STEPS - 1); falls from g = 0 to
                                   0 at 1 */
};

/* Measures the chain of a cube of `size` texels a face and fills the table. */
void tl_lobe_calibrate(int size, enum tl_chain_filter filter, struct tl_lobe_table *out);

#endif
