#include "cloth/contact/keep_apart.h"

#include "cloth/mesh/team.h"
#include "config/memory.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

/* A vertex beyond this share of its ball's radius asks for a window, but not within RIM_SUBSTEPS of the last;
 * one that a plane has stopped asks too, but not within STOPPED_SUBSTEPS: the next plane may leave more room.
 */
#define RIM_SHARE        0.8
#define RIM_SUBSTEPS     2
#define STOPPED_SUBSTEPS 5
/* Farther past a plane, m, a vertex is not moved back before a new window has made sure that it must be:
 * planes stand still, and two features that move on together would be stopped by the plane between them. What
 * is moved back loses its momentum. */
#define CUT_M 5e-6
/* m/s, at which depth from before a substep is removed; at most this many of the mesh's own sizes in a
 * second. */
#define PUSH_SPEED 0.3
#define PUSH_SIZES 100
/* Projections on all planes of a vertex, one after the other, before it is moved back along its way. */
#define ROUNDS 3

void tl_apart_release(struct tl_apart *apart)
{
    tl_near_release(&apart->near);
    tl_untangle_release(&apart->untangle);
    free(apart->size);
    free(apart->speed);
    free(apart->base);
    free(apart->radius);
    free(apart->way);
    free(apart->off);
    free(apart->plane_first);
    free(apart->planes);
    free(apart->contacts.contacts);
    free(apart->carried);
    *apart = (struct tl_apart){0};
}

void tl_apart_forget(struct tl_apart *apart)
{
    tl_apart_release(apart);
}

void tl_apart_end_window(struct tl_apart *apart)
{
    apart->current = false;
}

/* Mean side at rest of the triangles around each vertex, m. */
static void measure_sizes(const struct tl_topology *topology, const vec2s (*rest)[3], double *sizes)
{
    double *sides = TL_NEW_ARRAY(double, topology->vertex_count);
    for (size_t t = 0; t < topology->triangle_count; t++)
        for (int i = 0; i < 3; i++) {
            double length = (double)glms_vec2_distance(rest[t][i], rest[t][(i + 1) % 3]);
            for (int end = 0; end < 2; end++) {
                uint32_t v = topology->triangles[t][(i + end) % 3];
                sizes[v] += length;
                sides[v]++;
            }
        }
    for (size_t i = 0; i < topology->vertex_count; i++)
        sizes[i] = sides[i] > 0 ? sizes[i] / sides[i] : 0;
    free(sides);
}

void tl_apart_prepare(struct tl_apart *apart, const struct tl_apart_params *params, const uint32_t *class_of,
                      const vec3d *x)
{
    if (apart->made)
        return;
    size_t count = params->topology->vertex_count;
    *apart = (struct tl_apart){.near = tl_near_create(params->topology, class_of, x),
                               .made = true,
                               .size = TL_NEW_ARRAY(double, count),
                               .speed = TL_NEW_ARRAY(vec3d, count),
                               .base = TL_NEW_ARRAY(vec3d, count),
                               .radius = TL_NEW_ARRAY(double, count),
                               .way = TL_NEW_ARRAY(vec3d, count),
                               .off = TL_NEW_ARRAY(double, count),
                               .plane_first = TL_NEW_ARRAY(uint32_t, count + 1)};
    measure_sizes(params->topology, params->rest, apart->size);
    tl_untangle_search(&apart->untangle, &apart->near, x);
    apart->clean = apart->was_clean = apart->untangle.pair_count == 0;
}

bool tl_apart_is_due(const struct tl_apart *apart, double h)
{
    return !apart->current || apart->late || (apart->rim && apart->substeps >= RIM_SUBSTEPS) ||
           (apart->stopped && apart->substeps >= STOPPED_SUBSTEPS) || apart->time_s + h > apart->longest_s;
}

/* ---- Contacts ---- */

/* Removes the depth of this substep, and of the depth before it what PUSH_SPEED allows. Friction reduces the
 * slip of this substep by at most `friction` times the depth of this substep, as for the avatar (contact.h).
 * Only the `movable` ones of the four vertices move. */
static void solve_contact(const struct tl_apart *apart, const struct tl_apart_contact *contact,
                          struct tl_range movable, const struct tl_apart_params *params,
                          struct tl_particles *particles)
{
    vec3d now = tl_apart_between(contact, particles->x);
    double depth = contact->kept - vec3d_dot(now, contact->normal);
    if (!(depth > 0))
        return;
    vec3d before = tl_apart_between(contact, particles->previous);
    double depth_before = tl_max(contact->kept - vec3d_dot(before, contact->normal), 0);
    double speed = tl_min(PUSH_SPEED, PUSH_SIZES * apart->size[contact->v[0]]);
    double push = depth - tl_max(depth_before - speed * params->h, 0), inverse = 0;
    for (size_t i = movable.from; i < movable.to; i++)
        inverse += particles->w[contact->v[i]] * contact->weights[i] * contact->weights[i];
    if (!(push > 0) || !(inverse > 0))
        return;
    vec3d slip = vec3d_sub(now, before);
    slip = vec3d_muladd(slip, contact->normal, -vec3d_dot(slip, contact->normal));
    double length = vec3d_norm(slip), held = params->friction * tl_max(depth - depth_before, 0);
    vec3d move = vec3d_scale(contact->normal, push);
    move = vec3d_muladd(move, slip, length > held ? -held / length : -1);
    move = vec3d_scale(move, 1 / inverse);
    for (size_t i = movable.from; i < movable.to; i++) {
        uint32_t v = contact->v[i];
        particles->x[v] = vec3d_muladd(particles->x[v], move, particles->w[v] * contact->weights[i]);
    }
}

void tl_apart_solve(struct tl_apart *apart, const struct tl_apart_params *params,
                    struct tl_particles *particles)
{
    apart->substeps++;
    tl_apart_set_time(apart, apart->time_s + params->h);
    if (!apart->clean)
        tl_untangle_push(&apart->untangle, params->h, particles);
    tl_apart_push(apart, params, particles);
}

void tl_apart_push(struct tl_apart *apart, const struct tl_apart_params *params,
                   struct tl_particles *particles)
{
    for (size_t i = 0; i < apart->contacts.count; i++)
        solve_contact(apart, &apart->contacts.contacts[i], (struct tl_range){0, 4}, params, particles);
}

void tl_apart_carry(struct tl_apart *apart, const struct tl_apart_params *params,
                    struct tl_particles *particles)
{
    for (size_t i = 0; i < apart->carried_count; i++) {
        const struct tl_apart_carried *carried = &apart->carried[i];
        const struct tl_apart_contact *contact = &apart->contacts.contacts[carried->contact];
        solve_contact(apart, contact, tl_apart_feature(contact, carried->first), params, particles);
    }
}

/* ---- Truncation ---- */

/* The displacement nearest to d that heeds ball and planes, as far as a few projections find it; then so much
 * of that as heeds all of them. */
static vec3d bounded(vec3d d, double radius, const struct tl_apart_plane *planes, size_t plane_count,
                     bool *stopped)
{
    double length = vec3d_norm(d);
    if (length > radius)
        d = vec3d_scale(d, radius / length);
    bool outside = false;
    for (int round = 0; round < ROUNDS; round++) {
        outside = false;
        for (size_t k = 0; k < plane_count; k++) {
            double over = vec3d_dot(d, planes[k].normal) - planes[k].room;
            if (over > 0) {
                d = vec3d_muladd(d, planes[k].normal, -over);
                outside = *stopped = true;
            }
        }
        if (!outside)
            break;
    }
    double share = 1;
    for (size_t k = 0; k < plane_count && outside; k++) {
        double along = vec3d_dot(d, planes[k].normal);
        if (along > planes[k].room)
            share = tl_min(share, planes[k].room / along);
    }
    length = vec3d_norm(d);
    if (length * share > radius)
        share = radius / length;
    return share < 1 ? vec3d_scale(d, share) : d;
}

struct truncation {
    bool rim, stopped;
    bool over; /* a vertex that wants to leave its ball, or far past a plane, was left where it is */
    bool sunk; /* a vertex was moved into the body */
};

static bool sinks(const struct tl_apart_params *params, size_t i, vec3d from, vec3d to)
{
    struct tl_contact_height above, at;
    return params->body && tl_contacts_height(params->body, i, to, params->phase, &at) && at.height_m < 0 &&
           tl_contacts_height(params->body, i, from, params->phase, &above) && at.height_m < above.height_m;
}

static void truncate_one(const struct tl_apart *apart, const struct tl_apart_params *params, size_t i,
                         vec3d *x, struct truncation *seen)
{
    double radius = apart->radius[i];
    vec3d d = vec3d_sub(tl_affine_undo(&apart->back, *x), apart->base[i]);
    double squared = vec3d_dot(d, d);
    uint32_t from = apart->plane_first[i], to = apart->plane_first[i + 1];
    seen->rim |= squared > RIM_SHARE * RIM_SHARE * radius * radius;
    bool over = squared > radius * radius;
    seen->over |= over;
    if (over || from == to)
        return;
    vec3d kept = bounded(d, radius, apart->planes + from, to - from, &seen->stopped);
    bool cut = vec3d_distance(kept, d) > CUT_M;
    seen->over |= cut;
    if (cut || (kept.x == d.x && kept.y == d.y && kept.z == d.z))
        return;
    vec3d result = tl_affine_apply(&apart->moved, vec3d_add(apart->base[i], kept));
    seen->sunk |= sinks(params, i, *x, result);
    *x = result;
}

/* What is truncated, on the team, and what was seen of any vertex. */
struct truncating {
    const struct tl_apart *apart;
    const struct tl_apart_params *params;
    vec3d *x;
    atomic_bool rim, stopped, over, sunk;
};

static void see(bool one, atomic_bool *any)
{
    if (one)
        atomic_store(any, true);
}

static void truncate_range(void *context)
{
    struct truncating *now = context;
    struct truncation seen = {0};
    const struct tl_range range = tl_team_range(now->apart->near.topology->vertex_count, 1);
    for (size_t i = range.from; i < range.to; i++)
        truncate_one(now->apart, now->params, i, &now->x[i], &seen);
    see(seen.rim, &now->rim);
    see(seen.stopped, &now->stopped);
    see(seen.over, &now->over);
    see(seen.sunk, &now->sunk);
}

static struct truncation truncate_all(const struct tl_apart *apart, const struct tl_apart_params *params,
                                      vec3d *x)
{
    struct truncating now = {.apart = apart, .params = params, .x = x};
    tl_team_run(apart->near.topology->vertex_count, truncate_range, &now);
    return (struct truncation){now.rim, now.stopped, now.over, now.sunk};
}

/* ---- Planes that move ---- */

/* Planes that stand still stop plies that move on together, the more, the thinner the plies are, and their
 * momentum is lost. Within one substep each vertex goes a straight way, and so may each plane: what is on its
 * side at the start and at the end is there at all times between. At the end, a plane is half way between
 * where its two features want to be.
 *
 * A moving plane may leave a vertex no place, if others hold that back. All planes of that vertex then stand
 * still, for the other vertices of their pairs too, which may find no place any more in turn. Where all
 * planes of a vertex stand still, it can stay where it was. */

/* Rounds of holding vertices back before all planes stand still. */
#define HOLD_ROUNDS 16
/* m, rounding of a displacement. */
#define ON_PLANE_M 1e-12

static bool is_kept(vec3d d, double radius, const struct tl_apart_plane *planes, size_t plane_count)
{
    bool kept = vec3d_norm(d) <= radius + ON_PLANE_M;
    for (size_t k = 0; k < plane_count && kept; k++)
        kept = vec3d_dot(d, planes[k].normal) <= planes[k].room + ON_PLANE_M;
    return kept;
}

static bool has_held(const struct tl_apart *apart, const bool *held, uint32_t pair)
{
    const uint32_t *v = apart->near.pairs[pair].v;
    return held[v[0]] || held[v[1]] || held[v[2]] || held[v[3]];
}

/* Stops the planes of all pairs with a vertex that is held; all planes if `held` is NULL. */
static void stop_planes(struct tl_apart *apart, const bool *held)
{
    for (uint32_t k = 0; k < apart->plane_first[apart->near.topology->vertex_count]; k++) {
        struct tl_apart_plane *plane = &apart->planes[k];
        if (plane->pair == TL_NONE || (held && !has_held(apart, held, plane->pair)))
            continue;
        plane->room -= plane->gain;
        plane->gain = 0;
    }
}

/* What displacements are found for, on the team, and whether some vertex has none. */
struct finding {
    const struct tl_apart *apart;
    const vec3d *x;
    vec3d *kept;
    bool *held;
    atomic_bool missing;
};

static void find_range(void *context)
{
    struct finding *now = context;
    const struct tl_apart *apart = now->apart;
    const struct tl_range range = tl_team_range(apart->near.topology->vertex_count, 1);
    for (size_t i = range.from; i < range.to; i++) {
        const struct tl_apart_plane *planes = apart->planes + apart->plane_first[i];
        size_t plane_count = apart->plane_first[i + 1] - apart->plane_first[i];
        bool stopped = false;
        vec3d d = vec3d_sub(tl_affine_undo(&apart->back, now->x[i]), apart->base[i]);
        now->kept[i] = bounded(d, apart->radius[i], planes, plane_count, &stopped);
        if (now->held[i] || is_kept(now->kept[i], apart->radius[i], planes, plane_count))
            continue;
        now->held[i] = true;
        see(true, &now->missing);
    }
}

/* Finds displacements `kept` [vertex] that all moving planes allow; returns whether each vertex has one, and
 * marks in `held` those that have none. */
static bool find_displacements(const struct tl_apart *apart, const vec3d *x, vec3d *kept, bool *held)
{
    struct finding now = {.apart = apart, .x = x, .kept = kept, .held = held};
    tl_team_run(apart->near.topology->vertex_count, find_range, &now);
    return !now.missing;
}

/* Afterwards the window's planes hold no more. Its contacts serve the next substep too, which makes a window
 * when it ends. */
static void truncate_moving(struct tl_apart *apart, const struct tl_apart_params *params, vec3d *x,
                            struct truncation *seen)
{
    size_t count = apart->near.topology->vertex_count;
    bool *held = TL_NEW_ARRAY(bool, count);
    vec3d *kept = TL_NEW_ARRAY(vec3d, count);
    for (uint32_t k = 0; k < apart->plane_first[count]; k++)
        apart->planes[k].room += apart->planes[k].gain;
    for (int round = 1; !find_displacements(apart, x, kept, held); round++)
        stop_planes(apart, round < HOLD_ROUNDS ? held : NULL);
    for (size_t i = 0; i < count; i++) {
        vec3d result = tl_affine_apply(&apart->moved, vec3d_add(apart->base[i], kept[i]));
        seen->sunk |= sinks(params, i, x[i], result);
        x[i] = result;
    }
    apart->spent = true;
    free(held);
    free(kept);
}

static struct truncation truncate_widely(struct tl_apart *apart, const struct tl_apart_params *params,
                                         const vec3d *from, bool still, vec3d *x)
{
    tl_apart_widen(apart, params, from, x, still);
    struct truncation seen = truncate_all(apart, params, x);
    if (seen.over)
        truncate_moving(apart, params, x, &seen);
    return seen;
}

void tl_apart_truncate(struct tl_apart *apart, const struct tl_apart_params *params, const vec3d *from,
                       struct tl_particles *particles)
{
    if (!apart->current)
        return;
    struct truncation seen = {.over = apart->spent};
    if (!apart->spent)
        seen = truncate_all(apart, params, particles->x);
    bool over = seen.over, sunk;
    if (over)
        seen = truncate_widely(apart, params, from, false, particles->x);
    sunk = seen.sunk;
    if (sunk)
        seen = truncate_widely(apart, params, from, true, particles->x);
    apart->late = apart->late || ((over || sunk) && from != particles->previous);
    apart->rim = apart->rim || seen.rim;
    apart->stopped = apart->stopped || seen.stopped;
}
