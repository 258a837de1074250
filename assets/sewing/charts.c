#include "assets/sewing/charts.h"

#include "assets/topology/sets.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Charts ---- */

/* A vertex by what charts agree about. */
struct chart_point {
    float key[5]; /* position, UV */
    uint32_t vertex;
};

static int compare_points(const void *a, const void *b)
{
    const struct chart_point *p = a, *q = b;
    for (int i = 0; i < 5; i++)
        if (p->key[i] != q->key[i])
            return p->key[i] < q->key[i] ? -1 : 1;
    return 0;
}

/* Joins vertices that only differ in their normals. The caller frees the numbers [vertex_count]. */
static uint32_t *number_points(const tl_mesh *mesh)
{
    struct chart_point *points = TL_NEW_ARRAY(struct chart_point, mesh->vertex_count);
    uint32_t *numbers = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        vec3s at = mesh->positions[i];
        vec2s uv = mesh->uvs[i];
        points[i] = (struct chart_point){{at.x, at.y, at.z, uv.x, uv.y}, (uint32_t)i};
    }
    qsort(points, mesh->vertex_count, sizeof *points, compare_points);
    for (size_t i = 0, first = 0; i < mesh->vertex_count; i++) {
        if (compare_points(&points[first], &points[i]) != 0)
            first = i;
        numbers[points[i].vertex] = (uint32_t)first;
    }
    free(points);
    return numbers;
}

struct chart_side {
    uint32_t a, b; /* points, a < b */
    uint32_t triangle;
};

static int compare_sides(const void *first, const void *second)
{
    const struct chart_side *p = first, *q = second;
    if (p->a != q->a)
        return p->a < q->a ? -1 : 1;
    if (p->b != q->b)
        return p->b < q->b ? -1 : 1;
    return (p->triangle > q->triangle) - (p->triangle < q->triangle);
}

static struct chart_side *sort_sides(const tl_mesh *mesh)
{
    uint32_t *numbers = number_points(mesh);
    struct chart_side *sides = TL_NEW_ARRAY(struct chart_side, mesh->index_count);
    for (size_t i = 0; i < mesh->index_count; i++) {
        uint32_t a = numbers[mesh->indices[i]], b = numbers[mesh->indices[i % 3 == 2 ? i - 2 : i + 1]];
        sides[i] = (struct chart_side){a < b ? a : b, a < b ? b : a, (uint32_t)(i / 3)};
    }
    qsort(sides, mesh->index_count, sizeof *sides, compare_sides);
    free(numbers);
    return sides;
}

/* Numbers the charts; `charts` has triangle_count. */
static void number_charts(const tl_mesh *mesh, struct tl_charts *charts)
{
    uint32_t *parents = tl_sets_create(charts->triangle_count);
    charts->of_triangle = TL_NEW_ARRAY(uint32_t, charts->triangle_count);
    struct chart_side *sides = sort_sides(mesh);
    for (size_t i = 1; i < 3 * charts->triangle_count; i++)
        if (sides[i].a == sides[i - 1].a && sides[i].b == sides[i - 1].b)
            tl_sets_join(parents, sides[i].triangle, sides[i - 1].triangle);
    free(sides);
    for (size_t t = 0; t < charts->triangle_count; t++) {
        uint32_t root = tl_sets_find(parents, (uint32_t)t); /* the lowest */
        charts->of_triangle[t] = root == t ? (uint32_t)charts->count++ : charts->of_triangle[root];
    }
    free(parents);
}

/* ---- Maps from UVs to space ---- */

struct chart_map {
    double area;       /* m^2, in space */
    double uu, uv, vv; /* the metric F^T F of F = [F_u F_v] = [sides] [sides in UV]^-1, m^2 per unit^2 */
    double log_ratio;  /* of the areas in space and in UV: the sum of the singular values' logarithms */
    bool mapped;
    bool faces_back;
};

static struct chart_map map_triangle(const tl_mesh *mesh, const uint32_t *v)
{
    const double flattest = 1e-6; /* a triangle's height over its longest side; less is rounding */
    double sides[2][3], flat[2][2], lengths[2] = {0}, flat_lengths[2] = {0}, dot = 0;
    for (int i = 0; i < 2; i++) {
        for (int c = 0; c < 3; c++) {
            sides[i][c] = (double)mesh->positions[v[i + 1]].raw[c] - (double)mesh->positions[v[0]].raw[c];
            lengths[i] += sides[i][c] * sides[i][c];
        }
        for (int c = 0; c < 2; c++) {
            flat[i][c] = (double)mesh->uvs[v[i + 1]].raw[c] - (double)mesh->uvs[v[0]].raw[c];
            flat_lengths[i] += flat[i][c] * flat[i][c];
        }
    }
    double determinant = flat[0][0] * flat[1][1] - flat[1][0] * flat[0][1];
    for (int c = 0; c < 3; c++)
        dot += sides[0][c] * sides[1][c];
    struct chart_map map = {.area = sqrt(fmax(lengths[0] * lengths[1] - dot * dot, 0)) / 2,
                            .faces_back = determinant > 0}; /* v runs downwards */
    map.mapped = fabs(determinant) > flattest * fmax(flat_lengths[0], flat_lengths[1]) &&
                 2 * map.area > flattest * fmax(lengths[0], lengths[1]);
    if (!map.mapped)
        return map;
    map.log_ratio = log(2 * map.area / fabs(determinant));
    for (int c = 0; c < 3; c++) {
        double along_u = (sides[0][c] * flat[1][1] - sides[1][c] * flat[0][1]) / determinant;
        double along_v = (sides[1][c] * flat[0][0] - sides[0][c] * flat[1][0]) / determinant;
        map.uu += along_u * along_u, map.uv += along_u * along_v, map.vv += along_v * along_v;
    }
    return map;
}

static struct chart_map *map_triangles(const tl_mesh *mesh, size_t count)
{
    struct chart_map *maps = TL_NEW_ARRAY(struct chart_map, count);
    for (size_t t = 0; t < count; t++)
        maps[t] = map_triangle(mesh, &mesh->indices[3 * t]);
    return maps;
}

/* The logarithms of the singular values, the larger one first, where a unit of u is scale[0] metres and one
 * of v scale[1]. */
static void stretch_of(const struct chart_map *map, const double scale[2], double logs[2])
{
    double uu = map->uu / (scale[0] * scale[0]), vv = map->vv / (scale[1] * scale[1]);
    double uv = map->uv / (scale[0] * scale[1]), half = hypot((uu - vv) / 2, uv), middle = (uu + vv) / 2;
    logs[0] = log(middle + half) / 2;
    logs[1] = map->log_ratio - log(scale[0] * scale[1]) - logs[0];
}

/* ---- Scale ---- */

struct weighted {
    double value, weight;
};

static int compare_weighted(const void *a, const void *b)
{
    double p = ((const struct weighted *)a)->value, q = ((const struct weighted *)b)->value;
    return (p > q) - (p < q);
}

struct interval {
    size_t first, end;
    double weight;
};

/* The shortest interval within `from` that has half of its weight; of intervals that are equally short, the
 * lowest. */
static struct interval find_half(const struct weighted *values, struct interval from)
{
    const double equal = 1e-4, rounding = 1e-9;
    const double minimum = from.weight / 2 * (1 - rounding);
    struct interval best = from;
    double within = 0, shortest = values[from.end - 1].value - values[from.first].value;
    for (size_t i = from.first, j = i; i < from.end; within -= values[i++].weight) {
        while (j < from.end && within < minimum)
            within += values[j++].weight;
        if (within < minimum)
            break;
        double length = values[j - 1].value - values[i].value;
        if (length < shortest - equal) {
            shortest = length;
            best = (struct interval){i, j, within};
        }
    }
    return best;
}

/* The mode of weighted values: halves of halves [Bickel and Fruehwirth 2006] down to an interval as narrow as
 * `finest`, and the mean of that. Sorts the values. */
static double find_mode(struct weighted *values, size_t count)
{
    const double finest = 0.01;
    struct interval now = {0, count, 0};
    double sum = 0, weight = 0;
    qsort(values, count, sizeof *values, compare_weighted);
    for (size_t i = 0; i < count; i++)
        now.weight += values[i].weight;
    while (values[now.end - 1].value - values[now.first].value > finest) {
        struct interval half = find_half(values, now);
        if (half.first == now.first && half.end == now.end)
            break;
        now = half;
    }
    for (size_t i = now.first; i < now.end; i++)
        sum += values[i].weight * values[i].value, weight += values[i].weight;
    return sum / weight;
}

/* One scale for u and v. Most cloth of a garment hangs nearly unstrained, and a body stretches it rather than
 * compress it: the most frequent singular value is that of cloth at rest, and of two the lower one. */
static void fit_scale(const struct chart_map *maps, size_t count, struct weighted *values, double scale[2])
{
    const double unit[2] = {1, 1};
    size_t used = 0;
    for (size_t t = 0; t < count; t++) {
        if (!maps[t].mapped)
            continue;
        double logs[2];
        stretch_of(&maps[t], unit, logs);
        for (int i = 0; i < 2; i++)
            values[used++] = (struct weighted){logs[i], maps[t].area};
    }
    scale[0] = scale[1] = used > 0 ? exp(find_mode(values, used)) : 0;
}

/* A scale for u and one for v: of cloth at rest, F_u and F_v are as long, however its charts are turned. */
static void fit_scales(const struct chart_map *maps, size_t count, struct weighted *values, double scale[2])
{
    for (int axis = 0; axis < 2; axis++) {
        size_t used = 0;
        for (size_t t = 0; t < count; t++)
            if (maps[t].mapped)
                values[used++] =
                    (struct weighted){log(axis == 0 ? maps[t].uu : maps[t].vv) / 2, maps[t].area};
        scale[axis] = used > 0 ? exp(find_mode(values, used)) : 0;
    }
}

/* ---- Judgement ---- */

static double clamp(double x, double maximum)
{
    return fmin(fmax(x, -maximum), maximum);
}

/* Adds a triangle to the sums that finish() turns into means. */
static void add_triangle(struct tl_chart *chart, const struct chart_map *map, const double scale[2])
{
    const double maximum = log(2);
    double logs[2];
    chart->area += map->area;
    if (!map->mapped) {
        chart->unmapped_share += map->area;
        return;
    }
    stretch_of(map, scale, logs);
    chart->residual += map->area * (pow(clamp(logs[0], maximum), 2) + pow(clamp(logs[1], maximum), 2)) / 2;
    chart->log_scale += map->area * (logs[0] + logs[1]) / 2;
    chart->stretched_share += fmax(fabs(logs[0]), fabs(logs[1])) > TL_CHART_STRETCHED ? map->area : 0;
    chart->folded_share += map->faces_back ? map->area : 0;
}

static void finish(struct tl_chart *chart)
{
    double mapped = chart->area - chart->unmapped_share;
    if (!(mapped > 0)) {
        chart->unmapped_share = 1;
        return;
    }
    chart->residual = sqrt(chart->residual / mapped);
    chart->log_scale /= mapped;
    chart->stretched_share /= chart->area;
    chart->folded_share /= chart->area;
    chart->unmapped_share /= chart->area;
}

static enum tl_chart_verdict judge(const struct tl_chart *chart)
{
    if (chart->unmapped_share > TL_CHART_UNMAPPED)
        return TL_CHART_IS_UNMAPPED;
    if (fabs(chart->log_scale) > TL_CHART_RESCALED)
        return TL_CHART_IS_RESCALED;
    if (chart->folded_share > TL_CHART_FOLDED)
        return TL_CHART_IS_FOLDED;
    return chart->residual > TL_CHART_RESIDUAL ? TL_CHART_IS_STRETCHED : TL_CHART_IS_PATTERN;
}

/* The whole is what most of its area is. */
static enum tl_chart_verdict judge_whole(const struct tl_charts *charts)
{
    double areas[TL_CHART_IS_STRETCHED + 1] = {0};
    for (size_t c = 0; c < charts->count; c++)
        areas[charts->items[c].verdict] += charts->items[c].area;
    if (2 * areas[TL_CHART_IS_PATTERN] >= charts->whole.area && areas[TL_CHART_IS_PATTERN] > 0)
        return TL_CHART_IS_PATTERN;
    enum tl_chart_verdict maximum = TL_CHART_IS_UNMAPPED;
    for (enum tl_chart_verdict v = maximum; v <= TL_CHART_IS_STRETCHED; v++)
        maximum = areas[v] > areas[maximum] ? v : maximum;
    return maximum;
}

/* Measures and judges the charts at a scale. */
static void assess(struct tl_charts *charts, const struct chart_map *maps, const double scale[2])
{
    memset(charts->items, 0, charts->count * sizeof *charts->items);
    charts->whole = (struct tl_chart){0};
    charts->pattern_share = charts->pattern_residual = 0;
    charts->pattern_count = charts->mirrored_count = 0;
    memcpy(charts->metres_per_unit, scale, sizeof charts->metres_per_unit);
    for (size_t t = 0; t < charts->triangle_count; t++) {
        add_triangle(&charts->items[charts->of_triangle[t]], &maps[t], scale);
        add_triangle(&charts->whole, &maps[t], scale);
    }
    finish(&charts->whole);
    charts->whole.folded_share = 0;
    for (size_t c = 0; c < charts->count; c++) {
        struct tl_chart *chart = &charts->items[c];
        finish(chart);
        chart->mirrored = 2 * chart->folded_share > 1 - chart->unmapped_share;
        if (chart->mirrored)
            chart->folded_share = 1 - chart->unmapped_share - chart->folded_share;
        chart->verdict = judge(chart);
        charts->mirrored_count += chart->mirrored;
        charts->whole.folded_share += chart->folded_share * chart->area;
        if (chart->verdict != TL_CHART_IS_PATTERN)
            continue;
        charts->pattern_count++;
        charts->pattern_share += chart->area;
        charts->pattern_residual += chart->area * chart->residual * chart->residual;
    }
    charts->whole.verdict = judge_whole(charts);
    if (charts->pattern_share > 0)
        charts->pattern_residual = sqrt(charts->pattern_residual / charts->pattern_share);
    if (charts->whole.area > 0) {
        charts->pattern_share /= charts->whole.area;
        charts->whole.folded_share /= charts->whole.area;
    }
}

/* Whether the UVs fill a square of one texture, as those do that were fitted into it. */
static bool is_atlas(const tl_mesh *mesh)
{
    const float slack = 1e-3f;
    bool inside = true;
    for (size_t i = 0; i < 2 * mesh->vertex_count; i++) {
        float at = mesh->uvs[i / 2].raw[i % 2];
        inside = inside && at >= -slack && at <= 1 + slack;
    }
    return inside;
}

/* Two scales are taken where they explain an atlas much better than one. Of UVs that are not an atlas, such
 * as metres, and of nearly equal scales, the difference is the strain of worn cloth. */
static bool needs_two_scales(const double scales[2], double residual_of_two, double residual_of_one)
{
    const double noticed = 0.03, better = 0.5;
    return fabs(log(scales[0] / scales[1])) > noticed && residual_of_two < better * residual_of_one;
}

struct tl_charts tl_charts_find(const tl_mesh *mesh)
{
    struct tl_charts charts = {.triangle_count = mesh->index_count / 3};
    double scale[2], scales[2];
    number_charts(mesh, &charts);
    charts.items = TL_NEW_ARRAY(struct tl_chart, charts.count);
    struct chart_map *maps = map_triangles(mesh, charts.triangle_count);
    struct weighted *values = TL_NEW_ARRAY(struct weighted, 2 * charts.triangle_count);
    fit_scale(maps, charts.triangle_count, values, scale);
    assess(&charts, maps, scale);
    if (scale[0] > 0 && is_atlas(mesh)) {
        double residual = charts.whole.residual;
        fit_scales(maps, charts.triangle_count, values, scales);
        assess(&charts, maps, scales);
        if (!needs_two_scales(scales, charts.whole.residual, residual))
            assess(&charts, maps, scale);
    }
    free(values);
    free(maps);
    return charts;
}

void tl_charts_release(struct tl_charts *charts)
{
    free(charts->items);
    free(charts->of_triangle);
    *charts = (struct tl_charts){0};
}
