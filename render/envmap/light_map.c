#include "render/envmap/light_map.h"

#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "render/envmap/light_map_bake.h"
#include "render/gbuffer/gbuffer.h"
#include "render/gpu/shaders.h"
#include "render/surfaces/uv_texels.h"

#include <epoxy/gl.h>

#include <math.h>
#include <stdlib.h>

/* Uniform locations of light_map.vert and its fragment shader, in addition to those of surface.glsl. */
enum { VIEW_PROJECTION = 64, MAP_FRAME, LAYER, FIRST_VERTEX };
/* Texture units after those of the surfaces. */
enum { TRIANGLE_UNIT = 16, LIGHT_MAP_UNIT };
#define VERTEX_BINDING 2
/* Texels around a chart that look-ups may reach, and one more for sheared triangles. */
#define PADDING 2

void tl_light_map_release(struct tl_light_map *map)
{
    free(map->places);
    tl_texture_destroy(&map->texture);
    if (map->buffer)
        glDeleteBuffers(1, &map->buffer);
    tl_program_destroy(&map->program);
    tl_target_destroy(&map->target);
    *map = (struct tl_light_map){0};
}

bool tl_light_map_reload(struct tl_light_map *map, tl_error *error)
{
    return !map->program.id || tl_program_reload(&map->program, error);
}

size_t tl_light_map_bytes(const struct tl_light_map *map)
{
    return tl_texture_bytes(&map->texture) + map->buffer_bytes + tl_target_bytes(&map->target);
}

static vec3s weighted(const vec3s *vectors, const uint32_t *corners, vec3s weights)
{
    vec3s sum = glms_vec3_scale(vectors[corners[0]], weights.x);
    sum = glms_vec3_add(sum, glms_vec3_scale(vectors[corners[1]], weights.y));
    return glms_vec3_add(sum, glms_vec3_scale(vectors[corners[2]], weights.z));
}

static vec3s unit_or(vec3s v, vec3s fallback)
{
    float square = glms_vec3_norm2(v);
    return square > 0 ? glms_vec3_scale(v, 1 / sqrtf(square)) : fallback;
}

/* A point of a triangle and its smooth normal, on one of the two sides. Rays start off the plane of the
 * triangle. */
static struct tl_baked_point point_of(const tl_surface *surface, uint32_t triangle, vec3s weights, float side,
                                      float offset_m, size_t at)
{
    const uint32_t *corners = surface->indices + 3 * (size_t)triangle;
    const vec3s *positions = surface->positions;
    vec3s normal = unit_or(weighted(surface->normals, corners, weights), (vec3s){{0, 1, 0}});
    vec3s facet = unit_or(glms_vec3_cross(glms_vec3_sub(positions[corners[1]], positions[corners[0]]),
                                          glms_vec3_sub(positions[corners[2]], positions[corners[0]])),
                          normal);
    float away = glms_vec3_dot(facet, normal) < 0 ? -offset_m : offset_m;
    return (struct tl_baked_point){
        .point = glms_vec3_add(weighted(positions, corners, weights), glms_vec3_scale(facet, side * away)),
        .normal = glms_vec3_scale(normal, side),
        .at = at};
}

/* The light of a surface over its UVs: front, then back. */
static float *bake_texels(const struct tl_reference_scene *scene, int directions, const tl_surface *surface,
                          const uint32_t *triangles, struct tl_light_map_place *place, int side)
{
    size_t texels = (size_t)side * (size_t)side, count = 0;
    float *light = TL_NEW_ARRAY(float, 8 * texels);
    struct tl_baked_point *points = TL_NEW_ARRAY(struct tl_baked_point, 2 * texels);
    tl_uv_texels_box(surface, &place->low, &place->extent);
    for (size_t i = 0; i < 2 * texels; i++) {
        int texel = (int)(i % texels);
        if (!triangles[texel])
            continue;
        vec3s weights =
            tl_uv_texels_weights(surface, triangles[texel] - 1, place->low, place->extent, side, texel);
        points[count++] =
            point_of(surface, triangles[texel] - 1, weights, i < texels ? 1 : -1, scene->offset_m, i);
    }
    tl_light_map_gather(scene, directions, points, count, light);
    tl_light_map_pad(light, side, PADDING);
    tl_light_map_pad(light + 4 * texels, side, PADDING);
    free(points);
    return light;
}

/* The light at the vertices of a surface: front, then back. */
static void bake_vertices(const struct tl_reference_scene *scene, int directions, const tl_surface *surface,
                          float *light)
{
    size_t count = surface->vertex_count;
    struct tl_baked_point *points = TL_NEW_ARRAY(struct tl_baked_point, 2 * count);
    for (size_t i = 0; i < 2 * count; i++) {
        float side = i < count ? 1 : -1;
        vec3s normal = surface->normals[i % count];
        points[i] =
            (struct tl_baked_point){.point = glms_vec3_add(surface->positions[i % count],
                                                           glms_vec3_scale(normal, side * scene->offset_m)),
                                    .normal = glms_vec3_scale(normal, side),
                                    .at = i};
    }
    tl_light_map_gather(scene, directions, points, 2 * count, light);
    free(points);
}

/* Baked texels before they are sent. */
struct bake {
    const struct tl_reference_scene *scene;
    int directions, side, layers;
    float **texels;  /* by surface; NULL: at vertices */
    float *vertices; /* of all surfaces that are baked there */
    size_t vertex_count;
};

static void bake_surface(struct bake *bake, const tl_surface *surface, struct tl_light_map_place *place,
                         float **texels)
{
    uint32_t *triangles = tl_uv_texels_triangles(surface, bake->side);
    *place = (struct tl_light_map_place){.layer = -1,
                                         .extent = {{1, 1}},
                                         .first_vertex = bake->vertex_count,
                                         .vertex_count = surface->vertex_count};
    if (triangles) {
        *texels = bake_texels(bake->scene, bake->directions, surface, triangles, place, bake->side);
        place->layer = bake->layers;
        bake->layers += 2;
    } else {
        bake->vertices =
            tl_resize(bake->vertices, bake->vertex_count + 2 * surface->vertex_count, 4 * sizeof(float));
        bake_vertices(bake->scene, bake->directions, surface, bake->vertices + 4 * bake->vertex_count);
        bake->vertex_count += 2 * surface->vertex_count;
    }
    free(triangles);
}

static void send(struct tl_light_map *map, tl_gpu *gpu, const struct bake *bake)
{
    int side = bake->layers > 0 ? bake->side : 1, layers = bake->layers > 0 ? bake->layers : 1;
    const float none[4] = {0};
    tl_texture_destroy(&map->texture);
    map->texture = tl_texture_create(gpu, GL_TEXTURE_2D_ARRAY, GL_RGBA32F, side, side, layers, 1);
    for (size_t i = 0; i < map->place_count; i++)
        if (bake->texels[i])
            glTextureSubImage3D(map->texture.id, 0, 0, 0, map->places[i].layer, side, side, 2, GL_RGBA,
                                GL_FLOAT, bake->texels[i]);
    if (!map->buffer)
        glCreateBuffers(1, &map->buffer);
    map->buffer_bytes = 4 * sizeof(float) * (bake->vertex_count > 0 ? bake->vertex_count : 1);
    glNamedBufferData(map->buffer, (GLsizeiptr)map->buffer_bytes, bake->vertices ? bake->vertices : none,
                      GL_STATIC_DRAW);
}

bool tl_light_map_bake(struct tl_light_map *map, tl_gpu *gpu, const struct tl_reference_request *request,
                       int side, tl_error *error)
{
    const tl_frame *frame = request->frame;
    struct tl_reference_scene scene;
    if (!tl_reference_scene_make(request, &scene, error))
        return false;
    size_t count = frame->surface_count + (request->ground ? 1 : 0);
    struct bake bake = {.scene = &scene,
                        .directions = request->params->strata,
                        .side = side,
                        .texels = TL_NEW_ARRAY(float *, count + 1)};
    struct tl_progress progress = tl_progress_begin("baking light maps");
    map->places = tl_resize(map->places, count, sizeof *map->places);
    map->place_count = count;
    for (size_t i = 0; i < count; i++) {
        bake_surface(&bake, i < frame->surface_count ? &frame->surfaces[i] : &request->ground->surface,
                     &map->places[i], &bake.texels[i]);
        tl_progress_update(&progress, (double)i + 1, (double)count);
    }
    tl_progress_end(&progress);
    tl_reference_scene_release(&scene);
    bool fine = !tl_interrupted();
    if (fine) {
        send(map, gpu, &bake);
        tl_info("light maps: %d surfaces baked in %d x %d texels, %zu at vertices", bake.layers / 2, side,
                side, count - (size_t)(bake.layers / 2));
    }
    for (size_t i = 0; i < count; i++)
        free(bake.texels[i]);
    free(bake.texels);
    free(bake.vertices);
    return fine || tl_fail(error, TL_INTERRUPTED, "light maps: interrupted while they were baked");
}

/* UVs to places in the texture, for the middles of texels that tl_uv_texels_weights has. */
static void set_frame(const struct tl_light_map_place *place, int side)
{
    float half = 0.5f / (float)side, inner = (float)(side > 1 ? side - 1 : 1) / (float)side;
    vec2s factor = {{inner / place->extent.x, inner / place->extent.y}};
    glUniform4f(MAP_FRAME, half - place->low.x * factor.x, half - place->low.y * factor.y, factor.x,
                factor.y);
}

bool tl_light_map_draw(struct tl_light_map *map, tl_gpu *gpu, const tl_target *gbuffer,
                       const struct tl_view *view, const tl_surfaces *surfaces, size_t surface_count,
                       tl_error *error)
{
    const unsigned format = GL_RGBA32F;
    if (!map->program.id && !tl_program_create(gpu, tl_embedded_shaders, "light_map.vert", "light_map.frag",
                                               &map->program, error))
        return false;
    tl_target_fit(&map->target, gpu, gbuffer, &format, 1);
    glBindFramebuffer(GL_FRAMEBUFFER, map->target.id);
    glViewport(0, 0, gbuffer->width, gbuffer->height);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_FALSE);
    glBindTextureUnit(TRIANGLE_UNIT, gbuffer->colours[TL_GBUFFER_TRIANGLE].id);
    glBindTextureUnit(LIGHT_MAP_UNIT, map->texture.id);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, VERTEX_BINDING, map->buffer);
    glUseProgram(map->program.id);
    glUniformMatrix4fv(VIEW_PROJECTION, 1, GL_FALSE, view->view_projection.raw[0]);
    for (size_t s = 0; s < surface_count; s++) {
        const struct tl_light_map_place *place = &map->places[s];
        GLint first = (GLint)place->first_vertex;
        set_frame(place, map->texture.width);
        glUniform1i(LAYER, place->layer);
        glUniform2i(FIRST_VERTEX, first, first + (GLint)place->vertex_count);
        for (size_t p = 0; p < tl_surfaces_part_count(surfaces, s); p++)
            tl_surfaces_draw_part(surfaces, s, p);
    }
    return true;
}
