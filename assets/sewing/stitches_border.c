#include "assets/sewing/stitches_internal.h"

#include "config/base/memory.h"

#include <stdlib.h>

struct border_side {
    uint32_t lower, upper, corner; /* points, and where in the indices the side begins */
};

static int compare_sides(const void *a, const void *b)
{
    const struct border_side *left = a, *right = b;
    if (left->lower != right->lower)
        return left->lower < right->lower ? -1 : 1;
    return (left->upper > right->upper) - (left->upper < right->upper);
}

static struct border_side *list_sides(const tl_model *model)
{
    const tl_mesh *mesh = &model->mesh;
    struct border_side *sides = TL_NEW_ARRAY(struct border_side, mesh->index_count);
    for (size_t i = 0; i < mesh->index_count; i++) {
        uint32_t a = stitches_point(model, mesh->indices[i]);
        uint32_t b = stitches_point(model, mesh->indices[i % 3 == 2 ? i - 2 : i + 1]);
        sides[i] = (struct border_side){a < b ? a : b, a < b ? b : a, (uint32_t)i};
    }
    qsort(sides, mesh->index_count, sizeof *sides, compare_sides);
    return sides;
}

/* A second border through a point makes it ambiguous: a panel touches itself there. */
static void add_side(const tl_model *model, uint32_t corner, struct stitches_border *borders, bool *twice)
{
    const uint32_t *indices = model->mesh.indices;
    uint32_t a = stitches_point(model, indices[corner]);
    uint32_t b = stitches_point(model, indices[corner % 3 == 2 ? corner - 2 : corner + 1]);
    twice[a] |= borders[a].next != STITCHES_NONE;
    twice[b] |= borders[b].previous != STITCHES_NONE;
    borders[a].next = b;
    borders[a].corner = corner;
    borders[b].previous = a;
}

struct stitches_border *stitches_find_borders(const tl_model *model, size_t point_count)
{
    const struct stitches_border none = {STITCHES_NONE, STITCHES_NONE, STITCHES_NONE};
    struct stitches_border *borders = TL_NEW_ARRAY(struct stitches_border, point_count);
    bool *twice = TL_NEW_ARRAY(bool, point_count);
    struct border_side *sides = list_sides(model);
    size_t count = model->mesh.index_count;
    for (size_t i = 0; i < point_count; i++)
        borders[i] = none;
    for (size_t i = 0, end; i < count; i = end) {
        for (end = i + 1; end < count && compare_sides(&sides[i], &sides[end]) == 0;)
            end++;
        if (end == i + 1)
            add_side(model, sides[i].corner, borders, twice);
    }
    for (size_t i = 0; i < point_count; i++)
        if (twice[i])
            borders[i] = none;
    free(sides);
    free(twice);
    return borders;
}
