#include "render/local/local.h"

#include "config/memory.h"
#include "render/shaders.h"

#include <epoxy/gl.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Uniform locations of lamp.glsl, gloss.glsl and local.frag beside those of surface.glsl. */
enum {
    VIEW_PROJECTION = 64,
    EYE,
    LAMP,
    LAMP_IRRADIANCE,
    CONSTANT_LAMP,
    CONSTANT_EYE,
    GLOSS_WIDTHS,
    GLOSS_OPTICS,
    LAMP_VIEW = 73,
    LAMP_BIAS,
    LAMP_LAYER,
    LAMP_GROUND
};
enum { TRIANGLE_UNIT = 16, POINT_UNIT, SHADOW_UNIT };

void tl_local_reload(struct tl_local *local)
{
    for (size_t i = 0; i < local->program_count; i++) {
        tl_program_destroy(&local->programs[i]->program);
        free(local->programs[i]);
    }
    free(local->programs);
    local->programs = NULL;
    local->program_count = 0;
}

void tl_local_release(struct tl_local *local)
{
    tl_local_reload(local);
    tl_lamp_shadows_release(&local->shadows);
    *local = (struct tl_local){0};
}

size_t tl_local_bytes(const struct tl_local *local)
{
    return tl_lamp_shadows_bytes(&local->shadows);
}

static void define(char defines[TL_LOCAL_DEFINES_SIZE], const char *name)
{
    size_t length = strlen(defines);
    snprintf(defines + length, TL_LOCAL_DEFINES_SIZE - length, "#define %s\n", name);
}

/* Where vectors come from, and how they become unit. */
static void define_vectors(const struct tl_shading_params *params, char defines[TL_LOCAL_DEFINES_SIZE])
{
    static const char *const ways[] = {[TL_NORMALISE_NONE] = "NORMALISE_NONE",
                                       [TL_NORMALISE_CUBE8] = "NORMALISE_CUBE",
                                       [TL_NORMALISE_CUBE16] = "NORMALISE_CUBE",
                                       [TL_NORMALISE_NEWTON] = "NORMALISE_NEWTON",
                                       [TL_NORMALISE_EXACT] = "NORMALISE_EXACT"};
    bool is_fast = params->frequency == TL_FREQUENCY_FAST_PHONG;
    int way = is_fast ? TL_NORMALISE_NONE : params->normalisation;
    bool is_tangent = params->space == TL_SPACE_TANGENT;
    define(defines, ways[way]);
    if (params->coordinates == TL_COORDINATES_MATRIX)
        define(defines, "MATRIX");
    else if (is_tangent || way != TL_NORMALISE_EXACT)
        define(defines, is_tangent ? "VECTORS\n#define TANGENT_SPACE" : "VECTORS");
}

static void define_all(const struct tl_local_request *request, const tl_material *material,
                       enum tl_lamp_shadow shadow, char defines[TL_LOCAL_DEFINES_SIZE])
{
    const struct tl_shading_params *params = request->params;
    const struct tl_gloss *gloss = &material->gloss;
    snprintf(defines, TL_LOCAL_DEFINES_SIZE,
             "#define MODEL %d\n#define FACETS %d\n#define MASKING %d\n#define FRESNEL %d\n", gloss->model,
             gloss->facets, gloss->masking, gloss->fresnel);
    if (params->frequency == TL_FREQUENCY_GOURAUD)
        define(defines, params->coordinates == TL_COORDINATES_MATRIX ? "GOURAUD\n#define MATRIX" : "GOURAUD");
    else if (params->coordinates == TL_COORDINATES_VERTEX)
        define(defines, "COSINES");
    else
        define_vectors(params, defines);
    if (params->self_shadow == TL_SELF_SHADOW_STEP)
        define(defines, "STEP");
    if (shadow == TL_LAMP_SHADOW_RAYS)
        define(defines, "SHADOW_RAYS");
    else if (shadow == TL_LAMP_SHADOW_MAP)
        define(defines, "SHADOW_MAP");
}

/* The program of these defines, made when it is first asked for. */
static const tl_program *find_program(struct tl_local *local, tl_gpu *gpu, const char *defines,
                                      tl_error *error)
{
    for (size_t i = 0; i < local->program_count; i++)
        if (strcmp(local->programs[i]->defines, defines) == 0)
            return &local->programs[i]->program;
    struct tl_local_program *made = TL_NEW(struct tl_local_program);
    snprintf(made->defines, sizeof made->defines, "%s", defines);
    if (!tl_program_create_variant(gpu, tl_embedded_shaders, "local.vert", "local.frag", made->defines,
                                   &made->program, error)) {
        free(made);
        return NULL;
    }
    local->programs = tl_resize(local->programs, local->program_count + 1, sizeof(struct tl_local_program *));
    local->programs[local->program_count++] = made;
    return &made->program;
}

static void set_lamp(const struct tl_local *local, const struct tl_local_request *request, size_t index)
{
    const struct tl_lamp *lamp = &request->lamps[index];
    const struct tl_view *view = request->view;
    const struct tl_ground *ground = request->ground;
    bool is_point = lamp->kind == TL_LAMP_POINT;
    vec3s place = is_point ? lamp->position : glms_vec3_normalize(lamp->direction);
    vec3s constant_eye = glms_vec3_negate(glms_vec3_normalize(view->forward));
    vec3s constant_lamp = tl_lamp_at(lamp, request->casters.centre, constant_eye).direction;
    bool stops = ground && !(is_point && lamp->position.y >= ground->centre.y);
    glUniformMatrix4fv(VIEW_PROJECTION, 1, GL_FALSE, view->view_projection.raw[0]);
    glUniform3fv(EYE, 1, view->eye.raw);
    glUniform4f(LAMP, place.x, place.y, place.z, is_point ? 1 : 0);
    glUniform3fv(LAMP_IRRADIANCE, 1, lamp->irradiance.raw);
    glUniform3fv(CONSTANT_LAMP, 1, constant_lamp.raw);
    glUniform3fv(CONSTANT_EYE, 1, constant_eye.raw);
    glUniformMatrix4fv(LAMP_VIEW, 1, GL_FALSE, local->shadows.views[index].raw[0]);
    glUniform1f(LAMP_BIAS, request->depth_bias_m);
    glUniform1i(LAMP_LAYER, (GLint)index);
    glUniform4f(LAMP_GROUND, stops ? ground->centre.x : 0, stops ? ground->centre.y : 0,
                stops ? ground->centre.z : 0, stops ? ground->radius : 0);
}

static void set_gloss(const tl_material *material)
{
    const struct tl_gloss *gloss = &material->gloss;
    glUniform4f(GLOSS_WIDTHS, gloss->width_weft, gloss->width_warp, cosf(gloss->rotation),
                sinf(gloss->rotation));
    glUniform2f(GLOSS_OPTICS, gloss->index > 0 ? gloss->index : 1, fmaxf(gloss->extinction, 0));
}

static void bind_shadow(const struct tl_lamp_shadows *shadows, enum tl_lamp_shadow kind)
{
    if (kind == TL_LAMP_SHADOW_RAYS)
        glBindTextureUnit(SHADOW_UNIT, shadows->visibility.id);
    else if (kind == TL_LAMP_SHADOW_MAP)
        glBindTextureUnit(SHADOW_UNIT, shadows->depths.id);
}

static bool draw_lamp(struct tl_local *local, tl_gpu *gpu, const struct tl_local_request *request,
                      size_t index, tl_error *error)
{
    enum tl_lamp_shadow shadow = local->shadows.kinds[index];
    bind_shadow(&local->shadows, shadow);
    for (size_t s = 0; s < request->surface_count; s++)
        for (size_t p = 0; p < tl_surfaces_part_count(request->surfaces, s); p++) {
            const tl_material *material = tl_surfaces_part_material(request->surfaces, s, p);
            char defines[TL_LOCAL_DEFINES_SIZE];
            define_all(request, material, shadow, defines);
            const tl_program *program = find_program(local, gpu, defines, error);
            if (!program)
                return false;
            glUseProgram(program->id);
            set_lamp(local, request, index);
            set_gloss(material);
            tl_surfaces_draw_part(request->surfaces, s, p);
        }
    return true;
}

bool tl_local_draw(struct tl_local *local, tl_gpu *gpu, const struct tl_local_request *request,
                   tl_error *error)
{
    const tl_target *target = request->light;
    glBindFramebuffer(GL_FRAMEBUFFER, target->id);
    glViewport(0, 0, target->width, target->height);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendColor(0, 0, 0, request->weight);
    glBlendFunc(GL_CONSTANT_ALPHA, GL_ONE); /* coverage stays: no light has any of its own */
    glBindTextureUnit(TRIANGLE_UNIT, request->gbuffer->target.colours[TL_GBUFFER_TRIANGLE].id);
    glBindTextureUnit(POINT_UNIT, request->gbuffer->target.colours[TL_GBUFFER_POINT].id);
    bool fine = true;
    for (size_t i = 0; fine && i < request->lamp_count; i++)
        fine = draw_lamp(local, gpu, request, i, error);
    tl_gpu_reset_state(gpu);
    return fine;
}
