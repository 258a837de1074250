#include "cloth/contact/contact.h"

#include "config/memory.h"

#include <stdlib.h>
#include <string.h>

/* How far from its thickness a particle looks for the avatar. */
#define REACH_M 0.04
/* How far a particle slides over a surface before its plane is asked again: over a radius of 3 cm the plane
 * leaves the surface by 2^2 / (2 * 30) mm = 0.07 mm, small against any thickness. */
#define SLIDE_M    0.002
#define ROUNDING_M 1e-9
/* What slides is asked for this share of that way ahead of it, so that its plane leans with its way as much
 * as against it: a plane that always lags leans against it, and rubs more than friction does. */
#define LEAD_SHARE 0.9

/* Edges longer than this are probed: shorter ones sink into a radius of 5 cm by no more than 2.3 mm. */
#define COARSE_M 0.03
/* A particle that is put back outside is put this share of its thickness above the surface, and half as far
 * after each answer that there it is inside of another part. */
#define OUTSIDE_SHARE 0.5
#define OUTSIDE_TRIES 8

struct tl_contacts tl_contacts_create(const struct tl_topology *topology, const vec2s (*rest)[3])
{
    struct tl_contacts contacts = {.particle_count = topology->vertex_count};
    contacts.samples = tl_contact_samples_create(topology, rest, COARSE_M, &contacts.sample_count);
    contacts.allowed_depth = TL_NEW_ARRAY(double, contacts.particle_count);
    contacts.caught = TL_NEW_ARRAY(bool, contacts.particle_count);
    contacts.pinched = TL_NEW_ARRAY(bool, contacts.particle_count);
    contacts.slipped = TL_NEW_ARRAY(bool, contacts.particle_count);
    for (size_t i = 0; i < contacts.particle_count; i++)
        contacts.allowed_depth[i] = HUGE_VAL;
    size_t count = contacts.particle_count + contacts.sample_count;
    contacts.caches = TL_NEW_ARRAY(struct tl_contact_cache, count);
    for (size_t i = 0; i < count; i++)
        contacts.caches[i].query_phase = HUGE_VAL;
    return contacts;
}

void tl_contacts_release(struct tl_contacts *contacts)
{
    free(contacts->caches);
    free(contacts->samples);
    free(contacts->allowed_depth);
    free(contacts->caught);
    free(contacts->pinched);
    free(contacts->slipped);
    *contacts = (struct tl_contacts){0};
}

static vec3d anchor_at(const struct tl_contact_cache *cache, double phase)
{
    return vec3d_mix(cache->anchor[0], cache->anchor[1], phase);
}

/* Against its anchor, if it has one. */
static vec3d moved_since(const struct tl_contact_cache *cache, double phase, vec3d x)
{
    vec3d moved = vec3d_sub(x, cache->query_point);
    if (cache->near)
        moved = vec3d_sub(moved, vec3d_sub(anchor_at(cache, phase), anchor_at(cache, cache->query_phase)));
    return moved;
}

static double slide_of(double thickness)
{
    return fmin(SLIDE_M, fmax(thickness / 2, ROUNDING_M));
}

/* Where to ask for a point at x. */
static vec3d predicted_point(const struct tl_contact_cache *cache, double thickness, double phase, vec3d x)
{
    if (!cache->near || cache->query_phase > 1)
        return x;
    vec3d slid = moved_since(cache, phase, x);
    slid = vec3d_muladd(slid, cache->normal, -vec3d_dot(slid, cache->normal));
    double length = vec3d_norm(slid), slide = slide_of(thickness);
    return length > slide / 2 ? vec3d_muladd(x, slid, LEAD_SHARE * slide / length) : x;
}

TL_INLINE bool is_stale(const struct tl_contact_cache *cache, double travel, double phase, vec3d x)
{
    if (cache->query_phase > 1)
        return true;
    vec3d moved = moved_since(cache, phase, x);
    double clearance = cache->clearance;
    if (!cache->near)
        clearance -= travel * fabs(phase - cache->query_phase);
    return clearance <= 0 || vec3d_dot(moved, moved) > clearance * clearance;
}

/* How far the surface can be at most, as far as is known: as far as the old anchor, within which few
 * triangles lie; or for what was out of reach, as far as it has gone since. */
static double bound_distance(const struct tl_contact_cache *cache, double thickness, double travel,
                             double phase, vec3d x)
{
    if (cache->near)
        return vec3d_distance(x, anchor_at(cache, phase)) + ROUNDING_M;
    double gone = cache->query_phase <= 1 ? vec3d_distance(x, cache->query_point) + travel : 0;
    return fmax(thickness + REACH_M, gone);
}

/* Asked for where the particle was, not for where it was driven to: that may be nearer to the other side. */
static void query(const tl_collider *collider, double thickness, double phase, vec3d x,
                  struct tl_contact_cache *cache)
{
    struct tl_contact contact;
    const double point[3] = {x.x, x.y, x.z};
    double reach = bound_distance(cache, thickness, tl_collider_travel(collider), phase, x);
    *cache = (struct tl_contact_cache){.query_point = x, .query_phase = phase, .clearance = REACH_M};
    if (!tl_collider_query_at(collider, point, phase, reach, &contact) ||
        contact.distance_m > thickness + REACH_M)
        return;
    double ends[2][3];
    tl_collider_path(collider, contact.triangle, contact.barycentric, ends[0], ends[1]);
    for (int i = 0; i < 2; i++)
        cache->anchor[i] = (vec3d){ends[i][0], ends[i][1], ends[i][2]};
    cache->normal = (vec3d){contact.normal[0], contact.normal[1], contact.normal[2]};
    cache->clearance = fmax(contact.distance_m - thickness, slide_of(thickness));
    cache->near = true;
}

static size_t cache_count(const struct tl_contacts *contacts)
{
    return contacts->particle_count + contacts->sample_count;
}

void tl_contacts_begin(struct tl_contacts *contacts, const tl_collider *collider)
{
    uint64_t revision = collider ? tl_collider_revision(collider) : 0;
    bool same = collider == contacts->collider && revision == contacts->revision;
    bool next = collider == contacts->collider && revision == contacts->revision + 1;
    contacts->collider = collider;
    contacts->revision = revision;
    contacts->caught_count = 0;
    bool moves = collider && tl_collider_travel(collider) > 0;
    for (size_t i = 0; i < contacts->particle_count; i++) {
        contacts->pinched[i] = contacts->caught[i] || (contacts->pinched[i] && !moves);
        contacts->caught[i] = false;
    }
    for (size_t i = 0; i < cache_count(contacts) && !same; i++) {
        struct tl_contact_cache *cache = &contacts->caches[i];
        cache->query_phase = HUGE_VAL;
        cache->anchor[0] = cache->anchor[1]; /* where the last frame ended the next begins */
        cache->near = cache->near && next;
    }
}

/* Signed, to the plane that the cache holds. */
static double distance_to(const struct tl_contact_cache *cache, vec3d x, double phase)
{
    return cache->near ? vec3d_dot(vec3d_sub(x, anchor_at(cache, phase)), cache->normal) : HUGE_VAL;
}

void tl_contacts_forget(struct tl_contacts *contacts)
{
    for (size_t i = 0; i < cache_count(contacts); i++) {
        contacts->caches[i].query_phase = HUGE_VAL;
        contacts->caches[i].near = false;
    }
    contacts->collider = NULL;
}

void tl_contacts_update(struct tl_contacts *contacts, const vec3d *x, double thickness_m, double phase)
{
    const tl_collider *collider = contacts->collider;
    if (!collider)
        return;
    bool moves = tl_collider_travel(collider) > 0;
    for (size_t i = 0; i < cache_count(contacts); i++) {
        struct tl_contact_cache *cache = &contacts->caches[i];
        if (cache->query_phase <= 1 && !(cache->near && moves))
            continue;
        bool is_particle = i < contacts->particle_count;
        query(collider, thickness_m, phase,
              is_particle ? x[i]
                          : tl_contact_sample_position(&contacts->samples[i - contacts->particle_count], x),
              cache);
        if (is_particle && isinf(contacts->allowed_depth[i]))
            contacts->allowed_depth[i] = fmax(thickness_m - distance_to(cache, x[i], phase), 0);
    }
}

/* One particle; whether it had to be put back. */
static bool move_outside(struct tl_contacts *contacts, size_t i, double thickness, double phase,
                         struct tl_particles *particles)
{
    struct tl_contact_cache *cache = &contacts->caches[i];
    double deepest = fmin(thickness - contacts->allowed_depth[i], 0), share = OUTSIDE_SHARE;
    for (int tries = 0; tries <= OUTSIDE_TRIES; tries++) {
        vec3d x = particles->x[i], v = particles->v[i];
        if (cache->query_phase != phase || vec3d_distance(cache->query_point, x) > 0)
            query(contacts->collider, thickness, phase, x, cache);
        double distance = distance_to(cache, x, phase);
        if (distance >= deepest)
            return tries > 0;
        particles->x[i] = vec3d_muladd(x, cache->normal,
                                       (deepest < 0 ? deepest + ROUNDING_M : share * thickness) - distance);
        particles->v[i] = vec3d_muladd(v, cache->normal, fmax(-vec3d_dot(v, cache->normal), 0));
        share /= 2;
    }
    return true;
}

static void enforce_one(struct tl_contacts *contacts, size_t i, const struct tl_contact_params *step,
                        struct tl_particles *particles)
{
    struct tl_contact_cache *cache = &contacts->caches[i];
    double travel = tl_collider_travel(contacts->collider);
    contacts->allowed_depth[i] = fmax(contacts->allowed_depth[i] - step->push_out_speed * step->h, 0);
    if (!(particles->w[i] > 0) && !particles->driven[i])
        return;
    bool slipped = contacts->slipped[i],
         plane_is_lost = slipped || is_stale(cache, travel, step->phase, particles->x[i]);
    cache->near = cache->near && !slipped; /* it may be anywhere */
    if (plane_is_lost && !cache->near)
        query(contacts->collider, step->thickness_m, step->phase, particles->x[i], cache);
    bool must_query = travel > 0 || plane_is_lost || contacts->allowed_depth[i] > 0 || contacts->pinched[i];
    if (!cache->near || !must_query)
        return;
    bool caught = move_outside(contacts, i, step->thickness_m, step->phase, particles) || slipped;
    contacts->caught_count += caught && !contacts->caught[i];
    contacts->caught[i] = contacts->caught[i] || caught;
}

void tl_contacts_enforce(struct tl_contacts *contacts, const struct tl_contact_params *step,
                         struct tl_particles *particles)
{
    for (size_t i = 0; contacts->collider && i < contacts->particle_count; i++)
        enforce_one(contacts, i, step, particles);
    memset(contacts->slipped, 0, contacts->particle_count * sizeof(bool));
}

static vec3d push_off_ground(vec3d x, vec3d before, const struct tl_contact_params *params)
{
    const vec3d up = {0, 1, 0}, origin = {0};
    return tl_contact_push_out(x, before, origin, origin, up, params);
}

struct surroundings {
    const tl_collider *collider;
    bool ground;
    double travel;
};

static struct surroundings surroundings_of(const tl_collider *collider)
{
    return (struct surroundings){collider, collider && tl_collider_has_ground(collider),
                                 collider ? tl_collider_travel(collider) : 0};
}

/* Where a point that is driven from `before` to `x` may go. Inline, with all it calls as a rule: vectors that
 * are handed over in memory made it take twice as long. */
TL_INLINE vec3d keep_out(const struct surroundings *surroundings, struct tl_contact_cache *cache, vec3d x,
                         vec3d before, const struct tl_contact_params *params)
{
    if (is_stale(cache, surroundings->travel, params->phase, x))
        query(surroundings->collider, params->thickness_m, params->phase_before,
              predicted_point(cache, params->thickness_m, params->phase_before, before), cache);
    if (cache->near)
        x = tl_contact_push_out(x, before, anchor_at(cache, params->phase),
                                anchor_at(cache, params->phase_before), cache->normal, params);
    if (surroundings->ground && x.y < params->thickness_m)
        x = push_off_ground(x, before, params);
    return x;
}

/* Where a pin goes that is driven to `x`, whatever its way there. */
static vec3d park_pin(const struct surroundings *surroundings, struct tl_contact_cache *cache, vec3d x,
                      const struct tl_contact_params *params)
{
    if (is_stale(cache, surroundings->travel, params->phase, x))
        query(surroundings->collider, params->thickness_m, params->phase, x, cache);
    double depth = OUTSIDE_SHARE * params->thickness_m - distance_to(cache, x, params->phase);
    return depth > 0 ? vec3d_muladd(x, cache->normal, depth) : x;
}

static void solve_sample(const struct surroundings *surroundings, const struct tl_contact_sample *sample,
                         struct tl_contact_cache *cache, const struct tl_contact_params *params,
                         struct tl_particles *particles)
{
    vec3d x = tl_contact_sample_position(sample, particles->x),
          before = tl_contact_sample_position(sample, particles->previous);
    double inverse = tl_contact_sample_inverse_mass(sample, particles->w);
    vec3d push = vec3d_sub(keep_out(surroundings, cache, x, before, params), x);
    if (inverse > 0 && vec3d_dot(push, push) > 0)
        tl_contact_sample_push(sample, vec3d_scale(push, 1 / inverse), particles->w, particles->x);
}

void tl_contacts_solve(struct tl_contacts *contacts, const struct tl_contact_params *params,
                       struct tl_particles *particles)
{
    const struct surroundings surroundings = surroundings_of(contacts->collider);
    if (!surroundings.collider)
        return;
    for (size_t i = 0; i < contacts->sample_count; i++)
        solve_sample(&surroundings, &contacts->samples[i], &contacts->caches[contacts->particle_count + i],
                     params, particles);
    for (size_t i = 0; i < particles->count; i++) {
        struct tl_contact_cache *cache = &contacts->caches[i];
        if (particles->w[i] > 0)
            particles->x[i] = keep_out(&surroundings, cache, particles->x[i], particles->previous[i], params);
        else if (particles->driven[i])
            particles->x[i] = park_pin(&surroundings, cache, particles->x[i], params);
    }
}

/* ---- Velocities ---- */

/* What the velocity of a point at `gap` above a surface that moves at `surface` is left with, if it would
 * arrive there within the next substep: Coulomb's bound on impulses. */
static vec3d apply_friction(vec3d v, double gap, vec3d surface, vec3d normal,
                            const struct tl_contact_params *params)
{
    vec3d slip = vec3d_sub(v, surface);
    double approach = vec3d_dot(slip, normal);
    if (!(approach < 0) || gap + approach * params->h > ROUNDING_M)
        return v;
    slip = vec3d_muladd(slip, normal, -approach);
    double length = vec3d_norm(slip), max_friction = params->friction * -approach;
    return vec3d_muladd(surface, slip, length > max_friction ? 1 - max_friction / length : 0);
}

/* Of a point at x, by all that it touches. */
static vec3d apply_all_friction(const struct surroundings *surroundings, const struct tl_contact_cache *cache,
                                vec3d x, vec3d v, const struct tl_contact_params *params)
{
    if (cache->near) {
        vec3d motion = vec3d_sub(anchor_at(cache, params->phase), anchor_at(cache, params->phase_before));
        v = apply_friction(v, distance_to(cache, x, params->phase) - params->thickness_m,
                           vec3d_scale(motion, 1 / params->h), cache->normal, params);
    }
    if (surroundings->ground)
        v = apply_friction(v, x.y - params->thickness_m, (vec3d){0}, (vec3d){0, 1, 0}, params);
    return v;
}

static void apply_friction_to_sample(const struct surroundings *surroundings,
                                     const struct tl_contact_sample *sample,
                                     const struct tl_contact_cache *cache,
                                     const struct tl_contact_params *params, struct tl_particles *particles)
{
    double inverse = tl_contact_sample_inverse_mass(sample, particles->w);
    vec3d v = tl_contact_sample_position(sample, particles->v);
    vec3d change = vec3d_sub(
        apply_all_friction(surroundings, cache, tl_contact_sample_position(sample, particles->x), v, params),
        v);
    if (inverse > 0 && vec3d_dot(change, change) > 0)
        tl_contact_sample_push(sample, vec3d_scale(change, 1 / inverse), particles->w, particles->v);
}

void tl_contacts_solve_velocities(const struct tl_contacts *contacts, const struct tl_contact_params *params,
                                  struct tl_particles *particles)
{
    const struct surroundings surroundings = surroundings_of(contacts->collider);
    if (!surroundings.collider)
        return;
    for (size_t i = 0; i < contacts->sample_count; i++)
        apply_friction_to_sample(&surroundings, &contacts->samples[i],
                                 &contacts->caches[contacts->particle_count + i], params, particles);
    for (size_t i = 0; i < particles->count; i++)
        if (particles->w[i] > 0)
            particles->v[i] = apply_all_friction(&surroundings, &contacts->caches[i], particles->x[i],
                                                 particles->v[i], params);
}

/* ---- For solvers that heed planes themselves ---- */

static struct tl_contact_plane plane_of(vec3d x, vec3d surface, vec3d surface_before, vec3d normal,
                                        const struct tl_contact_params *params)
{
    vec3d motion = vec3d_sub(surface, surface_before);
    double depth = params->thickness_m - vec3d_dot(vec3d_sub(x, surface_before), normal);
    double pushed = depth > 0 ? fmin(depth, params->push_out_speed * params->h) : depth;
    return (struct tl_contact_plane){normal, motion, vec3d_dot(motion, normal) + pushed};
}

size_t tl_contacts_planes(struct tl_contacts *contacts, const struct tl_contact_params *params,
                          size_t particle, vec3d x, struct tl_contact_plane out[TL_CONTACT_PLANES])
{
    const struct surroundings surroundings = surroundings_of(contacts->collider);
    size_t count = 0;
    if (!surroundings.collider)
        return 0;
    struct tl_contact_cache *cache = &contacts->caches[particle];
    if (is_stale(cache, surroundings.travel, params->phase_before, x))
        query(surroundings.collider, params->thickness_m, params->phase_before,
              predicted_point(cache, params->thickness_m, params->phase_before, x), cache);
    if (cache->near)
        out[count++] = plane_of(x, anchor_at(cache, params->phase), anchor_at(cache, params->phase_before),
                                cache->normal, params);
    if (surroundings.ground)
        out[count++] = plane_of(x, (vec3d){0}, (vec3d){0}, (vec3d){0, 1, 0}, params);
    return count;
}
