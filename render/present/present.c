#include "render/present/present.h"

#include "config/memory.h"
#include "render/gpu/shaders.h"
#include "render/present/resample.h"

#include <epoxy/gl.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Uniform locations of show.frag. */
enum { EXPOSURE, ENVIRONMENT_TURN, VIEW, BLURRED_SCALE = 5 };

bool tl_present_create(struct tl_present *present, tl_gpu *gpu, tl_error *error)
{
    return tl_program_create(gpu, tl_embedded_shaders, "fullscreen.vert", "resolve.frag", &present->resolve,
                             error);
}

void tl_present_release(struct tl_present *present)
{
    tl_program_destroy(&present->resolve);
    for (int shown = 0; shown < TL_SHOWN_COUNT; shown++)
        for (int same_size = 0; same_size < 2; same_size++)
            tl_program_destroy(&present->shows[shown][same_size]);
    tl_linear_image_release(&present->image);
    tl_target_destroy(&present->shown);
    tl_texture_destroy(&present->backdrop);
    tl_texture_destroy(&present->blurred);
}

bool tl_present_reload(struct tl_present *present, tl_error *error)
{
    bool fine = tl_program_reload(&present->resolve, error);
    for (int shown = 0; shown < TL_SHOWN_COUNT; shown++)
        for (int same_size = 0; same_size < 2; same_size++)
            if (present->shows[shown][same_size].id)
                fine = fine && tl_program_reload(&present->shows[shown][same_size], error);
    return fine;
}

float *tl_present_begin_cpu_image(struct tl_present *present, int width, int height)
{
    return tl_linear_image_begin_cpu(&present->image, width, height);
}

void tl_present_set_image(struct tl_present *present, const tl_image *image)
{
    size_t row_floats = 4 * (size_t)image->width;
    float *texels = tl_present_begin_cpu_image(present, image->width, image->height);
    for (size_t y = 0; y < (size_t)image->height; y++) /* the image's rows run downwards */
        memcpy(texels + ((size_t)image->height - 1 - y) * row_floats, tl_image_floats(image) + y * row_floats,
               row_floats * sizeof *texels);
}

static float *read_texture(const tl_texture *texture)
{
    size_t count = 4 * (size_t)texture->width * (size_t)texture->height;
    float *texels = tl_alloc(count, sizeof *texels);
    glGetTextureImage(texture->id, 0, GL_RGBA, GL_FLOAT, (GLsizei)(count * sizeof *texels), texels);
    return texels;
}

static void resolve_by_resampling(struct tl_present *present, const tl_texture *lights,
                                  const tl_texture *points, int width, int height)
{
    float *light = read_texture(lights), *point = read_texture(points);
    size_t count = (size_t)lights->width * (size_t)lights->height;
#pragma omp parallel for
    for (size_t i = 0; i < count; i++) /* as resolve.frag has it */
        light[4 * i + 3] = point[4 * i + 3] - light[4 * i + 3];
    const struct tl_resample resample = {.from = light,
                                         .from_width = lights->width,
                                         .from_height = lights->height,
                                         .to = tl_present_begin_cpu_image(present, width, height),
                                         .to_width = width,
                                         .to_height = height};
    tl_resample(&resample);
    free(point);
    free(light);
}

void tl_present_resolve(struct tl_present *present, tl_gpu *gpu, const tl_texture *lights,
                        const tl_texture *points, int width, int height)
{
    int side = lights->width / width;
    if (side * width != lights->width || side * height != lights->height) {
        resolve_by_resampling(present, lights, points, width, height);
        return;
    }
    tl_linear_image_begin_gpu(&present->image, gpu, width, height);
    glUseProgram(present->resolve.id);
    glUniform1i(0, side);
    glBindTextureUnit(0, lights->id);
    glBindTextureUnit(1, points->id);
    tl_gpu_draw_fullscreen(gpu);
}

bool tl_present_set_backdrop(struct tl_present *present, tl_gpu *gpu, const tl_environment *environment,
                             const tl_cube *cube, int filter, tl_error *error)
{
    const tl_image *image = &environment->image;
    int limit = tl_gpu_texture_side_max(gpu);
    if (image->width > limit || image->height > limit)
        return tl_fail(error, TL_INPUT, "%s: %d x %d texels are more than GL holds: scale it to %d",
                       environment->name, image->width, image->height, limit);
    bool latlong = environment->layout == TL_ENV_LATLONG;
    tl_texture_destroy(&present->backdrop);
    tl_texture_destroy(&present->blurred);
    present->blurred = tl_pem_upload_whole(gpu, cube, filter, &present->blurred_scale);
    GLenum given = image->channels == 4 ? GL_RGBA : GL_RGB;
    if (latlong) {
        present->backdrop =
            tl_texture_create(gpu, GL_TEXTURE_2D, GL_RGBA32F, image->width, image->height, 1, 1);
        glTextureSubImage2D(present->backdrop.id, 0, 0, 0, image->width, image->height, given, GL_FLOAT,
                            image->texels);
        glTextureParameteri(present->backdrop.id, GL_TEXTURE_WRAP_S, GL_REPEAT);
    } else {
        present->backdrop =
            tl_texture_create(gpu, GL_TEXTURE_CUBE_MAP, GL_RGBA32F, image->width, image->width, 6, 1);
        glTextureSubImage3D(present->backdrop.id, 0, 0, 0, 0, image->width, image->width, 6, given, GL_FLOAT,
                            image->texels);
    }
    return true;
}

const tl_target *tl_present_screen(struct tl_present *present, tl_gpu *gpu)
{
    const struct tl_linear_image *image = &present->image;
    const unsigned format = GL_RGBA8;
    if (present->shown.width != image->width || present->shown.height != image->height) {
        tl_target_destroy(&present->shown);
        present->shown = tl_target_create(gpu, image->width, image->height, &format, 1, false);
    }
    return &present->shown;
}

static enum tl_shown shown_of(const struct tl_present *present, const struct tl_image_params *params)
{
    if (params->view != TL_VIEW_LIGHT)
        return TL_SHOWN_AS_IT_IS;
    if (params->background == TL_BACKGROUND_GREY)
        return TL_SHOWN_ON_GREY;
    if (params->background == TL_BACKGROUND_BLURRED)
        return TL_SHOWN_ON_BLURRED;
    return present->backdrop.target == GL_TEXTURE_2D ? TL_SHOWN_ON_LATLONG : TL_SHOWN_ON_CUBE;
}

static const tl_program *program_of(struct tl_present *present, tl_gpu *gpu, enum tl_shown shown,
                                    bool same_size, tl_error *error)
{
    static const char *const defines[TL_SHOWN_COUNT][2] = {
        [TL_SHOWN_ON_GREY] = {"#define ON_GREY\n", "#define ON_GREY\n#define SAME_SIZE\n"},
        [TL_SHOWN_ON_BLURRED] = {"#define ON_BLURRED\n", "#define ON_BLURRED\n#define SAME_SIZE\n"},
        [TL_SHOWN_ON_LATLONG] = {"#define ON_LATLONG\n", "#define ON_LATLONG\n#define SAME_SIZE\n"},
        [TL_SHOWN_ON_CUBE] = {"#define ON_CUBE\n", "#define ON_CUBE\n#define SAME_SIZE\n"},
        [TL_SHOWN_AS_IT_IS] = {"#define AS_IT_IS\n", "#define AS_IT_IS\n#define SAME_SIZE\n"},
    };
    tl_program *program = &present->shows[shown][same_size];
    if (!program->id && !tl_program_create_variant(gpu, tl_embedded_shaders, "fullscreen.vert", "show.frag",
                                                   defines[shown][same_size], program, error))
        return NULL;
    return program;
}

static void set_uniforms(const struct tl_present *present, const struct tl_show_request *request,
                         enum tl_shown shown)
{
    const struct tl_view *view = &request->view;
    const vec3s columns[3] = {view->right, view->up, view->forward};
    if (shown == TL_SHOWN_AS_IT_IS)
        return;
    glUniform1f(EXPOSURE, exp2f(request->params->exposure_ev));
    if (shown == TL_SHOWN_ON_GREY)
        return;
    glUniform2f(ENVIRONMENT_TURN, cosf(request->environment_yaw), sinf(request->environment_yaw));
    glUniformMatrix3fv(VIEW, 1, GL_FALSE, columns[0].raw);
    if (shown == TL_SHOWN_ON_BLURRED)
        glUniform1f(BLURRED_SCALE, present->blurred_scale);
}

bool tl_present_show(struct tl_present *present, tl_gpu *gpu, const struct tl_show_request *request,
                     tl_error *error)
{
    enum tl_shown shown = shown_of(present, request->params);
    bool same_size = request->width == present->image.width && request->height == present->image.height;
    const tl_program *program = program_of(present, gpu, shown, same_size, error);
    if (!program)
        return false;
    const tl_texture *image = tl_linear_image_texture(&present->image, gpu);
    glBindFramebuffer(GL_FRAMEBUFFER, request->framebuffer);
    glViewport(0, 0, request->width, request->height);
    glEnable(GL_SCISSOR_TEST);
    glScissor(request->first_column, 0, request->end_column - request->first_column, request->height);
    glUseProgram(program->id);
    set_uniforms(present, request, shown);
    glBindTextureUnit(0, image->id);
    glBindTextureUnit(1, shown == TL_SHOWN_ON_BLURRED ? present->blurred.id : present->backdrop.id);
    tl_gpu_draw_fullscreen(gpu);
    glDisable(GL_SCISSOR_TEST);
    return true;
}

size_t tl_present_bytes(const struct tl_present *present)
{
    return tl_linear_image_bytes(&present->image) + tl_target_bytes(&present->shown);
}
