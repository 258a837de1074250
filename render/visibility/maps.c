#include "render/visibility/maps.h"

#include "config/base/log.h"
#include "config/base/memory.h"
#include "render/gpu/shaders.h"
#include "render/visibility/map_order.h"

#include <epoxy/gl.h>

#include <math.h>
#include <stdlib.h>

/* A depth map's texel is pushed back by this many times its surface's own slope across a texel, so that no
 * surface shadows itself where a look-up blends neighbouring texels. */
#define SLOPE_OFFSET 2.0f

/* Uniform locations of maps.vert and blur.frag. */
enum { MAP_ROWS = 16, LAYER = 0, DIRECTION = 1, RADIUS = 2, WEIGHTS = 3 };

/* Programs by what they keep and draw. */
enum { OPAQUE_DEPTH, MASKED_DEPTH, OPAQUE_MOMENTS, MASKED_MOMENTS, PROGRAM_COUNT };
static const char *const program_defines[PROGRAM_COUNT] = {NULL, "#define MASKED\n", "#define MOMENTS\n",
                                                           "#define MOMENTS\n#define MASKED\n"};

struct tl_shadow_maps {
    tl_gpu *gpu;
    tl_program programs[PROGRAM_COUNT], blur;
    GLuint framebuffer, depth_framebuffer; /* the second has no colours */
    enum tl_visibility kind;
    enum tl_moments moments;
    int count, per_array, size;
    int array_count;
    tl_texture *arrays; /* 2D arrays, per_array layers each; the last one fewer */
    tl_texture depth, scratch;
    tl_texture sun_array;
    struct tl_caster_cloud cloud;
    struct tl_region_view views[TL_REGIONS_MAX], sun_views[TL_SUNS_MAX];
    int ages[TL_REGIONS_MAX]; /* draws since each was drawn; 0: in the last one */
    bool due[TL_REGIONS_MAX]; /* drawn in this draw */
    bool drawn_before;        /* all of them, of these regions */
    uint64_t regions_revision;
    bool warned;
};

tl_shadow_maps *tl_shadow_maps_create(tl_gpu *gpu, tl_error *error)
{
    tl_shadow_maps *maps = TL_NEW(tl_shadow_maps);
    maps->gpu = gpu;
    glCreateFramebuffers(1, &maps->framebuffer);
    glCreateFramebuffers(1, &maps->depth_framebuffer);
    glNamedFramebufferDrawBuffer(maps->depth_framebuffer, GL_NONE);
    bool fine =
        tl_program_create(gpu, tl_embedded_shaders, "fullscreen.vert", "blur.frag", &maps->blur, error);
    for (int i = 0; fine && i < PROGRAM_COUNT; i++)
        fine = tl_program_create_variant(gpu, tl_embedded_shaders, "maps.vert", "maps.frag",
                                         program_defines[i], &maps->programs[i], error);
    if (!fine)
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
    tl_texture_destroy(&(*maps)->sun_array);
    tl_caster_cloud_release(&(*maps)->cloud);
    for (int i = 0; i < PROGRAM_COUNT; i++)
        tl_program_destroy(&(*maps)->programs[i]);
    tl_program_destroy(&(*maps)->blur);
    glDeleteFramebuffers(1, &(*maps)->framebuffer);
    glDeleteFramebuffers(1, &(*maps)->depth_framebuffer);
    free(*maps);
    *maps = NULL;
}

bool tl_shadow_maps_reload(tl_shadow_maps *maps, tl_error *error)
{
    bool fine = tl_program_reload(&maps->blur, error);
    for (int i = 0; i < PROGRAM_COUNT; i++)
        fine = fine && tl_program_reload(&maps->programs[i], error);
    return fine;
}

/* A look-up compares four texels with a depth and blends the answers. */
tl_texture tl_depth_array_create(tl_gpu *gpu, int size, int layers)
{
    tl_texture array =
        tl_texture_create(gpu, GL_TEXTURE_2D_ARRAY, GL_DEPTH_COMPONENT32F, size, size, layers, 1);
    glTextureParameteri(array.id, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glTextureParameteri(array.id, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    return array;
}

static void allocate_moments(tl_shadow_maps *maps)
{
    int count = maps->count, per_array = maps->per_array, size = maps->size;
    const GLenum format = maps->moments == TL_MOMENTS_HALF ? GL_RG16F : GL_RG32F;
    for (int i = 0; i < maps->array_count; i++) {
        int layers = i + 1 < maps->array_count ? per_array : count - i * per_array;
        maps->arrays[i] = tl_texture_create(maps->gpu, GL_TEXTURE_2D_ARRAY, format, size, size, layers, 1);
    }
    maps->depth = tl_texture_create(maps->gpu, GL_TEXTURE_2D, GL_DEPTH_COMPONENT32F, size, size, 1, 1);
    maps->scratch = tl_texture_create(maps->gpu, GL_TEXTURE_2D_ARRAY, format, size, size, 1, 1);
}

static void allocate(tl_shadow_maps *maps, const struct tl_shadow_request *request)
{
    int count = request->regions->count, per_array = request->maps_per_array, size = request->map_size;
    if (maps->kind == request->kind && maps->moments == request->moments && maps->count == count &&
        maps->per_array == per_array && maps->size == size)
        return;
    release_textures(maps);
    maps->drawn_before = false;
    maps->kind = request->kind;
    maps->moments = request->moments;
    maps->count = count;
    maps->per_array = per_array;
    maps->size = size;
    maps->array_count = (count + per_array - 1) / per_array;
    maps->arrays = TL_NEW_ARRAY(tl_texture, (size_t)maps->array_count);
    if (maps->kind == TL_VISIBILITY_VSM)
        allocate_moments(maps);
    else
        for (int i = 0; i < maps->array_count; i++)
            maps->arrays[i] = tl_depth_array_create(
                maps->gpu, size, i + 1 < maps->array_count ? per_array : count - i * per_array);
}

int tl_sun_map_size(const tl_gpu *gpu, int map_size)
{
    int size = 2 * map_size, maximum = tl_gpu_texture_side_max(gpu);
    size = size < TL_SUN_MAP_SIZE_MIN ? TL_SUN_MAP_SIZE_MIN : size;
    return size > maximum ? maximum : size;
}

static void allocate_suns(tl_shadow_maps *maps, const struct tl_shadow_request *request)
{
    int size = tl_sun_map_size(maps->gpu, request->map_size);
    int count = request->suns->count;
    if (maps->sun_array.layers == count && (count == 0 || maps->sun_array.width == size))
        return;
    tl_texture_destroy(&maps->sun_array);
    if (count > 0)
        maps->sun_array = tl_depth_array_create(maps->gpu, size, count);
}

/* Share of the map's side that the casters' sphere takes. */
static float inner_share(int map_size)
{
    return map_size > 4 * TL_MAP_MARGIN_TEXELS ? 1 - 2.0f * TL_MAP_MARGIN_TEXELS / (float)map_size : 1;
}

struct tl_region_view tl_region_view_make(vec3s direction, const struct tl_casters *casters, int map_size)
{
    vec3s right, up;
    tl_view_axes(direction, &right, &up);
    float depth_scale = 0.5f / casters->radius, map_scale = depth_scale * inner_share(map_size);
    return (struct tl_region_view){
        .map_rows = {tl_view_row(right, casters->centre, map_scale),
                     tl_view_row(up, casters->centre, map_scale),
                     tl_view_row(glms_vec3_negate(direction), casters->centre, depth_scale)},
        .direction = {{direction.x, direction.y, direction.z, 0}},
    };
}

vec3s tl_region_seen_direction(const struct tl_regions *regions, int i, int round)
{
    return round == 0 ? regions->items[i].direction : tl_region_sample(regions, i, (uint32_t)round);
}

void tl_shadow_maps_forget(tl_shadow_maps *maps)
{
    maps->drawn_before = false;
}

static void choose_due(tl_shadow_maps *maps, const struct tl_shadow_request *request)
{
    maps->drawn_before = maps->drawn_before && maps->regions_revision == request->regions_revision;
    maps->regions_revision = request->regions_revision;
    struct tl_map_wait *waits = TL_NEW_ARRAY(struct tl_map_wait, (size_t)maps->count);
    for (int i = 0; i < maps->count; i++) {
        const struct tl_region *region = &request->regions->items[i];
        waits[i] = (struct tl_map_wait){region->importance, region->spread, maps->ages[i] + 1};
    }
    tl_map_order(waits, maps->count, maps->drawn_before ? request->refresh : 0, maps->due);
    for (int i = 0; i < maps->count; i++)
        maps->ages[i] = maps->due[i] ? 0 : maps->ages[i] + 1;
    maps->drawn_before = true;
    free(waits);
}

bool tl_shadow_maps_wait(const tl_shadow_maps *maps)
{
    for (int i = 0; i < maps->count; i++)
        if (maps->ages[i] > 0)
            return true;
    return false;
}

static void make_views(tl_shadow_maps *maps, const struct tl_shadow_request *request)
{
    bool fits = request->kind == TL_VISIBILITY_DEPTH || request->suns->count > 0;
    if (fits)
        tl_caster_cloud_fill(&maps->cloud, request->caster_surfaces, request->caster_count);
    for (int i = 0; i < maps->count; i++) {
        if (!maps->due[i])
            continue;
        vec3s direction = tl_turn_direction(tl_region_seen_direction(request->regions, i, request->round),
                                            request->environment_yaw);
        maps->views[i] = request->kind == TL_VISIBILITY_DEPTH
                             ? tl_region_view_fit(direction, &maps->cloud, maps->size)
                             : tl_region_view_make(direction, &request->casters, maps->size);
    }
    for (int i = 0; i < request->suns->count; i++) {
        const struct tl_sun *sun = &request->suns->items[i];
        vec3s seen =
            sun->sample_count > 0 ? sun->samples[request->round % sun->sample_count] : sun->direction;
        maps->sun_views[i] = tl_region_view_fit(tl_turn_direction(seen, request->environment_yaw),
                                                &maps->cloud, maps->sun_array.width);
    }
}

float tl_shadow_sigma(const struct tl_region *region, const struct tl_casters *casters, int map_size,
                      float blur_m)
{
    float texel_m = 2 * casters->radius / (inner_share(map_size) * (float)map_size);
    return tl_casters_scale(casters) * blur_m * tanf(region->cone) / texel_m;
}

static void attach_layer(const tl_shadow_maps *maps, int index)
{
    glNamedFramebufferTextureLayer(maps->framebuffer, GL_COLOR_ATTACHMENT0,
                                   maps->arrays[index / maps->per_array].id, 0, index % maps->per_array);
}

static void draw_parts(const tl_program *program, const struct tl_shadow_request *request,
                       const struct tl_region_view *view, enum tl_surface_parts parts, bool ground)
{
    glUseProgram(program->id);
    glUniform4fv(MAP_ROWS, 3, view->map_rows[0].raw);
    for (size_t i = 0; i < request->surface_count; i++)
        if ((int)i != request->ground_index || ground)
            tl_surfaces_draw(request->surfaces, i, parts);
}

static void draw_view(const tl_program programs[2], const struct tl_shadow_request *request,
                      const struct tl_region_view *view, bool ground)
{
    draw_parts(&programs[0], request, view, TL_PARTS_OPAQUE, ground);
    if (tl_surfaces_have(request->surfaces, TL_PARTS_MASKED))
        draw_parts(&programs[1], request, view, TL_PARTS_MASKED, ground);
}

static void draw_moments(const tl_shadow_maps *maps, const struct tl_shadow_request *request)
{
    const float empty[] = {1, 1, 0, 0}, farthest = 1;
    glNamedFramebufferTexture(maps->framebuffer, GL_DEPTH_ATTACHMENT, maps->depth.id, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, maps->framebuffer);
    glViewport(0, 0, maps->size, maps->size);
    glEnable(GL_DEPTH_CLAMP); /* the ground reaches beyond the casters' sphere; its moments are not clamped */
    for (int i = 0; i < maps->count; i++) {
        if (!maps->due[i])
            continue;
        attach_layer(maps, i);
        glClearNamedFramebufferfv(maps->framebuffer, GL_COLOR, 0, empty);
        glClearNamedFramebufferfv(maps->framebuffer, GL_DEPTH, 0, &farthest);
        /* Below the horizon the ground's shadow is found without a map (ground.glsl). Above it the ground
         * shadows nothing, but as what lies behind the casters it belongs into the moments. */
        draw_view(&maps->programs[OPAQUE_MOMENTS], request, &maps->views[i], maps->views[i].direction.y > 0);
    }
}

/* Layer i of `array` sees views[i], and is drawn if due[i] (NULL: all are). The ground's shadow needs no map.
 */
static void draw_depths(const tl_shadow_maps *maps, const struct tl_shadow_request *request,
                        const tl_texture *array, const struct tl_region_view *views, const bool *due)
{
    const float farthest = 1;
    glBindFramebuffer(GL_FRAMEBUFFER, maps->depth_framebuffer);
    glViewport(0, 0, array->width, array->height);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(SLOPE_OFFSET, 0);
    for (int layer = 0; layer < array->layers; layer++) {
        if (due && !due[layer])
            continue;
        glNamedFramebufferTextureLayer(maps->depth_framebuffer, GL_DEPTH_ATTACHMENT, array->id, 0, layer);
        glClearNamedFramebufferfv(maps->depth_framebuffer, GL_DEPTH, 0, &farthest);
        draw_view(&maps->programs[OPAQUE_DEPTH], request, &views[layer], false);
    }
    glDisable(GL_POLYGON_OFFSET_FILL);
}

void tl_shadow_maps_draw(tl_shadow_maps *maps, const struct tl_shadow_request *request)
{
    allocate(maps, request);
    allocate_suns(maps, request);
    choose_due(maps, request);
    make_views(maps, request);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    if (maps->kind == TL_VISIBILITY_VSM)
        draw_moments(maps, request);
    else
        for (int i = 0; i < maps->array_count; i++)
            draw_depths(maps, request, &maps->arrays[i], maps->views + (ptrdiff_t)i * maps->per_array,
                        maps->due + (ptrdiff_t)i * maps->per_array);
    if (request->suns->count > 0)
        draw_depths(maps, request, &maps->sun_array, maps->sun_views, NULL);
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
    if (maps->kind != TL_VISIBILITY_VSM)
        return;
    glNamedFramebufferTexture(maps->framebuffer, GL_DEPTH_ATTACHMENT, 0, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, maps->framebuffer);
    glViewport(0, 0, maps->size, maps->size);
    glUseProgram(maps->blur.id);
    for (int i = 0; i < maps->count; i++) {
        float sigma =
            tl_shadow_sigma(&request->regions->items[i], &request->casters, maps->size, request->blur_m);
        if (!maps->due[i] || sigma < TL_BLUR_SIGMA_MIN)
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

unsigned tl_shadow_maps_sun_texture(const tl_shadow_maps *maps)
{
    return maps->sun_array.id;
}

const struct tl_region_view *tl_shadow_maps_views(const tl_shadow_maps *maps)
{
    return maps->views;
}

const struct tl_region_view *tl_shadow_maps_sun_views(const tl_shadow_maps *maps)
{
    return maps->sun_views;
}

struct tl_shadow_texels tl_shadow_maps_read(const tl_shadow_maps *maps, int index)
{
    bool moments = maps->kind == TL_VISIBILITY_VSM;
    struct tl_shadow_texels map = {.size = maps->size, .channels = moments ? 2 : 1};
    size_t values = (size_t)map.size * (size_t)map.size * (size_t)map.channels;
    map.texels = TL_NEW_ARRAY(float, values);
    glGetTextureSubImage(maps->arrays[index / maps->per_array].id, 0, 0, 0, index % maps->per_array, map.size,
                         map.size, 1, moments ? GL_RG : GL_DEPTH_COMPONENT, GL_FLOAT,
                         (GLsizei)(values * sizeof(float)), map.texels);
    return map;
}

size_t tl_shadow_maps_bytes(const tl_shadow_maps *maps)
{
    size_t bytes = tl_texture_bytes(&maps->depth) + tl_texture_bytes(&maps->scratch) +
                   tl_texture_bytes(&maps->sun_array);
    for (int i = 0; i < maps->array_count; i++)
        bytes += tl_texture_bytes(&maps->arrays[i]);
    return bytes;
}
