#include "cloth/cage/clearance.h"

#include "cloth/state.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

/* Maximum clearance that is resolved: 2.5 mm, of the dress's 20 mm edges enough for nine vertices in ten. */
#define LIST_REACH_M  0.002
#define LIST_MARGIN_M 0.001

/* Cloth that is nearer to a body than this is kept off it, by so much: a body that bends by 40 mm rises by
 * 0.3 mm between vertices that are 10 mm apart. */
#define REACH_M 0.01f
#define CLEAR_M 0.001f

float tl_clearance_share(const struct tl_clearance *clearance, vec3s end, vec3s flat, vec3s moved)
{
    float above = clearance->height_m + glms_vec3_dot(glms_vec3_sub(flat, end), clearance->up);
    float down = -glms_vec3_dot(moved, clearance->up), room = fmaxf(above - CLEAR_M, 0);
    float length = glms_vec3_norm(moved);
    float share = clearance->height_m < REACH_M && down > room ? room / fmaxf(down, 1e-12f) : 1;
    return length > clearance->room_m ? fminf(share, clearance->room_m / length) : share;
}

static void measure_heights(const tl_cloth *cloth, const tl_collider *collider, size_t count,
                            struct tl_clearance *out)
{
    const struct tl_contacts *contacts = &cloth->contacts; /* not filled in a drape that was kept */
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < count; i++) {
        struct tl_contact_height at;
        vec3d x = cloth->particles.x[i];
        bool is_known = contacts->collider && contacts->caches[i].query_phase <= 1;
        bool is_near = is_known ? tl_contacts_height(contacts, i, x, 1, &at)
                                : collider && tl_contacts_height_asked(collider, x, &at);
        out[i].up = is_near ? vec3d_to_float(at.up) : (vec3s){{0, 1, 0}};
        out[i].height_m = is_near ? (float)at.height_m : INFINITY;
    }
}

/* Pairs that are not listed leave each vertex what is left of its reach, and half of the margin. `off`
 * [count]: m that it has moved since the list was made; NULL: not at all. */
static void take_pairs(const struct tl_near *near, const double *off, const vec3d *x, size_t count,
                       struct tl_clearance *out)
{
    for (size_t i = 0; i < count; i++)
        out[i].room_m = (float)(near->margin / 2 + fmax(near->reach[i] - (off ? off[i] : 0), 0));
    for (size_t i = 0; i < near->pair_count; i++) {
        const struct tl_near_pair *pair = &near->pairs[i];
        double weights[4];
        float room = 0.5f * (float)vec3d_norm(tl_near_closest(pair, x, weights));
        for (int k = 0; k < 4; k++)
            out[pair->v[k]].room_m = fminf(out[pair->v[k]].room_m, room);
    }
}

/* The list that contact keeps is not there before the cloth has moved, nor while it is untangled. */
static void list_pairs(const tl_cloth *cloth, size_t count, struct tl_clearance *out)
{
    uint32_t *class_of = TL_NEW_ARRAY(uint32_t, count);
    for (size_t i = 0; i < count; i++)
        class_of[i] = (uint32_t)i;
    struct tl_near near = tl_near_create(&cloth->topology, class_of, cloth->particles.x);
    for (size_t i = 0; i < count; i++)
        near.reach[i] = LIST_REACH_M;
    near.margin = LIST_MARGIN_M;
    tl_near_list(&near, cloth->particles.x);
    take_pairs(&near, NULL, cloth->particles.x, count, out);
    tl_near_release(&near);
    free(class_of);
}

static void measure_rooms(const tl_cloth *cloth, size_t count, struct tl_clearance *out)
{
    const struct tl_self_contact *self_contact = &cloth->self_contact;
    if (self_contact->made && self_contact->near.listed)
        take_pairs(&self_contact->near, self_contact->off, cloth->particles.x, count, out);
    else if (cloth->params.self_contact)
        list_pairs(cloth, count, out);
    else
        for (size_t i = 0; i < count; i++)
            out[i].room_m = INFINITY;
}

void tl_cloth_clearances(const tl_cloth *cloth, const tl_collider *collider, struct tl_clearance *out)
{
    const size_t count = cloth->particles.count;
    measure_heights(cloth, collider, count, out);
    measure_rooms(cloth, count, out);
}
