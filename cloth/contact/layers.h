/* Layers of a garment that is made of several pieces, a shirt over trousers: which of them is outside, and
 * contact between them with Coulomb friction.
 *
 * Every connected component of the cloth is a piece. Of two that come within a few centimetres of each other,
 * the one that lies mostly on the other's outer side is the outer one; this is decided once, and anew when
 * seams change the pieces. From then on the vertices of each are kept on their side of the other's nearest
 * triangle, and both give way in proportion to their masses. The pairs are looked for once a step and follow
 * their triangles in between. A piece's open edges touch nothing: beside them there is no side to be on.
 * Which side of a piece is its outer one the avatar tells, and without one the winding of its triangles.
 * Metres. Threads: pure. */
#ifndef TOILE_CLOTH_CONTACT_LAYERS_H
#define TOILE_CLOTH_CONTACT_LAYERS_H

#include "cloth/contact/contact.h"

/* Garments of more pieces are not told apart. */
#define TL_PIECES_MAX 64

/* A point of one layer and the nearest point of a triangle of another. */
struct tl_layer_contact {
    struct tl_contact_sample point, surface;
    vec3d normal; /* from the surface to the point's own side */
};

struct tl_layer {
    tl_collider *surface; /* the layer's triangles */
    uint32_t *triangles;  /* the cloth's, of each triangle of the surface */
    size_t particle_count;
    uint32_t *particles; /* [particle_count] of each vertex of the surface */
    vec3s *positions;    /* [particle_count] as the surface has them */
};

struct tl_layers {
    bool ordered;
    bool searched;       /* touches are those of the last step */
    size_t layer_count;  /* 0 or 1: nothing to keep apart */
    uint32_t *layer_of;  /* [particle] 0 is innermost */
    bool *on_open_edge;  /* [particle] */
    signed char *facing; /* [triangle] 1: outwards as wound, -1: inwards, 0: neither */
    size_t sample_count; /* of all layers, vertices included */
    struct tl_contact_sample *samples;
    struct tl_layer *layers; /* [layer_count] */
    size_t contact_count;
    struct tl_layer_contact *contacts; /* good for one step */
};
void tl_layers_release(struct tl_layers *layers);

/* Forgets what the last step has found. */
void tl_layers_forget(struct tl_layers *layers);

/* How many pieces a mesh has; numbers them from 0 in `pieces` [vertex_count]. */
size_t tl_layers_pieces(const struct tl_topology *topology, uint32_t *pieces);

/* Fills empty layers: tells them apart, at positions `x`. Fails only where a collider cannot be built. */
bool tl_layers_decide(struct tl_layers *layers, const struct tl_topology *topology, const vec2s (*rest)[3],
                      const tl_collider *avatar, const vec3d *x, tl_error *error);

/* Once per step, at its start: looks for what touches. */
void tl_layers_update(struct tl_layers *layers, const struct tl_topology *topology, const vec3d *x);

/* Once per substep, before the avatar's contacts. */
void tl_layers_solve(const struct tl_layers *layers, const struct tl_contact_params *params,
                     struct tl_particles *particles);

#endif
