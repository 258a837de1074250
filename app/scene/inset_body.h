/* A body under a garment as authored. Garments are modelled on bodies that their programs hide, or shrink,
 * under cloth: where both are drawn as they are, skin reaches through a legging by millimetres. So the drawn
 * body is moved inwards there; the collider, and with it the cloth, has the body as it is. Metres. Threads:
 * pure. */
#ifndef TOILE_APP_SCENE_INSET_BODY_H
#define TOILE_APP_SCENE_INSET_BODY_H

#include "assets/base/mesh.h"
#include "config/base/error.h"

/* The distance by which each vertex of the body, in its rest pose, moves against its normal, so that it lies
 * TL_INSET_BODY_CLEARANCE_M inside the garment: [body->vertex_count], 0 where no cloth covers it or it lies
 * deeper. A vertex is covered where the garment is at most TL_INSET_BODY_REACH_M away, before or behind it,
 * and faces the same side. All 0 for a body that the garment was not made for: it shows as it is. Errors:
 * NULL, as tl_collider_create. The caller frees it. */
#define TL_INSET_BODY_CLEARANCE_M 0.003f
#define TL_INSET_BODY_REACH_M     0.02f
float *tl_inset_body_find(const tl_mesh *garment, const tl_mesh *body, tl_error *error);

/* Moves `positions` [count] against `normals`. */
void tl_inset_body_apply(const float *depths, const vec3s *normals, vec3s *positions, size_t count);

#endif
