/* Exactly prefiltered partial environment maps: P_i(d, s) = integral over region i of L(w) K_s(d, w) dw, by
 * direct convolution with solid-angle weights. Each source texel belongs to one region, so all regions
 * together cost about as much as one whole map.
 *
 * The slice of region i and exponent k is a small square map in the frame of the region: Lambert's azimuthal
 * equal-area projection about the direction of the region, cropped to where its lobes do not vanish. (Cropped
 * paraboloid maps, which [Knuth et al. 2014, 5] propose, are paraboloids.h; in this projection all texels
 * have the same size.) P is 0 outside of the map. Pure; results do not depend on the number of threads. */
#ifndef TOILE_RENDER_PEM_SLICES_H
#define TOILE_RENDER_PEM_SLICES_H

#include "render/env/lobes.h"
#include "render/pem/regions.h"

/* The frame of a region's maps. With (x, y, z) = (d.right, d.up, d.direction) of a unit d, the map coordinate
 * is 0.5 + (x, y) * sqrt(2 / (1 + z)) * scale[k], in [0, 1] inside the crop; texel centres lie at (i + 0.5) /
 * side. */
struct tl_slice_frame {
    vec3s right, up, direction; /* environment's frame, unit */
    float scale[TL_EXPONENT_COUNT + 1];
};

struct tl_slices {
    int region_count;
    uint32_t made; /* bits by exponent */
    struct tl_slice_frame frames[TL_REGIONS_MAX];
    int side[TL_EXPONENT_COUNT + 1];      /* texels; the same for all regions */
    float *texels[TL_EXPONENT_COUNT + 1]; /* [region][side][side][3]; NULL: not made */
};

/* Computes the slices of `needed` that do not exist yet. Release them when cube or regions change. */
void tl_slices_make(struct tl_slices *slices, const tl_cube *cube, const struct tl_regions *regions,
                    uint32_t needed);
void tl_slices_release(struct tl_slices *slices);
/* P_region(d, s); `direction` is unit, in the environment's frame. The exponents of the blend must exist. */
vec3s tl_slices_fetch(const struct tl_slices *slices, int region, vec3s direction,
                      struct tl_exponent_blend blend);

/* Size on the GPU (4 bytes per texel). */
size_t tl_slices_bytes(const struct tl_slices *slices);
/* The size that the slices of `exponents` will have, computed without making them. */
size_t tl_slices_bytes_of(const tl_cube *cube, const struct tl_regions *regions, uint32_t exponents);

#endif
