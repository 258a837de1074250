#include "render/light/gbuffer.h"

#include "render/shaders.h"

#include <epoxy/gl.h>

#include <string.h>

/* Uniform locations of gbuffer.vert and gbuffer.frag beside those of surface.glsl. */
enum { VIEW_PROJECTION = 16, EYE = 17, FADING_DISC = 18 };

/* Texture unit of gbuffer.frag's own: the last one, out of the surfaces' way. */
#define PASSED_UNIT 15

void tl_gbuffer_release(struct tl_gbuffer *gbuffer)
{
    for (int i = 0; i < TL_GBUFFER_PROGRAMS; i++)
        tl_program_destroy(&gbuffer->programs[i].program);
    tl_target_destroy(&gbuffer->target);
}

bool tl_gbuffer_reload(struct tl_gbuffer *gbuffer, tl_error *error)
{
    bool fine = true;
    for (int i = 0; i < TL_GBUFFER_PROGRAMS; i++)
        if (gbuffer->programs[i].program.id)
            fine = fine && tl_program_reload(&gbuffer->programs[i].program, error);
    return fine;
}

/* Programs of other detail are of no use any more. */
static void choose_detail(struct tl_gbuffer *gbuffer, const struct tl_detail_params *detail)
{
    char defines[sizeof gbuffer->detail];
    tl_detail_defines(detail, defines, sizeof defines);
    if (strcmp(defines, gbuffer->detail) == 0)
        return;
    strcpy(gbuffer->detail, defines);
    for (int i = 0; i < TL_GBUFFER_PROGRAMS; i++)
        tl_program_destroy(&gbuffer->programs[i].program);
}

static const tl_program *program_of(struct tl_gbuffer *gbuffer, tl_gpu *gpu,
                                    const struct tl_gbuffer_request *request, tl_error *error)
{
    choose_detail(gbuffer, request->detail);
    int bits = (request->frames ? TL_GBUFFER_FRAMES : 0) | (request->passed ? TL_GBUFFER_BEHIND : 0);
    struct tl_gbuffer_program *made = &gbuffer->programs[bits];
    tl_detail_defines(request->detail, made->defines, sizeof made->defines);
    strcat(made->defines, request->frames ? "#define FRAMES\n" : "");
    strcat(made->defines, request->passed ? "#define BEHIND\n" : "");
    if (!made->program.id && !tl_program_create_variant(gpu, tl_embedded_shaders, "gbuffer.vert",
                                                        "gbuffer.frag", made->defines, &made->program, error))
        return NULL;
    return &made->program;
}

static void allocate(struct tl_gbuffer *gbuffer, tl_gpu *gpu, const struct tl_gbuffer_request *request)
{
    static const unsigned formats[TL_GBUFFER_LAYERS] = {GL_RGBA32F, GL_RGBA16F, GL_RGBA16F,
                                                        GL_RGBA16F, GL_R32UI,   GL_RGBA16F};
    int layers = request->frames ? TL_GBUFFER_LAYERS : TL_GBUFFER_TANGENT;
    const tl_target *target = &gbuffer->target;
    if (target->width == request->width && target->height == request->height &&
        target->colour_count == layers)
        return;
    tl_target_destroy(&gbuffer->target);
    gbuffer->target = tl_target_create(gpu, request->width, request->height, formats, layers, true);
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

static void draw_surfaces(const struct tl_gbuffer_request *request)
{
    const struct tl_ground *ground = request->ground;
    for (size_t i = 0; i < request->surface_count; i++) {
        bool is_ground = ground && i + 1 == request->surface_count;
        if (is_ground)
            glUniform4f(FADING_DISC, ground->centre.x, ground->centre.y, ground->centre.z, ground->radius);
        else
            glUniform4f(FADING_DISC, 0, 0, 0, 0);
        tl_surfaces_draw(request->surfaces, i, TL_PARTS_ALL);
    }
}

bool tl_gbuffer_draw(struct tl_gbuffer *gbuffer, tl_gpu *gpu, const struct tl_gbuffer_request *request,
                     tl_error *error)
{
    const tl_program *program = program_of(gbuffer, gpu, request, error);
    if (!program)
        return false;
    allocate(gbuffer, gpu, request);
    clear(&gbuffer->target);
    glBindFramebuffer(GL_FRAMEBUFFER, gbuffer->target.id);
    glViewport(0, 0, request->width, request->height);
    glEnable(GL_DEPTH_TEST);
    glUseProgram(program->id);
    glUniformMatrix4fv(VIEW_PROJECTION, 1, GL_FALSE, request->view->view_projection.raw[0]);
    glUniform3fv(EYE, 1, request->view->eye.raw);
    if (request->passed)
        glBindTextureUnit(PASSED_UNIT, request->passed->id);
    draw_surfaces(request);
    tl_gpu_reset_state(gpu);
    return true;
}
