#include "render/envmap/vectors.h"

#include "render/gpu/shaders.h"

#include <epoxy/gl.h>

#include <math.h>

/* Uniform locations of vectors.vert, in addition to those of surface.glsl. */
enum { VIEW_PROJECTION = 64, EYE, MODE, INDEX };
/* The first texture unit after those of the surfaces. */
#define TRIANGLE_UNIT 16

void tl_vertex_vectors_release(struct tl_vertex_vectors *vectors)
{
    tl_program_destroy(&vectors->program);
    tl_target_destroy(&vectors->target);
}

bool tl_vertex_vectors_reload(struct tl_vertex_vectors *vectors, tl_error *error)
{
    return !vectors->program.id || tl_program_reload(&vectors->program, error);
}

bool tl_vertex_vectors_draw(struct tl_vertex_vectors *vectors, tl_gpu *gpu, const tl_target *gbuffer,
                            const struct tl_view *view, const tl_surfaces *surfaces, size_t surface_count,
                            bool has_ground, const struct tl_maps_params *params, tl_error *error)
{
    const unsigned formats[2] = {GL_RGBA32F, GL_RGBA32F};
    if (!vectors->program.id && !tl_program_create(gpu, tl_embedded_shaders, "vectors.vert", "vectors.frag",
                                                   &vectors->program, error))
        return false;
    tl_target_fit(&vectors->target, gpu, gbuffer, formats, 2);
    glBindFramebuffer(GL_FRAMEBUFFER, vectors->target.id);
    glViewport(0, 0, gbuffer->width, gbuffer->height);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_FALSE);
    glBindTextureUnit(TRIANGLE_UNIT, gbuffer->colours[TL_GBUFFER_TRIANGLE].id);
    glUseProgram(vectors->program.id);
    glUniformMatrix4fv(VIEW_PROJECTION, 1, GL_FALSE, view->view_projection.raw[0]);
    glUniform3fv(EYE, 1, view->eye.raw);
    for (size_t s = 0; s < surface_count; s++) {
        glUniform1i(MODE, has_ground && s + 1 == surface_count ? TL_MAPS_SURFACE : params->mode);
        for (size_t p = 0; p < tl_surfaces_part_count(surfaces, s); p++) {
            glUniform1f(INDEX, fmaxf(tl_surfaces_part_material(surfaces, s, p)->gloss.index, 1));
            tl_surfaces_draw_part(surfaces, s, p);
        }
    }
    return true;
}
