#include "cloth/self_contact/exchange.h"

#include "cloth/mesh/team.h"
#include "config/base/memory.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

/* A vertex beyond this share of its ball's radius asks for a window, but not within RIM_SUBSTEPS of the last;
 * one that a plane has stopped asks too, but not within STOPPED_SUBSTEPS, unless these take more than
 * STOPPED_S: the next plane may leave more room, but contacts of long substeps are soon those of another
 * place. */
#define RIM_SHARE        0.8
#define RIM_SUBSTEPS     2
#define STOPPED_SUBSTEPS 5
#define STOPPED_S        5e-3
/* m/s, at which depth from before a substep is removed; at most this many of the mesh's own sizes in a
 * second. */
#define PUSH_SPEED 0.3
#define PUSH_SIZES 100

void tl_apart_release(struct tl_apart *apart)
{
    tl_near_release(&apart->near);
    tl_untangle_release(&apart->untangle);
    free(apart->size);
    free(apart->speed);
    free(apart->base);
    free(apart->radius);
    free(apart->off);
    free(apart->cut);
    free(apart->plane_first);
    free(apart->plane_count);
    free(apart->plane_room);
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
                               .off = TL_NEW_ARRAY(double, count),
                               .cut = TL_NEW_ARRAY(bool, count),
                               .plane_first = TL_NEW_ARRAY(uint32_t, count),
                               .plane_count = TL_NEW_ARRAY(uint32_t, count),
                               .plane_room = TL_NEW_ARRAY(uint32_t, count)};
    measure_sizes(params->topology, params->rest, apart->size);
    tl_untangle_search(&apart->untangle, &apart->near, x);
    apart->clean = apart->was_clean = apart->untangle.pair_count == 0;
}

bool tl_apart_is_due(const struct tl_apart *apart, double h)
{
    return !apart->current || apart->late || (apart->rim && apart->substeps >= RIM_SUBSTEPS) ||
           (apart->stopped && (apart->substeps >= STOPPED_SUBSTEPS || apart->time_s >= STOPPED_S)) ||
           apart->time_s + h > apart->longest_s;
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

struct truncation {
    bool rim, stopped;
    bool out;  /* a vertex that wants to leave its ball was left where it is, */
    bool over; /* or one that wants far past a plane */
    bool sunk; /* a vertex was moved into the body */
};

/* Work of a truncation on the team, and what was found at any vertex. */
struct truncating {
    const struct tl_apart *apart;
    const struct tl_apart_params *params;
    const struct tl_apart_start *start;
    vec3d *x;
    bool *cut; /* [vertex] */
    atomic_bool rim, stopped, out, over, sunk;
};

static void truncate_one(struct truncating *now, size_t i, struct truncation *seen)
{
    const struct tl_apart *apart = now->apart;
    double radius = apart->radius[i];
    vec3d *x = &now->x[i], d = vec3d_sub(tl_affine_undo(&apart->back, *x), apart->base[i]);
    double squared = vec3d_dot(d, d);
    const struct tl_apart_plane *planes = apart->planes + apart->plane_first[i];
    size_t plane_count = apart->plane_count[i];
    seen->rim |= squared > RIM_SHARE * RIM_SHARE * radius * radius;
    bool out = squared > radius * radius;
    seen->out |= out;
    now->cut[i] = out;
    if (out || plane_count == 0)
        return;
    vec3d safe = tl_apart_safe(apart, now->start, i);
    vec3d kept = tl_apart_bounded(d, safe, radius, planes, plane_count, &seen->stopped);
    now->cut[i] = vec3d_distance(kept, d) > TL_APART_CUT_M;
    seen->over |= now->cut[i];
    if (now->cut[i] || (kept.x == d.x && kept.y == d.y && kept.z == d.z))
        return;
    vec3d result = tl_affine_apply(&apart->moved, vec3d_add(apart->base[i], kept));
    seen->sunk |= tl_apart_sinks(now->params, i, *x, result);
    *x = result;
}

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
        truncate_one(now, i, &seen);
    see(seen.rim, &now->rim);
    see(seen.stopped, &now->stopped);
    see(seen.out, &now->out);
    see(seen.over, &now->over);
    see(seen.sunk, &now->sunk);
}

static struct truncation truncate_all(struct tl_apart *apart, const struct tl_apart_params *params,
                                      const struct tl_apart_start *start, vec3d *x)
{
    struct truncating now = {.apart = apart, .params = params, .start = start, .x = x, .cut = apart->cut};
    tl_team_run(apart->near.topology->vertex_count, truncate_range, &now);
    return (struct truncation){now.rim, now.stopped, now.out, now.over, now.sunk};
}

/* The common motion at the time of `from`. */
static struct tl_apart_start start_of(const struct tl_apart *apart, const struct tl_apart_params *params,
                                      const vec3d *from, const vec3d *previous)
{
    struct tl_apart_start start = {.x = from, .back = apart->back};
    const struct tl_affine moved = tl_affine_scaled(&apart->velocity, apart->time_s - params->h);
    if (from == previous)
        tl_affine_invert(&moved, &start.back);
    return start;
}

static struct truncation truncate_widely(struct tl_apart *apart, const struct tl_apart_params *params,
                                         const vec3d *from, bool still, vec3d *x)
{
    tl_apart_widen(apart, params, from, x, still);
    const struct tl_affine none = {0};
    struct tl_apart_start start = {.x = from};
    tl_affine_invert(&none, &start.back);
    struct truncation seen = truncate_all(apart, params, &start, x);
    if (seen.out || seen.over)
        seen.sunk |= tl_apart_exchange(apart, params, &start, x);
    return seen;
}

void tl_apart_truncate(struct tl_apart *apart, const struct tl_apart_params *params, const vec3d *from,
                       struct tl_particles *particles)
{
    if (!apart->current)
        return;
    const struct tl_apart_start start = start_of(apart, params, from, particles->previous);
    struct truncation seen = truncate_all(apart, params, &start, particles->x);
    bool wide = seen.out, still;
    if (wide)
        seen = truncate_widely(apart, params, from, false, particles->x);
    else if (seen.over)
        seen.sunk |= tl_apart_exchange(apart, params, &start, particles->x);
    still = seen.sunk;
    if (still)
        seen = truncate_widely(apart, params, from, true, particles->x);
    apart->late = apart->late || still || (wide && from != particles->previous);
    apart->rim = apart->rim || seen.rim;
    apart->stopped = apart->stopped || seen.stopped;
}
