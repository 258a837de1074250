#include "cloth/contact.h"

#include "config/memory.h"

#include <stdlib.h>

/* How far from its thickness a particle looks for the avatar. */
#define REACH_M 0.04
/* How far a particle slides over a surface before its plane is asked again: over a radius of 3 cm the plane
 * leaves the surface by 2^2 / (2 * 30) mm = 0.07 mm, small against any thickness. */
#define SLIDE_M 0.002
/* Penetration that was there before is taken out this fast: 14 mm in 0.07 s, and no more energy than a fall
 * from 2 mm. */
#define PUSH_OUT_SPEED 0.2

/* Edges longer than this are probed: shorter ones sink into a radius of 5 cm by less than 1 mm. */
#define COARSE_M 0.02

static double rest_length(const vec2s rest[3], int corner)
{
    vec2s side = glms_vec2_sub(rest[(corner + 1) % 3], rest[(corner + 2) % 3]);
    return hypot((double)side.x, (double)side.y);
}

/* The middles of a triangle's long edges, each edge from its first triangle only, and of the triangle. */
static size_t add_probes(const struct tl_topology *topology, const vec2s (*rest)[3], uint32_t triangle,
                         struct tl_probe *out)
{
    size_t count = 0;
    const uint32_t *v = topology->triangles[triangle];
    double longest = 0;
    for (int corner = 0; corner < 3; corner++) {
        double length = rest_length(rest[triangle], corner);
        longest = fmax(longest, length);
        bool first = topology->neighbour[triangle][corner] > triangle; /* also where there is none */
        if (length > COARSE_M && first)
            out[count++] =
                (struct tl_probe){{v[(corner + 1) % 3], v[(corner + 2) % 3], v[corner]}, {0.5, 0.5, 0}};
    }
    if (longest > COARSE_M)
        out[count++] = (struct tl_probe){{v[0], v[1], v[2]}, {1.0 / 3, 1.0 / 3, 1.0 / 3}};
    return count;
}

struct tl_contacts tl_contacts_create(const struct tl_topology *topology, const vec2s (*rest)[3])
{
    struct tl_contacts contacts = {.particle_count = topology->vertex_count,
                                   .probes = TL_NEW_ARRAY(struct tl_probe, 4 * topology->triangle_count)};
    for (size_t t = 0; t < topology->triangle_count; t++)
        contacts.probe_count +=
            add_probes(topology, rest, (uint32_t)t, &contacts.probes[contacts.probe_count]);
    size_t count = contacts.particle_count + contacts.probe_count;
    contacts.caches = TL_NEW_ARRAY(struct tl_contact_cache, count);
    for (size_t i = 0; i < count; i++)
        contacts.caches[i].asked_phase = HUGE_VAL;
    return contacts;
}

void tl_contacts_release(struct tl_contacts *contacts)
{
    free(contacts->caches);
    free(contacts->probes);
    *contacts = (struct tl_contacts){0};
}

void tl_contacts_begin(struct tl_contacts *contacts, const tl_collider *collider)
{
    bool same =
        collider == contacts->collider && (!collider || tl_collider_revision(collider) == contacts->revision);
    contacts->collider = collider;
    if (same)
        return;
    contacts->revision = collider ? tl_collider_revision(collider) : 0;
    for (size_t i = 0; i < contacts->particle_count + contacts->probe_count; i++)
        contacts->caches[i].asked_phase = HUGE_VAL;
}

void tl_contacts_renew(struct tl_contacts *contacts)
{
    if (!contacts->collider || tl_collider_travel(contacts->collider) == 0)
        return;
    for (size_t i = 0; i < contacts->particle_count + contacts->probe_count; i++)
        if (contacts->caches[i].near)
            contacts->caches[i].asked_phase = HUGE_VAL;
}

static vec3d anchor_at(const struct tl_contact_cache *cache, double phase)
{
    return vec3d_mix(cache->anchor[0], cache->anchor[1], phase);
}

static bool stale(const struct tl_contact_cache *cache, double travel, double phase, vec3d x)
{
    if (cache->asked_phase > 1)
        return true;
    vec3d moved = vec3d_sub(x, cache->asked_at);
    double slack = cache->clearance;
    if (cache->near)
        moved = vec3d_sub(moved, vec3d_sub(anchor_at(cache, phase), anchor_at(cache, cache->asked_phase)));
    else
        slack -= travel * fabs(phase - cache->asked_phase);
    return slack <= 0 || vec3d_dot(moved, moved) > slack * slack;
}

/* Asked for where the particle was, not for where it was driven to: that may be nearer to the other side. */
static void ask(const tl_collider *collider, double thickness, double phase, vec3d x,
                struct tl_contact_cache *cache)
{
    struct tl_contact contact;
    const double point[3] = {x.x, x.y, x.z};
    double reach = thickness + REACH_M;
    *cache = (struct tl_contact_cache){.asked_at = x, .asked_phase = phase, .clearance = REACH_M};
    if (!tl_collider_query_at(collider, point, phase, reach, &contact))
        return;
    double ends[2][3];
    tl_collider_path(collider, contact.triangle, contact.barycentric, ends[0], ends[1]);
    for (int i = 0; i < 2; i++)
        cache->anchor[i] = (vec3d){ends[i][0], ends[i][1], ends[i][2]};
    cache->normal = (vec3d){contact.normal[0], contact.normal[1], contact.normal[2]};
    cache->clearance = fmax(contact.distance_m - thickness, SLIDE_M);
    cache->near = true;
}

/* Keeps x on the outer side of a plane through `surface`, which was at `surface_before` when the particle was
 * at `before`; Coulomb friction bounds the slip by mu times the normal correction. */
static vec3d push_out(vec3d x, vec3d before, vec3d surface, vec3d surface_before, vec3d normal,
                      const struct tl_contact_params *params)
{
    double depth = params->thickness_m - vec3d_dot(vec3d_sub(x, surface), normal);
    double depth_before = fmax(params->thickness_m - vec3d_dot(vec3d_sub(before, surface_before), normal), 0);
    double kept = fmax(depth_before - PUSH_OUT_SPEED * params->h, 0);
    double correction = depth - kept;
    if (!(correction > 0))
        return x;
    x = vec3d_muladd(x, normal, correction);
    vec3d slip = vec3d_sub(vec3d_sub(x, before), vec3d_sub(surface, surface_before));
    slip = vec3d_muladd(slip, normal, -vec3d_dot(slip, normal));
    double length = vec3d_norm(slip);
    double pressed = fmax(depth - depth_before, 0); /* what load pushed in, without the old penetration */
    double grip = params->friction * pressed;
    return vec3d_muladd(x, slip, length > grip ? -grip / length : -1);
}

static vec3d push_off_ground(vec3d x, vec3d before, const struct tl_contact_params *params)
{
    const vec3d up = {0, 1, 0}, origin = {0};
    return push_out(x, before, origin, origin, up, params);
}

/* Where a point that is driven from `before` to `x` may go. */
static vec3d keep_out(const tl_collider *collider, struct tl_contact_cache *cache, vec3d x, vec3d before,
                      const struct tl_contact_params *params)
{
    if (stale(cache, tl_collider_travel(collider), params->phase, x))
        ask(collider, params->thickness_m, params->phase_before, before, cache);
    if (cache->near)
        x = push_out(x, before, anchor_at(cache, params->phase), anchor_at(cache, params->phase_before),
                     cache->normal, params);
    if (tl_collider_has_ground(collider) && x.y < params->thickness_m)
        x = push_off_ground(x, before, params);
    return x;
}

/* A probe is moved by moving its vertices, each in proportion to its share and inverse mass. */
static void solve_probe(const tl_collider *collider, const struct tl_probe *probe,
                        struct tl_contact_cache *cache, const struct tl_contact_params *params,
                        struct tl_particles *particles)
{
    vec3d x = {0}, before = {0};
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        uint32_t v = probe->vertices[i];
        x = vec3d_muladd(x, particles->x[v], probe->weights[i]);
        before = vec3d_muladd(before, particles->previous[v], probe->weights[i]);
        sum += particles->w[v] * probe->weights[i] * probe->weights[i];
    }
    vec3d push = vec3d_sub(keep_out(collider, cache, x, before, params), x);
    if (!(sum > 0) || !(vec3d_dot(push, push) > 0))
        return;
    for (int i = 0; i < 3; i++) {
        uint32_t v = probe->vertices[i];
        particles->x[v] = vec3d_muladd(particles->x[v], push, particles->w[v] * probe->weights[i] / sum);
    }
}

void tl_contacts_solve(struct tl_contacts *contacts, const struct tl_contact_params *params,
                       struct tl_particles *particles)
{
    const tl_collider *collider = contacts->collider;
    if (!collider)
        return;
    for (size_t i = 0; i < contacts->probe_count; i++)
        solve_probe(collider, &contacts->probes[i], &contacts->caches[contacts->particle_count + i], params,
                    particles);
    for (size_t i = 0; i < particles->count; i++)
        if (particles->w[i] > 0)
            particles->x[i] =
                keep_out(collider, &contacts->caches[i], particles->x[i], particles->previous[i], params);
}
