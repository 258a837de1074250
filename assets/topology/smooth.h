/* Loop's subdivision of a welded triangle mesh, as weights: every triangle becomes four, whose corners lie on
 * the smooth surface that endless subdivision leads to. The weights depend on connectivity alone, so that a
 * frame only sums them.
 *
 * Weights after [Loop 1987], limit positions after [Hoppe et al. 1994]. Creases and borders are cubic
 * B-splines of their own vertices, the same ones from both sides, so the surface stays closed. Where creases
 * end, cross or turn in one triangle, the vertex stays. Any list of triangles is accepted: an edge of one, or
 * of more than two of them is a crease.
 *
 * Lifetime: plain structs that own their arrays. Threads: pure; tl_smooth_apply is parallel inside, with the
 * same results at any number of threads. */
#ifndef TOILE_ASSETS_TOPOLOGY_SMOOTH_H
#define TOILE_ASSETS_TOPOLOGY_SMOOTH_H

#include <cglm/struct.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* All borrowed. */
struct tl_smooth_source {
    size_t vertex_count, triangle_count;
    const uint32_t (
        *triangles)[3];       /* below vertex_count; those with two equal corners have no area, and stay so */
    const bool (*creases)[3]; /* [triangle] whether the edge that faces each corner is a crease; NULL: none */
};

struct tl_smooth {
    size_t source_count, vertex_count; /* the source's vertices, then one on each edge */
    size_t triangle_count;             /* four for each of the source's: at its corners, then its middle */
    uint32_t (*triangles)[3];          /* [triangle_count] */
    uint32_t (*ends)[2];               /* [vertex_count - source_count] of each edge */
    size_t *firsts;                    /* [vertex_count + 1] into the weights */
    uint32_t *sources;                 /* vertices of the source */
    float *weights;                    /* of a vertex: 1 in sum, none negative */
};

struct tl_smooth tl_smooth_make(const struct tl_smooth_source *source);
void tl_smooth_release(struct tl_smooth *smooth); /* frees and zeroes */

/* Computes `fine` [vertex_count] from `coarse` [source_count]. */
void tl_smooth_apply(const struct tl_smooth *smooth, const vec3s *coarse, vec3s *fine);

#endif
