#include "assets/obj/polygon.h"

#include "config/base/memory.h"

#include <stdbool.h>
#include <stdlib.h>

/* A polygon projected along its normal. */
struct point {
    double x, y;
};
struct outline {
    struct point *points; /* of all corners */
    uint32_t *left;       /* corners not yet cut off, in order */
    size_t count;
    size_t tests_left; /* of corners against triangles */
};

/* Newell's: the sum of the cross products of its edges is twice its area, for any flat polygon. */
static vec3s area_vector(const vec3s *corners, size_t count)
{
    vec3s sum = {{0, 0, 0}};
    for (size_t i = 1; i + 1 < count; i++)
        sum = glms_vec3_add(sum, glms_vec3_cross(glms_vec3_sub(corners[i], corners[0]),
                                                 glms_vec3_sub(corners[i + 1], corners[0])));
    return sum;
}

/* Twice the area of a triangle, positive when it turns to the left. */
static double turn(const struct outline *outline, uint32_t a, uint32_t b, uint32_t c)
{
    const struct point *p = outline->points;
    return (p[b].x - p[a].x) * (p[c].y - p[a].y) - (p[b].y - p[a].y) * (p[c].x - p[a].x);
}

/* Whether corner `at` is an ear: it and its neighbours form a left-turning triangle that holds no other
 * corner. */
static bool is_ear(struct outline *outline, size_t at)
{
    size_t count = outline->count;
    uint32_t a = outline->left[at > 0 ? at - 1 : count - 1], b = outline->left[at],
             c = outline->left[at + 1 < count ? at + 1 : 0];
    bool ear = turn(outline, a, b, c) > 0;
    size_t i = 0;
    for (; ear && i < count; i++) {
        uint32_t p = outline->left[i];
        ear = p == a || p == b || p == c || turn(outline, a, b, p) < 0 || turn(outline, b, c, p) < 0 ||
              turn(outline, c, a, p) < 0;
    }
    outline->tests_left -= i + 1 < outline->tests_left ? i + 1 : outline->tests_left;
    return ear;
}

/* The first ear from `from` on, or `from` when there is none (the polygon is degenerate or crosses itself) or
 * all tests are used up. */
static size_t find_ear(struct outline *outline, size_t from)
{
    for (size_t i = 0; i < outline->count && outline->tests_left > 0; i++) {
        size_t at = (from + i) % outline->count;
        if (is_ear(outline, at))
            return at;
    }
    return from % outline->count;
}

/* A polygon that does not cross itself takes at most about count^2 / 2 tests. One that does may have no ear
 * at most steps, which would take count^3. */
static size_t tests_for(size_t count)
{
    const size_t for_small = 4096;
    return for_small + count * count;
}

void tl_polygon_cut(const vec3s *corners, size_t count, uint32_t *triangles, uint32_t *scratch)
{
    vec3s normal = glms_vec3_normalize(area_vector(corners, count));
    vec3s right = glms_vec3_normalize(glms_vec3_ortho(normal)), up = glms_vec3_cross(normal, right);
    struct outline outline = {.points = TL_NEW_ARRAY(struct point, count),
                              .left = scratch,
                              .count = count,
                              .tests_left = tests_for(count)};
    for (size_t i = 0; i < count; i++) {
        for (int c = 0; c < 3; c++) {
            double from_first = (double)corners[i].raw[c] - (double)corners[0].raw[c];
            outline.points[i].x += from_first * (double)right.raw[c];
            outline.points[i].y += from_first * (double)up.raw[c];
        }
        scratch[i] = (uint32_t)i;
    }
    /* Moves on two corners after each cut: ears are taken from all around, not as a fan from one corner. */
    for (size_t at = 1; outline.count >= 3; at++) {
        at = find_ear(&outline, at);
        *triangles++ = outline.left[(at + outline.count - 1) % outline.count];
        *triangles++ = outline.left[at];
        *triangles++ = outline.left[(at + 1) % outline.count];
        outline.count--;
        for (size_t i = at; i < outline.count; i++)
            outline.left[i] = outline.left[i + 1];
    }
    free(outline.points);
}
