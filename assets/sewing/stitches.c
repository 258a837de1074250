#include "assets/sewing/stitches.h"

#include "assets/sewing/stitches_internal.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

/* Vertices of one point are sewn together: a file splits them where texture coordinates differ. */
static void join_splits(struct stitches *stitches, tl_garment *garment)
{
    const tl_model *model = &garment->model;
    for (uint32_t v = 0; v < model->mesh.vertex_count; v++) {
        uint32_t *first = &stitches->first[stitches_point(model, v)];
        if (*first == STITCHES_NONE)
            *first = v;
        else
            garment->seams[garment->seam_count++] = (struct tl_seam_pair){*first, v};
    }
}

/* Whether two points are one, or follow one another along a border with few points between them. */
static bool are_near(const struct stitches *stitches, uint32_t a, uint32_t b)
{
    uint32_t after = a, before = a;
    bool found = a == b;
    for (int i = 0; !found && i <= STITCHES_MAX_LEFT_OVER; i++) {
        after = after == STITCHES_NONE ? after : stitches->borders[after].next;
        before = before == STITCHES_NONE ? before : stitches->borders[before].previous;
        found = after == b || before == b;
    }
    return found;
}

/* Whether `point` is sewn to one near `other`: one more stitch would make what lies between both a point, or
 * a fold. */
static bool shuts_edge(const struct stitches *stitches, uint32_t point, uint32_t other)
{
    for (uint32_t i = stitches->lists[point]; i != STITCHES_NONE; i = stitches->partners[i].next)
        if (are_near(stitches, stitches->partners[i].point, other))
            return true;
    return false;
}

static void add_partner(struct stitches *stitches, uint32_t point, uint32_t partner)
{
    stitches->partners[stitches->partner_count] = (struct stitches_partner){partner, stitches->lists[point]};
    stitches->lists[point] = (uint32_t)stitches->partner_count++;
}

static bool are_adjacent(const struct stitches *stitches, uint32_t a, uint32_t b)
{
    return stitches->borders[a].next == b || stitches->borders[b].next == a;
}

/* The distance by which a stitch is moved along its edge, as a share of it. */
static float moved_by(const struct tl_stitch *stitch)
{
    return fminf(fabsf(stitch->at), fabsf(1 - stitch->at));
}

static int compare_stitches(const void *a, const void *b)
{
    const struct tl_stitch *const *left = a, *const *right = b;
    float difference = moved_by(*left) - moved_by(*right);
    if (difference != 0)
        return difference < 0 ? -1 : 1;
    return (*left > *right) - (*left < *right); /* as in the file */
}

static bool sew_one(struct stitches *stitches, const struct tl_stitch *stitch, tl_garment *garment)
{
    uint32_t a = stitch->point, b = stitch->edge[stitch->at < 0.5f ? 0 : 1];
    if (stitches->first[a] == STITCHES_NONE || stitches->first[b] == STITCHES_NONE || a == b ||
        are_adjacent(stitches, a, b) || shuts_edge(stitches, a, b) || shuts_edge(stitches, b, a))
        return false;
    add_partner(stitches, a, b);
    add_partner(stitches, b, a);
    garment->seams[garment->seam_count++] = (struct tl_seam_pair){stitches->first[a], stitches->first[b]};
    return true;
}

/* The stitch to an end that is moved least holds. Returns how many hold. */
static size_t sew_exact_ones_first(struct stitches *stitches, tl_garment *garment)
{
    const tl_model *model = &garment->model;
    const struct tl_stitch **order = TL_NEW_ARRAY(const struct tl_stitch *, model->stitch_count);
    size_t count = 0;
    for (size_t i = 0; i < model->stitch_count; i++)
        order[i] = &model->stitches[i];
    qsort(order, model->stitch_count, sizeof *order, compare_stitches);
    for (size_t i = 0; i < model->stitch_count; i++)
        count += sew_one(stitches, order[i], garment);
    free(order);
    return count;
}

struct tl_stitches_report tl_stitches_sew(tl_garment *garment)
{
    const tl_model *model = &garment->model;
    struct tl_stitches_report report = {0};
    if (model->stitch_count == 0)
        return report;
    const size_t points = tl_model_point_count(model);
    struct stitches stitches = {
        .point_count = points,
        .first = TL_NEW_ARRAY(uint32_t, points),
        .borders = stitches_find_borders(model, points),
        .lists = TL_NEW_ARRAY(uint32_t, points),
        .partners = TL_NEW_ARRAY(struct stitches_partner, 2 * model->stitch_count),
    };
    for (size_t i = 0; i < points; i++)
        stitches.first[i] = stitches.lists[i] = STITCHES_NONE;
    /* Room for the splits, the stitches, and one more a point, which may be left over. */
    size_t maximum = model->mesh.vertex_count + model->stitch_count + points;
    garment->seams = tl_resize(garment->seams, maximum, sizeof *garment->seams);
    garment->seam_count = 0;
    garment->welds_seams_only = true;
    join_splits(&stitches, garment);
    report.sewn = sew_exact_ones_first(&stitches, garment);
    report.added = stitches_fill_gaps(&stitches, garment);
    report.sewn += report.added;
    free(stitches.first);
    free(stitches.borders);
    free(stitches.lists);
    free(stitches.partners);
    return report;
}
