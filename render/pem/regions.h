/* Division of the environment into regions, by two methods. Pure; bit-identical at any number of threads.
 *
 * Faces: median cut [Debevec 2005] on the six faces of a cube, [Knuth et al. 2014, 4]. Sphere: variance
 * minimisation [Viriyothai and Debevec 2009]: the whole sphere is cut along the longest axis of a node, where
 * the cut leaves the least variance, so that no cut divides a compact light. The measure is half luminance
 * and half solid angle (docs/notes/visibility.md, 5). */
#ifndef TOILE_RENDER_PEM_REGIONS_H
#define TOILE_RENDER_PEM_REGIONS_H

#include "render/env/cube.h"

#define TL_REGIONS_MAX 384

struct tl_region {
    int face, x0, y0, x1,
        y1;            /* median cut of the faces: texels [x0, x1) x [y0, y1) of a face; else face is -1 */
    vec3s direction;   /* unit: luminance-weighted centroid; geometric centre of a black region */
    vec3s power;       /* integral of radiance, RGB, W sr^-1 m^-2 x sr */
    float solid_angle; /* sr */
    float importance;  /* integral of luminance, W sr^-1 m^-2 x sr */
    float cone;        /* rad: half-angle of the cone of the same solid angle, acos(1 - solid_angle / 2 pi) */
    float spread; /* rad: root of the luminance-weighted mean square angle from `direction`; a texel's light
                     is spread over the texel */
};

/* The binary tree of a cut of the sphere: nodes 0 .. 2 count - 2, parents before their children. PEMs are
 * additive, so an inner node stands for its leaves without filtering again. */
struct tl_region_node {
    int children[2]; /* -1: a leaf */
    int parent;      /* -1: the root */
    int region;      /* leaf: index into items; inner node: -1 */
    int rank;        /* inner node: it was cut as number `rank` (0: the root) */
};

/* A division; owns its arrays. A zeroed struct is empty and may be cut into or released. */
struct tl_regions {
    int count;
    struct tl_region items[TL_REGIONS_MAX];
    int size;            /* of the cube that was cut */
    uint16_t *labels;    /* [6][size][size]: region of every texel */
    float *solid_angles; /* [size][size]: of the texels of any face, sr */
    float *importance;   /* [6][size][size]: integral of every texel's luminance */
    /* The texels of each region in Morton order, and the fraction of the region's luminance (or solid angle,
     * if it is black) up to and including each of them; used by tl_region_direction. */
    uint32_t *texels;  /* [6 * size * size] */
    float *cumulative; /* parallel to `texels`, in (0, 1] within each region */
    uint32_t first[TL_REGIONS_MAX + 1];
    int node_count; /* 0 for a cut of the faces */
    struct tl_region_node nodes[2 * TL_REGIONS_MAX];
};

/* Median cut of the faces. `count` is a multiple of six, from 6 to TL_REGIONS_MAX: count / 6 regions per
 * face. A cut runs across the longer side (in angle), where the importance of both halves is proportional to
 * the numbers of their regions. Each texel lies in exactly one region; no region is empty if the face has
 * enough texels. Replaces the contents of `out`. */
void tl_regions_cut(const tl_cube *cube, int count, struct tl_regions *out);

/* Cut of the sphere into `count` regions, 1 to TL_REGIONS_MAX; fewer if the cube has fewer texels. Replaces
 * the contents of `out`. */
void tl_regions_cut_sphere(const tl_cube *cube, int count, struct tl_regions *out);

/* A deep copy. */
struct tl_regions tl_regions_copy(const struct tl_regions *regions);
void tl_regions_release(struct tl_regions *regions);

/* A direction inside region i, distributed as its luminance, for (u, v) uniform in [0, 1)^2. Neighbouring u
 * give neighbouring texels, so that stratified u cover the region evenly. Unit, in the environment's frame.
 * If the region is empty, its own direction. */
vec3s tl_region_direction(const struct tl_regions *regions, int i, float u, float v);
/* Direction number n of a sequence that covers the light of region i evenly after any number of terms. Every
 * region begins at a place of its own, so that no two jitter in step. */
vec3s tl_region_sample(const struct tl_regions *regions, int i, uint32_t n);

#endif
