#include "render/light/light.h"

#include "render/shaders.h"

#include <epoxy/gl.h>

#include <math.h>

/* Uniform locations and texture units of light.frag. */
enum { REGION_COUNT, EYE, ENVIRONMENT_TURN, PEM_SCALE, LOBE, SHADOWED, MAP_LIMITS, GROUND_DISC };
enum { LOBE_LEVELS_UNIT = TL_GBUFFER_LAYERS, PEMS_UNIT, MAPS_UNIT };

bool tl_lighting_create(struct tl_lighting *lighting, tl_gpu *gpu, tl_error *error)
{
    glCreateBuffers(1, &lighting->regions_buffer);
    glNamedBufferStorage(lighting->regions_buffer, TL_PASS_REGIONS_MAX * sizeof(struct tl_region_view), NULL,
                         GL_DYNAMIC_STORAGE_BIT);
    return tl_program_create(gpu, tl_embedded_shaders, "fullscreen.vert", "light.frag", &lighting->program,
                             error);
}

void tl_lighting_release(struct tl_lighting *lighting)
{
    tl_program_destroy(&lighting->program);
    tl_texture_destroy(&lighting->lobe_levels);
    tl_target_destroy(&lighting->target);
    if (lighting->regions_buffer)
        glDeleteBuffers(1, &lighting->regions_buffer);
    lighting->regions_buffer = 0;
}

void tl_lighting_set_lobe(struct tl_lighting *lighting, tl_gpu *gpu, const struct tl_lobe_table *table)
{
    if (!lighting->lobe_levels.id)
        lighting->lobe_levels = tl_texture_create(gpu, GL_TEXTURE_2D, GL_R32F, TL_LOBE_STEPS, 1, 1, 1);
    glTextureSubImage2D(lighting->lobe_levels.id, 0, 0, 0, TL_LOBE_STEPS, 1, GL_RED, GL_FLOAT, table->level);
}

static void allocate(struct tl_lighting *lighting, tl_gpu *gpu, const tl_target *gbuffer)
{
    const unsigned format = GL_RGBA32F;
    if (lighting->target.width != gbuffer->width || lighting->target.height != gbuffer->height) {
        tl_target_destroy(&lighting->target);
        lighting->target = tl_target_create(gpu, gbuffer->width, gbuffer->height, &format, 1, false);
    }
    glNamedFramebufferTexture(lighting->target.id, GL_DEPTH_ATTACHMENT, gbuffer->depth.id, 0);
}

void tl_lighting_set(struct tl_lighting *lighting, tl_gpu *gpu, const struct tl_gbuffer *gbuffer,
                     const float *light)
{
    allocate(lighting, gpu, &gbuffer->target);
    glTextureSubImage2D(lighting->target.colours[0].id, 0, 0, 0, gbuffer->target.width,
                        gbuffer->target.height, GL_RGBA, GL_FLOAT, light);
}

static void set_frame_uniforms(const struct tl_light_request *request)
{
    const struct tl_light_params *params = request->params;
    const struct tl_ground *ground = request->ground;
    float unit_m = 2 * request->casters.radius; /* one unit of depth */
    glUniform3fv(EYE, 1, request->eye.raw);
    glUniform2f(ENVIRONMENT_TURN, cosf(request->environment_yaw), sinf(request->environment_yaw));
    glUniform1f(PEM_SCALE, request->pems->scale);
    glUniform1i(LOBE, params->lobe);
    glUniform1i(SHADOWED, params->method != TL_METHOD_UNSHADOWED);
    glUniform3f(MAP_LIMITS, params->depth_bias_m / unit_m, params->min_variance / (unit_m * unit_m),
                params->bleed_reduction);
    if (ground)
        glUniform4f(GROUND_DISC, ground->centre.x, ground->centre.y, ground->centre.z, ground->radius);
    else
        glUniform4f(GROUND_DISC, 0, 0, 0, 0);
}

static void draw_pass(const struct tl_lighting *lighting, tl_gpu *gpu, const struct tl_light_request *request,
                      int pass)
{
    struct tl_region_view views[TL_PASS_REGIONS_MAX];
    int first = pass * request->pems->per_array;
    int count = request->regions->count - first;
    count = count < request->pems->per_array ? count : request->pems->per_array;
    for (int i = 0; i < count; i++) {
        vec3s direction =
            tl_turn_direction(request->regions->items[first + i].direction, request->environment_yaw);
        views[i] = tl_region_view_make(direction, &request->casters, request->params->map_size);
    }
    glNamedBufferSubData(lighting->regions_buffer, 0, (GLsizeiptr)((size_t)count * sizeof views[0]), views);
    glBindTextureUnit(PEMS_UNIT, request->pems->arrays[pass].id);
    if (request->params->method != TL_METHOD_UNSHADOWED)
        glBindTextureUnit(MAPS_UNIT, tl_shadow_maps_texture(request->maps, pass));
    glUniform1i(REGION_COUNT, count);
    tl_gpu_draw_fullscreen(gpu);
}

void tl_lighting_draw(struct tl_lighting *lighting, tl_gpu *gpu, const struct tl_light_request *request)
{
    const tl_target *gbuffer = &request->gbuffer->target;
    const float black[] = {0, 0, 0, 0};
    allocate(lighting, gpu, gbuffer);
    glClearNamedFramebufferfv(lighting->target.id, GL_COLOR, 0, black);
    glBindFramebuffer(GL_FRAMEBUFFER, lighting->target.id);
    glViewport(0, 0, gbuffer->width, gbuffer->height);
    glEnable(GL_DEPTH_TEST); /* the full-screen triangle lies at depth 1: this keeps to what is covered */
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    glUseProgram(lighting->program.id);
    for (GLuint i = 0; i < TL_GBUFFER_LAYERS; i++)
        glBindTextureUnit(i, gbuffer->colours[i].id);
    glBindTextureUnit(LOBE_LEVELS_UNIT, lighting->lobe_levels.id);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, lighting->regions_buffer);
    set_frame_uniforms(request);
    for (int pass = 0; pass < request->pems->array_count; pass++)
        draw_pass(lighting, gpu, request, pass);
    tl_gpu_reset_state(gpu);
}
