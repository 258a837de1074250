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

void tl_self_contact_release(struct tl_self_contact *self)
{
    tl_near_release(&self->near);
    tl_untangle_release(&self->untangle);
    free(self->size);
    free(self->speed);
    free(self->base);
    free(self->radius);
    free(self->off);
    free(self->cut);
    free(self->plane_first);
    free(self->plane_count);
    free(self->plane_room);
    free(self->planes);
    free(self->contacts.pairs);
    free(self->carried);
    *self = (struct tl_self_contact){0};
}

void tl_self_contact_forget(struct tl_self_contact *self)
{
    tl_self_contact_release(self);
}

void tl_self_contact_end_window(struct tl_self_contact *self)
{
    self->current = false;
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

void tl_self_contact_prepare(struct tl_self_contact *self, const struct tl_self_contact_params *params,
                             const uint32_t *class_of, const vec3d *x)
{
    if (self->made)
        return;
    size_t count = params->topology->vertex_count;
    *self = (struct tl_self_contact){.near = tl_near_create(params->topology, class_of, x),
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
    measure_sizes(params->topology, params->rest, self->size);
    tl_untangle_search(&self->untangle, &self->near, x);
    self->clean = self->was_clean = self->untangle.pair_count == 0;
}

bool tl_self_contact_is_due(const struct tl_self_contact *self, double h)
{
    return !self->current || self->late || (self->rim && self->substeps >= RIM_SUBSTEPS) ||
           (self->stopped && (self->substeps >= STOPPED_SUBSTEPS || self->time_s >= STOPPED_S)) ||
           self->time_s + h > self->longest_s;
}

/* ---- Contacts ---- */

/* Removes the depth of this substep, and of the depth before it what PUSH_SPEED allows. Friction reduces the
 * slip of this substep by at most `friction` times the depth of this substep, as for the avatar (contact.h).
 * Only the `movable` ones of the four vertices move. */
static void solve_contact(const struct tl_self_contact *self, const struct tl_self_contact_pair *contact,
                          struct tl_range movable, const struct tl_self_contact_params *params,
                          struct tl_particles *particles)
{
    vec3d now = tl_self_contact_between(contact, particles->x);
    double depth = contact->kept - vec3d_dot(now, contact->normal);
    if (!(depth > 0))
        return;
    vec3d before = tl_self_contact_between(contact, particles->previous);
    double depth_before = tl_max(contact->kept - vec3d_dot(before, contact->normal), 0);
    double speed = tl_min(PUSH_SPEED, PUSH_SIZES * self->size[contact->v[0]]);
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

void tl_self_contact_solve(struct tl_self_contact *self, const struct tl_self_contact_params *params,
                           struct tl_particles *particles)
{
    self->substeps++;
    tl_self_contact_set_time(self, self->time_s + params->h);
    if (!self->clean)
        tl_untangle_push(&self->untangle, params->h, particles);
    tl_self_contact_push(self, params, particles);
}

void tl_self_contact_push(struct tl_self_contact *self, const struct tl_self_contact_params *params,
                          struct tl_particles *particles)
{
    for (size_t i = 0; i < self->contacts.count; i++)
        solve_contact(self, &self->contacts.pairs[i], (struct tl_range){0, 4}, params, particles);
}

void tl_self_contact_carry(struct tl_self_contact *self, const struct tl_self_contact_params *params,
                           struct tl_particles *particles)
{
    for (size_t i = 0; i < self->carried_count; i++) {
        const struct tl_self_contact_carried *carried = &self->carried[i];
        const struct tl_self_contact_pair *contact = &self->contacts.pairs[carried->contact];
        solve_contact(self, contact, tl_self_contact_feature(contact, carried->first), params, particles);
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
    const struct tl_self_contact *self;
    const struct tl_self_contact_params *params;
    const struct tl_self_contact_start *start;
    vec3d *x;
    bool *cut; /* [vertex] */
    atomic_bool rim, stopped, out, over, sunk;
};

static void truncate_one(struct truncating *now, size_t i, struct truncation *seen)
{
    const struct tl_self_contact *self = now->self;
    double radius = self->radius[i];
    vec3d *x = &now->x[i], d = vec3d_sub(tl_affine_undo(&self->back, *x), self->base[i]);
    double squared = vec3d_dot(d, d);
    const struct tl_self_contact_plane *planes = self->planes + self->plane_first[i];
    size_t plane_count = self->plane_count[i];
    seen->rim |= squared > RIM_SHARE * RIM_SHARE * radius * radius;
    bool out = squared > radius * radius;
    seen->out |= out;
    now->cut[i] = out;
    if (out || plane_count == 0)
        return;
    vec3d safe = tl_self_contact_safe(self, now->start, i);
    vec3d kept = tl_self_contact_bounded(d, safe, radius, planes, plane_count, &seen->stopped);
    now->cut[i] = vec3d_distance(kept, d) > TL_SELF_CONTACT_CUT_M;
    seen->over |= now->cut[i];
    if (now->cut[i] || (kept.x == d.x && kept.y == d.y && kept.z == d.z))
        return;
    vec3d result = tl_affine_apply(&self->moved, vec3d_add(self->base[i], kept));
    seen->sunk |= tl_self_contact_sinks(now->params, i, *x, result);
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
    const struct tl_range range = tl_team_range(now->self->near.topology->vertex_count, 1);
    for (size_t i = range.from; i < range.to; i++)
        truncate_one(now, i, &seen);
    see(seen.rim, &now->rim);
    see(seen.stopped, &now->stopped);
    see(seen.out, &now->out);
    see(seen.over, &now->over);
    see(seen.sunk, &now->sunk);
}

static struct truncation truncate_all(struct tl_self_contact *self,
                                      const struct tl_self_contact_params *params,
                                      const struct tl_self_contact_start *start, vec3d *x)
{
    struct truncating now = {.self = self, .params = params, .start = start, .x = x, .cut = self->cut};
    tl_team_run(self->near.topology->vertex_count, truncate_range, &now);
    return (struct truncation){now.rim, now.stopped, now.out, now.over, now.sunk};
}

/* The common motion at the time of `from`. */
static struct tl_self_contact_start start_of(const struct tl_self_contact *self,
                                             const struct tl_self_contact_params *params, const vec3d *from,
                                             const vec3d *previous)
{
    struct tl_self_contact_start start = {.x = from, .back = self->back};
    const struct tl_affine moved = tl_affine_scaled(&self->velocity, self->time_s - params->h);
    if (from == previous)
        tl_affine_invert(&moved, &start.back);
    return start;
}

static struct truncation truncate_widely(struct tl_self_contact *self,
                                         const struct tl_self_contact_params *params, const vec3d *from,
                                         bool still, vec3d *x)
{
    tl_self_contact_widen(self, params, from, x, still);
    const struct tl_affine none = {0};
    struct tl_self_contact_start start = {.x = from};
    tl_affine_invert(&none, &start.back);
    struct truncation seen = truncate_all(self, params, &start, x);
    if (seen.out || seen.over)
        seen.sunk |= tl_self_contact_exchange(self, params, &start, x);
    return seen;
}

void tl_self_contact_truncate(struct tl_self_contact *self, const struct tl_self_contact_params *params,
                              const vec3d *from, struct tl_particles *particles)
{
    if (!self->current)
        return;
    const struct tl_self_contact_start start = start_of(self, params, from, particles->previous);
    struct truncation seen = truncate_all(self, params, &start, particles->x);
    bool wide = seen.out, still;
    if (wide)
        seen = truncate_widely(self, params, from, false, particles->x);
    else if (seen.over)
        seen.sunk |= tl_self_contact_exchange(self, params, &start, particles->x);
    still = seen.sunk;
    if (still)
        seen = truncate_widely(self, params, from, true, particles->x);
    self->late = self->late || still || (wide && from != particles->previous);
    self->rim = self->rim || seen.rim;
    self->stopped = self->stopped || seen.stopped;
}
