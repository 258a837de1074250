/* Which level of the chain stands for which glossiness [002, sections 3.2 and 5].
 *
 * A white texel on black, filtered, is the chain's lobe. Its volume relative to its peak (sr) is matched to
 * that of the cosine lobe, 2 pi / (s + 1). Averaged over texel positions on a face, corner included. Pure. */
#ifndef TOILE_RENDER_PEM_LOBE_H
#define TOILE_RENDER_PEM_LOBE_H

#include "render/pem/chain.h"

#define TL_LOBE_STEPS 256

struct tl_lobe_table {
    float level[TL_LOBE_STEPS]; /* fractional chain level for g = i / (TL_LOBE_STEPS - 1); falls from g = 0 to
                                   0 at 1 */
};

void tl_lobe_calibrate(int size, enum tl_chain_filter filter, struct tl_lobe_table *out);

#endif
