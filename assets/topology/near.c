#include "assets/topology/near_internal.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

enum { CLASSES = 3 }; /* seams, hems, darts */

struct near_entry {
    uint32_t border, next;
};

struct spreading {
    const tl_mesh *mesh;
    const struct tl_pieces *pieces;
    tl_borders *borders;
    uint32_t *heads; /* [triangle_count] of a list of entries */
    float (
        *bounds)[CLASSES]; /* [triangle_count] no point of it is farther than this from its nearest border */
    struct near_entry *entries;
    size_t entry_count, entry_capacity;
    struct step {
        uint32_t triangle, border;
    } * steps; /* a queue: each triangle hands what it accepts to its neighbours */
    size_t step_count, step_capacity;
};

static float to_segment(vec2s p, vec2s a, vec2s b)
{
    vec2s along = glms_vec2_sub(b, a), from = glms_vec2_sub(p, a);
    float square = glms_vec2_dot(along, along);
    float share = square > 0 ? glms_vec2_dot(from, along) / square : 0;
    share = fminf(fmaxf(share, 0), 1);
    return glms_vec2_norm(glms_vec2_sub(from, glms_vec2_scale(along, share)));
}

static float side_of(vec2s p, vec2s a, vec2s b)
{
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

static bool cross_each_other(vec2s a, vec2s b, vec2s c, vec2s d)
{
    return side_of(a, c, d) * side_of(b, c, d) < 0 && side_of(c, a, b) * side_of(d, a, b) < 0;
}

/* The smallest distance between a border and the points of a triangle, and the largest, which is at a corner
 * because a distance to a convex set is convex. UV units. A border lies on its piece's rim, so it is never
 * inside of a triangle without crossing or touching a side. */
static void bound_distance(const vec2s corners[3], const struct tl_border *border, float *low, float *high)
{
    vec2s a = {{border->from[0], border->from[1]}}, b = {{border->to[0], border->to[1]}};
    *low = INFINITY;
    *high = 0;
    for (int i = 0; i < 3; i++) {
        vec2s c = corners[i], d = corners[(i + 1) % 3];
        float corner = to_segment(c, a, b);
        *high = fmaxf(*high, corner);
        *low = fminf(*low, fminf(corner, fminf(to_segment(a, c, d), to_segment(b, c, d))));
        if (cross_each_other(a, b, c, d))
            *low = 0;
    }
}

static int class_of(const struct tl_border *border)
{
    return border->kind == (float)TL_BORDER_HEM ? 1 : border->kind == (float)TL_BORDER_DART ? 2 : 0;
}

static void bounds_of(const struct spreading *spreading, uint32_t triangle, const struct tl_border *border,
                      float *low_m, float *high_m)
{
    vec2s corners[3];
    for (int i = 0; i < 3; i++)
        corners[i] = spreading->mesh->uvs[spreading->mesh->indices[3 * (size_t)triangle + (size_t)i]];
    bound_distance(corners, border, low_m, high_m);
    *low_m *= border->metres;
    *high_m *= border->metres;
}

static void push(struct spreading *spreading, uint32_t triangle, uint32_t border)
{
    if (spreading->step_count == spreading->step_capacity) {
        spreading->step_capacity = 2 * spreading->step_capacity + 1024;
        spreading->steps = tl_resize(spreading->steps, spreading->step_capacity, sizeof *spreading->steps);
    }
    spreading->steps[spreading->step_count++] = (struct step){triangle, border};
}

static bool has(const struct spreading *spreading, uint32_t triangle, uint32_t border)
{
    for (uint32_t e = spreading->heads[triangle]; e != TL_NO_BORDER; e = spreading->entries[e].next)
        if (spreading->entries[e].border == border)
            return true;
    return false;
}

static void keep(struct spreading *spreading, uint32_t triangle, uint32_t border)
{
    if (spreading->entry_count == spreading->entry_capacity) {
        spreading->entry_capacity = 2 * spreading->entry_capacity + 1024;
        spreading->entries =
            tl_resize(spreading->entries, spreading->entry_capacity, sizeof *spreading->entries);
    }
    spreading->entries[spreading->entry_count] = (struct near_entry){border, spreading->heads[triangle]};
    spreading->heads[triangle] = (uint32_t)spreading->entry_count++;
}

/* Bounds are compared with a margin for rounding. */
static bool can_be_nearest(float low_m, float bound_m)
{
    return low_m <= TL_BORDER_REACH_M && low_m <= 1.0001f * bound_m + 1e-7f;
}

static void take_step(struct spreading *spreading, struct step step)
{
    const struct tl_border *border = &spreading->borders->borders[step.border];
    float *bound = &spreading->bounds[step.triangle][class_of(border)], low, high;
    bounds_of(spreading, step.triangle, border, &low, &high);
    if (!can_be_nearest(low, *bound) || has(spreading, step.triangle, step.border))
        return;
    keep(spreading, step.triangle, step.border);
    *bound = fminf(*bound, high);
    for (size_t k = 0; k < 3; k++) {
        uint32_t other = spreading->pieces->across[3 * (size_t)step.triangle + k];
        if (other != TL_NO_BORDER)
            push(spreading, other / 3, step.border);
    }
}

static int rising(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* Writes the lists without what later borders have ruled out. */
static void write_lists(const struct spreading *spreading)
{
    tl_borders *borders = spreading->borders;
    size_t count = 0;
    borders->firsts = TL_NEW_ARRAY(uint32_t, borders->triangle_count + 1);
    borders->near = TL_NEW_ARRAY(uint32_t, spreading->entry_count);
    for (uint32_t t = 0; t < borders->triangle_count; t++) {
        borders->firsts[t] = (uint32_t)count;
        for (uint32_t e = spreading->heads[t]; e != TL_NO_BORDER; e = spreading->entries[e].next) {
            const struct tl_border *border = &borders->borders[spreading->entries[e].border];
            float low, high;
            bounds_of(spreading, t, border, &low, &high);
            if (can_be_nearest(low, spreading->bounds[t][class_of(border)]))
                borders->near[count++] = spreading->entries[e].border;
        }
        qsort(borders->near + borders->firsts[t], count - borders->firsts[t], sizeof *borders->near, rising);
    }
    borders->firsts[borders->triangle_count] = (uint32_t)count;
}

void tl_borders_list_near(const tl_mesh *mesh, const struct tl_pieces *pieces, const uint32_t *sides,
                          tl_borders *borders)
{
    struct spreading spreading = {.mesh = mesh,
                                  .pieces = pieces,
                                  .borders = borders,
                                  .heads = TL_NEW_ARRAY(uint32_t, borders->triangle_count),
                                  .bounds = tl_alloc(borders->triangle_count, sizeof(float[CLASSES]))};
    for (size_t t = 0; t < borders->triangle_count; t++) {
        spreading.heads[t] = TL_NO_BORDER;
        for (int c = 0; c < CLASSES; c++)
            spreading.bounds[t][c] = INFINITY;
    }
    for (uint32_t b = 0; b < borders->border_count; b++)
        push(&spreading, sides[b] / 3, b);
    for (size_t i = 0; i < spreading.step_count; i++)
        take_step(&spreading, spreading.steps[i]);
    write_lists(&spreading);
    free(spreading.heads);
    free(spreading.bounds);
    free(spreading.entries);
    free(spreading.steps);
}
