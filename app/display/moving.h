/* A model's mesh as it moves: this frame's positions, and the normals and tangents that follow from them. */
#ifndef TOILE_APP_DISPLAY_MOVING_H
#define TOILE_APP_DISPLAY_MOVING_H

#include "assets/base/surface.h"
#include "assets/model.h"
#include "assets/topology/borders.h"
#include "cloth/tangents/tangent_frames.h"

struct tl_moving {
    const tl_model *model; /* borrowed */
    vec3s *positions;      /* [vertex_count], metres; written by the caller before tl_moving_update */
    vec3s *normals;
    vec4s *tangents;
    tl_tangent_frames *frames;
    uint64_t motion_revision;
    tl_borders borders; /* of a garment's pieces; empty until tl_moving_find_borders */
};

/* `weld` as in tl_tangent_frames_create, or NULL to weld by position. Starts in the model's rest pose. */
void tl_moving_create(struct tl_moving *moving, const tl_model *model, const uint32_t *weld);
void tl_moving_release(struct tl_moving *moving);

/* Finds the borders of the pieces of the garment whose model moves. */
void tl_moving_find_borders(struct tl_moving *moving, const tl_garment *garment);

/* Goes back to the state after tl_moving_create: the rest pose. */
void tl_moving_restart(struct tl_moving *moving);

/* The same with the file's own normals, and its tangents or, if it has none, the computed ones made
 * orthogonal to these normals. */
void tl_moving_restart_as_authored(struct tl_moving *moving);

/* Recomputes normals and tangents after `positions` changed, and raises motion_revision. */
void tl_moving_update(struct tl_moving *moving);

/* The vertex nearest to where a ray first hits the mesh, from either side, and the distance in units of
 * `direction`'s length. False: it misses, and *vertex is not set. */
bool tl_moving_pick(const struct tl_moving *moving, vec3s origin, vec3s direction, uint32_t *vertex,
                    float *distance_m);

/* The appearance of a moving model: a material for each of the model's, and parts that choose among them. */
struct tl_dressing {
    tl_material *materials; /* the model's, then at most one for each part */
    size_t material_count;
    struct tl_mesh_part *parts;
};

/* The surface for the renderer. Borrows all three arguments. */
tl_surface tl_moving_surface(const struct tl_moving *moving, const char *name,
                             const struct tl_dressing *dressing);

#endif
