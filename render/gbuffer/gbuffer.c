#include "render/gbuffer/gbuffer.h"

#include "render/gpu/shaders.h"

#include <epoxy/gl.h>

#include <string.h>

/* Uniform locations of gbuffer.vert and gbuffer.frag that surface.glsl does not have. */
enum { VIEW_PROJECTION = 16, EYE = 17, FADING_DISC = 18, BLENDS_LOBES = 19 };

/* Texture units of gbuffer.frag's own: the last ones, out of the surfaces' way. */
#define NUMBERS_UNIT 14
#define PASSED_UNIT  15

enum { KEPT_INDICES, KEPT_NUMBERS, KEPT_BUFFERS };

void tl_gbuffer_release(struct tl_gbuffer *gbuffer)
{
    for (int i = 0; i < TL_GBUFFER_PROGRAMS; i++)
        tl_program_destroy(&gbuffer->programs[i].program);
    tl_target_destroy(&gbuffer->target);
    tl_cull_release(&gbuffer->cull);
    if (gbuffer->numbers) {
        glDeleteTextures(1, &gbuffer->numbers);
        glDeleteBuffers(KEPT_BUFFERS, gbuffer->kept);
    }
    gbuffer->numbers = 0;
}

size_t tl_gbuffer_bytes(const struct tl_gbuffer *gbuffer)
{
    return tl_target_bytes(&gbuffer->target) + tl_cull_bytes(&gbuffer->cull) +
           gbuffer->cull.triangle_count * 4 * sizeof(uint32_t);
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
                                    const struct tl_gbuffer_request *request, bool masked, tl_error *error)
{
    int bits = (request->frames ? TL_GBUFFER_FRAMES : 0) | (request->passed ? TL_GBUFFER_BEHIND : 0) |
               (request->only_triangle ? TL_GBUFFER_ONLY_TRIANGLE : 0) | (masked ? TL_GBUFFER_MASKED : 0);
    struct tl_gbuffer_program *made = &gbuffer->programs[bits];
    tl_detail_defines(request->detail, made->defines, sizeof made->defines);
    strcat(made->defines, request->frames ? "#define FRAMES\n" : "");
    strcat(made->defines, request->passed ? "#define BEHIND\n" : "");
    strcat(made->defines, request->only_triangle ? "#define ONLY_TRIANGLE\n" : "");
    strcat(made->defines, masked ? "#define MASKED\n" : "");
    if (!made->program.id && !tl_program_create_variant(gpu, tl_embedded_shaders, "gbuffer.vert",
                                                        "gbuffer.frag", made->defines, &made->program, error))
        return NULL;
    return &made->program;
}

static void allocate(struct tl_gbuffer *gbuffer, tl_gpu *gpu, const struct tl_gbuffer_request *request)
{
    static const unsigned formats[TL_GBUFFER_LAYERS] = {GL_RGBA32F, GL_RGBA16F, GL_RGBA16F,
                                                        GL_RGBA16F, GL_R32UI,   GL_RGBA16F};
    int layers = request->only_triangle ? 1 : request->frames ? TL_GBUFFER_LAYERS : TL_GBUFFER_WIDENING;
    const tl_target *target = &gbuffer->target;
    if (target->width == request->width && target->height == request->height &&
        target->colour_count == layers)
        return;
    tl_target_destroy(&gbuffer->target);
    gbuffer->target =
        tl_target_create(gpu, request->width, request->height,
                         formats + (request->only_triangle ? TL_GBUFFER_TRIANGLE : 0), layers, true);
}

static void clear(const tl_target *target)
{
    const float nothing[] = {0, 0, 0, 0}, farthest = 1;
    const GLuint no_triangle[] = {0, 0, 0, 0};
    for (int i = 0; i < target->colour_count; i++)
        if (target->colours[i].format == GL_R32UI)
            glClearNamedFramebufferuiv(target->id, GL_COLOR, i, no_triangle);
        else
            glClearNamedFramebufferfv(target->id, GL_COLOR, i, nothing);
    glClearNamedFramebufferfv(target->id, GL_DEPTH, 0, &farthest);
}

/* Many samples to a triangle leave little to save. */
#define SAMPLES_PER_TRIANGLE 4

/* No triangle may be culled where layers behind are drawn, where a surface is not drawn and hides nothing,
 * and where relief has holes at its rim. */
static bool counts_nearest_only(const struct tl_gbuffer_request *request)
{
    size_t triangles = 0;
    for (size_t i = 0; i < request->surface_count; i++) {
        if (tl_surfaces_is_hidden(request->surfaces, i))
            return false;
        triangles += request->drawn[i]->index_count / 3;
    }
    bool moves_rims = request->detail && request->detail->mode == TL_DETAIL_RELIEF;
    return !request->passed && !moves_rims &&
           (size_t)request->width * (size_t)request->height <= SAMPLES_PER_TRIANGLE * triangles;
}

static void keep_triangles(struct tl_gbuffer *gbuffer, const tl_gpu *gpu,
                           const struct tl_gbuffer_request *request)
{
    struct tl_cull *cull = &gbuffer->cull;
    const struct tl_cull_request what = {.surfaces = request->drawn,
                                         .surface_count = request->surface_count,
                                         .view_projection = request->view->view_projection,
                                         .width = request->width,
                                         .height = request->height,
                                         .subpixel_bits = tl_gpu_subpixel_bits(gpu),
                                         .nearest_only = counts_nearest_only(request),
                                         .first_fading = request->surface_count - (request->ground ? 1 : 0)};
    tl_cull_make(&what, cull);
    if (!gbuffer->numbers) {
        glCreateBuffers(KEPT_BUFFERS, gbuffer->kept);
        glCreateTextures(GL_TEXTURE_BUFFER, 1, &gbuffer->numbers);
    }
    const GLsizeiptr number_bytes = (GLsizeiptr)(cull->triangle_count * sizeof *cull->numbers);
    glNamedBufferData(gbuffer->kept[KEPT_INDICES], 3 * number_bytes, cull->indices, GL_STREAM_DRAW);
    glNamedBufferData(gbuffer->kept[KEPT_NUMBERS], number_bytes, cull->numbers, GL_STREAM_DRAW);
    glTextureBuffer(gbuffer->numbers, GL_R32UI, gbuffer->kept[KEPT_NUMBERS]);
    glBindTextureUnit(NUMBERS_UNIT, gbuffer->numbers);
}

static void use_program(const struct tl_gbuffer_request *request, const tl_program *program)
{
    glUseProgram(program->id);
    glUniformMatrix4fv(VIEW_PROJECTION, 1, GL_FALSE, request->view->view_projection.raw[0]);
    glUniform3fv(EYE, 1, request->view->eye.raw);
    glUniformMatrix3fv(TL_UNIFORM_INTO_EYE_SPACE, 1, GL_FALSE, tl_view_turn(request->view).raw[0]);
    glUniform1i(BLENDS_LOBES, request->blends_lobes);
}

static void set_fading_disc(const struct tl_gbuffer_request *request, size_t surface)
{
    const struct tl_ground *ground = request->ground;
    if (ground && surface + 1 == request->surface_count)
        glUniform4f(FADING_DISC, ground->centre.x, ground->centre.y, ground->centre.z, ground->radius);
    else
        glUniform4f(FADING_DISC, 0, 0, 0, 0);
}

static void draw_part(const struct tl_gbuffer *gbuffer, const struct tl_gbuffer_request *request,
                      size_t surface, size_t part, const struct tl_cull_part *kept)
{
    tl_surfaces_draw_some(request->surfaces, surface, part, gbuffer->kept[KEPT_INDICES], kept->first,
                          kept->count);
}

static void draw_surfaces(const struct tl_gbuffer *gbuffer, const struct tl_gbuffer_request *request)
{
    const struct tl_cull_part *kept = gbuffer->cull.parts;
    for (size_t i = 0; i < request->surface_count; i++) {
        set_fading_disc(request, i);
        for (size_t p = 0; p < request->drawn[i]->part_count; p++, kept++)
            draw_part(gbuffer, request, i, p, kept);
    }
}

/* Parts without holes are drawn by a program that reads no texture: the early depth test then works. */
static bool draw_triangles(struct tl_gbuffer *gbuffer, tl_gpu *gpu, const struct tl_gbuffer_request *request,
                           tl_error *error)
{
    int programs = tl_surfaces_have(request->surfaces, TL_PARTS_MASKED) ? 2 : 1;
    for (int masked = 0; masked < programs; masked++) {
        const tl_program *program = program_of(gbuffer, gpu, request, masked, error);
        if (!program)
            return false;
        use_program(request, program);
        const struct tl_cull_part *kept = gbuffer->cull.parts;
        for (size_t i = 0; i < request->surface_count; i++)
            for (size_t p = 0; p < request->drawn[i]->part_count; p++, kept++)
                if ((tl_surfaces_part_material(request->surfaces, i, p)->alpha_cutoff > 0) == masked)
                    draw_part(gbuffer, request, i, p, kept);
    }
    return true;
}

void tl_gbuffer_keep_depth(const struct tl_gbuffer *gbuffer, tl_gpu *gpu, tl_texture *kept)
{
    const tl_texture *depth = &gbuffer->target.depth;
    if (kept->width != depth->width || kept->height != depth->height) {
        tl_texture_destroy(kept);
        *kept = tl_texture_create(gpu, GL_TEXTURE_2D, depth->format, depth->width, depth->height, 1, 1);
    }
    glCopyImageSubData(depth->id, GL_TEXTURE_2D, 0, 0, 0, 0, kept->id, GL_TEXTURE_2D, 0, 0, 0, 0,
                       depth->width, depth->height, 1);
}

bool tl_gbuffer_draw(struct tl_gbuffer *gbuffer, tl_gpu *gpu, const struct tl_gbuffer_request *request,
                     tl_error *error)
{
    choose_detail(gbuffer, request->detail);
    const tl_program *program = program_of(gbuffer, gpu, request, false, error);
    if (!program)
        return false;
    allocate(gbuffer, gpu, request);
    clear(&gbuffer->target);
    glBindFramebuffer(GL_FRAMEBUFFER, gbuffer->target.id);
    glViewport(0, 0, request->width, request->height);
    glEnable(GL_DEPTH_TEST);
    use_program(request, program);
    if (request->passed)
        glBindTextureUnit(PASSED_UNIT, request->passed->id);
    keep_triangles(gbuffer, gpu, request);
    bool fine = true;
    if (request->only_triangle)
        fine = draw_triangles(gbuffer, gpu, request, error);
    else
        draw_surfaces(gbuffer, request);
    tl_gpu_reset_state(gpu);
    return fine;
}
