#include "render/visibility/cache_probes.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

#define KEY_BITS 10
#define NORMAL_SHARE                                                                                         \
    0.05f                /* a normal's length among positions, over the surface's size: 90 degrees are 7 % */
#define SAME_NORMAL 0.9f /* cosine */

struct order {
    bool follows; /* takes its light from others */
    uint64_t key;
    uint32_t vertex;
};

/* Bit i of `x` to bit 6 i. */
static uint64_t spread_bits(uint32_t x)
{
    uint64_t spread = 0;
    for (int i = 0; i < KEY_BITS; i++)
        spread |= (uint64_t)(x >> i & 1) << (6 * i);
    return spread;
}

/* Place on a Morton curve through positions and normals. */
static uint64_t key_of(vec3s position, vec3s normal, const struct tl_box *box, float size)
{
    uint64_t key = 0;
    for (int i = 0; i < 6; i++) {
        float along =
            i < 3 ? (position.raw[i] - box->lower.raw[i]) / size : NORMAL_SHARE * (normal.raw[i - 3] + 1);
        float whole = fminf(fmaxf(along, 0), 1) * (float)((1 << KEY_BITS) - 1);
        key |= spread_bits((uint32_t)whole) << (5 - i);
    }
    return key;
}

static int compare_keys(const void *a, const void *b)
{
    const struct order *x = a, *y = b;
    if (x->follows != y->follows)
        return x->follows ? 1 : -1;
    if (x->key != y->key)
        return x->key < y->key ? -1 : 1;
    return x->vertex < y->vertex ? -1 : x->vertex > y->vertex;
}

static struct order *sort_vertices(const tl_surface *surface)
{
    struct order *order = TL_NEW_ARRAY(struct order, surface->vertex_count);
    struct tl_box box = tl_box_of(surface->positions, surface->vertex_count);
    vec3s extent = glms_vec3_sub(box.upper, box.lower);
    float size = fmaxf(fmaxf(extent.x, extent.y), fmaxf(extent.z, 1e-9f));
    for (size_t v = 0; v < surface->vertex_count; v++)
        order[v] = (struct order){.follows = !tl_has_own_light(surface, (uint32_t)v),
                                  .key = key_of(surface->positions[v], surface->normals[v], &box, size),
                                  .vertex = (uint32_t)v};
    qsort(order, surface->vertex_count, sizeof *order, compare_keys);
    return order;
}

static bool are_one(const tl_surface *surface, uint32_t a, uint32_t b)
{
    vec3s p = surface->positions[a], q = surface->positions[b];
    return p.x == q.x && p.y == q.y && p.z == q.z &&
           glms_vec3_dot(surface->normals[a], surface->normals[b]) > SAME_NORMAL;
}

/* representative[v]: the vertex whose probe stands for v. Equals are neighbours in the order but for others
 * of the same key. */
static uint32_t *find_representatives(const tl_surface *surface, const struct order *order)
{
    uint32_t *representative = TL_NEW_ARRAY(uint32_t, surface->vertex_count);
    for (size_t i = 0; i < surface->vertex_count; i++) {
        uint32_t vertex = order[i].vertex;
        representative[vertex] = vertex;
        for (size_t k = i; k > 0 && i - k < TL_CLUSTER && order[k - 1].key == order[i].key &&
                           order[k - 1].follows == order[i].follows;
             k--)
            if (are_one(surface, order[k - 1].vertex, vertex))
                representative[vertex] = representative[order[k - 1].vertex];
    }
    return representative;
}

static void start_cluster(struct tl_cache_probes *probes, size_t *capacity)
{
    if (probes->cluster_count == *capacity) {
        *capacity = 2 * *capacity + 64;
        probes->items = tl_resize(probes->items, *capacity * TL_CLUSTER, sizeof *probes->items);
    }
    for (size_t lane = 0; lane < TL_CLUSTER; lane++)
        probes->items[probes->cluster_count * TL_CLUSTER + lane] =
            (struct tl_cache_probe){.surface = TL_CACHE_PROBE_NONE};
    probes->cluster_count++;
}

static void add_side(struct tl_cache_probes *probes, size_t *capacity, const struct order *order,
                     size_t count, const uint32_t *representative, struct tl_cache_probe probe)
{
    uint32_t *of_vertex = probes->of_vertex + 2 * (size_t)probes->first_vertex[probe.surface] + probe.back;
    size_t lane = TL_CLUSTER;
    for (size_t i = 0; i < count; i++) {
        probe.vertex = order[i].vertex;
        if (representative[probe.vertex] != probe.vertex)
            continue;
        if (lane == TL_CLUSTER || (i > 0 && order[i].follows && !order[i - 1].follows)) {
            start_cluster(probes, capacity);
            lane = 0;
        }
        size_t number = (probes->cluster_count - 1) * TL_CLUSTER + lane++;
        probes->items[number] = probe;
        of_vertex[2 * (size_t)probe.vertex] = (uint32_t)number;
    }
    for (size_t v = 0; v < count; v++)
        of_vertex[2 * v] = of_vertex[2 * (size_t)representative[v]];
}

void tl_cache_probes_build(const struct tl_triangle_ranges *ranges, struct tl_cache_probes *out)
{
    tl_cache_probes_release(out);
    out->first_vertex = TL_NEW_ARRAY(uint32_t, ranges->surface_count + 1);
    for (size_t s = 0; s < ranges->surface_count; s++)
        out->first_vertex[s + 1] = out->first_vertex[s] + (uint32_t)ranges->surfaces[s]->vertex_count;
    out->of_vertex = TL_NEW_ARRAY(uint32_t, 2 * (size_t)out->first_vertex[ranges->surface_count]);
    size_t capacity = 0; /* of items, in clusters */
    out->items = NULL;
    for (size_t s = 0; s < ranges->surface_count; s++) {
        const tl_surface *surface = ranges->surfaces[s];
        struct order *order = sort_vertices(surface);
        uint32_t *representative = find_representatives(surface, order);
        for (int back = 0; back < 2; back++)
            add_side(out, &capacity, order, surface->vertex_count, representative,
                     (struct tl_cache_probe){.surface = (uint32_t)s, .back = back});
        free(order);
        free(representative);
    }
}

void tl_cache_probes_release(struct tl_cache_probes *probes)
{
    free(probes->items);
    free(probes->first_vertex);
    free(probes->of_vertex);
    *probes = (struct tl_cache_probes){0};
}
