/* Layers of a garment of several pieces, such as a shirt over trousers: their order from inside to outside,
 * and contact between them with Coulomb friction.
 *
 * Every connected component of the cloth is a piece. Of two pieces within a few centimetres of each other,
 * the one that lies mostly on the other's outer side is the outer one. The avatar's normals decide which side
 * of a piece is its outer one; without an avatar the winding of the triangles does. The order is decided
 * once, and again when seams change the pieces. Contact then keeps the vertices of each layer on their side
 * of the other layer's nearest triangle, and moves both layers in inverse proportion to their masses. Pairs
 * are searched once per step and follow their triangles during the substeps. Points past an open edge of a
 * piece have no contact, because an edge does not separate two sides. Metres. Lifetime: plain structs that
 * own their arrays. Threads: pure. */
#ifndef TOILE_CLOTH_CONTACT_LAYERS_H
#define TOILE_CLOTH_CONTACT_LAYERS_H

#include "cloth/contact/contact.h"

/* A garment of more pieces has no layers: every pair of pieces is compared. */
#define TL_PIECES_MAX 64

/* A point of one layer and the nearest point of a triangle of another. */
struct tl_layer_contact {
    struct tl_contact_sample point, surface;
    vec3d normal; /* from the surface to the point's own side */
};

struct tl_layer {
    tl_collider *surface; /* the layer's triangles */
    uint32_t *triangles;  /* the cloth's triangle for each triangle of the surface */
    size_t particle_count;
    uint32_t *particles; /* [particle_count] the cloth's particle for each vertex of the surface */
    vec3s *positions;    /* [particle_count] of the surface, from the last search */
};

struct tl_layers {
    bool ordered;        /* tl_layers_decide has run */
    bool searched;       /* contacts are those of the last search */
    size_t layer_count;  /* 0 or 1: no contact between layers */
    uint32_t *layer_of;  /* [particle] 0 is innermost */
    bool *on_open_edge;  /* [particle] */
    signed char *facing; /* [triangle] wound normal points 1: outwards, -1: inwards, 0: neither */
    size_t sample_count; /* of all layers, vertices included */
    struct tl_contact_sample *samples;
    struct tl_layer *layers; /* [layer_count] */
    size_t contact_count;
    struct tl_layer_contact *contacts; /* good for one step */
};
void tl_layers_release(struct tl_layers *layers);

/* Invalidates the last search, for particles that were placed elsewhere. */
void tl_layers_forget(struct tl_layers *layers);

/* Numbers the connected components from 0 in `pieces` [vertex_count]; returns their number. */
size_t tl_layers_pieces(const struct tl_topology *topology, uint32_t *pieces);

/* Fills empty layers: finds the pieces, orders them by the positions `x` and builds a collider for each
 * layer. `avatar` may be NULL. Errors: those of tl_collider_create; returns false and leaves the layers empty
 * then. */
bool tl_layers_decide(struct tl_layers *layers, const struct tl_topology *topology, const vec2s (*rest)[3],
                      const tl_collider *avatar, const vec3d *x, tl_error *error);

/* Searches the contacts; once per step, at its start. Does nothing if no layer has moved since the last
 * search. */
void tl_layers_update(struct tl_layers *layers, const struct tl_topology *topology, const vec3d *x);

/* Separates the layers and applies friction; once per substep, before the avatar's contacts, which must hold
 * at the end of the substep. */
void tl_layers_solve(const struct tl_layers *layers, const struct tl_contact_params *params,
                     struct tl_particles *particles);

#endif
