#include "render/light/gbuffer.h"

#include "render/shaders.h"

#include <epoxy/gl.h>

#include <string.h>

/* Uniform locations of gbuffer.vert and gbuffer.frag beside those of surface.glsl. */
enum { VIEW_PROJECTION = 16, EYE = 17, FADING_DISC = 18 };

static bool make_program(struct tl_gbuffer *gbuffer, tl_gpu *gpu, tl_program *out, tl_error *error)
{
    return tl_program_create_variant(gpu, tl_embedded_shaders, "gbuffer.vert", "gbuffer.frag",
                                     gbuffer->defines, out, error);
}

bool tl_gbuffer_create(struct tl_gbuffer *gbuffer, tl_gpu *gpu, tl_error *error)
{
    tl_detail_defines(tl_detail_options.defaults, gbuffer->defines, sizeof gbuffer->defines);
    return make_program(gbuffer, gpu, &gbuffer->program, error);
}

bool tl_gbuffer_choose_detail(struct tl_gbuffer *gbuffer, tl_gpu *gpu, const struct tl_detail_params *detail,
                              tl_error *error)
{
    char before[sizeof gbuffer->defines];
    tl_program program;
    strcpy(before, gbuffer->defines);
    tl_detail_defines(detail, gbuffer->defines, sizeof gbuffer->defines);
    if (strcmp(before, gbuffer->defines) == 0)
        return true;
    if (!make_program(gbuffer, gpu, &program, error)) {
        strcpy(gbuffer->defines, before);
        return false;
    }
    tl_program_destroy(&gbuffer->program);
    gbuffer->program = program;
    return true;
}

void tl_gbuffer_release(struct tl_gbuffer *gbuffer)
{
    tl_program_destroy(&gbuffer->program);
    tl_target_destroy(&gbuffer->target);
}

static void allocate(struct tl_gbuffer *gbuffer, tl_gpu *gpu, int width, int height)
{
    static const unsigned formats[TL_GBUFFER_LAYERS] = {GL_RGBA32F, GL_RGBA16F, GL_RGBA16F, GL_RGBA16F,
                                                        GL_R32UI};
    if (gbuffer->target.width == width && gbuffer->target.height == height)
        return;
    tl_target_destroy(&gbuffer->target);
    gbuffer->target = tl_target_create(gpu, width, height, formats, TL_GBUFFER_LAYERS, true);
}

static void clear(const tl_target *target)
{
    const float nothing[] = {0, 0, 0, 0}, farthest = 1;
    const GLuint no_triangle[] = {0, 0, 0, 0};
    for (int i = 0; i < target->colour_count; i++)
        if (i == TL_GBUFFER_TRIANGLE)
            glClearNamedFramebufferuiv(target->id, GL_COLOR, i, no_triangle);
        else
            glClearNamedFramebufferfv(target->id, GL_COLOR, i, nothing);
    glClearNamedFramebufferfv(target->id, GL_DEPTH, 0, &farthest);
}

void tl_gbuffer_draw(struct tl_gbuffer *gbuffer, tl_gpu *gpu, const struct tl_view *view, int width,
                     int height, const tl_surfaces *surfaces, size_t surface_count,
                     const struct tl_ground *ground)
{
    allocate(gbuffer, gpu, width, height);
    clear(&gbuffer->target);
    glBindFramebuffer(GL_FRAMEBUFFER, gbuffer->target.id);
    glViewport(0, 0, width, height);
    glEnable(GL_DEPTH_TEST);
    glUseProgram(gbuffer->program.id);
    glUniformMatrix4fv(VIEW_PROJECTION, 1, GL_FALSE, view->view_projection.raw[0]);
    glUniform3fv(EYE, 1, view->eye.raw);
    for (size_t i = 0; i < surface_count; i++) {
        bool is_ground = ground && i + 1 == surface_count;
        if (is_ground)
            glUniform4f(FADING_DISC, ground->centre.x, ground->centre.y, ground->centre.z, ground->radius);
        else
            glUniform4f(FADING_DISC, 0, 0, 0, 0);
        tl_surfaces_draw(surfaces, i, TL_PARTS_ALL);
    }
    tl_gpu_reset_state(gpu);
}
