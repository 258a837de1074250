/* A model's mesh as it moves: this frame's positions, and the normals and tangents that follow from them. */
#ifndef TOILE_APP_SCENE_MOVING_H
#define TOILE_APP_SCENE_MOVING_H

#include "assets/base/surface.h"
#include "assets/model.h"
#include "cloth/tangents/tangent_frames.h"

struct tl_moving {
    const tl_model *model; /* borrowed */
    vec3s *positions;      /* [vertex_count], metres; written by the caller before tl_moving_update */
    vec3s *normals;
    vec4s *tangents;
    tl_tangent_frames *frames;
    uint64_t motion_revision;
};

/* `weld` as in tl_tangent_frames_create, or NULL to weld by position. Starts in the model's rest pose. */
void tl_moving_create(struct tl_moving *moving, const tl_model *model, const uint32_t *weld);
void tl_moving_release(struct tl_moving *moving);

/* As it was when it was created: in the rest pose, whatever it has gone through since. */
void tl_moving_restart(struct tl_moving *moving);

/* After `positions` changed. */
void tl_moving_update(struct tl_moving *moving);

/* How it looks: a material for each of the model's, and parts that choose among them. */
struct tl_dressing {
    tl_material *materials;
    struct tl_mesh_part *parts;
};

/* The view that the renderer gets. */
tl_surface tl_moving_surface(const struct tl_moving *moving, const char *name,
                             const struct tl_dressing *dressing);

#endif
