/* The environment cut into regions of about equal importance: median cut [Debevec 2005] on the six faces of a
 * cube, as [002] section 4 does. Pure; bit-identical at any thread count. */
#ifndef TOILE_RENDER_PEM_REGIONS_H
#define TOILE_RENDER_PEM_REGIONS_H

#include "render/env/cube.h"

#define TL_REGIONS_MAX 384

struct tl_region {
    int face, x0, y0, x1, y1; /* texels [x0, x1) x [y0, y1) of a face */
    vec3s direction;          /* unit: luminance-weighted centroid; geometric centre of a black region */
    float solid_angle;        /* sr */
    float importance;         /* integral of luminance, W sr^-1 m^-2 x sr */
    float cone; /* rad: half-angle of the cone of the same solid angle, acos(1 - solid_angle / 2 pi) */
};

struct tl_regions {
    int count;
    struct tl_region items[TL_REGIONS_MAX];
};

/* `count` is a multiple of six, 6 to TL_REGIONS_MAX: count / 6 regions a face. A cut runs across the longer
 * side (in angle) where both halves hold importance in proportion to the number of regions they get. Each
 * texel lies in exactly one region; a region is never empty while the face has texels enough. */
void tl_regions_cut(const tl_cube *cube, int count, struct tl_regions *out);

#endif
