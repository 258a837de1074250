#include "render/local/lamp_shadows.h"

#include "render/gpu/shaders.h"
#include "render/visibility/maps.h"

#include <epoxy/gl.h>

#include <math.h>

/* A lamp nearer than this many radii would need a frustum so wide that its central texels are large. */
#define NEAREST_RADII 1.2f
#define SLOPE_OFFSET  2.0f /* the same as in visibility/maps.c */

enum { LAMP_VIEW = 73 }; /* uniform location */

enum tl_lamp_shadow tl_lamp_shadow_of(const struct tl_lamp *lamp, const struct tl_light_params *light,
                                      const struct tl_casters *casters)
{
    if (light->method == TL_METHOD_UNSHADOWED)
        return TL_LAMP_SHADOW_NONE;
    if (light->visibility == TL_VISIBILITY_RAYS)
        return TL_LAMP_SHADOW_RAYS;
    bool is_near = lamp->kind == TL_LAMP_POINT &&
                   !(glms_vec3_distance(lamp->position, casters->centre) > NEAREST_RADII * casters->radius);
    return is_near ? TL_LAMP_SHADOW_RAYS : TL_LAMP_SHADOW_MAP;
}

/* Converts the rows of a region view, which map to [0, 1], to clip space, [-1, 1]. */
static mat4s clip_of(const struct tl_region_view *view)
{
    mat4s clip = GLMS_MAT4_ZERO_INIT;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++)
            clip.raw[column][row] = 2 * view->map_rows[row].raw[column] - (column == 3 ? 1 : 0);
    clip.raw[3][3] = 1;
    return clip;
}

mat4s tl_lamp_view(const struct tl_lamp *lamp, const struct tl_casters *casters,
                   const struct tl_caster_cloud *cloud, int map_size)
{
    if (lamp->kind == TL_LAMP_DIRECTIONAL) {
        struct tl_region_view view =
            tl_region_view_fit(glms_vec3_normalize(lamp->direction), cloud, map_size);
        return clip_of(&view);
    }
    vec3s away = glms_vec3_sub(lamp->position, casters->centre), right, up;
    float distance = glms_vec3_norm(away), radius = casters->radius;
    vec3s direction = glms_vec3_divs(away, distance);
    tl_view_axes(direction, &right, &up);
    float tangent = radius / sqrtf(distance * distance - radius * radius);
    float margin = 1 + 2.0f * TL_MAP_MARGIN_TEXELS / (float)map_size;
    mat4s projection = glms_perspective(2 * atanf(tangent * margin), 1, distance - radius, distance + radius);
    return glms_mat4_mul(projection, glms_look(lamp->position, glms_vec3_negate(direction), up));
}

void tl_lamp_shadows_release(struct tl_lamp_shadows *shadows)
{
    tl_texture_destroy(&shadows->depths);
    tl_texture_destroy(&shadows->visibility);
    for (int i = 0; i < 2; i++)
        tl_program_destroy(&shadows->programs[i]);
    if (shadows->framebuffer)
        glDeleteFramebuffers(1, &shadows->framebuffer);
    tl_caster_cloud_release(&shadows->cloud);
    *shadows = (struct tl_lamp_shadows){0};
}

size_t tl_lamp_shadows_bytes(const struct tl_lamp_shadows *shadows)
{
    return tl_texture_bytes(&shadows->depths) + tl_texture_bytes(&shadows->visibility);
}

static bool prepare(struct tl_lamp_shadows *shadows, tl_gpu *gpu, int size, int layers, tl_error *error)
{
    static const char *const defines[2] = {NULL, "#define MASKED\n"};
    for (int i = 0; i < 2; i++)
        if (!shadows->programs[i].id &&
            !tl_program_create_variant(gpu, tl_embedded_shaders, "lamp_depth.vert", "maps.frag", defines[i],
                                       &shadows->programs[i], error))
            return false;
    if (!shadows->framebuffer) {
        glCreateFramebuffers(1, &shadows->framebuffer);
        glNamedFramebufferDrawBuffer(shadows->framebuffer, GL_NONE);
    }
    if (shadows->depths.width != size || shadows->depths.layers != layers) {
        tl_texture_destroy(&shadows->depths);
        shadows->depths = tl_depth_array_create(gpu, size, layers);
    }
    return true;
}

static void draw_layer(const struct tl_lamp_shadows *shadows, const struct tl_lamp_maps_request *request,
                       size_t layer)
{
    static const enum tl_surface_parts parts[2] = {TL_PARTS_OPAQUE, TL_PARTS_MASKED};
    const float farthest = 1;
    glNamedFramebufferTextureLayer(shadows->framebuffer, GL_DEPTH_ATTACHMENT, shadows->depths.id, 0,
                                   (GLint)layer);
    glClearNamedFramebufferfv(shadows->framebuffer, GL_DEPTH, 0, &farthest);
    for (int i = 0; i < 2; i++) {
        if (!tl_surfaces_have(request->surfaces, parts[i]))
            continue;
        glUseProgram(shadows->programs[i].id);
        glUniformMatrix4fv(LAMP_VIEW, 1, GL_FALSE, shadows->views[layer].raw[0]);
        for (size_t s = 0; s < request->caster_count; s++)
            tl_surfaces_draw(request->surfaces, s, parts[i]);
    }
}

bool tl_lamp_maps_draw(struct tl_lamp_shadows *shadows, tl_gpu *gpu,
                       const struct tl_lamp_maps_request *request, tl_error *error)
{
    int size = tl_sun_map_size(gpu, request->map_size);
    if (!prepare(shadows, gpu, size, (int)request->lamp_count, error))
        return false;
    tl_caster_cloud_fill(&shadows->cloud, request->caster_surfaces, request->caster_count);
    glBindFramebuffer(GL_FRAMEBUFFER, shadows->framebuffer);
    glViewport(0, 0, size, size);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(SLOPE_OFFSET, 0);
    for (size_t i = 0; i < request->lamp_count; i++) {
        if (shadows->kinds[i] != TL_LAMP_SHADOW_MAP)
            continue;
        shadows->views[i] = tl_lamp_view(&request->lamps[i], &request->casters, &shadows->cloud, size);
        draw_layer(shadows, request, i);
    }
    glDisable(GL_POLYGON_OFFSET_FILL);
    tl_gpu_reset_state(gpu);
    return true;
}

void tl_lamp_shadows_set(struct tl_lamp_shadows *shadows, tl_gpu *gpu, int width, int height, size_t lamp,
                         size_t lamp_count, const uint8_t *visible)
{
    tl_texture *texture = &shadows->visibility;
    if (texture->width != width || texture->height != height || texture->layers != (int)lamp_count) {
        tl_texture_destroy(texture);
        *texture = tl_texture_create(gpu, GL_TEXTURE_2D_ARRAY, GL_R8, width, height, (int)lamp_count, 1);
    }
    glTextureSubImage3D(texture->id, 0, 0, 0, (GLint)lamp, width, height, 1, GL_RED, GL_UNSIGNED_BYTE,
                        visible);
}
