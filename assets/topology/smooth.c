#include "assets/topology/smooth.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct edge {
    uint32_t ends[2];     /* the lower one first */
    uint32_t opposite[2]; /* the third corners of its first two triangles */
    uint32_t uses;        /* triangles with an area */
    bool is_crease;
};

/* A mesh with its edges, and the edges around each vertex. */
struct net {
    size_t vertex_count, triangle_count, edge_count;
    const uint32_t (*triangles)[3];
    struct edge *edges;
    uint32_t (*edge_of)[3]; /* [triangle_count] the edge that faces each corner */
    size_t *firsts;         /* [vertex_count + 1] into `around` */
    uint32_t *around;
    uint32_t *fans; /* [vertex_count] triangles with an area */
};

struct smooth_side {
    uint32_t ends[2], triangle, corner;
};

static int compare_sides(const void *a, const void *b)
{
    const struct smooth_side *left = a, *right = b;
    for (int i = 0; i < 2; i++)
        if (left->ends[i] != right->ends[i])
            return left->ends[i] < right->ends[i] ? -1 : 1;
    if (left->triangle != right->triangle)
        return left->triangle < right->triangle ? -1 : 1;
    return left->corner < right->corner ? -1 : left->corner > right->corner;
}

static bool has_area(const uint32_t corners[3])
{
    return corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0];
}

static void find_edges(const struct tl_smooth_source *source, struct net *net)
{
    struct smooth_side *sides = TL_NEW_ARRAY(struct smooth_side, 3 * source->triangle_count);
    for (uint32_t t = 0; t < source->triangle_count; t++)
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t a = source->triangles[t][(k + 1) % 3], b = source->triangles[t][(k + 2) % 3];
            sides[3 * t + k] = (struct smooth_side){{a < b ? a : b, a < b ? b : a}, t, k};
        }
    qsort(sides, 3 * source->triangle_count, sizeof *sides, compare_sides);
    for (size_t i = 0; i < 3 * source->triangle_count; i++) {
        const struct smooth_side *side = &sides[i];
        bool is_new = i == 0 || memcmp(side->ends, sides[i - 1].ends, sizeof side->ends) != 0;
        if (is_new)
            net->edges[net->edge_count++] = (struct edge){.ends = {side->ends[0], side->ends[1]}};
        struct edge *edge = &net->edges[net->edge_count - 1];
        net->edge_of[side->triangle][side->corner] = (uint32_t)(net->edge_count - 1);
        edge->is_crease |= source->creases && source->creases[side->triangle][side->corner];
        if (!has_area(source->triangles[side->triangle]))
            continue;
        if (edge->uses < 2)
            edge->opposite[edge->uses] = source->triangles[side->triangle][side->corner];
        edge->uses++;
    }
    for (size_t e = 0; e < net->edge_count; e++)
        net->edges[e].is_crease |= net->edges[e].uses != 2;
    free(sides);
}

static void find_neighbours(struct net *net)
{
    for (size_t e = 0; e < net->edge_count; e++)
        for (int k = 0; net->edges[e].uses > 0 && k < 2; k++)
            net->firsts[net->edges[e].ends[k] + 1]++;
    for (size_t v = 0; v < net->vertex_count; v++)
        net->firsts[v + 1] += net->firsts[v];
    size_t *next = TL_NEW_ARRAY(size_t, net->vertex_count);
    memcpy(next, net->firsts, net->vertex_count * sizeof *next);
    for (uint32_t e = 0; e < net->edge_count; e++)
        for (int k = 0; net->edges[e].uses > 0 && k < 2; k++)
            net->around[next[net->edges[e].ends[k]]++] = e;
    for (size_t t = 0; t < net->triangle_count; t++)
        for (int k = 0; has_area(net->triangles[t]) && k < 3; k++)
            net->fans[net->triangles[t][k]]++;
    free(next);
}

static struct net net_make(const struct tl_smooth_source *source)
{
    size_t sides = 3 * source->triangle_count;
    struct net net = {
        .vertex_count = source->vertex_count,
        .triangle_count = source->triangle_count,
        .triangles = source->triangles,
        .edges = TL_NEW_ARRAY(struct edge, sides),
        .edge_of = tl_alloc(source->triangle_count, sizeof *net.edge_of),
        .firsts = TL_NEW_ARRAY(size_t, source->vertex_count + 1),
        .around = TL_NEW_ARRAY(uint32_t, 2 * sides),
        .fans = TL_NEW_ARRAY(uint32_t, source->vertex_count),
    };
    find_edges(source, &net);
    find_neighbours(&net);
    return net;
}

static void net_release(struct net *net)
{
    free(net->edges);
    free(net->edge_of);
    free(net->firsts);
    free(net->around);
    free(net->fans);
}

static uint32_t other_end(const struct edge *edge, uint32_t vertex)
{
    return edge->ends[edge->ends[0] == vertex];
}

/* Sparse rows of weights. */
struct weight_rows {
    size_t count, room;
    size_t *firsts; /* [rows + 1] */
    uint32_t *sources;
    double *weights;
};

static void add_weight(struct weight_rows *rows, uint32_t source, double weight)
{
    if (rows->count == rows->room) {
        rows->room = rows->room ? 2 * rows->room : 4096;
        rows->sources = tl_resize(rows->sources, rows->room, sizeof *rows->sources);
        rows->weights = tl_resize(rows->weights, rows->room, sizeof *rows->weights);
    }
    rows->sources[rows->count] = source;
    rows->weights[rows->count++] = weight;
}

static void rows_release(struct weight_rows *rows)
{
    free(rows->firsts);
    free(rows->sources);
    free(rows->weights);
}

/* Weights of a vertex and its neighbours: `smooth` for each neighbour within the surface, `crease` for each
 * of the two along a crease. */
static void add_vertex(const struct net *net, uint32_t vertex, double (*smooth)(size_t), double crease,
                       struct weight_rows *rows)
{
    size_t first = net->firsts[vertex], end = net->firsts[vertex + 1], creases = 0;
    for (size_t i = first; i < end; i++)
        creases += net->edges[net->around[i]].is_crease;
    bool is_smooth = creases == 0 && end > first;
    bool bends = creases == 2 && net->fans[vertex] > 1;
    double weight = is_smooth ? smooth(end - first) : crease, rest = 1;
    for (size_t i = first; (is_smooth || bends) && i < end; i++)
        if (is_smooth || net->edges[net->around[i]].is_crease) {
            add_weight(rows, other_end(&net->edges[net->around[i]], vertex), weight);
            rest -= weight;
        }
    add_weight(rows, vertex, rest);
}

/* Loop's weight of one of n neighbours. */
static double step_weight(size_t n)
{
    double cosine = 3.0 / 8 + cos(2 * M_PI / (double)n) / 4;
    return (5.0 / 8 - cosine * cosine) / (double)n;
}

/* Its weight in the limit. */
static double limit_weight(size_t n)
{
    return 1 / ((double)n + 3 / (8 * step_weight(n)));
}

static struct weight_rows step_rows(const struct net *net)
{
    size_t count = net->vertex_count + net->edge_count;
    struct weight_rows rows = {.firsts = TL_NEW_ARRAY(size_t, count + 1)};
    for (uint32_t v = 0; v < net->vertex_count; v++) {
        add_vertex(net, v, step_weight, 1.0 / 8, &rows);
        rows.firsts[v + 1] = rows.count;
    }
    for (size_t e = 0; e < net->edge_count; e++) {
        const struct edge *edge = &net->edges[e];
        for (int k = 0; k < 2; k++)
            add_weight(&rows, edge->ends[k], edge->is_crease ? 1.0 / 2 : 3.0 / 8);
        for (int k = 0; !edge->is_crease && k < 2; k++)
            add_weight(&rows, edge->opposite[k], 1.0 / 8);
        rows.firsts[net->vertex_count + e + 1] = rows.count;
    }
    return rows;
}

static struct weight_rows limit_rows(const struct net *net)
{
    struct weight_rows rows = {.firsts = TL_NEW_ARRAY(size_t, net->vertex_count + 1)};
    for (uint32_t v = 0; v < net->vertex_count; v++) {
        add_vertex(net, v, limit_weight, 1.0 / 6, &rows);
        rows.firsts[v + 1] = rows.count;
    }
    return rows;
}

/* Splits the triangles, of which those without an area have none that counts; writes the creases of the new
 * ones, each half of an old edge. */
static void split(const struct net *net, uint32_t (*triangles)[3], bool (*creases)[3])
{
    for (size_t t = 0; t < net->triangle_count; t++) {
        const uint32_t *edges = net->edge_of[t];
        for (size_t k = 0; k < 4; k++) {
            uint32_t *child = triangles[4 * t + k];
            for (size_t c = 0; c < 3; c++)
                child[c] = has_area(net->triangles[t])
                               ? (uint32_t)(net->vertex_count + edges[k == 3 ? c : (k + 3 - c) % 3])
                               : net->triangles[t][0];
            if (k == 3 || !has_area(net->triangles[t]))
                continue;
            child[0] = net->triangles[t][k];
            creases[4 * t + k][1] = net->edges[edges[(k + 1) % 3]].is_crease;
            creases[4 * t + k][2] = net->edges[edges[(k + 2) % 3]].is_crease;
        }
    }
}

/* The product of both, each row's sources rising in order of their first use. */
static void compose(const struct weight_rows *step, const struct weight_rows *limit, size_t source_count,
                    struct tl_smooth *out)
{
    double *sums = TL_NEW_ARRAY(double, source_count);
    bool *is_used = TL_NEW_ARRAY(bool, source_count);
    struct weight_rows rows = {.firsts = TL_NEW_ARRAY(size_t, out->vertex_count + 1)};
    for (size_t i = 0; i < out->vertex_count; i++) {
        for (size_t m = limit->firsts[i]; m < limit->firsts[i + 1]; m++)
            for (size_t s = step->firsts[limit->sources[m]]; s < step->firsts[limit->sources[m] + 1]; s++) {
                uint32_t source = step->sources[s];
                if (!is_used[source])
                    add_weight(&rows, source, 0);
                is_used[source] = true;
                sums[source] += limit->weights[m] * step->weights[s];
            }
        for (size_t r = rows.firsts[i]; r < rows.count; r++) {
            rows.weights[r] = sums[rows.sources[r]];
            sums[rows.sources[r]] = 0;
            is_used[rows.sources[r]] = false;
        }
        rows.firsts[i + 1] = rows.count;
    }
    out->firsts = rows.firsts;
    out->sources = rows.sources;
    out->weights = TL_NEW_ARRAY(float, rows.count);
    for (size_t r = 0; r < rows.count; r++)
        out->weights[r] = (float)rows.weights[r];
    free(rows.weights);
    free(sums);
    free(is_used);
}

struct tl_smooth tl_smooth_make(const struct tl_smooth_source *source)
{
    struct net net = net_make(source);
    struct tl_smooth smooth = {
        .source_count = source->vertex_count,
        .vertex_count = source->vertex_count + net.edge_count,
        .triangle_count = 4 * source->triangle_count,
        .triangles = tl_alloc(4 * source->triangle_count, sizeof *smooth.triangles),
        .ends = tl_alloc(net.edge_count, sizeof *smooth.ends),
    };
    bool(*creases)[3] = tl_alloc(smooth.triangle_count, sizeof *creases);
    memset(creases, 0, smooth.triangle_count * sizeof *creases);
    for (size_t e = 0; e < net.edge_count; e++)
        memcpy(smooth.ends[e], net.edges[e].ends, sizeof *smooth.ends);
    split(&net, smooth.triangles, creases);
    struct net finer = net_make(&(struct tl_smooth_source){smooth.vertex_count, smooth.triangle_count,
                                                           (const uint32_t(*)[3])smooth.triangles,
                                                           (const bool(*)[3])creases});
    struct weight_rows step = step_rows(&net), limit = limit_rows(&finer);
    compose(&step, &limit, source->vertex_count, &smooth);
    rows_release(&step);
    rows_release(&limit);
    net_release(&finer);
    net_release(&net);
    free(creases);
    return smooth;
}

void tl_smooth_release(struct tl_smooth *smooth)
{
    free(smooth->triangles);
    free(smooth->ends);
    free(smooth->firsts);
    free(smooth->sources);
    free(smooth->weights);
    *smooth = (struct tl_smooth){0};
}

void tl_smooth_apply(const struct tl_smooth *smooth, const vec3s *coarse, vec3s *fine)
{
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < smooth->vertex_count; i++) {
        vec3s sum = {{0, 0, 0}};
        for (size_t k = smooth->firsts[i]; k < smooth->firsts[i + 1]; k++)
            sum = glms_vec3_muladds(coarse[smooth->sources[k]], smooth->weights[k], sum);
        fine[i] = sum;
    }
}
