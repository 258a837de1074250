/* Places of the lobes of a fit that stand for facets with Gaussian slopes (lobe_fit.h), and the quadrature
 * for their albedo: scalar arithmetic without branches, which render/shade evaluates for many pixels at a
 * time. Directions are in the frame (tangent, bitangent, normal). Pure; threads: any. */
#ifndef TOILE_RENDER_BRDF_SLOPE_LOBE_SET_H
#define TOILE_RENDER_BRDF_SLOPE_LOBE_SET_H

#include "config/base/simd.h"

#include <math.h>
#include <stdbool.h>

/* The cosine to the viewer, at least, for which the spread of light across the plane of incidence is
 * computed. */
#define TL_SLOPE_MIN_COSINE 0.2f

/* The larger and the smaller eigenvalue of J S J^T, and the slope of one standard deviation along the axis of
 * the larger one. */
struct tl_slope_axes {
    float broad, narrow, slope_x, slope_y;
};

/* `weft`, `warp`: standard deviations of the slopes along x and y; (x, y): the viewer; `cosine`: that of a
 * facet to the viewer.
 *
 * The eigenvalues of J S J^T are those of S^(1/2) J^T J S^(1/2), where J^T J = 4 (v_t v_t^T + c^2 I) with the
 * tangential part v_t and the cosine c of the view direction: a facet turns light by twice its own angle in
 * the plane of incidence, and by 2 c times that angle across it. The eigenvector of the larger eigenvalue,
 * times S^(1/2), is the slope of one standard deviation along the broad axis. */
TL_INLINE struct tl_slope_axes tl_slope_axes_of(float weft, float warp, float x, float y, float cosine)
{
    float square = cosine * cosine;
    float a = 4 * weft * weft * (x * x + square), b = 4 * weft * warp * x * y;
    float d = 4 * warp * warp * (y * y + square);
    float mean = (a + d) / 2, half = (a - d) / 2, off = sqrtf(half * half + b * b);
    float twice = half / tl_maxf(off, 1e-20f); /* cosine of twice the angle of the broad axis */
    float part = sqrtf(tl_maxf((1 + twice) / 2, 0)), other = sqrtf(tl_maxf((1 - twice) / 2, 0));
    return (struct tl_slope_axes){mean + off, tl_maxf(mean - off, 0), weft * part,
                                  warp * (b < 0 ? -other : other)};
}

/* The lobes towards one viewer. Lobe k stands for the slopes about `first + k step` standard deviations along
 * the axis along which light spreads most; slopes that send light below the horizon are left out. */
struct tl_lobe_set {
    float count; /* a whole number */
    float first, step;
    float slope_x, slope_y;   /* one standard deviation along the axis, towards the viewer */
    float across_x, across_y; /* ... and across it, as light spreads */
    float overlap;            /* standard deviation of a lobe over the distance of two neighbours, at least */
    float minimum;            /* variance of a lobe, at least */
};

/* The part of the spread that lobes stand for, in standard deviations, and how far they overlap, where there
 * are as many as it takes; else a gap between them costs more than what they leave out. These and the figure
 * for up to four lobes had the least L1 error of some twenty sets, over satin's facets and threads and a
 * round gloss, from in front to 1.45 rad; the next best sets are within a tenth of it. */
#define TL_LOBE_SET_REACH         2.5f
#define TL_LOBE_SET_OVERLAP       0.42f
#define TL_LOBE_SET_REACH_FEW     2.0f
#define TL_LOBE_SET_OVERLAP_FEW   0.31f
#define TL_LOBE_SET_REACH_OF_FOUR 2.1f

/* The mean of the slopes that the viewer sees, in standard deviations towards the viewer, where those below
 * `cut`, at most 0, are turned away: phi / Phi of a normal distribution within .13, which only a
 * cosine depends on: 0.6 times the mean fits as well. */
TL_INLINE float tl_slope_mean_seen(float cut)
{
    float fall = tl_exp2(-0.72134752f * cut * cut);
    return 0.4f * fall / (1 - 0.5f * fall);
}

/* `minimum`, `maximum`: of lobes. As many as it takes for neighbours to overlap, or else `maximum`, which are
 * wider. */
TL_INLINE struct tl_lobe_set tl_lobe_set_of(float weft, float warp, float x, float y, float z, int minimum,
                                            int maximum)
{
    float flat = sqrtf(x * x + y * y), scale = 1 / tl_maxf(flat, 1e-4f);
    float seen_x = x * scale * weft, seen_y = y * scale * warp;
    float deviation = tl_maxf(sqrtf(seen_x * seen_x + seen_y * seen_y), 1e-6f);
    float mean = tl_slope_mean_seen(-(1 - flat) / tl_maxf(z, 1e-6f) / deviation);
    float mean_x = mean * seen_x * weft / deviation, mean_y = mean * seen_y * warp / deviation;
    float facing = (z + x * mean_x + y * mean_y) / sqrtf(1 + mean_x * mean_x + mean_y * mean_y);
    const struct tl_slope_axes axes = tl_slope_axes_of(weft, warp, x, y, tl_maxf(facing, 0.02f));

    float towards = x * axes.slope_x + y * axes.slope_y, side = copysignf(1, towards);
    float slope_x = side * axes.slope_x, slope_y = side * axes.slope_y;
    float square = slope_x * slope_x + slope_y * slope_y;
    towards *= side;
    /* A slope of t deviations sends light upwards where square z t^2 - 2 towards t - z < 0. */
    float root = sqrtf(towards * towards + square * z * z);
    float lowest = -z / tl_maxf(towards + root, 1e-12f);
    float highest = (towards + root) / tl_maxf(square * z, 1e-9f);

    float thin = 2 * TL_SLOPE_MIN_COSINE * tl_minf(weft, warp), narrow = tl_maxf(axes.narrow, thin * thin);
    float span = tl_minf(highest, TL_LOBE_SET_REACH) - tl_maxf(lowest, -TL_LOBE_SET_REACH);
    float widening = sqrtf(tl_maxf(axes.broad - narrow, 0) / narrow);
    float wanted = tl_minf(TL_LOBE_SET_OVERLAP * widening * span, (float)maximum + 1);
    wanted = (float)(int)(wanted + 0.9999f);
    float is_broad = axes.broad > 1.5f * narrow ? 1.0f : 0.0f;
    wanted = 1 + is_broad * (tl_maxf(wanted, 3) - 1);
    float few = wanted > (float)maximum ? 1.0f : 0.0f;
    float count = tl_minf(tl_maxf(wanted, (float)minimum), (float)maximum);
    float reach = TL_LOBE_SET_REACH + few * (TL_LOBE_SET_REACH_FEW - TL_LOBE_SET_REACH);
    reach = count <= 4 ? TL_LOBE_SET_REACH_OF_FOUR : reach;
    float from = tl_maxf(lowest, -reach), step = (tl_minf(highest, reach) - from) / count;
    float first = tl_minf(count - 1, 1) * (from + step / 2);
    return (struct tl_lobe_set){count,
                                first,
                                step,
                                slope_x,
                                slope_y,
                                -slope_y * weft / warp,
                                slope_x * warp / weft,
                                TL_LOBE_SET_OVERLAP + few * (TL_LOBE_SET_OVERLAP_FEW - TL_LOBE_SET_OVERLAP),
                                thin * thin};
}

/* A lobe of a set. */
struct tl_slope_lobe {
    float slope_x, slope_y; /* in whose mirror direction it lies */
    float share;            /* of all lobes, not normalised: the density of the slopes */
    float variance;
};

/* The square of the change of the mirror direction 2 (n v) n / n^2 - v, n = (x, y, 1), by a change of the
 * slope. `p`: n v; `square`: n^2. */
TL_INLINE float tl_slope_turned(float dp, float dn_n, float dn_dn, float p, float square)
{
    float along = 2 * (dp - 2 * p * dn_n / square) / square, own = 2 * p / square;
    return along * along * square + 2 * along * own * dn_n + own * own * dn_dn;
}

/* Lobe `k` towards the viewer (x, y, z). Its own width adds to that of the set, which is made narrower by as
 * much. */
TL_INLINE struct tl_slope_lobe tl_slope_lobe_of(const struct tl_lobe_set *set, float k, float x, float y,
                                                float z)
{
    float at = set->first + k * set->step, slope_x = at * set->slope_x, slope_y = at * set->slope_y;
    float p = z + x * slope_x + y * slope_y, square = 1 + slope_x * slope_x + slope_y * slope_y;
    float broad =
        tl_slope_turned(x * set->slope_x + y * set->slope_y, slope_x * set->slope_x + slope_y * set->slope_y,
                        set->slope_x * set->slope_x + set->slope_y * set->slope_y, p, square);
    float narrow = tl_slope_turned(x * set->across_x + y * set->across_y,
                                   slope_x * set->across_x + slope_y * set->across_y,
                                   set->across_x * set->across_x + set->across_y * set->across_y, p, square);
    float between = set->overlap * set->step;
    float alone = sqrtf(tl_maxf(broad * narrow, 0)), variance = tl_maxf(narrow, between * between * broad);
    variance = tl_maxf(set->count > 1 ? variance : alone, set->minimum);
    float shrink = sqrtf(tl_maxf(1 - variance / tl_maxf(broad, 1e-20f), 0));
    return (struct tl_slope_lobe){shrink * slope_x, shrink * slope_y, tl_exp2(-0.72134752f * at * at),
                                  variance};
}

/* The squared width of facets by that without maps and bumps, and what these add to it. */
TL_INLINE float tl_facet_square(float square, float widening)
{
    const float narrowest = 1e-3f;
    return tl_minf(tl_maxf(square + widening, narrowest * narrowest), 1);
}

/* The principal axes of facets whose slopes are correlated: squared widths along them, and the angle from x
 * to the first of them, at most 45 degrees. */
struct tl_facet_axes {
    float square[2], cosine, sine;
};

/* The largest product of widths along x and y with which squared widths along both axes stay within those of
 * tl_facet_square. */
TL_INLINE float tl_facet_product(float weft, float warp, float product)
{
    const float narrowest = 1e-6f;
    float limit = tl_minf((weft - narrowest) * (warp - narrowest), (1 - weft) * (1 - warp));
    limit = sqrtf(tl_maxf(limit, 0));
    return tl_minf(tl_maxf(product, -limit), limit);
}

/* The axes of the symmetric matrix with `weft` and `warp` on its diagonal and `product` off it, which
 * tl_facet_product limits: the angle by Jacobi's rotation. A product that is rounding turns nothing: round
 * facets have no axes. */
TL_INLINE struct tl_facet_axes tl_facet_axes_of(float weft, float warp, float product)
{
    float mean = (weft + warp) / 2, half = (weft - warp) / 2;
    float off = sqrtf(half * half + product * product), signed_off = half < 0 ? -off : off;
    bool is_turned = fabsf(product) > 1e-6f * mean;
    float safe = tl_maxf(off, 1e-20f), share = is_turned ? tl_minf(fabsf(half) / safe, 1) : 1;
    float cosine = sqrtf((1 + share) / 2), sine = is_turned ? product / (2 * safe * cosine) : 0;
    return (struct tl_facet_axes){
        {is_turned ? mean + signed_off : weft, is_turned ? mean - signed_off : warp},
        cosine,
        half < 0 ? -sine : sine};
}

TL_INLINE float tl_slope_exponent(float variance)
{
    return tl_maxf(1 / tl_maxf(variance, 1e-7f) - 1, 1);
}

/* Nodes of the mean over all slopes: along the direction to the viewer, and two across it. Slopes that turn
 * away from the viewer by more than half of the angle left to a right angle reflect light from below the
 * horizon. That cuts the integrand off sharply, so the quadrature starts at the cut. Across it the integrand
 * is smooth, and two Gauss-Hermite nodes suffice. */
struct tl_slope_quadrature {
    float along_x, along_y, across_x, across_y; /* slopes of one standard deviation */
    float middle, half;                         /* of the interval along, in standard deviations */
    float share;                                /* of all slopes that it holds */
};

/* Integration range in standard deviations; the rest of a normal distribution is less than 0.3 %. */
#define TL_SLOPE_RANGE  3.0f
#define TL_SLOPE_POINTS 5 /* of Gauss and Legendre on [-1, 1] */

/* erf within 1.5e-7 [Abramowitz and Stegun 1964, 7.1.26]. */
TL_INLINE float tl_slope_erf(float x)
{
    float size = fabsf(x), t = 1 / (1 + 0.3275911f * size);
    float series = t * (0.254829592f +
                        t * (-0.284496736f + t * (1.421413741f + t * (-1.453152027f + t * 1.061405429f))));
    float value = 1 - series * tl_exp2(-1.44269504f * size * size);
    return x < 0 ? -value : value;
}

TL_INLINE struct tl_slope_quadrature tl_slope_quadrature_of(float weft, float warp, float x, float y, float z)
{
    float flat = sqrtf(x * x + y * y), scale = 1 / tl_maxf(flat, 1e-4f);
    bool is_aside = flat > 1e-4f;
    float to_x = is_aside ? x * scale : 1, to_y = is_aside ? y * scale : 0;
    float deviation = sqrtf(to_x * to_x * weft * weft + to_y * to_y * warp * warp);
    float lowest = (1 - flat) / tl_maxf(z, 1e-6f); /* tan((90 degrees - b) / 2) */
    float from = tl_maxf(-TL_SLOPE_RANGE, -lowest / deviation);
    const float root_half = 0.707106781f;
    float below = tl_slope_erf(TL_SLOPE_RANGE * root_half) - tl_slope_erf(from * root_half);
    return (struct tl_slope_quadrature){to_x * weft * weft / deviation,
                                        to_y * warp * warp / deviation,
                                        -to_y * weft * warp / deviation,
                                        to_x * weft * warp / deviation,
                                        (TL_SLOPE_RANGE + from) / 2,
                                        (TL_SLOPE_RANGE - from) / 2,
                                        below / 2};
}

static const float tl_slope_points[TL_SLOPE_POINTS] = {-0.9061798f, -0.5384693f, 0, 0.5384693f, 0.9061798f};
static const float tl_slope_weights[TL_SLOPE_POINTS] = {0.2369269f, 0.4786287f, 0.5688889f, 0.4786287f,
                                                        0.2369269f};

/* The weight of a point at `at` standard deviations, to be divided by their sum. */
TL_INLINE float tl_slope_weight(int point, float at)
{
    return tl_slope_weights[point] * tl_exp2(-0.72134752f * at * at);
}

/* The part of a lobe above the horizon, for the cosine of its axis with the normal. */
TL_INLINE float tl_slope_above(float cosine, float exponent)
{
    return 0.5f * (1 + tl_slope_erf(cosine * sqrtf((exponent + 1) / 2)));
}

#endif
