#include "assets/pattern/pattern_internal.h"
#include "assets/topology/sets.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <stdlib.h>

/* The corner of its panel at which a side begins or ends, numbered through all panels. */
static uint32_t corner(const tl_pattern *pattern, const uint32_t *firsts, const struct tl_pattern_side *side,
                       bool end)
{
    size_t count = pattern->panels[side->panel].edge_count;
    return firsts[side->panel] + (uint32_t)((side->edge + (end ? 1 : 0)) % count);
}

static void join(const tl_pattern *pattern, const uint32_t *firsts, const struct tl_pattern_stitch *stitch,
                 bool right_wrong, uint32_t *sets)
{
    for (int end = 0; end < 2; end++)
        tl_sets_join(sets, corner(pattern, firsts, &stitch->sides[0], end == 1),
                     corner(pattern, firsts, &stitch->sides[1], (end == 1) == right_wrong));
}

/* Counts those of the two edges that end where they begin, once all seams but this one are sewn, and this one
 * too as `right_wrong` states. */
static int count_rings(const tl_pattern *pattern, const uint32_t *firsts, uint32_t corner_count, size_t index,
                       const bool *right_wrong)
{
    const struct tl_pattern_stitch *stitch = &pattern->stitches[index];
    uint32_t *sets = tl_sets_create(corner_count);
    int rings = 0;
    for (size_t s = 0; s < pattern->stitch_count; s++)
        if (s != index)
            join(pattern, firsts, &pattern->stitches[s], pattern->stitches[s].right_wrong, sets);
    if (right_wrong)
        join(pattern, firsts, stitch, *right_wrong, sets);
    for (int k = 0; k < 2; k++)
        rings += tl_sets_find(sets, corner(pattern, firsts, &stitch->sides[k], false)) ==
                 tl_sets_find(sets, corner(pattern, firsts, &stitch->sides[k], true));
    free(sets);
    return rings;
}

void tl_pattern_untwist(tl_pattern *pattern)
{
    uint32_t corner_count = 0, *firsts = TL_NEW_ARRAY(uint32_t, pattern->panel_count);
    for (size_t p = 0; p < pattern->panel_count; p++) {
        firsts[p] = corner_count;
        corner_count += (uint32_t)pattern->panels[p].edge_count;
    }
    for (size_t s = 0; s < pattern->stitch_count; s++) {
        struct tl_pattern_stitch *stitch = &pattern->stitches[s];
        const bool given = stitch->right_wrong, other = !given;
        int without = count_rings(pattern, firsts, corner_count, s, NULL);
        if (count_rings(pattern, firsts, corner_count, s, &given) == without ||
            count_rings(pattern, firsts, corner_count, s, &other) != without)
            continue;
        stitch->right_wrong = other;
        tl_info("%s: stitch %zu: would draw the edges of %s and %s into rings, because it joins their ends "
                "crosswise: sewn the other way round",
                pattern->name, s, pattern->panels[stitch->sides[0].panel].name,
                pattern->panels[stitch->sides[1].panel].name);
    }
    free(firsts);
}
