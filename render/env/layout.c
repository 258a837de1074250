#include "render/env/layout.h"

#include "render/env/cube.h"

#include <assert.h>
#include <math.h>

const char *const tl_layout_names[TL_LAYOUT_COUNT + 1] = {"cube",    "sphere",     "paraboloid",
                                                          "latlong", "octahedral", NULL};

void tl_layout_extent(enum tl_layout layout, int size, int64_t *width, int64_t *height)
{
    bool wide = layout == TL_LAYOUT_LATLONG || layout == TL_LAYOUT_PARABOLOID;
    *width = (wide ? 2 : 1) * (int64_t)size;
    *height = (layout == TL_LAYOUT_CUBE ? 6 : 1) * (int64_t)size;
}

int tl_layout_size(const struct tl_sphere_map *map)
{
    return map->layout == TL_LAYOUT_CUBE ? map->width : map->height;
}

/* A disc of a picture: left border and radius (texels) and the side from which its mirror is seen. */
struct disc {
    double left, radius;
    double side; /* 1 from +Z, -1 from -Z */
};

static struct disc disc_at(const struct tl_sphere_map *map, double x)
{
    bool behind = map->layout == TL_LAYOUT_PARABOLOID && x >= map->height;
    return (struct disc){behind ? map->height : 0, 0.5 * map->height, behind ? -1 : 1};
}

/* Point of the unit disc, y up. */
static void to_disc(const struct disc *disc, double x, double y, double point[2])
{
    point[0] = (x - disc->left) / disc->radius - 1;
    point[1] = 1 - y / disc->radius;
}

static vec3s direction_on_latlong(const struct tl_sphere_map *map, double x, double y)
{
    double phi = 2 * M_PI * (x / map->width - 0.5), theta = M_PI * y / map->height;
    return (vec3s){{(float)(sin(theta) * sin(phi)), (float)cos(theta), (float)(-sin(theta) * cos(phi))}};
}

static vec3s direction_on_cube(const struct tl_sphere_map *map, double x, double y)
{
    int face = (int)fmin(y / map->width, 5);
    return glms_vec3_normalize(
        tl_cube_direction(face, (float)(x / map->width), (float)(y / map->width - face)));
}

static vec3s sphere_direction(const double point[2])
{
    double square = point[0] * point[0] + point[1] * point[1];
    double half_z = sqrt(fmax(1 - square, 0)); /* of h; the direction is 2 (h.z) h - z */
    return (vec3s){
        {(float)(2 * half_z * point[0]), (float)(2 * half_z * point[1]), (float)(2 * half_z * half_z - 1)}};
}

static vec3s paraboloid_direction(const double point[2], double side)
{
    double square = point[0] * point[0] + point[1] * point[1], scale = 2 / (1 + square);
    return (vec3s){{(float)(side * scale * point[0]), (float)(scale * point[1]),
                    (float)(side * (1 - square) / (1 + square))}};
}

/* Point of the octahedron, not normalised: its coordinates' magnitudes sum to 1. */
static void octahedron_point(const struct tl_sphere_map *map, double x, double y, double point[3])
{
    double u = 2 * x / map->width - 1, v = 2 * y / map->height - 1;
    point[1] = 1 - fabs(u) - fabs(v);
    point[0] = point[1] >= 0 ? u : copysign(1 - fabs(v), u);
    point[2] = point[1] >= 0 ? v : copysign(1 - fabs(u), v);
}

static vec3s octahedral_direction(const struct tl_sphere_map *map, double x, double y)
{
    double point[3];
    octahedron_point(map, x, y, point);
    double length = sqrt(point[0] * point[0] + point[1] * point[1] + point[2] * point[2]);
    return (vec3s){{(float)(point[0] / length), (float)(point[1] / length), (float)(point[2] / length)}};
}

vec3s tl_layout_direction(const struct tl_sphere_map *map, double x, double y)
{
    if (map->layout == TL_LAYOUT_LATLONG)
        return direction_on_latlong(map, x, y);
    if (map->layout == TL_LAYOUT_OCTAHEDRAL)
        return octahedral_direction(map, x, y);
    if (map->layout == TL_LAYOUT_CUBE)
        return direction_on_cube(map, x, y);
    struct disc disc = disc_at(map, x);
    double point[2];
    to_disc(&disc, x, y, point);
    return map->layout == TL_LAYOUT_SPHERE ? sphere_direction(point) : paraboloid_direction(point, disc.side);
}

/* The half angle from atan2 of both components: z alone loses precision near the axis. */
static void sphere_locate(vec3s direction, double point[2])
{
    double x = (double)direction.x, y = (double)direction.y, z = (double)direction.z;
    double across = hypot(x, y), radius = sin(0.5 * atan2(across, z));
    point[0] = across > 0 ? radius * x / across : radius;
    point[1] = across > 0 ? radius * y / across : 0;
}

/* Below the horizon 1 - |v| = |u| + |y|. */
static void octahedral_locate(vec3s direction, double *u, double *v)
{
    double x = (double)direction.x, y = (double)direction.y, z = (double)direction.z;
    double sum = fabs(x) + fabs(y) + fabs(z), outwards = fmax(-y / sum, 0);
    *u = x / sum + copysign(outwards, x);
    *v = z / sum + copysign(outwards, z);
}

int tl_layout_locate(const struct tl_sphere_map *map, vec3s direction, double *x, double *y)
{
    if (map->layout == TL_LAYOUT_OCTAHEDRAL) {
        double u, v;
        octahedral_locate(direction, &u, &v);
        *x = map->width * (0.5 + 0.5 * u);
        *y = map->height * (0.5 + 0.5 * v);
        return 0;
    }
    if (map->layout == TL_LAYOUT_LATLONG) {
        double x0 = (double)direction.x, y0 = (double)direction.y, z0 = (double)direction.z;
        *x = map->width * (0.5 + atan2(x0, -z0) / (2 * M_PI));
        *y = map->height * atan2(hypot(x0, z0), y0) /
             M_PI; /* atan2, because acos loses half of its digits at the poles */
        return 0;
    }
    if (map->layout == TL_LAYOUT_CUBE) {
        int face;
        float s, t;
        tl_cube_locate(direction, &face, &s, &t);
        *x = map->width * (double)s;
        *y = fmin(map->width * (face + (double)t),
                  nextafter(map->width * (face + 1.0), 0)); /* stays on this face */
        return face;
    }
    double point[2];
    bool behind = map->layout == TL_LAYOUT_PARABOLOID && direction.z < 0;
    if (map->layout == TL_LAYOUT_SPHERE) {
        sphere_locate(direction, point);
    } else {
        double scale = 1 / (1 + fabs((double)direction.z));
        point[0] = (behind ? -scale : scale) * (double)direction.x;
        point[1] = scale * (double)direction.y;
    }
    double radius = 0.5 * map->height;
    *x = (behind ? map->height : 0) + radius * (1 + point[0]);
    *y = radius * (1 - point[1]);
    return behind;
}

static int clamp_index(double value, int begin, int end)
{
    return value < begin ? begin : value >= end ? end - 1 : (int)value;
}

size_t tl_layout_texel(const struct tl_sphere_map *map, vec3s direction)
{
    double x, y;
    int piece = tl_layout_locate(map, direction, &x, &y);
    struct tl_layout_piece bounds = tl_layout_piece(map, piece);
    return (size_t)clamp_index(y, bounds.y0, bounds.y1) * (size_t)map->width +
           (size_t)clamp_index(x, bounds.x0, bounds.x1);
}

struct tl_layout_piece tl_layout_piece(const struct tl_sphere_map *map, int piece)
{
    int side = tl_layout_size(map);
    if (map->layout == TL_LAYOUT_CUBE)
        return (struct tl_layout_piece){0, piece * side, side, (piece + 1) * side};
    if (map->layout == TL_LAYOUT_PARABOLOID)
        return (struct tl_layout_piece){piece * side, 0, (piece + 1) * side, side};
    return (struct tl_layout_piece){0, 0, map->width, map->height};
}

double tl_layout_density(const struct tl_sphere_map *map, double x, double y)
{
    if (map->layout == TL_LAYOUT_LATLONG)
        return sin(M_PI * y / map->height);
    if (map->layout == TL_LAYOUT_CUBE) {
        double u = 2 * x / map->width - 1, v = 2 * (y / map->width - floor(y / map->width)) - 1;
        return pow(1 + u * u + v * v, -1.5);
    }
    if (map->layout == TL_LAYOUT_SPHERE)
        return 1;
    if (map->layout == TL_LAYOUT_OCTAHEDRAL) {
        double point[3];
        octahedron_point(map, x, y, point);
        return pow(point[0] * point[0] + point[1] * point[1] + point[2] * point[2], -1.5);
    }
    struct disc disc = disc_at(map, x);
    double point[2];
    to_disc(&disc, x, y, point);
    double square = point[0] * point[0] + point[1] * point[1];
    return 1 / ((1 + square) * (1 + square));
}

static bool has_discs(enum tl_layout layout)
{
    return layout == TL_LAYOUT_SPHERE || layout == TL_LAYOUT_PARABOLOID;
}

bool tl_layout_contains(const struct tl_sphere_map *map, double x, double y)
{
    if (!has_discs(map->layout))
        return true;
    struct disc disc = disc_at(map, x);
    double point[2];
    to_disc(&disc, x, y, point);
    return point[0] * point[0] + point[1] * point[1] <= 1;
}

void tl_layout_nearest(const struct tl_sphere_map *map, const struct tl_layout_cell *cell, double *x,
                       double *y)
{
    bool round = has_discs(map->layout);
    double middle_x = 0.5 * (cell->x0 + cell->x1), middle_y = 0.5 * (cell->y0 + cell->y1);
    double radius = 0.5 * map->height;
    *x = round ? fmin(fmax(disc_at(map, middle_x).left + radius, cell->x0), cell->x1) : middle_x;
    *y = round ? fmin(fmax(radius, cell->y0), cell->y1) : middle_y;
}

/* Signed solid angle between the centre of a disc and a straight segment that lies inside of the disc. */
static double inner_piece(enum tl_layout layout, const double a[2], const double b[2])
{
    double twice_area = a[0] * b[1] - a[1] * b[0];
    if (layout == TL_LAYOUT_SPHERE)
        return 2 * twice_area;
    double along[2] = {b[0] - a[0], b[1] - a[1]}, length = hypot(along[0], along[1]);
    if (length <= 0)
        return 0;
    double distance = twice_area / length, reach = sqrt(1 + distance * distance);
    double from = (a[0] * along[0] + a[1] * along[1]) / length;
    return 2 * distance / reach * (atan((from + length) / reach) - atan(from / reach));
}

/* Outside of the disc the segment is replaced by the rim. */
static double outer_piece(enum tl_layout layout, const double a[2], const double b[2])
{
    double angle = atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
    return layout == TL_LAYOUT_SPHERE ? 2 * angle : angle;
}

/* A straight segment from `a` to `b`, split where it crosses the rim. */
static double line_solid_angle(enum tl_layout layout, const double a[2], const double b[2])
{
    double along[2] = {b[0] - a[0], b[1] - a[1]};
    double square = along[0] * along[0] + along[1] * along[1];
    double middle = -(a[0] * along[0] + a[1] * along[1]) / square;
    double discriminant = middle * middle - (a[0] * a[0] + a[1] * a[1] - 1) / square;
    double reach = sqrt(fmax(discriminant, 0));
    const double parts[4] = {0, fmin(fmax(middle - reach, 0), 1), fmin(fmax(middle + reach, 0), 1), 1};
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        double begin[2] = {a[0] + parts[i] * along[0], a[1] + parts[i] * along[1]};
        double end[2] = {a[0] + parts[i + 1] * along[0], a[1] + parts[i + 1] * along[1]};
        sum += i == 1 ? inner_piece(layout, begin, end) : outer_piece(layout, begin, end);
    }
    return sum;
}

static double disc_solid_angle(const struct tl_sphere_map *map, const struct tl_layout_cell *cell)
{
    double near_x, near_y, sum = 0;
    tl_layout_nearest(map, cell, &near_x, &near_y);
    if (!tl_layout_contains(map, near_x, near_y))
        return 0; /* not a rounding residue */
    struct disc disc = disc_at(map, 0.5 * (cell->x0 + cell->x1));
    double corners[4][2];
    for (int i = 0; i < 4; i++) /* anticlockwise */
        to_disc(&disc, i == 1 || i == 2 ? cell->x1 : cell->x0, i < 2 ? cell->y1 : cell->y0, corners[i]);
    for (int i = 0; i < 4; i++)
        sum += line_solid_angle(map->layout, corners[i], corners[(i + 1) % 4]);
    return fmax(sum, 0);
}

/* Signed solid angle of the rectangle between the centre of a cube's face at distance 1 and (u, v) on it. */
static double corner_solid_angle(double u, double v)
{
    return atan2(u * v, sqrt(u * u + v * v + 1));
}

/* A convex polygon on one face of the octahedron: u, v >= 0 and u + v <= 1 stand for (u, 1 - u - v, v). */
struct face_outline {
    double points[6][2];
    int count;
};

/* Solid angle by [Van Oosterom and Strackee 1983, eq. 8]. The triple product of points whose coordinates sum
 * to 1 is twice the area that they span in (u, v). */
static double triangle_solid_angle(const double a[2], const double b[2], const double c[2])
{
    const double *corners[3] = {a, b, c};
    double points[3][3], lengths[3], below = 1;
    for (int i = 0; i < 3; i++) {
        double u = corners[i][0], v = corners[i][1], y = 1 - u - v;
        points[i][0] = u;
        points[i][1] = y;
        points[i][2] = v;
        lengths[i] = sqrt(u * u + y * y + v * v);
        below *= lengths[i];
    }
    for (int i = 0; i < 3; i++) {
        const double *p = points[i], *q = points[(i + 1) % 3];
        below += (p[0] * q[0] + p[1] * q[1] + p[2] * q[2]) * lengths[(i + 2) % 3];
    }
    double twice_area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    return 2 * atan2(fabs(twice_area), below);
}

static double outline_solid_angle(const struct face_outline *outline)
{
    double sum = 0;
    for (int i = 1; i + 1 < outline->count; i++)
        sum += triangle_solid_angle(outline->points[0], outline->points[i], outline->points[i + 1]);
    return sum;
}

/* The part of a rectangle on the upper face (side 1: u + v <= 1), or on the lower one (side -1), which is
 * laid over the upper one by its mirror image in the line between them. */
static struct face_outline cut_at_horizon(const double corners[4][2], double side)
{
    struct face_outline part = {.count = 0};
    for (int i = 0; i < 4; i++) {
        const double *a = corners[i], *b = corners[(i + 1) % 4];
        double over_a = side * (a[0] + a[1] - 1), over_b = side * (b[0] + b[1] - 1);
        double along = over_a / (over_a - over_b);
        for (int step = 0; step < 2; step++) {
            if (step == 0 ? over_a > 0 : (over_a < 0) == (over_b < 0) || over_a == 0 || over_b == 0)
                continue;
            double u = step ? a[0] + along * (b[0] - a[0]) : a[0];
            double v = step ? a[1] + along * (b[1] - a[1]) : a[1];
            double *point = part.points[part.count++];
            point[0] = side > 0 ? u : 1 - v;
            point[1] = side > 0 ? v : 1 - u;
        }
    }
    return part;
}

/* A cell is split at the edges of the octahedron: along both axes of the map, and at the horizon. */
static double octahedral_solid_angle(const struct tl_sphere_map *map, const struct tl_layout_cell *cell)
{
    double u[2] = {2 * cell->x0 / map->width - 1, 2 * cell->x1 / map->width - 1};
    double v[2] = {2 * cell->y0 / map->height - 1, 2 * cell->y1 / map->height - 1};
    double sum = 0;
    for (int quadrant = 0; quadrant < 4; quadrant++) {
        double right = quadrant & 1 ? 1 : -1, down = quadrant & 2 ? 1 : -1;
        double u0 = fmax(fmin(right * u[0], right * u[1]), 0), u1 = fmax(right * u[0], right * u[1]);
        double v0 = fmax(fmin(down * v[0], down * v[1]), 0), v1 = fmax(down * v[0], down * v[1]);
        if (u1 <= u0 || v1 <= v0)
            continue;
        const double corners[4][2] = {{u0, v0}, {u1, v0}, {u1, v1}, {u0, v1}};
        struct face_outline upper = cut_at_horizon(corners, 1), lower = cut_at_horizon(corners, -1);
        sum += outline_solid_angle(&upper) + outline_solid_angle(&lower);
    }
    return sum;
}

double tl_layout_cell_solid_angle(const struct tl_sphere_map *map, const struct tl_layout_cell *cell)
{
    if (map->layout == TL_LAYOUT_OCTAHEDRAL)
        return octahedral_solid_angle(map, cell);
    if (map->layout == TL_LAYOUT_LATLONG) { /* cos a - cos b without cancellation at the poles */
        double middle = 0.5 * M_PI * (cell->y0 + cell->y1) / map->height;
        double half = 0.5 * M_PI * (cell->y1 - cell->y0) / map->height;
        return 2 * M_PI * (cell->x1 - cell->x0) / map->width * 2 * sin(middle) * sin(half);
    }
    if (map->layout == TL_LAYOUT_CUBE) {
        double top = map->width * floor(cell->y0 / map->width), scale = 2.0 / map->width;
        double u0 = scale * cell->x0 - 1, v0 = scale * (cell->y0 - top) - 1;
        double u1 = scale * cell->x1 - 1, v1 = scale * (cell->y1 - top) - 1;
        return corner_solid_angle(u1, v1) - corner_solid_angle(u0, v1) - corner_solid_angle(u1, v0) +
               corner_solid_angle(u0, v0);
    }
    return disc_solid_angle(map, cell);
}

double tl_layout_solid_angle(const struct tl_sphere_map *map, int x, int y)
{
    assert(x >= 0 && x < map->width && y >= 0 && y < map->height);
    return tl_layout_cell_solid_angle(map, &(struct tl_layout_cell){x, y, x + 1, y + 1});
}
