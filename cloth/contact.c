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

struct tl_contacts tl_contacts_create(size_t particle_count)
{
    struct tl_contacts contacts = {.count = particle_count,
                                   .caches = TL_NEW_ARRAY(struct tl_contact_cache, particle_count)};
    for (size_t i = 0; i < particle_count; i++)
        contacts.caches[i].asked_phase = HUGE_VAL;
    return contacts;
}

void tl_contacts_release(struct tl_contacts *contacts)
{
    free(contacts->caches);
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
    for (size_t i = 0; i < contacts->count; i++)
        contacts->caches[i].asked_phase = HUGE_VAL;
}

void tl_contacts_renew(struct tl_contacts *contacts)
{
    if (!contacts->collider || tl_collider_travel(contacts->collider) == 0)
        return;
    for (size_t i = 0; i < contacts->count; i++)
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

void tl_contacts_solve(struct tl_contacts *contacts, const struct tl_contact_params *params,
                       struct tl_particles *particles)
{
    const tl_collider *collider = contacts->collider;
    if (!collider)
        return;
    bool ground = tl_collider_has_ground(collider);
    double travel = tl_collider_travel(collider);
    for (size_t i = 0; i < particles->count; i++) {
        if (!(particles->w[i] > 0))
            continue;
        vec3d x = particles->x[i], before = particles->previous[i];
        struct tl_contact_cache *cache = &contacts->caches[i];
        if (stale(cache, travel, params->phase, x))
            ask(collider, params->thickness_m, params->phase, x, cache);
        if (cache->near)
            x = push_out(x, before, anchor_at(cache, params->phase), anchor_at(cache, params->phase_before),
                         cache->normal, params);
        if (ground && x.y < params->thickness_m)
            x = push_off_ground(x, before, params);
        particles->x[i] = x;
    }
}
