/* The steps of sewing a garment by its file's stitches. Points are the file's vertices. */
#ifndef TOILE_ASSETS_SEWING_STITCHES_INTERNAL_H
#define TOILE_ASSETS_SEWING_STITCHES_INTERNAL_H

#include "assets/base/garment.h"

#define STITCHES_NONE UINT32_MAX
/* Points in a row without a stitch: more are no remainder of a division, but an opening. */
#define STITCHES_MAX_LEFT_OVER 4

/* Along the border of its panel; NONE where a point is on no border, or on several. */
struct stitches_border {
    uint32_t next, previous; /* points */
    uint32_t corner;         /* of the triangle whose side leads from the point to `next`: into the indices */
};

struct stitches_partner {
    uint32_t point, next; /* next of the same list; NONE: the last */
};

struct stitches {
    size_t point_count;
    uint32_t *first;                 /* [point_count] a vertex of each point; NONE: no triangle uses it */
    struct stitches_border *borders; /* [point_count] */
    uint32_t *lists;                 /* [point_count] first partner of each point, or NONE */
    size_t partner_count;
    struct stitches_partner *partners; /* two a pair */
};

static inline uint32_t stitches_point(const tl_model *model, uint32_t vertex)
{
    return model->points ? model->points[vertex] : vertex;
}

/* Finds the borders of the panels. (stitches_border.c) */
struct stitches_border *stitches_find_borders(const tl_model *model, size_t point_count);

/* Divides edges opposite to points that were left over between two stitches, and adds seams of these;
 * returns how many vertices were added. `seams` has room for point_count more. (stitches_gaps.c) */
size_t stitches_fill_gaps(const struct stitches *stitches, tl_garment *garment);

#endif
