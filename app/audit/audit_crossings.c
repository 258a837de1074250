/* Crossing triangles of the garment as it lies in its file. Those that touch one another are one finding. */
#include "app/audit/audit_internal.h"
#include "assets/topology/sets.h"
#include "cloth/self_contact/crossings.h"
#include "config/base/memory.h"

#include <stdlib.h>

/* Joins crossing triangles that have a corner in common, and those that cross; returns their sets. */
static uint32_t *group(const tl_mesh *mesh, const struct tl_near_pairs *pairs)
{
    uint32_t *sets = tl_sets_create(mesh->index_count / 3);
    uint32_t *of_vertex = TL_NEW_ARRAY(uint32_t, mesh->vertex_count); /* plus one */
    for (size_t i = 0; i < pairs->count; i++) {
        tl_sets_join(sets, pairs->pairs[i][0], pairs->pairs[i][1]);
        for (size_t corner = 0; corner < 6; corner++) {
            uint32_t triangle = pairs->pairs[i][corner / 3];
            uint32_t *known = &of_vertex[mesh->indices[3 * triangle + corner % 3]];
            if (*known > 0)
                tl_sets_join(sets, triangle, *known - 1);
            *known = triangle + 1;
        }
    }
    free(of_vertex);
    return sets;
}

void audit_crossings(tl_audit *audit, const struct audited *audited)
{
    const tl_mesh *mesh = audited->mesh;
    struct tl_near_pairs pairs = {0};
    tl_crossings_of_mesh(mesh, mesh->positions, &pairs);
    audit->crossing_count = pairs.count;
    audit->crossings_complete = !pairs.cut_short;
    uint32_t *sets = group(mesh, &pairs);
    size_t *counts = TL_NEW_ARRAY(size_t, mesh->index_count / 3);
    for (size_t i = 0; i < pairs.count; i++)
        counts[tl_sets_find(sets, pairs.pairs[i][0])]++;
    for (size_t i = 0; i < pairs.count; i++) {
        size_t *count = &counts[tl_sets_find(sets, pairs.pairs[i][0])];
        if (*count > 0)
            audit_add(audit, TL_AUDIT_CROSSING, audited->model, pairs.pairs[i][0],
                      "pairs of triangles that cross here: %zu", *count);
        *count = 0;
    }
    free(counts);
    free(sets);
    tl_near_pairs_release(&pairs);
}
