#include "render/visibility/maps.h"

#include "config/log.h"
#include "config/memory.h"
#include "render/shaders.h"

#include <epoxy/gl.h>

#include <math.h>
#include <stdlib.h>

/* Free texels around the casters' sphere, so that a blurred silhouette does not touch the map's border. */
#define MARGIN_TEXELS 2

/* Uniform locations of maps.vert and blur.frag. */
enum { MAP_ROWS = 16, LAYER = 0, DIRECTION = 1, RADIUS = 2, WEIGHTS = 3 };

struct tl_shadow_maps {
    tl_gpu *gpu;
    tl_program opaque, masked, blur;
    GLuint framebuffer;
    int count, per_array, size;
    int array_count;
    tl_texture *arrays; /* 2D arrays, per_array layers each; the last one fewer */
    tl_texture depth, scratch;
    bool warned;
};

tl_shadow_maps *tl_shadow_maps_create(tl_gpu *gpu, tl_error *error)
{
    tl_shadow_maps *maps = TL_NEW(tl_shadow_maps);
    maps->gpu = gpu;
    glCreateFramebuffers(1, &maps->framebuffer);
    if (!tl_program_create(gpu, tl_embedded_shaders, "maps.vert", "maps.frag", &maps->opaque, error) ||
        !tl_program_create(gpu, tl_embedded_shaders, "maps.vert", "maps_masked.frag", &maps->masked, error) ||
        !tl_program_create(gpu, tl_embedded_shaders, "fullscreen.vert", "blur.frag", &maps->blur, error))
        tl_shadow_maps_destroy(&maps);
    return maps;
}

static void release_textures(tl_shadow_maps *maps)
{
    for (int i = 0; i < maps->array_count; i++)
        tl_texture_destroy(&maps->arrays[i]);
    free(maps->arrays);
    maps->arrays = NULL;
    maps->array_count = 0;
    tl_texture_destroy(&maps->depth);
    tl_texture_destroy(&maps->scratch);
}

void tl_shadow_maps_destroy(tl_shadow_maps **maps)
{
    if (!*maps)
        return;
    release_textures(*maps);
    tl_program_destroy(&(*maps)->opaque);
    tl_program_destroy(&(*maps)->masked);
    tl_program_destroy(&(*maps)->blur);
    glDeleteFramebuffers(1, &(*maps)->framebuffer);
    free(*maps);
    *maps = NULL;
}

bool tl_shadow_maps_reload(tl_shadow_maps *maps, tl_error *error)
{
    return tl_program_reload(&maps->opaque, error) && tl_program_reload(&maps->masked, error) &&
           tl_program_reload(&maps->blur, error);
}

static void allocate(tl_shadow_maps *maps, int count, int per_array, int size)
{
    if (maps->count == count && maps->per_array == per_array && maps->size == size)
        return;
    release_textures(maps);
    maps->count = count;
    maps->per_array = per_array;
    maps->size = size;
    maps->array_count = (count + per_array - 1) / per_array;
    maps->arrays = TL_NEW_ARRAY(tl_texture, (size_t)maps->array_count);
    for (int i = 0; i < maps->array_count; i++) {
        int layers = i + 1 < maps->array_count ? per_array : count - i * per_array;
        maps->arrays[i] = tl_texture_create(maps->gpu, GL_TEXTURE_2D_ARRAY, GL_RG32F, size, size, layers, 1);
    }
    maps->depth = tl_texture_create(maps->gpu, GL_TEXTURE_2D, GL_DEPTH_COMPONENT32F, size, size, 1, 1);
    maps->scratch = tl_texture_create(maps->gpu, GL_TEXTURE_2D_ARRAY, GL_RG32F, size, size, 1, 1);
}

/* Row that maps a point to 0.5 + axis . (point - centre) * scale. */
static vec4s view_row(vec3s axis, vec3s centre, float scale)
{
    return (vec4s){
        {axis.x * scale, axis.y * scale, axis.z * scale, 0.5f - scale * glms_vec3_dot(axis, centre)}};
}

/* Share of the map's side that the casters' sphere takes. */
static float inner_share(int map_size)
{
    return map_size > 4 * MARGIN_TEXELS ? 1 - 2.0f * MARGIN_TEXELS / (float)map_size : 1;
}

struct tl_region_view tl_region_view_make(vec3s direction, const struct tl_casters *casters, int map_size)
{
    vec3s helper = fabsf(direction.y) < 0.9f ? (vec3s){{0, 1, 0}} : (vec3s){{1, 0, 0}};
    vec3s right = glms_vec3_normalize(glms_vec3_cross(helper, direction));
    vec3s up = glms_vec3_cross(direction, right);
    float depth_scale = 0.5f / casters->radius, map_scale = depth_scale * inner_share(map_size);
    return (struct tl_region_view){
        .map_rows = {view_row(right, casters->centre, map_scale), view_row(up, casters->centre, map_scale),
                     view_row(glms_vec3_negate(direction), casters->centre, depth_scale)},
        .direction = {{direction.x, direction.y, direction.z, 0}},
    };
}

float tl_shadow_sigma(const struct tl_region *region, const struct tl_casters *casters, int map_size,
                      float blur_m)
{
    float texel_m = 2 * casters->radius / (inner_share(map_size) * (float)map_size);
    return blur_m * tanf(region->cone) / texel_m;
}

static void attach_layer(const tl_shadow_maps *maps, int index)
{
    glNamedFramebufferTextureLayer(maps->framebuffer, GL_COLOR_ATTACHMENT0,
                                   maps->arrays[index / maps->per_array].id, 0, index % maps->per_array);
}

static void draw_parts(const tl_shadow_maps *maps, const struct tl_shadow_request *request,
                       const struct tl_region_view *view, enum tl_surface_parts parts)
{
    glUseProgram(parts == TL_PARTS_OPAQUE ? maps->opaque.id : maps->masked.id);
    glUniform4fv(MAP_ROWS, 3, view->map_rows[0].raw);
    for (size_t i = 0; i < request->surface_count; i++)
        /* Below the horizon the ground's shadow is found without a map (ground.glsl). Above it the ground
         * shadows nothing, but as what lies behind the casters it belongs into the moments. */
        if ((int)i != request->ground_index || view->direction.y > 0)
            tl_surfaces_draw(request->surfaces, i, parts);
}

static void draw_one(const tl_shadow_maps *maps, const struct tl_shadow_request *request, vec3s direction)
{
    struct tl_region_view view = tl_region_view_make(direction, &request->casters, maps->size);
    const float empty[] = {1, 1, 0, 0}, farthest = 1;
    glClearNamedFramebufferfv(maps->framebuffer, GL_COLOR, 0, empty);
    glClearNamedFramebufferfv(maps->framebuffer, GL_DEPTH, 0, &farthest);
    draw_parts(maps, request, &view, TL_PARTS_OPAQUE);
    if (tl_surfaces_have(request->surfaces, TL_PARTS_MASKED))
        draw_parts(maps, request, &view, TL_PARTS_MASKED);
}

void tl_shadow_maps_draw(tl_shadow_maps *maps, const struct tl_shadow_request *request)
{
    allocate(maps, request->regions->count, request->maps_per_array, request->map_size);
    glNamedFramebufferTexture(maps->framebuffer, GL_DEPTH_ATTACHMENT, maps->depth.id, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, maps->framebuffer);
    glViewport(0, 0, maps->size, maps->size);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_DEPTH_CLAMP); /* the ground reaches beyond the casters' sphere; its moments are not clamped */
    glDepthFunc(GL_LEQUAL);
    for (int i = 0; i < maps->count; i++) {
        attach_layer(maps, i);
        draw_one(maps, request,
                 tl_turn_direction(request->regions->items[i].direction, request->environment_yaw));
    }
    tl_gpu_reset_state(maps->gpu);
}

/* Weights of the centre and one side, normalised over both; returns the radius. */
static int gaussian(float sigma, float weights[TL_BLUR_RADIUS_MAX + 1])
{
    int radius = (int)fminf(ceilf(3 * sigma), TL_BLUR_RADIUS_MAX);
    float sum = 0;
    for (int i = 0; i <= radius; i++) {
        weights[i] = expf(-0.5f * (float)(i * i) / (sigma * sigma));
        sum += i == 0 ? weights[i] : 2 * weights[i];
    }
    for (int i = 0; i <= radius; i++)
        weights[i] /= sum;
    return radius;
}

static void blur_one(const tl_shadow_maps *maps, int index, float sigma)
{
    float weights[TL_BLUR_RADIUS_MAX + 1];
    int radius = gaussian(sigma, weights);
    glUniform1i(RADIUS, radius);
    glUniform1fv(WEIGHTS, radius + 1, weights);

    glNamedFramebufferTextureLayer(maps->framebuffer, GL_COLOR_ATTACHMENT0, maps->scratch.id, 0, 0);
    glBindTextureUnit(0, maps->arrays[index / maps->per_array].id);
    glUniform1i(LAYER, index % maps->per_array);
    glUniform2i(DIRECTION, 1, 0);
    tl_gpu_draw_fullscreen(maps->gpu);

    attach_layer(maps, index);
    glBindTextureUnit(0, maps->scratch.id);
    glUniform1i(LAYER, 0);
    glUniform2i(DIRECTION, 0, 1);
    tl_gpu_draw_fullscreen(maps->gpu);
}

void tl_shadow_maps_blur(tl_shadow_maps *maps, const struct tl_shadow_request *request)
{
    glNamedFramebufferTexture(maps->framebuffer, GL_DEPTH_ATTACHMENT, 0, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, maps->framebuffer);
    glViewport(0, 0, maps->size, maps->size);
    glUseProgram(maps->blur.id);
    for (int i = 0; i < maps->count; i++) {
        float sigma =
            tl_shadow_sigma(&request->regions->items[i], &request->casters, maps->size, request->blur_m);
        if (sigma < TL_BLUR_SIGMA_MIN)
            continue;
        if (3 * sigma > TL_BLUR_RADIUS_MAX && !maps->warned) {
            tl_warn("light.blur_m: a shadow blur of %.0f texels is cut to %d: lower light.blur_m or "
                    "light.map_size",
                    (double)(3 * sigma), TL_BLUR_RADIUS_MAX);
            maps->warned = true;
        }
        blur_one(maps, i, sigma);
    }
}

unsigned tl_shadow_maps_texture(const tl_shadow_maps *maps, int index)
{
    return maps->arrays[index].id;
}

size_t tl_shadow_maps_bytes(const tl_shadow_maps *maps)
{
    size_t bytes = tl_texture_bytes(&maps->depth) + tl_texture_bytes(&maps->scratch);
    for (int i = 0; i < maps->array_count; i++)
        bytes += tl_texture_bytes(&maps->arrays[i]);
    return bytes;
}
