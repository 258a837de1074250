#include "cloth/contact/caught.h"

#define CAUGHT_STRETCH (1 + TL_CAUGHT_STRAIN)
#define TORN_STRETCH   3
/* Length to which caught edges are shortened, relative to rest. Sweeps propagate it along chains of edges. */
#define SLIPPED_STRETCH 1.5
#define SWEEPS          8

/* Shortens an edge that is longer than `limit` times its rest length; returns whether it was. */
static bool shorten(const uint32_t edge[2], double rest, double limit, struct tl_particles *particles,
                    bool *slipped)
{
    vec3d offset = vec3d_sub(particles->x[edge[1]], particles->x[edge[0]]);
    double squared = vec3d_dot(offset, offset), most = limit * rest;
    double sum = particles->w[edge[0]] + particles->w[edge[1]];
    if (!(squared > most * most) || !(sum > 0))
        return false;
    double excess = (1 - SLIPPED_STRETCH * rest / sqrt(squared)) / sum;
    for (int end = 0; end < 2; end++) {
        uint32_t i = edge[end];
        double way = (end == 0 ? 1 : -1) * excess * particles->w[i];
        particles->x[i] = vec3d_muladd(particles->x[i], offset, way);
        slipped[i] = slipped[i] || particles->w[i] > 0;
        particles->v[i] = (vec3d){0};
    }
    return true;
}

bool tl_caught_tears(const struct tl_topology *topology, const vec2s (*rest)[3], double shortest,
                     const vec3d *x)
{
    for (size_t t = 0; t < topology->triangle_count; t++)
        for (int corner = 0; corner < 3; corner++) {
            int next = (corner + 1) % 3;
            uint32_t a = topology->triangles[t][corner], b = topology->triangles[t][next];
            double length = (double)glms_vec2_distance(rest[t][corner], rest[t][next]);
            if (length > shortest && vec3d_distance(x[a], x[b]) > TORN_STRETCH * length)
                return true;
        }
    return false;
}

static bool sweep(const struct tl_topology *topology, const vec2s (*rest)[3], double shortest, double limit,
                  struct tl_particles *particles, bool *slipped)
{
    bool any = false;
    for (size_t t = 0; t < topology->triangle_count; t++)
        for (int corner = 0; corner < 3; corner++) {
            int next = (corner + 1) % 3;
            const uint32_t edge[2] = {topology->triangles[t][corner], topology->triangles[t][next]};
            double length = (double)glms_vec2_distance(rest[t][corner], rest[t][next]);
            if (length > shortest)
                any = shorten(edge, length, limit, particles, slipped) || any;
        }
    return any;
}

void tl_caught_release(const struct tl_topology *topology, const vec2s (*rest)[3], double shortest,
                       struct tl_particles *particles, bool *slipped)
{
    bool caught = sweep(topology, rest, shortest, CAUGHT_STRETCH, particles, slipped);
    for (int i = 0; caught && i < SWEEPS; i++)
        caught = sweep(topology, rest, shortest, SLIPPED_STRETCH, particles, slipped);
}
