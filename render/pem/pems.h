/* The PEMs on the GPU: one filtered cube map per region [002, section 4], several in each cube map array.
 *
 * RGBA16F, as in the paper. A sun beyond the range of half floats is preserved: all values are stored
 * multiplied by one power of two for the whole environment, which costs no precision, and the light pass
 * multiplies by `scale`. Needs the GL context of its tl_gpu. */
#ifndef TOILE_RENDER_PEM_PEMS_H
#define TOILE_RENDER_PEM_PEMS_H

#include "render/gpu/gpu.h"
#include "render/pem/regions.h"

#define TL_PEM_TEXEL_BYTES 8
#define TL_PEM_STORED_MAX                                                                                    \
    32768.0f /* half of the largest half float, so that filters do not overflow either */

struct tl_pems {
    int count, per_array, array_count;
    float scale;        /* radiance = scale x stored */
    tl_texture *arrays; /* cube map arrays, per_array cubes each; the last one fewer */
};

/* Cuts, filters and uploads all regions of `cube`; replaces the contents of `pems`. The chains are built in
 * parallel; the result does not depend on the number of threads. */
void tl_pems_build(struct tl_pems *pems, tl_gpu *gpu, const tl_cube *cube, const struct tl_regions *regions,
                   int filter, int per_array);
void tl_pems_release(struct tl_pems *pems);
size_t tl_pems_bytes(const struct tl_pems *pems);

/* Reads a level of the filtered cube of region `index` back from the GPU, as radiance; for checks. The caller
 * releases the cube. */
tl_cube tl_pems_read(const struct tl_pems *pems, int index, int level);

#endif
