/* Chooses the side of the body around which a seam closes. */
#include "cloth/drive/seams.h"
#include "config/base/memory.h"

#include <stdlib.h>

/* The reach in which the body is found, the distance of a path from it, how far aside, and in what steps. */
#define REACH_M 0.3
#define OFF_M   0.012
#define ASIDE_M 0.3
#define STEP_M  0.005
#define TOUCH_M 0.001 /* a thread nearer than this to the body does not pass it */

static double distance_to(const tl_collider *collider, vec3d at)
{
    const double point[3] = {at.x, at.y, at.z};
    struct tl_contact contact;
    return tl_collider_query(collider, point, REACH_M, &contact) ? contact.distance_m : REACH_M;
}

/* Whether the straight thread passes the body: steps of the distance to it [Hart 1996]. */
static bool is_clear(const tl_collider *collider, vec3d a, vec3d b)
{
    double length = vec3d_distance(a, b), done = 0;
    while (done < length) {
        double distance = distance_to(collider, vec3d_mix(a, b, done / length));
        if (distance < TOUCH_M)
            return false;
        done += distance;
    }
    return true;
}

/* Unit-less sums over the boundary's edges around each vertex: out of the panel, in its plane. */
static vec3d *find_outwards(const struct tl_topology *topology, const vec3d *x)
{
    vec3d *outwards = TL_NEW_ARRAY(vec3d, topology->vertex_count);
    for (size_t t = 0; t < topology->triangle_count; t++) {
        const uint32_t *v = topology->triangles[t];
        for (int k = 0; k < 3; k++) {
            if (topology->neighbour[t][k] != TL_NONE)
                continue;
            uint32_t a = v[(k + 1) % 3], b = v[(k + 2) % 3];
            vec3d edge = vec3d_sub(x[b], x[a]), side = vec3d_sub(x[a], x[v[k]]);
            double along = vec3d_dot(side, edge) / fmax(vec3d_dot(edge, edge), 1e-30);
            vec3d out = vec3d_unit_or(vec3d_muladd(side, edge, -along), (vec3d){0, 0, 0});
            out = vec3d_scale(out, vec3d_norm(edge));
            outwards[a] = vec3d_add(outwards[a], out);
            outwards[b] = vec3d_add(outwards[b], out);
        }
    }
    return outwards;
}

/* The first point aside of the thread from which both ends are seen; else the first that is off the body. */
static bool find_way(const tl_collider *collider, vec3d a, vec3d b, vec3d aside, vec3d *over)
{
    const vec3d middle = vec3d_mix(a, b, 0.5);
    bool found = false;
    for (int step = 1; step * STEP_M <= ASIDE_M; step++) {
        vec3d at = vec3d_muladd(middle, aside, step * STEP_M);
        if (distance_to(collider, at) < OFF_M)
            continue;
        if (!found)
            *over = at;
        found = true;
        if (is_clear(collider, a, at) && is_clear(collider, at, b)) {
            *over = at;
            break;
        }
    }
    return found;
}

void tl_seams_find_ways(struct tl_seams *seams, const struct tl_topology *topology, const vec3d *x,
                        const tl_collider *collider)
{
    const vec3d nowhere = {0, 0, 0};
    vec3d *outwards = find_outwards(topology, x);
    seams->way_count = 0;
    seams->ways = tl_resize(seams->ways, seams->pair_count, sizeof *seams->ways);
    for (size_t i = 0; i < seams->pair_count; i++) {
        uint32_t a = seams->links[i].a, b = seams->links[i].b;
        vec3d over,
            aside = vec3d_unit_or(
                vec3d_add(vec3d_unit_or(outwards[a], nowhere), vec3d_unit_or(outwards[b], nowhere)), nowhere);
        if (vec3d_norm(aside) > 0 && !is_clear(collider, x[a], x[b]) &&
            find_way(collider, x[a], x[b], aside, &over))
            seams->ways[seams->way_count++] = (struct tl_seam_way){a, b, over};
    }
    free(outwards);
}
