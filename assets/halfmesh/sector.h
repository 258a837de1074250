/* The faces around a vertex, laid out in their plane of rest, and what removing the vertex makes of them: the
 * step of an edge collapse in which a cage keeps the lengths of the cloth.
 *
 * The faces around a hub that belong to one piece of flat cloth form a sector: closed, around a vertex within
 * the piece, or open, between two edges of its outline. A collapse moves the hub onto the end of a spoke, the
 * target: faces with that spoke vanish, the others become the triangles between the target and their outer
 * side. Cloth is flat at rest, so that the layout is exact but for rounding where the garment's rest shapes
 * fit together; where they do not (a closed sector whose angles do not add up to 2 pi), the angles are scaled
 * [as Lee et al. 1998].
 *
 * Lengths in metres. Threads: pure. */
#ifndef TOILE_ASSETS_HALFMESH_SECTOR_H
#define TOILE_ASSETS_HALFMESH_SECTOR_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { TL_SECTOR_FACES = 24 };

/* Faces are counter-clockwise around the hub; face i lies between spokes i and i + 1, in a closed sector the
 * last one between its spoke and spoke 0. */
struct tl_sector {
    size_t face_count;
    bool closed;
    double rest[TL_SECTOR_FACES][3][2]; /* of the hub and of both spokes' ends, each face in its own frame */
    double spokes[TL_SECTOR_FACES + 1][2]; /* laid out; the hub is at the origin */
    double turn[2];                        /* cosine and sine: from the faces' frames into the layout */
    bool mirrored;                         /* the frames are left-handed: the layout is their mirror image */
};

/* Fills `spokes`, `turn` and `mirrored` from the rest. False when a face has no area, when faces differ in
 * handedness, or when a closed sector is far from flat. */
bool tl_sector_lay_out(struct tl_sector *sector);

/* Judges the collapse of the hub onto the end of spoke `target` (of an open sector: 0 or face_count). The
 * lower the better: the longest new edge in metres, or more for badly shaped triangles. Negative: not
 * allowed, because a triangle would turn over or become a needle, or an outline would lose its shape. */
double tl_sector_judge(const struct tl_sector *sector, size_t target);

/* Whether face i remains, with the target in place of the hub. */
bool tl_sector_keeps(const struct tl_sector *sector, size_t target, size_t face);

/* The rest shape of a face that remains: of the target and of both spokes' ends, in the faces' frames (moved,
 * and turned by the mean of their turns). */
void tl_sector_rest(const struct tl_sector *sector, size_t target, size_t face, double rest[3][2]);

/* Finds a point, given by its weights in face `from` (of the hub and both spokes' ends), in the faces that
 * remain: returns the face, and the weights there, of the target and both spokes' ends. Weights add up to 1;
 * one is negative where the collapse of an outline's vertex has left the point outside. *inside is the
 * smallest. */
size_t tl_sector_locate(const struct tl_sector *sector, size_t target, size_t from, const double weights[3],
                        double found[3], double *inside);

/* Flips, for open sectors of two faces, a quadrilateral: the hub, and the ends of spokes 0, 1 and 2. Flipped,
 * its faces are TL_FLIPPED_HUB (hub, ends 0 and 2) and TL_FLIPPED_FAR (end 1, ends 2 and 0), corners in this
 * order. */
enum { TL_FLIPPED_HUB, TL_FLIPPED_FAR };

/* Whether the flipped diagonal is Delaunay's: the smallest angle grows, and no triangle turns over. */
bool tl_sector_should_flip(const struct tl_sector *sector);

/* The same as tl_sector_rest and tl_sector_locate, for the flipped faces. */
void tl_sector_flipped_rest(const struct tl_sector *sector, size_t face, double rest[3][2]);
size_t tl_sector_flipped_locate(const struct tl_sector *sector, size_t from, const double weights[3],
                                double found[3]);

#ifdef __cplusplus
}
#endif

#endif
