#include "render/gbuffer/primary.h"

#include "render/gpu/shaders.h"

#include <epoxy/gl.h>

#define GROUP_SIDE 8 /* pixels */

enum { EYE, FORWARD, RIGHT, UP, DEPTHS }; /* locations */

bool tl_primary_trace(struct tl_primary *primary, tl_gpu *gpu, const struct tl_primary_request *request,
                      tl_error *error)
{
    const struct tl_view *view = request->view;
    const tl_texture *ids = request->ids;
    if (!primary->program.id &&
        !tl_program_create_compute(gpu, tl_embedded_shaders, "primary.comp", NULL, &primary->program, error))
        return false;
    glUseProgram(primary->program.id);
    glUniform3fv(EYE, 1, view->eye.raw);
    glUniform3fv(FORWARD, 1, view->forward.raw);
    glUniform3fv(RIGHT, 1, view->right.raw);
    glUniform3fv(UP, 1, view->up.raw);
    glUniform2f(DEPTHS, view->near_m, view->far_m);
    tl_tree_buffers_bind(request->tree, 0);
    glBindImageTexture(0, ids->id, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R32UI);
    tl_gpu_dispatch(tl_gpu_groups((size_t)ids->width, GROUP_SIDE),
                    tl_gpu_groups((size_t)ids->height, GROUP_SIDE), 1);
    return true;
}

bool tl_primary_reload(struct tl_primary *primary, tl_error *error)
{
    return !primary->program.id || tl_program_reload(&primary->program, error);
}

void tl_primary_release(struct tl_primary *primary)
{
    tl_program_destroy(&primary->program);
}
