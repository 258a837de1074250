#include "assets/cut/garment_cut_internal.h"

#include "config/base/memory.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

/* Straight trousers: two front and two back legs, and a waistband in two. Drafted from the body's measures as
 * pattern books do (W. Aldrich, "Metric Pattern Cutting", the trouser block): quarters of the hip's girth
 * with a fork for the crotch that is longer behind, a dart in each quarter, the back's middle seam slanted
 * and higher. y is the height on the body; x is 0 in the middle seam below the hip. */
#define BELOW_WAIST  0.020 /* the waistband's upper edge */
#define BAND_HEIGHT  0.038
#define BAND_EASE    0.018 /* metres around, at the waistband's lower edge */
#define HIP_EASE     0.076
#define CROTCH_EASE  0.012 /* the fork hangs below the body's */
#define SEAT_EASE    0.030 /* of the seam under the crotch, front to back */
#define KNEE_EASE    0.110 /* over the calf */
#define HEM_EASE     0.060
#define HEM_PART     0.040 /* of the body's height: above the floor */
#define FOOT_EASE    0.015 /* of the hem around the lowest place of the leg that it reaches */
#define SHORTEST_LEG 0.15  /* of shorts, below the fork */
#define HIP_ABOVE    0.060 /* at least so far above the crotch */
#define FORKS_MIN    0.13  /* of the hip's girth: the width of front's and back's forks together */
#define FORKS_MAX    0.26
#define FRONT_FORK   0.38  /* of the forks' width */
#define BACK_MORE    0.010 /* the back is wider, to each side */
#define FRONT_SLANT  0.008 /* of the middle seam, hip to waist */
#define BACK_SLANT   0.022
#define BACK_RISE    0.020 /* of the back's middle above its side */
#define FRONT_CURVE  0.060 /* height of the crotch's curve */
#define BACK_CURVE   0.100
#define DART_MAX     0.028
#define DART_MIN     0.008
#define FRONT_DART   0.085 /* length */
#define BACK_DART    0.120

enum { LEVELS = 96 };
enum {
    HEM,
    OUT_LOWER,
    OUT_UPPER,
    OUT_HIP,
    WAIST_SIDE,
    DART_DOWN,
    DART_UP,
    WAIST_MIDDLE,
    MIDDLE,
    CROTCH,
    IN_UPPER,
    IN_LOWER,
    LEG_CURVES
};
enum { BAND_MIDDLE, BAND_DART, BAND_SIDE, BAND_TOP, BAND_CURVES };

/* One leg's front or back as drafted: its side seam on +x. */
struct leg_pattern {
    struct tl_curve curves[LEG_CURVES];
    double dart_width, dart_x, dart_length, top_y; /* top_y: the waist line's highest point */
    double low[LEVELS], high[LEVELS]; /* from the inside to the outside, at each level, darts closed */
};

struct levels {
    double y[LEVELS];
    struct tl_ring trunk[LEVELS], leg[LEVELS];
};

struct trousers;
struct leg_placement {
    const struct trousers *trousers;
    const struct leg_pattern *pattern;
    bool back, mirrored;
};
struct band_placement {
    const struct trousers *trousers;
    bool back;
};

struct trousers {
    double hem_y, knee_y, fork_y, hip_y, band_y; /* band_y: the waistband's lower edge */
    struct leg_pattern front, back;
    struct levels levels;
    struct tl_ring band[2]; /* lower and upper edge */
    struct leg_placement places[4];
    struct band_placement bands[2];
};

static struct tl_curve curve_of(struct tl_point a, struct tl_point b, struct tl_point c, struct tl_point d)
{
    return (struct tl_curve){.control = {a, b, c, d}};
}

static struct tl_point between(struct tl_point a, struct tl_point b, double t)
{
    return (struct tl_point){a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t};
}

/* Differences between front and back. */
struct leg_draft {
    double width, fork, slant, rise, curve, dart_length, waist; /* waist: a quarter of the waistband */
    double knee, hem;                                           /* widths */
};

/* The distance by which the side seam moves in from the hip to the waist, the knee and the hem: the same in
 * front and back, so that both are as long. */
struct side_shape {
    double waist, knee, hem;
};

/* The inside, from the fork at height `fork_y` to the hem. */
static void cut_inside(const struct trousers *t, const struct leg_draft *draft, const struct side_shape *side,
                       double fork_y, struct tl_curve *curves)
{
    struct tl_point start = {0, t->fork_y + draft->curve}, fork = {-draft->fork, fork_y};
    struct tl_point knee = {draft->width - side->knee - draft->knee, t->knee_y};
    struct tl_point hem = {draft->width - side->hem - draft->hem, t->hem_y};
    curves[CROTCH] = curve_of(start, (struct tl_point){0, fork_y + 0.40 * draft->curve},
                              (struct tl_point){-0.35 * draft->fork, fork_y + 0.004}, fork);
    struct tl_point hollow = between(fork, knee, 0.3);
    hollow.x += 0.10 * (knee.x - fork.x);
    curves[IN_UPPER] = curve_of(fork, hollow, between(knee, hem, -0.35), knee);
    curves[IN_LOWER] = tl_curve_line(knee, hem);
}

static void cut_waist(const struct trousers *t, const struct leg_draft *draft, const struct side_shape *side,
                      struct leg_pattern *out)
{
    struct tl_point hip = {draft->width, t->hip_y}, waist = {draft->width - side->waist, t->band_y};
    struct tl_point middle = {draft->slant, t->band_y + draft->rise}, start = {0, t->fork_y + draft->curve};
    double length = hypot(waist.x - middle.x, waist.y - middle.y), rise = t->band_y - t->hip_y;
    out->dart_width = fmax(length - draft->waist, 0.5 * DART_MIN);
    struct tl_point outer = between(middle, waist, 0.5 + 0.5 * out->dart_width / length);
    struct tl_point inner = between(middle, waist, 0.5 - 0.5 * out->dart_width / length);
    struct tl_point axis = between(inner, outer, 0.5);
    struct tl_point tip = {axis.x + draft->dart_length * (waist.y - middle.y) / length,
                           axis.y - draft->dart_length * (waist.x - middle.x) / length};
    out->dart_x = axis.x;
    out->dart_length = draft->dart_length;
    out->top_y = middle.y;
    out->curves[OUT_HIP] =
        curve_of(hip, (struct tl_point){hip.x, hip.y + 0.30 * rise},
                 (struct tl_point){waist.x + 0.40 * side->waist, waist.y - 0.40 * rise}, waist);
    out->curves[WAIST_SIDE] = tl_curve_line(waist, outer);
    out->curves[DART_DOWN] = tl_curve_line(outer, tip);
    out->curves[DART_UP] = tl_curve_line(tip, inner);
    out->curves[WAIST_MIDDLE] = tl_curve_line(inner, middle);
    out->curves[MIDDLE] = tl_curve_line(middle, start);
}

static void cut_outside(const struct trousers *t, const struct leg_draft *draft,
                        const struct side_shape *side, struct leg_pattern *out)
{
    struct tl_point hip = {draft->width, t->hip_y}, knee = {draft->width - side->knee, t->knee_y};
    struct tl_point hem = {draft->width - side->hem, t->hem_y};
    out->curves[HEM] = tl_curve_line((struct tl_point){hem.x - draft->hem, t->hem_y}, hem);
    out->curves[OUT_LOWER] = tl_curve_line(hem, knee);
    out->curves[OUT_UPPER] =
        curve_of(knee, between(knee, hem, -0.35), (struct tl_point){hip.x, hip.y - 0.12}, hip);
}

/* The inside of the back is as long as the front's: its fork is lower. */
static double find_back_fork(const struct trousers *t, const struct leg_draft *back,
                             const struct side_shape *side, double length)
{
    double low = t->fork_y - 0.05, high = t->fork_y;
    for (int step = 0; step < 40; step++) {
        struct tl_curve curves[LEG_CURVES];
        double middle = 0.5 * (low + high);
        cut_inside(t, back, side, middle, curves);
        if (tl_curve_length(&curves[IN_UPPER]) < length)
            low = middle;
        else
            high = middle;
    }
    return high;
}

/* Finds where the curves from `first` to `last` cross the height y: the lowest and highest x. */
static void find_span(const struct leg_pattern *pattern, int first, int last, double y, double span[2])
{
    enum { SAMPLES = 64 };
    span[0] = INFINITY;
    span[1] = -INFINITY;
    for (int c = first; c <= last; c++) {
        struct tl_point before = pattern->curves[c].control[0];
        for (int i = 1; i <= SAMPLES; i++) {
            struct tl_point point = tl_curve_at(&pattern->curves[c], (double)i / SAMPLES);
            double low = fmin(before.y, point.y), high = fmax(before.y, point.y);
            if (y >= low && y <= high) {
                double t = high > low ? (y - before.y) / (point.y - before.y) : 0;
                double x = before.x + (point.x - before.x) * t;
                span[0] = fmin(span[0], x);
                span[1] = fmax(span[1], x);
            }
            before = point;
        }
    }
}

/* The dart's opening at a height. */
static double dart_opening(const struct leg_pattern *pattern, const struct trousers *t, double y)
{
    return pattern->dart_width * fmin(fmax((y - t->band_y) / pattern->dart_length + 1, 0), 1);
}

static void measure_levels(const struct trousers *t, struct leg_pattern *pattern)
{
    for (int i = 0; i < LEVELS; i++) {
        double y = t->levels.y[i], inside[2], outside[2];
        find_span(pattern, MIDDLE, IN_LOWER, fmax(y, t->hem_y), inside);
        find_span(pattern, OUT_LOWER, OUT_HIP, y, outside);
        pattern->low[i] = inside[0];
        pattern->high[i] = outside[1] - dart_opening(pattern, t, y);
    }
}

static double level_of(const struct levels *levels, double y, int *index)
{
    double place = (y - levels->y[0]) / (levels->y[LEVELS - 1] - levels->y[0]) * (LEVELS - 1);
    place = fmin(fmax(place, 0), LEVELS - 1);
    *index = place < LEVELS - 1 ? (int)place : LEVELS - 2;
    return place - *index;
}

static double mix(double a, double b, double t)
{
    return a + (b - a) * t;
}

/* (x, z) on a ring, for a place between the pattern's inside and outside, on the leg of +X. */
static struct tl_point around_trunk(const struct tl_ring *ring, double x, bool back)
{
    return tl_ring_at(ring, back ? 0.5 * ring->length - x : x);
}

static struct tl_point around_leg(const struct tl_ring *ring, double from_inside, bool back)
{
    int inner = 0;
    for (int k = 1; k < TL_RING_STEPS; k++)
        if (ring->points[k].x < ring->points[inner].x)
            inner = k;
    double start = ring->length * inner / TL_RING_STEPS;
    return tl_ring_at(ring, back ? start - from_inside : start + from_inside);
}

static void place_leg(const void *context, struct tl_point p, double position[3])
{
    const double half_gap = 0.003; /* between the two legs */
    const struct leg_placement *place = context;
    const struct trousers *t = place->trousers;
    const struct leg_pattern *pattern = place->pattern;
    double x = place->mirrored ? -p.x : p.x, y = p.y;
    if (y > t->hip_y) /* the back rises towards its middle */
        y = t->hip_y +
            (y - t->hip_y) * (t->band_y - t->hip_y) /
                (mix(pattern->top_y, t->band_y, fmin(fmax(x / pattern->high[0], 0), 1)) - t->hip_y);
    if (x > pattern->dart_x)
        x -= dart_opening(pattern, t, y);
    int i;
    double u = level_of(&t->levels, y, &i);
    struct tl_point at[2];
    for (int k = 0; k < 2; k++) {
        double level = t->levels.y[i + k], above = (level - t->fork_y) / FRONT_CURVE;
        double share = fmin(fmax(above, 0), 1), low = pattern->low[i + k];
        double middle = fmax(low, 0), width = pattern->high[i + k] - low;
        struct tl_point trunk = around_trunk(&t->levels.trunk[i + k], fmax(x - middle, 0), place->back);
        struct tl_point leg = around_leg(&t->levels.leg[i + k], fmin(fmax(x - low, 0), width), place->back);
        at[k] = between(leg, trunk, share * share * (3 - 2 * share));
    }
    struct tl_point on = between(at[0], at[1], u);
    bool left = place->back == place->mirrored; /* on +X */
    position[0] = (left ? 1 : -1) * (x <= pattern->low[i] + 1e-6 && y > t->fork_y ? 0 : fmax(on.x, half_gap));
    position[1] = y;
    position[2] = on.y;
}

static void place_band(const void *context, struct tl_point p, double position[3])
{
    const struct band_placement *place = context;
    const struct tl_ring *band = place->trousers->band;
    struct tl_point low = tl_ring_at(&band[0], place->back ? 0.5 * band[0].length + p.x : p.x);
    struct tl_point high = tl_ring_at(&band[1], place->back ? 0.5 * band[1].length + p.x : p.x);
    struct tl_point on = between(low, high, p.y / BAND_HEIGHT);
    position[0] = on.x;
    position[1] = place->trousers->band_y + p.y;
    position[2] = on.y;
}

/* Each level's rings are as long as the pattern is wide there. */
static void make_rings(const struct tl_body *body, struct trousers *t)
{
    for (int i = 0; i < LEVELS; i++) {
        double y = t->levels.y[i];
        double front = t->front.high[i] - t->front.low[i], back = t->back.high[i] - t->back.low[i];
        double trunk =
            2 * (t->front.high[i] - fmax(t->front.low[i], 0) + t->back.high[i] - fmax(t->back.low[i], 0));
        (void)tl_body_trunk_ring(body, fmax(y, body->crotch_y + 0.004), trunk, &t->levels.trunk[i]);
        (void)tl_body_leg_ring(body, fmin(y, body->crotch_y - 0.004), front + back, &t->levels.leg[i]);
    }
    double half = 0;
    for (int c = 0; c < 2; c++)
        half += tl_curve_length(&t->front.curves[c ? WAIST_SIDE : WAIST_MIDDLE]) +
                tl_curve_length(&t->back.curves[c ? WAIST_SIDE : WAIST_MIDDLE]);
    for (int edge = 0; edge < 2; edge++)
        (void)tl_body_trunk_ring(body, t->band_y + edge * BAND_HEIGHT, 2 * half, &t->band[edge]);
}

/* Front and back as wide as the body is, before the forks are known. */
static void draft_widths(const struct tl_body *body, const struct trousers *t, double ease,
                         struct leg_draft draft[2])
{
    double quarter = (body->hip + HIP_EASE + ease) / 4;
    double band = (tl_body_trunk_girth(body, t->band_y) + BAND_EASE + ease) / 4;
    double knee = (fmax(body->knee, body->calf) + KNEE_EASE + 0.5 * ease) / 2;
    double hem = knee - 0.5 * (KNEE_EASE - HEM_EASE);
    for (int i = 0; i < 2; i++) {
        double more = i ? BACK_MORE : -BACK_MORE;
        draft[i] = (struct leg_draft){.width = quarter + more / 2,
                                      .slant = i ? BACK_SLANT : FRONT_SLANT,
                                      .rise = i ? BACK_RISE : 0,
                                      .curve = i ? BACK_CURVE : FRONT_CURVE,
                                      .dart_length = i ? BACK_DART : FRONT_DART,
                                      .waist = band + more / 2,
                                      .knee = knee + more,
                                      .hem = hem + more};
    }
}

/* Cuts both with forks of the given width together; returns the length of the seam under the crotch. */
static double cut_legs(struct trousers *t, struct leg_draft draft[2], double forks)
{
    struct leg_draft *front = &draft[0], *back = &draft[1];
    front->fork = FRONT_FORK * forks;
    back->fork = forks - front->fork;
    /* The crease lies in the middle of the front's width at the fork, of its knee and of its hem. */
    double crease = 0.5 * (front->width - front->fork);
    double excess = 0.5 * (front->width + back->width - front->waist - back->waist);
    struct side_shape side = {.knee = front->width - crease - 0.5 * front->knee,
                              .hem = front->width - crease - 0.5 * front->hem};
    side.waist = fmax(0.4 * excess, excess - BACK_SLANT - DART_MAX);
    side.waist = fmin(side.waist, fmax(excess - BACK_SLANT - DART_MIN, 0));
    cut_outside(t, front, &side, &t->front);
    cut_outside(t, back, &side, &t->back);
    cut_waist(t, front, &side, &t->front);
    cut_waist(t, back, &side, &t->back);
    cut_inside(t, front, &side, t->fork_y, t->front.curves);
    double fork = find_back_fork(t, back, &side, tl_curve_length(&t->front.curves[IN_UPPER]));
    cut_inside(t, back, &side, fork, t->back.curves);
    return tl_curve_length(&t->front.curves[MIDDLE]) + tl_curve_length(&t->front.curves[CROTCH]) +
           tl_curve_length(&t->back.curves[MIDDLE]) + tl_curve_length(&t->back.curves[CROTCH]);
}

/* The girth that both hems are drafted to, in draft_widths. */
static double hem_girth(const struct tl_body *body)
{
    return fmax(body->knee, body->calf) + HEM_EASE;
}

struct tl_cut_range tl_cut_longer_trousers(const struct tl_body *body)
{
    const double drafted_y = HEM_PART * body->height, step = 0.005;
    double lowest_y = drafted_y;
    for (int i = 0; drafted_y - i * step > 0; i++) { /* feet are wider than the hem */
        const double y = drafted_y - i * step;
        double girth = tl_body_leg_girth(body, y);
        if (!(girth > 0 && girth + FOOT_EASE < hem_girth(body)))
            break;
        lowest_y = y;
    }
    return (struct tl_cut_range){drafted_y - (body->crotch_y - CROTCH_EASE - SHORTEST_LEG),
                                 drafted_y - lowest_y};
}

static void draft(const struct tl_body *body, const struct tl_cut_params *sizes, struct trousers *t)
{
    t->band_y = body->waist_y - BELOW_WAIST - BAND_HEIGHT;
    t->hip_y = fmax(body->hip_y, body->crotch_y + HIP_ABOVE);
    t->fork_y = body->crotch_y - CROTCH_EASE;
    t->hem_y = HEM_PART * body->height - (double)sizes->longer_m;
    t->knee_y = fmax(0.58 * body->crotch_y, t->hem_y + 0.4 * SHORTEST_LEG); /* of shorts: below the middle */
    for (int i = 0; i < LEVELS; i++)
        t->levels.y[i] = t->hem_y + (t->band_y - t->hem_y) * i / (LEVELS - 1);
    struct leg_draft draft[2];
    draft_widths(body, t, (double)sizes->ease_m, draft);
    double seat = tl_body_crotch_length(body, t->band_y) + SEAT_EASE;
    double low = FORKS_MIN * body->hip, high = FORKS_MAX * body->hip;
    for (int step = 0; step < 30; step++) {
        double middle = 0.5 * (low + high);
        if (cut_legs(t, draft, middle) < seat)
            low = middle;
        else
            high = middle;
    }
    measure_levels(t, &t->front);
    measure_levels(t, &t->back);
    make_rings(body, t);
}

static struct tl_cut_piece leg_piece(const struct leg_pattern *pattern)
{
    struct tl_cut_piece piece = {
        .half_count = LEG_CURVES, .whole = true, .place = place_leg, .material = "trousers"};
    for (size_t c = 0; c < LEG_CURVES; c++)
        piece.half[c] = pattern->curves[c];
    return piece;
}

static struct tl_cut_piece band_piece(const struct leg_pattern *pattern, const struct band_placement *place)
{
    double middle = tl_curve_length(&pattern->curves[WAIST_MIDDLE]);
    double width = middle + tl_curve_length(&pattern->curves[WAIST_SIDE]);
    struct tl_point dart = {middle, 0}, side = {width, 0}, top = {width, BAND_HEIGHT};
    return (struct tl_cut_piece){
        .half = {tl_curve_line((struct tl_point){0, 0}, dart), tl_curve_line(dart, side),
                 tl_curve_line(side, top), tl_curve_line(top, (struct tl_point){0, BAND_HEIGHT})},
        .half_count = BAND_CURVES,
        .place = place_band,
        .context = place,
        .material = "waistband",
    };
}

enum { FRONT_LEFT, FRONT_RIGHT, BACK_RIGHT, BACK_LEFT, BAND_FRONT, BAND_BACK, PIECES };

static size_t other(size_t curve)
{
    return LEG_CURVES - 1 - curve;
}

/* A leg as drafted, and its counterpart, whose curves run the other way. */
static void sew_legs(struct tl_cut_plan *plan)
{
    const size_t across[] = {OUT_LOWER, OUT_UPPER, OUT_HIP, IN_UPPER, IN_LOWER};
    const struct {
        size_t drafted, counterpart;
    } pairs[] = {{FRONT_LEFT, BACK_LEFT}, {BACK_RIGHT, FRONT_RIGHT}};
    for (size_t i = 0; i < TL_COUNT(pairs); i++)
        for (size_t k = 0; k < TL_COUNT(across); k++)
            tl_cut_sew(plan, pairs[i].drafted, across[k], pairs[i].counterpart, other(across[k]));
    const size_t middles[] = {MIDDLE, CROTCH};
    for (size_t k = 0; k < TL_COUNT(middles); k++) {
        tl_cut_sew(plan, FRONT_LEFT, middles[k], FRONT_RIGHT, other(middles[k]));
        tl_cut_sew(plan, BACK_RIGHT, middles[k], BACK_LEFT, other(middles[k]));
    }
    const size_t drafted[] = {FRONT_LEFT, BACK_RIGHT}, counterpart[] = {FRONT_RIGHT, BACK_LEFT};
    for (size_t i = 0; i < 2; i++) {
        tl_cut_sew(plan, drafted[i], DART_DOWN, drafted[i], DART_UP);
        tl_cut_sew(plan, counterpart[i], other(DART_DOWN), counterpart[i], other(DART_UP));
    }
}

static void sew_band(struct tl_cut_plan *plan)
{
    const size_t band[] = {BAND_FRONT, BAND_BACK}, drafted[] = {FRONT_LEFT, BACK_RIGHT};
    const size_t counterpart[] = {FRONT_RIGHT, BACK_LEFT};
    for (size_t i = 0; i < 2; i++) {
        const struct tl_cut_piece *piece = &plan->pieces[band[i]];
        tl_cut_sew(plan, band[i], BAND_MIDDLE, drafted[i], WAIST_MIDDLE);
        tl_cut_sew(plan, band[i], BAND_DART, drafted[i], WAIST_SIDE);
        tl_cut_sew(plan, band[i], tl_cut_mirror(piece, BAND_MIDDLE), counterpart[i], other(WAIST_MIDDLE));
        tl_cut_sew(plan, band[i], tl_cut_mirror(piece, BAND_DART), counterpart[i], other(WAIST_SIDE));
        tl_cut_sew(plan, band[i], BAND_SIDE, band[1 - i],
                   tl_cut_mirror(&plan->pieces[band[1 - i]], BAND_SIDE));
    }
}

struct tl_cut_plan tl_cut_plan_trousers(const struct tl_body *body, const struct tl_cut_params *sizes)
{
    struct trousers *t = TL_NEW(struct trousers);
    draft(body, sizes, t);
    struct tl_cut_plan plan = {
        .name = "trousers", .piece_count = PIECES, .placement = t, .keeps_sides = true};
    for (size_t i = 0; i < BAND_FRONT; i++) {
        bool back = i == BACK_RIGHT || i == BACK_LEFT, mirrored = i == FRONT_RIGHT || i == BACK_LEFT;
        const struct leg_pattern *pattern = back ? &t->back : &t->front;
        struct tl_cut_piece piece = leg_piece(pattern);
        t->places[i] = (struct leg_placement){t, pattern, back, mirrored};
        plan.pieces[i] = mirrored ? tl_cut_mirrored(&piece) : piece;
        plan.pieces[i].context = &t->places[i];
        plan.pieces[i].table_offset.x = 0.55 * (double)i;
    }
    for (size_t i = 0; i < 2; i++) {
        t->bands[i] = (struct band_placement){t, i == 1};
        plan.pieces[BAND_FRONT + i] = band_piece(i ? &t->back : &t->front, &t->bands[i]);
        plan.pieces[BAND_FRONT + i].table_offset = (struct tl_point){0.55 * (double)i, t->band_y + 0.15};
    }
    sew_legs(&plan);
    sew_band(&plan);
    return plan;
}
