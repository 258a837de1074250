/* One flat piece of a sewing pattern, cut along its outline and triangulated.
 *
 * An outline is a ring of cubic Bezier curves, counter-clockwise, in metres. Each curve becomes `segments`
 * edges of equal length, so that two curves which are sewn together get the same number of points whatever
 * their shapes. The inside is a Delaunay triangulation of a jittered hexagonal grid, smoothed. Threads: pure,
 * no randomness but a fixed hash. */
#ifndef TOILE_ASSETS_SEWING_PANEL_H
#define TOILE_ASSETS_SEWING_PANEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct tl_point {
    double x, y;
};

struct tl_curve {
    struct tl_point control[4];
    int segments;
};

typedef struct tl_panel_mesh {
    size_t point_count;
    struct tl_point *points; /* metres; the outline's come first, in its order */
    size_t outline_count;
    size_t triangle_count;
    uint32_t (*triangles)[3]; /* counter-clockwise */
} tl_panel_mesh;

struct tl_curve tl_curve_line(struct tl_point from, struct tl_point to);
struct tl_point tl_curve_at(const struct tl_curve *curve, double t); /* 0 to 1 */
double tl_curve_length(const struct tl_curve *curve);

/* The curve's start and its inner divisions, at equal lengths; out [curve->segments]. */
void tl_curve_divide(const struct tl_curve *curve, struct tl_point *out);

/* The point of curve c's n-th division is outline point (sum of the segments before c) + n. The outline must
 * not cross or touch itself. */
tl_panel_mesh tl_panel_cut(const struct tl_curve *outline, size_t curve_count, double edge_m);

/* The same for an outline that is divided already: at least three points, apart by about edge_m. False, with
 * *out zeroed, when the outline crosses or touches itself. */
bool tl_panel_fill(const struct tl_point *outline, size_t count, double edge_m, tl_panel_mesh *out);
void tl_panel_release(tl_panel_mesh *panel); /* frees and zeroes */

#endif
