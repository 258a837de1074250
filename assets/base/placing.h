/* Placing a model in the scene: which of its file's axes points up, its size, direction and place. Metres,
 * world axes with y up. */
#ifndef TOILE_ASSETS_BASE_PLACING_H
#define TOILE_ASSETS_BASE_PLACING_H

#include "assets/base/mesh.h"

#include <stdbool.h>

enum tl_up { TL_UP_AUTO, TL_UP_Y, TL_UP_Z };
extern const char *const tl_up_names[]; /* "auto", "y", "z"; NULL-terminated */

struct tl_placing {
    bool z_up;      /* +Z of the file becomes up, its -Y the front */
    float scale;    /* about the origin */
    float turn_deg; /* about the vertical; positive turns the front, +Z, towards +X */
    vec3s move_m;   /* last of all */
};

/* Whether the placing changes anything. Threads: pure. */
bool tl_placing_moves(const struct tl_placing *placing);

/* A point of the file, placed. Threads: pure. */
vec3s tl_placing_point(const struct tl_placing *placing, vec3s point);

/* The file's point that is placed there: undoes tl_placing_point. Threads: pure. */
vec3s tl_placing_origin(const struct tl_placing *placing, vec3s placed);

/* The placing turned by so many degrees more, and sized by a factor, about a placed point, which stays where
 * it is. Threads: pure. */
struct tl_placing tl_placing_about(const struct tl_placing *placing, vec3s point, float turn_deg,
                                   float factor);

/* The placing that takes a point placed by `from` to where `to` places it. Neither alters which axis is up.
 * Threads: pure. */
struct tl_placing tl_placing_between(const struct tl_placing *from, const struct tl_placing *to);

/* Places positions, normals and tangents. Threads: one per mesh. */
void tl_placing_apply(const struct tl_placing *placing, tl_mesh *mesh);

#endif
