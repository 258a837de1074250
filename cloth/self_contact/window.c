/* Windows of self_contact.h: the balls, planes and contacts that hold until the next one. */
#include "cloth/self_contact/self_contact.h"

#include "cloth/mesh/team.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Radius of a ball: at rest; times what the vertex moves within WINDOW_SUBSTEPS, or one substep more than the
 * last window was of use for; at most this share of the mesh's own size there, so that triangles around a
 * vertex need no planes. */
#define RADIUS_M        0.0005
#define RADIUS_LEAD     1.3
#define WINDOW_SUBSTEPS 4
#define RADIUS_SHARE    0.115
/* Balls for longer ways: times the way, and at most this share of the mesh's size. Farther in one substep,
 * besides the common motion, the cloth would have to be searched as a whole. */
#define WIDE         1.02
#define WIDEST_SHARE 2.0
/* A list reaches as far as this many windows. */
#define LIST_WINDOWS 5
/* A list is renewed when it leaves a vertex less than this share of the radius that it wants. */
#define WANTED_SHARE 0.7
/* Common motion is renewed before it turns or stretches by more than this. */
#define COMMON_MOST 0.2
/* Limit of lists: more stretch of the common motion since then requires a new one. */
#define LIST_STRETCH 1.1
/* Planes that leave a vertex more room than its ball are no bound and not kept; but what they are exchanged
 * for may be. Each vertex has room for so many more planes than it has, at first. */
#define SPARE_PLANES 3

/* Bounds of the distance that contact keeps, besides the thickness: of the mesh's own size there, and of the
 * distance as made. */
#define KEPT_SHARE 0.25
#define KEPT_MADE  0.9

/* ---- Balls ---- */

static void choose_radii(struct tl_self_contact *self, const vec3d *x, double h)
{
    size_t count = self->near.topology->vertex_count;
    int lead = self->substeps + 1 < WINDOW_SUBSTEPS ? self->substeps + 1 : WINDOW_SUBSTEPS;
    for (size_t i = 0; i < count; i++) {
        double speed = vec3d_norm(vec3d_sub(self->speed[i], tl_affine_at(&self->velocity, x[i])));
        double wanted = RADIUS_M + RADIUS_LEAD * speed * lead * h;
        self->radius[i] = tl_min(wanted, RADIUS_SHARE * self->size[i]);
    }
}

/* Balls about `from` that hold the places `to`, to which the vertices want to go in one substep. */
static void widen_radii(struct tl_self_contact *self, const vec3d *from, const vec3d *to)
{
    size_t count = self->near.topology->vertex_count;
    for (size_t i = 0; i < count; i++) {
        double wanted = WIDE * vec3d_distance(tl_affine_undo(&self->back, to[i]), from[i]);
        self->radius[i] = tl_max(self->radius[i], tl_min(wanted, WIDEST_SHARE * self->size[i]));
    }
}

static void make_list(struct tl_self_contact *self, const struct tl_self_contact_params *params,
                      const vec3d *x)
{
    struct tl_near *near = &self->near;
    size_t count = near->topology->vertex_count;
    for (size_t i = 0; i < count; i++)
        near->reach[i] = LIST_WINDOWS * self->radius[i];
    near->margin = LIST_STRETCH * params->thickness_m;
    tl_near_list(near, x);
    memset(self->off, 0, count * sizeof *self->off);
    self->lists++;
}

static struct tl_affine common_motion(const vec3d *from, const vec3d *to, size_t count)
{
    vec3d *displacements = TL_NEW_ARRAY(vec3d, count);
    for (size_t i = 0; i < count; i++)
        displacements[i] = vec3d_sub(to[i], from[i]);
    struct tl_affine moved = tl_affine_fit(from, displacements, count);
    free(displacements);
    return moved;
}

/* Takes the common motion since the list out of the particles' displacements. Returns the factor by which its
 * inverse stretches at most, or 0 if the list is of no use any more. */
static double measure_list(struct tl_self_contact *self, const vec3d *x)
{
    struct tl_near *near = &self->near;
    struct tl_affine_inverse back;
    size_t count = near->topology->vertex_count;
    if (!near->listed)
        return 0;
    const struct tl_affine moved = common_motion(near->base, x, count);
    if (!tl_affine_invert(&moved, &back) || back.norm > LIST_STRETCH)
        return 0;
    bool good = true;
    for (size_t i = 0; i < count; i++) {
        self->off[i] = vec3d_distance(tl_affine_undo(&back, x[i]), near->base[i]);
        good = good && near->reach[i] - self->off[i] >= WANTED_SHARE * back.norm * self->radius[i];
    }
    return good ? back.norm : 0;
}

/* ---- Pairs ---- */

/* Findings of one thread in its part of the list. */
struct found {
    bool touching;
    struct tl_self_contact_pairs contacts;
    size_t plane_count, plane_capacity;
    struct found_plane {
        uint32_t vertex;
        struct tl_self_contact_plane plane;
    } * planes;
    size_t tight_count, tight_capacity;
    struct tight_pair {
        uint32_t v[4];
        double radius;
    } * tight; /* no plane separates them safely */
};

static void add_plane(struct found *found, uint32_t vertex, const struct tl_self_contact_plane *plane,
                      double radius)
{
    if (plane->room >= radius)
        return;
    if (found->plane_count == found->plane_capacity) {
        found->plane_capacity = 2 * found->plane_capacity + 256;
        found->planes = tl_resize(found->planes, found->plane_capacity, sizeof *found->planes);
    }
    found->planes[found->plane_count++] = (struct found_plane){vertex, *plane};
}

static void add_tight(struct found *found, const struct tl_near_pair *pair, double distance)
{
    if (found->tight_count == found->tight_capacity) {
        found->tight_capacity = 2 * found->tight_capacity + 64;
        found->tight = tl_resize(found->tight, found->tight_capacity, sizeof *found->tight);
    }
    struct tight_pair tight = {.radius = TL_SELF_CONTACT_UNPLANED_SHARE * distance};
    memcpy(tight.v, pair->v, sizeof tight.v);
    found->tight[found->tight_count++] = tight;
}

static void add_planes(const struct tl_self_contact *self, const struct tl_near_pair *pair, const vec3d *x,
                       vec3d normal, double distance, struct found *found)
{
    const vec3d at[4] = {x[pair->v[0]], x[pair->v[1]], x[pair->v[2]], x[pair->v[3]]};
    struct tl_self_contact_plane planes[4];
    if (!tl_self_contact_planes_of(pair, self->size, at, at, normal, distance, planes)) {
        add_tight(found, pair, distance);
        return;
    }
    for (int i = 0; i < 4; i++) {
        planes[i].pair = (uint32_t)(pair - self->near.pairs);
        add_plane(found, pair->v[i], &planes[i], self->radius[pair->v[i]]);
    }
}

static void add_contact(struct tl_self_contact_pairs *list, const struct tl_self_contact_pair *contact)
{
    if (list->count == list->capacity) {
        list->capacity = 2 * list->capacity + 64;
        list->pairs = tl_resize(list->pairs, list->capacity, sizeof *list->pairs);
    }
    list->pairs[list->count++] = *contact;
}

/* Computed once a pair and list. */
static double kept_between(const struct tl_self_contact *self, const struct tl_self_contact_params *params,
                           struct tl_near_pair *pair)
{
    double kept = params->thickness_m, weights[4];
    if (pair->kept >= 0)
        return (double)pair->kept;
    for (int i = 0; i < 4; i++)
        kept = tl_min(kept, KEPT_SHARE * self->size[pair->v[i]]);
    double made = vec3d_norm(tl_near_closest(pair, params->made_at, weights));
    pair->kept = (float)tl_min(kept, KEPT_MADE * made);
    return (double)pair->kept;
}

static double most_of(const double *numbers, const struct tl_near_pair *pair, int from, int to)
{
    double most = numbers[pair->v[from]];
    for (int i = from + 1; i < to; i++)
        most = tl_max(most, numbers[pair->v[i]]);
    return most;
}

static void look_at(const struct tl_self_contact *self, const struct tl_self_contact_params *params,
                    const vec3d *x, struct tl_near_pair *pair, struct found *found)
{
    struct tl_self_contact_pair contact;
    int second = tl_near_second(pair);
    if (!self->clean && tl_untangle_is_free(&self->untangle, pair))
        return;
    vec3d between = tl_near_closest(pair, x, contact.weights);
    double distance = vec3d_norm(between);
    if (distance < TL_SELF_CONTACT_TOUCHING_M) {
        found->touching = true;
        return;
    }
    double reach = most_of(self->radius, pair, 0, second) + most_of(self->radius, pair, second, 4);
    if (distance > reach + params->thickness_m)
        return;
    vec3d normal = vec3d_unit_or(between, (vec3d){0});
    if (distance <= reach + 2 * TL_SELF_CONTACT_FLOOR_M)
        add_planes(self, pair, x, normal, distance, found);
    memcpy(contact.v, pair->v, sizeof contact.v);
    for (int i = 0; i < second; i++)
        contact.weights[i] = -contact.weights[i];
    contact.normal = normal;
    contact.edges = pair->edges;
    contact.kept = kept_between(self, params, pair);
    if (distance < reach + contact.kept)
        add_contact(&found->contacts, &contact);
}

/* `reach` [vertex] is what each vertex may have moved since the list, may move within the window, and half
 * the thickness. */
static void look_at_range(const struct tl_self_contact *self, const struct tl_self_contact_params *params,
                          const vec3d *x, const double *reach, struct tl_range range, struct found *found)
{
    for (size_t k = range.from; k < range.to; k++) {
        struct tl_near_pair *pair = &self->near.pairs[k];
        int second = tl_near_second(pair);
        if ((double)pair->distance <= most_of(reach, pair, 0, second) + most_of(reach, pair, second, 4))
            look_at(self, params, x, pair, found);
    }
}

/* ---- Gathering ---- */

/* Makes the array as large as what is in use, and `more`. */
static void reserve_planes(struct tl_self_contact *self, size_t more)
{
    if (self->plane_end + more <= self->plane_capacity)
        return;
    self->plane_capacity = 2 * (self->plane_end + more);
    self->planes = tl_resize(self->planes, self->plane_capacity, sizeof *self->planes);
}

void tl_self_contact_make_room(struct tl_self_contact *self, size_t vertex)
{
    const uint32_t count = self->plane_count[vertex], room = 2 * count + SPARE_PLANES;
    if (count < self->plane_room[vertex])
        return;
    reserve_planes(self, room);
    memcpy(self->planes + self->plane_end, self->planes + self->plane_first[vertex],
           count * sizeof *self->planes);
    self->plane_first[vertex] = (uint32_t)self->plane_end;
    self->plane_room[vertex] = room;
    self->plane_end += room;
}

/* Bounds balls where no plane separates, and sorts the planes by vertex, in the order of the list. */
static void gather_planes(struct tl_self_contact *self, const struct found *parts, size_t part_count)
{
    size_t vertex_count = self->near.topology->vertex_count;
    uint32_t *first = self->plane_first, *count = self->plane_count;
    memset(count, 0, vertex_count * sizeof *count);
    for (size_t part = 0; part < part_count; part++) {
        for (size_t k = 0; k < parts[part].plane_count; k++)
            count[parts[part].planes[k].vertex]++;
        for (size_t k = 0; k < parts[part].tight_count; k++)
            for (int i = 0; i < 4; i++) {
                double *radius = &self->radius[parts[part].tight[k].v[i]];
                *radius = tl_min(*radius, parts[part].tight[k].radius);
            }
    }
    self->plane_end = 0;
    for (size_t i = 0; i < vertex_count; i++) {
        first[i] = (uint32_t)self->plane_end;
        self->plane_room[i] = count[i] + SPARE_PLANES;
        self->plane_end += self->plane_room[i];
    }
    reserve_planes(self, 0);
    memset(count, 0, vertex_count * sizeof *count);
    for (size_t part = 0; part < part_count; part++)
        for (size_t k = 0; k < parts[part].plane_count; k++) {
            const struct found_plane *found = &parts[part].planes[k];
            self->planes[first[found->vertex] + count[found->vertex]++] = found->plane;
        }
}

static void gather_contacts(struct tl_self_contact *self, const struct found *parts, size_t part_count)
{
    self->contacts.count = 0;
    for (size_t part = 0; part < part_count; part++)
        for (size_t k = 0; k < parts[part].contacts.count; k++)
            add_contact(&self->contacts, &parts[part].contacts.pairs[k]);
}

/* ---- Supports ---- */

vec3d tl_self_contact_between(const struct tl_self_contact_pair *contact, const vec3d *x)
{
    vec3d sum = {0};
    for (int i = 0; i < 4; i++)
        sum = vec3d_muladd(sum, x[contact->v[i]], contact->weights[i]);
    return sum;
}

struct tl_range tl_self_contact_feature(const struct tl_self_contact_pair *contact, bool first)
{
    size_t second = contact->edges ? 2 : 1;
    return first ? (struct tl_range){0, second} : (struct tl_range){second, 4};
}

/* The upper feature of a contact lies on the lower one if the contact's normal has at least this cosine with
 * the direction away from the body, */
#define CARRYING_COSINE 0.5
/* and the gap is less than this many times the kept distance. Vertices of a smaller weight do not count. */
#define CARRYING_GAPS  2
#define LEAST_CARRYING 0.1

/* Positions of vertices that lie on the body, directly or by way of other cloth. */
struct carriers {
    bool *known; /* [vertex] */
    struct tl_contact_height *at;
};

static bool is_close(const struct tl_self_contact_pair *contact, const vec3d *x)
{
    return vec3d_dot(tl_self_contact_between(contact, x), contact->normal) < CARRYING_GAPS * contact->kept;
}

/* Whether one feature of a contact lies on the other; `lower` is then where the other one is. */
static bool lies_on(const struct carriers *carriers, const struct tl_self_contact_pair *contact,
                    bool first_is_upper, struct tl_contact_height *lower)
{
    const struct tl_range range = tl_self_contact_feature(contact, !first_is_upper);
    *lower = (struct tl_contact_height){0};
    for (size_t i = range.from; i < range.to; i++) {
        double weight = fabs(contact->weights[i]);
        const struct tl_contact_height *at = &carriers->at[contact->v[i]];
        if (weight < LEAST_CARRYING)
            continue;
        if (!carriers->known[contact->v[i]])
            return false;
        lower->up = vec3d_muladd(lower->up, at->up, weight);
        lower->height_m += weight * at->height_m;
    }
    lower->up = vec3d_unit_or(lower->up, (vec3d){0});
    return vec3d_dot(lower->up, contact->normal) * (first_is_upper ? -1 : 1) >= CARRYING_COSINE;
}

/* Vertices of the upper feature that are not known to lie on anything are one ply above the lower one. */
static void raise_upper(const struct tl_self_contact_pair *contact, bool first_is_upper,
                        const struct tl_contact_height *lower, struct carriers *carriers)
{
    const struct tl_range range = tl_self_contact_feature(contact, first_is_upper);
    for (size_t i = range.from; i < range.to; i++) {
        uint32_t v = contact->v[i];
        if (carriers->known[v] || fabs(contact->weights[i]) < LEAST_CARRYING)
            continue;
        carriers->known[v] = true;
        carriers->at[v] = (struct tl_contact_height){vec3d_scale(contact->normal, first_is_upper ? -1 : 1),
                                                     lower->height_m + contact->kept};
    }
}

static int compare_carried(const void *a, const void *b)
{
    const struct tl_self_contact_carried *left = a, *right = b;
    if (left->height_m != right->height_m)
        return left->height_m < right->height_m ? -1 : 1;
    return (left->contact > right->contact) - (left->contact < right->contact);
}

/* Appends the contacts among `undecided` [count] in which a feature lies on a known one, until there are no
 * more: each pass goes one ply farther at least. */
static void find_carried(struct tl_self_contact *self, uint32_t *undecided, size_t count,
                         struct carriers *carriers)
{
    for (size_t before = SIZE_MAX; count < before;) {
        before = count;
        count = 0;
        for (size_t k = 0; k < before; k++) {
            const struct tl_self_contact_pair *contact = &self->contacts.pairs[undecided[k]];
            struct tl_contact_height lower;
            bool first = lies_on(carriers, contact, true, &lower);
            if (!first && !lies_on(carriers, contact, false, &lower)) {
                undecided[count++] = undecided[k];
                continue;
            }
            raise_upper(contact, first, &lower, carriers);
            self->carried[self->carried_count++] = (struct tl_self_contact_carried){
                .height_m = lower.height_m, .contact = undecided[k], .first = first};
        }
    }
}

/* Orders the contacts that carry from the body outwards. */
static void order_carried(struct tl_self_contact *self, const struct tl_self_contact_params *params,
                          const vec3d *x)
{
    size_t count = self->near.topology->vertex_count, contact_count = self->contacts.count, close = 0;
    self->carried_count = 0;
    if (!params->body || contact_count == 0)
        return;
    struct carriers carriers = {TL_NEW_ARRAY(bool, count), TL_NEW_ARRAY(struct tl_contact_height, count)};
    for (size_t i = 0; i < count; i++)
        carriers.known[i] = tl_contacts_height(params->body, i, x[i], params->phase, &carriers.at[i]) &&
                            carriers.at[i].height_m < params->carrier_m;
    uint32_t *undecided = TL_NEW_ARRAY(uint32_t, contact_count);
    for (size_t k = 0; k < contact_count; k++)
        if (is_close(&self->contacts.pairs[k], x))
            undecided[close++] = (uint32_t)k;
    if (close > self->carried_capacity) {
        self->carried_capacity = 2 * close;
        self->carried = tl_resize(self->carried, self->carried_capacity, sizeof *self->carried);
    }
    find_carried(self, undecided, close, &carriers);
    if (self->carried_count > 0)
        qsort(self->carried, self->carried_count, sizeof *self->carried, compare_carried);
    free(undecided);
    free(carriers.known);
    free(carriers.at);
}

/* Planes on the body's surface, for vertices that could enter it. */
static void add_body(const struct tl_self_contact *self, const struct tl_self_contact_params *params,
                     const vec3d *x, struct found *found)
{
    struct tl_contact_height at;
    for (size_t i = 0; i < self->near.topology->vertex_count && params->body; i++)
        if (tl_contacts_height(params->body, i, x[i], params->phase, &at)) {
            const struct tl_self_contact_plane plane = {
                .normal = vec3d_scale(at.up, -1), .room = tl_max(at.height_m, 0), .pair = TL_NONE};
            add_plane(found, (uint32_t)i, &plane, self->radius[i]);
        }
}

struct looking {
    const struct tl_self_contact *self;
    const struct tl_self_contact_params *params;
    const vec3d *x;
    const double *reach;
    struct found *parts; /* one for each thread of the team */
};

static void look_on_team(void *context)
{
    const struct looking *now = context;
    look_at_range(now->self, now->params, now->x, now->reach, tl_team_range(now->self->near.pair_count, 1),
                  &now->parts[tl_team_thread()]);
}

static void find_planes(struct tl_self_contact *self, const struct tl_self_contact_params *params,
                        const vec3d *x, double stretch, bool still)
{
    size_t count = self->near.topology->vertex_count;
    size_t part_count = tl_team_size(count);
    struct found *parts = TL_NEW_ARRAY(struct found, part_count);
    double *reach = TL_NEW_ARRAY(double, count);
    for (size_t i = 0; i < count; i++)
        reach[i] = self->off[i] + stretch * (self->radius[i] + params->thickness_m / 2);
    struct looking looking = {self, params, x, reach, parts};
    tl_team_run(count, look_on_team, &looking);
    if (still)
        add_body(self, params, x, &parts[part_count - 1]);
    gather_planes(self, parts, part_count);
    gather_contacts(self, parts, part_count);
    order_carried(self, params, x);
    for (size_t part = 0; part < part_count; part++) {
        self->clean = self->clean && !parts[part].touching;
        free(parts[part].contacts.pairs);
        free(parts[part].planes);
        free(parts[part].tight);
    }
    free(parts);
    free(reach);
}

/* ---- The window ---- */

vec3d tl_self_contact_safe(const struct tl_self_contact *self, const struct tl_self_contact_start *start,
                           size_t vertex)
{
    return vec3d_sub(tl_affine_undo(&start->back, start->x[vertex]), self->base[vertex]);
}

bool tl_self_contact_sinks(const struct tl_self_contact_params *params, size_t i, vec3d from, vec3d to)
{
    struct tl_contact_height above, at;
    return params->body && tl_contacts_height(params->body, i, to, params->phase, &at) && at.height_m < 0 &&
           tl_contacts_height(params->body, i, from, params->phase, &above) && at.height_m < above.height_m;
}

void tl_self_contact_set_time(struct tl_self_contact *self, double time_s)
{
    self->time_s = time_s;
    self->moved = tl_affine_scaled(&self->velocity, time_s);
    if (!tl_affine_invert(&self->moved, &self->back))
        self->current = false;
}

static void choose_common_motion(struct tl_self_contact *self, const vec3d *x, double h)
{
    self->velocity = tl_affine_fit(x, self->speed, self->near.topology->vertex_count);
    if (tl_affine_gradient_norm(&self->velocity) * 2 * h > COMMON_MOST)
        memset(self->velocity.gradient, 0, sizeof self->velocity.gradient);
    double norm = tl_affine_gradient_norm(&self->velocity);
    self->longest_s = norm > 0 ? COMMON_MOST / norm : HUGE_VAL;
}

/* Makes the window at positions `x` for the speeds that are known; its balls hold `to`, if that is not NULL.
 */
static void make_window(struct tl_self_contact *self, const struct tl_self_contact_params *params,
                        const vec3d *x, const vec3d *to, bool still)
{
    struct tl_near *near = &self->near;
    size_t count = near->topology->vertex_count;
    if (!self->clean) {
        tl_untangle_search(&self->untangle, near, x);
        self->clean = self->untangle.pair_count == 0;
        self->was_clean = self->was_clean || self->clean;
    }
    choose_common_motion(self, x, params->h);
    if (still)
        self->velocity = (struct tl_affine){0};
    choose_radii(self, x, params->h);
    tl_self_contact_set_time(self, to ? params->h : 0);
    if (to)
        widen_radii(self, x, to);
    double stretch = measure_list(self, x);
    if (!(stretch > 0)) {
        make_list(self, params, x);
        stretch = 1;
    }
    memcpy(self->base, x, count * sizeof *x);
    for (size_t i = 0; i < count; i++)
        self->radius[i] = tl_min(self->radius[i], (near->reach[i] - self->off[i]) / stretch);
    find_planes(self, params, x, stretch, still);
    self->current = true;
    self->rim = self->stopped = self->late = false;
    self->substeps = to ? 1 : 0;
    self->windows++;
}

void tl_self_contact_renew(struct tl_self_contact *self, const struct tl_self_contact_params *params,
                           const struct tl_particles *particles, bool velocity_from_positions)
{
    size_t count = self->near.topology->vertex_count;
    const vec3d *x = particles->x, *before = particles->previous;
    for (size_t i = 0; i < count; i++)
        self->speed[i] = velocity_from_positions ? vec3d_scale(vec3d_sub(x[i], before[i]), 1 / params->h)
                                                 : particles->v[i];
    make_window(self, params, x, NULL, false);
}

void tl_self_contact_widen(struct tl_self_contact *self, const struct tl_self_contact_params *params,
                           const vec3d *from, const vec3d *to, bool still)
{
    size_t count = self->near.topology->vertex_count;
    for (size_t i = 0; i < count; i++)
        self->speed[i] = vec3d_scale(vec3d_sub(to[i], from[i]), 1 / params->h);
    make_window(self, params, from, to, still);
}
