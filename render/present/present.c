#include "render/present/present.h"

#include "config/base/memory.h"
#include "render/gpu/shaders.h"
#include "render/present/resolve.h"

#include <epoxy/gl.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Uniform locations of show.frag. */
enum { EXPOSURE, ENVIRONMENT_TURN, VIEW };

bool tl_present_create(struct tl_present *present, tl_gpu *gpu, tl_error *error)
{
    tl_encoding_make(&present->encoding);
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
    free(present->part.texels);
    present->part = (struct tl_image_part){0};
    tl_picture_release(&present->picture);
    tl_backdrop_release(&present->backdrop);
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

float *tl_present_begin_cpu_image(struct tl_present *present, int width, int height, int before)
{
    struct tl_image_part *part = &present->part;
    float *texels = tl_linear_image_begin_cpu(&present->image, width, height);
    size_t bytes = before > 0 ? 4 * sizeof(float) * (size_t)width * (size_t)height : 0;
    part->before = before;
    if (bytes != part->bytes) {
        free(part->texels);
        part->texels = bytes > 0 ? tl_alloc_lines(bytes, 1) : NULL;
        part->bytes = bytes;
    }
    return before > 0 ? part->texels : texels;
}

void tl_present_end_cpu_image(struct tl_present *present)
{
    const struct tl_image_part *part = &present->part;
    float *mean = present->image.texels, share = 1 / (float)(part->before + 1);
    size_t count = part->bytes / sizeof *mean;
#pragma omp parallel for
    for (size_t i = 0; i < count; i++)
        mean[i] += (part->texels[i] - mean[i]) * share;
}

void tl_present_set_image(struct tl_present *present, const tl_image *image)
{
    size_t row_floats = 4 * (size_t)image->width;
    float *texels = tl_present_begin_cpu_image(present, image->width, image->height, 0);
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
                                  const tl_texture *points, int width, int height, int before)
{
    float *light = read_texture(lights), *point = read_texture(points);
    size_t count = (size_t)lights->width * (size_t)lights->height;
#pragma omp parallel for
    for (size_t i = 0; i < count; i++) /* as resolve.frag has it */
        light[4 * i + 3] = point[4 * i + 3] - light[4 * i + 3];
    tl_present_resolve_texels(present, light, lights->width, lights->height, width, height, before);
    free(point);
    free(light);
}

void tl_present_resolve_texels(struct tl_present *present, const float *texels, int columns, int rows,
                               int width, int height, int before)
{
    const struct tl_resample resolve = {.from = texels,
                                        .from_width = columns,
                                        .from_height = rows,
                                        .to = tl_present_begin_cpu_image(present, width, height, before),
                                        .to_width = width,
                                        .to_height = height};
    tl_resolve(&resolve);
    tl_present_end_cpu_image(present);
}

void tl_present_resolve(struct tl_present *present, tl_gpu *gpu, const tl_texture *lights,
                        const tl_texture *points, int width, int height, int before)
{
    int side = lights->width / width;
    if (side * width != lights->width || side * height != lights->height) {
        resolve_by_resampling(present, lights, points, width, height, before);
        return;
    }
    tl_linear_image_begin_gpu(&present->image, gpu, width, height);
    glUseProgram(present->resolve.id);
    glUniform1i(0, side);
    glBindTextureUnit(0, lights->id);
    glBindTextureUnit(1, points->id);
    if (before > 0) { /* the target holds the mean of those before */
        float share = 1 / (float)(before + 1);
        glEnable(GL_BLEND);
        glBlendColor(share, share, share, share);
        glBlendFunc(GL_CONSTANT_COLOR, GL_ONE_MINUS_CONSTANT_COLOR);
    }
    tl_gpu_draw_fullscreen(gpu);
    glDisable(GL_BLEND);
}

static enum tl_shown shown_of(const struct tl_show_request *request)
{
    const struct tl_image_params *params = request->params;
    if (params->view != TL_VIEW_LIGHT)
        return TL_SHOWN_AS_IT_IS;
    if (params->background == TL_BACKGROUND_GREY)
        return TL_SHOWN_ON_GREY;
    if (params->background == TL_BACKGROUND_BLURRED)
        return TL_SHOWN_ON_BLURRED;
    return request->environment->layout == TL_ENV_LATLONG ? TL_SHOWN_ON_LATLONG : TL_SHOWN_ON_CUBE;
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

/* Factors of red, green and blue. */
static vec3s exposure_of(const struct tl_show_request *request)
{
    vec3s adapted = request->environment->shown;
    bool is_adapted = request->params->adapt && !glms_vec3_eqv(adapted, glms_vec3_zero());
    return glms_vec3_scale(is_adapted ? adapted : glms_vec3_one(), exp2f(request->params->exposure_ev));
}

static void set_uniforms(const struct tl_show_request *request, enum tl_shown shown)
{
    const struct tl_view *view = &request->view;
    const vec3s columns[3] = {view->right, view->up, view->forward};
    if (shown == TL_SHOWN_AS_IT_IS)
        return;
    glUniform3fv(EXPOSURE, 1, exposure_of(request).raw);
    if (shown == TL_SHOWN_ON_GREY)
        return;
    glUniform2f(ENVIRONMENT_TURN, cosf(request->environment_yaw), sinf(request->environment_yaw));
    glUniformMatrix3fv(VIEW, 1, GL_FALSE, columns[0].raw);
}

/* Binds the texture of what is behind; true where there is none. */
static bool bind_backdrop(struct tl_present *present, tl_gpu *gpu, const struct tl_show_request *request,
                          enum tl_shown shown, tl_error *error)
{
    const tl_texture *texture = NULL;
    if (shown == TL_SHOWN_AS_IT_IS || shown == TL_SHOWN_ON_GREY)
        return true;
    if (shown == TL_SHOWN_ON_BLURRED)
        texture = tl_backdrop_blurred(&present->backdrop, gpu);
    else
        texture = tl_backdrop_sharp(&present->backdrop, gpu, request->environment, error);
    if (texture)
        glBindTextureUnit(1, texture->id);
    return texture;
}

static bool show_by_shader(struct tl_present *present, tl_gpu *gpu, const struct tl_show_request *request,
                           tl_error *error)
{
    const struct tl_picture_part *part = &request->part;
    enum tl_shown shown = shown_of(request);
    bool same_size = part->width == present->image.width && part->height == present->image.height;
    const tl_program *program = program_of(present, gpu, shown, same_size, error);
    if (!program || !bind_backdrop(present, gpu, request, shown, error))
        return false;
    glBindTextureUnit(0, tl_linear_image_texture(&present->image, gpu)->id);
    tl_picture_begin_gpu(&present->picture, gpu, part);
    glEnable(GL_SCISSOR_TEST);
    glScissor(part->first_column, 0, part->end_column - part->first_column, part->height);
    glUseProgram(program->id);
    set_uniforms(request, shown);
    tl_gpu_draw_fullscreen(gpu);
    glDisable(GL_SCISSOR_TEST);
    return true;
}

static void show_on_cpu(struct tl_present *present, const struct tl_show_request *request)
{
    const struct tl_picture_part *part = &request->part;
    struct tl_backdrop *backdrop = &present->backdrop;
    enum tl_shown shown = shown_of(request);
    struct tl_tone_map_request tone_map = {.encoding = &present->encoding,
                                           .texels = present->image.texels,
                                           .width = part->width,
                                           .height = part->height,
                                           .first_column = part->first_column,
                                           .end_column = part->end_column,
                                           .is_light = shown != TL_SHOWN_AS_IT_IS,
                                           .exposure = exposure_of(request)};
    if (shown != TL_SHOWN_AS_IT_IS && shown != TL_SHOWN_ON_GREY) {
        const struct tl_behind_request behind = {.forward = request->view.forward,
                                                 .right = request->view.right,
                                                 .up = request->view.up,
                                                 .environment_yaw = request->environment_yaw,
                                                 .environment = request->environment,
                                                 .blurred =
                                                     shown == TL_SHOWN_ON_BLURRED ? &backdrop->blurred : NULL,
                                                 .width = part->width,
                                                 .height = part->height,
                                                 .revision = backdrop->revision};
        tl_behind_begin(&backdrop->behind, &behind);
        tone_map.behind = &backdrop->behind;
    }
    tl_tone_map(&tone_map, tl_picture_begin_cpu(&present->picture, part));
}

bool tl_present_show(struct tl_present *present, tl_gpu *gpu, const struct tl_show_request *request,
                     tl_error *error)
{
    const struct tl_linear_image *image = &present->image;
    if (!image->texels || image->width != request->part.width || image->height != request->part.height)
        return show_by_shader(present, gpu, request, error);
    show_on_cpu(present, request);
    return true;
}

size_t tl_present_bytes(const struct tl_present *present)
{
    return tl_linear_image_bytes(&present->image) + present->part.bytes + tl_picture_bytes(&present->picture);
}
