#include "cloth/drive/seams.h"

#include "assets/topology/sets.h"
#include "cloth/solvers/xpbd.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Seconds that seams are given to close, at most; for how long ways are followed, before which they do not
 * become firm; without a welded pair until they become firm; and, once firm, until they are stuck. */
#define CLOSE_S 6.0
#define WAYS_S  1.2
#define FIRM_S  0.3
#define STUCK_S 0.3
/* Seconds that stuck ones are given. */
#define LAST_S 1.0
/* Speed at which seam pulls shorten, m/s, and the cloth's drag meanwhile, 1/s. */
#define GENTLE_SPEED 0.6
#define FIRM_SPEED   0.15
#define STUCK_SPEED  1.5
#define GENTLE_DRAG  40
#define FIRM_DRAG    20
/* Sides this near are one. Welding rebuilds the mesh, so pairs wait for one another. */
#define CLOSED_M 0.002
#define WELD_S   0.1

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

struct tl_seams tl_seams_create(const struct tl_seam_pair *pairs, size_t pair_count, const uint32_t *weld)
{
    struct tl_seams seams = {.links = TL_NEW_ARRAY(struct tl_link, pair_count)};
    for (size_t i = 0; i < pair_count; i++)
        seams.links[i] = link_of(weld[pairs[i].a], weld[pairs[i].b]);
    seams.pair_count = tidy(seams.links, pair_count);
    return seams;
}

void tl_seams_release(struct tl_seams *seams)
{
    free(seams->links);
    free(seams->ways);
    *seams = (struct tl_seams){0};
}

static double last_change(const struct tl_seams *seams)
{
    return fmax(seams->firm_s, seams->welded_s);
}

bool tl_seams_are_closing(const struct tl_seams *seams)
{
    bool given_up = tl_seams_are_firm(seams) && seams->elapsed_s - last_change(seams) >= STUCK_S + LAST_S;
    return seams->pair_count > 0 && seams->elapsed_s < CLOSE_S && !given_up;
}

bool tl_seams_are_firm(const struct tl_seams *seams)
{
    return seams->firm_s > 0;
}

bool tl_seams_are_stuck(const struct tl_seams *seams)
{
    return tl_seams_are_closing(seams) && tl_seams_are_firm(seams) &&
           seams->elapsed_s - last_change(seams) >= STUCK_S;
}

double tl_seams_drag(const struct tl_seams *seams)
{
    return tl_seams_are_firm(seams) ? FIRM_DRAG : GENTLE_DRAG;
}

static double speed_now(const struct tl_seams *seams)
{
    return tl_seams_are_stuck(seams) ? STUCK_SPEED : tl_seams_are_firm(seams) ? FIRM_SPEED : GENTLE_SPEED;
}

/* Sets the links' lengths from their lengths at the substep's start. */
static void shrink(struct tl_seams *seams, const vec3d *x, double h)
{
    double drawn_in = h * speed_now(seams);
    seams->elapsed_s += h;
    for (size_t i = 0; i < seams->pair_count; i++) {
        struct tl_link *link = &seams->links[i];
        link->rest = fmax(vec3d_distance(x[link->a], x[link->b]) - drawn_in, 0);
    }
}

/* Draws a particle towards a point that does not yield. */
static void draw_over(struct tl_particles *particles, uint32_t particle, vec3d over, double drawn_in)
{
    double rest = fmax(vec3d_distance(particles->previous[particle], over) - drawn_in, 0);
    double length = vec3d_distance(particles->x[particle], over);
    if (length > rest && particles->w[particle] > 0)
        particles->x[particle] = vec3d_mix(over, particles->x[particle], rest / length);
}

void tl_seams_solve(struct tl_seams *seams, struct tl_particles *particles, double h)
{
    shrink(seams, particles->previous, h);
    for (size_t i = 0; i < seams->way_count && seams->elapsed_s < WAYS_S; i++) {
        draw_over(particles, seams->ways[i].a, seams->ways[i].over, h * GENTLE_SPEED);
        draw_over(particles, seams->ways[i].b, seams->ways[i].over, h * GENTLE_SPEED);
    }
    for (size_t i = 0; i < seams->pair_count; i++) {
        const struct tl_link *link = &seams->links[i];
        if (vec3d_distance(particles->x[link->a], particles->x[link->b]) > link->rest)
            tl_xpbd_solve_link(link, particles);
    }
}

/* Ways of welded pairs are followed no longer. */
static void renumber_ways(struct tl_seams *seams, const uint32_t *joined)
{
    size_t kept = 0;
    for (size_t i = 0; i < seams->way_count; i++) {
        struct tl_seam_way way = seams->ways[i];
        way.a = joined[way.a];
        way.b = joined[way.b];
        if (way.a != way.b)
            seams->ways[kept++] = way;
    }
    seams->way_count = kept;
}

/* Nothing begins again once the time to close is over. */
static void note_progress(struct tl_seams *seams, bool welded)
{
    if (!tl_seams_are_closing(seams))
        return;
    if (welded)
        seams->welded_s = seams->elapsed_s;
    else if (!tl_seams_are_firm(seams) && seams->elapsed_s >= WAYS_S &&
             seams->elapsed_s - seams->welded_s >= FIRM_S)
        seams->firm_s = seams->elapsed_s;
}

size_t tl_seams_close(struct tl_seams *seams, const struct tl_particles *particles, uint32_t *joined)
{
    uint32_t *parents = tl_sets_create(particles->count);
    bool is_due = seams->elapsed_s >= seams->next_close_s;
    for (size_t i = 0; is_due && i < seams->pair_count; i++) {
        const struct tl_link *link = &seams->links[i];
        if (vec3d_distance(particles->x[link->a], particles->x[link->b]) < CLOSED_M)
            tl_sets_join(parents, link->a, link->b);
    }
    seams->next_close_s = is_due ? seams->elapsed_s + WELD_S : seams->next_close_s;
    size_t count = 0;
    for (size_t i = 0; i < particles->count; i++) {
        uint32_t root = tl_sets_find(parents, (uint32_t)i);
        joined[i] = root == i ? (uint32_t)count++ : joined[root];
    }
    free(parents);
    note_progress(seams, count < particles->count);
    if (count == particles->count)
        return count;
    for (size_t i = 0; i < seams->pair_count; i++)
        seams->links[i] = link_of(joined[seams->links[i].a], joined[seams->links[i].b]);
    seams->pair_count = tidy(seams->links, seams->pair_count);
    renumber_ways(seams, joined);
    return count;
}
