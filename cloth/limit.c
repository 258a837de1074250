#include "cloth/limit.h"

#include "config/memory.h"

#include <stdlib.h>

struct tl_limits tl_limits_create(const struct tl_topology *topology, const vec2s (*rest)[3], double shortest,
                                  const vec3d *x)
{
    struct tl_limits limits = {.edges = TL_NEW_ARRAY(struct tl_limited_edge, 3 * topology->triangle_count)};
    for (uint32_t t = 0; t < topology->triangle_count; t++)
        for (int corner = 0; corner < 3; corner++) {
            int a = (corner + 1) % 3, b = (corner + 2) % 3;
            double length = (double)glms_vec2_distance(rest[t][a], rest[t][b]);
            bool first = topology->neighbour[t][corner] > t; /* also where there is none */
            uint32_t from = topology->triangles[t][a], to = topology->triangles[t][b];
            if (first && length > shortest)
                limits.edges[limits.count++] =
                    (struct tl_limited_edge){{from, to}, length, vec3d_distance(x[from], x[to])};
        }
    return limits;
}

void tl_limits_release(struct tl_limits *limits)
{
    free(limits->edges);
    *limits = (struct tl_limits){0};
}

/* What is beyond the limit at first is drawn back at this speed, a share of the rest length a second: at
 * once, it would become a speed that grows as the substep shrinks. */
#define DRAW_BACK_SPEED 1.0

static bool limit(const struct tl_limited_edge *edge, double stretch, struct tl_particles *particles)
{
    uint32_t a = edge->ends[0], b = edge->ends[1];
    vec3d apart = vec3d_sub(particles->x[b], particles->x[a]);
    double squared = vec3d_dot(apart, apart), most = fmax(stretch * edge->rest, edge->allowed);
    double sum = particles->w[a] + particles->w[b];
    if (!(squared > most * most) || !(sum > 0))
        return false;
    vec3d push = vec3d_scale(apart, (1 - most / sqrt(squared)) / sum);
    particles->x[a] = vec3d_muladd(particles->x[a], push, particles->w[a]);
    particles->x[b] = vec3d_muladd(particles->x[b], push, -particles->w[b]);
    return true;
}

void tl_limits_solve(struct tl_limits *limits, double strain, double h, struct tl_particles *particles)
{
    bool any = false;
    for (size_t i = 0; i < limits->count; i++) {
        struct tl_limited_edge *edge = &limits->edges[i];
        edge->allowed = fmax(edge->allowed - DRAW_BACK_SPEED * edge->rest * h, 0);
        any = limit(edge, 1 + strain, particles) || any;
    }
    for (size_t i = limits->count; any && i-- > 0;)
        (void)limit(&limits->edges[i], 1 + strain, particles);
}
