#include "assets/builtin/form.h"

#include "config/memory.h"

#include <math.h>

/* The trunk: half-axes of its horizontal section by height. Front and back differ: they share the side's
 * tangent, so the section is C1. */
struct trunk_section {
    double y, side, front, back;
};
static const struct trunk_section trunk[] = {
    {0.62, 0.158, 0.088, 0.094}, {0.70, 0.165, 0.095, 0.105}, {0.78, 0.172, 0.101, 0.117},
    {0.86, 0.174, 0.106, 0.120}, {0.92, 0.163, 0.106, 0.111}, {0.98, 0.142, 0.100, 0.096},
    {1.04, 0.124, 0.091, 0.084}, {1.10, 0.131, 0.093, 0.090}, {1.16, 0.145, 0.096, 0.100},
    {1.22, 0.154, 0.096, 0.107}, {1.28, 0.157, 0.086, 0.105}, {1.34, 0.142, 0.066, 0.096},
    {1.40, 0.100, 0.042, 0.074}, {1.46, 0.050, 0.020, 0.045},
};
enum { TRUNK_COUNT = TL_COUNT(trunk) };

/* Superellipse exponent of the trunk: 2 is an ellipse, more is boxier. */
#define TRUNK_EXPONENT 2.2

/* Pairs of soft swellings: depth * exp(-(x -+ apart)^2 / 2 sx^2 - (y - level)^2 / 2 sy^2). */
struct swelling {
    double level, apart, depth, spread_x, spread_y, spread_up;
    double facing; /* +1 front, -1 back */
};
static const struct swelling swellings[] = {
    {1.205, 0.076, 0.040, 0.050, 0.044, 0.064, 1},
    {0.855, 0.070, 0.012, 0.055, 0.055, 0.060, -1},
};

#define STUB_CUT 0.180 /* the shoulders end in flat caps at x = -+STUB_CUT */

/* Derivative of a trunk column at knot i: Catmull-Rom on uneven knots; the ends are straight. */
static double knot_slope(const double *y, const double *value, int i)
{
    if (i == 0 || i == TRUNK_COUNT - 1)
        return 0;
    return (value[i + 1] - value[i - 1]) / (y[i + 1] - y[i - 1]);
}

/* The cubic Hermite spline of one trunk column, C1. */
static double trunk_value(double height, size_t column)
{
    double y[TRUNK_COUNT], value[TRUNK_COUNT];
    for (int i = 0; i < TRUNK_COUNT; i++) {
        const double *row = &trunk[i].y;
        y[i] = row[0];
        value[i] = row[column];
    }
    if (height <= y[0])
        return value[0];
    if (height >= y[TRUNK_COUNT - 1])
        return value[TRUNK_COUNT - 1];
    int i = 0;
    while (height > y[i + 1])
        i++;
    double h = y[i + 1] - y[i], t = (height - y[i]) / h;
    double before = knot_slope(y, value, i) * h, after = knot_slope(y, value, i + 1) * h;
    double t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * value[i] + (t3 - 2 * t2 + t) * before + (3 * t2 - 2 * t3) * value[i + 1] +
           (t3 - t2) * after;
}

/* Polynomial smooth minimum (Quilez), C1; the blend is k wide. */
static double smooth_min(double a, double b, double k)
{
    double h = fmax(k - fabs(a - b), 0) / k;
    return fmin(a, b) - h * h * k * 0.25;
}

static double smooth_max(double a, double b, double k)
{
    return -smooth_min(-a, -b, k);
}

/* Distance along the ray from the section's centre to a superellipse with half-axes a, b. */
static double superellipse(double x, double z, double a, double b, double exponent)
{
    double norm = pow(pow(fabs(x) / a, exponent) + pow(fabs(z) / b, exponent), 1 / exponent);
    return norm > 1e-9 ? hypot(x, z) * (1 - 1 / norm) : -fmin(a, b);
}

static double swelling_depth(const struct swelling *s, double x, double y)
{
    double dx = (fabs(x) - s->apart) / s->spread_x, other = (fabs(x) + s->apart) / s->spread_x;
    double dy = (y - s->level) / (y > s->level ? s->spread_up : s->spread_y);
    return s->depth * (exp(-0.5 * dx * dx) + exp(-0.5 * other * other)) * exp(-0.5 * dy * dy);
}

static double trunk_distance(double x, double y, double z)
{
    double side = trunk_value(y, 1), depth = trunk_value(y, z > 0 ? 2 : 3);
    for (size_t i = 0; i < TL_COUNT(swellings); i++) {
        if (swellings[i].facing * z > 0)
            depth += swelling_depth(&swellings[i], x, y);
    }
    return superellipse(x, z, side, depth, TRUNK_EXPONENT);
}

/* One bar from shoulder to shoulder, its underside level so that every horizontal section stays star-shaped;
 * its top falls from the neck to the tips. */
static double shoulder_distance(double x, double y, double z)
{
    const double bottom = 1.252, top_middle = 1.420, top_tip = 1.378;
    double t = fmin(fabs(x) / STUB_CUT, 1.2);
    double top = top_middle + (top_tip - top_middle) * t, depth = 0.068 - 0.014 * t;
    return superellipse(y - 0.5 * (top + bottom), z + 0.016, 0.5 * (top - bottom), depth, 2.3);
}

/* The neck, which leans forward a little. */
static double neck_distance(double x, double y, double z)
{
    double lean = -0.012 + 0.22 * (y - 1.40);
    return superellipse(x, z - lean, 0.056, 0.059, 2);
}

double tl_form_distance(const double point[3])
{
    double x = point[0], y = point[1], z = point[2];
    double body = smooth_min(trunk_distance(x, y, z), shoulder_distance(x, y, z), 0.065);
    body = smooth_min(body, fmax(neck_distance(x, y, z), 1.36 - y), 0.038);
    body = smooth_max(body, fabs(x) - STUB_CUT, 0.008);
    body = smooth_max(body, y - TL_FORM_NECK_TOP, 0.006);
    return smooth_max(body, TL_FORM_BOTTOM - y, 0.02);
}

double tl_form_radius(double y, double angle)
{
    double sine = sin(angle), cosine = cos(angle);
    double inside = 0, outside = 0.3; /* the form's radius is below 0.3 m everywhere */
    if (tl_form_distance((double[3]){0, y, 0}) >= 0)
        return 0;
    for (int i = 0; i < 40; i++) {
        double r = 0.5 * (inside + outside);
        if (tl_form_distance((double[3]){-r * sine, y, -r * cosine}) < 0)
            inside = r;
        else
            outside = r;
    }
    return inside;
}

enum { SECTION_SAMPLES = 180 }; /* of half a section, back to front */

double tl_form_girth(double y)
{
    /* Upper hull of the half section (-X side): a monotone chain in z, back to front. */
    double x[SECTION_SAMPLES + 1] = {0}, z[SECTION_SAMPLES + 1] = {0};
    int count = 0;
    for (int i = 0; i <= SECTION_SAMPLES; i++) {
        double angle = M_PI * i / SECTION_SAMPLES, r = tl_form_radius(y, angle);
        double px = r * sin(angle), pz = -r * cos(angle);
        while (count >= 2 && (z[count - 1] - z[count - 2]) * (px - x[count - 2]) -
                                     (x[count - 1] - x[count - 2]) * (pz - z[count - 2]) >=
                                 0)
            count--;
        x[count] = px;
        z[count] = pz;
        count++;
    }
    double length = 0;
    for (int i = 1; i < count; i++)
        length += hypot(x[i] - x[i - 1], z[i] - z[i - 1]);
    return 2 * length;
}
