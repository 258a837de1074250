#include "cloth/drive/seams.h"

#include "cloth/solvers/xpbd.h"
#include "config/memory.h"

#include <stdlib.h>
#include <string.h>

/* Seconds in which links shrink to nothing: 30 cm at 0.4 m/s. */
#define PULL_S 0.8
/* After that, how long the two sides are given to meet. */
#define MEET_S 0.7
/* Sides this near are one. */
#define CLOSED_M 0.002

static int compare_links(const void *a, const void *b)
{
    const struct tl_link *left = a, *right = b;
    if (left->a != right->a)
        return left->a < right->a ? -1 : 1;
    return (left->b > right->b) - (left->b < right->b);
}

/* Sorts, and drops pairs of one vertex with itself and repeated ones. */
static size_t tidy(struct tl_link *links, size_t count)
{
    size_t kept = 0;
    qsort(links, count, sizeof *links, compare_links);
    for (size_t i = 0; i < count; i++) {
        bool repeats = kept > 0 && compare_links(&links[kept - 1], &links[i]) == 0;
        if (links[i].a != links[i].b && !repeats)
            links[kept++] = links[i];
    }
    return kept;
}

static struct tl_link link_of(uint32_t a, uint32_t b)
{
    return (struct tl_link){.a = a < b ? a : b, .b = a < b ? b : a};
}

struct tl_seams tl_seams_create(const struct tl_seam_pair *pairs, size_t pair_count, const uint32_t *weld,
                                const vec3d *x)
{
    struct tl_seams seams = {.links = TL_NEW_ARRAY(struct tl_link, pair_count),
                             .gaps = TL_NEW_ARRAY(double, pair_count)};
    for (size_t i = 0; i < pair_count; i++)
        seams.links[i] = link_of(weld[pairs[i].a], weld[pairs[i].b]);
    seams.pair_count = tidy(seams.links, pair_count);
    for (size_t i = 0; i < seams.pair_count; i++)
        seams.gaps[i] = vec3d_distance(x[seams.links[i].a], x[seams.links[i].b]);
    return seams;
}

void tl_seams_release(struct tl_seams *seams)
{
    free(seams->links);
    free(seams->gaps);
    *seams = (struct tl_seams){0};
}

bool tl_seams_are_closing(const struct tl_seams *seams)
{
    return seams->pair_count > 0 && seams->elapsed_s < PULL_S + MEET_S;
}

void tl_seams_shrink(struct tl_seams *seams, double h)
{
    seams->elapsed_s += h;
    double left = fmax(1 - seams->elapsed_s / PULL_S, 0);
    for (size_t i = 0; i < seams->pair_count; i++)
        seams->links[i].rest = left * seams->gaps[i];
}

void tl_seams_solve(struct tl_seams *seams, struct tl_particles *particles, double h)
{
    tl_seams_shrink(seams, h);
    for (size_t i = 0; i < seams->pair_count; i++)
        tl_xpbd_solve_link(&seams->links[i], particles);
}

size_t tl_seams_close(struct tl_seams *seams, const struct tl_particles *particles, uint32_t *joined)
{
    uint32_t *parents = TL_NEW_ARRAY(uint32_t, particles->count);
    for (size_t i = 0; i < particles->count; i++)
        parents[i] = (uint32_t)i;
    for (size_t i = 0; seams->elapsed_s >= PULL_S && i < seams->pair_count; i++) {
        const struct tl_link *link = &seams->links[i];
        if (vec3d_distance(particles->x[link->a], particles->x[link->b]) < CLOSED_M)
            tl_sets_join(parents, link->a, link->b);
    }
    size_t count = 0;
    for (size_t i = 0; i < particles->count; i++) {
        uint32_t root = tl_sets_find(parents, (uint32_t)i);
        joined[i] = root == i ? (uint32_t)count++ : joined[root];
    }
    free(parents);
    if (count == particles->count)
        return count;
    for (size_t i = 0; i < seams->pair_count; i++)
        seams->links[i] = link_of(joined[seams->links[i].a], joined[seams->links[i].b]);
    seams->pair_count = tidy(seams->links, seams->pair_count); /* gaps are of no use once links are 0 */
    return count;
}
