/* Where the lobes of a fit lie that stand for facets with Gaussian slopes (lobe_fit.h), and the quadrature
 * for their albedo: scalar arithmetic without branches, which render/shade evaluates for many pixels at a
 * time. Directions are in the frame (tangent, bitangent, normal). Pure; threads: any. */
#ifndef TOILE_RENDER_BRDF_SLOPE_FAN_H
#define TOILE_RENDER_BRDF_SLOPE_FAN_H

#include "config/simd.h"

#include <math.h>
#include <stdbool.h>

/* Standard deviation of two neighbouring lobes, as a fraction of their distance, at which their sum has no
 * dip between them. At 0.35 the L1 error of the mixture is smallest over the models and viewers of
 * test_lobe_fit.c. */
#define TL_FAN_OVERLAP 0.35f
/* Towards a grazing viewer lobes become ever narrower across the plane of incidence, and the horizon cuts
 * them along it. Their widths are computed for this cosine at least. */
#define TL_FAN_MIN_COSINE (1 / 3.0f)

/* Distance of neighbouring lobes in standard deviations of the spread. Three, five and seven lobes extend to
 * 1.7, 2.1 and 2.3. */
TL_INLINE float tl_fan_step(int count)
{
    return count <= 3 ? 1.7320508f : count <= 5 ? 1.05f : 0.76f;
}

/* The larger and the smaller eigenvalue of J S J^T, and the slope of one standard deviation along the axis of
 * the larger one. */
struct tl_slope_axes {
    float broad, narrow, slope_x, slope_y;
};

/* `weft`, `warp`: standard deviations of the slopes along x and y; (x, y, z): the viewer.
 *
 * The eigenvalues of J S J^T are those of S^(1/2) J^T J S^(1/2), where J^T J = 4 (v_t v_t^T + c^2 I) with the
 * tangential part v_t and the cosine c of the view direction: a facet turns light by twice its own angle in
 * the plane of incidence, and by 2 c times that angle across it. The eigenvector of the larger eigenvalue,
 * times S^(1/2), is the slope of one standard deviation along the broad axis. */
TL_INLINE struct tl_slope_axes tl_slope_axes_of(float weft, float warp, float x, float y, float z)
{
    float c = tl_maxf(z, TL_FAN_MIN_COSINE);
    float a = 4 * weft * weft * (x * x + c * c), b = 4 * weft * warp * x * y;
    float d = 4 * warp * warp * (y * y + c * c);
    float mean = (a + d) / 2, half = (a - d) / 2, off = sqrtf(half * half + b * b);
    float twice = half / tl_maxf(off, 1e-20f); /* cosine of twice the angle of the broad axis */
    float cosine = sqrtf(tl_maxf((1 + twice) / 2, 0)), sine = sqrtf(tl_maxf((1 - twice) / 2, 0));
    return (struct tl_slope_axes){mean + off, tl_maxf(mean - off, 0), weft * cosine,
                                  warp * (b < 0 ? -sine : sine)};
}

/* The lobes towards one viewer: `count` of them, an odd number, so that one lies at the peak. Lobe k stands
 * for the slope (k - count / 2) * (slope_x, slope_y), which lies `step` times as many standard deviations of
 * the spread from the peak; the factor that makes room for the lobes' own width is applied to the slope. */
struct tl_slope_fan {
    int count;
    float variance; /* of each lobe */
    float step, slope_x, slope_y;
};

/* There are as many lobes as it takes for neighbours to overlap, or else they are widened. */
TL_INLINE struct tl_slope_fan tl_slope_fan_of(float weft, float warp, float x, float y, float z,
                                              int max_count)
{
    const struct tl_slope_axes axes = tl_slope_axes_of(weft, warp, x, y, z);
    float broad = axes.broad, narrow = axes.narrow;
    float apart = TL_FAN_OVERLAP * TL_FAN_OVERLAP * tl_maxf(broad - narrow, 0);
    bool three = (max_count >= 3) & (broad > 1.5f * narrow);
    bool five = three & (max_count >= 5) & (apart * tl_fan_step(3) * tl_fan_step(3) > narrow);
    bool seven = five & (max_count >= 7) & (apart * tl_fan_step(5) * tl_fan_step(5) > narrow);
    int count = 1 + 2 * (int)three + 2 * (int)five + 2 * (int)seven;
    float step = tl_fan_step(count), square = TL_FAN_OVERLAP * step * (TL_FAN_OVERLAP * step);
    float shared = tl_maxf(narrow, square / (1 + square) * broad);
    float variance = three ? shared : sqrtf(broad * narrow);
    float extent = step * sqrtf(tl_maxf(1 - variance / tl_maxf(broad, 1e-20f), 0));
    return (struct tl_slope_fan){count, variance, step, extent * axes.slope_x, extent * axes.slope_y};
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

/* erf within 1.5e-7 [Abramowitz and Stegun 7.1.26]. */
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
