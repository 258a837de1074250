#include "cloth/mesh/topology.h"

#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

static uint32_t float_bits(float value)
{
    if (value == 0) /* -0 equals 0 */
        value = 0;
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static size_t hash_position(vec3s p)
{
    uint64_t hash = 1469598103934665603u; /* FNV-1a over three words */
    for (int i = 0; i < 3; i++)
        hash = (hash ^ float_bits(p.raw[i])) * 1099511628211u;
    return (size_t)(hash ^ (hash >> 29));
}

static bool same_position(vec3s a, vec3s b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

size_t tl_weld_positions(const vec3s *positions, size_t count, uint32_t *weld)
{
    size_t slots = 16;
    while (slots < 2 * count)
        slots *= 2;
    uint32_t *table = TL_NEW_ARRAY(uint32_t, slots); /* first vertex at a position, plus one */
    size_t welded = 0;
    for (size_t i = 0; i < count; i++) {
        size_t slot = hash_position(positions[i]) & (slots - 1);
        while (table[slot] && !same_position(positions[table[slot] - 1], positions[i]))
            slot = (slot + 1) & (slots - 1);
        if (table[slot]) {
            weld[i] = weld[table[slot] - 1];
        } else {
            table[slot] = (uint32_t)i + 1;
            weld[i] = (uint32_t)welded++;
        }
    }
    free(table);
    return welded;
}

struct sorted_triangle {
    uint32_t corners[3]; /* ascending */
    uint32_t index;
};

static int compare_words(const uint32_t *a, const uint32_t *b, int count)
{
    for (int i = 0; i < count; i++)
        if (a[i] != b[i])
            return a[i] < b[i] ? -1 : 1;
    return 0;
}

static int compare_triangles(const void *a, const void *b)
{
    return compare_words(a, b,
                         4); /* by corners, then by index, so that the first of equal triangles comes first */
}

static void order(uint32_t *a, uint32_t *b)
{
    if (*a > *b) {
        uint32_t t = *a;
        *a = *b;
        *b = t;
    }
}

/* Marks the render triangles that have three different corners and do not repeat an earlier triangle. */
static void find_distinct(const uint32_t *indices, size_t count, const uint32_t *weld, bool *keep)
{
    struct sorted_triangle *sorted = TL_NEW_ARRAY(struct sorted_triangle, count);
    for (size_t t = 0; t < count; t++) {
        uint32_t *c = sorted[t].corners;
        for (int i = 0; i < 3; i++)
            c[i] = weld[indices[3 * t + (size_t)i]];
        order(&c[0], &c[1]);
        order(&c[1], &c[2]);
        order(&c[0], &c[1]);
        sorted[t].index = (uint32_t)t;
    }
    qsort(sorted, count, sizeof *sorted, compare_triangles);
    for (size_t i = 0; i < count; i++) {
        const uint32_t *c = sorted[i].corners;
        bool repeats = i > 0 && compare_words(c, sorted[i - 1].corners, 3) == 0;
        keep[sorted[i].index] = !repeats && c[0] != c[1] && c[1] != c[2];
    }
    free(sorted);
}

struct half_edge {
    uint32_t a, b; /* a < b */
    uint32_t triangle, corner;
};

static int compare_half_edges(const void *a, const void *b)
{
    return compare_words(a, b, 4);
}

static void connect(struct tl_topology *topology)
{
    size_t count = 3 * topology->triangle_count;
    struct half_edge *half = TL_NEW_ARRAY(struct half_edge, count);
    for (size_t i = 0; i < count; i++) {
        const uint32_t *t = topology->triangles[i / 3];
        half[i] = (struct half_edge){t[(i + 1) % 3], t[(i + 2) % 3], (uint32_t)(i / 3), (uint32_t)(i % 3)};
        order(&half[i].a, &half[i].b);
    }
    qsort(half, count, sizeof *half, compare_half_edges);
    topology->edges = tl_alloc(count, sizeof *topology->edges);
    topology->neighbour = tl_alloc(topology->triangle_count, sizeof *topology->neighbour);
    memset(topology->neighbour, 0xff, topology->triangle_count * sizeof *topology->neighbour);
    for (size_t i = 0, end; i < count; i = end) {
        for (end = i + 1; end < count && half[end].a == half[i].a && half[end].b == half[i].b;)
            end++;
        uint32_t *edge = topology->edges[topology->edge_count++];
        edge[0] = half[i].a;
        edge[1] = half[i].b;
        if (end - i != 2)
            continue;
        topology->neighbour[half[i].triangle][half[i].corner] = half[i + 1].triangle;
        topology->neighbour[half[i + 1].triangle][half[i + 1].corner] = half[i].triangle;
    }
    free(half);
}

struct tl_topology tl_topology_build(const uint32_t *indices, size_t index_count, const uint32_t *weld,
                                     size_t render_count, size_t vertex_count)
{
    struct tl_topology topology = {.vertex_count = vertex_count, .render_count = render_count};
    size_t count = index_count / 3;
    topology.weld = TL_NEW_ARRAY(uint32_t, render_count);
    memcpy(topology.weld, weld, render_count * sizeof *weld);
    topology.triangles = tl_alloc(count, sizeof *topology.triangles);
    topology.source = TL_NEW_ARRAY(uint32_t, count);
    bool *keep = TL_NEW_ARRAY(bool, count);
    find_distinct(indices, count, weld, keep);
    for (size_t t = 0; t < count; t++) {
        if (!keep[t])
            continue;
        for (size_t i = 0; i < 3; i++)
            topology.triangles[topology.triangle_count][i] = weld[indices[3 * t + i]];
        topology.source[topology.triangle_count++] = (uint32_t)t;
    }
    free(keep);
    connect(&topology);
    return topology;
}

void tl_topology_release(struct tl_topology *topology)
{
    free(topology->weld);
    free(topology->triangles);
    free(topology->source);
    free(topology->neighbour);
    free(topology->edges);
    *topology = (struct tl_topology){0};
}

uint32_t tl_topology_far_corner(const struct tl_topology *topology, uint32_t triangle, uint32_t neighbour)
{
    const uint32_t *t = topology->triangles[triangle], *other = topology->triangles[neighbour];
    uint32_t corner = 0;
    while (corner < 2 && (other[corner] == t[0] || other[corner] == t[1] || other[corner] == t[2]))
        corner++;
    return corner;
}

uint32_t tl_topology_edge(const struct tl_topology *topology, uint32_t a, uint32_t b)
{
    uint32_t low = a < b ? a : b, high = a < b ? b : a;
    size_t from = 0, to = topology->edge_count;
    while (to - from > 1) {
        size_t middle = (from + to) / 2;
        const uint32_t *edge = topology->edges[middle];
        if (edge[0] < low || (edge[0] == low && edge[1] <= high))
            from = middle;
        else
            to = middle;
    }
    return (uint32_t)from;
}

struct tl_fans tl_fans_build(const uint32_t *corners, size_t corner_count, size_t vertex_count)
{
    struct tl_fans fans = {TL_NEW_ARRAY(uint32_t, vertex_count + 1), TL_NEW_ARRAY(uint32_t, corner_count)};
    for (size_t i = 0; i < corner_count; i++)
        fans.first[corners[i] + 1]++;
    for (size_t v = 0; v < vertex_count; v++)
        fans.first[v + 1] += fans.first[v];
    uint32_t *next = TL_NEW_ARRAY(uint32_t, vertex_count);
    for (size_t i = 0; i < corner_count; i++)
        fans.items[fans.first[corners[i]] + next[corners[i]]++] = (uint32_t)i;
    free(next);
    return fans;
}

void tl_fans_release(struct tl_fans *fans)
{
    free(fans->first);
    free(fans->items);
    *fans = (struct tl_fans){0};
}

#define COLOURS 64 /* one bit of a 64-bit mask each */

/* The lowest colour that no element at these vertices has. If all are taken it is the last colour, whose
 * elements may share vertices. */
static uint8_t choose_colour(uint64_t *used, const uint32_t *vertices, size_t count)
{
    uint64_t taken = 0;
    for (size_t i = 0; i < count; i++)
        taken |= used[vertices[i]];
    int colour = taken == UINT64_MAX ? COLOURS - 1 : __builtin_ctzll(~taken);
    for (size_t i = 0; i < count; i++)
        used[vertices[i]] |= (uint64_t)1 << colour;
    return (uint8_t)colour;
}

/* Finds the first batch of each colour. Elements of the last colour may share vertices, so each gets a batch
 * and a run of its own. */
static void lay_out(struct tl_batches *batches, const size_t sizes[COLOURS], size_t first[COLOURS])
{
    batches->run_ends = TL_NEW_ARRAY(size_t, COLOURS + sizes[COLOURS - 1]);
    for (size_t c = 0; c < COLOURS; c++) {
        bool shared = c == COLOURS - 1;
        size_t runs = shared ? sizes[c] : sizes[c] > 0,
               length = shared ? 1 : (sizes[c] + TL_BATCH - 1) / TL_BATCH;
        first[c] = batches->count;
        for (size_t run = 0; run < runs; run++) {
            batches->count += length;
            batches->run_ends[batches->run_count++] = batches->count;
        }
    }
}

struct tl_batches tl_batches_build(const uint32_t *corners, size_t stride, size_t per_element, size_t count,
                                   size_t vertex_count)
{
    uint64_t *used = TL_NEW_ARRAY(uint64_t, vertex_count);
    uint8_t *colours = TL_NEW_ARRAY(uint8_t, count);
    size_t sizes[COLOURS] = {0}, next[COLOURS];
    for (size_t e = 0; e < count; e++) {
        colours[e] = choose_colour(used, corners + e * stride, per_element);
        sizes[colours[e]]++;
    }
    struct tl_batches batches = {0};
    lay_out(&batches, sizes, next);
    batches.elements = TL_NEW_ARRAY(uint32_t, batches.count * TL_BATCH);
    memset(batches.elements, 0xff, batches.count * TL_BATCH * sizeof *batches.elements);
    for (size_t c = 0; c < COLOURS; c++)
        next[c] *= TL_BATCH;
    for (size_t e = 0; e < count; e++) {
        batches.elements[next[colours[e]]] = (uint32_t)e;
        next[colours[e]] += colours[e] == COLOURS - 1 ? TL_BATCH : 1;
    }
    free(used);
    free(colours);
    return batches;
}

void tl_batches_release(struct tl_batches *batches)
{
    free(batches->elements);
    free(batches->run_ends);
    *batches = (struct tl_batches){0};
}
