/* Layouts of the sphere of directions as a picture. Pure; threads: any.
 *
 * Points of a picture are counted in texels from its top left corner: texel (x, y) is the square from (x, y)
 * to (x + 1, y + 1). `size` is the height of a picture, or for a cube the side of a face.
 *
 * - lat-long, 2:1: u = 0.5 + atan2(x, -z) / 2pi, v = acos(y) / pi: the centre looks along -Z, +X right of it.
 * - cube, 1:6: faces +X -X +Y -Y +Z -Z stacked from the top, each in GL orientation (render/env/cube.h).
 * - sphere, 1:1: a mirror ball seen by an orthographic camera that looks along -Z: a point of the unit disc,
 *   y up, is h.xy, where h halves the angle between the direction and +Z [Heidrich and Seidel 1999, 4.1]. The
 *   centre shows +Z. -Z is singular: the whole rim shows it.
 * - paraboloid, 2:1: two mirrors side by side that show a hemisphere each: d.xy / (1 + d.z) on the left for
 *   z >= 0, and on the right the same seen from behind, (-d.x, d.y) / (1 - d.z) [Heidrich and Seidel
 *   1999, eq. 5 to 7].
 * - octahedral, 1:1: the octahedron |x| + |y| + |z| = 1 unfolded about +Y: the upper half is (x, z), +X right
 *   and +Z down, and below the horizon the four corners are folded outwards, -Y in each of them.
 *
 * Points outside of the discs are not part of the sphere. There paraboloids are continued [Heidrich and
 * Seidel 1999, 4.1] and the rim of the ball is repeated, so that filters do not read black. */
#ifndef TOILE_RENDER_ENV_LAYOUT_H
#define TOILE_RENDER_ENV_LAYOUT_H

#include <cglm/struct.h>

enum tl_layout {
    TL_LAYOUT_CUBE,
    TL_LAYOUT_SPHERE,
    TL_LAYOUT_PARABOLOID,
    TL_LAYOUT_LATLONG,
    TL_LAYOUT_OCTAHEDRAL,
    TL_LAYOUT_COUNT
};

extern const char *const tl_layout_names[TL_LAYOUT_COUNT + 1]; /* names on the command line, then NULL */

/* Layout and extent (texels) of a picture. Lat-long pictures may have any extent. */
struct tl_sphere_map {
    enum tl_layout layout;
    int width, height;
};

/* Extent of a picture of a given size. int64_t, because a size that a user typed may exceed that of an
 * image. */
void tl_layout_extent(enum tl_layout layout, int size, int64_t *width, int64_t *height);
/* The size of a picture, as above. */
int tl_layout_size(const struct tl_sphere_map *map);

/* Unit direction of a point. */
vec3s tl_layout_direction(const struct tl_sphere_map *map, double x, double y);
/* Point of a unit direction, at most on the right and lower border of the picture. Returns the piece of the
 * picture that contains it: the face of a cube or the disc of a paraboloid. */
int tl_layout_locate(const struct tl_sphere_map *map, vec3s direction, double *x, double *y);
/* The texels of a piece: columns [x0, x1), rows [y0, y1). */
struct tl_layout_piece {
    int x0, y0, x1, y1;
};
struct tl_layout_piece tl_layout_piece(const struct tl_sphere_map *map, int piece);
/* Index of the texel in a direction: y * width + x. */
size_t tl_layout_texel(const struct tl_sphere_map *map, vec3s direction);

/* Solid angle per texel area at a point, up to a constant factor of the map. */
double tl_layout_density(const struct tl_sphere_map *map, double x, double y);

/* True for points that are part of the sphere. */
bool tl_layout_contains(const struct tl_sphere_map *map, double x, double y);

/* A rectangle within a texel. */
struct tl_layout_cell {
    double x0, y0, x1, y1;
};

/* A point of the cell that is part of the sphere if any point of it is: the one nearest to the centre of its
 * disc, or the centre of the cell where there are no discs. */
void tl_layout_nearest(const struct tl_sphere_map *map, const struct tl_layout_cell *cell, double *x,
                       double *y);

/* Exact solid angle (sr) of the part of a cell, or of texel (x, y), that belongs to the sphere. The texels
 * sum to 4 pi. */
double tl_layout_cell_solid_angle(const struct tl_sphere_map *map, const struct tl_layout_cell *cell);
double tl_layout_solid_angle(const struct tl_sphere_map *map, int x, int y);

#endif
