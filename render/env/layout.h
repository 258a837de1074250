/* The ways to lay the sphere of directions out as a picture. Pure.
 *
 * Points of a picture are counted in texels from its top left corner: texel (x, y) is the square from (x, y)
 * to (x + 1, y + 1). `size` is the height of a picture, but for a cube the side of a face.
 *
 * - lat-long, 2:1: u = 0.5 + atan2(x, -z) / 2pi, v = acos(y) / pi: the centre looks along -Z, +X right of it.
 * - cube, 1:6: faces +X -X +Y -Y +Z -Z stacked from the top, each in GL orientation (render/env/cube.h).
 * - sphere, 1:1: a mirror ball seen by an orthographic camera that looks along -Z: a point of the unit disc,
 *   y up, is h.xy, where h halves the angle between the direction and +Z (Heidrich and Seidel 1999, 4.1). The
 *   centre shows +Z. -Z is singular: the whole rim shows it.
 * - paraboloid, 2:1: two mirrors of this kind side by side that show a hemisphere each: d.xy / (1 + d.z) on
 *   the left for z >= 0, and on the right the same seen from behind, (-d.x, d.y) / (1 - d.z) (op. cit., eq. 5
 *   to 7).
 * - octahedral, 1:1: the octahedron |x| + |y| + |z| = 1 unfolded about +Y: the upper half is (x, z), +X right
 *   and +Z down, and below the horizon the four corners are folded outwards, -Y in each of them.
 *
 * What lies outside of the discs is no part of the sphere. Paraboloids are continued there (op. cit., 4.1),
 * and the ball's rim is repeated, so that filters find no black. */
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

extern const char *const tl_layout_names[TL_LAYOUT_COUNT + 1]; /* as on the command line; NULL */

/* A picture's layout and extent, texels. Lat-long pictures may have any. */
struct tl_sphere_map {
    enum tl_layout layout;
    int width, height;
};

/* int64_t, because a size that a person typed may not fit into an image. */
void tl_layout_extent(enum tl_layout layout, int size, int64_t *width, int64_t *height);
int tl_layout_size(const struct tl_sphere_map *map);

/* Unit direction of a point. */
vec3s tl_layout_direction(const struct tl_sphere_map *map, double x, double y);
/* Point of a unit direction, at most on the picture's right and lower border. Returns the number of the piece
 * of the picture in which it lies: the face of a cube, the disc of a paraboloid. */
int tl_layout_locate(const struct tl_sphere_map *map, vec3s direction, double *x, double *y);
/* The texels of a piece: columns [x0, x1), rows [y0, y1). */
struct tl_layout_piece {
    int x0, y0, x1, y1;
};
struct tl_layout_piece tl_layout_piece(const struct tl_sphere_map *map, int piece);
/* Number of the texel in a direction: y * width + x. */
size_t tl_layout_texel(const struct tl_sphere_map *map, vec3s direction);

/* Solid angle for one texel's area at a point, up to a factor that is the map's own. */
double tl_layout_density(const struct tl_sphere_map *map, double x, double y);

/* True for the points that are part of the sphere. */
bool tl_layout_contains(const struct tl_sphere_map *map, double x, double y);

/* A part of a texel. */
struct tl_layout_cell {
    double x0, y0, x1, y1;
};

/* The point of a cell that is part of the sphere if any of it is: the nearest to the centre of its disc, and
 * where there are no discs the cell's own centre. */
void tl_layout_nearest(const struct tl_sphere_map *map, const struct tl_layout_cell *cell, double *x,
                       double *y);

/* Exact solid angle, sr, of the part of a cell, or of texel (x, y), that is part of the sphere. Texels sum to
 * 4 pi. */
double tl_layout_cell_solid_angle(const struct tl_sphere_map *map, const struct tl_layout_cell *cell);
double tl_layout_solid_angle(const struct tl_sphere_map *map, int x, int y);

#endif
