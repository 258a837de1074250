/* Fans of triangles around vertices, arranged so that TL_LANES of them are streamed in parallel lanes.
 *
 * An item is one tangent frame: a normal, and one tangent group around it. Its fan is a list of spokes, the
 * neighbours of the vertex in order: two consecutive spokes and the vertex are a triangle, so that each spoke
 * is read once for two triangles. Between the pieces of a fan, and after its end, the spoke is the vertex
 * itself, which makes triangles without area that add nothing. A vertex with several groups has one item that
 * sums its normal and the first group's tangent, and further items, the borrowers, that copy that normal
 * instead of summing it again. */
#ifndef TOILE_CLOTH_TANGENTS_TANGENT_LAYOUT_H
#define TOILE_CLOTH_TANGENTS_TANGENT_LAYOUT_H

#include "cloth/tangents/tangent_frames.h"
#include "cloth/tangents/tangent_groups.h"
#include "config/base/simd.h"

struct tl_tangent_block {
    uint32_t first_row;      /* of `rows`: the vertices themselves, then spoke_count rows of spokes */
    uint32_t first_gradient; /* of `gradients`: spoke_count - 1 rows */
    uint32_t spoke_count;
    uint32_t first_output; /* of `outputs`; the next block's is their end */
};

struct tl_tangent_output {
    uint32_t vertex, lane;
};

/* The last result. A vertex whose triangles give no direction in a frame keeps it. */
struct tl_tangent_state {
    float normal[3][TL_LANES], tangent[3][TL_LANES];
    float sign[TL_LANES];
};

struct tl_tangent_frames {
    size_t block_count, borrower_count; /* the borrowers come last */
    struct tl_tangent_block *blocks;    /* [block_count + 1] */
    uint32_t (*rows)[TL_LANES];         /* render vertices */
    float (*gradients)[2][TL_LANES];    /* tangent = spoke * [0] + next spoke * [1] */
    struct tl_tangent_output *outputs;  /* render vertices of each block */
    uint32_t (*lenders)[TL_LANES];      /* [borrower_count] slot of the item whose normal each lane copies */
    struct tl_tangent_state *states;    /* [block_count] */
};

/* Fills empty `frames` from the groups. */
void tl_tangent_frames_lay_out(tl_tangent_frames *frames, const struct tl_tangent_groups *groups);

#endif
