#include "app/scene/whole_body.h"

#include "app/scene/inset_body.h"
#include "app/scene/session_internal.h"
#include "config/base/memory.h"

#include <stdlib.h>

/* Poses the body as the session does (session.c). */
static bool pose(const tl_session *session, struct tl_whole_body *body, tl_error *error)
{
    const tl_model *model = &body->avatar->model;
    struct tl_moving *moving = &body->moving;
    tl_moving_create(moving, model, NULL);
    tl_model_pose(model, session->clip, session->frame / session->settings.cloth.frame_rate,
                  moving->positions);
    tl_moving_update(moving);
    if (!session->inset)
        return true;
    float *depths = tl_inset_body_find(&session->garment->model.mesh, &model->mesh, error);
    if (depths)
        tl_inset_body_apply(depths, moving->normals, moving->positions, model->mesh.vertex_count);
    free(depths);
    return depths != NULL;
}

bool tl_whole_body_load(const tl_session *session, struct tl_whole_body *out, tl_surface *surface,
                        tl_error *error)
{
    *out = (struct tl_whole_body){0};
    if (!surface || !session->avatar || !session->avatar->simplified)
        return true;
    tl_avatar loaded;
    if (!tl_scene_load_whole_avatar(&session->settings, &loaded, error))
        return false;
    out->avatar = TL_NEW(tl_avatar);
    *out->avatar = loaded;
    struct tl_session_models models = tl_session_models(session);
    models.avatar = &out->avatar->model;
    if (!pose(session, out, error) ||
        !tl_session_make_appearance(&models, &session->settings, &out->appearance, error)) {
        tl_whole_body_release(out);
        return false;
    }
    tl_surface whole = tl_moving_surface(&out->moving, surface->name, &out->appearance.avatar);
    whole.has_own_normals = surface->has_own_normals;
    *surface = whole;
    return true;
}

void tl_whole_body_release(struct tl_whole_body *body)
{
    tl_appearance_release(&body->appearance);
    tl_moving_release(&body->moving);
    if (body->avatar)
        tl_avatar_release(body->avatar);
    free(body->avatar);
    *body = (struct tl_whole_body){0};
}
