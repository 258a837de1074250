#include "cloth/limit.h"

#include "config/memory.h"

#include <stdlib.h>
#include <string.h>

/* What is beyond the limit at first is drawn back at this speed, a share of the rest length a second: at
 * once, it would become a speed that grows as the substep shrinks. */
#define DRAW_BACK_SPEED 1.0

/* A triangle is near the limit when something in it is stretched by this share of it. */
#define NEAR 0.75

/* Those of the topology that are in a triangle and long enough, in its order. */
static void list_edges(struct tl_limits *limits, const struct tl_topology *topology, const vec2s (*rest)[3],
                       double shortest, const vec3d *x)
{
    double *lengths = TL_NEW_ARRAY(double, topology->edge_count);
    for (size_t t = topology->triangle_count; t-- > 0;) /* of several the first triangle's */
        for (int corner = 0; corner < 3; corner++) {
            int a = (corner + 1) % 3, b = (corner + 2) % 3;
            const uint32_t *vertices = topology->triangles[t];
            lengths[tl_topology_edge(topology, vertices[a], vertices[b])] =
                (double)glms_vec2_distance(rest[t][a], rest[t][b]);
        }
    for (size_t e = 0; e < topology->edge_count; e++) {
        uint32_t from = topology->edges[e][0], to = topology->edges[e][1];
        if (lengths[e] > shortest) {
            limits->edges[limits->count++] =
                (struct tl_limited_edge){{from, to}, lengths[e], vec3d_distance(x[from], x[to])};
            limits->first[from + 1]++;
        }
    }
    free(lengths);
}

struct tl_limits tl_limits_create(const struct tl_topology *topology, const struct tl_energy *energy,
                                  const vec2s (*rest)[3], double shortest, double strain, const vec3d *x)
{
    size_t count = topology->vertex_count;
    struct tl_limits limits = {.strain = strain,
                               .vertex_count = count,
                               .edges = TL_NEW_ARRAY(struct tl_limited_edge, topology->edge_count),
                               .first = TL_NEW_ARRAY(uint32_t, count + 1),
                               .due = TL_NEW_ARRAY(bool, count + 1),
                               .always = TL_NEW_ARRAY(bool, count + 1),
                               .watch = {.most = (1 + NEAR * strain) * (1 + NEAR * strain),
                                         .seen = TL_NEW_ARRAY(bool, energy->membrane_count)}};
    list_edges(&limits, topology, rest, shortest, x);
    for (size_t v = 0; v < count; v++)
        limits.first[v + 1] += limits.first[v];
    for (size_t i = 0; i < energy->link_count; i++) { /* slivers have no membrane that could be watched */
        uint32_t a = energy->links[i].a, b = energy->links[i].b;
        limits.always[a < b ? a : b] = true;
    }
    return limits;
}

void tl_limits_release(struct tl_limits *limits)
{
    free(limits->edges);
    free(limits->first);
    free(limits->due);
    free(limits->always);
    free(limits->watch.seen);
    *limits = (struct tl_limits){0};
}

/* The edges of a triangle lie with its lowest and its middle vertex. */
static void mark_triangle(struct tl_limits *limits, uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t low = a < b ? a : b, high = a < b ? b : a;
    limits->due[c < low ? c : low] = true;
    limits->due[c < low ? low : c < high ? c : high] = true;
}

/* Returns whether any edge is to be looked at. */
static bool mark(struct tl_limits *limits, const struct tl_energy *energy)
{
    bool any = energy->link_count > 0;
    memcpy(limits->due, limits->always, limits->vertex_count * sizeof(bool));
    for (size_t i = 0; i < energy->membrane_count; i++) {
        const struct tl_membrane *m = &energy->membranes[i];
        any = any || limits->watch.seen[i];
        for (int lane = 0; lane < TL_BATCH && limits->watch.seen[i]; lane++)
            mark_triangle(limits, m->vertices[0][lane], m->vertices[1][lane], m->vertices[2][lane]);
    }
    return any;
}

/* All edges at a vertex. */
static void mark_vertex(struct tl_limits *limits, const struct tl_pulls *pulls, uint32_t vertex)
{
    limits->due[vertex] = true;
    for (uint32_t k = pulls->along_first[vertex]; k < pulls->along_first[vertex + 1]; k++)
        if (pulls->along[k].other < vertex)
            limits->due[pulls->along[k].other] = true;
}

static bool limit(const struct tl_limits *limits, const struct tl_limited_edge *edge,
                  struct tl_particles *particles)
{
    uint32_t a = edge->ends[0], b = edge->ends[1];
    vec3d apart = vec3d_sub(particles->x[b], particles->x[a]);
    double squared = vec3d_dot(apart, apart), most = (1 + limits->strain) * edge->rest;
    if (!(squared > most * most))
        return false;
    most = fmax(most, edge->began - DRAW_BACK_SPEED * edge->rest * limits->passed_s);
    double sum = particles->w[a] + particles->w[b];
    if (!(squared > most * most) || !(sum > 0))
        return false;
    vec3d push = vec3d_scale(apart, (1 - most / sqrt(squared)) / sum);
    particles->x[a] = vec3d_muladd(particles->x[a], push, particles->w[a]);
    particles->x[b] = vec3d_muladd(particles->x[b], push, -particles->w[b]);
    return true;
}

/* What draws one edge back may stretch its neighbours. */
static bool limit_row(struct tl_limits *limits, const struct tl_pulls *pulls, size_t vertex,
                      struct tl_particles *particles)
{
    bool any = false;
    for (uint32_t e = limits->first[vertex]; e < limits->first[vertex + 1]; e++)
        if (limit(limits, &limits->edges[e], particles)) {
            mark_vertex(limits, pulls, limits->edges[e].ends[0]);
            mark_vertex(limits, pulls, limits->edges[e].ends[1]);
            any = true;
        }
    return any;
}

void tl_limits_solve(struct tl_limits *limits, const struct tl_energy *energy, double h,
                     struct tl_particles *particles)
{
    limits->passed_s += h;
    if (!mark(limits, energy))
        return;
    bool any = false;
    for (size_t v = 0; v < limits->vertex_count; v++)
        if (limits->due[v])
            any = limit_row(limits, &energy->pulls, v, particles) || any;
    for (size_t v = limits->vertex_count; any && v-- > 0;)
        if (limits->due[v])
            (void)limit_row(limits, &energy->pulls, v, particles);
}
