/* The draws that light all samples: one, or several that are blended as on hardware that reads one texture at
 * a time [Heidrich and Seidel 1999, 4.2, 4.4]. Of several, the first writes the share of the mirror,
 * Fresnel's term or that of a coat, into the alpha of a target of its own. The others add a term each,
 * multiplied by that share or by what it leaves. The alpha of a pixel holds one number: a term that differs
 * between colours takes all passes for each of them, under a colour mask. Where paraboloids are looked up by
 * matrices, a term takes two passes, one for each of the two maps. The sum is then added to the light. */
#include "config/base/memory.h"
#include "render/envmap/envmap.h"
#include "render/gpu/shaders.h"
#include "render/local/shading.h"

#include <epoxy/gl.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Uniform locations of envmap.frag and what it includes; sample.glsl has 1 and 2. */
enum {
    EYE = 1,
    TEXEL_REACH = 3,
    PART_COUNT,
    TURN,
    SLOTS,
    FRONT_MATRIX = 40,
    BACK_MATRIX,
    CHANNEL,
    PASS_SCALE
};
/* Texture units; the layers of the G-buffer come first. */
enum {
    LEVELS_UNIT = 5,
    MAPS_UNIT,
    FRESNEL_UNIT,
    PASSED_UNIT,
    OVER_VECTORS_UNIT,
    UNDER_VECTORS_UNIT,
    BAKED_UNIT
};
#define PARTS_BINDING 1

/* PASS in envmap.frag. */
enum { WHOLE, SHARE, OVER, UNDER, COATING, THROUGH, SUM };
/* A pass, and the factor on what it adds. */
struct term {
    int pass;
    GLenum factor;
};
#define PASSES_MAX 5
struct term_list {
    int count;
    struct term items[PASSES_MAX];
};

/* The work of one draw over all samples. */
struct draw {
    const struct tl_envmap_request *request;
    int pass;
    int half;    /* of a pair of paraboloids: 0, 1; -1: both */
    int channel; /* of the share */
};

static bool by_matrix(const struct tl_envmap *envmap, const struct tl_maps_params *params)
{
    return envmap->layout == TL_LAYOUT_PARABOLOID && params->look_up == TL_LOOK_UP_MATRIX;
}

static bool is_layered(const struct tl_envmap *envmap, const struct tl_maps_params *params)
{
    return envmap->has_layers && params->mode == TL_MAPS_SURFACE && params->fresnel == TL_MAPS_FRESNEL_OFF;
}

static char *defines_of(const struct tl_envmap *envmap, const struct draw *draw)
{
    static const char *const layouts[TL_LAYOUT_COUNT] = {"CUBE", "SPHERE", "PARABOLOID", "LATLONG",
                                                         "OCTAHEDRAL"};
    static const char *const halves[3] = {"", "#define HALF 0\n", "#define HALF 1\n"};
    const struct tl_maps_params *params = draw->request->params;
    char pass[32] = "";
    if (draw->pass != WHOLE)
        snprintf(pass, sizeof pass, "#define PASS %d\n", draw->pass);
    return tl_format("#define %s\n#define MODE %d\n#define COMPOSITION %d\n%s%s%s%s%s%s%s%s",
                     layouts[envmap->layout], params->mode, params->fresnel,
                     by_matrix(envmap, params) ? "#define MATRIX\n" : "",
                     envmap->has_ground ? "#define GROUND\n" : "", params->minify ? "#define MINIFY\n" : "",
                     is_layered(envmap, params) ? "#define LAYERED\n" : "",
                     params->vectors == TL_MAPS_VECTORS_VERTEX ? "#define VERTEX_VECTORS\n" : "",
                     draw->request->baked ? "#define BAKED\n" : "", pass, halves[draw->half + 1]);
}

static const tl_program *program_of(struct tl_envmap *envmap, tl_gpu *gpu, const struct draw *draw,
                                    tl_error *error)
{
    char *defines = defines_of(envmap, draw);
    for (size_t i = 0; i < envmap->variant_count; i++)
        if (strcmp(envmap->variants[i].defines, defines) == 0) {
            free(defines);
            return &envmap->variants[i].program;
        }
    struct tl_envmap_variant variant = {.defines = defines};
    if (!tl_program_create_variant(gpu, tl_embedded_shaders, "fullscreen.vert", "envmap.frag", defines,
                                   &variant.program, error)) {
        free(defines);
        return NULL;
    }
    envmap->variants = tl_resize(envmap->variants, envmap->variant_count + 1, sizeof variant);
    envmap->variants[envmap->variant_count] = variant;
    return &envmap->variants[envmap->variant_count++].program;
}

/* P S M^-1 of equation 7, with the transformation to texture coordinates: (x, y, z, 1) -> (x, y) / (1 + z)
 * from [-1, 1] to [0, 1], rows downwards. M^-1 transforms from world to picture. */
static void set_matrices(const mat3s *turn)
{
    mat3s axes = *turn;
    mat4s into_picture = glms_mat4_identity();
    glm_mat4_ins3(axes.raw, into_picture.raw);
    for (int back = 0; back < 2; back++) {
        float side = back ? -1 : 1;
        const mat4s add_axis = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, side, 0}, {0, 0, 1, 1}}};
        const mat4s project = {{{0.5f * side, 0, 0, 0}, {0, -0.5f, 0, 0}, {0.5f, 0.5f, 1, 1}, {0, 0, 0, 0}}};
        mat4s matrix = glms_mat4_mul(glms_mat4_mul(project, add_axis), into_picture);
        glUniformMatrix4fv(back ? BACK_MATRIX : FRONT_MATRIX, 1, GL_FALSE, matrix.raw[0]);
    }
}

/* Square root of the mean solid angle of a texel, rad. */
static float texel_reach(const struct tl_mip_levels *levels)
{
    const struct tl_sphere_map *map = &levels->maps[0];
    float discs = map->layout == TL_LAYOUT_SPHERE || map->layout == TL_LAYOUT_PARABOLOID ? GLM_PI_4f : 1;
    return sqrtf(4 * GLM_PIf / (discs * (float)map->width * (float)map->height));
}

/* The factor from radiance to the values of the passes' target. */
static float scale_of(const struct tl_maps_params *params)
{
    return params->pass_target == TL_PASS_TARGET_FIXED8 ? 1 / params->pass_white : 1;
}

static bool draw_term(struct tl_envmap *envmap, tl_gpu *gpu, const struct draw *draw, tl_error *error)
{
    const struct tl_maps_params *params = draw->request->params;
    const tl_program *program = program_of(envmap, gpu, draw, error);
    if (!program)
        return false;
    glUseProgram(program->id);
    glUniform3fv(EYE, 1, draw->request->view->eye.raw);
    glUniform1f(TEXEL_REACH, texel_reach(&envmap->levels));
    glUniform1i(PART_COUNT, envmap->part_count);
    glUniform1iv(SLOTS, TL_EXPONENT_COUNT + 1, envmap->slots);
    if (draw->pass != WHOLE) {
        glUniform1i(CHANNEL, draw->channel);
        glUniform1f(PASS_SCALE, draw->pass == SUM ? 1 / scale_of(params) : scale_of(params));
    }
    if (by_matrix(envmap, params))
        set_matrices(&envmap->turn);
    else
        glUniformMatrix3fv(TURN, 1, GL_FALSE, envmap->turn.raw[0]);
    tl_gpu_draw_fullscreen(gpu);
    return true;
}

static void bind_textures(const struct tl_envmap *envmap, const struct tl_envmap_request *request)
{
    const tl_texture *triangles = &request->gbuffer->colours[TL_GBUFFER_TRIANGLE];
    glTextureParameteri(triangles->id, GL_TEXTURE_MIN_FILTER,
                        GL_NEAREST); /* integers cannot be interpolated */
    glTextureParameteri(triangles->id, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glBindTextureUnit(TL_GBUFFER_TRIANGLE, triangles->id);
    glBindTextureUnit(LEVELS_UNIT, request->exponent_levels->id);
    glBindTextureUnit(MAPS_UNIT, envmap->maps.id);
    glBindTextureUnit(FRESNEL_UNIT, envmap->fresnel.id);
    glBindTextureUnit(OVER_VECTORS_UNIT, envmap->vectors.target.colours[0].id);
    glBindTextureUnit(UNDER_VECTORS_UNIT, envmap->vectors.target.colours[1].id);
    if (request->baked)
        glBindTextureUnit(BAKED_UNIT, request->baked->id);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PARTS_BINDING, envmap->parts_buffer);
}

static void add_pass(struct term_list *list, int pass, GLenum factor)
{
    list->items[list->count++] = (struct term){pass, factor};
}

/* The terms of envmap.h. All light of the ground is that of UNDER, because it has no share. */
static struct term_list list_passes(const struct tl_envmap *envmap, const struct tl_maps_params *params)
{
    struct term_list list = {0};
    bool layered = is_layered(envmap, params), shared = params->fresnel != TL_MAPS_FRESNEL_OFF;
    bool only_under =
        params->mode == TL_MAPS_DIFFUSE ||
        (!shared && (params->mode == TL_MAPS_REFRACTION || params->mode == TL_MAPS_TRANSMISSION));
    bool only_over = params->mode == TL_MAPS_GLOSSY || (!shared && params->mode == TL_MAPS_MIRROR);
    GLenum rest = layered || params->fresnel == TL_MAPS_FRESNEL_COAT ? GL_ONE_MINUS_DST_ALPHA : GL_ONE;
    if (layered || shared)
        add_pass(&list, SHARE, GL_ONE);
    if (layered)
        add_pass(&list, COATING, GL_DST_ALPHA);
    if (!only_under)
        add_pass(&list, OVER, shared ? GL_DST_ALPHA : rest);
    if (!only_over || (shared && envmap->has_ground))
        add_pass(&list, UNDER, rest);
    if (layered)
        add_pass(&list, THROUGH, rest);
    return list;
}

/* Adds up the passes of one colour, or of all colours when `mask` is -1. */
static bool draw_passes(struct tl_envmap *envmap, tl_gpu *gpu, const struct tl_envmap_request *request,
                        const struct term_list *list, int mask, tl_error *error)
{
    bool fine = true;
    int halves = by_matrix(envmap, request->params) ? 2 : 1;
    for (int i = 0; fine && i < list->count; i++) {
        const struct term *term = &list->items[i];
        bool is_share = term->pass == SHARE;
        glColorMask(!is_share && mask != 1 && mask != 2, !is_share && mask != 0 && mask != 2,
                    !is_share && mask != 0 && mask != 1, is_share);
        glBlendFunc(term->factor, is_share ? GL_ZERO : GL_ONE);
        for (int half = 0; fine && half < (is_share ? 1 : halves); half++) {
            const struct draw draw = {request, term->pass, halves == 1 || is_share ? -1 : half,
                                      mask < 0 ? 0 : mask};
            fine = draw_term(envmap, gpu, &draw, error);
        }
    }
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    return fine;
}

static bool draw_several(struct tl_envmap *envmap, tl_gpu *gpu, const struct tl_envmap_request *request,
                         unsigned light, tl_error *error)
{
    const unsigned format = request->params->pass_target == TL_PASS_TARGET_FIXED8 ? GL_RGBA8 : GL_RGBA32F;
    const float black[] = {0, 0, 0, 0};
    const struct term_list list = list_passes(envmap, request->params);
    bool by_colour = request->params->fresnel != TL_MAPS_FRESNEL_OFF && envmap->has_colours, fine = true;
    tl_target_fit(&envmap->passed, gpu, request->gbuffer, &format, 1);
    glClearNamedFramebufferfv(envmap->passed.id, GL_COLOR, 0, black);
    glBindFramebuffer(GL_FRAMEBUFFER, envmap->passed.id);
    glEnable(GL_BLEND);
    for (int channel = by_colour ? 0 : -1; fine && channel < (by_colour ? 3 : 0); channel++)
        fine = draw_passes(envmap, gpu, request, &list, channel, error);
    glDisable(GL_BLEND);
    glBindFramebuffer(GL_FRAMEBUFFER, light);
    glBindTextureUnit(PASSED_UNIT, envmap->passed.colours[0].id);
    const struct draw sum = {request, SUM, -1, 0};
    return fine && draw_term(envmap, gpu, &sum, error);
}

bool tl_envmap_draw(struct tl_envmap *envmap, tl_gpu *gpu, const struct tl_envmap_request *request,
                    struct tl_light_buffer *light, tl_error *error)
{
    const struct tl_maps_params *params = request->params;
    if (params->vectors == TL_MAPS_VECTORS_PIXEL)
        tl_target_destroy(&envmap->vectors.target);
    else if (!tl_vertex_vectors_draw(&envmap->vectors, gpu, request->gbuffer, request->view,
                                     request->surfaces, request->surface_count, envmap->has_ground, params,
                                     error))
        return false;
    tl_light_buffer_begin(light, gpu, request->gbuffer, true);
    bind_textures(envmap, request);
    if (params->passes == TL_MAPS_PASSES_SEVERAL)
        return draw_several(envmap, gpu, request, light->target.id, error);
    tl_target_destroy(&envmap->passed);
    const struct draw whole = {request, WHOLE, -1, 0};
    return draw_term(envmap, gpu, &whole, error);
}
