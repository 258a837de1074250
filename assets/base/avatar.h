/* The body that wears the garment and that cloth collides with: a model whose mesh may move. Immutable once
 * made. */
#ifndef TOILE_ASSETS_BASE_AVATAR_H
#define TOILE_ASSETS_BASE_AVATAR_H

#include "assets/base/model.h"

typedef struct tl_avatar {
    tl_model model;
    bool simplified; /* its file has more vertices (assets/topology/simplify.h) */
} tl_avatar;

/* Frees what the avatar owns and zeroes it; a zeroed avatar is accepted.
 *
 * Errors: none. Lifetime: pointers into the avatar end here. Threads: one, while no other uses it. */
void tl_avatar_release(tl_avatar *avatar);

#endif
