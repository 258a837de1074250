#include "assets/body/wrap.h"

#include "assets/base/version.h"
#include "assets/body/form.h"
#include "config/cache/cache.h"

#include <math.h>

/* Replaces a closed polyline by `steps` points at equal distances, beginning at its first; returns its
 * length.
 */
static double even_out(const struct tl_point *from, int count, struct tl_point *to, int steps)
{
    double total = 0, walked = 0;
    for (int i = 0; i < count; i++)
        total += hypot(from[(i + 1) % count].x - from[i].x, from[(i + 1) % count].y - from[i].y);
    int i = 0;
    double next = hypot(from[1].x - from[0].x, from[1].y - from[0].y);
    for (int k = 0; k < steps; k++) {
        double wanted = total * k / steps;
        while (i < count - 1 && walked + next < wanted) {
            walked += next;
            i++;
            next = hypot(from[(i + 1) % count].x - from[i].x, from[(i + 1) % count].y - from[i].y);
        }
        double t = next > 0 ? (wanted - walked) / next : 0;
        struct tl_point a = from[i], b = from[(i + 1) % count];
        to[k] = (struct tl_point){a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t};
    }
    to[steps] = to[0];
    return total;
}

void tl_ring_around(const struct tl_point *section, int count, double girth, bool symmetric, double length,
                    struct tl_ring *out)
{
    enum { DIRECTIONS = 1024 };
    struct tl_point hull[DIRECTIONS];
    /* The hull, moved outwards by d, is the support point of every direction moved by d; Cauchy: 2 pi d
     * longer. */
    double off = (length - girth) / (2 * M_PI);
    for (int k = 0; k < DIRECTIONS; k++) {
        double angle = 2 * M_PI * k / DIRECTIONS, x = sin(angle), z = cos(angle);
        struct tl_point best = section[0];
        for (int i = 1; i < count; i++) {
            if (section[i].x * x + section[i].y * z > best.x * x + best.y * z)
                best = section[i];
        }
        hull[k] = (struct tl_point){best.x + off * x, best.y + off * z};
    }
    if (symmetric)
        hull[0].x = 0; /* where the hull is a straight line in front, begin in its middle */
    out->length = even_out(hull, DIRECTIONS, out->points, TL_RING_STEPS);
}

void tl_ring_around_form(double y, double length, struct tl_ring *out)
{
    enum { SECTION = 256 };
    struct tl_point section[SECTION];
    const double order[] = {y, length};
    struct tl_cache_key key = tl_cache_key_begin();
    tl_cache_key_add(&key, TL_BUILTIN_VERSION, sizeof TL_BUILTIN_VERSION);
    tl_cache_key_add(&key, order, sizeof order);
    if (tl_cache_read(&key, out, sizeof *out))
        return;
    *out = (struct tl_ring){0};
    for (int i = 0; i < SECTION; i++) {
        double angle = 2 * M_PI * i / SECTION, r = tl_form_radius(y, angle);
        section[i] = (struct tl_point){-r * sin(angle), -r * cos(angle)};
    }
    out->y = y;
    tl_ring_around(section, SECTION, tl_form_girth(y), true, length, out);
    tl_cache_store(&key, out, sizeof *out);
}

static struct tl_point mix(struct tl_point a, struct tl_point b, double t)
{
    return (struct tl_point){a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t};
}

static struct tl_point at_fraction(const struct tl_point *points, int steps, double fraction)
{
    double place = (fraction - floor(fraction)) * steps;
    int i = (int)place < steps ? (int)place : steps - 1;
    return mix(points[i], points[i + 1], place - i);
}

struct tl_point tl_ring_at(const struct tl_ring *ring, double distance)
{
    return at_fraction(ring->points, TL_RING_STEPS, distance / ring->length);
}

/* The ring in the directions of a flare, the same for all its rows. Directions turn evenly along the ring,
 * which keeps the cone of an oval waist nearly as developable as a round one's. The fold's phase varies a
 * little: real folds are not evenly spaced. */
struct flare_steps {
    struct tl_point base[TL_FLARE_STEPS], out[TL_FLARE_STEPS]; /* `out` is a unit vector */
    double fold[TL_FLARE_STEPS];                               /* -1 to 1 */
};

static void fill_steps(const struct tl_ring *ring, int folds, struct flare_steps *steps)
{
    for (int k = 0; k < TL_FLARE_STEPS; k++) {
        double turn = 2 * M_PI * k / TL_FLARE_STEPS;
        steps->base[k] = at_fraction(ring->points, TL_RING_STEPS, (double)k / TL_FLARE_STEPS);
        steps->out[k] = (struct tl_point){sin(turn), cos(turn)};
        steps->fold[k] = cos(folds * turn + 0.3 * sin(2 * turn + 0.7) + 0.2 * sin(3 * turn + 2));
    }
}

/* One row: the ring moved outwards by `out`, waved by `wave`. */
static double waved_row(const struct flare_steps *steps, double out, double wave, struct tl_point *row)
{
    struct tl_point raw[TL_FLARE_STEPS];
    for (int k = 0; k < TL_FLARE_STEPS; k++) {
        double reach = out + wave * steps->fold[k];
        raw[k] = (struct tl_point){steps->base[k].x + reach * steps->out[k].x,
                                   steps->base[k].y + reach * steps->out[k].y};
    }
    return even_out(raw, TL_FLARE_STEPS, row, TL_FLARE_STEPS);
}

void tl_flare_from_ring(const struct tl_ring *ring, double length, double full_angle, double slope, int folds,
                        struct tl_flare *out)
{
    struct flare_steps steps;
    fill_steps(ring, folds, &steps);
    out->length = length;
    for (int i = 0; i < TL_FLARE_ROWS; i++) {
        double down = length * i / (TL_FLARE_ROWS - 1), wanted = ring->length + full_angle * down;
        double low = 0, high = down;
        for (int step = 0; step < 30; step++) {
            double wave = 0.5 * (low + high);
            if (waved_row(&steps, down * sin(slope), wave, out->points[i]) < wanted)
                low = wave;
            else
                high = wave;
        }
        out->y[i] = ring->y - down * cos(slope);
    }
}

void tl_flare_at(const struct tl_flare *flare, double fraction, double down, double position[3])
{
    double place = fmin(fmax(down / flare->length, 0), 1) * (TL_FLARE_ROWS - 1);
    int i = (int)place < TL_FLARE_ROWS - 1 ? (int)place : TL_FLARE_ROWS - 2;
    struct tl_point p = mix(at_fraction(flare->points[i], TL_FLARE_STEPS, fraction),
                            at_fraction(flare->points[i + 1], TL_FLARE_STEPS, fraction), place - i);
    position[0] = p.x;
    position[1] = flare->y[i] + (flare->y[i + 1] - flare->y[i]) * (place - i);
    position[2] = p.y;
}
