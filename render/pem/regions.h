/* The environment cut into regions, two ways. Pure; bit-identical at any thread count. `tl_regions` owns its
 * arrays; one that is zeroed is empty and may be cut into or released.
 *
 * Faces: median cut [Debevec 2005] on the six faces of a cube, as [002] section 4 does. Sphere: cuts of the
 * whole sphere along the longest axis of what is cut, where they leave the least variance [Viriyothai and
 * Debevec 2009], so that no cut runs through a compact light; measured half by luminance, half by solid angle
 * (FRONTIER, finding 5). */
#ifndef TOILE_RENDER_PEM_REGIONS_H
#define TOILE_RENDER_PEM_REGIONS_H

#include "render/env/cube.h"

#define TL_REGIONS_MAX 384

struct tl_region {
    int face, x0, y0, x1, y1; /* cut of the faces: texels [x0, x1) x [y0, y1) of a face; else face -1 */
    vec3s direction;          /* unit: luminance-weighted centroid; geometric centre of a black region */
    vec3s power;              /* integral of radiance, RGB, W sr^-1 m^-2 x sr */
    float solid_angle;        /* sr */
    float importance;         /* integral of luminance, W sr^-1 m^-2 x sr */
    float cone;   /* rad: half-angle of the cone of the same solid angle, acos(1 - solid_angle / 2 pi) */
    float spread; /* rad: root of the luminance-weighted mean square angle from `direction`; a texel's light
                     is spread over the texel */
};

/* The binary tree of a cut of the sphere. Nodes 0 .. 2 count - 2; the children of a node come after it. PEMs
 * add, so an inner node stands for its leaves without refiltering. */
struct tl_region_node {
    int children[2]; /* -1: a leaf */
    int parent;      /* -1: the root */
    int region;      /* of a leaf: index into items; -1 for an inner node */
    int rank;        /* inner node: it was the rank-th to be cut (0: the root) */
};

struct tl_regions {
    int count;
    struct tl_region items[TL_REGIONS_MAX];
    int size;            /* of the cube that was cut */
    uint16_t *labels;    /* [6][size][size]: region of every texel */
    float *solid_angles; /* [size][size]: of the texels of any face, sr */
    float *importance;   /* [6][size][size]: integral of every texel's luminance */
    /* Texels by region, neighbours near each other (Morton order), and what part of a region's luminance (of
     * its solid angle, where it is black) lies at or before each: for tl_region_direction. */
    uint32_t *texels;  /* [6 * size * size] */
    float *cumulative; /* in step with texels, (0, 1] within each region */
    uint32_t first[TL_REGIONS_MAX + 1];
    int node_count; /* 0 for a cut of the faces */
    struct tl_region_node nodes[2 * TL_REGIONS_MAX];
};

/* `count` is a multiple of six, 6 to TL_REGIONS_MAX: count / 6 regions a face. A cut runs across the longer
 * side (in angle) where both halves hold importance in proportion to the number of regions they get. Each
 * texel lies in exactly one region; a region is never empty while the face has texels enough. Replaces what
 * `out` held. */
void tl_regions_cut(const tl_cube *cube, int count, struct tl_regions *out);

/* `count` from 1 to TL_REGIONS_MAX (fewer come out when the cube has fewer texels). */
void tl_regions_cut_sphere(const tl_cube *cube, int count, struct tl_regions *out);

/* The same cut with `count` regions, no more than `from` (a cut of the sphere) has: siblings merged, last cut
 * first. What tl_regions_cut_sphere makes of the same cube with `count`, but for the rounding of `power`.
 * `out` is not `from`. */
void tl_regions_merge(const struct tl_regions *from, int count, struct tl_regions *out);
struct tl_regions tl_regions_copy(const struct tl_regions *regions); /* to be released like any other */
void tl_regions_release(struct tl_regions *regions);

/* A direction inside region i, distributed as its luminance, for (u, v) uniform in [0, 1)^2; neighbouring u
 * give neighbouring texels, so that stratified u cover the region evenly. Unit, environment's frame. The
 * region's own direction where the region is empty. */
vec3s tl_region_direction(const struct tl_regions *regions, int i, float u, float v);

#endif
