/* A table of the lobes that stand for a gloss of facets (render/brdf/lobe_fit.h), by the direction of the
 * viewer in the frame of the threads: the fit takes ten evaluations of the gloss, a look-up a hundredth of
 * that.
 *
 * Exact at its nodes, interpolated between them. Reflectance is affine in F0 by Schlick's term, so two fits
 * give the weights at any F0; other Fresnel terms multiply F0 and are as exact. Glossiness is a third axis.
 * Ward's facets have two widths and no table (render/brdf/ward_lanes.h).
 * tests/render/shade/test_lobe_set_table.c prints the error. Threads: pure once made.
 */
#ifndef TOILE_RENDER_SHADE_LOBE_SET_TABLE_H
#define TOILE_RENDER_SHADE_LOBE_SET_TABLE_H

#include "render/brdf/lobe_fit.h"
#include "render/env/quad.h"
#include "render/gpu/vectors.h"

#include <math.h>
#include <stdbool.h>

typedef struct LobeSetBetween LobeSetBetween;
typedef struct LobeSetPlace LobeSetPlace;

#include "render/gpu/terms_begin.h"

#include "render/shade/lobe_set_terms.glsl"

#include "render/gpu/terms_end.h"

/* One node: lobes in the local frame (tangent, bitangent, normal). Two quads each. */
struct tl_lobe_set_lobe {
    float direction[3], log_exponent; /* base 2 */
    float low, high;                  /* weight at F0 = TL_LOBE_SET_LOW_F0 and at F0 = 1 */
    float orders;                     /* of the first lobe: of the cell that begins at this node */
    float unused;
};
struct tl_lobe_set_node {
    struct tl_lobe_set_lobe lobes[TL_LOBE_FIT_MAX];
};

struct tl_lobe_set_table {
    int lobe_count, gloss_count;
    float gloss_low, gloss_high;    /* 1 - 1 / exponent at the ends of the third axis */
    struct tl_lobe_set_node *nodes; /* [gloss][cosine][azimuth] */
};

/* Makes the table of a material whose gloss is made of facets, for glossiness between two values, with at
 * most `max_count` lobes. */
void tl_lobe_set_table_make(const tl_material *material, float gloss_low, float gloss_high, int max_count,
                            struct tl_lobe_set_table *out);
void tl_lobe_set_table_release(struct tl_lobe_set_table *table);

TL_INLINE const struct tl_lobe_set_node *tl_lobe_set_nodes(const struct tl_lobe_set_table *table, int gloss,
                                                           int row, int column)
{
    return table->nodes + (size_t)(gloss * TL_LOBE_SET_COSINES + row) * TL_LOBE_SET_AZIMUTHS + (size_t)column;
}

/* The fit lists its lobes along an axis that has no sign, and which turns by half a turn about a viewer to
 * whom the gloss is round: no order of the lobes suits all nodes, but one suits a cell. Bit i of `orders`:
 * corner i lists them from the other end. */
TL_INLINE void tl_lobe_set_add_nodes(const struct tl_lobe_set_table *table,
                                     const struct tl_lobe_set_node *nodes, int orders, float share,
                                     LobeSetBetween row, LobeSetBetween column,
                                     tl_quad sums[2 * TL_LOBE_FIT_MAX])
{
    for (int i = 0; i < 4; i++) {
        float weight =
            share * (i & 1 ? column.share : 1 - column.share) * (i & 2 ? row.share : 1 - row.share);
        const tl_quad *lobe = (const tl_quad *)&nodes[(i >> 1) * TL_LOBE_SET_AZIMUTHS + (i & 1)];
        bool reversed = orders >> i & 1;
        lobe += reversed ? 2 * (table->lobe_count - 1) : 0;
        for (size_t k = 0; k < (size_t)table->lobe_count; k++, lobe += reversed ? -2 : 2) {
            sums[2 * k] += weight * lobe[0];
            sums[2 * k + 1] += weight * lobe[1];
        }
    }
}

/* lobe_set_place in a table. */
TL_INLINE LobeSetPlace tl_lobe_set_place(const struct tl_lobe_set_table *table, float x, float y,
                                         float cosine, float glossiness)
{
    return lobe_set_place(x, y, cosine, glossiness, table->gloss_low, table->gloss_high, table->gloss_count);
}

/* The interpolated node: of each lobe its direction, which is not normalised, and its logarithm; then its
 * weights. */
TL_INLINE void tl_lobe_set_fetch(const struct tl_lobe_set_table *table, const LobeSetPlace *at,
                                 tl_quad sums[2 * TL_LOBE_FIT_MAX])
{
    for (int k = 0; k < 2 * table->lobe_count; k++)
        sums[k] = (tl_quad){0, 0, 0, 0};
    const struct tl_lobe_set_node *nodes =
        tl_lobe_set_nodes(table, at->gloss.first, at->row.first, at->column.first);
    int orders = (int)nodes->lobes[0].orders;
    if (table->gloss_count == 1) {
        tl_lobe_set_add_nodes(table, nodes, orders, 1, at->row, at->column, sums);
        return;
    }
    tl_lobe_set_add_nodes(table, nodes, orders, 1 - at->gloss.share, at->row, at->column, sums);
    tl_lobe_set_add_nodes(table, nodes + (size_t)TL_LOBE_SET_COSINES * TL_LOBE_SET_AZIMUTHS, orders >> 4,
                          at->gloss.share, at->row, at->column, sums);
}

/* The weight of a lobe at a reflectance, by channel: these shares of its weights at the low and at the high
 * F0. */
struct tl_lobe_set_shares {
    tl_quad low, high;
};

TL_INLINE struct tl_lobe_set_shares tl_lobe_set_shares(tl_quad f0)
{
    return (struct tl_lobe_set_shares){
        {lobe_set_low_share(f0[0]), lobe_set_low_share(f0[1]), lobe_set_low_share(f0[2]), 0},
        {lobe_set_high_share(f0[0]), lobe_set_high_share(f0[1]), lobe_set_high_share(f0[2]), 0}};
}

#endif
