/* What wears the garment and is collided with: a model whose mesh may move. Immutable once made. */
#ifndef TOILE_ASSETS_AVATAR_H
#define TOILE_ASSETS_AVATAR_H

#include "assets/model.h"

typedef struct tl_avatar {
    tl_model model;
} tl_avatar;

/* A glTF or OBJ file; its units as in tl_model_load and tl_model_load_in. */
bool tl_avatar_load(const char *path, tl_avatar *out, tl_error *error);
bool tl_avatar_load_in(const char *path, enum tl_units units, tl_avatar *out, tl_error *error);
void tl_avatar_release(tl_avatar *avatar);

/* The built-in dress form (assets/builtin/form.c): a tailor's torso on a stand, 1.6 m high, feet of the stand
 * at y = 0, facing +Z, closed and manifold, covered in canvas. */
tl_avatar tl_avatar_form(void);

#endif
