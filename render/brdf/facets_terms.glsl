// Facets whose slopes are Gaussian, and the lobes of a fit that stand for them (lobe_fit.h): their places, the
// quadrature for their albedo, and Ward's facets. Written once for GLSL and C (facets.h); scalar arithmetic without
// branches, which C evaluates for many lanes at a time. Directions are in the frame (tangent, bitangent, normal).
#ifdef GL_core_profile
#include "vectors.glsl"
#endif
#ifndef TERM
#define TERM
#endif
#ifndef TERM_TABLE
#define TERM_TABLE const
#endif

// ---- Fresnel ----

// Schlick's factor of what is missing from F0 to its greatest value [Schlick 1994, eq. 15].
TERM float schlick_share(float cosine)
{
    float away = 1.0f - max(min(cosine, 1.0f), 0.0f);
    return away * away * away * away * away;
}

// A channel of the reflectance. The greatest value is one, but for an F0 below 2 %, which no dielectric has and which
// therefore means "matt": there it goes to zero in proportion.
TERM float schlick_reflectance(float f0, float share)
{
    return f0 + (min(50.0f * f0, 1.0f) - f0) * share;
}

TERM vec3 schlick_colour(vec3 f0, float cosine)
{
    float share = schlick_share(cosine);
    return vec3(schlick_reflectance(f0.x, share), schlick_reflectance(f0.y, share), schlick_reflectance(f0.z, share));
}

// Fresnel's equations for unpolarised light at one interface [Born and Wolf 1999, 1.5.2]; `cosine` from 0 to 1. An index
// below 1 reflects totally beyond the critical angle.
#define COAT_INDEX 1.5f
TERM float fresnel_dielectric(float index, float cosine)
{
    float inside_squared = index * index - (1.0f - cosine * cosine);
    float g = sqrt(max(inside_squared, 0.0f)); // index times the refracted ray's cosine
    float s = (cosine - g) / (cosine + g), p = (index * index * cosine - g) / (index * index * cosine + g);
    return inside_squared > 0.0f && cosine > 0.0f ? clamp((s * s + p * p) / 2.0f, 0.0f, 1.0f) : 1.0f;
}

// The same of a metal, of complex index n + ik: (p + iq)^2 = (n + ik)^2 - sin^2 in its real form [Born and Wolf 1999, 14.4].
TERM float fresnel_conductor(float n, float k, float cosine)
{
    float c = cosine, s2 = 1.0f - c * c, real = n * n - k * k - s2, cross2 = 4.0f * n * n * k * k;
    float size = sqrt(real * real + cross2);
    // Whichever of two forms does not cancel.
    float p = sqrt(max(real < 0.0f ? 0.5f * cross2 / max(size - real, 1e-30f) : 0.5f * (size + real), 0.0f));
    float across = (size - 2.0f * p * c + c * c) / max(size + 2.0f * p * c + c * c, 1e-12f);
    float along = (c * c * size - 2.0f * p * c * s2 + s2 * s2) / max(c * c * size + 2.0f * p * c * s2 + s2 * s2, 1e-12f);
    float reflected = clamp(0.5f * across * (1.0f + along), 0.0f, 1.0f);
    return k == 0.0f ? fresnel_dielectric(n, c) : c > 0.0f ? reflected : 1.0f;
}

// The factor of Fresnel's equations on F0; 1: Schlick's term has no such. Enum tl_fresnel.
#define FRESNEL_SCHLICK 0
#define FRESNEL_DIELECTRIC 1
#define FRESNEL_CONDUCTOR 2
TERM float fresnel_by_index(int kind, float index, float extinction, float cosine)
{
    if (kind == FRESNEL_SCHLICK)
        return 1.0f;
    return kind == FRESNEL_DIELECTRIC ? fresnel_dielectric(index, cosine) : fresnel_conductor(index, extinction, cosine);
}

// Reflectance by Schlick's term: `plain`, and `away` times schlick_share.
struct FacetReflected {
    vec3 plain, away;
};

TERM FacetReflected facet_reflected(vec3 f0)
{
    FacetReflected r;
    r.plain = f0;
    r.away = vec3_subtract(schlick_colour(f0, 0.0f), f0);
    return r;
}

// Light that has been inside threads: their colour, `ratio` times the diffuse one, times what their surface lets in.
TERM FacetReflected thread_reflected(vec3 f0, vec3 diffuse, vec3 ratio)
{
    FacetReflected f = facet_reflected(f0), r;
    vec3 colour = vec3_multiply(diffuse, ratio);
    colour = vec3(clamp(colour.x, 0.0f, 1.0f), clamp(colour.y, 0.0f, 1.0f), clamp(colour.z, 0.0f, 1.0f));
    r.plain = vec3_multiply(colour, vec3_subtract(vec3(1.0f, 1.0f, 1.0f), f.plain));
    r.away = vec3_subtract(vec3(0.0f, 0.0f, 0.0f), vec3_multiply(colour, f.away));
    return r;
}

// The share of light that a clear coat takes from what is below it, by the cosine of viewer and smooth normal.
TERM float coat_share(float coat, float cosine)
{
    return coat > 0.0f ? coat * fresnel_dielectric(COAT_INDEX, max(min(cosine, 1.0f), 0.0f)) : 0.0f;
}

// ---- Widths ----

// The squared width of facets by that without maps and bumps, and what these add to it.
TERM float facet_square(float square, float widening)
{
    return min(max(square + widening, 1e-6f), 1.0f);
}

// The largest product of widths along x and y with which squared widths along both axes stay within those of
// facet_square.
TERM float facet_product(float weft, float warp, float product)
{
    float limit = min((weft - 1e-6f) * (warp - 1e-6f), (1.0f - weft) * (1.0f - warp));
    limit = sqrt(max(limit, 0.0f));
    return min(max(product, -limit), limit);
}

// The sum that maps and bumps add to squared widths along the threads, and to their product, by what they add along u and
// v and to that product (detail_terms.glsl). `cosine`, `sine`: of the rotation of the threads; the sign of `handedness`
// counts.
struct FacetWidening {
    float weft, warp, product;
};

TERM FacetWidening facet_widening(float cosine, float sine, float handedness, float along_u, float along_v, float both)
{
    float cc = cosine * cosine, ss = sine * sine, cs = cosine * sine * (handedness < 0.0f ? -1.0f : 1.0f);
    FacetWidening widening;
    widening.weft = cc * along_u + ss * along_v + 2.0f * cs * both;
    widening.warp = ss * along_u + cc * along_v - 2.0f * cs * both;
    widening.product = cs * (along_v - along_u) + (cc - ss) * both;
    return widening;
}

// The direction of threads: a unit tangent at right angles to the unit normal, turned counter-clockwise as seen along
// it. Any tangent where the given one is zero.
TERM vec3 thread_direction(vec3 n, vec3 tangent, float cosine, float sine)
{
    vec3 t = vec3_subtract(tangent, vec3_scale(n, dot(n, tangent)));
    bool is_given = dot(t, t) > 1e-12f, is_x = abs(n.x) < 0.6f;
    t = vec3(is_given ? t.x : is_x ? 0.0f : n.z, is_given ? t.y : is_x ? -n.z : 0.0f, // else: an axis x n
             is_given ? t.z : is_x ? n.y : -n.x);
    t = direction_or(t, t);
    return vec3_add(vec3_scale(t, cosine), vec3_scale(cross(n, t), sine));
}

// The principal axes of facets whose slopes are correlated: squared widths along them, and the angle from x to the
// first of them, at most 45 degrees.
struct FacetAxes {
    float square_x, square_y, cosine, sine;
};

// The axes of the symmetric matrix with `weft` and `warp` on its diagonal and `product` off it, which facet_product
// limits: the angle by Jacobi's rotation. A product that is rounding turns nothing: round facets have no axes.
TERM FacetAxes facet_axes(float weft, float warp, float product)
{
    float mean = (weft + warp) / 2.0f, half_difference = (weft - warp) / 2.0f;
    float off = sqrt(half_difference * half_difference + product * product);
    float signed_off = half_difference < 0.0f ? -off : off;
    bool is_turned = abs(product) > 1e-6f * mean;
    float safe = max(off, 1e-20f), share = is_turned ? min(abs(half_difference) / safe, 1.0f) : 1.0f;
    FacetAxes axes;
    axes.cosine = sqrt((1.0f + share) / 2.0f);
    axes.sine = is_turned ? product / (2.0f * safe * axes.cosine) : 0.0f;
    axes.sine = half_difference < 0.0f ? -axes.sine : axes.sine;
    axes.square_x = is_turned ? mean + signed_off : weft;
    axes.square_y = is_turned ? mean - signed_off : warp;
    return axes;
}

// ---- Lobes ----

// The cosine to the viewer, at least, for which the spread of light across the plane of incidence is computed.
#define SLOPE_MIN_COSINE 0.2f

// The larger and the smaller eigenvalue of J S J^T, and the slope of one standard deviation along the axis of the larger
// one.
struct SlopeAxes {
    float broad, narrow, slope_x, slope_y;
};

// `weft`, `warp`: standard deviations of the slopes along x and y; (x, y): the viewer; `cosine`: that of a facet to the
// viewer.
//
// The eigenvalues of J S J^T are those of S^(1/2) J^T J S^(1/2), where J^T J = 4 (v_t v_t^T + c^2 I) with the tangential
// part v_t and the cosine c of the view direction: a facet turns light by twice its own angle in the plane of incidence,
// and by 2 c times that angle across it. The eigenvector of the larger eigenvalue, times S^(1/2), is the slope of one
// standard deviation along the broad axis.
TERM SlopeAxes slope_axes(float weft, float warp, float x, float y, float cosine)
{
    float square = cosine * cosine;
    float a = 4.0f * weft * weft * (x * x + square), b = 4.0f * weft * warp * x * y;
    float d = 4.0f * warp * warp * (y * y + square);
    float mean = (a + d) / 2.0f, half_difference = (a - d) / 2.0f;
    float off = sqrt(half_difference * half_difference + b * b);
    float twice = half_difference / max(off, 1e-20f); // cosine of twice the angle of the broad axis
    float along = sqrt(max((1.0f + twice) / 2.0f, 0.0f)), other = sqrt(max((1.0f - twice) / 2.0f, 0.0f));
    SlopeAxes axes;
    axes.broad = mean + off;
    axes.narrow = max(mean - off, 0.0f);
    axes.slope_x = weft * along;
    axes.slope_y = warp * (b < 0.0f ? -other : other);
    return axes;
}

// The lobes towards one viewer. Lobe k stands for the slopes about `first + k step_by` standard deviations along the
// axis along which light spreads most; slopes that send light below the horizon are left out.
struct LobeSet {
    float count; // a whole number
    float first, step_by;
    float slope_x, slope_y;   // one standard deviation along the axis, towards the viewer
    float across_x, across_y; // ... and across it, as light spreads
    float overlap;            // standard deviation of a lobe over the distance of two neighbours, at least
    float narrowest;          // variance of a lobe, at least
};

// The part of the spread that lobes stand for, in standard deviations, and how far they overlap, where there are as many
// as it takes; else a gap between them costs more than what they leave out. These and the figure for up to four lobes
// had the least L1 error of some twenty sets, over satin's facets and threads and a round gloss, from in front to 1.45
// rad; the next best sets are within a tenth of it.
#define LOBE_SET_REACH         2.5f
#define LOBE_SET_OVERLAP       0.42f
#define LOBE_SET_REACH_FEW     2.0f
#define LOBE_SET_OVERLAP_FEW   0.31f
#define LOBE_SET_REACH_OF_FOUR 2.1f

// The mean of the slopes that the viewer sees, in standard deviations towards the viewer, where those below `cut`, at
// most 0, are turned away: phi / Phi of a normal distribution within .13, which only a cosine depends on: 0.6 times the
// mean fits as well.
TERM float slope_mean_seen(float cut)
{
    float fall = exp2(-0.72134752f * cut * cut);
    return 0.4f * fall / (1.0f - 0.5f * fall);
}

// `minimum`, `maximum`: of lobes. As many as it takes for neighbours to overlap, or else `maximum`, which are wider.
TERM LobeSet lobe_set(float weft, float warp, float x, float y, float z, float minimum, float maximum)
{
    float level = sqrt(x * x + y * y), scale = 1.0f / max(level, 1e-4f);
    float seen_x = x * scale * weft, seen_y = y * scale * warp;
    float deviation = max(sqrt(seen_x * seen_x + seen_y * seen_y), 1e-6f);
    float mean = slope_mean_seen(-(1.0f - level) / max(z, 1e-6f) / deviation);
    float mean_x = mean * seen_x * weft / deviation, mean_y = mean * seen_y * warp / deviation;
    float facing = (z + x * mean_x + y * mean_y) / sqrt(1.0f + mean_x * mean_x + mean_y * mean_y);
    SlopeAxes axes = slope_axes(weft, warp, x, y, max(facing, 0.02f));

    float towards = x * axes.slope_x + y * axes.slope_y, side = towards < 0.0f ? -1.0f : 1.0f;
    float slope_x = side * axes.slope_x, slope_y = side * axes.slope_y;
    float square = slope_x * slope_x + slope_y * slope_y;
    towards *= side;
    // A slope of t deviations sends light upwards where square z t^2 - 2 towards t - z < 0.
    float root = sqrt(towards * towards + square * z * z);
    float lowest = -z / max(towards + root, 1e-12f);
    float highest = (towards + root) / max(square * z, 1e-9f);

    float thin = 2.0f * SLOPE_MIN_COSINE * min(weft, warp), narrow = max(axes.narrow, thin * thin);
    float span = min(highest, LOBE_SET_REACH) - max(lowest, -LOBE_SET_REACH);
    float widening = sqrt(max(axes.broad - narrow, 0.0f) / narrow);
    float wanted = min(LOBE_SET_OVERLAP * widening * span, maximum + 1.0f);
    wanted = float(int(wanted + 0.9999f));
    float is_broad = axes.broad > 1.5f * narrow ? 1.0f : 0.0f;
    wanted = 1.0f + is_broad * (max(wanted, 3.0f) - 1.0f);
    float few = wanted > maximum ? 1.0f : 0.0f;
    float reach = LOBE_SET_REACH + few * (LOBE_SET_REACH_FEW - LOBE_SET_REACH);
    LobeSet set;
    set.count = min(max(wanted, minimum), maximum);
    reach = set.count <= 4.0f ? LOBE_SET_REACH_OF_FOUR : reach;
    float from = max(lowest, -reach);
    set.step_by = (min(highest, reach) - from) / set.count;
    set.first = min(set.count - 1.0f, 1.0f) * (from + set.step_by / 2.0f);
    set.slope_x = slope_x;
    set.slope_y = slope_y;
    set.across_x = -slope_y * weft / warp;
    set.across_y = slope_x * warp / weft;
    set.overlap = LOBE_SET_OVERLAP + few * (LOBE_SET_OVERLAP_FEW - LOBE_SET_OVERLAP);
    set.narrowest = thin * thin;
    return set;
}

// A lobe of a set.
struct SlopeLobe {
    float slope_x, slope_y; // in whose mirror direction it lies
    float share;            // of all lobes, not normalised: the density of the slopes
    float variance;
};

// The square of the change of the mirror direction 2 (n v) n / n^2 - v, n = (x, y, 1), by a change of the slope. `p`:
// n v; `square`: n^2.
TERM float slope_turned(float dp, float dn_n, float dn_dn, float p, float square)
{
    float along = 2.0f * (dp - 2.0f * p * dn_n / square) / square, own = 2.0f * p / square;
    return along * along * square + 2.0f * along * own * dn_n + own * own * dn_dn;
}

// Lobe `k` towards the viewer (x, y, z). Its own width adds to that of the set, which is made narrower by as much.
TERM SlopeLobe slope_lobe(LobeSet set, float k, float x, float y, float z)
{
    float at = set.first + k * set.step_by, slope_x = at * set.slope_x, slope_y = at * set.slope_y;
    float p = z + x * slope_x + y * slope_y, square = 1.0f + slope_x * slope_x + slope_y * slope_y;
    float broad = slope_turned(x * set.slope_x + y * set.slope_y, slope_x * set.slope_x + slope_y * set.slope_y,
                               set.slope_x * set.slope_x + set.slope_y * set.slope_y, p, square);
    float narrow = slope_turned(x * set.across_x + y * set.across_y, slope_x * set.across_x + slope_y * set.across_y,
                                set.across_x * set.across_x + set.across_y * set.across_y, p, square);
    float between = set.overlap * set.step_by;
    float alone = sqrt(max(broad * narrow, 0.0f)), variance = max(narrow, between * between * broad);
    variance = max(set.count > 1.0f ? variance : alone, set.narrowest);
    float shrink = sqrt(max(1.0f - variance / max(broad, 1e-20f), 0.0f));
    SlopeLobe lobe;
    lobe.slope_x = shrink * slope_x;
    lobe.slope_y = shrink * slope_y;
    lobe.share = exp2(-0.72134752f * at * at);
    lobe.variance = variance;
    return lobe;
}

TERM float slope_exponent(float variance)
{
    return max(1.0f / max(variance, 1e-7f) - 1.0f, 1.0f);
}

// ---- Albedo ----

// Nodes of the mean over all slopes: along the direction to the viewer, and two across it. Slopes that turn away from
// the viewer by more than half of the angle left to a right angle reflect light from below the horizon. That cuts the
// integrand off sharply, so the quadrature starts at the cut. Across it the integrand is smooth, and two Gauss-Hermite
// nodes suffice.
struct SlopeQuadrature {
    float along_x, along_y, across_x, across_y; // slopes of one standard deviation
    float middle, half_width;                   // of the interval along, in standard deviations
    float share;                                // of all slopes that it holds
};

// Integration range in standard deviations; the rest of a normal distribution is less than 0.3 %.
#define SLOPE_RANGE 3.0f
#define SLOPE_POINTS 5 // of Gauss and Legendre on [-1, 1]
TERM_TABLE float slope_points[SLOPE_POINTS] = {-0.9061798f, -0.5384693f, 0.0f, 0.5384693f, 0.9061798f};
TERM_TABLE float slope_weights[SLOPE_POINTS] = {0.2369269f, 0.4786287f, 0.5688889f, 0.4786287f, 0.2369269f};

// erf within 1.5e-7 [Abramowitz and Stegun 1964, 7.1.26].
TERM float slope_erf(float x)
{
    float size = abs(x), t = 1.0f / (1.0f + 0.3275911f * size);
    float series =
        t * (0.254829592f + t * (-0.284496736f + t * (1.421413741f + t * (-1.453152027f + t * 1.061405429f))));
    float value = 1.0f - series * exp2(-1.44269504f * size * size);
    return x < 0.0f ? -value : value;
}

TERM SlopeQuadrature slope_quadrature(float weft, float warp, float x, float y, float z)
{
    float level = sqrt(x * x + y * y), scale = 1.0f / max(level, 1e-4f);
    bool is_aside = level > 1e-4f;
    float to_x = is_aside ? x * scale : 1.0f, to_y = is_aside ? y * scale : 0.0f;
    float deviation = sqrt(to_x * to_x * weft * weft + to_y * to_y * warp * warp);
    float lowest = (1.0f - level) / max(z, 1e-6f); // tan((90 degrees - b) / 2)
    float from = max(-SLOPE_RANGE, -lowest / deviation);
    float below = slope_erf(SLOPE_RANGE * 0.707106781f) - slope_erf(from * 0.707106781f);
    SlopeQuadrature nodes;
    nodes.along_x = to_x * weft * weft / deviation;
    nodes.along_y = to_y * warp * warp / deviation;
    nodes.across_x = -to_y * weft * warp / deviation;
    nodes.across_y = to_x * weft * warp / deviation;
    nodes.middle = (SLOPE_RANGE + from) / 2.0f;
    nodes.half_width = (SLOPE_RANGE - from) / 2.0f;
    nodes.share = below / 2.0f;
    return nodes;
}

// The weight of a point at `at` standard deviations, to be divided by their sum.
TERM float slope_weight(int point, float at)
{
    return slope_weights[point] * exp2(-0.72134752f * at * at);
}

// The part of a lobe above the horizon, for the cosine of its axis with the normal.
TERM float slope_above(float cosine, float exponent)
{
    return 0.5f * (1.0f + slope_erf(cosine * sqrt((exponent + 1.0f) / 2.0f)));
}

// ---- Microfacets of Torrance and Sparrow (brdf.h) ----

// enum tl_facets and tl_masking (assets/base/material.h)
#define FACETS_BECKMANN 1
#define FACETS_GGX 2
#define MASKING_V_GROOVES 1
#define MASKING_SCHLICK 2

// With full precision; a driver's own function has only four digits near 0.
TERM float arc_tangent(float x)
{
    float y = x * x;
    return x > 0.25f ? atan(x) : x * (1.0f - y * (1.0f / 3.0f - y * (0.2f - y * (1.0f / 7.0f - y / 9.0f))));
}

// P(w^2) is the integral of 2 d exp(-(d/w)^2) cos d sin d / (d w^2) over d in [0, pi/2]. It is 1 for narrow facets. This
// polynomial interpolates it at five Chebyshev nodes of w^2 in [0, 1], with an error below 1e-4.
TERM float gaussian_volume(float w2)
{
    return 0.99992717f + w2 * (-0.66309756f + w2 * (0.24115347f + w2 * (-0.02326816f - w2 * 0.00701674f)));
}

// D(d), from tan^2 d.
TERM float facet_density(int facets, float width, float tangent_squared)
{
    float w2 = width * width, rise = 1.0f + tangent_squared; // 1 / cos^2
    if (facets == FACETS_BECKMANN) {
        float fall = exp(-tangent_squared / w2);
        return fall > 0.0f ? fall * rise * rise / (4.0f * w2) : 0.0f;
    }
    float quotient = rise / (w2 + tangent_squared);
    if (facets == FACETS_GGX)
        return quotient * quotient * w2 / 4.0f;
    float d = arc_tangent(sqrt(tangent_squared));
    return exp(-d * d / w2) / (4.0f * w2 * gaussian_volume(w2));
}

// Smith's lambda, the ratio of hidden to visible facets: for slopes of Beckmann (exp(-k^2) / (k sqrt pi) - erfc k) / 2.
TERM float facet_lambda(int facets, float width, float cosine)
{
    float sine_squared = max(1.0f - cosine * cosine, 0.0f);
    if (facets == FACETS_GGX)
        return (sqrt(1.0f + width * width * sine_squared / max(cosine * cosine, 1e-12f)) - 1.0f) / 2.0f;
    float k = min(cosine / (width * max(sqrt(sine_squared), 1e-6f)), 1e6f), t = 1.0f / (1.0f + 0.3275911f * k);
    float scaled = // erfc k / exp(-k^2) as slope_erf
        t * (0.254829592f + t * (-0.284496736f + t * (1.421413741f + t * (-1.453152027f + t * 1.061405429f))));
    return max(exp(-k * k) * (0.56418958f / max(k, 1e-20f) - scaled) / 2.0f, 0.0f);
}

// G, from the cosines a of the light, b of the viewer, t of facet and light, d of facet and normal.
TERM float facet_masking(int facets, int masking, float width, float cos_a, float cos_b, float cos_t, float cos_d)
{
    if (masking == MASKING_V_GROOVES)
        return min(1.0f, 2.0f * cos_d * min(cos_a, cos_b) / cos_t);
    float k = 0.79788456f * width;
    if (masking == MASKING_SCHLICK)
        return cos_a * cos_b / ((cos_a + k * (1.0f - cos_a)) * (cos_b + k * (1.0f - cos_b)));
    return 1.0f / (1.0f + facet_lambda(facets, width, cos_a) + facet_lambda(facets, width, cos_b));
}

// c(s) of BANKS by Gamma(z + 1/2) / Gamma(z), z = s/2 + 3/2, from the first terms of its asymptotic series. The relative
// error is below 5e-4 for s >= 1.
TERM float thread_scale(float s)
{
    float z = s / 2.0f + 1.5f;
    return sqrt(z - 0.25f + 1.0f / (32.0f * z)) * 0.28209479f;
}

// ---- Ward's facets ----

// The contribution of a slope to the gloss: see value_of_slope of lobe_fit.c. With q the squared cosine of the facet,
// t its cosine to the viewer, p = t sqrt(1 / q) and a = 2 p q - b it is p q^2 sqrt(a / b) by Ward, and a / (p q) in the
// bounded form. What the fit evaluates as a gloss divided by a pdf has this closed form. Without Fresnel's term.
struct WardSlope {
    float value;
    float cosine;  // t, at least 0
    float towards; // p q
};

TERM WardSlope ward_slope(bool is_bounded, float x, float y, float z, float slope_x, float slope_y)
{
    float p = z + x * slope_x + y * slope_y, q = 1.0f / (1.0f + slope_x * slope_x + slope_y * slope_y);
    float a = 2.0f * p * q - z;
    float published = p * q * q * sqrt(max(a, 0.0f) / z), bounded = a / (p * q);
    float value = is_bounded ? bounded : published;
    WardSlope slope;
    slope.value = p > 0.0f && a > 0.0f ? value : 0.0f;
    slope.cosine = max(p * sqrt(q), 0.0f);
    slope.towards = p * q;
    return slope;
}

// f_r cos a without Fresnel's term, of facets with these squared widths and their product. (slope_x, slope_y): of the
// facet halfway between light and viewer, whose cosines are a and b. `steep`: the squared cosine of facet and viewer
// times the fourth power of that of facet and normal.
TERM float ward_lobe(bool is_bounded, float slope_x, float slope_y, float steep, float cos_a, float cos_b, float weft,
                     float warp, float product)
{
    float determinant = max(weft * warp - product * product, 1e-16f);
    float published = sqrt(cos_a / cos_b), bounded = cos_a / max(steep, 1e-30f);
    float squares = slope_x * slope_x * warp - 2.0f * slope_x * slope_y * product + slope_y * slope_y * weft;
    float value = exp2(-1.44269504f * squares / determinant) * (is_bounded ? bounded : published) /
                  (4.0f * 3.14159265f * sqrt(determinant));
    return cos_a > 0.0f && cos_b > 0.0f ? value : 0.0f;
}

// ... for light from a disc of angular radius `radius`, rad. (x, y, z): the sum of the unit directions to light and viewer;
// `square`: of its length, which is twice the cosine of facet and light.
TERM float ward_under_disc(bool is_bounded, float x, float y, float z, float square, float cos_a, float cos_b, float weft,
                           float warp, float product, float radius)
{
    float wider = radius * radius / 8.0f, over = 1.0f / z;
    return ward_lobe(is_bounded, x * over, y * over, z * z * z * z / (4.0f * square), cos_a, cos_b, weft + wider,
                     warp + wider, product);
}

// ---- The lobes that stand for Ward's facets ----

// The facets towards a viewer, in the axes of their widths, and their Fresnel term by an index.
struct WardFacets {
    bool is_bounded;
    int fresnel;
    float index, extinction;
    float x, y, z;
};

// Contributions of slopes, without F0: `plain`, and `away` times schlick_share. `share`: of all slopes.
struct WardValues {
    float share, plain, away;
};

TERM WardValues ward_values(WardFacets facets, WardSlope slope)
{
    WardValues values;
    values.share = 1.0f;
    values.plain =
        slope.value * fresnel_by_index(facets.fresnel, facets.index, facets.extinction, min(slope.cosine, 1.0f));
    values.away = values.plain * schlick_share(slope.cosine);
    return values;
}

// The two nodes at a point of the quadrature.
TERM WardValues ward_node(WardFacets f, SlopeQuadrature nodes, int point)
{
    float at = nodes.middle + nodes.half_width * slope_points[point];
    float x = at * nodes.along_x, y = at * nodes.along_y;
    WardValues one = ward_values(f, ward_slope(f.is_bounded, f.x, f.y, f.z, x + nodes.across_x, y + nodes.across_y));
    WardValues other = ward_values(f, ward_slope(f.is_bounded, f.x, f.y, f.z, x - nodes.across_x, y - nodes.across_y));
    WardValues mean;
    mean.share = slope_weight(point, at);
    mean.plain = 0.5f * mean.share * (one.plain + other.plain);
    mean.away = 0.5f * mean.share * (one.away + other.away);
    return mean;
}

struct WardLobe {
    float x, y, z; // direction, unit
    float exponent, above; // the part above the horizon
    float plain, away;     // as WardValues; not normalised
};

// Lobe `k` of the set.
TERM WardLobe ward_lobe_of(WardFacets f, LobeSet set, float k)
{
    SlopeLobe at = slope_lobe(set, k, f.x, f.y, f.z);
    WardSlope slope = ward_slope(f.is_bounded, f.x, f.y, f.z, at.slope_x, at.slope_y);
    WardValues values = ward_values(f, slope);
    float share = k < set.count ? at.share : 0.0f;
    WardLobe lobe;
    lobe.x = 2.0f * slope.towards * at.slope_x - f.x;
    lobe.y = 2.0f * slope.towards * at.slope_y - f.y;
    lobe.z = 2.0f * slope.towards - f.z;
    lobe.exponent = slope_exponent(at.variance);
    lobe.above = slope_above(lobe.z, lobe.exponent);
    lobe.plain = share * values.plain;
    lobe.away = share * values.away;
    return lobe;
}
