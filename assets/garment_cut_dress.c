#include "assets/form.h"
#include "assets/garment_cut.h"

#include "config/memory.h"

#include <math.h>

/* A sleeveless summer dress in four pieces: fitted bodice front and back, and a half circle skirt. It hangs
 * from its shoulder seams; nothing is pinned. */
#define WAIST_Y      1.035
#define WAIST_LENGTH 0.75 /* metres around: the form's girth and 7 cm of ease */
#define SKIRT_LENGTH 0.50
#define SKIRT_ANGLE  3.0    /* radians: the hem is 0.75 + 3.0 x 0.5 = 2.25 m around */
#define SKIRT_SLOPE  0.42   /* radians, of the start shape */
#define SKIRT_FOLDS  9      /* of the start shape */
#define UNDERARM     0.190  /* metres of cloth above the waist seam */
#define STRAP_X      0.112  /* the shoulder seam's middle */
#define RIDGE_Z      -0.016 /* the shoulders' ridge */

enum { BODICE_RINGS = 16, PROFILE_STEPS = 64 };

/* Side view of the way from the underarm level over chest or back to the shoulder's ridge, by cloth length.
 */
struct profile {
    double length;
    double y[PROFILE_STEPS + 1];
    double depth[PROFILE_STEPS + 1]; /* distance in front of (behind) the ridge, 1 at the underarm level */
};

struct bodice_shape {
    double waist_half, underarm_half; /* half-widths of the piece, metres */
    double facing;                    /* +1 front, -1 back */
    struct profile profile;
    const struct tl_ring *rings; /* BODICE_RINGS from waist to underarm, shared */
};

struct dress_placement {
    struct tl_ring rings[BODICE_RINGS];
    struct tl_flare flare;
    struct tl_cut_flared skirt_front, skirt_back;
    struct bodice_shape front, back;
};

/* Ring point at `distance` from the piece's own middle, to the right as one looks at the piece. */
static struct tl_point ring_point(const struct bodice_shape *bodice, const struct tl_ring *ring,
                                  double distance)
{
    return tl_ring_at(ring, bodice->facing > 0 ? distance : 0.5 * ring->length + distance);
}

static void place_bodice(const void *context, struct tl_point p, double position[3])
{
    const struct bodice_shape *bodice = context;
    double level = fmin(p.y / UNDERARM, 1) * (BODICE_RINGS - 1);
    int i = (int)level < BODICE_RINGS - 1 ? (int)level : BODICE_RINGS - 2;
    double t = level - i;
    struct tl_point low = ring_point(bodice, &bodice->rings[i], p.x);
    struct tl_point high = ring_point(bodice, &bodice->rings[i + 1], p.x);
    position[0] = low.x + (high.x - low.x) * t;
    position[1] = bodice->rings[i].y + (bodice->rings[i + 1].y - bodice->rings[i].y) * t;
    position[2] = low.y + (high.y - low.y) * t;
    if (p.y <= UNDERARM)
        return;
    double place = fmin((p.y - UNDERARM) / bodice->profile.length, 1) * PROFILE_STEPS;
    int k = (int)place < PROFILE_STEPS ? (int)place : PROFILE_STEPS - 1;
    double u = place - k, up = place / PROFILE_STEPS;
    const double *depth = bodice->profile.depth, *y = bodice->profile.y;
    position[0] += (bodice->facing * p.x - position[0]) * up;
    position[1] = y[k] + (y[k + 1] - y[k]) * u;
    position[2] = RIDGE_Z + (position[2] - RIDGE_Z) * (depth[k] + (depth[k + 1] - depth[k]) * u);
}

/* Walks around the shoulder in the plane x = STRAP_X, seen from a point below the ridge, a centimetre off. */
static void trace_profile(double underarm_y, double facing, struct profile *out)
{
    double y[PROFILE_STEPS + 1], z[PROFILE_STEPS + 1], length[PROFILE_STEPS + 1] = {0};
    for (int i = 0; i <= PROFILE_STEPS; i++) {
        double angle = 0.5 * M_PI * i / PROFILE_STEPS, inside = 0, outside = 0.4;
        for (int step = 0; step < 40; step++) {
            double r = 0.5 * (inside + outside);
            double point[3] = {STRAP_X, underarm_y + r * sin(angle), RIDGE_Z + facing * r * cos(angle)};
            if (tl_form_distance(point) < 0.01)
                inside = r;
            else
                outside = r;
        }
        y[i] = underarm_y + inside * sin(angle);
        z[i] = inside * cos(angle);
        if (i > 0)
            length[i] = length[i - 1] + hypot(y[i] - y[i - 1], z[i] - z[i - 1]);
    }
    out->length = length[PROFILE_STEPS];
    for (int k = 0, i = 0; k <= PROFILE_STEPS; k++) {
        double wanted = out->length * k / PROFILE_STEPS;
        while (i < PROFILE_STEPS - 1 && length[i + 1] < wanted)
            i++;
        double t = (wanted - length[i]) / (length[i + 1] - length[i]);
        out->y[k] = y[i] + (y[i + 1] - y[i]) * t;
        out->depth[k] = (z[i] + (z[i + 1] - z[i]) * t) / z[0];
    }
}

struct bodice_pattern {
    double waist_half, underarm_half;
    double neck_drop;  /* depth of the neckline below the shoulder seam's inner end */
    double chest_half; /* narrowest half-width between the armholes */
};

enum { WAIST, SIDE, ARMHOLE, SHOULDER, NECKLINE, BODICE_CURVES };

/* `rise`: cloth from the waist over the chest to the shoulder seam's middle. */
static struct tl_cut_piece bodice_piece(const struct bodice_pattern *pattern, double rise,
                                        const struct bodice_shape *shape)
{
    struct tl_point centre = {0, 0}, waist = {pattern->waist_half, 0};
    struct tl_point underarm = {pattern->underarm_half, UNDERARM};
    struct tl_point tip = {STRAP_X + 0.026, rise - 0.010}, neck = {STRAP_X - 0.026, rise + 0.008};
    struct tl_point scoop = {0, neck.y - pattern->neck_drop};
    double armhole = tip.y - underarm.y, chest = pattern->chest_half;
    return (struct tl_cut_piece){
        .half = {[WAIST] = tl_curve_line(centre, waist),
                 [SIDE] = tl_curve_line(waist, underarm),
                 [ARMHOLE] = {.control = {underarm,
                                          {chest + 0.2 * (underarm.x - chest), underarm.y + 0.01},
                                          {chest - 0.012, underarm.y + 0.45 * armhole},
                                          tip}},
                 [SHOULDER] = tl_curve_line(tip, neck),
                 [NECKLINE] = {.control = {neck,
                                           {neck.x - 0.004, neck.y - 0.6 * pattern->neck_drop},
                                           {0.6 * neck.x, scoop.y},
                                           scoop}}},
        .half_count = BODICE_CURVES,
        .place = place_bodice,
        .context = shape,
    };
}

/* Front pieces' right sides meet back pieces' left sides, and the other way round. */
static void sew_around(struct tl_cut_plan *plan, size_t front, size_t back, size_t curve)
{
    size_t mirror = tl_cut_mirror(&plan->pieces[front], curve);
    plan->seams[plan->seam_count++] = (struct tl_cut_seam){front, curve, back, mirror};
    plan->seams[plan->seam_count++] = (struct tl_cut_seam){back, curve, front, mirror};
}

static void sew_waist(struct tl_cut_plan *plan, size_t bodice, size_t skirt)
{
    enum { SKIRT_WAIST = 2 };
    plan->seams[plan->seam_count++] = (struct tl_cut_seam){bodice, WAIST, skirt, SKIRT_WAIST};
    plan->seams[plan->seam_count++] =
        (struct tl_cut_seam){bodice, tl_cut_mirror(&plan->pieces[bodice], WAIST), skirt,
                             tl_cut_mirror(&plan->pieces[skirt], SKIRT_WAIST)};
}

struct tl_cut_plan tl_cut_plan_dress(void)
{
    const struct bodice_pattern front = {0.25 * WAIST_LENGTH, 0.235, 0.130, 0.140};
    const struct bodice_pattern back = {0.25 * WAIST_LENGTH, 0.235, 0.080, 0.145};
    struct dress_placement *placement = TL_NEW(struct dress_placement);
    const double underarm_y = WAIST_Y + UNDERARM - 0.006; /* the sides slant */
    for (int i = 0; i < BODICE_RINGS; i++) {
        double t = (double)i / (BODICE_RINGS - 1);
        double bust = 2 * (front.underarm_half + back.underarm_half);
        tl_ring_around_form(WAIST_Y + (underarm_y - WAIST_Y) * t, WAIST_LENGTH + (bust - WAIST_LENGTH) * t,
                            &placement->rings[i]);
    }
    tl_flare_from_ring(&placement->rings[0], SKIRT_LENGTH, SKIRT_ANGLE, SKIRT_SLOPE, SKIRT_FOLDS,
                       &placement->flare);
    placement->skirt_front = (struct tl_cut_flared){&placement->flare, WAIST_LENGTH, SKIRT_ANGLE, 0};
    placement->skirt_back = (struct tl_cut_flared){&placement->flare, WAIST_LENGTH, SKIRT_ANGLE, 0.5};
    placement->front =
        (struct bodice_shape){front.waist_half, front.underarm_half, 1, .rings = placement->rings};
    placement->back =
        (struct bodice_shape){back.waist_half, back.underarm_half, -1, .rings = placement->rings};
    trace_profile(underarm_y, 1, &placement->front.profile);
    trace_profile(underarm_y, -1, &placement->back.profile);

    struct tl_cut_plan plan = {.name = "dress", .piece_count = 4, .placement = placement};
    enum { FRONT, BACK, SKIRT_FRONT, SKIRT_BACK, SKIRT_SIDE = 1 };
    plan.pieces[FRONT] = bodice_piece(&front, UNDERARM + placement->front.profile.length, &placement->front);
    plan.pieces[BACK] = bodice_piece(&back, UNDERARM + placement->back.profile.length, &placement->back);
    plan.pieces[SKIRT_FRONT] = tl_cut_flared_piece(&placement->skirt_front);
    plan.pieces[SKIRT_BACK] = tl_cut_flared_piece(&placement->skirt_back);
    plan.pieces[BACK].table_offset.x = 0.7;
    plan.pieces[SKIRT_BACK].table_offset.x = 1.2;
    sew_around(&plan, FRONT, BACK, SIDE);
    sew_around(&plan, FRONT, BACK, SHOULDER);
    sew_around(&plan, SKIRT_FRONT, SKIRT_BACK, SKIRT_SIDE);
    sew_waist(&plan, FRONT, SKIRT_FRONT);
    sew_waist(&plan, BACK, SKIRT_BACK);
    return plan;
}
