/* The body of a scene with all vertices of its file, for exports: the session draws, and collides with, a
 * simplified one where the file's is heavy. */
#ifndef TOILE_APP_SCENE_WHOLE_BODY_H
#define TOILE_APP_SCENE_WHOLE_BODY_H

#include "app/display/moving.h"
#include "app/scene/appearance.h"
#include "app/scene/session.h"
#include "assets/avatar.h"

struct tl_whole_body {
    tl_avatar *avatar; /* NULL: the session's body is whole */
    struct tl_moving moving;
    struct tl_appearance appearance;
};

/* Reads the file again where the session's body is simplified, poses it for the session's frame, and puts it
 * in place of the session's in *surface, which is that of the avatar; NULL, or a body that is whole: loads
 * nothing.
 *
 * Errors: false with one message; `out` is then empty. Lifetime: *surface borrows from `out` and from the
 * session; end with tl_whole_body_release. Threads: the session's. */
bool tl_whole_body_load(const tl_session *session, struct tl_whole_body *out, tl_surface *surface,
                        tl_error *error);
void tl_whole_body_release(struct tl_whole_body *body);

#endif
