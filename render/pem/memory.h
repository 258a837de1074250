/* Memory of the maps of all regions in several forms: this program's own and those of [Knuth et al. 2014,
 * figure 8]. Computed without making the maps. For slices see tl_slices_bytes_of (slices.h). Pure; threads:
 * any. */
#ifndef TOILE_RENDER_PEM_MEMORY_H
#define TOILE_RENDER_PEM_MEMORY_H

#include "render/pem/chain.h"
#include "render/pem/regions.h"

#include <stddef.h>

/* Figure 8 as printed, in MB of 2^20 bytes: PEMs of 128 and 256 texels a side (RGBA16F), variance shadow maps
 * of 64 to 1024 (RG16F). The PEM columns are twice the size of six faces of RGBA16F: 128^2 x 6 x 8 bytes are
 * 0.75 MB, or 1 MB with mip levels. */
#define TL_PAPER_ROWS 6
#define TL_PAPER_PEMS 2
#define TL_PAPER_MAPS 5
struct tl_paper_memory {
    int regions;
    double pems_mb[TL_PAPER_PEMS], maps_mb[TL_PAPER_MAPS];
};
extern const int tl_paper_pem_sizes[TL_PAPER_PEMS], tl_paper_map_sizes[TL_PAPER_MAPS]; /* texels */
extern const struct tl_paper_memory tl_paper_memory[TL_PAPER_ROWS];

/* Bytes of `regions` cube maps of RGBA16F: level 0 only, and the whole chain as pem/pems.h keeps it. */
size_t tl_memory_cubes(int regions, int size);
size_t tl_memory_chains(int regions, int size);
/* Bytes of `regions` shadow maps. */
size_t tl_memory_shadow_maps(int regions, int size, size_t texel_bytes);

/* The paper's proposal as pem/pems.h keeps it: cropped paraboloid maps, those of `per_array` regions in one
 * texture. RGBA16F. Filters the regions, since the crops are those of what they become. */
size_t tl_memory_paraboloids(const tl_cube *cube, const struct tl_regions *regions,
                             enum tl_chain_filter filter, int per_array);

#endif
