#include "assets/halfmesh/sector.h"

#include <math.h>

/* Ratio of a triangle's height to its longest side (0.87 at best): flatter ones are needles. */
#define NEEDLE 0.15
#define BEST   0.866
/* Rise of an outline's vertex over the chord that replaces it, to the chord: a turn of 27 degrees. */
#define OUTLINE_RISE 0.12
/* Radians by which the angles of a closed sector may differ from a full turn. */
#define CURVED 1.0

static const double hub[2] = {0, 0}; /* as laid out */

static double cross(const double a[2], const double b[2])
{
    return a[0] * b[1] - a[1] * b[0];
}

static void subtract(const double a[2], const double b[2], double out[2])
{
    out[0] = a[0] - b[0];
    out[1] = a[1] - b[1];
}

static double length_of(const double a[2])
{
    return sqrt(a[0] * a[0] +
                a[1] * a[1]); /* lengths of cloth: hypot's care for overflow takes half the time */
}

static double distance(const double a[2], const double b[2])
{
    double side[2];
    subtract(b, a, side);
    return length_of(side);
}

/* Twice the area; positive when a, b, c run counter-clockwise. */
static double area_of(const double a[2], const double b[2], const double c[2])
{
    double side[2], other[2];
    subtract(b, a, side);
    subtract(c, a, other);
    return cross(side, other);
}

/* Height over longest side; negative when turned over. */
static double shape_of(const double a[2], const double b[2], const double c[2])
{
    double longest = fmax(distance(a, b), fmax(distance(b, c), distance(c, a)));
    return longest > 0 ? area_of(a, b, c) / (longest * longest) : 0;
}

static size_t spoke_after(const struct tl_sector *sector, size_t face)
{
    return sector->closed && face + 1 == sector->face_count ? 0 : face + 1;
}

static size_t spoke_count(const struct tl_sector *sector)
{
    return sector->face_count + !sector->closed;
}

/* A side from a face's hub, in its own frame or the mirror image of that. */
static void side_of(const struct tl_sector *sector, size_t face, int end, double out[2])
{
    subtract(sector->rest[face][end], sector->rest[face][0], out);
    if (sector->mirrored)
        out[1] = -out[1];
}

/* The angle at the hub. */
static double angle_of(const struct tl_sector *sector, size_t face)
{
    double a[2], b[2];
    side_of(sector, face, 1, a);
    side_of(sector, face, 2, b);
    return atan2(cross(a, b), a[0] * b[0] + a[1] * b[1]);
}

/* The mean of the turns of the frames, by area. */
static void find_turn(struct tl_sector *sector)
{
    double sum[2] = {0, 0};
    for (size_t i = 0; i < sector->face_count; i++) {
        double a[2], b[2];
        const double *spoke = sector->spokes[i];
        side_of(sector, i, 1, a);
        side_of(sector, i, 2, b);
        double weight = cross(a, b) / (length_of(a) * length_of(spoke));
        sum[0] += weight * (a[0] * spoke[0] + a[1] * spoke[1]);
        sum[1] += weight * cross(a, spoke);
    }
    double length = length_of(sum);
    sector->turn[0] = length > 0 ? sum[0] / length : 1;
    sector->turn[1] = length > 0 ? sum[1] / length : 0;
}

bool tl_sector_lay_out(struct tl_sector *sector)
{
    const size_t count = sector->face_count;
    double angles[TL_SECTOR_FACES], total = 0;
    sector->mirrored = area_of(sector->rest[0][0], sector->rest[0][1], sector->rest[0][2]) < 0;
    for (size_t i = 0; i < count; i++) {
        angles[i] = angle_of(sector, i);
        if (!(angles[i] > 0))
            return false;
        total += angles[i];
    }
    const double turn = 2 * M_PI;
    if (sector->closed ? fabs(total - turn) > CURVED : total > turn)
        return false;
    double scale = sector->closed ? turn / total : 1, angle = 0;
    for (size_t i = 0; i < spoke_count(sector); i++) {
        /* Both faces at a spoke know its length; they differ where the rest shapes do not fit together. */
        size_t before = i > 0 ? i - 1 : count - 1;
        bool has_before = i > 0 || sector->closed, has_after = i < count;
        double length = 0, side[2];
        if (has_after) {
            side_of(sector, i, 1, side);
            length += length_of(side);
        }
        if (has_before) {
            side_of(sector, before, 2, side);
            length += length_of(side);
        }
        length /= has_before + has_after;
        sector->spokes[i][0] = length * cos(angle);
        sector->spokes[i][1] = length * sin(angle);
        angle += i < count ? scale * angles[i] : 0;
    }
    find_turn(sector);
    return true;
}

bool tl_sector_keeps(const struct tl_sector *sector, size_t target, size_t face)
{
    return face != target && spoke_after(sector, face) != target;
}

/* Whether the outline keeps its shape when the chord between the ends of an open sector replaces the hub. */
static bool outline_stays(const struct tl_sector *sector, size_t target)
{
    const double *end = sector->spokes[target == 0 ? sector->face_count : 0], *at = sector->spokes[target];
    double chord = distance(end, at), dot = end[0] * at[0] + end[1] * at[1];
    return dot < 0 && fabs(cross(end, at)) <= OUTLINE_RISE * chord * chord;
}

double tl_sector_judge(const struct tl_sector *sector, size_t target)
{
    const double *to = sector->spokes[target];
    double longest = 0, shape = BEST, shape_before = BEST;
    size_t kept = 0;
    for (size_t i = 0; i < sector->face_count; i++) {
        const double *a = sector->spokes[i], *b = sector->spokes[spoke_after(sector, i)];
        shape_before = fmin(shape_before, shape_of(hub, a, b));
        if (!tl_sector_keeps(sector, target, i))
            continue;
        kept++;
        shape = fmin(shape, shape_of(to, a, b));
        longest = fmax(longest, fmax(distance(to, a), distance(to, b)));
    }
    bool shaped = shape >= NEEDLE || (shape > 0 && shape >= shape_before);
    if (kept == 0 || !shaped || (!sector->closed && !outline_stays(sector, target)))
        return -1;
    return longest * sqrt(BEST / shape);
}

/* A laid-out triangle in the faces' frames. */
static void turn_back(const struct tl_sector *sector, const double *const corners[3], double rest[3][2])
{
    const double cosine = sector->turn[0], sine = sector->turn[1];
    for (int i = 0; i < 3; i++) { /* turned back */
        rest[i][0] = cosine * corners[i][0] + sine * corners[i][1];
        rest[i][1] = cosine * corners[i][1] - sine * corners[i][0];
        if (sector->mirrored)
            rest[i][1] = -rest[i][1];
    }
}

void tl_sector_rest(const struct tl_sector *sector, size_t target, size_t face, double rest[3][2])
{
    const double *const corners[3] = {sector->spokes[target], sector->spokes[face],
                                      sector->spokes[spoke_after(sector, face)]};
    turn_back(sector, corners, rest);
}

/* The position at which the point with these weights in face `from` is laid out. */
static void lay_point(const struct tl_sector *sector, size_t from, const double weights[3], double point[2])
{
    const double *first = sector->spokes[from], *second = sector->spokes[spoke_after(sector, from)];
    for (int c = 0; c < 2; c++)
        point[c] = weights[1] * first[c] + weights[2] * second[c];
}

/* The weights of a point in a triangle; returns the smallest. */
static double weigh(const double *const corners[3], const double point[2], double weights[3])
{
    const double *a = corners[0], *b = corners[1], *c = corners[2];
    double area = area_of(a, b, c);
    weights[0] = area_of(point, b, c) / area;
    weights[1] = area_of(a, point, c) / area;
    weights[2] = area_of(a, b, point) / area;
    return fmin(weights[0], fmin(weights[1], weights[2]));
}

size_t tl_sector_locate(const struct tl_sector *sector, size_t target, size_t from, const double weights[3],
                        double found[3], double *inside)
{
    double point[2], here[3];
    size_t best = 0;
    lay_point(sector, from, weights, point);
    *inside = -INFINITY;
    for (size_t i = 0; i < sector->face_count; i++) {
        if (!tl_sector_keeps(sector, target, i))
            continue;
        const double *const corners[3] = {sector->spokes[target], sector->spokes[i],
                                          sector->spokes[spoke_after(sector, i)]};
        double minimum = weigh(corners, point, here);
        if (!(minimum > *inside))
            continue;
        *inside = minimum;
        best = i;
        for (int k = 0; k < 3; k++)
            found[k] = here[k];
    }
    return best;
}

/* ---- Flips ---- */

struct flipped {
    const double *corners[3];
};

static struct flipped flipped_face(const struct tl_sector *sector, size_t face)
{
    const double(*s)[2] = sector->spokes;
    return face == TL_FLIPPED_HUB ? (struct flipped){{hub, s[0], s[2]}}
                                  : (struct flipped){{s[1], s[2], s[0]}};
}

/* The angle at a of the triangle a b c. */
static double corner_angle(const double a[2], const double b[2], const double c[2])
{
    double side[2], other[2];
    subtract(b, a, side);
    subtract(c, a, other);
    return atan2(cross(side, other), side[0] * other[0] + side[1] * other[1]);
}

bool tl_sector_should_flip(const struct tl_sector *sector)
{
    const double rounding = 1e-6;
    const double(*s)[2] = sector->spokes;
    for (size_t face = 0; face < 2; face++) {
        const struct flipped flipped = flipped_face(sector, face);
        if (!(shape_of(flipped.corners[0], flipped.corners[1], flipped.corners[2]) > NEEDLE))
            return false;
    }
    return corner_angle(s[0], s[1], hub) + corner_angle(s[2], hub, s[1]) > M_PI + rounding;
}

void tl_sector_flipped_rest(const struct tl_sector *sector, size_t face, double rest[3][2])
{
    const struct flipped flipped = flipped_face(sector, face);
    turn_back(sector, flipped.corners, rest);
}

size_t tl_sector_flipped_locate(const struct tl_sector *sector, size_t from, const double weights[3],
                                double found[3])
{
    double point[2], other[3];
    lay_point(sector, from, weights, point);
    double inside = weigh(flipped_face(sector, TL_FLIPPED_HUB).corners, point, found);
    if (weigh(flipped_face(sector, TL_FLIPPED_FAR).corners, point, other) <= inside)
        return TL_FLIPPED_HUB;
    for (int k = 0; k < 3; k++)
        found[k] = other[k];
    return TL_FLIPPED_FAR;
}
