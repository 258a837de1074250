#include "cloth/self_contact/exchange.h"

#include "config/base/memory.h"

#include <stdlib.h>

/* Stages of a plane's exchange within one call. */
enum stage {
    KEPT,      /* not exchanged */
    EXCHANGED, /* stands where the substep starts */
    MOVING,    /* is where the substep ends */
    STOPPED,   /* cannot be exchanged, or has moved and left a vertex no place */
};

struct exchange {
    struct tl_self_contact *self;
    const struct tl_self_contact_params *params;
    const struct tl_self_contact_start *start;
    const vec3d *x; /* [vertex] m, where vertices want to be */
    bool *known;    /* [vertex] of `touched` */
    size_t touched_count, touched_capacity;
    struct touched {
        uint32_t vertex;
        vec3d kept; /* the displacement that is left of what it wants */
    } * touched;
    size_t due_count, due_capacity;
    struct due {
        uint32_t vertex, pair;
        enum stage stage; /* to come */
    } * due;
};

static void touch(struct exchange *now, uint32_t vertex)
{
    if (now->known[vertex])
        return;
    now->known[vertex] = true;
    if (now->touched_count == now->touched_capacity) {
        now->touched_capacity = 2 * now->touched_capacity + 64;
        now->touched = tl_resize(now->touched, now->touched_capacity, sizeof *now->touched);
    }
    now->touched[now->touched_count++] = (struct touched){.vertex = vertex};
}

static vec3d wanted(const struct exchange *now, uint32_t v)
{
    return vec3d_sub(tl_affine_undo(&now->self->back, now->x[v]), now->self->base[v]);
}

static struct tl_self_contact_plane *plane_of(const struct tl_self_contact *self, uint32_t vertex,
                                              uint32_t pair)
{
    struct tl_self_contact_plane *planes = self->planes + self->plane_first[vertex];
    for (uint32_t k = 0; k < self->plane_count[vertex]; k++)
        if (planes[k].pair == pair)
            return &planes[k];
    return NULL;
}

/* The planes of a pair where the substep starts. */
static bool make_planes(const struct exchange *now, const struct tl_near_pair *pair,
                        struct tl_self_contact_plane planes[4])
{
    double weights[4];
    const struct tl_self_contact *self = now->self;
    struct tl_near_pair own = {.v = {0, 1, 2, 3}, .edges = pair->edges};
    vec3d at[4], to[4];
    for (int i = 0; i < 4; i++) {
        at[i] = tl_affine_undo(&now->start->back, now->start->x[pair->v[i]]);
        to[i] = tl_affine_undo(&self->back, now->x[pair->v[i]]);
    }
    vec3d between = tl_near_closest(&own, at, weights), normal = vec3d_unit_or(between, (vec3d){0});
    double distance = vec3d_norm(between);
    if (distance < TL_SELF_CONTACT_TOUCHING_M ||
        !tl_self_contact_planes_of(pair, self->size, at, to, normal, distance, planes))
        return false;
    for (int i = 0; i < 4; i++)
        planes[i].room += vec3d_dot(planes[i].normal, vec3d_sub(at[i], self->base[pair->v[i]]));
    return true;
}

static void keep_pair(struct exchange *now, uint32_t pair)
{
    for (int i = 0; i < 4; i++) {
        uint32_t v = now->self->near.pairs[pair].v[i];
        struct tl_self_contact_plane *plane = plane_of(now->self, v, pair);
        if (plane)
            plane->stage = STOPPED;
        touch(now, v);
    }
}

/* The place of a vertex's plane; NULL: it has none, and the new plane does not bound it. */
static struct tl_self_contact_plane *place_for(struct tl_self_contact *self, uint32_t vertex, uint32_t pair,
                                               bool bounds)
{
    struct tl_self_contact_plane *plane = plane_of(self, vertex, pair);
    if (plane || !bounds)
        return plane;
    tl_self_contact_make_room(self, vertex);
    return &self->planes[self->plane_first[vertex] + self->plane_count[vertex]++];
}

/* A pair that no plane separates keeps those that it has. */
static void exchange_pair(struct exchange *now, uint32_t k, enum stage stage)
{
    struct tl_self_contact *self = now->self;
    const struct tl_near_pair *pair = &self->near.pairs[k];
    struct tl_self_contact_plane planes[4];
    if (!make_planes(now, pair, planes)) {
        keep_pair(now, k);
        return;
    }
    for (int i = 0; i < 4; i++) {
        uint32_t v = pair->v[i];
        const double room = planes[i].room, gain = stage == MOVING ? planes[i].gain : 0;
        bool bounds = room + tl_min(gain, 0) < self->radius[v];
        struct tl_self_contact_plane *plane = place_for(self, v, k, bounds);
        if (plane)
            *plane = (struct tl_self_contact_plane){planes[i].normal, room + gain, gain, k, (uint8_t)stage};
        touch(now, v);
    }
}

/* Moves a pair's plane back to where the substep starts. */
static void stop_pair(const struct tl_self_contact *self, uint32_t pair)
{
    for (int i = 0; i < 4; i++) {
        struct tl_self_contact_plane *plane = plane_of(self, self->near.pairs[pair].v[i], pair);
        if (!plane)
            continue;
        plane->room -= plane->gain;
        plane->gain = 0;
        plane->stage = STOPPED;
    }
}

/* Notes the planes that stop vertices and can be exchanged. */
static void find_due(struct exchange *now)
{
    const struct tl_self_contact *self = now->self;
    now->due_count = 0;
    for (size_t i = 0; i < now->touched_count; i++) {
        uint32_t v = now->touched[i].vertex, from = self->plane_first[v];
        vec3d d = wanted(now, v);
        for (uint32_t k = from; k < from + self->plane_count[v]; k++) {
            const struct tl_self_contact_plane *plane = &self->planes[k];
            bool stops = vec3d_dot(d, plane->normal) > plane->room + TL_SELF_CONTACT_CUT_M / 2;
            if (!stops || plane->stage >= MOVING || plane->pair == TL_NONE)
                continue;
            if (now->due_count == now->due_capacity) {
                now->due_capacity = 2 * now->due_capacity + 64;
                now->due = tl_resize(now->due, now->due_capacity, sizeof *now->due);
            }
            now->due[now->due_count++] =
                (struct due){v, plane->pair, plane->stage == KEPT ? EXCHANGED : MOVING};
        }
    }
}

/* Each pair's planes are exchanged at most twice: for standing ones, and for ones that move. */
static void exchange_all(struct exchange *now)
{
    for (find_due(now); now->due_count > 0; find_due(now))
        for (size_t i = 0; i < now->due_count; i++) {
            const struct due *due = &now->due[i];
            if (plane_of(now->self, due->vertex, due->pair)->stage < due->stage)
                exchange_pair(now, due->pair, due->stage);
        }
}

/* Finds what is left of a vertex's way. Returns whether it has a place. */
static bool find_place(const struct exchange *now, struct touched *touched)
{
    const struct tl_self_contact *self = now->self;
    uint32_t v = touched->vertex;
    const struct tl_self_contact_plane *planes = self->planes + self->plane_first[v];
    size_t count = self->plane_count[v];
    vec3d d = wanted(now, v), safe = tl_self_contact_safe(self, now->start, v);
    bool stopped;
    touched->kept = tl_self_contact_bounded(d, safe, self->radius[v], planes, count, &stopped);
    return tl_self_contact_allows(touched->kept, self->radius[v], planes, count);
}

/* Moving planes stand still where they leave a vertex no place, for the other vertices of their pairs too,
 * which may find no place any more in turn. Where all planes stand still, a vertex can stay where it was. */
static void find_places(struct exchange *now)
{
    const struct tl_self_contact *self = now->self;
    for (bool stops = true; stops;) {
        stops = false;
        for (size_t i = 0; i < now->touched_count; i++) {
            if (find_place(now, &now->touched[i]))
                continue;
            uint32_t v = now->touched[i].vertex, from = self->plane_first[v];
            for (uint32_t k = from; k < from + self->plane_count[v]; k++)
                if (self->planes[k].stage == MOVING) {
                    stop_pair(self, self->planes[k].pair);
                    stops = true;
                }
        }
    }
}

/* Moves what was touched. Planes that have moved stand still from now on. */
static bool end_exchange(struct exchange *now, vec3d *x)
{
    const struct tl_self_contact *self = now->self;
    bool sunk = false;
    for (size_t i = 0; i < now->touched_count; i++) {
        uint32_t v = now->touched[i].vertex;
        vec3d result = tl_affine_apply(&self->moved, vec3d_add(self->base[v], now->touched[i].kept));
        sunk |= tl_self_contact_sinks(now->params, v, x[v], result);
        x[v] = result;
        for (uint32_t k = 0; k < self->plane_count[v]; k++)
            self->planes[self->plane_first[v] + k].stage = KEPT;
    }
    return sunk;
}

bool tl_self_contact_exchange(struct tl_self_contact *self, const struct tl_self_contact_params *params,
                              const struct tl_self_contact_start *start, vec3d *x)
{
    uint32_t count = (uint32_t)self->near.topology->vertex_count;
    struct exchange now = {
        .self = self, .params = params, .start = start, .x = x, .known = TL_NEW_ARRAY(bool, count)};
    for (uint32_t i = 0; i < count; i++)
        if (self->cut[i])
            touch(&now, i);
    exchange_all(&now);
    find_places(&now);
    bool sunk = end_exchange(&now, x);
    free(now.known);
    free(now.touched);
    free(now.due);
    return sunk;
}
