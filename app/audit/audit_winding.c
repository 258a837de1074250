/* Triangles that are turned over. Neighbours across an edge agree when they run along it in opposite
 * directions. Each piece (what edges of two triangles connect) has two ways to face; every triangle gets one
 * of them by walking over these edges, and those of the way that has the smaller area are turned over. */
#include "app/audit/audit_internal.h"
#include "assets/sewing/charts.h"
#include "assets/topology/sets.h"
#include "config/base/memory.h"

#include <stdlib.h>

struct winding {
    const struct tl_topology *topology;
    uint32_t *pieces;   /* [triangle_count] the piece's first triangle */
    bool *turned;       /* [triangle_count] faces the other way than that one */
    uint32_t *patches;  /* sets of neighbours that agree */
    double (*areas)[2]; /* [triangle_count] of a piece, by its first triangle: m^2 of both ways */
    bool *one_sided;    /* [triangle_count] of a piece, likewise: both ways meet on the way round */
};

/* Whether two neighbours across the edge that faces corner k of the first run along it alike. */
static bool disagree(const struct tl_topology *topology, uint32_t triangle, int k)
{
    const uint32_t *own = topology->triangles[triangle],
                   *other = topology->triangles[topology->neighbour[triangle][k]];
    uint32_t from = own[(k + 1) % 3], to = own[(k + 2) % 3];
    for (int i = 0; i < 3; i++)
        if (other[i] == from)
            return other[(i + 1) % 3] == to;
    return false;
}

static void walk(struct winding *winding, uint32_t first, uint32_t *queue)
{
    const struct tl_topology *topology = winding->topology;
    size_t done = 0, count = 1;
    queue[0] = first;
    winding->pieces[first] = first;
    for (; done < count; done++) {
        uint32_t triangle = queue[done];
        for (int k = 0; k < 3; k++) {
            uint32_t next = topology->neighbour[triangle][k];
            if (next == TL_NONE)
                continue;
            bool turned = winding->turned[triangle] != disagree(topology, triangle, k);
            if (winding->pieces[next] != TL_NONE) {
                winding->one_sided[first] |= winding->turned[next] != turned;
                continue;
            }
            winding->pieces[next] = first;
            winding->turned[next] = turned;
            queue[count++] = next;
        }
    }
}

static double area_of(const struct audited *audited, uint32_t triangle)
{
    uint32_t source = audited->topology.source[triangle];
    vec3s a = audit_corner(audited->mesh, source, 0), b = audit_corner(audited->mesh, source, 1),
          c = audit_corner(audited->mesh, source, 2);
    return 0.5 * (double)glms_vec3_norm(glms_vec3_cross(glms_vec3_sub(b, a), glms_vec3_sub(c, a)));
}

static struct winding find_winding(const struct audited *audited)
{
    const struct tl_topology *topology = &audited->topology;
    size_t count = topology->triangle_count;
    struct winding winding = {.topology = topology,
                              .pieces = TL_NEW_ARRAY(uint32_t, count),
                              .turned = TL_NEW_ARRAY(bool, count),
                              .patches = tl_sets_create(count),
                              .areas = tl_alloc(count, sizeof *winding.areas),
                              .one_sided = TL_NEW_ARRAY(bool, count)};
    uint32_t *queue = TL_NEW_ARRAY(uint32_t, count);
    for (size_t t = 0; t < count; t++)
        winding.pieces[t] = TL_NONE;
    for (uint32_t t = 0; t < count; t++)
        if (winding.pieces[t] == TL_NONE)
            walk(&winding, t, queue);
    for (uint32_t t = 0; t < count; t++) {
        winding.areas[winding.pieces[t]][winding.turned[t]] += area_of(audited, t);
        for (int k = 0; k < 3; k++)
            if (topology->neighbour[t][k] != TL_NONE && !disagree(topology, t, k))
                tl_sets_join(winding.patches, t, topology->neighbour[t][k]);
    }
    free(queue);
    return winding;
}

static void winding_release(struct winding *winding)
{
    free(winding->pieces);
    free(winding->turned);
    free(winding->patches);
    free(winding->areas);
    free(winding->one_sided);
}

static bool is_flipped(const struct audited *audited, const struct winding *winding, uint32_t triangle)
{
    uint32_t piece = winding->pieces[triangle];
    const double *areas = winding->areas[piece];
    return !audited->degenerate[audited->topology.source[triangle]] && !winding->one_sided[piece] &&
           winding->turned[triangle] == (areas[1] <= areas[0]);
}

/* Twice the area of a triangle in UV; positive: counter-clockwise with v down. */
static double uv_area(const tl_mesh *mesh, size_t triangle)
{
    vec2s uv[3];
    for (size_t k = 0; k < 3; k++)
        uv[k] = mesh->uvs[mesh->indices[3 * triangle + k]];
    return ((double)uv[1].x - (double)uv[0].x) * ((double)uv[2].y - (double)uv[0].y) -
           ((double)uv[1].y - (double)uv[0].y) * ((double)uv[2].x - (double)uv[0].x);
}

/* One finding a chart. flipped [triangle of the mesh]: turned over in space, which turns its UVs too. */
static void audit_charts(tl_audit *audit, const struct audited *audited, const bool *flipped)
{
    struct tl_charts charts = tl_charts_find(audited->mesh);
    double *areas = TL_NEW_ARRAY(double, charts.count);
    size_t *counts = TL_NEW_ARRAY(size_t, charts.count);
    for (int pass = 0; pass < 3;
         pass++) /* which way most of each faces; how many do not; the first of them */
        for (size_t t = 0; t < charts.triangle_count; t++) {
            uint32_t chart = charts.of_triangle[t];
            double area = (flipped[t] ? -1 : 1) * uv_area(audited->mesh, t);
            if (pass == 0)
                areas[chart] += area;
            else if (charts.items[chart].verdict != TL_CHART_IS_PATTERN || area * areas[chart] >= 0)
                continue;
            else if (pass == 1)
                counts[chart]++;
            else if (counts[chart] > 0) {
                audit_add(audit, TL_AUDIT_UV_FLIPPED, audited->model, (int64_t)t,
                          "triangles of its chart that lie turned over in the pattern: %zu", counts[chart]);
                counts[chart] = 0;
            }
        }
    free(counts);
    free(areas);
    tl_charts_release(&charts);
}

void audit_winding(tl_audit *audit, const struct audited *audited)
{
    const struct tl_topology *topology = &audited->topology;
    const tl_model *model = audited->model;
    struct winding winding = find_winding(audited);
    bool *flipped = TL_NEW_ARRAY(bool, audited->mesh->index_count / 3);
    uint32_t *counts = TL_NEW_ARRAY(uint32_t, topology->triangle_count);
    for (uint32_t t = 0; t < topology->triangle_count; t++) {
        flipped[topology->source[t]] = is_flipped(audited, &winding, t);
        counts[tl_sets_find(winding.patches, t)] += is_flipped(audited, &winding, t);
    }
    for (uint32_t t = 0; t < topology->triangle_count; t++) {
        uint32_t *count = &counts[tl_sets_find(winding.patches, t)];
        if (is_flipped(audited, &winding, t) && *count > 0) {
            audit_add(audit, TL_AUDIT_TRIANGLE_FLIPPED, model, topology->source[t],
                      "triangles together that face the other way than the rest of their piece: %u", *count);
            *count = 0;
        }
        if (winding.pieces[t] == t && winding.one_sided[t])
            audit_add(audit, TL_AUDIT_SURFACE_ONE_SIDED, model, topology->source[t],
                      "its piece has no outside");
    }
    audit_charts(audit, audited, flipped);
    free(counts);
    free(flipped);
    winding_release(&winding);
}
