/* The lobes that stand for Ward's facets (lobe_fit.h), TL_LANES at a time: of several pixels, or of the
 * facets and the threads of one. What the fit evaluates as a gloss divided by a pdf has a closed form here,
 * and Schlick's term is kept apart as its two summands, so that colours come last. Pure; threads: any. */
#ifndef TOILE_RENDER_BRDF_WARD_LANES_H
#define TOILE_RENDER_BRDF_WARD_LANES_H

#include "render/brdf/facets.h"
#include "render/brdf/fresnel.h"
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

/* A slope's contribution, and times (1 - t)^5 where Schlick's term is kept apart. */
struct tl_ward_value {
    float plain, away;
    float towards; /* WardSlope */
};

TL_INLINE struct tl_ward_value tl_ward_value_of(const struct tl_gloss *gloss, bool schlick, float x, float y,
                                                float z, float slope_x, float slope_y)
{
    const WardSlope slope = ward_slope(gloss->ward == TL_WARD_BOUNDED, x, y, z, slope_x, slope_y);
    float value = slope.value;
    if (!schlick)
        value *= gloss->fresnel == TL_FRESNEL_DIELECTRIC
                     ? tl_fresnel_dielectric(gloss->index, slope.cosine)
                     : tl_fresnel_conductor(gloss->index, gloss->extinction, slope.cosine);
    return (struct tl_ward_value){value, schlick ? value * schlick_share(slope.cosine) : 0, slope.towards};
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
            float x = w->viewer[0][i], y = w->viewer[1][i], z = w->viewer[2][i];
            const SlopeLobe at = slope_lobe(set, (float)k, x, y, z);
            const struct tl_ward_value lobe =
                tl_ward_value_of(w->gloss, schlick, x, y, z, at.slope_x, at.slope_y);
            float share = (float)k < set.count ? at.share : 0;
            float exponent = slope_exponent(at.variance), axis = 2 * lobe.towards - z;
            float above = slope_above(axis, exponent);
            w->exponent[k][i] = exponent;
            w->plain[k][i] = share * lobe.plain;
            w->away[k][i] = share * lobe.away;
            w->local[k][0][i] = 2 * lobe.towards * at.slope_x - x;
            w->local[k][1][i] = 2 * lobe.towards * at.slope_y - y;
            w->local[k][2][i] = axis;
            w->sum[0][i] += above * w->plain[k][i];
            w->sum[1][i] += above * w->away[k][i];
        }
}

TL_INLINE void tl_ward_albedo(struct tl_ward_lanes *w, bool schlick)
{
    const float root_half = 0.707106781f;
    float along[2][TL_LANES], across[2][TL_LANES], middle[TL_LANES], half[TL_LANES], all[TL_LANES];
    float shares[TL_LANES];
    for (int i = 0; i < TL_LANES; i++) {
        const SlopeQuadrature nodes =
            slope_quadrature(root_half * sqrtf(w->square[0][i]), root_half * sqrtf(w->square[1][i]),
                             w->viewer[0][i], w->viewer[1][i], w->viewer[2][i]);
        along[0][i] = nodes.along_x, along[1][i] = nodes.along_y;
        across[0][i] = nodes.across_x, across[1][i] = nodes.across_y;
        middle[i] = nodes.middle, half[i] = nodes.half_width, all[i] = nodes.share;
        w->albedo[0][i] = w->albedo[1][i] = shares[i] = 0;
    }
    for (int point = 0; point < SLOPE_POINTS; point++)
        for (int i = 0; i < TL_LANES; i++) {
            float x = w->viewer[0][i], y = w->viewer[1][i], z = w->viewer[2][i];
            float at = middle[i] + half[i] * slope_points[point], share = slope_weight(point, at);
            float slope_x = at * along[0][i], slope_y = at * along[1][i];
            const struct tl_ward_value one =
                tl_ward_value_of(w->gloss, schlick, x, y, z, slope_x + across[0][i], slope_y + across[1][i]);
            const struct tl_ward_value other =
                tl_ward_value_of(w->gloss, schlick, x, y, z, slope_x - across[0][i], slope_y - across[1][i]);
            shares[i] += share;
            w->albedo[0][i] += 0.5f * share * (one.plain + other.plain);
            w->albedo[1][i] += 0.5f * share * (one.away + other.away);
        }
    for (int i = 0; i < TL_LANES; i++) {
        w->albedo[0][i] *= all[i] / shares[i];
        w->albedo[1][i] *= all[i] / shares[i];
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
