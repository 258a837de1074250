#include "assets/obj/polygon.h"

#include <stdbool.h>

/* A polygon projected along its normal. */
struct outline {
    const vec3s *corners;
    vec3s right, up;
    uint32_t *left; /* corners not yet cut off, in order */
    size_t count;
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

static double turn(const struct outline *outline, uint32_t a, uint32_t b, uint32_t c)
{
    vec3s ab = glms_vec3_sub(outline->corners[b], outline->corners[a]);
    vec3s ac = glms_vec3_sub(outline->corners[c], outline->corners[a]);
    return (double)glms_vec3_dot(ab, outline->right) * (double)glms_vec3_dot(ac, outline->up) -
           (double)glms_vec3_dot(ab, outline->up) * (double)glms_vec3_dot(ac, outline->right);
}

/* Whether corner `at` is an ear: it and its neighbours form a left-turning triangle that holds no other
 * corner. */
static bool is_ear(const struct outline *outline, size_t at)
{
    size_t count = outline->count;
    uint32_t a = outline->left[(at + count - 1) % count], b = outline->left[at],
             c = outline->left[(at + 1) % count];
    if (!(turn(outline, a, b, c) > 0))
        return false;
    for (size_t i = 0; i < count; i++) {
        uint32_t p = outline->left[i];
        if (p != a && p != b && p != c && turn(outline, a, b, p) >= 0 && turn(outline, b, c, p) >= 0 &&
            turn(outline, c, a, p) >= 0)
            return false;
    }
    return true;
}

/* The first ear from `from` on, or `from` when there is none: the polygon is degenerate or crosses itself. */
static size_t find_ear(const struct outline *outline, size_t from)
{
    for (size_t i = 0; i < outline->count; i++) {
        size_t at = (from + i) % outline->count;
        if (is_ear(outline, at))
            return at;
    }
    return from % outline->count;
}

void tl_polygon_cut(const vec3s *corners, size_t count, uint32_t *triangles, uint32_t *scratch)
{
    vec3s normal = glms_vec3_normalize(area_vector(corners, count));
    vec3s right = glms_vec3_ortho(normal);
    struct outline outline = {.corners = corners,
                              .right = glms_vec3_normalize(right),
                              .up = glms_vec3_cross(normal, glms_vec3_normalize(right)),
                              .left = scratch,
                              .count = count};
    for (size_t i = 0; i < count; i++)
        scratch[i] = (uint32_t)i;
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
}
