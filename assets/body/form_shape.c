#include "assets/body/form.h"

#include "assets/body/solid.h"
#include "config/base/memory.h"

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

/* Pairs of soft swellings: depth * exp(-(x -+ offset)^2 / 2 sx^2 - (y - level)^2 / 2 sy^2). */
struct swelling {
    double level, offset, depth, spread_x, spread_y, spread_up;
    double facing; /* +1 front, -1 back */
};
static const struct swelling swellings[] = {
    {1.205, 0.076, 0.040, 0.050, 0.044, 0.064, 1},
    {0.855, 0.070, 0.012, 0.055, 0.055, 0.060, -1},
};

#define STUB_CUT 0.180 /* the shoulders end in flat caps at x = -+STUB_CUT */

/* A column of a table whose first column is the height. */
struct column {
    const double *rows;
    size_t width, count, number;
};

static double entry(const struct column *column, size_t row, size_t number)
{
    return column->rows[row * column->width + number];
}

/* Derivative at knot i: Catmull-Rom on uneven knots; the ends are straight. */
static double knot_slope(const struct column *column, size_t i)
{
    if (i == 0 || i == column->count - 1)
        return 0;
    return (entry(column, i + 1, column->number) - entry(column, i - 1, column->number)) /
           (entry(column, i + 1, 0) - entry(column, i - 1, 0));
}

/* The cubic Hermite spline of a column, C1. */
static double column_value(const struct column *column, double height)
{
    const size_t last = column->count - 1;
    if (height <= entry(column, 0, 0))
        return entry(column, 0, column->number);
    if (height >= entry(column, last, 0))
        return entry(column, last, column->number);
    size_t i = 0;
    while (height > entry(column, i + 1, 0))
        i++;
    double h = entry(column, i + 1, 0) - entry(column, i, 0), t = (height - entry(column, i, 0)) / h;
    double before = knot_slope(column, i) * h, after = knot_slope(column, i + 1) * h;
    double t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * entry(column, i, column->number) + (t3 - 2 * t2 + t) * before +
           (3 * t2 - 2 * t3) * entry(column, i + 1, column->number) + (t3 - t2) * after;
}

static double trunk_value(double height, size_t number)
{
    return column_value(&(struct column){&trunk[0].y, 4, TRUNK_COUNT, number}, height);
}

/* Distance along the ray from the section's centre to a superellipse with half-axes a, b. */
static double superellipse(double x, double z, double a, double b, double exponent)
{
    double norm = pow(pow(fabs(x) / a, exponent) + pow(fabs(z) / b, exponent), 1 / exponent);
    return norm > 1e-9 ? hypot(x, z) * (1 - 1 / norm) : -fmin(a, b);
}

static double swelling_depth(const struct swelling *s, double x, double y)
{
    double dx = (fabs(x) - s->offset) / s->spread_x, other = (fabs(x) + s->offset) / s->spread_x;
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

/* The torso without any cut. */
static double torso_distance(double x, double y, double z)
{
    double body = tl_smooth_min(trunk_distance(x, y, z), shoulder_distance(x, y, z), 0.065);
    return tl_smooth_min(body, fmax(neck_distance(x, y, z), 1.36 - y), 0.038);
}

double tl_form_distance(const double point[3])
{
    double y = point[1], body = torso_distance(point[0], y, point[2]);
    body = tl_smooth_max(body, fabs(point[0]) - STUB_CUT, 0.008);
    body = tl_smooth_max(body, y - TL_FORM_NECK_TOP, 0.006);
    return tl_smooth_max(body, TL_FORM_BOTTOM - y, 0.02);
}

/* A limb: the middle and the half-axes of its horizontal sections by height. */
struct limb_section {
    double y, x, z, side, depth;
};
static const struct limb_section leg[] = {
    {0.00, 0.118, -0.014, 0.033, 0.038}, {0.04, 0.118, -0.014, 0.033, 0.040},
    {0.10, 0.116, -0.014, 0.033, 0.036}, {0.20, 0.112, -0.014, 0.041, 0.043},
    {0.33, 0.107, -0.014, 0.053, 0.055}, {0.46, 0.103, 0.002, 0.053, 0.056},
    {0.58, 0.100, 0.006, 0.066, 0.070},  {0.70, 0.096, 0.005, 0.081, 0.086},
    {0.78, 0.093, 0.002, 0.086, 0.092},  {0.90, 0.090, -0.002, 0.080, 0.090},
};
static const struct limb_section arm[] = {
    {0.80, 0.392, 0.030, 0.026, 0.026},  {0.88, 0.366, 0.014, 0.028, 0.026},
    {0.98, 0.330, -0.008, 0.038, 0.034}, {1.06, 0.299, -0.020, 0.042, 0.037},
    {1.16, 0.251, -0.024, 0.046, 0.040}, {1.26, 0.201, -0.021, 0.054, 0.046},
    {1.36, 0.150, -0.016, 0.060, 0.050},
};

static double limb_value(const struct limb_section *limb, size_t count, double height, size_t number)
{
    return column_value(&(struct column){&limb->y, 5, count, number}, height);
}

static double limb_distance(const struct limb_section *limb, size_t count, double x, double y, double z)
{
    double side = limb_value(limb, count, y, 3), depth = limb_value(limb, count, y, 4);
    return superellipse(x - limb_value(limb, count, y, 1), z - limb_value(limb, count, y, 2), side, depth, 2);
}

/* The front of a foot, as a flattened ball. */
static double foot_distance(double x, double y, double z)
{
    const double scale[3] = {0.040, 0.036, 0.086};
    double u = (x - 0.121) / scale[0], v = (y - 0.026) / scale[1], w = (z - 0.055) / scale[2];
    return (sqrt(u * u + v * v + w * w) - 1) * scale[1];
}

static double head_distance(double x, double y, double z)
{
    const double scale[3] = {0.070, 0.105, 0.088};
    double u = x / scale[0], v = (y - 1.575) / scale[1], w = (z - 0.022) / scale[2];
    return (sqrt(u * u + v * v + w * w) - 1) * scale[0];
}

double tl_figure_distance(const double point[3])
{
    const double shoulder_end = 0.150, crotch = 0.765, leg_end = 0.87, hand_end = 0.805, arm_end = 1.372;
    double x = fabs(point[0]), y = point[1], z = point[2];
    double below = fmax(1.27 - y, 0), side = shoulder_end + 4 * below * below; /* the chest is uncut */
    double trunk_part = tl_smooth_max(torso_distance(x, y, z), x - side, 0.05);
    double leg_part = tl_smooth_max(limb_distance(leg, TL_COUNT(leg), x, y, z), y - leg_end, 0.06);
    double arm_part = limb_distance(arm, TL_COUNT(arm), x, y, z);
    arm_part = tl_smooth_max(tl_smooth_max(arm_part, hand_end - y, 0.04), y - arm_end, 0.05);
    leg_part = tl_smooth_min(leg_part, foot_distance(x, y, z), 0.03);
    double body = tl_smooth_max(trunk_part, crotch - y, 0.15);
    body = tl_smooth_min(tl_smooth_min(body, leg_part, 0.02), arm_part, 0.03);
    body = tl_smooth_max(body, y - 1.53, 0.02);
    body = tl_smooth_min(body, head_distance(x, y, z), 0.03);
    return tl_smooth_max(body, -y, 0.004);
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
