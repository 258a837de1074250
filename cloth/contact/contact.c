#include "cloth/contact/contact.h"

#include "cloth/mesh/team.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Distance beyond the thickness within which the avatar is searched. */
#define REACH_M 0.04
/* Sliding distance after which the plane is queried again. After a slide s over a radius R the plane is off
 * the surface by s^2 / 2R: 2^2 / (2 * 30) mm = 0.07 mm at R = 3 cm, which is small against any thickness. */
#define SLIDE_M    0.002
#define ROUNDING_M 1e-9
/* The query point of a sliding particle is moved ahead by this share of the sliding distance. The plane's
 * tilt against the surface then averages to about zero along the slide. A plane queried at the particle
 * itself lags behind and is always tilted against the motion, which would act as additional friction. */
#define LEAD_SHARE 0.9

/* Edges longer than this get probes. Shorter ones sink into a radius R by at most e^2 / 8R: 2.3 mm at R = 5
 * cm. */
#define COARSE_M 0.03
/* A particle that is moved outside is placed at this share of its thickness above the surface. If it is then
 * inside another part of the avatar, the share is halved and the move repeated. */
#define OUTSIDE_SHARE 0.5
#define OUTSIDE_TRIES 8
/* Seconds for which the avatar lets a particle go that has no place outside of it. An arm that swings past a
 * hip moves on by its own width meanwhile. */
#define RELEASED_S 0.1

struct tl_contacts tl_contacts_create(const struct tl_topology *topology, const vec2s (*rest)[3])
{
    struct tl_contacts contacts = {.topology = topology, .particle_count = topology->vertex_count};
    contacts.samples = tl_contact_samples_create(topology, rest, COARSE_M, &contacts.probe_count);
    contacts.sample_count = contacts.probe_count;
    contacts.allowed_depth = TL_NEW_ARRAY(double, contacts.particle_count);
    contacts.caught = TL_NEW_ARRAY(bool, contacts.particle_count);
    contacts.pinched = TL_NEW_ARRAY(bool, contacts.particle_count);
    contacts.slipped = TL_NEW_ARRAY(bool, contacts.particle_count);
    contacts.released_s = TL_NEW_ARRAY(double, contacts.particle_count);
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
    tl_skin_grid_release(&contacts->skin);
    free(contacts->allowed_depth);
    free(contacts->caught);
    free(contacts->pinched);
    free(contacts->slipped);
    free(contacts->released_s);
    *contacts = (struct tl_contacts){0};
}

static vec3d anchor_at(const struct tl_contact_cache *cache, double phase)
{
    return vec3d_mix(cache->anchor[0], cache->anchor[1], phase);
}

/* Displacement since the query, relative to the moving anchor if there is one. */
static vec3d moved_since(const struct tl_contact_cache *cache, double phase, vec3d x)
{
    vec3d moved = vec3d_sub(x, cache->query_point);
    if (cache->near)
        moved = vec3d_sub(moved, vec3d_sub(anchor_at(cache, phase), anchor_at(cache, cache->query_phase)));
    return moved;
}

/* The sliding distance, less for thin cloth; never 0, or every substep would query. */
static double slide_of(double thickness)
{
    return fmin(SLIDE_M, fmax(thickness / 2, ROUNDING_M));
}

/* The query point for a point at x: ahead of it in the direction of its slide, see LEAD_SHARE. A point that
 * moved less than half a sliding distance tangentially has no direction of slide and is queried at x. */
static vec3d predicted_point(const struct tl_contact_cache *cache, double thickness, double phase, vec3d x)
{
    if (!cache->near || cache->query_phase > 1)
        return x;
    vec3d slid = moved_since(cache, phase, x);
    slid = vec3d_muladd(slid, cache->normal, -vec3d_dot(slid, cache->normal));
    double length = vec3d_norm(slid), slide = slide_of(thickness);
    return length > slide / 2 ? vec3d_muladd(x, slid, LEAD_SHARE * slide / length) : x;
}

/* Whether the cache has to be queried again for a point at x: if it is invalid or the point moved further
 * than the clearance. Out of reach there is no anchor, so the largest displacement of the surface is
 * subtracted instead. */
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

/* Search radius of a query. The old anchor is a point of the surface, so its distance is an upper bound of
 * the nearest one: such a radius covers few triangles, and the search is fast. Without an anchor the radius
 * is the reach, or the displacement of point and surface since the last query if that is larger. */
static double bound_distance(const struct tl_contact_cache *cache, double thickness, double travel,
                             double phase, vec3d x)
{
    if (cache->near)
        return vec3d_distance(x, anchor_at(cache, phase)) + ROUNDING_M;
    double gone = cache->query_phase <= 1 ? vec3d_distance(x, cache->query_point) + travel : 0;
    return fmax(thickness + REACH_M, gone);
}

/* Fills the cache for a point at x. Substeps pass the position at their start, not the predicted one, which
 * may lie nearer to the opposite side of a thin part. */
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
    if (!same)
        tl_skin_grid_release(&contacts->skin);
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
        cache->anchor[0] = cache->anchor[1]; /* the pose at the end of the last frame starts the next one */
        cache->near = cache->near && next;
    }
}

/* Signed distance to the cached plane; HUGE_VAL without one. */
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
    memset(contacts->released_s, 0, contacts->particle_count * sizeof *contacts->released_s);
    contacts->collider = NULL;
}

/* Peaks are kept apart from cloth that is nearer than their share of the thickness by less than this part of
 * it, so that those in contact are found again. */
#define PEAK_MARGIN 0.1
/* Skin that pierces cloth is more pointed than this, as a nipple is; the built-in bodies are nowhere. A
 * sphere of 5 cm has 0.08 under edges of 8 mm. */
#define POINTED 0.25
/* Distance from the avatar, beyond the thickness, of vertices whose triangles peaks may pierce. */
#define PEAK_REACH_M 0.01

static void renew_skin(struct tl_contacts *contacts, double phase)
{
    const bool moves = tl_collider_travel(contacts->collider) > 0;
    if (contacts->skin.vertices && (!moves || contacts->skin_phase == phase))
        return;
    tl_skin_grid_release(&contacts->skin);
    contacts->skin = tl_skin_grid_create(contacts->collider, phase, POINTED);
    contacts->skin_phase = phase;
}

/* Makes samples of the cloth in front of peaks. */
static void renew_peaks(struct tl_contacts *contacts, const vec3d *x, double thickness, double phase)
{
    struct tl_peak *peaks;
    bool *near = TL_NEW_ARRAY(bool, contacts->particle_count);
    for (size_t i = 0; i < contacts->particle_count; i++)
        near[i] = distance_to(&contacts->caches[i], x[i], phase) < thickness + PEAK_REACH_M;
    renew_skin(contacts, phase);
    const size_t count = tl_peaks_find(&contacts->skin, contacts->topology, x, near,
                                       (1 + PEAK_MARGIN) * TL_PEAK_SHARE * thickness, &peaks);
    contacts->sample_count = contacts->probe_count + count;
    contacts->samples = tl_resize(contacts->samples, contacts->sample_count + 1, sizeof *contacts->samples);
    contacts->caches = tl_resize(contacts->caches, cache_count(contacts), sizeof *contacts->caches);
    for (size_t i = 0; i < count; i++) {
        contacts->samples[contacts->probe_count + i] = peaks[i].at;
        contacts->caches[contacts->particle_count + contacts->probe_count + i] =
            (struct tl_contact_cache){.query_phase = HUGE_VAL};
    }
    free(peaks);
    free(near);
}

static vec3d position_of(const struct tl_contacts *contacts, size_t i, const vec3d *x)
{
    return i < contacts->particle_count
               ? x[i]
               : tl_contact_sample_position(&contacts->samples[i - contacts->particle_count], x);
}

static void renew_cache(struct tl_contacts *contacts, size_t i, const vec3d *x, double thickness,
                        double phase)
{
    struct tl_contact_cache *cache = &contacts->caches[i];
    const bool moves = tl_collider_travel(contacts->collider) > 0;
    if (cache->query_phase > 1 || (cache->near && moves))
        query(contacts->collider, tl_contacts_share(contacts, i) * thickness, phase,
              position_of(contacts, i, x), cache);
}

void tl_contacts_update(struct tl_contacts *contacts, const vec3d *x, double thickness_m, double phase)
{
    if (!contacts->collider)
        return;
    for (size_t i = 0; i < contacts->particle_count; i++) {
        renew_cache(contacts, i, x, thickness_m, phase);
        if (isinf(contacts->allowed_depth[i]))
            contacts->allowed_depth[i] =
                fmax(thickness_m - distance_to(&contacts->caches[i], x[i], phase), 0);
    }
    renew_peaks(contacts, x, thickness_m, phase);
    for (size_t i = contacts->particle_count; i < cache_count(contacts); i++)
        renew_cache(contacts, i, x, thickness_m, phase);
}

/* The signed distance that a particle must have at least: 0, or less for old penetration. */
static double deepest_allowed(const struct tl_contacts *contacts, size_t i, double thickness)
{
    return fmin(thickness - contacts->allowed_depth[i], 0);
}

/* Moves one particle outside along the normal of its nearest point, until a query finds it no deeper than
 * allowed; returns whether it was moved. Its velocity keeps no part into the surface. Between two parts of
 * the avatar a move may enter the other part, so the target height is halved after each try. */
static bool move_outside(struct tl_contacts *contacts, size_t i, double thickness, double phase,
                         struct tl_particles *particles)
{
    struct tl_contact_cache *cache = &contacts->caches[i];
    double deepest = deepest_allowed(contacts, i, thickness), share = OUTSIDE_SHARE;
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

static void mark_caught(struct tl_contacts *contacts, size_t i)
{
    contacts->caught_count += !contacts->caught[i];
    contacts->caught[i] = true;
}

static bool is_released(const struct tl_contacts *contacts, size_t particle)
{
    return contacts->released_s[particle] > 0;
}

static bool is_sample_released(const struct tl_contacts *contacts, const struct tl_contact_sample *sample)
{
    const uint32_t *v = sample->vertices;
    return is_released(contacts, v[0]) || is_released(contacts, v[1]) || is_released(contacts, v[2]);
}

/* Vertices that are outside again are held outside. Those still inside when their time is over come out at
 * push_out_speed. */
static void follow_released(struct tl_contacts *contacts, size_t i, const struct tl_contact_params *step,
                            vec3d x)
{
    struct tl_contact_cache *cache = &contacts->caches[i];
    query(contacts->collider, step->thickness_m, step->phase, x, cache);
    double distance = distance_to(cache, x, step->phase);
    contacts->allowed_depth[i] = fmax(step->thickness_m - distance, 0);
    contacts->released_s[i] = distance < 0 ? contacts->released_s[i] - step->h : 0;
}

/* Enforces one particle. With a valid plane of a resting avatar, no old penetration and no second part
 * nearby, the substeps have enforced everything already, and no query is made. */
static void enforce_one(struct tl_contacts *contacts, size_t i, const struct tl_contact_params *step,
                        struct tl_particles *particles)
{
    struct tl_contact_cache *cache = &contacts->caches[i];
    double travel = tl_collider_travel(contacts->collider);
    contacts->allowed_depth[i] = fmax(contacts->allowed_depth[i] - step->push_out_speed * step->h, 0);
    if (!(particles->w[i] > 0) && !particles->driven[i])
        return;
    if (is_released(contacts, i)) {
        follow_released(contacts, i, step, particles->x[i]);
        return;
    }
    bool slipped = contacts->slipped[i],
         plane_is_lost = slipped || is_stale(cache, travel, step->phase, particles->x[i]);
    cache->near = cache->near && !slipped; /* its old anchor no longer bounds the search */
    if (plane_is_lost && !cache->near)
        query(contacts->collider, step->thickness_m, step->phase, particles->x[i], cache);
    bool must_query = travel > 0 || plane_is_lost || contacts->allowed_depth[i] > 0 || contacts->pinched[i];
    if (!cache->near || !must_query)
        return;
    if (move_outside(contacts, i, step->thickness_m, step->phase, particles) || slipped)
        mark_caught(contacts, i);
}

void tl_contacts_enforce(struct tl_contacts *contacts, const struct tl_contact_params *step,
                         struct tl_particles *particles)
{
    for (size_t i = 0; contacts->collider && i < contacts->particle_count; i++)
        enforce_one(contacts, i, step, particles);
    memset(contacts->slipped, 0, contacts->particle_count * sizeof(bool));
}

bool tl_contacts_lift(struct tl_contacts *contacts, const struct tl_contact_params *step,
                      struct tl_particles *particles)
{
    bool any = false;
    if (!contacts->collider)
        return false;
    double travel = tl_collider_travel(contacts->collider);
    for (size_t i = 0; i < contacts->particle_count; i++) {
        struct tl_contact_cache *cache = &contacts->caches[i];
        if ((!(particles->w[i] > 0) && !particles->driven[i]) || is_released(contacts, i))
            continue;
        bool slipped = contacts->slipped[i];
        contacts->slipped[i] = false;
        cache->near = cache->near && !slipped; /* as in enforce_one */
        if (slipped || (!cache->near && is_stale(cache, travel, step->phase, particles->x[i])))
            query(contacts->collider, step->thickness_m, step->phase, particles->x[i], cache);
        if (!cache->near)
            continue;
        if (!move_outside(contacts, i, step->thickness_m, step->phase, particles))
            continue;
        mark_caught(contacts, i);
        any = true;
    }
    return any;
}

void tl_contacts_let_go(struct tl_contacts *contacts, const struct tl_contact_params *step,
                        const struct tl_particles *particles)
{
    for (size_t i = 0; i < contacts->particle_count; i++) {
        struct tl_contact_cache *cache = &contacts->caches[i];
        if (!cache->near || !(particles->w[i] > 0) || is_released(contacts, i))
            continue;
        query(contacts->collider, step->thickness_m, step->phase, particles->x[i], cache);
        if (distance_to(cache, particles->x[i], step->phase) <
            deepest_allowed(contacts, i, step->thickness_m))
            contacts->released_s[i] = RELEASED_S;
    }
}

/* The ground is the plane y = 0 and does not move. */
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

/* Returns the position allowed for a point that moved from `before` to `x`: projected out of the avatar
 * first, then out of the ground, so that the ground is exact. Inline with the functions on its usual path:
 * vectors passed in memory made it take twice as long. */
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

/* Returns the position of a pin driven to `x`: at OUTSIDE_SHARE of the thickness above the surface or higher.
 * Its motion is prescribed, so there is no friction, and its path to x does not matter. */
static vec3d park_pin(const struct surroundings *surroundings, struct tl_contact_cache *cache, vec3d x,
                      const struct tl_contact_params *params)
{
    if (is_stale(cache, surroundings->travel, params->phase, x))
        query(surroundings->collider, params->thickness_m, params->phase, x, cache);
    double depth = OUTSIDE_SHARE * params->thickness_m - distance_to(cache, x, params->phase);
    return depth > 0 ? vec3d_muladd(x, cache->normal, depth) : x;
}

/* Moves a probe out by moving its three vertices in proportion to their weights and inverse masses. */
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

/* Takes the ground where it is nearer. False if nothing is near. */
static bool take_ground(bool ground, vec3d x, struct tl_contact_height *out)
{
    if (ground && x.y < tl_min(out->height_m, REACH_M))
        *out = (struct tl_contact_height){{0, 1, 0}, x.y};
    return out->height_m < HUGE_VAL;
}

bool tl_contacts_height(const struct tl_contacts *contacts, size_t particle, vec3d x, double phase,
                        struct tl_contact_height *out)
{
    const struct tl_contact_cache *cache = &contacts->caches[particle];
    const struct surroundings surroundings = surroundings_of(contacts->collider);
    *out = (struct tl_contact_height){.height_m = HUGE_VAL};
    if (surroundings.collider && cache->near)
        *out = (struct tl_contact_height){cache->normal, distance_to(cache, x, phase)};
    return take_ground(surroundings.ground, x, out);
}

bool tl_contacts_height_asked(const tl_collider *collider, vec3d x, struct tl_contact_height *out)
{
    struct tl_contact contact;
    *out = (struct tl_contact_height){.height_m = HUGE_VAL};
    if (tl_collider_query(collider, (const double[3]){x.x, x.y, x.z}, REACH_M, &contact))
        *out = (struct tl_contact_height){{contact.normal[0], contact.normal[1], contact.normal[2]},
                                          contact.distance_m};
    return take_ground(tl_collider_has_ground(collider), x, out);
}

/* The work on the team. */
struct solving {
    struct surroundings surroundings;
    struct tl_contacts *contacts;
    const struct tl_contact_params *params;
    struct tl_particles *particles;
};

/* Whether keep_out would leave a point at x where it is, for an avatar that stands still: its anchors do. The
 * usual case. */
TL_INLINE bool stands_clear(const struct tl_contact_cache *cache, double thickness, vec3d x)
{
    vec3d moved = vec3d_sub(x, cache->query_point);
    if (cache->query_phase > 1 || cache->clearance <= 0 ||
        vec3d_dot(moved, moved) > cache->clearance * cache->clearance)
        return false;
    return !cache->near || vec3d_dot(vec3d_sub(x, cache->anchor[0]), cache->normal) >= thickness;
}

static void solve_particles(void *context)
{
    const struct solving *now = context;
    struct tl_particles *particles = now->particles;
    const double thickness = now->params->thickness_m;
    const bool still = now->surroundings.travel == 0, ground = now->surroundings.ground;
    const struct tl_range range = tl_team_range(particles->count, 1);
    for (size_t i = range.from; i < range.to; i++) {
        struct tl_contact_cache *cache = &now->contacts->caches[i];
        if (is_released(now->contacts, i) ||
            (still && stands_clear(cache, thickness, particles->x[i]) &&
             (!ground || particles->x[i].y >= thickness) && particles->w[i] > 0))
            continue;
        if (particles->w[i] > 0)
            particles->x[i] =
                keep_out(&now->surroundings, cache, particles->x[i], particles->previous[i], now->params);
        else if (particles->driven[i])
            particles->x[i] = park_pin(&now->surroundings, cache, particles->x[i], now->params);
    }
}

static struct tl_contact_params params_at(const struct tl_contacts *contacts, size_t i,
                                          const struct tl_contact_params *params)
{
    struct tl_contact_params own = *params;
    own.thickness_m *= tl_contacts_share(contacts, i);
    return own;
}

void tl_contacts_solve(struct tl_contacts *contacts, const struct tl_contact_params *params,
                       struct tl_particles *particles)
{
    struct solving now = {surroundings_of(contacts->collider), contacts, params, particles};
    if (!now.surroundings.collider)
        return;
    for (size_t i = 0; i < contacts->sample_count; i++) {
        const size_t at = contacts->particle_count + i;
        const struct tl_contact_params own = params_at(contacts, at, params);
        if (!is_sample_released(contacts, &contacts->samples[i]))
            solve_sample(&now.surroundings, &contacts->samples[i], &contacts->caches[at], &own, particles);
    }
    tl_team_run(particles->count, solve_particles, &now);
}

/* ---- Velocities ---- */

/* Returns the velocity of a point after an inelastic contact with friction. It is unchanged if the point, at
 * `gap` above a surface with velocity `surface`, would not reach the surface within h. Otherwise the
 * approaching normal velocity becomes 0, and the tangential slip is reduced by at most mu times that normal
 * velocity (Coulomb's bound on impulses per mass). */
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

/* apply_friction for the avatar and then the ground, for a point at x with velocity v. */
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
    for (size_t i = 0; i < contacts->sample_count; i++) {
        const size_t at = contacts->particle_count + i;
        const struct tl_contact_params own = params_at(contacts, at, params);
        apply_friction_to_sample(&surroundings, &contacts->samples[i], &contacts->caches[at], &own,
                                 particles);
    }
    for (size_t i = 0; i < particles->count; i++)
        if (particles->w[i] > 0)
            particles->v[i] = apply_all_friction(&surroundings, &contacts->caches[i], particles->x[i],
                                                 particles->v[i], params);
}
