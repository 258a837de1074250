#include "cloth/pairs.h"

#include "cloth/energy.h"

#include <stdlib.h>
#include <string.h>

/* ---- Partners ---- */

struct matching {
    const struct tl_topology *topology;
    uint32_t
        *membranes; /* [triangle_count] each triangle's membrane; TL_NONE: it has none, or one in a pair */
};

static bool is_free(const struct matching *matching, uint32_t triangle)
{
    return triangle != TL_NONE && matching->membranes[triangle] != TL_NONE;
}

static int count_free(const struct matching *matching, uint32_t triangle)
{
    int count = 0;
    for (int corner = 0; corner < 3; corner++)
        count += is_free(matching, matching->topology->neighbour[triangle][corner]);
    return count;
}

/* The corner that faces the free neighbour with the fewest of its own, which would else stay alone; -1: none
 * is free. */
static int choose_partner(const struct matching *matching, uint32_t triangle)
{
    int best = -1, least = 0;
    for (int corner = 0; corner < 3; corner++) {
        uint32_t other = matching->topology->neighbour[triangle][corner];
        int count = is_free(matching, other) ? count_free(matching, other) : 0;
        if (is_free(matching, other) && (best < 0 || count < least)) {
            best = corner;
            least = count;
        }
    }
    return best;
}

struct element {
    uint32_t vertices[4]; /* the first again where there is no fourth */
    uint32_t membranes[TL_SIDES];
};

static struct element pair_up(struct matching *matching, uint32_t triangle)
{
    const struct tl_topology *topology = matching->topology;
    const uint32_t *corners = topology->triangles[triangle];
    int facing = choose_partner(matching, triangle), far = facing < 0 ? 2 : facing;
    struct element element = {
        {corners[(far + 1) % 3], corners[(far + 2) % 3], corners[far], corners[(far + 1) % 3]},
        {matching->membranes[triangle], TL_NONE}};
    matching->membranes[triangle] = TL_NONE;
    if (facing < 0)
        return element;
    uint32_t other = topology->neighbour[triangle][facing];
    element.vertices[3] = topology->triangles[other][tl_topology_far_corner(topology, triangle, other)];
    element.membranes[1] = matching->membranes[other];
    matching->membranes[other] = TL_NONE;
    return element;
}

/* New array of `*count` elements. */
static struct element *list_elements(const struct tl_topology *topology, const uint32_t *triangles,
                                     size_t triangle_count, size_t *count)
{
    struct element *elements = TL_NEW_ARRAY(struct element, triangle_count);
    struct matching matching = {topology, TL_NEW_ARRAY(uint32_t, topology->triangle_count)};
    memset(matching.membranes, 0xff, topology->triangle_count * sizeof *matching.membranes);
    for (size_t i = 0; i < triangle_count; i++)
        matching.membranes[triangles[i]] = (uint32_t)i;
    *count = 0;
    for (size_t i = 0; i < triangle_count; i++)
        if (is_free(&matching, triangles[i]))
            elements[(*count)++] = pair_up(&matching, triangles[i]);
    free(matching.membranes);
    return elements;
}

/* ---- Batches ---- */

/* Where the membrane of a side has its pair's vertex 0, 1 or 2 (its third one). */
static int find_corner(const struct tl_membrane *m, size_t lane, const struct tl_pair *pair, size_t at,
                       int side, int vertex)
{
    uint32_t wanted = pair->vertices[vertex < 2 ? vertex : 2 + side][at];
    int corner = 0;
    while (corner < 2 && m->vertices[corner][lane] != wanted)
        corner++;
    return corner;
}

static void place_side(const struct tl_membrane *membranes, uint32_t membrane, struct tl_pair *pair,
                       size_t lane, int side)
{
    const struct tl_membrane *m = &membranes[membrane / TL_BATCH];
    size_t from = membrane % TL_BATCH;
    for (int i = 0; i < 2; i++) {
        int corner = find_corner(m, from, pair, lane, side, i + 1);
        pair->sides[side].c[i][lane] = m->c[corner][from];
        pair->sides[side].d[i][lane] = m->d[corner][from];
    }
}

static void place_element(const struct tl_membrane *membranes, const struct element *element,
                          struct tl_pair *pair, size_t lane)
{
    for (int k = 0; k < 4; k++)
        if (k < 3 || element->membranes[1] != TL_NONE)
            pair->vertices[k][lane] = element->vertices[k];
    for (int side = 0; side < TL_SIDES; side++)
        if (element->membranes[side] != TL_NONE)
            place_side(membranes, element->membranes[side], pair, lane, side);
}

struct tl_pairs tl_pairs_build(const struct tl_topology *topology, const struct tl_membrane *membranes,
                               const uint32_t *triangles, size_t count)
{
    size_t element_count;
    struct element *elements = list_elements(topology, triangles, count, &element_count);
    struct tl_batches batches = tl_batches_build(elements[0].vertices, sizeof *elements / sizeof(uint32_t), 4,
                                                 element_count, topology->vertex_count);
    struct tl_pairs pairs = {.count = batches.count,
                             .run_count = batches.run_count,
                             .run_ends = batches.run_ends,
                             .batches = tl_alloc_lines(batches.count, sizeof *pairs.batches),
                             .membranes = tl_alloc(batches.count, sizeof *pairs.membranes)};
    batches.run_ends = NULL;
    memset(pairs.membranes, 0xff, pairs.count * sizeof *pairs.membranes);
    for (size_t i = 0; i < pairs.count * TL_BATCH; i++) {
        size_t batch = i / TL_BATCH, lane = i % TL_BATCH;
        for (int k = 0; k < 4; k++)
            pairs.batches[batch].vertices[k][lane] = (uint32_t)topology->vertex_count;
        if (batches.elements[i] == TL_NONE)
            continue;
        const struct element *element = &elements[batches.elements[i]];
        place_element(membranes, element, &pairs.batches[batch], lane);
        for (int side = 0; side < TL_SIDES; side++)
            pairs.membranes[batch][side][lane] = element->membranes[side];
    }
    tl_batches_release(&batches);
    free(elements);
    return pairs;
}

void tl_pairs_release(struct tl_pairs *pairs)
{
    free(pairs->run_ends);
    free(pairs->batches);
    free(pairs->membranes);
    *pairs = (struct tl_pairs){0};
}

/* ---- Material ---- */

static void set_side(struct tl_pair *pair, int side, size_t lane, double area,
                     const struct tl_cloth_fabric *fabric, double h)
{
    struct tl_side *to = &pair->sides[side];
    const double c[3] = {-(to->c[0][lane] + to->c[1][lane]), to->c[0][lane], to->c[1][lane]};
    const double d[3] = {-(to->d[0][lane] + to->d[1][lane]), to->d[0][lane], to->d[1][lane]};
    double cc = 0, cd = 0, dd = 0;
    for (int i = 0; i < 3; i++) {
        double mobility = pair->w[i < 2 ? i : 2 + side][lane];
        cc += mobility * c[i] * c[i];
        cd += mobility * c[i] * d[i];
        dd += mobility * d[i] * d[i];
    }
    to->cc[lane] = cc;
    to->cd[lane] = cd;
    to->dd[lane] = dd;
    to->weft[lane] = tl_xpbd_factor(cc, fabric->stretch_weft * area, h);
    to->warp[lane] = tl_xpbd_factor(dd, fabric->stretch_warp * area, h);
    to->shear[lane] = 1 / (fabric->shear * area * h * h);
}

void tl_pairs_set(struct tl_pairs *pairs, const struct tl_membrane *membranes,
                  const struct tl_cloth_fabric *fabric, const double *inverse_masses, double h)
{
    for (size_t i = 0; i < pairs->count * TL_BATCH; i++) {
        struct tl_pair *pair = &pairs->batches[i / TL_BATCH];
        size_t lane = i % TL_BATCH;
        for (int k = 0; k < 4; k++)
            pair->w[k][lane] = inverse_masses[pair->vertices[k][lane]];
        for (int side = 0; side < TL_SIDES; side++) {
            uint32_t membrane = pairs->membranes[i / TL_BATCH][side][lane];
            if (membrane != TL_NONE)
                set_side(pair, side, lane, membranes[membrane / TL_BATCH].area[membrane % TL_BATCH], fabric,
                         h);
        }
    }
}
