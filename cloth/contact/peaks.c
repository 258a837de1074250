#include "cloth/contact/peaks.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

#define BEYOND_M 0.006
#define CELL_M   0.04
/* Cosine of the angle between the normals of skin and cloth. */
#define FACING 0.5
/* Lets a point lie outside a triangle by this share of it: between the prisms over both sides of a
 * fold. */
#define MARGIN 0.1

struct skin_cell {
    int at[3];
};

static struct skin_cell cell_of(vec3d x)
{
    return (struct skin_cell){{(int)floor(x.x / CELL_M), (int)floor(x.y / CELL_M), (int)floor(x.z / CELL_M)}};
}

/* Hashes a cell [Teschner et al. 2003, section 4]. */
static size_t bucket_of(const struct tl_skin_grid *skin, struct skin_cell cell)
{
    return ((size_t)cell.at[0] * 73856093U ^ (size_t)cell.at[1] * 19349663U ^
            (size_t)cell.at[2] * 83492791U) &
           skin->mask;
}

struct tl_skin_grid tl_skin_grid_create(const tl_collider *collider, double phase, double point)
{
    struct tl_skin_grid skin = {.mask = 1};
    const size_t all = tl_collider_skin_count(collider);
    skin.vertices = TL_NEW_ARRAY(struct tl_skin_vertex, all + 1);
    tl_collider_skin(collider, phase, skin.vertices);
    for (size_t i = 0; i < all; i++)
        if (skin.vertices[i].point > point)
            skin.vertices[skin.count++] = skin.vertices[i];
    while (skin.mask + 1 < skin.count)
        skin.mask = 2 * skin.mask + 1;
    skin.first = TL_NEW_ARRAY(uint32_t, skin.mask + 3);
    skin.items = TL_NEW_ARRAY(uint32_t, skin.count + 1);
    for (size_t i = 0; i < skin.count; i++)
        skin.first[bucket_of(&skin, cell_of(skin.vertices[i].x)) + 2]++;
    for (size_t i = 0; i <= skin.mask; i++)
        skin.first[i + 2] += skin.first[i + 1];
    for (size_t i = 0; i < skin.count; i++)
        skin.items[skin.first[bucket_of(&skin, cell_of(skin.vertices[i].x)) + 1]++] = (uint32_t)i;
    return skin;
}

void tl_skin_grid_release(struct tl_skin_grid *skin)
{
    free(skin->vertices);
    free(skin->first);
    free(skin->items);
    *skin = (struct tl_skin_grid){0};
}

struct peak_search {
    const struct tl_skin_grid *skin;
    const vec3d *x;
    double below_m;
    size_t count, capacity;
    struct tl_peak *all;
};

/* Whether the skin's vertex is on the triangle, and where. */
static bool is_at(const struct peak_search *search, const uint32_t v[3], const struct tl_skin_vertex *skin,
                  struct tl_peak *out)
{
    const vec3d a = search->x[v[0]], b = vec3d_sub(search->x[v[1]], a), c = vec3d_sub(search->x[v[2]], a);
    const vec3d area = vec3d_cross(b, c), from = vec3d_sub(skin->x, a);
    const double squared = vec3d_dot(area, area), facing = vec3d_dot(area, skin->normal);
    if (!(facing * facing > FACING * FACING * squared))
        return false;
    const double beyond = vec3d_dot(from, area) / copysign(sqrt(squared), facing);
    const double second = vec3d_dot(vec3d_cross(from, c), area) / squared,
                 third = vec3d_dot(vec3d_cross(b, from), area) / squared;
    if (beyond > BEYOND_M || beyond < -search->below_m || second < -MARGIN || third < -MARGIN ||
        second + third > 1 + MARGIN)
        return false;
    double weights[3] = {fmax(1 - second - third, 0), fmax(second, 0), fmax(third, 0)};
    const double sum = weights[0] + weights[1] + weights[2];
    *out = (struct tl_peak){{{v[0], v[1], v[2]}, {weights[0] / sum, weights[1] / sum, weights[2] / sum}},
                            beyond};
    return true;
}

static void add(struct peak_search *search, const struct tl_peak *peak)
{
    if (search->count == search->capacity) {
        search->capacity = 2 * search->capacity + 64;
        search->all = tl_resize(search->all, search->capacity, sizeof *search->all);
    }
    search->all[search->count++] = *peak;
}

static void search_cell(struct peak_search *search, const uint32_t v[3], struct skin_cell cell)
{
    const struct tl_skin_grid *skin = search->skin;
    const size_t bucket = bucket_of(skin, cell);
    for (uint32_t i = skin->first[bucket]; i < skin->first[bucket + 1]; i++) {
        const struct tl_skin_vertex *vertex = &skin->vertices[skin->items[i]];
        const struct skin_cell own = cell_of(vertex->x);
        struct tl_peak peak;
        if (own.at[0] == cell.at[0] && own.at[1] == cell.at[1] && own.at[2] == cell.at[2] &&
            is_at(search, v, vertex, &peak))
            add(search, &peak);
    }
}

static void search_triangle(struct peak_search *search, const uint32_t v[3])
{
    vec3d low = search->x[v[0]], high = low;
    for (int i = 1; i < 3; i++) {
        const vec3d x = search->x[v[i]];
        low = (vec3d){fmin(low.x, x.x), fmin(low.y, x.y), fmin(low.z, x.z)};
        high = (vec3d){fmax(high.x, x.x), fmax(high.y, x.y), fmax(high.z, x.z)};
    }
    const vec3d reach = {BEYOND_M, BEYOND_M, BEYOND_M};
    const struct skin_cell from = cell_of(vec3d_sub(low, reach)), to = cell_of(vec3d_add(high, reach));
    struct skin_cell cell;
    for (cell.at[0] = from.at[0]; cell.at[0] <= to.at[0]; cell.at[0]++)
        for (cell.at[1] = from.at[1]; cell.at[1] <= to.at[1]; cell.at[1]++)
            for (cell.at[2] = from.at[2]; cell.at[2] <= to.at[2]; cell.at[2]++)
                search_cell(search, v, cell);
}

size_t tl_peaks_find(const struct tl_skin_grid *skin, const struct tl_topology *topology, const vec3d *x,
                     const bool *near, double below_m, struct tl_peak **out)
{
    struct peak_search search = {skin, x, below_m, 0, 0, NULL};
    for (size_t i = 0; i < topology->triangle_count; i++) {
        const uint32_t *v = topology->triangles[i];
        if (!near || near[v[0]] || near[v[1]] || near[v[2]])
            search_triangle(&search, v);
    }
    *out = search.all;
    return search.count;
}
