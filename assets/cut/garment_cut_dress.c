#include "assets/body/form.h"
#include "assets/cut/garment_cut_internal.h"

#include "config/base/memory.h"

#include <math.h>

/* A sleeveless summer dress in four pieces: fitted bodice front and back, and a half circle skirt. It hangs
 * from its shoulder seams; nothing is pinned. */
#define WAIST_Y      1.035
#define WAIST_LENGTH 0.75 /* metres around: the form's girth and 7 cm of ease */
#define SKIRT_LENGTH 0.50
#define SKIRT_ANGLE  3.0  /* radians: the hem is 0.75 + 3.0 x 0.5 = 2.25 m around */
#define SKIRT_SLOPE  0.42 /* radians, of the start shape */
#define SKIRT_FOLDS                                                                                          \
    6 /* of the start shape: of 5, 7 and 8 a side fold closes on itself and creases along the mesh */
/* A curtain before the dress's left: metres. */
#define CURTAIN_WIDTH  0.80
#define CURTAIN_LENGTH 1.05
#define CURTAIN_X      0.40
#define CURTAIN_Y      1.50
#define CURTAIN_Z      0.46
#define CURTAIN_FOLDS  3
#define CURTAIN_GATHER 0.92     /* its width as it hangs over its width as cloth */
#define CURTAIN_DEPTH  0.0237   /* of the folds, which take up the difference */
#define UNDERARM       0.190    /* metres of cloth above the waist seam */
#define STRAP_X        0.112    /* the shoulder seam's middle */
#define RIDGE_Z        (-0.016) /* the shoulders' ridge */

enum { BODICE_RINGS = 16, PROFILE_STEPS = 64 };

/* Side view of the way from the underarm level over chest or back to the shoulder's ridge, by cloth length.
 */
struct dress_profile {
    double length;
    double y[PROFILE_STEPS + 1];
    double depth[PROFILE_STEPS + 1]; /* distance in front of (behind) the ridge, 1 at the underarm level */
};

struct bodice_shape {
    double facing; /* +1 front, -1 back */
    bool darted;
    struct dress_profile profile;
    const struct tl_ring *rings; /* BODICE_RINGS from waist to underarm, shared */
};

struct dress_placement {
    struct tl_ring rings[BODICE_RINGS];
    struct tl_flare flare;
    struct tl_cut_flared skirt_front, skirt_back;
    struct bodice_shape front, back;
};

/* The bust dart of the front: a wedge in the side seam whose legs are sewn together. It removes the
 * excess that would gape at the armhole: the part above it is rotated about the dart's tip by the dart's
 * angle. */
#define DART_ANGLE 0.17 /* radians */
static const struct tl_point dart_point = {0.108, 0.158};

static struct tl_point turned(struct tl_point p, double angle)
{
    double x = p.x - dart_point.x, y = p.y - dart_point.y, c = cos(angle), s = sin(angle);
    return (struct tl_point){dart_point.x + c * x - s * y, dart_point.y + s * x + c * y};
}

/* Undoes the dart's rotation of the part above it: by the full angle at the dart's leg, falling to zero
 * straight above its tip. */
static struct tl_point undarted(struct tl_point p)
{
    const double leg = -0.02; /* radians: between the dart's two legs */
    double side = p.x < 0 ? -1 : 1, angle = atan2(p.y - dart_point.y, side * p.x - dart_point.x);
    if (angle < leg || angle > 0.5 * M_PI)
        return p;
    double share = (0.5 * M_PI - angle) / (0.5 * M_PI - leg);
    struct tl_point q = turned((struct tl_point){side * p.x, p.y}, -DART_ANGLE * share);
    return (struct tl_point){side * q.x, q.y};
}

/* The ring point at `distance` from the piece's middle, to the right as seen from outside. */
static struct tl_point ring_point(const struct bodice_shape *bodice, const struct tl_ring *ring,
                                  double distance)
{
    return tl_ring_at(ring, bodice->facing > 0 ? distance : 0.5 * ring->length + distance);
}

static void place_bodice(const void *context, struct tl_point p, double position[3])
{
    const struct bodice_shape *bodice = context;
    if (bodice->darted)
        p = undarted(p);
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

/* Traces the profile around the shoulder in the plane x = STRAP_X, a centimetre off the form, by rays from a
 * point below the ridge. */
static void trace_profile(double underarm_y, double facing, struct dress_profile *out)
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

/* One half of a bodice piece, right side. The side seam is in two, front and back alike: the dart opens
 * between them. */
struct bodice_pattern {
    double waist_half, underarm_half;
    double neck_drop;  /* depth of the neckline below the shoulder seam's inner end */
    double chest_half; /* narrowest half-width between the armholes */
    double rise;       /* cloth from the waist over chest or back to the shoulder seam's middle */
};

enum { WAIST, SIDE_LOWER };                                       /* of both pieces */
enum { BACK_SIDE_UPPER = 2, BACK_SHOULDER = 4, BACK_CURVES = 6 }; /* without a dart */
enum { DART_LOWER = 2, DART_UPPER, FRONT_SIDE_UPPER, FRONT_SHOULDER = 6, FRONT_CURVES = 8 };

static void cut_sides(const struct bodice_pattern *pattern, struct tl_curve *waist, struct tl_curve *lower,
                      struct tl_curve *upper)
{
    const double dart_height = 0.66; /* along the side seam */
    struct tl_point corner = {pattern->waist_half, 0}, underarm = {pattern->underarm_half, UNDERARM};
    struct tl_point dart = {corner.x + dart_height * (underarm.x - corner.x), dart_height * UNDERARM};
    *waist = tl_curve_line((struct tl_point){0, 0}, corner);
    *lower = tl_curve_line(corner, dart);
    *upper = tl_curve_line(dart, underarm);
}

/* Armhole, shoulder seam and neckline, from the underarm on. */
static void cut_top(const struct bodice_pattern *pattern, struct tl_point underarm, struct tl_curve curves[3])
{
    struct tl_point tip = {STRAP_X + 0.026, pattern->rise - 0.010};
    struct tl_point neck = {STRAP_X - 0.026, pattern->rise + 0.008};
    struct tl_point scoop = {0, neck.y - pattern->neck_drop};
    double armhole = tip.y - underarm.y, chest = pattern->chest_half;
    curves[0] = (struct tl_curve){.control = {underarm,
                                              {chest + 0.2 * (underarm.x - chest), underarm.y + 0.01},
                                              {chest - 0.012, underarm.y + 0.45 * armhole},
                                              tip}};
    curves[1] = tl_curve_line(tip, neck);
    curves[2] = (struct tl_curve){
        .control = {
            neck, {neck.x - 0.004, neck.y - 0.6 * pattern->neck_drop}, {0.6 * neck.x, scoop.y}, scoop}};
}

static struct tl_cut_piece back_piece(const struct bodice_pattern *pattern, const struct bodice_shape *shape)
{
    struct tl_cut_piece piece = {
        .half_count = BACK_CURVES, .place = place_bodice, .context = shape, .material = "bodice"};
    cut_sides(pattern, &piece.half[WAIST], &piece.half[SIDE_LOWER], &piece.half[BACK_SIDE_UPPER]);
    cut_top(pattern, piece.half[BACK_SIDE_UPPER].control[3], &piece.half[BACK_SIDE_UPPER + 1]);
    return piece;
}

static struct tl_cut_piece front_piece(const struct bodice_pattern *pattern, const struct bodice_shape *shape)
{
    struct tl_cut_piece piece = {
        .half_count = FRONT_CURVES, .place = place_bodice, .context = shape, .material = "bodice"};
    struct tl_curve upper;
    cut_sides(pattern, &piece.half[WAIST], &piece.half[SIDE_LOWER], &upper);
    struct tl_point dart = upper.control[0], dart_turned = turned(dart, DART_ANGLE);
    struct tl_point underarm = turned(upper.control[3], DART_ANGLE);
    piece.half[DART_LOWER] = tl_curve_line(dart, dart_point);
    piece.half[DART_UPPER] = tl_curve_line(dart_point, dart_turned);
    piece.half[FRONT_SIDE_UPPER] = tl_curve_line(dart_turned, underarm);
    cut_top(pattern, underarm, &piece.half[FRONT_SIDE_UPPER + 1]);
    return piece;
}

enum { FRONT, BACK, SKIRT_FRONT, SKIRT_BACK, SKIRT_SIDE = 1, SKIRT_WAIST = 2 };

/* Sews the front's right curve to the back's left one and vice versa. */
static void sew_around(struct tl_cut_plan *plan, size_t front, size_t front_curve, size_t back,
                       size_t back_curve)
{
    tl_cut_sew(plan, front, front_curve, back, tl_cut_mirror(&plan->pieces[back], back_curve));
    tl_cut_sew(plan, back, back_curve, front, tl_cut_mirror(&plan->pieces[front], front_curve));
}

/* Two curves on the same side of the figure, both halves. */
static void sew_halves(struct tl_cut_plan *plan, size_t piece_a, size_t curve_a, size_t piece_b,
                       size_t curve_b)
{
    tl_cut_sew(plan, piece_a, curve_a, piece_b, curve_b);
    tl_cut_sew(plan, piece_a, tl_cut_mirror(&plan->pieces[piece_a], curve_a), piece_b,
               tl_cut_mirror(&plan->pieces[piece_b], curve_b));
}

struct tl_cut_range tl_cut_longer_dress(void)
{
    return (struct tl_cut_range){TL_CUT_SHORTEST_SKIRT_M - SKIRT_LENGTH, INFINITY};
}

struct tl_cut_plan tl_cut_plan_dress(const struct tl_cut_params *sizes)
{
    const double ease = (double)sizes->ease_m, waist_length = WAIST_LENGTH + ease;
    const double length = SKIRT_LENGTH + (double)sizes->longer_m;
    struct bodice_pattern front = {0.25 * waist_length, 0.235 + 0.25 * ease, 0.130, 0.140, 0};
    struct bodice_pattern back = {0.25 * waist_length, 0.235 + 0.25 * ease, 0.080, 0.145, 0};
    struct dress_placement *placement = TL_NEW(struct dress_placement);
    const double underarm_y = WAIST_Y + UNDERARM - 0.006; /* the sides slant */
    for (int i = 0; i < BODICE_RINGS; i++) {
        double t = (double)i / (BODICE_RINGS - 1);
        double bust = 2 * (front.underarm_half + back.underarm_half);
        tl_ring_around_form(WAIST_Y + (underarm_y - WAIST_Y) * t, waist_length + (bust - waist_length) * t,
                            &placement->rings[i]);
    }
    tl_flare_from_ring(&placement->rings[0], length, SKIRT_ANGLE, SKIRT_SLOPE, SKIRT_FOLDS,
                       &placement->flare);
    placement->skirt_front = (struct tl_cut_flared){&placement->flare, waist_length, SKIRT_ANGLE, 0};
    placement->skirt_back = (struct tl_cut_flared){&placement->flare, waist_length, SKIRT_ANGLE, 0.5};
    placement->front = (struct bodice_shape){.facing = 1, .darted = true, .rings = placement->rings};
    placement->back = (struct bodice_shape){.facing = -1, .rings = placement->rings};
    trace_profile(underarm_y, 1, &placement->front.profile);
    trace_profile(underarm_y, -1, &placement->back.profile);
    front.rise = UNDERARM + placement->front.profile.length;
    back.rise = UNDERARM + placement->back.profile.length;

    struct tl_cut_plan plan = {.name = "dress", .piece_count = 4, .placement = placement};
    plan.pieces[FRONT] = front_piece(&front, &placement->front);
    plan.pieces[BACK] = back_piece(&back, &placement->back);
    plan.pieces[SKIRT_FRONT] = tl_cut_flared_piece(&placement->skirt_front);
    plan.pieces[SKIRT_BACK] = tl_cut_flared_piece(&placement->skirt_back);
    plan.pieces[BACK].table_offset.x = 0.7;
    plan.pieces[SKIRT_BACK].table_offset.x = 1.2;
    sew_halves(&plan, FRONT, DART_LOWER, FRONT, DART_UPPER);
    sew_around(&plan, FRONT, SIDE_LOWER, BACK, SIDE_LOWER);
    sew_around(&plan, FRONT, FRONT_SIDE_UPPER, BACK, BACK_SIDE_UPPER);
    sew_around(&plan, FRONT, FRONT_SHOULDER, BACK, BACK_SHOULDER);
    sew_around(&plan, SKIRT_FRONT, SKIRT_SIDE, SKIRT_BACK, SKIRT_SIDE);
    sew_halves(&plan, FRONT, WAIST, SKIRT_FRONT, SKIRT_WAIST);
    sew_halves(&plan, BACK, WAIST, SKIRT_BACK, SKIRT_WAIST);
    return plan;
}

/* Waves along its width, nearly as long as the cloth is wide. */
static void place_curtain(const void *context, struct tl_point p, double position[3])
{
    (void)context;
    double phase = 2 * M_PI * CURTAIN_FOLDS * p.x / CURTAIN_WIDTH, across = CURTAIN_GATHER * p.x;
    position[0] = CURTAIN_X + across;
    position[1] = CURTAIN_Y + p.y;
    position[2] = CURTAIN_Z + CURTAIN_DEPTH * sin(phase);
}

static struct tl_cut_piece curtain_piece(void)
{
    const struct tl_point bottom = {0, -CURTAIN_LENGTH}, top = {0, 0};
    const struct tl_point lower = {CURTAIN_WIDTH / 2, -CURTAIN_LENGTH}, upper = {CURTAIN_WIDTH / 2, 0};
    return (struct tl_cut_piece){
        .half = {tl_curve_line(bottom, lower), tl_curve_line(lower, upper), tl_curve_line(upper, top)},
        .half_count = 3,
        .place = place_curtain,
        .material = "overlay",
    };
}

/* The dress, and a gathered curtain in front of its left side that does not touch it. */
struct tl_cut_plan tl_cut_plan_layers(const struct tl_cut_params *sizes)
{
    enum { CURTAIN = 4, TOP = 2 };
    struct tl_cut_plan plan = tl_cut_plan_dress(sizes);
    plan.name = "layers";
    plan.piece_count = CURTAIN + 1;
    plan.pieces[CURTAIN] = curtain_piece();
    plan.pieces[CURTAIN].table_offset.x = 2.6;
    plan.pins[plan.pin_count++] = (struct tl_cut_pin){CURTAIN, TOP};
    plan.pins[plan.pin_count++] = (struct tl_cut_pin){CURTAIN, tl_cut_mirror(&plan.pieces[CURTAIN], TOP)};
    return plan;
}
