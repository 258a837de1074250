#include "assets/cut/garment_cut_internal.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

/* A grid over a flat pattern: each square lists the triangles that come within half a square of it. */
struct squares {
    double side, low[2];
    size_t across[2];
    uint32_t *first, *items; /* [across[0] * across[1] + 1], and first's last */
};

struct square_span {
    size_t low[2], high[2]; /* inclusive */
};

static size_t square_at(const struct squares *squares, int axis, double place)
{
    double number = floor((place - squares->low[axis]) / squares->side);
    return (size_t)fmin(fmax(number, 0), (double)squares->across[axis] - 1);
}

static struct square_span span_of(const struct squares *squares, const tl_garment *garment, size_t triangle)
{
    const uint32_t *v = &garment->model.mesh.indices[3 * triangle];
    struct square_span span;
    for (int axis = 0; axis < 2; axis++) {
        double low = INFINITY, high = -INFINITY;
        for (int k = 0; k < 3; k++) {
            low = fmin(low, (double)garment->pattern[v[k]].raw[axis]);
            high = fmax(high, (double)garment->pattern[v[k]].raw[axis]);
        }
        span.low[axis] = square_at(squares, axis, low - squares->side / 2);
        span.high[axis] = square_at(squares, axis, high + squares->side / 2);
    }
    return span;
}

/* Counts, or with `fill` lists, the triangles of each square. */
static void visit(struct squares *squares, const tl_garment *garment, bool fill)
{
    for (size_t t = 0; t < garment->model.mesh.index_count / 3; t++) {
        struct square_span span = span_of(squares, garment, t);
        for (size_t y = span.low[1]; y <= span.high[1]; y++)
            for (size_t x = span.low[0]; x <= span.high[0]; x++) {
                uint32_t *first = &squares->first[y * squares->across[0] + x];
                if (fill)
                    squares->items[--*first] = (uint32_t)t;
                else
                    (*first)++;
            }
    }
}

static struct squares sort_triangles(const tl_garment *garment, double side)
{
    const size_t vertices = garment->model.mesh.vertex_count;
    struct squares squares = {.side = side};
    for (int axis = 0; axis < 2; axis++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t v = 0; v < vertices; v++) {
            low = fmin(low, (double)garment->pattern[v].raw[axis]);
            high = fmax(high, (double)garment->pattern[v].raw[axis]);
        }
        squares.low[axis] = low;
        squares.across[axis] = (size_t)((high - low) / side) + 1;
    }
    size_t count = squares.across[0] * squares.across[1];
    squares.first = TL_NEW_ARRAY(uint32_t, count + 1);
    visit(&squares, garment, false);
    for (size_t i = 1; i <= count; i++) /* ends first: filling then counts down to the beginnings */
        squares.first[i] += squares.first[i - 1];
    squares.items = TL_NEW_ARRAY(uint32_t, squares.first[count]);
    visit(&squares, garment, true);
    return squares;
}

/* Barycentric coordinates of a point in the pattern: their sum is 1; outside the triangle one is negative. */
static void find_weights(const tl_garment *garment, const uint32_t v[3], vec2s point, double weights[3])
{
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        vec2s a = garment->pattern[v[(k + 1) % 3]], b = garment->pattern[v[(k + 2) % 3]];
        weights[k] = ((double)a.x - (double)point.x) * ((double)b.y - (double)point.y) -
                     ((double)b.x - (double)point.x) * ((double)a.y - (double)point.y);
        sum += weights[k];
    }
    for (int k = 0; k < 3; k++)
        weights[k] /= sum;
}

static void carry(const tl_garment *coarse, const struct squares *squares, vec2s point, double position[3])
{
    size_t square =
        square_at(squares, 1, (double)point.y) * squares->across[0] + square_at(squares, 0, (double)point.x);
    double best = -INFINITY;
    for (uint32_t n = squares->first[square]; n < squares->first[square + 1]; n++) {
        const uint32_t *v = &coarse->model.mesh.indices[3 * (size_t)squares->items[n]];
        double weights[3];
        find_weights(coarse, v, point, weights);
        double inside = fmin(fmin(weights[0], weights[1]), weights[2]);
        if (!(inside > best))
            continue;
        best = inside;
        for (int c = 0; c < 3; c++)
            position[c] = weights[0] * (double)coarse->model.mesh.positions[v[0]].raw[c] +
                          weights[1] * (double)coarse->model.mesh.positions[v[1]].raw[c] +
                          weights[2] * (double)coarse->model.mesh.positions[v[2]].raw[c];
    }
}

void tl_cut_carry(const tl_garment *coarse, double edge_m, const tl_garment *garment, double (*positions)[3])
{
    struct squares squares = sort_triangles(coarse, edge_m);
    bool *pinned = TL_NEW_ARRAY(bool, garment->model.mesh.vertex_count);
    for (size_t i = 0; i < garment->pin_count; i++)
        pinned[garment->pins[i]] = true;
    for (size_t v = 0; v < garment->model.mesh.vertex_count; v++)
        if (!pinned[v])
            carry(coarse, &squares, garment->pattern[v], positions[v]);
    free(pinned);
    free(squares.first);
    free(squares.items);
}
