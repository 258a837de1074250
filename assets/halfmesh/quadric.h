/* Distances that decimation compares: quadrics, and nearest points of triangles and segments. Points are x,
 * y, z in metres. Threads: pure. */
#ifndef TOILE_ASSETS_HALFMESH_QUADRIC_H
#define TOILE_ASSETS_HALFMESH_QUADRIC_H

#ifdef __cplusplus
extern "C" {
#endif

/* The weighted sum of squared distances from planes, as a quadratic form [Garland and Heckbert 1997]: the
 * upper triangle of a symmetric 4 x 4 matrix, by rows. */
struct tl_quadric {
    double a[10];
};

/* Adds the plane through `point` with the unit normal `normal`. */
void tl_quadric_add_plane(struct tl_quadric *quadric, const double normal[3], const double point[3],
                          double weight);
void tl_quadric_add(struct tl_quadric *quadric, const struct tl_quadric *other);

/* The sum for a point: weight times m^2. Rounding may leave it below 0. */
double tl_quadric_at(const struct tl_quadric *quadric, const double point[3]);

/* 1: an equilateral triangle, 0: a line. `twice_area` m^2. */
double tl_triangle_shape(const double a[3], const double b[3], const double c[3], double twice_area);

/* The squared distance from a point to a triangle, and the weights of the corners at the nearest point of it
 * [Ericson 2005, 5.1.5]. */
double tl_triangle_nearest(const double point[3], const double triangle[3][3], double weights[3]);

/* The distance from a point to the segment between two others. */
double tl_segment_distance(const double point[3], const double from[3], const double to[3]);

#ifdef __cplusplus
}
#endif

#endif
