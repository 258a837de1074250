#include "assets/sewing/delaunay_ring.h"

#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* A side of the ring that is being put in, and the triangles that it crosses. */
struct ring_side {
    const struct tl_point *points;
    uint32_t a, b;
    uint32_t (*triangles)[3]; /* all */
    uint32_t *crossed;        /* indices into them, reused as they are triangulated again */
    size_t crossed_count, reused;
    uint32_t *chains[2]; /* vertices of the hole left and right of a -> b, in that order */
    size_t counts[2];
};

/* Twice the area, positive where c is left of a -> b. */
static double side_of(const struct tl_point *p, uint32_t a, uint32_t b, uint32_t c)
{
    return (p[b].x - p[a].x) * (p[c].y - p[a].y) - (p[c].x - p[a].x) * (p[b].y - p[a].y);
}

static bool crosses(const struct tl_point *p, uint32_t a, uint32_t b, uint32_t u, uint32_t v)
{
    if (u == a || u == b || v == a || v == b)
        return false;
    return side_of(p, a, b, u) * side_of(p, a, b, v) < 0 && side_of(p, u, v, a) * side_of(p, u, v, b) < 0;
}

static void find_crossed(struct ring_side *side, size_t triangle_count)
{
    side->crossed_count = 0;
    for (size_t t = 0; t < triangle_count; t++) {
        const uint32_t *v = side->triangles[t];
        bool is_crossed = false;
        for (int k = 0; k < 3; k++)
            is_crossed |= crosses(side->points, side->a, side->b, v[k], v[(k + 1) % 3]);
        if (is_crossed)
            side->crossed[side->crossed_count++] = (uint32_t)t;
    }
}

/* The corner of a crossed triangle opposite its side u -> v; false when none has this side. */
static bool opposite(const struct ring_side *side, uint32_t u, uint32_t v, uint32_t *out)
{
    for (size_t i = 0; i < side->crossed_count; i++) {
        const uint32_t *corner = side->triangles[side->crossed[i]];
        for (int k = 0; k < 3; k++) {
            if (corner[k] == u && corner[(k + 1) % 3] == v) {
                *out = corner[(k + 2) % 3];
                return true;
            }
        }
    }
    return false;
}

/* The side opposite a in the first triangle that a -> b crosses: left end first. */
static bool first_side(const struct ring_side *side, uint32_t *left, uint32_t *right)
{
    for (size_t i = 0; i < side->crossed_count; i++) {
        const uint32_t *corner = side->triangles[side->crossed[i]];
        for (int k = 0; k < 3; k++) {
            if (corner[k] != side->a)
                continue;
            *right = corner[(k + 1) % 3];
            *left = corner[(k + 2) % 3];
            return true;
        }
    }
    return false;
}

/* Walks along a -> b and lists what lies left and right of it. */
static bool find_chains(struct ring_side *side)
{
    uint32_t left, right, next;
    if (!first_side(side, &left, &right))
        return false;
    side->counts[0] = side->counts[1] = 1;
    side->chains[0][0] = left;
    side->chains[1][0] = right;
    for (size_t step = 0; step < side->crossed_count; step++) {
        if (!opposite(side, left, right, &next))
            return false;
        if (next == side->b)
            return side->counts[0] + side->counts[1] == side->crossed_count;
        double height = side_of(side->points, side->a, side->b, next);
        if (height == 0)
            return false;
        int chain = height < 0;
        side->chains[chain][side->counts[chain]++] = next;
        *(chain ? &right : &left) = next;
    }
    return false;
}

/* Whether d lies inside the circle through a, b, c, in any order. */
static bool is_in_circle(const struct tl_point *p, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    double m[3][3];
    const uint32_t v[3] = {a, b, c};
    for (int i = 0; i < 3; i++) {
        m[i][0] = p[v[i]].x - p[d].x;
        m[i][1] = p[v[i]].y - p[d].y;
        m[i][2] = m[i][0] * m[i][0] + m[i][1] * m[i][1];
    }
    double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    return side_of(p, a, b, c) > 0 ? determinant > 0 : determinant < 0;
}

/* Triangulates the hole between the side a -> b and a chain from a to b. */
static void fill_hole(struct ring_side *side, uint32_t a, uint32_t b, const uint32_t *chain, size_t count)
{
    if (count == 0)
        return;
    size_t chosen = 0;
    for (size_t i = 1; i < count; i++)
        if (is_in_circle(side->points, a, b, chain[chosen], chain[i]))
            chosen = i;
    uint32_t c = chain[chosen];
    uint32_t *out = side->triangles[side->crossed[side->reused++]];
    bool is_left = side_of(side->points, a, b, c) > 0;
    memcpy(out, (uint32_t[3]){a, is_left ? b : c, is_left ? c : b}, 3 * sizeof *out);
    fill_hole(side, a, c, chain, chosen);
    fill_hole(side, c, b, chain + chosen + 1, count - chosen - 1);
}

/* present[i]: whether the ring's side from i to its next point is a side of a triangle. Returns how many are
 * not. */
static size_t find_missing(size_t ring_count, const uint32_t (*triangles)[3], size_t triangle_count,
                           bool *present)
{
    size_t missing = ring_count;
    memset(present, 0, ring_count * sizeof *present);
    for (size_t i = 0; i < 3 * triangle_count; i++) {
        size_t a = triangles[i / 3][i % 3], b = triangles[i / 3][(i + 1) % 3];
        if (a >= ring_count || b >= ring_count)
            continue;
        size_t from = b == (a + 1) % ring_count ? a : a == (b + 1) % ring_count ? b : ring_count;
        if (from == ring_count || present[from])
            continue;
        present[from] = true;
        missing--;
    }
    return missing;
}

bool tl_delaunay_follow(const struct tl_point *points, size_t ring_count, uint32_t (*triangles)[3],
                        size_t triangle_count)
{
    bool *present = TL_NEW_ARRAY(bool, ring_count);
    bool follows = find_missing(ring_count, (const uint32_t(*)[3])triangles, triangle_count, present) == 0;
    if (!follows) {
        struct ring_side side = {.points = points, .triangles = triangles};
        side.crossed = TL_NEW_ARRAY(uint32_t, triangle_count);
        for (int k = 0; k < 2; k++)
            side.chains[k] = TL_NEW_ARRAY(uint32_t, triangle_count + 1);
        for (uint32_t i = 0; i < ring_count; i++) {
            if (present[i])
                continue;
            side.a = i;
            side.b = (uint32_t)((i + 1) % ring_count);
            side.reused = 0;
            find_crossed(&side, triangle_count);
            if (!find_chains(&side))
                continue;
            fill_hole(&side, side.a, side.b, side.chains[0], side.counts[0]);
            fill_hole(&side, side.a, side.b, side.chains[1], side.counts[1]);
        }
        for (int k = 0; k < 2; k++)
            free(side.chains[k]);
        free(side.crossed);
        follows = find_missing(ring_count, (const uint32_t(*)[3])triangles, triangle_count, present) == 0;
    }
    free(present);
    return follows;
}
