/* The lobes that stand for Ward's facets (lobe_fit.h), TL_LANES at a time: of several pixels, or of the
 * facets and the threads of one. What the fit evaluates as a gloss divided by a pdf has a closed form here,
 * and Schlick's term is kept apart as its two summands, so that colours come last. Pure; threads: any. */
#ifndef TOILE_RENDER_BRDF_WARD_LANES_H
#define TOILE_RENDER_BRDF_WARD_LANES_H

#include "render/brdf/facets.h"
#include "render/brdf/lobe_fit.h"

struct tl_ward_lanes {
    const struct tl_gloss *gloss;
    /* Given: */
    float viewer[3][TL_LANES]; /* in the frame of the threads */
    float square[2][TL_LANES]; /* squared widths along weft and warp */
    /* Results. Light by lobe: F0 * plain + (F90 - F0) * away, times the same of `albedo` over that of `sum`.
     */
    int count;                                 /* the greatest number of lobes of a lane */
    float local[TL_LOBE_FIT_MAX][3][TL_LANES]; /* directions, unit */
    float exponent[TL_LOBE_FIT_MAX][TL_LANES];
    float plain[TL_LOBE_FIT_MAX][TL_LANES], away[TL_LOBE_FIT_MAX][TL_LANES];
    float sum[2][TL_LANES], albedo[2][TL_LANES];
};

TL_INLINE WardFacets tl_ward_facets(const struct tl_ward_lanes *w, bool schlick, int lane)
{
    return (WardFacets){w->gloss->ward == TL_WARD_BOUNDED,
                        schlick ? FRESNEL_SCHLICK : w->gloss->fresnel,
                        w->gloss->index,
                        w->gloss->extinction,
                        w->viewer[0][lane],
                        w->viewer[1][lane],
                        w->viewer[2][lane]};
}

/* LobeSet of each lane. */
struct tl_lobe_set_lanes {
    float count[TL_LANES], first[TL_LANES], step[TL_LANES], overlap[TL_LANES], minimum[TL_LANES];
    float slope_x[TL_LANES], slope_y[TL_LANES], across_x[TL_LANES], across_y[TL_LANES];
};

TL_INLINE void tl_ward_lobe_sets(const struct tl_ward_lanes *w, int max_count, struct tl_lobe_set_lanes *sets)
{
    const float root_half = 0.707106781f;
    for (int i = 0; i < TL_LANES; i++) {
        const LobeSet set = lobe_set(root_half * sqrtf(w->square[0][i]), root_half * sqrtf(w->square[1][i]),
                                     w->viewer[0][i], w->viewer[1][i], w->viewer[2][i], 1, (float)max_count);
        sets->count[i] = set.count, sets->first[i] = set.first, sets->step[i] = set.step_by;
        sets->overlap[i] = set.overlap, sets->minimum[i] = set.narrowest;
        sets->slope_x[i] = set.slope_x, sets->slope_y[i] = set.slope_y;
        sets->across_x[i] = set.across_x, sets->across_y[i] = set.across_y;
    }
}

TL_INLINE void tl_ward_place(struct tl_ward_lanes *w, bool schlick, int max_count, int lane_count)
{
    struct tl_lobe_set_lanes sets;
    tl_ward_lobe_sets(w, max_count, &sets);
    w->count = 1;
    for (int i = 0; i < lane_count; i++)
        w->count = sets.count[i] > (float)w->count ? (int)sets.count[i] : w->count;
    for (int i = 0; i < TL_LANES; i++)
        w->sum[0][i] = w->sum[1][i] = 0;
    for (int k = 0; k < w->count; k++)
        for (int i = 0; i < TL_LANES; i++) {
            const LobeSet set = {sets.count[i],    sets.first[i],   sets.step[i],
                                 sets.slope_x[i],  sets.slope_y[i], sets.across_x[i],
                                 sets.across_y[i], sets.overlap[i], sets.minimum[i]};
            const WardLobe lobe = ward_lobe_of(tl_ward_facets(w, schlick, i), set, (float)k);
            w->exponent[k][i] = lobe.exponent;
            w->plain[k][i] = lobe.plain;
            w->away[k][i] = lobe.away;
            w->local[k][0][i] = lobe.x;
            w->local[k][1][i] = lobe.y;
            w->local[k][2][i] = lobe.z;
            w->sum[0][i] += lobe.above * lobe.plain;
            w->sum[1][i] += lobe.above * lobe.away;
        }
}

/* SlopeQuadrature of each lane. */
struct tl_quadrature_lanes {
    float along[2][TL_LANES], across[2][TL_LANES], middle[TL_LANES], half[TL_LANES], all[TL_LANES];
};

TL_INLINE void tl_ward_albedo(struct tl_ward_lanes *w, bool schlick)
{
    const float root_half = 0.707106781f;
    struct tl_quadrature_lanes nodes;
    float shares[TL_LANES];
    for (int i = 0; i < TL_LANES; i++) {
        const SlopeQuadrature of =
            slope_quadrature(root_half * sqrtf(w->square[0][i]), root_half * sqrtf(w->square[1][i]),
                             w->viewer[0][i], w->viewer[1][i], w->viewer[2][i]);
        nodes.along[0][i] = of.along_x, nodes.along[1][i] = of.along_y;
        nodes.across[0][i] = of.across_x, nodes.across[1][i] = of.across_y;
        nodes.middle[i] = of.middle, nodes.half[i] = of.half_width, nodes.all[i] = of.share;
        w->albedo[0][i] = w->albedo[1][i] = shares[i] = 0;
    }
    for (int point = 0; point < SLOPE_POINTS; point++)
        for (int i = 0; i < TL_LANES; i++) {
            const SlopeQuadrature at = {nodes.along[0][i],  nodes.along[1][i], nodes.across[0][i],
                                        nodes.across[1][i], nodes.middle[i],   nodes.half[i],
                                        nodes.all[i]};
            const WardValues mean = ward_node(tl_ward_facets(w, schlick, i), at, point);
            shares[i] += mean.share;
            w->albedo[0][i] += mean.plain;
            w->albedo[1][i] += mean.away;
        }
    for (int i = 0; i < TL_LANES; i++) {
        w->albedo[0][i] *= nodes.all[i] / shares[i];
        w->albedo[1][i] *= nodes.all[i] / shares[i];
    }
}

/* Finds the lobes, at most `max_count`; `lane_count` lanes are used. */
TL_INLINE void tl_ward_fit(struct tl_ward_lanes *w, int max_count, int lane_count)
{
    if (w->gloss->fresnel == TL_FRESNEL_SCHLICK) {
        tl_ward_place(w, true, max_count, lane_count);
        tl_ward_albedo(w, true);
    } else {
        tl_ward_place(w, false, max_count, lane_count);
        tl_ward_albedo(w, false);
    }
}

#endif
