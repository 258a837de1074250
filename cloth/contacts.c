#include "cloth/contacts.h"

#include "assets/topology/sets.h"
#include "cloth/contact/caught.h"
#include "cloth/timestep.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

struct tl_contact_params tl_cloth_contact_params(const tl_cloth *cloth, double h, double phase_before,
                                                 double phase)
{
    return (struct tl_contact_params){.friction =
                                          tl_seams_are_closing(&cloth->seams) ? 0 : cloth->fabric.friction,
                                      .thickness_m = cloth->fabric.thickness_m,
                                      .push_out_speed = TL_PUSH_OUT_SPEED,
                                      .phase_before = phase_before,
                                      .phase = phase,
                                      .h = h};
}

/* While panels are sewn, plies keep this share of the distance to the avatar at least: panels of a pattern
 * that pass each other more closely stay caught in each other. */
#define SEWING_PLY_SHARE 0.5

static double ply_distance(const tl_cloth *cloth)
{
    double ply = tl_cloth_fabric_ply(&cloth->fabric);
    return tl_seams_are_closing(&cloth->seams) ? fmax(ply, SEWING_PLY_SHARE * cloth->fabric.thickness_m)
                                               : ply;
}

/* Cloth lies on the body where it is nearer than this many times the distance that contact keeps: vertices of
 * coarse cloth stand higher than the points between them, which touch. */
#define CARRIER_DISTANCES 3

static struct tl_self_contact_params params_of_self_contact(const tl_cloth *cloth, double friction, double h,
                                                            double phase)
{
    return (struct tl_self_contact_params){.topology = &cloth->topology,
                                           .rest = (const vec2s(*)[3])cloth->rest,
                                           .made_at = cloth->made_at,
                                           .thickness_m = ply_distance(cloth),
                                           .friction = friction,
                                           .h = h,
                                           .body = &cloth->contacts,
                                           .phase = phase,
                                           .carrier_m = CARRIER_DISTANCES * cloth->fabric.thickness_m};
}

bool tl_cloth_is_tangled(const tl_cloth *cloth)
{
    return cloth->params.self_contact && !cloth->self_contact.was_clean;
}

bool tl_cloth_order_layers(tl_cloth *cloth, const tl_collider *collider, tl_error *error)
{
    if (!tl_cloth_is_tangled(cloth))
        tl_layers_release(&cloth->layers);
    if (!tl_cloth_is_tangled(cloth) || cloth->layers.ordered || tl_seams_are_closing(&cloth->seams))
        return true;
    return tl_layers_decide(&cloth->layers, &cloth->topology, (const vec2s(*)[3])cloth->rest, collider,
                            cloth->particles.x, error);
}

void tl_cloth_solve_contact(tl_cloth *cloth, const struct tl_contact_params *contact)
{
    const struct tl_self_contact_params params =
        params_of_self_contact(cloth, contact->friction, contact->h, contact->phase);
    if (cloth->params.self_contact) {
        tl_self_contact_solve(&cloth->self_contact, &params, &cloth->particles);
        if (tl_cloth_is_tangled(cloth))
            tl_layers_solve(&cloth->layers, contact, &cloth->particles);
    }
    tl_contacts_solve(&cloth->contacts, contact, &cloth->particles);
    if (cloth->params.self_contact) {
        tl_self_contact_carry(&cloth->self_contact, &params, &cloth->particles);
        tl_self_contact_truncate(&cloth->self_contact, &params, cloth->particles.previous, &cloth->particles);
    }
}

/* Distance of such cloth. Farther, so much passes that it cannot be untangled. */
#define NO_CONTACT_M 0.012

/* Joins what is near a pair that is stuck, as with a fold between its two sides: cloth may pass through
 * itself there until the pair has met, and is untangled then. */
static void disable_self_contact_near(const tl_cloth *cloth, const struct tl_link *link, uint32_t *classes)
{
    const vec3d *x = cloth->particles.x;
    for (uint32_t i = 0; i < cloth->particles.count; i++)
        if (vec3d_distance(x[i], x[link->a]) < NO_CONTACT_M ||
            vec3d_distance(x[i], x[link->b]) < NO_CONTACT_M)
            tl_sets_join(classes, link->a, i);
}

/* Classes of vertices between which there is no contact: those that open seams join count as one. */
static uint32_t *make_classes(const tl_cloth *cloth)
{
    uint32_t *classes = tl_sets_create(cloth->particles.count);
    for (size_t i = 0; i < cloth->seams.pair_count; i++)
        tl_sets_join(classes, cloth->seams.links[i].a, cloth->seams.links[i].b);
    for (size_t i = 0; i < cloth->seams.pair_count && tl_seams_are_stuck(&cloth->seams); i++)
        disable_self_contact_near(cloth, &cloth->seams.links[i], classes);
    for (uint32_t i = 0; i < cloth->particles.count; i++)
        classes[i] = tl_sets_find(classes, i);
    return classes;
}

void tl_cloth_prepare_contact(tl_cloth *cloth)
{
    if (cloth->self_contact.made || !cloth->params.self_contact)
        return;
    uint32_t *classes = make_classes(cloth);
    const struct tl_self_contact_params params = params_of_self_contact(cloth, 0, 1, 0);
    tl_self_contact_prepare(&cloth->self_contact, &params, classes, cloth->particles.x);
    free(classes);
}

void tl_cloth_renew_contact(tl_cloth *cloth, double h, double phase_before, bool velocity_from_positions)
{
    if (!cloth->params.self_contact || !tl_self_contact_is_due(&cloth->self_contact, h))
        return;
    const struct tl_self_contact_params params = params_of_self_contact(cloth, 0, h, phase_before);
    tl_self_contact_renew(&cloth->self_contact, &params, &cloth->particles, velocity_from_positions);
}

/* A moving avatar catches cloth, and so does cloth that lies on itself and holds a vertex inside the avatar
 * until that is moved out: its neighbours cannot follow past the cloth between. Otherwise soft cloth on a
 * body at rest may hang at any length. */
static void release_caught(tl_cloth *cloth, const tl_collider *collider)
{
    bool held = cloth->params.self_contact && cloth->contacts.caught_count > 0;
    if (collider && (held || tl_collider_travel(collider) > 0))
        tl_caught_release(&cloth->topology, (const vec2s(*)[3])cloth->rest, cloth->shortest_edge,
                          &cloth->particles, cloth->contacts.slipped);
}

static bool is_torn(const tl_cloth *cloth)
{
    return tl_caught_tears(&cloth->topology, (const vec2s(*)[3])cloth->rest, cloth->shortest_edge,
                           cloth->particles.x);
}

/* Cloth that a moving avatar has caught may have to go where other cloth is: it pushes that aside, in at most
 * so many rounds. */
#define MAKE_WAY_ROUNDS 100

/* Lets what is caught slip, moves what is inside the avatar out, and what is in the way of both aside, until
 * nothing is inside and no edge is torn. Returns whether some vertices cannot be outside of the avatar and on
 * their side of other cloth. */
static bool make_way(tl_cloth *cloth, const tl_collider *collider, const struct tl_contact_params *contact,
                     vec3d *from)
{
    struct tl_particles *particles = &cloth->particles;
    const struct tl_self_contact_params params =
        params_of_self_contact(cloth, 0, tl_cloth_substep(cloth), contact->phase);
    bool any = true;
    for (int round = 0; round < MAKE_WAY_ROUNDS && (any || is_torn(cloth)); round++) {
        release_caught(cloth, collider);
        tl_self_contact_push(&cloth->self_contact, &params, particles);
        tl_self_contact_truncate(&cloth->self_contact, &params, from, particles);
        memcpy(from, particles->x, particles->count * sizeof *from);
        any = tl_contacts_lift(&cloth->contacts, contact, particles);
    }
    return any;
}

void tl_cloth_keep_outside(tl_cloth *cloth, const tl_collider *collider,
                           const struct tl_contact_params *contact)
{
    struct tl_particles *particles = &cloth->particles;
    size_t count = particles->count;
    bool pressed = false;
    if (!collider || !cloth->params.self_contact) {
        release_caught(cloth, collider);
        tl_contacts_enforce(&cloth->contacts, contact, particles);
        return;
    }
    vec3d *from = TL_NEW_ARRAY(vec3d, count);
    memcpy(from, particles->x, count * sizeof *from);
    release_caught(cloth, collider);
    tl_contacts_enforce(&cloth->contacts, contact, particles);
    if (tl_collider_travel(collider) > 0 && cloth->contacts.caught_count > 0)
        pressed = make_way(cloth, collider, contact, from);
    const struct tl_self_contact_params params =
        params_of_self_contact(cloth, 0, tl_cloth_substep(cloth), contact->phase);
    tl_self_contact_truncate(&cloth->self_contact, &params, from, particles);
    if (pressed)
        tl_contacts_let_go(&cloth->contacts, contact, particles);
    free(from);
}

void tl_cloth_find_contacts(const tl_cloth *cloth, const tl_collider *collider, struct tl_contacts *body,
                            struct tl_self_contact *self)
{
    *body = tl_contacts_create(&cloth->topology, (const vec2s(*)[3])cloth->rest);
    *self = (struct tl_self_contact){0};
    tl_contacts_begin(body, collider);
    tl_contacts_update(body, cloth->particles.x, cloth->fabric.thickness_m, 1);
    if (!cloth->params.self_contact)
        return;
    uint32_t *classes = make_classes(cloth);
    struct tl_self_contact_params params = params_of_self_contact(cloth, 0, tl_cloth_substep(cloth), 1);
    params.body = body;
    tl_self_contact_prepare(self, &params, classes, cloth->particles.x);
    tl_self_contact_renew(self, &params, &cloth->particles, false);
    free(classes);
}
