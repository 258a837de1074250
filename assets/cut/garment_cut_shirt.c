#include "assets/cut/garment_cut_internal.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

/* A shirt, buttoned up: two fronts with a placket between them, a back, set-in sleeves with cuffs, and a
 * collar of a stand and a fall, which lies over it. Drafted from the body's measures as pattern books do (W.
 * Aldrich, "Metric Pattern Cutting", the shirt block): quarters of the bust's girth, shoulders as on the
 * body, sleeve caps as long as their armholes. y is the height on the body up to the underarm and the length
 * of cloth above it; x is 0 in the middle. */
#define BUST_EASE     0.130
#define HIP_EASE      0.100
#define UNDERARM_DROP 0.020 /* the armhole's bottom below the body's armpit */
#define HEM_ABOVE     0.030 /* above the crotch */
#define HEM_BELOW     0.020 /* the waist, at least */
#define SLEEVE_MIN    0.050 /* without its cuff */
#define WAIST_SHAPE   0.010 /* how far the side seam moves in at the waist */
#define SHOULDER_EASE 0.014 /* cloth over the shoulder */
#define NECK_WIDER    0.016 /* the neckline's half width over the neck's */
#define BACK_NECK     0.020 /* depths of the necklines below the shoulder seam's inner end */
#define FRONT_NECK    0.020 /* and the neckline's half width */
#define ARMHOLE_IN    0.018 /* front and back are narrower there than the shoulders */
#define SLEEVE_EASE   0.100 /* around the upper arm */
#define CUFF_EASE     0.060
#define CUFF_HEIGHT   0.055
#define SLEEVE_START  0.030 /* of the underarm, along the arm: where it is clear of the side */
#define PLACKET_HALF  0.016
#define STAND_HEIGHT  0.032
#define FALL_HEIGHT   0.038 /* in the back */
#define FALL_POINT    0.058 /* its front edge */
#define FALL_OPEN     0.12  /* radians: its points lie back from the middle */
#define FALL_LIFT     0.7   /* of the start shape, too: its drop, so that it is clear of the back */
#define FALL_OFF      0.008 /* of the start shape: from the stand */
#define FALL_SLOPE    0.60  /* radians: of the cone that it is cut for, from the vertical */

enum { LEVELS = 48, COLUMNS = 9, PROFILE_STEPS = 48 };
enum { FRONT_HEM, SIDE, ARMHOLE, SHOULDER, NECK, FRONT_MIDDLE, FRONT_CURVES, BACK_CURVES = NECK + 1 };
enum { BOTTOM_FRONT, BOTTOM_BACK, UNDER_BACK, CAP_BACK, CAP_FRONT, UNDER_FRONT, SLEEVE_CURVES };
enum { STRIP_BOTTOM, STRIP_SIDE, STRIP_TOP, STRIP_CURVES }; /* placket and cuffs */
enum { STAND_BACK, STAND_FRONT, STAND_MIDDLE, STAND_END, STAND_TOP, STAND_CURVES };
enum { FALL_SEAM, FALL_END, FALL_EDGE, FALL_CURVES };

/* The way from the underarm's level over the chest, or the back, to the shoulder's ridge, at one distance
 * from the middle: (height, distance from the ridge) by length. */
struct shoulder_profile {
    double length;
    struct tl_point points[PROFILE_STEPS + 1];
};

struct shirt;
struct half_placement {
    const struct shirt *shirt;
    bool back, mirrored;
};

struct shirt {
    const struct tl_body *body;
    double hem_y, underarm_y, ridge_z, half; /* half: a quarter of the bust's girth, with its ease */
    double shoulder_x, neck_x;               /* the shoulder seam's ends */
    double tip_y[2], neck_top_y[2];          /* their y in the pattern, of front and back */
    struct tl_curve front[FRONT_CURVES], back[BACK_CURVES], sleeve[SLEEVE_CURVES];
    double arm_end; /* of the sleeves with their cuffs, along the arm */
    double cap_height, sleeve_length, cuff,
        stand; /* cuff: around; stand: its length from the back to the front */
    struct tl_ring rings[LEVELS];
    struct shoulder_profile profiles[2][COLUMNS];
    struct tl_ring arm[TL_ARM_STEPS];
    struct half_placement places[6];
};

static struct tl_point point_at(double x, double y)
{
    return (struct tl_point){x, y};
}

static double mix(double a, double b, double t)
{
    return a + (b - a) * t;
}

static struct tl_curve cubic(struct tl_point a, struct tl_point b, struct tl_point c, struct tl_point d)
{
    return (struct tl_curve){.control = {a, b, c, d}};
}

/* ---- The body's shoulders ---- */

static double distance_at(const struct tl_body *body, double x, double y, double z)
{
    return body->distance.at(body->distance.context, (double[3]){x, y, z});
}

/* The shoulder's height at a distance from the middle: where the body ends above the underarm's level. */
static double shoulder_height(const struct shirt *s, double x)
{
    const double step = 0.0005;
    double y = s->underarm_y + 0.03;
    while (y < s->body->height && distance_at(s->body, x, y, s->ridge_z) < 0)
        y += step;
    return y;
}

/* The shoulder seam's ends: where the neck's slope becomes the shoulder's, and that the arm's. */
static void find_shoulder(struct shirt *s)
{
    const double step = 0.005, foot = 0.6, slope = 0.75;
    double x = s->body->neck_half + NECK_WIDER, y = shoulder_height(s, x),
           next = shoulder_height(s, x + step);
    for (int i = 0; i < 2 && (y - next) / step > foot; i++) {
        x += step;
        y = next;
        next = shoulder_height(s, x + step);
    }
    s->neck_x = x;
    x += 0.05;
    y = shoulder_height(s, x);
    next = shoulder_height(s, x + 2 * step);
    while (x < 0.4 && (y - next) / (2 * step) < slope) {
        x += step;
        y = shoulder_height(s, x);
        next = shoulder_height(s, x + 2 * step);
    }
    s->shoulder_x = x;
}

/* Casts rays from the ridge at the underarm's level, through a quarter of a turn. */
static void trace_profile(const struct shirt *s, double x, bool back, struct shoulder_profile *out)
{
    enum { RAYS = 96 };
    struct tl_point raw[RAYS + 1];
    double length[RAYS + 1] = {0};
    for (int i = 0; i <= RAYS; i++) {
        double angle = 0.5 * M_PI * i / RAYS, reach = 0.02;
        double up = sin(angle), away = (back ? -1 : 1) * cos(angle);
        while (reach < 0.4 &&
               distance_at(s->body, x, s->underarm_y + reach * up, s->ridge_z + reach * away) < 0.008)
            reach += 0.002;
        raw[i] = point_at(s->underarm_y + reach * up, reach * cos(angle));
        if (i > 0)
            length[i] = length[i - 1] + hypot(raw[i].x - raw[i - 1].x, raw[i].y - raw[i - 1].y);
    }
    out->length = length[RAYS];
    for (int k = 0, i = 0; k <= PROFILE_STEPS; k++) {
        double wanted = out->length * k / PROFILE_STEPS;
        while (i < RAYS - 1 && length[i + 1] < wanted)
            i++;
        double t = (wanted - length[i]) / fmax(length[i + 1] - length[i], 1e-9);
        out->points[k] = point_at(mix(raw[i].x, raw[i + 1].x, t), mix(raw[i].y, raw[i + 1].y, t));
    }
}

static double column_x(const struct shirt *s, int column)
{
    return s->neck_x + (s->shoulder_x - s->neck_x) * column / (COLUMNS - 1);
}

/* The shoulder seam's ends in the pattern of the front or the back: cloth from the underarm up. Both slope as
 * the body does, so that the seam is as long in both. */
static void measure_shoulders(struct shirt *s)
{
    double slope = 0, rise[2];
    for (int side = 0; side < 2; side++) {
        for (int c = 0; c < COLUMNS; c++)
            trace_profile(s, column_x(s, c), side == 1, &s->profiles[side][c]);
        double inner = s->profiles[side][0].length, outer = s->profiles[side][COLUMNS - 1].length;
        slope += 0.5 * (inner - outer);
        rise[side] = s->underarm_y + 0.5 * (inner + outer) + SHOULDER_EASE;
    }
    for (int side = 0; side < 2; side++) {
        s->neck_top_y[side] = rise[side] + 0.5 * slope;
        s->tip_y[side] = rise[side] - 0.5 * slope;
    }
}

/* ---- The pattern ---- */

static void cut_half(const struct shirt *s, bool back, double hem_half, struct tl_curve *curves)
{
    double from = back ? 0 : PLACKET_HALF, waist_y = s->body->waist_y;
    struct tl_point hem = {hem_half, s->hem_y}, underarm = {s->half, s->underarm_y};
    struct tl_point tip = {s->shoulder_x, s->tip_y[back]}, neck = {s->neck_x, s->neck_top_y[back]};
    double depth = back ? BACK_NECK : s->neck_x + FRONT_NECK, chest = s->shoulder_x - ARMHOLE_IN;
    struct tl_point scoop = {from, neck.y - depth};
    double armhole = tip.y - underarm.y, in = fmin(hem.x, underarm.x) - WAIST_SHAPE;
    curves[FRONT_HEM] = tl_curve_line(point_at(from, s->hem_y), hem);
    curves[SIDE] = cubic(hem, point_at(in, mix(hem.y, waist_y, 0.7)),
                         point_at(in, mix(underarm.y, waist_y, 0.6)), underarm);
    curves[ARMHOLE] = cubic(underarm, point_at(mix(underarm.x, chest, 0.75), underarm.y + 0.004),
                            point_at(chest - 0.006, underarm.y + 0.45 * armhole), tip);
    curves[SHOULDER] = tl_curve_line(tip, neck);
    curves[NECK] = cubic(neck, point_at(neck.x - (back ? 0.010 : 0.004), neck.y - 0.6 * depth),
                         point_at(mix(from, neck.x, 0.6), scoop.y), scoop);
    if (!back)
        curves[FRONT_MIDDLE] = tl_curve_line(scoop, point_at(from, s->hem_y));
}

/* Half of a sleeve's cap, from its end at the underarm, `width` from the middle, to its top. */
static struct tl_curve cap_curve(double width, double height)
{
    return cubic(point_at(width, 0), point_at(0.62 * width, 0.06 * height), point_at(0.50 * width, height),
                 point_at(0, height));
}

/* The width at which half of a cap of this height is as long as its armhole. */
static double cap_width(double length, double height)
{
    double low = 0.02, high = length;
    for (int step = 0; step < 50; step++) {
        double middle = 0.5 * (low + high);
        struct tl_curve cap = cap_curve(middle, height);
        if (tl_curve_length(&cap) < length)
            low = middle;
        else
            high = middle;
    }
    return high;
}

/* `girth`: around its widest place. */
static void cut_sleeve(struct shirt *s, double girth)
{
    double front = tl_curve_length(&s->front[ARMHOLE]), back = tl_curve_length(&s->back[ARMHOLE]);
    double low = 0.02, high = 0.95 * fmin(front, back);
    for (int step = 0; step < 50; step++) { /* the higher, the narrower */
        s->cap_height = 0.5 * (low + high);
        if (cap_width(front, s->cap_height) + cap_width(back, s->cap_height) > girth)
            low = s->cap_height;
        else
            high = s->cap_height;
    }
    double to_front = cap_width(front, s->cap_height), to_back = cap_width(back, s->cap_height);
    double middle = 0.5 * (to_back - to_front), bottom = -s->sleeve_length; /* both seams slant alike */
    struct tl_point ends[2] = {{middle - 0.5 * s->cuff, bottom}, {middle + 0.5 * s->cuff, bottom}};
    struct tl_point centre = {middle, bottom};
    struct tl_curve cap_front = cap_curve(to_front, s->cap_height);
    struct tl_curve cap_back = cap_curve(to_back, s->cap_height);
    s->sleeve[BOTTOM_FRONT] = tl_curve_line(ends[0], centre);
    s->sleeve[BOTTOM_BACK] = tl_curve_line(centre, ends[1]);
    s->sleeve[UNDER_BACK] = tl_curve_line(ends[1], point_at(to_back, 0));
    s->sleeve[CAP_BACK] = cap_back;
    s->sleeve[CAP_FRONT] = tl_cut_mirrored_curve(&cap_front);
    s->sleeve[UNDER_FRONT] = tl_curve_line(point_at(-to_front, 0), ends[0]);
}

/* ---- Start positions of the pieces ---- */

static struct tl_point trunk_at(const struct shirt *s, double x, double y, bool back)
{
    double place = fmin(fmax((y - s->hem_y) / (s->underarm_y - s->hem_y), 0), 1) * (LEVELS - 1);
    int i = place < LEVELS - 1 ? (int)place : LEVELS - 2;
    struct tl_point at[2];
    for (int k = 0; k < 2; k++) {
        const struct tl_ring *ring = &s->rings[i + k];
        at[k] = tl_ring_at(ring, back ? 0.5 * ring->length - x : x);
    }
    return point_at(mix(at[0].x, at[1].x, place - i), mix(at[0].y, at[1].y, place - i));
}

/* Front or back on +X, in the middle too: x from 0 to the side. */
static void place_on_trunk(const struct shirt *s, double x, double y, bool back, double position[3])
{
    struct tl_point on = trunk_at(s, x, y, back);
    position[0] = on.x;
    position[1] = fmin(y, s->underarm_y);
    position[2] = on.y;
    if (y <= s->underarm_y)
        return;
    double across = fmin(fmax((x - s->neck_x) / (s->shoulder_x - s->neck_x), 0), 1);
    double top = mix(s->neck_top_y[back], s->tip_y[back], across);
    double up = fmin((y - s->underarm_y) / (top - s->underarm_y), 1), step = up * PROFILE_STEPS;
    double column = across * (COLUMNS - 1);
    int c = column < COLUMNS - 1 ? (int)column : COLUMNS - 2;
    int k = step < PROFILE_STEPS ? (int)step : PROFILE_STEPS - 1;
    struct tl_point at[2], foot[2];
    for (int j = 0; j < 2; j++) {
        const struct tl_point *points = s->profiles[back][c + j].points;
        at[j] = point_at(mix(points[k].x, points[k + 1].x, step - k),
                         mix(points[k].y, points[k + 1].y, step - k));
        foot[j] = points[0];
    }
    double height = mix(at[0].x, at[1].x, column - c), away = mix(at[0].y, at[1].y, column - c);
    double from = mix(foot[0].y, foot[1].y, column - c), base = fabs(on.y - s->ridge_z);
    position[0] = mix(on.x, x, up);
    position[1] = height;
    position[2] = s->ridge_z + (back ? -1 : 1) * (away + (base - from) * (1 - up));
    for (int i = 0;
         i < 60 && x < s->neck_x && distance_at(s->body, position[0], position[1], position[2]) < 0.006;
         i++) /* beside the neck no profile was traced */
        position[2] += back ? -0.001 : 0.001;
}

static void place_half(const void *context, struct tl_point p, double position[3])
{
    const struct half_placement *place = context;
    double x = place->mirrored ? -p.x : p.x; /* a front's or a back's on +x, or of a whole back */
    place_on_trunk(place->shirt, fabs(x), p.y, place->back, position);
    bool left = place->back ? p.x < 0 : p.x > 0; /* on +X: the back is seen from behind */
    position[0] *= left ? 1 : -1;
}

/* On the arm on +X: `around` from its outer side to the back, `down` from the armpit's level. */
static void place_on_arm(const struct shirt *s, double around, double down, double position[3])
{
    const struct tl_body_arm *arm = &s->body->arm;
    double place = fmin(fmax(down / arm->length, 0), 1) * (TL_ARM_STEPS - 1);
    int i = place < TL_ARM_STEPS - 1 ? (int)place : TL_ARM_STEPS - 2;
    double beyond = down < 0 ? down : fmax(down - arm->length, 0);
    double at[2][3];
    for (int k = 0; k < 2; k++) {
        struct tl_point on = tl_ring_at(&s->arm[i + k], -around);
        for (int c = 0; c < 3; c++)
            at[k][c] = (double)arm->middle[i + k].raw[c] + on.x * (double)arm->ahead[i + k].raw[c] +
                       on.y * (double)arm->outer[i + k].raw[c] + beyond * (double)arm->along[i + k].raw[c];
    }
    for (int c = 0; c < 3; c++)
        position[c] = mix(at[0][c], at[1][c], place - i);
}

static void place_sleeve(const void *context, struct tl_point p, double position[3])
{
    const struct half_placement *place = context;
    const struct shirt *s = place->shirt;
    double down = SLEEVE_START - p.y, middle = 0;
    if (p.y < 0) /* the pattern's middle moves over where its seams do not slant alike */
        middle = s->sleeve[BOTTOM_BACK].control[0].x * -p.y / s->sleeve_length;
    place_on_arm(s, (place->mirrored ? -p.x : p.x) - middle, down, position);
    position[0] *= place->mirrored ? -1 : 1;
}

static void place_cuff(const void *context, struct tl_point p, double position[3])
{
    const struct half_placement *place = context;
    double down = place->shirt->arm_end - p.y;
    place_on_arm(place->shirt, place->mirrored ? -p.x : p.x, down, position);
    position[0] *= place->mirrored ? -1 : 1;
}

/* The point of a curve at a distance from its start. */
static struct tl_point along_curve(const struct tl_curve *curve, double distance)
{
    enum { SAMPLES = 128 };
    struct tl_point before = curve->control[0];
    double walked = 0;
    for (int i = 1; i <= SAMPLES; i++) {
        struct tl_point point = tl_curve_at(curve, (double)i / SAMPLES);
        double step = hypot(point.x - before.x, point.y - before.y);
        if (walked + step >= distance) {
            double t = step > 0 ? (distance - walked) / step : 0;
            return point_at(mix(before.x, point.x, t), mix(before.y, point.y, t));
        }
        walked += step;
        before = point;
    }
    return before;
}

/* On the neckline, `x` of its length from the back's middle towards -X, as the stand is seen from outside. */
static void neckline_at(const struct shirt *s, double x, double position[3])
{
    double back = tl_curve_length(&s->back[NECK]), front = tl_curve_length(&s->front[NECK]);
    double from_back = fmin(fabs(x), s->stand);
    struct tl_point p = s->front[NECK].control[3];
    if (from_back < back)
        p = along_curve(&s->back[NECK], back - from_back);
    else if (from_back < back + front)
        p = along_curve(&s->front[NECK], from_back - back);
    else
        p.x = s->stand - from_back;
    place_on_trunk(s, p.x, p.y, from_back < back, position);
    position[0] *= x > 0 ? -1 : 1;
}

/* Outwards from the neck's middle, until the neck is clear of both ends of the stand. */
static void clear_neck(const struct shirt *s, double position[3])
{
    const double clear = 0.007, step = 0.001;
    double x = position[0], z = position[2] - s->body->neck_z, away = fmax(hypot(x, z), 1e-6);
    for (int i = 0;
         i < 60 && (distance_at(s->body, position[0], position[1], position[2]) < clear ||
                    distance_at(s->body, position[0], position[1] + STAND_HEIGHT, position[2]) < clear);
         i++) {
        position[0] += step * x / away;
        position[2] += step * z / away;
    }
}

static void place_stand(const void *context, struct tl_point p, double position[3])
{
    const struct shirt *s = ((const struct half_placement *)context)->shirt;
    neckline_at(s, p.x, position);
    clear_neck(s, position);
    position[1] += p.y;
}

/* The fall is cut as a cone's surface is: circles around a point below it, so that it is longer where it is
 * farther from the neck. `radius` is that of its seam. */
static double fall_radius(const struct shirt *s)
{
    return s->stand / (M_PI * sin(FALL_SLOPE));
}

static struct tl_point on_fall(const struct shirt *s, double height, double angle)
{
    double radius = fall_radius(s) + height;
    return point_at(radius * sin(angle), radius * cos(angle) - fall_radius(s));
}

/* Turned down around the stand's upper edge, which its seam is at. */
static void place_fall(const void *context, struct tl_point p, double position[3])
{
    const struct shirt *s = ((const struct half_placement *)context)->shirt;
    double radius = fall_radius(s), height = hypot(p.x, p.y + radius) - radius;
    neckline_at(s, radius * atan2(p.x, p.y + radius), position);
    clear_neck(s, position);
    double off = fmin(fmax(height, 0), FALL_OFF) + height * sin(FALL_SLOPE);
    double x = position[0], z = position[2] - s->body->neck_z, away = fmax(hypot(x, z), 1e-6);
    position[0] += off * x / away;
    position[1] += STAND_HEIGHT - FALL_LIFT * height * cos(FALL_SLOPE);
    position[2] += off * z / away;
}

/* ---- The plan ---- */

static void make_rings(struct shirt *s, double hem_half)
{
    const struct tl_body *body = s->body;
    for (int i = 0; i < LEVELS; i++) {
        double t = (double)i / (LEVELS - 1);
        (void)tl_body_trunk_ring(body, fmax(mix(s->hem_y, s->underarm_y, t), body->crotch_y + 0.004),
                                 4 * mix(hem_half, s->half, t), &s->rings[i]);
    }
    double top = s->sleeve[UNDER_BACK].control[3].x - s->sleeve[UNDER_FRONT].control[0].x;
    for (size_t k = 0; k < TL_ARM_STEPS; k++) {
        double down = (double)k / (TL_ARM_STEPS - 1) * body->arm.length / (s->arm_end - CUFF_HEIGHT);
        (void)tl_body_arm_girth(body->mesh, &body->arm, k, mix(top, s->cuff, fmin(down, 1)), &s->arm[k]);
    }
}

/* The step of the arm where a sleeve of this length ends. */
static size_t arm_step(const struct tl_body *body, double length)
{
    double place = fmin(fmax(length / body->arm.length, 0), 1) * (TL_ARM_STEPS - 1);
    return (size_t)lround(place);
}

struct tl_cut_range tl_cut_longer_shirt(const struct tl_body *body)
{
    return (struct tl_cut_range){body->crotch_y + HEM_ABOVE - (body->waist_y - HEM_BELOW), INFINITY};
}

struct tl_cut_range tl_cut_longer_sleeves(const struct tl_body *body)
{
    return (struct tl_cut_range){CUFF_HEIGHT + SLEEVE_START + SLEEVE_MIN - body->arm.length, INFINITY};
}

static void draft(const struct tl_body *body, const struct tl_cut_params *sizes, struct shirt *s)
{
    const double ease = (double)sizes->ease_m;
    s->body = body;
    s->underarm_y = body->underarm_y - UNDERARM_DROP;
    s->hem_y = body->crotch_y + HEM_ABOVE - (double)sizes->longer_m;
    s->ridge_z = 0.5 * (body->neck_z + (double)body->arm.middle[0].z);
    s->half = 0.25 * (body->bust + BUST_EASE + ease);
    double hem_half = fmax(s->half - 0.005, 0.25 * (body->hip + HIP_EASE + ease));
    find_shoulder(s);
    measure_shoulders(s);
    cut_half(s, false, hem_half, s->front);
    cut_half(s, true, hem_half, s->back);
    double upper = tl_body_arm_girth(body->mesh, &body->arm, TL_ARM_STEPS / 6, 0, NULL);
    s->arm_end = body->arm.length + (double)sizes->sleeve_m;
    double wrist = tl_body_arm_girth(body->mesh, &body->arm, arm_step(body, s->arm_end), 0, NULL);
    s->cuff = wrist + CUFF_EASE + 0.5 * ease;
    s->sleeve_length = s->arm_end - CUFF_HEIGHT - SLEEVE_START;
    cut_sleeve(s, upper + SLEEVE_EASE + 0.5 * ease);
    s->stand = tl_curve_length(&s->back[NECK]) + tl_curve_length(&s->front[NECK]) + PLACKET_HALF;
    make_rings(s, hem_half);
}

static struct tl_cut_piece piece_of(const struct tl_curve *curves, size_t count, bool whole,
                                    const char *material)
{
    struct tl_cut_piece piece = {.half_count = count, .whole = whole, .material = material};
    for (size_t c = 0; c < count; c++)
        piece.half[c] = curves[c];
    return piece;
}

static struct tl_cut_piece strip_piece(double half, double low, double high, const char *material)
{
    const struct tl_curve curves[STRIP_CURVES] = {tl_curve_line(point_at(0, low), point_at(half, low)),
                                                  tl_curve_line(point_at(half, low), point_at(half, high)),
                                                  tl_curve_line(point_at(half, high), point_at(0, high))};
    return piece_of(curves, STRIP_CURVES, false, material);
}

static struct tl_cut_piece stand_piece(const struct shirt *s)
{
    double back = tl_curve_length(&s->back[NECK]), front = back + tl_curve_length(&s->front[NECK]);
    const double h = STAND_HEIGHT;
    const struct tl_curve curves[STAND_CURVES] = {tl_curve_line(point_at(0, 0), point_at(back, 0)),
                                                  tl_curve_line(point_at(back, 0), point_at(front, 0)),
                                                  tl_curve_line(point_at(front, 0), point_at(s->stand, 0)),
                                                  tl_curve_line(point_at(s->stand, 0), point_at(s->stand, h)),
                                                  tl_curve_line(point_at(s->stand, h), point_at(0, h))};
    return piece_of(curves, STAND_CURVES, false, "collar");
}

/* An arc from one angle to another, its height changing: nearly a circle's arc. */
static struct tl_curve fall_arc(const struct shirt *s, double height, double angle, double to_height,
                                double to)
{
    struct tl_point a = on_fall(s, height, angle), d = on_fall(s, to_height, to);
    double k = 4.0 / 3 * tan((to - angle) / 4), near = k * (fall_radius(s) + height);
    double far = k * (fall_radius(s) + to_height);
    return cubic(a, point_at(a.x + near * cos(angle), a.y - near * sin(angle)),
                 point_at(d.x - far * cos(to), d.y + far * sin(to)), d);
}

static struct tl_cut_piece fall_piece(const struct shirt *s)
{
    double end = s->stand / fall_radius(s), point = end - FALL_OPEN;
    const struct tl_curve curves[FALL_CURVES] = {
        fall_arc(s, 0, 0, 0, end), tl_curve_line(on_fall(s, 0, end), on_fall(s, FALL_POINT, point)),
        fall_arc(s, FALL_POINT, point, FALL_HEIGHT, 0)};
    return piece_of(curves, FALL_CURVES, false, "collar");
}

enum {
    FRONT_LEFT,
    FRONT_RIGHT,
    BACK,
    SLEEVE_LEFT,
    SLEEVE_RIGHT,
    PLACKET,
    CUFF_LEFT,
    CUFF_RIGHT,
    STAND,
    FALL,
    PIECES
};

static size_t front_other(size_t curve)
{
    return FRONT_CURVES - 1 - curve;
}

static size_t sleeve_other(size_t curve)
{
    return SLEEVE_CURVES - 1 - curve;
}

/* The back's right half, as it is seen from behind, is on -X. */
static void sew_body(struct tl_cut_plan *plan)
{
    const struct tl_cut_piece *back = &plan->pieces[BACK], *placket = &plan->pieces[PLACKET];
    const size_t across[] = {SIDE, SHOULDER};
    for (size_t k = 0; k < TL_COUNT(across); k++) {
        tl_cut_sew(plan, FRONT_LEFT, across[k], BACK, tl_cut_mirror(back, across[k]));
        tl_cut_sew(plan, FRONT_RIGHT, front_other(across[k]), BACK, across[k]);
    }
    tl_cut_sew(plan, FRONT_LEFT, ARMHOLE, SLEEVE_LEFT, CAP_FRONT);
    tl_cut_sew(plan, FRONT_RIGHT, front_other(ARMHOLE), SLEEVE_RIGHT, sleeve_other(CAP_FRONT));
    tl_cut_sew(plan, BACK, tl_cut_mirror(back, ARMHOLE), SLEEVE_LEFT, CAP_BACK);
    tl_cut_sew(plan, BACK, ARMHOLE, SLEEVE_RIGHT, sleeve_other(CAP_BACK));
    tl_cut_sew(plan, FRONT_LEFT, FRONT_MIDDLE, PLACKET, STRIP_SIDE);
    tl_cut_sew(plan, FRONT_RIGHT, front_other(FRONT_MIDDLE), PLACKET, tl_cut_mirror(placket, STRIP_SIDE));
}

static void sew_sleeves(struct tl_cut_plan *plan)
{
    tl_cut_sew(plan, SLEEVE_LEFT, UNDER_BACK, SLEEVE_LEFT, UNDER_FRONT);
    tl_cut_sew(plan, SLEEVE_RIGHT, sleeve_other(UNDER_BACK), SLEEVE_RIGHT, sleeve_other(UNDER_FRONT));
    const struct tl_cut_piece *cuff = &plan->pieces[CUFF_LEFT];
    tl_cut_sew(plan, CUFF_LEFT, STRIP_TOP, SLEEVE_LEFT, BOTTOM_BACK);
    tl_cut_sew(plan, CUFF_LEFT, tl_cut_mirror(cuff, STRIP_TOP), SLEEVE_LEFT, BOTTOM_FRONT);
    tl_cut_sew(plan, CUFF_RIGHT, STRIP_TOP, SLEEVE_RIGHT, sleeve_other(BOTTOM_FRONT));
    tl_cut_sew(plan, CUFF_RIGHT, tl_cut_mirror(cuff, STRIP_TOP), SLEEVE_RIGHT, sleeve_other(BOTTOM_BACK));
    for (size_t i = CUFF_LEFT; i <= CUFF_RIGHT; i++)
        tl_cut_sew(plan, i, STRIP_SIDE, i, tl_cut_mirror(cuff, STRIP_SIDE));
}

static void sew_collar(struct tl_cut_plan *plan)
{
    const struct tl_cut_piece *stand = &plan->pieces[STAND], *fall = &plan->pieces[FALL];
    const struct tl_cut_piece *back = &plan->pieces[BACK], *placket = &plan->pieces[PLACKET];
    tl_cut_sew(plan, STAND, STAND_BACK, BACK, NECK);
    tl_cut_sew(plan, STAND, tl_cut_mirror(stand, STAND_BACK), BACK, tl_cut_mirror(back, NECK));
    tl_cut_sew(plan, STAND, STAND_FRONT, FRONT_RIGHT, front_other(NECK));
    tl_cut_sew(plan, STAND, tl_cut_mirror(stand, STAND_FRONT), FRONT_LEFT, NECK);
    tl_cut_sew(plan, STAND, STAND_MIDDLE, PLACKET, tl_cut_mirror(placket, STRIP_TOP));
    tl_cut_sew(plan, STAND, tl_cut_mirror(stand, STAND_MIDDLE), PLACKET, STRIP_TOP);
    tl_cut_sew(plan, STAND, STAND_END, STAND, tl_cut_mirror(stand, STAND_END));
    tl_cut_sew(plan, STAND, STAND_TOP, FALL, FALL_SEAM);
    tl_cut_sew(plan, STAND, tl_cut_mirror(stand, STAND_TOP), FALL, tl_cut_mirror(fall, FALL_SEAM));
}

static void set_piece(struct tl_cut_plan *plan, size_t index, struct tl_cut_piece piece,
                      void (*place)(const void *, struct tl_point, double *),
                      const struct half_placement *context, double table_x)
{
    piece.place = place;
    piece.context = context;
    piece.table_offset.x = table_x;
    plan->pieces[index] = piece;
}

struct tl_cut_plan tl_cut_plan_shirt(const struct tl_body *body, const struct tl_cut_params *sizes)
{
    struct shirt *s = TL_NEW(struct shirt);
    draft(body, sizes, s);
    s->places[0] = (struct half_placement){s, false, false};
    s->places[1] = (struct half_placement){s, false, true};
    s->places[2] = (struct half_placement){s, true, false};
    const struct half_placement *left = &s->places[0], *right = &s->places[1];
    struct tl_cut_plan plan = {.name = "shirt", .piece_count = PIECES, .placement = s};
    struct tl_cut_piece front = piece_of(s->front, FRONT_CURVES, true, "shirt");
    struct tl_cut_piece sleeve = piece_of(s->sleeve, SLEEVE_CURVES, true, "shirt");
    struct tl_cut_piece cuff = strip_piece(0.5 * s->cuff, 0, CUFF_HEIGHT, "cuffs");
    set_piece(&plan, FRONT_LEFT, front, place_half, left, 0);
    set_piece(&plan, FRONT_RIGHT, tl_cut_mirrored(&front), place_half, right, 1.0);
    set_piece(&plan, BACK, piece_of(s->back, BACK_CURVES, false, "shirt"), place_half, &s->places[2], 1.6);
    set_piece(&plan, SLEEVE_LEFT, sleeve, place_sleeve, left, 2.4);
    set_piece(&plan, SLEEVE_RIGHT, tl_cut_mirrored(&sleeve), place_sleeve, right, 3.0);
    set_piece(&plan, PLACKET, strip_piece(PLACKET_HALF, s->hem_y, s->front[NECK].control[3].y, "placket"),
              place_half, left, -0.2);
    set_piece(&plan, CUFF_LEFT, cuff, place_cuff, left, 3.6);
    set_piece(&plan, CUFF_RIGHT, cuff, place_cuff, right, 4.2);
    set_piece(&plan, STAND, stand_piece(s), place_stand, left, 4.9);
    set_piece(&plan, FALL, fall_piece(s), place_fall, left, 6.0);
    sew_body(&plan);
    sew_sleeves(&plan);
    sew_collar(&plan);
    return plan;
}
