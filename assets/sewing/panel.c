#include "assets/sewing/panel.h"

#include "assets/sewing/delaunay.h"
#include "assets/sewing/delaunay_ring.h"
#include "config/base/memory.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { CURVE_SAMPLES = 128, SMOOTHING_PASSES = 8, SMOOTHING_ROUNDS = 2 };

struct tl_curve tl_curve_line(struct tl_point from, struct tl_point to)
{
    struct tl_curve curve = {.control = {from, {0}, {0}, to}};
    for (int i = 1; i < 3; i++)
        curve.control[i] =
            (struct tl_point){from.x + (to.x - from.x) * i / 3, from.y + (to.y - from.y) * i / 3};
    return curve;
}

struct tl_point tl_curve_at(const struct tl_curve *curve, double t)
{
    const struct tl_point *c = curve->control;
    double s = 1 - t, w[4] = {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
    return (struct tl_point){w[0] * c[0].x + w[1] * c[1].x + w[2] * c[2].x + w[3] * c[3].x,
                             w[0] * c[0].y + w[1] * c[1].y + w[2] * c[2].y + w[3] * c[3].y};
}

/* length[i]: along the curve to parameter i / CURVE_SAMPLES. */
static void measure_curve(const struct tl_curve *curve, double length[CURVE_SAMPLES + 1])
{
    struct tl_point last = curve->control[0];
    length[0] = 0;
    for (int i = 1; i <= CURVE_SAMPLES; i++) {
        struct tl_point point = tl_curve_at(curve, (double)i / CURVE_SAMPLES);
        length[i] = length[i - 1] + hypot(point.x - last.x, point.y - last.y);
        last = point;
    }
}

double tl_curve_length(const struct tl_curve *curve)
{
    double length[CURVE_SAMPLES + 1];
    measure_curve(curve, length);
    return length[CURVE_SAMPLES];
}

void tl_curve_divide(const struct tl_curve *curve, struct tl_point *out)
{
    double length[CURVE_SAMPLES + 1];
    measure_curve(curve, length);
    for (int n = 0, i = 0; n < curve->segments; n++) {
        double wanted = length[CURVE_SAMPLES] * n / curve->segments;
        while (i < CURVE_SAMPLES - 1 && length[i + 1] < wanted)
            i++;
        out[n] = tl_curve_at(curve, (i + (wanted - length[i]) / (length[i + 1] - length[i])) / CURVE_SAMPLES);
    }
}

/* Crossings of a ray to +x with the closed outline. */
static bool is_inside(const struct tl_point *outline, size_t count, struct tl_point p)
{
    bool inside = false;
    for (size_t i = 0; i < count; i++) {
        struct tl_point a = outline[i], b = outline[(i + 1) % count];
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y))
            inside = !inside;
    }
    return inside;
}

static double distance_to_outline(const struct tl_point *outline, size_t count, struct tl_point p)
{
    double nearest = INFINITY; /* squared */
    for (size_t i = 0; i < count; i++) {
        struct tl_point a = outline[i], b = outline[(i + 1) % count];
        double dx = b.x - a.x, dy = b.y - a.y;
        double t = ((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy);
        t = fmin(fmax(t, 0), 1);
        double away_x = a.x + t * dx - p.x, away_y = a.y + t * dy - p.y;
        nearest = fmin(nearest, away_x * away_x + away_y * away_y);
    }
    return sqrt(nearest);
}

/* A fixed pseudo-random value in [-1/2, 1/2) (the finaliser of MurmurHash3). */
static double jitter(uint32_t seed)
{
    seed = (seed ^ seed >> 16) * 0x85ebca6bu;
    seed = (seed ^ seed >> 13) * 0xc2b2ae35u;
    seed ^= seed >> 16;
    return seed / 4294967296.0 - 0.5;
}

/* Hexagonal grid points inside the outline, off it by 0.6 edges: farther than the radius of any outline
 * edge's diametral circle, so that every outline edge is a Delaunay edge. The jitter avoids a preferred
 * direction in the cloth. */
static void fill_inside(tl_panel_mesh *panel, double edge_m)
{
    const double row_height = 0.5 * sqrt(3) * edge_m, clearance = 0.6 * edge_m, shake = 0.25 * edge_m;
    struct tl_point lower = panel->points[0], upper = panel->points[0];
    for (size_t i = 0; i < panel->outline_count; i++) {
        lower = (struct tl_point){fmin(lower.x, panel->points[i].x), fmin(lower.y, panel->points[i].y)};
        upper = (struct tl_point){fmax(upper.x, panel->points[i].x), fmax(upper.y, panel->points[i].y)};
    }
    int columns = (int)ceil((upper.x - lower.x) / edge_m) + 2;
    int rows = (int)ceil((upper.y - lower.y) / row_height) + 1;
    panel->points = tl_resize(panel->points, panel->outline_count + (size_t)columns * (size_t)rows,
                              sizeof *panel->points);
    for (int j = 0; j < rows; j++) {
        for (int i = 0; i < columns; i++) {
            uint32_t seed = (uint32_t)(j * columns + i) * 2;
            struct tl_point p = {lower.x + (i - 0.5 * (j % 2)) * edge_m + shake * jitter(seed),
                                 lower.y + j * row_height + shake * jitter(seed + 1)};
            if (is_inside(panel->points, panel->outline_count, p) &&
                distance_to_outline(panel->points, panel->outline_count, p) > clearance)
                panel->points[panel->point_count++] = p;
        }
    }
}

/* False when an outline edge is lost. */
static bool triangulate(tl_panel_mesh *panel)
{
    free(panel->triangles);
    size_t count = tl_delaunay(panel->points, panel->point_count, &panel->triangles), kept = 0;
    bool follows = tl_delaunay_follow(panel->points, panel->outline_count, panel->triangles, count);
    for (size_t t = 0; t < count; t++) {
        struct tl_point centre = {0, 0};
        for (int k = 0; k < 3; k++) {
            centre.x += panel->points[panel->triangles[t][k]].x / 3;
            centre.y += panel->points[panel->triangles[t][k]].y / 3;
        }
        if (!is_inside(panel->points, panel->outline_count, centre))
            continue;
        for (int k = 0; k < 3; k++)
            panel->triangles[kept][k] = panel->triangles[t][k];
        kept++;
    }
    panel->triangle_count = kept;
    return follows && kept == 2 * panel->point_count - panel->outline_count - 2; /* Euler's, of a disc */
}

/* Moves inner points to the mean of their neighbours, which evens out the strip along the outline. Beside a
 * notch the mean may lie outside, or on the outline: such points stay. */
static void smooth(tl_panel_mesh *panel, double edge_m)
{
    const double clearance = 0.25 * edge_m;
    struct tl_point *sum = TL_NEW_ARRAY(struct tl_point, panel->point_count);
    struct tl_point *before = TL_NEW_ARRAY(struct tl_point, panel->point_count);
    double *weight = TL_NEW_ARRAY(double, panel->point_count);
    memcpy(before, panel->points, panel->point_count * sizeof *before);
    for (int pass = 0; pass < SMOOTHING_PASSES; pass++) {
        for (size_t i = 0; i < panel->point_count; i++) {
            sum[i] = (struct tl_point){0, 0};
            weight[i] = 0;
        }
        for (size_t t = 0; t < panel->triangle_count; t++) {
            for (int k = 0; k < 6; k++) {
                uint32_t a = panel->triangles[t][k / 2], b = panel->triangles[t][(k / 2 + 1 + k % 2) % 3];
                sum[a].x += panel->points[b].x;
                sum[a].y += panel->points[b].y;
                weight[a]++;
            }
        }
        for (size_t i = panel->outline_count; i < panel->point_count; i++)
            panel->points[i] = (struct tl_point){sum[i].x / weight[i], sum[i].y / weight[i]};
    }
    for (size_t i = panel->outline_count; i < panel->point_count; i++)
        if (!is_inside(panel->points, panel->outline_count, panel->points[i]) ||
            distance_to_outline(panel->points, panel->outline_count, panel->points[i]) < clearance)
            panel->points[i] = before[i];
    free(sum);
    free(before);
    free(weight);
}

bool tl_panel_fill(const struct tl_point *outline, size_t count, double edge_m, tl_panel_mesh *out)
{
    *out = (tl_panel_mesh){.outline_count = count, .point_count = count};
    out->points = TL_NEW_ARRAY(struct tl_point, count);
    memcpy(out->points, outline, count * sizeof *outline);
    fill_inside(out, edge_m);
    bool good = triangulate(out);
    for (int round = 0; good && round < SMOOTHING_ROUNDS; round++) {
        smooth(out, edge_m);
        good = triangulate(out);
    }
    if (!good)
        tl_panel_release(out);
    return good;
}

tl_panel_mesh tl_panel_cut(const struct tl_curve *outline, size_t curve_count, double edge_m)
{
    size_t count = 0;
    for (size_t c = 0; c < curve_count; c++)
        count += (size_t)outline[c].segments;
    struct tl_point *points = TL_NEW_ARRAY(struct tl_point, count);
    size_t next = 0;
    for (size_t c = 0; c < curve_count; c++) {
        tl_curve_divide(&outline[c], points + next);
        next += (size_t)outline[c].segments;
    }
    tl_panel_mesh panel;
    bool good = tl_panel_fill(points, count, edge_m, &panel);
    assert(good);
    (void)good;
    free(points);
    return panel;
}

void tl_panel_release(tl_panel_mesh *panel)
{
    free(panel->points);
    free(panel->triangles);
    *panel = (tl_panel_mesh){0};
}
