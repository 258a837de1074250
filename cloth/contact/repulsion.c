#include "cloth/contact/repulsion.h"

#include "config/memory.h"

#include <stdlib.h>

/* Pairs are searched within this many thicknesses. Particles that approach by more than the margin within one
 * step are found one step later. */
#define REACH_THICKNESSES 2.0
/* m/s, at which pairs that are too near already are separated. */
#define PUSH_APART_SPEED 1.0
/* Bound of cell indices, so that they fit; nothing that far away has a neighbour. */
#define FARTHEST_CELL 1e15

void tl_repulsion_release(struct tl_repulsion *repulsion)
{
    free(repulsion->pairs);
    *repulsion = (struct tl_repulsion){0};
}

struct hash_cell {
    int64_t x, y, z;
};

/* Particles by the cell that they lie in: those of slot s are items[first[s]] to items[first[s + 1] - 1], in
 * rising order. Several cells may share a slot. */
struct grid {
    double cell_m;
    const vec3d *x;
    uint32_t mask;
    uint32_t *first, *items;
};

static int64_t cell_number(double x, double cell_m)
{
    return (int64_t)fmax(fmin(floor(x / cell_m), FARTHEST_CELL), -FARTHEST_CELL);
}

static struct hash_cell cell_of(const struct grid *grid, size_t i)
{
    vec3d x = grid->x[i];
    return (struct hash_cell){cell_number(x.x, grid->cell_m), cell_number(x.y, grid->cell_m),
                              cell_number(x.z, grid->cell_m)};
}

static uint32_t slot_of(const struct grid *grid, struct hash_cell cell)
{
    uint64_t hash =
        (uint64_t)cell.x * 73856093u ^ (uint64_t)cell.y * 19349663u ^ (uint64_t)cell.z * 83492791u;
    return (uint32_t)hash & grid->mask;
}

static struct grid make_grid(size_t count, const vec3d *x, double cell_m)
{
    struct grid grid = {.cell_m = cell_m, .x = x, .mask = 1};
    while (grid.mask < 2 * count)
        grid.mask = 2 * grid.mask + 1;
    grid.first = TL_NEW_ARRAY(uint32_t, (size_t)grid.mask + 2);
    grid.items = TL_NEW_ARRAY(uint32_t, count);
    uint32_t *last = grid.first + 1; /* one past each slot's items, until they are in */
    for (size_t i = 0; i < count; i++)
        last[slot_of(&grid, cell_of(&grid, i))]++;
    for (size_t s = 1; s <= grid.mask; s++)
        last[s] += last[s - 1];
    for (size_t i = count; i-- > 0;)
        grid.items[--last[slot_of(&grid, cell_of(&grid, i))]] = (uint32_t)i;
    for (size_t s = 0; s <= grid.mask; s++)
        grid.first[s] = grid.first[s + 1];
    grid.first[(size_t)grid.mask + 1] = (uint32_t)count;
    return grid;
}

static void add_pair(struct tl_repulsion *repulsion, struct tl_repulsion_pair pair)
{
    if (repulsion->pair_count == repulsion->pair_capacity) {
        repulsion->pair_capacity = 2 * repulsion->pair_capacity + 256;
        repulsion->pairs = tl_resize(repulsion->pairs, repulsion->pair_capacity, sizeof *repulsion->pairs);
    }
    repulsion->pairs[repulsion->pair_count++] = pair;
}

/* Pairs of particle i with later ones in one cell. */
static void find_pairs(struct tl_repulsion *repulsion, const struct grid *grid, size_t i,
                       struct hash_cell cell, const vec3d *start, double thickness_m)
{
    uint32_t slot = slot_of(grid, cell);
    for (uint32_t k = grid->first[slot]; k < grid->first[slot + 1]; k++) {
        uint32_t j = grid->items[k];
        struct hash_cell other = cell_of(grid, j);
        bool here = other.x == cell.x && other.y == cell.y && other.z == cell.z;
        if (j <= i || !here || !(vec3d_distance(grid->x[i], grid->x[j]) < grid->cell_m))
            continue;
        double kept = fmin(thickness_m, vec3d_distance(start[i], start[j]));
        add_pair(repulsion, (struct tl_repulsion_pair){(uint32_t)i, j, kept});
    }
}

void tl_repulsion_update(struct tl_repulsion *repulsion, size_t count, const vec3d *x, const vec3d *start,
                         double thickness_m)
{
    repulsion->pair_count = 0;
    if (!(thickness_m > 0))
        return;
    struct grid grid = make_grid(count, x, REACH_THICKNESSES * thickness_m);
    for (size_t i = 0; i < count; i++) {
        struct hash_cell cell = cell_of(&grid, i);
        for (int n = 0; n < 27; n++) {
            struct hash_cell around = {cell.x + n % 3 - 1, cell.y + n / 3 % 3 - 1, cell.z + n / 9 - 1};
            find_pairs(repulsion, &grid, i, around, start, thickness_m);
        }
    }
    free(grid.first);
    free(grid.items);
}

/* Separates a pair to its distance; penetration that was there before, at a limited speed. Friction reduces
 * the slip of this substep by at most `friction` times the correction. */
static void solve_pair(const struct tl_repulsion_pair *pair, double friction, double max_push_m,
                       struct tl_particles *particles)
{
    double wa = particles->w[pair->a], wb = particles->w[pair->b];
    vec3d *a = &particles->x[pair->a], *b = &particles->x[pair->b];
    vec3d apart = vec3d_sub(*b, *a);
    vec3d before = vec3d_sub(particles->previous[pair->b], particles->previous[pair->a]);
    double nearer = vec3d_norm(before) - vec3d_norm(apart);
    double depth = fmin(pair->distance_m - vec3d_norm(apart), fmax(nearer, 0) + max_push_m);
    if (!(depth > 0) || !(wa + wb > 0))
        return;
    vec3d normal = vec3d_unit_or(apart, (vec3d){0, 1, 0});
    vec3d slip = vec3d_sub(apart, before);
    slip = vec3d_muladd(slip, normal, -vec3d_dot(slip, normal));
    double length = vec3d_norm(slip), max_friction = friction * depth;
    vec3d push =
        vec3d_muladd(vec3d_scale(normal, depth), slip, length > max_friction ? -max_friction / length : -1);
    push = vec3d_scale(push, 1 / (wa + wb));
    *a = vec3d_muladd(*a, push, -wa);
    *b = vec3d_muladd(*b, push, wb);
}

void tl_repulsion_solve(const struct tl_repulsion *repulsion, double friction, double h,
                        struct tl_particles *particles)
{
    for (size_t i = 0; i < repulsion->pair_count; i++)
        solve_pair(&repulsion->pairs[i], friction, PUSH_APART_SPEED * h, particles);
}
