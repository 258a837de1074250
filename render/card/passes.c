#include "render/card/card_internal.h"

#include "config/base/memory.h"
#include "render/visibility/points.h"

#include <stdlib.h>
#include <string.h>

#define TILE 8 /* pixels a side */

/* ---- IDs and tiles ---- */

static void set_view(tl_graphics_card *card, const struct tl_card_view *request)
{
    struct tl_card_frame *frame = &card->frame;
    const struct tl_view *view = request->view;
    const float width = (float)request->width, height = (float)request->height;
    memcpy(frame->view_projection, view->view_projection.raw, sizeof frame->view_projection);
    tl_card_put(frame->eye, view->eye, frame->eye[3]);
    const vec3s across = glms_vec3_scale(view->right, 2 / width), up = glms_vec3_scale(view->up, 2 / height);
    vec3s first = glms_vec3_sub(view->forward, glms_vec3_add(view->right, view->up));
    first = glms_vec3_add(first, glms_vec3_scale(glms_vec3_add(across, up), 0.5f)); /* a pixel's middle */
    tl_card_put(frame->ray_first, first, 0);
    tl_card_put(frame->ray_across, across, 0);
    tl_card_put(frame->ray_up, up, 0);
    frame->size[0] = request->width;
    frame->size[1] = request->height;
    frame->size[2] = (request->width + TILE - 1) / TILE;
    frame->size[3] = (request->height + TILE - 1) / TILE;
}

/* Dispatches begin with nothing along x. */
static void clear_work(tl_graphics_card *card)
{
    uint32_t words[CARD_WORDS] = {0};
    for (int i = 0; i < CARD_WORDS; i += 4)
        words[i + 1] = words[i + 2] = 1;
    tl_buffer_write(&card->buffers[CARD_WORK], 0, words, sizeof words);
}

static void make_vertex_array(tl_graphics_card *card)
{
    if (card->vertex_array == 0) {
        glCreateVertexArrays(1, &card->vertex_array);
        glEnableVertexArrayAttrib(card->vertex_array, 0);
        glVertexArrayAttribFormat(card->vertex_array, 0, 3, GL_FLOAT, GL_FALSE, 0);
        glVertexArrayAttribBinding(card->vertex_array, 0, 0);
        glCreateFramebuffers(1, &card->ids_framebuffer);
    }
    glVertexArrayVertexBuffer(card->vertex_array, 0, card->points.positions.id, 0, sizeof(vec3s));
    glVertexArrayElementBuffer(card->vertex_array, card->points.corners.id);
    glNamedFramebufferTexture(card->ids_framebuffer, GL_COLOR_ATTACHMENT0, card->ids[0].id, 0);
    glNamedFramebufferTexture(card->ids_framebuffer, GL_DEPTH_ATTACHMENT, card->depth.id, 0);
}

/* The ground has an upper side only. */
static void draw_ids(tl_graphics_card *card)
{
    static const GLuint none[4];
    static const float farthest = 1;
    const bool sees_ground = card->frame.eye[1] > card->frame.disc[1];
    const size_t triangles = sees_ground ? card->points.triangle_count : card->traced_triangles;
    make_vertex_array(card);
    glBindFramebuffer(GL_FRAMEBUFFER, card->ids_framebuffer);
    glViewport(0, 0, card->ids[0].width, card->ids[0].height);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glClearNamedFramebufferuiv(card->ids_framebuffer, GL_COLOR, 0, none);
    glClearNamedFramebufferfv(card->ids_framebuffer, GL_DEPTH, 0, &farthest);
    glUseProgram(card->draw_ids[card->points.has_holes ? 1 : 0].id);
    glBindVertexArray(card->vertex_array);
    glDrawElements(GL_TRIANGLES, (GLsizei)(3 * triangles), GL_UNSIGNED_INT, NULL);
    glBindVertexArray(0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDisable(GL_DEPTH_TEST);
    tl_gpu_barrier();
}

/* The triangles behind open ones. */
static void find_behind(tl_graphics_card *card)
{
    glUseProgram(card->behind.id);
    for (int layer = 1; layer < card->layers; layer++) {
        glBindTextureUnit(0, card->ids[layer - 1].id);
        glBindImageTexture(0, card->ids[layer].id, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R32UI);
        tl_gpu_dispatch((unsigned)card->frame.size[2], (unsigned)card->frame.size[3], 1);
        tl_gpu_barrier();
    }
}

/* Lists the tiles of a layer. */
static void list_tiles(tl_graphics_card *card, int layer)
{
    clear_work(card);
    glBindTextureUnit(0, card->ids[layer].id);
    glUseProgram(card->list_tiles.id);
    tl_gpu_dispatch((unsigned)card->frame.size[2], (unsigned)card->frame.size[3], 1);
    tl_gpu_barrier();
}

bool tl_card_see(tl_graphics_card *card, const struct tl_card_view *request, tl_error *error)
{
    set_view(card, request);
    const int32_t *size = card->frame.size;
    for (int i = 0; i < card->layers; i++)
        tl_card_fit_texture(card, &card->ids[i], GL_R32UI, size[0], size[1]);
    tl_card_fit_texture(card, &card->depth, GL_DEPTH_COMPONENT32F, size[0], size[1]);
    const size_t tiles = (size_t)size[2] * (size_t)size[3] * CARD_CLASSES_MAX;
    if (!tl_buffer_reserve(&card->buffers[CARD_TILES], card->gpu, sizeof(uint32_t) * tiles, error) ||
        !tl_card_send_frame(card, error))
        return false;
    draw_ids(card);
    find_behind(card);
    tl_card_points_list(&card->points, card->ids, card->layers);
    if (!tl_card_send_frame(card, error))
        return false;
    list_tiles(card, 0);
    return true;
}

/* ---- Light at vertices ---- */

bool tl_card_trace_points(tl_graphics_card *card, const struct tl_card_light *request, tl_error *error)
{
    if (!tl_card_send_light(card, request, error))
        return false;
    const int regions = request->regions->count;
    const int rays = request->rays < TL_CARD_RAYS_MAX ? request->rays : TL_CARD_RAYS_MAX;
    vec3s *own = tl_points_directions(request->regions, rays, request->environment_yaw);
    vec3s *directions = TL_NEW_ARRAY(vec3s, (size_t)(rays * regions));
    for (int i = 0; i < regions; i++)
        for (int ray = 0; ray < rays; ray++)
            directions[ray * regions + i] = own[i * rays + ray];
    const struct tl_card_points_light light = {
        .directions = directions, .region_count = regions, .ray_count = rays, .ground = request->ground};
    const bool fine = tl_card_points_trace(&card->points, &light, error);
    free(own);
    free(directions);
    return fine;
}

/* Traces every `shares`-th probe with bounced light of its own, from `first` on. */
static void bounce_once(tl_graphics_card *card, uint32_t first, uint32_t shares)
{
    const uint32_t count = ((uint32_t)card->own_count - first + shares - 1) / shares;
    glUseProgram(card->bounce.id);
    glUniform3ui(0, first, shares, count);
    tl_card_dispatch(&card->bounce, count, 2);
    tl_card_dispatch(&card->bounce_fill, card->points.probe_count, 64);
}

/* Bounces of the first frame, after which what rays meet is known itself. */
#define FIRST_FRAMES 4

bool tl_card_trace_bounce(tl_graphics_card *card, const struct tl_card_bounce *request, tl_error *error)
{
    const size_t probes = card->points.probe_count;
    const struct {
        int binding;
        size_t bytes;
    } needed[] = {{CARD_FOUND, (size_t)17 * 16 * probes},
                  {CARD_BOUNCED, (size_t)17 * 16 * probes},
                  {CARD_SENT, 16 * probes},
                  {CARD_SENT_NOW, (size_t)2 * 16 * probes}};
    for (size_t i = 0; i < sizeof needed / sizeof *needed; i++)
        if (!tl_buffer_reserve(&card->buffers[needed[i].binding], card->gpu, needed[i].bytes, error))
            return false;
    if (!tl_card_send_sky(card, request, error) || !tl_card_send_frame(card, error))
        return false;
    glBindTextureUnit(4, card->lobe_atlas.id);
    if (card->bounce_frames == 0) {
        tl_buffer_clear(&card->buffers[CARD_FOUND]);
        tl_buffer_clear(&card->buffers[CARD_SENT]);
        tl_buffer_clear(&card->buffers[CARD_SENT_NOW]);
        for (int i = 0; i < FIRST_FRAMES; i++)
            bounce_once(card, 0, 1);
    } else {
        bounce_once(card, card->bounce_frames % (uint32_t)request->shares, (uint32_t)request->shares);
    }
    card->bounce_frames++;
    tl_card_dispatch_listed(card, &card->bounce_show, CARD_WORK_OF_4);
    return true;
}

bool tl_card_make_ratios(tl_graphics_card *card, bool bounces, tl_error *error)
{
    card->frame.numbers[1] = bounces;
    if (!tl_card_send_frame(card, error))
        return false;
    glBindTextureUnit(4, card->lobe_atlas.id);
    glBindTextureUnit(5, card->gain_atlas.id);
    tl_card_dispatch_listed(card, &card->ratios, CARD_WORK_OF_32);
    return true;
}

/* ---- Pixels ---- */

/* The places of a sun that a pixel traces: at first, and in a penumbra. */
#define PLACES_FIRST 4
#define PLACES       9

static void fit_layers(tl_graphics_card *card, tl_texture *texture, int layers)
{
    const int32_t *size = card->frame.size;
    if (texture->width == size[0] && texture->height == size[1] && texture->layers == layers)
        return;
    tl_texture_destroy(texture);
    if (layers > 0)
        *texture = tl_texture_create(card->gpu, GL_TEXTURE_2D_ARRAY, GL_R8, size[0], size[1], layers, 1);
}

bool tl_card_trace_suns(tl_graphics_card *card, tl_error *error)
{
    const int32_t *size = card->frame.size;
    const int columns = (size[0] + 2) / 4 + 1,
              rows = (size[1] + 2) / 4 + 1; /* every fourth pixel, and the last */
    if (!tl_card_send_frame(card, error))
        return false;
    tl_card_fit_texture(card, &card->coarse, GL_R8UI, columns, rows);
    for (int i = 0; i < card->layers * card->frame.counts[1]; i++) {
        const int layer = i / card->frame.counts[1], sun = i % card->frame.counts[1];
        const bool is_lamp = card->frame.suns[sun][3] < 0;
        fit_layers(card, &card->sun_seen[layer], card->frame.counts[1]);
        glBindTextureUnit(0, card->ids[layer].id);
        glUseProgram(card->sun_coarse.id);
        glUniform1i(0, sun);
        glBindImageTexture(0, card->coarse.id, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R8UI);
        tl_gpu_dispatch(tl_gpu_groups((size_t)columns, 8), tl_gpu_groups((size_t)rows, 8), 1);
        tl_gpu_barrier();
        glUseProgram(card->sun_fine.id);
        glUniform1i(0, sun);
        glUniform2ui(1, is_lamp ? 1 : PLACES_FIRST, is_lamp ? 1 : PLACES);
        glBindTextureUnit(1, card->coarse.id);
        glBindImageTexture(0, card->sun_seen[layer].id, 0, GL_FALSE, sun, GL_WRITE_ONLY, GL_R8);
        tl_gpu_dispatch((unsigned)size[2], (unsigned)size[3], 1);
        tl_gpu_barrier();
    }
    return true;
}

/* Binds one texel of nothing where a class has no map. */
void tl_card_bind_class(tl_graphics_card *card, const struct tl_card_class *class)
{
    static const unsigned units[TL_CARD_MAPS] = {10, 11, 12, 13, 14, 15, 1, 2, 3, 5}; /* as card_maps.glsl */
    tl_card_fit_texture(card, &card->no_map, GL_RGBA16F, 1, 1);
    for (int i = 0; i < TL_CARD_MAPS; i++)
        glBindTextureUnit(units[i], class->maps[i].id != 0 ? class->maps[i].id : card->no_map.id);
    tl_buffer_bind(&class->firsts, CARD_BORDER_FIRSTS);
    tl_buffer_bind(&class->near, CARD_BORDER_NEAR);
    tl_buffer_bind(&class->borders, CARD_BORDERS);
    tl_buffer_bind(&class->profiles, CARD_PROFILES);
    tl_buffer_bind(&class->yarns, CARD_YARNS);
}

void tl_card_resolve(tl_graphics_card *card, const tl_texture *samples, const tl_texture *image, int before)
{
    glUseProgram(card->resolve.id);
    glUniform1i(0, samples->width / image->width);
    glUniform1i(1, before);
    glBindTextureUnit(0, samples->id);
    glBindImageTexture(0, image->id, 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA32F);
    tl_gpu_dispatch(tl_gpu_groups((size_t)image->width, 8), tl_gpu_groups((size_t)image->height, 8), 1);
    tl_gpu_barrier();
}

/* Layers behind the first add to what it leaves. */
static void shade_layer(tl_graphics_card *card, int layer)
{
    const int tiles = card->frame.size[2] * card->frame.size[3];
    if (card->layers > 1)
        list_tiles(card, layer);
    glBindTextureUnit(0, card->ids[layer].id);
    glBindTextureUnit(6, card->sun_seen[layer].id);
    for (int i = layer > 0 ? 1 : 0; i < card->class_count; i++) {
        glUseProgram(i == 0 ? card->shade_nothing.id : i == 1 ? card->shade_plain.id : card->shade_rich.id);
        if (i > 1)
            tl_card_bind_class(card, &card->classes[i]);
        glUniform3i(0, i, i * tiles, layer);
        tl_gpu_dispatch_indirect(&card->buffers[CARD_WORK], sizeof(uint32_t) * 4 * (size_t)i);
    }
    tl_gpu_barrier();
}

bool tl_card_shade(tl_graphics_card *card, const tl_texture *image, int before, tl_error *error)
{
    if (!tl_card_send_frame(card, error))
        return false;
    glBindTextureUnit(4, card->lobe_atlas.id);
    tl_card_fit_texture(card, &card->no_map, GL_RGBA16F, 1, 1);
    tl_card_fit_texture(card, &card->light, GL_RGBA16F, card->frame.size[0], card->frame.size[1]);
    glBindImageTexture(0, card->light.id, 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA16F);
    for (int layer = 0; layer < card->layers; layer++)
        shade_layer(card, layer);
    tl_card_resolve(card, &card->light, image, before);
    return true;
}
