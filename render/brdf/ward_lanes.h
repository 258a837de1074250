/* The lobes that stand for Ward's facets (lobe_fit.h), TL_LANES at a time: of several pixels, or of the
 * facets and the threads of one. What the fit evaluates as a gloss divided by a pdf has a closed form here,
 * and Schlick's term is kept apart as its two summands, so that colours come last. Pure; threads: any. */
#ifndef TOILE_RENDER_BRDF_WARD_LANES_H
#define TOILE_RENDER_BRDF_WARD_LANES_H

#include "render/brdf/fresnel.h"
#include "render/brdf/lobe_fit.h"
#include "render/brdf/lobe_set.h"

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

/* The contribution of a slope to the gloss: see value_of_slope of lobe_fit.c. With q the squared cosine of
 * the facet, p = t sqrt(1 / q) and a = 2 p q - b it is p q^2 sqrt(a / b) by Ward, and a / (p q) in the
 * bounded form. */
struct tl_ward_slope {
    float value, away; /* ... and times (1 - t)^5 */
    float towards;     /* p q */
};

TL_INLINE struct tl_ward_slope tl_ward_slope_at(const struct tl_gloss *gloss, bool schlick, float x, float y,
                                                float z, float slope_x, float slope_y)
{
    float p = z + x * slope_x + y * slope_y, q = 1 / (1 + slope_x * slope_x + slope_y * slope_y);
    float a = 2 * p * q - z, t = p * sqrtf(q), rest = 1 - tl_minf(t, 1);
    bool is_seen = (p > 0) & (a > 0);
    float published = p * q * q * sqrtf(tl_maxf(a, 0) / z), bounded = a / (p * q);
    float value = gloss->ward == TL_WARD_BOUNDED ? bounded : published;
    value = is_seen ? value : 0;
    if (!schlick)
        value *= gloss->fresnel == TL_FRESNEL_DIELECTRIC
                     ? tl_fresnel_dielectric(gloss->index, tl_maxf(t, 0))
                     : tl_fresnel_conductor(gloss->index, gloss->extinction, tl_maxf(t, 0));
    float square = rest * rest;
    return (struct tl_ward_slope){value, schlick ? value * square * square * rest : 0, p * q};
}

/* tl_lobe_set of each lane. */
struct tl_lobe_set_lanes {
    float count[TL_LANES], first[TL_LANES], step[TL_LANES], overlap[TL_LANES], minimum[TL_LANES];
    float slope_x[TL_LANES], slope_y[TL_LANES], across_x[TL_LANES], across_y[TL_LANES];
};

TL_INLINE void tl_ward_lobe_sets(const struct tl_ward_lanes *w, int max_count, struct tl_lobe_set_lanes *sets)
{
    const float root_half = 0.707106781f;
    for (int i = 0; i < TL_LANES; i++) {
        const struct tl_lobe_set set =
            tl_lobe_set_of(root_half * sqrtf(w->square[0][i]), root_half * sqrtf(w->square[1][i]),
                           w->viewer[0][i], w->viewer[1][i], w->viewer[2][i], 1, max_count);
        sets->count[i] = set.count, sets->first[i] = set.first, sets->step[i] = set.step;
        sets->overlap[i] = set.overlap, sets->minimum[i] = set.minimum;
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
            const struct tl_lobe_set set = {sets.count[i],    sets.first[i],   sets.step[i],
                                            sets.slope_x[i],  sets.slope_y[i], sets.across_x[i],
                                            sets.across_y[i], sets.overlap[i], sets.minimum[i]};
            float x = w->viewer[0][i], y = w->viewer[1][i], z = w->viewer[2][i];
            struct tl_slope_lobe at = tl_slope_lobe_of(&set, (float)k, x, y, z);
            struct tl_ward_slope lobe = tl_ward_slope_at(w->gloss, schlick, x, y, z, at.slope_x, at.slope_y);
            float share = (float)k < set.count ? at.share : 0;
            float exponent = tl_slope_exponent(at.variance), axis = 2 * lobe.towards - z;
            float above = tl_slope_above(axis, exponent);
            w->exponent[k][i] = exponent;
            w->plain[k][i] = share * lobe.value;
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
        struct tl_slope_quadrature nodes =
            tl_slope_quadrature_of(root_half * sqrtf(w->square[0][i]), root_half * sqrtf(w->square[1][i]),
                                   w->viewer[0][i], w->viewer[1][i], w->viewer[2][i]);
        along[0][i] = nodes.along_x, along[1][i] = nodes.along_y;
        across[0][i] = nodes.across_x, across[1][i] = nodes.across_y;
        middle[i] = nodes.middle, half[i] = nodes.half, all[i] = nodes.share;
        w->albedo[0][i] = w->albedo[1][i] = shares[i] = 0;
    }
    for (int point = 0; point < TL_SLOPE_POINTS; point++)
        for (int i = 0; i < TL_LANES; i++) {
            float x = w->viewer[0][i], y = w->viewer[1][i], z = w->viewer[2][i];
            float at = middle[i] + half[i] * tl_slope_points[point], share = tl_slope_weight(point, at);
            float slope_x = at * along[0][i], slope_y = at * along[1][i];
            struct tl_ward_slope one =
                tl_ward_slope_at(w->gloss, schlick, x, y, z, slope_x + across[0][i], slope_y + across[1][i]);
            struct tl_ward_slope other =
                tl_ward_slope_at(w->gloss, schlick, x, y, z, slope_x - across[0][i], slope_y - across[1][i]);
            shares[i] += share;
            w->albedo[0][i] += 0.5f * share * (one.value + other.value);
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
