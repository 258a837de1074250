#include "assets/body/form.h"
#include "assets/cut/garment_cut_internal.h"

#include "config/base/memory.h"

#include <math.h>

/* A full circle skirt: two half rings, sewn at the sides, pinned along the waist. */
#define SKIRT_LENGTH 0.60 /* metres */
#define SKIRT_Y      1.045
#define SKIRT_EASE   0.030 /* waistband less the form's girth: it sits half a centimetre off the canvas */
#define SKIRT_SLOPE  0.60  /* radians, of the start shape */
#define SKIRT_FOLDS  9     /* of the start shape: with more, or fewer, they cross as they fall */

static void place_flared(const void *context, struct tl_point p, double position[3])
{
    const struct tl_cut_flared *flared = context;
    double angle = atan2(p.x, -p.y), waist_radius = flared->waist_length / flared->full_angle;
    tl_flare_at(flared->flare, flared->turn + angle / flared->full_angle, hypot(p.x, p.y) - waist_radius,
                position);
}

/* An arc around (0, 0) as a cubic, from one angle (measured from -y towards +x) to another: k = 4/3 tan(sweep
 * / 4) keeps the radius within 0.03 % up to a quarter circle. */
static struct tl_curve arc(double radius, double from, double to)
{
    double k = 4.0 / 3 * tan((to - from) / 4) * radius;
    struct tl_point a = {radius * sin(from), -radius * cos(from)};
    struct tl_point b = {radius * sin(to), -radius * cos(to)};
    return (struct tl_curve){
        .control = {
            a, {a.x + k * cos(from), a.y + k * sin(from)}, {b.x - k * cos(to), b.y - k * sin(to)}, b}};
}

struct tl_cut_piece tl_cut_flared_piece(const struct tl_cut_flared *flared)
{
    double waist = flared->waist_length / flared->full_angle, hem = waist + flared->flare->length;
    double side = flared->full_angle / 4;
    struct tl_curve bottom = arc(hem, 0, side), top = arc(waist, side, 0);
    return (struct tl_cut_piece){
        .half = {bottom, tl_curve_line(bottom.control[3], top.control[0]), top},
        .half_count = 3,
        .place = place_flared,
        .context = flared,
        .material = "skirt",
    };
}

struct skirt_placement {
    struct tl_flare flare;
    struct tl_cut_flared front, back;
};

struct tl_cut_range tl_cut_longer_skirt(void)
{
    return (struct tl_cut_range){TL_CUT_SHORTEST_SKIRT_M - SKIRT_LENGTH, INFINITY};
}

struct tl_cut_plan tl_cut_plan_skirt(const struct tl_cut_params *sizes)
{
    struct skirt_placement *placement = TL_NEW(struct skirt_placement);
    double waist = tl_form_girth(SKIRT_Y) + SKIRT_EASE + (double)sizes->ease_m;
    double length = SKIRT_LENGTH + (double)sizes->longer_m;
    struct tl_ring ring;
    tl_ring_around_form(SKIRT_Y, waist, &ring);
    tl_flare_from_ring(&ring, length, 2 * M_PI, SKIRT_SLOPE, SKIRT_FOLDS, &placement->flare);
    placement->front = (struct tl_cut_flared){&placement->flare, waist, 2 * M_PI, 0};
    placement->back = (struct tl_cut_flared){&placement->flare, waist, 2 * M_PI, 0.5};

    struct tl_cut_plan plan = {.name = "skirt", .piece_count = 2, .placement = placement};
    enum { FRONT, BACK, SIDE = 1, WAIST = 2 };
    plan.pieces[FRONT] = tl_cut_flared_piece(&placement->front);
    plan.pieces[BACK] = tl_cut_flared_piece(&placement->back);
    plan.pieces[BACK].table_offset.x = 1.6;
    size_t left_side = tl_cut_mirror(&plan.pieces[FRONT], SIDE), left_waist = left_side - 1;
    plan.seams[plan.seam_count++] = (struct tl_cut_seam){FRONT, SIDE, BACK, left_side};
    plan.seams[plan.seam_count++] = (struct tl_cut_seam){BACK, SIDE, FRONT, left_side};
    for (size_t piece = FRONT; piece <= BACK; piece++) {
        plan.pins[plan.pin_count++] = (struct tl_cut_pin){piece, WAIST};
        plan.pins[plan.pin_count++] = (struct tl_cut_pin){piece, left_waist};
    }
    return plan;
}
