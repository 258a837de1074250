#include "render/card/card_internal.h"

#include "config/base/memory.h"
#include "render/gbuffer/rings.h"
#include "render/visibility/cache_probes.h"

#include <stdlib.h>
#include <string.h>

/* Numbers of vertices and probes through all surfaces. */
struct layout {
    const struct tl_triangle_ranges *ranges;
    uint32_t *first;    /* [surfaces + 1]: vertex 0 of each among all */
    size_t ground;      /* the number of its surface; that of all surfaces: there is none */
    uint32_t *probe_of; /* [vertices][front, back] */
};

static struct layout lay_out(const tl_graphics_card *card, const struct tl_card_surfaces *request)
{
    const struct tl_triangle_ranges *ranges = request->ranges;
    const size_t surfaces = ranges->surface_count;
    struct layout layout = {.ranges = ranges,
                            .first = TL_NEW_ARRAY(uint32_t, surfaces + 1),
                            .ground = request->ground ? surfaces - 1 : surfaces,
                            .probe_of = TL_NEW_ARRAY(uint32_t, card->points.probe_count)};
    for (size_t s = 0; s < surfaces; s++)
        layout.first[s + 1] = layout.first[s] + (uint32_t)ranges->surfaces[s]->vertex_count;
    for (size_t p = 0; p < card->points.probe_count; p++) {
        const struct tl_cache_probe *probe = &card->points.items[p];
        layout.probe_of[2 * (layout.first[probe->surface] + probe->vertex) + probe->back] = (uint32_t)p;
    }
    return layout;
}

static void release_layout(struct layout *layout)
{
    free(layout->first);
    free(layout->probe_of);
}

static bool send(tl_graphics_card *card, int binding, const void *data, size_t bytes, tl_error *error)
{
    return tl_buffer_fill(&card->buffers[binding], card->gpu, data, bytes, error);
}

/* Sends from which probes others take bounced light. */
static bool send_origins(tl_graphics_card *card, const struct layout *layout, tl_error *error)
{
    const size_t count = card->points.probe_count, surfaces = layout->ranges->surface_count;
    const size_t ground_vertices =
        layout->ground < surfaces ? layout->ranges->surfaces[layout->ground]->vertex_count : 0;
    uint32_t *from = TL_NEW_ARRAY(uint32_t, 4 * count);
    uint32_t *own = TL_NEW_ARRAY(uint32_t, count + ground_vertices);
    float *shares = TL_NEW_ARRAY(float, 4 * count);
    card->own_count = 0;
    for (size_t p = 0; p < count; p++) {
        const struct tl_cache_probe *probe = &card->points.items[p];
        const tl_surface *surface = layout->ranges->surfaces[probe->surface];
        const bool is_own = tl_has_own_light(surface, probe->vertex);
        const size_t other = 2 * (layout->first[probe->surface] + (size_t)probe->vertex) + !probe->back;
        from[4 * p + 3] = (is_own ? 1u : 0u) | layout->probe_of[other] << 1;
        for (size_t k = 0; k < 3; k++) {
            const uint32_t vertex = is_own ? probe->vertex : surface->light_mesh->from[probe->vertex][k];
            from[4 * p + k] = layout->probe_of[2 * (layout->first[probe->surface] + vertex) + probe->back];
            shares[4 * p + k] = is_own ? (float)(k == 0) : surface->light_mesh->shares[probe->vertex][k];
        }
        if (is_own && !(probe->surface == layout->ground && probe->back))
            own[card->own_count++] = (uint32_t)p;
    }
    for (size_t v = 0; v < ground_vertices; v++)
        own[card->own_count + v] = layout->probe_of[2 * (layout->first[layout->ground] + v)];
    bool fine = send(card, CARD_FROM, from, 4 * count * sizeof *from, error) &&
                send(card, CARD_SHARES, shares, 4 * count * sizeof *shares, error) &&
                send(card, CARD_OWN, own, (card->own_count + ground_vertices) * sizeof *own, error);
    free(from);
    free(shares);
    free(own);
    return fine;
}

static bool send_rings(tl_graphics_card *card, const struct layout *layout, tl_error *error)
{
    struct tl_vertex_rings rings = tl_vertex_rings_make(layout->ranges);
    const size_t probes = card->points.probe_count;
    size_t all = 0, at = probes + 1;
    for (size_t v = 0; v < rings.vertex_count; v++)
        all += rings.counts[v];
    uint32_t *numbers = TL_NEW_ARRAY(uint32_t, probes + 1 + 2 * all);
    for (size_t p = 0; p < probes; p++) {
        const struct tl_cache_probe *probe = &card->points.items[p];
        const size_t v = layout->first[probe->surface] + probe->vertex;
        numbers[p] = (uint32_t)at;
        for (uint32_t i = 0; i < rings.counts[v]; i++)
            numbers[at++] = layout->probe_of[2 * (size_t)rings.neighbours[rings.first[v] + i] + probe->back];
    }
    numbers[probes] = (uint32_t)at;
    bool fine = send(card, CARD_RINGS, numbers, at * sizeof *numbers, error);
    tl_vertex_rings_release(&rings);
    free(numbers);
    return fine;
}

/* Gathers one attribute of all vertices; that of surfaces without it is 0. */
#define GATHER(ranges_of, member, to)                                                                        \
    do {                                                                                                     \
        size_t at = 0;                                                                                       \
        for (size_t s = 0; s < (ranges_of)->surface_count; s++) {                                            \
            const tl_surface *surface = (ranges_of)->surfaces[s];                                            \
            if (surface->member)                                                                             \
                memcpy((to) + at, surface->member, surface->vertex_count * sizeof *(to));                    \
            at += surface->vertex_count;                                                                     \
        }                                                                                                    \
    } while (0)

static bool send_uvs(tl_graphics_card *card, const struct tl_triangle_ranges *ranges, tl_error *error)
{
    vec2s *uvs = TL_NEW_ARRAY(vec2s, card->points.vertex_count);
    GATHER(ranges, uvs, uvs);
    bool fine = send(card, CARD_UVS, uvs, card->points.vertex_count * sizeof *uvs, error);
    free(uvs);
    return fine;
}

static bool send_tangents(tl_graphics_card *card, const struct tl_triangle_ranges *ranges, tl_error *error)
{
    vec4s *tangents = TL_NEW_ARRAY(vec4s, card->points.vertex_count);
    GATHER(ranges, tangents, tangents);
    bool fine = send(card, CARD_TANGENTS, tangents, card->points.vertex_count * sizeof *tangents, error);
    free(tangents);
    return fine;
}

static bool send_shapes(tl_graphics_card *card, const struct tl_card_surfaces *request, tl_error *error)
{
    struct layout layout = lay_out(card, request);
    card->traced_triangles = request->ranges->first[layout.ground];
    bool fine =
        send_origins(card, &layout, error) && send_rings(card, &layout, error) &&
        send_uvs(card, request->ranges, error) && tl_card_send_materials(card, request, error) &&
        tl_buffer_reserve(&card->buffers[CARD_RATIOS], card->gpu, 64 * card->points.probe_count, error) &&
        /* ratios read it even when nothing bounces */
        tl_buffer_reserve(&card->buffers[CARD_BOUNCED], card->gpu, 16, error) &&
        tl_buffer_reserve(&card->buffers[CARD_WORK], card->gpu, (size_t)4 * CARD_WORDS, error);
    release_layout(&layout);
    return fine;
}

bool tl_card_send_surfaces(tl_graphics_card *card, const struct tl_card_surfaces *request, tl_error *error)
{
    const bool is_new = !card->have_shapes || card->shapes_revision != request->shapes_revision;
    if (!tl_card_make_programs(card, error) ||
        !tl_card_points_follow(&card->points, card->gpu, request->ranges, request->ground,
                               request->shapes_revision, error) ||
        !send_tangents(card, request->ranges, error))
        return false;
    if (is_new) {
        card->have_shapes = send_shapes(card, request, error);
        card->shapes_revision = request->shapes_revision;
        card->bounce_frames = 0;
    }
    struct tl_card_frame *frame = &card->frame;
    frame->eye[3] = card->points.offset_m;
    frame->counts[2] = (int32_t)card->points.probe_count;
    frame->counts[3] = (int32_t)card->points.triangle_count;
    frame->numbers[0] = (uint32_t)card->own_count;
    frame->numbers[2] = (uint32_t)card->traced_triangles;
    tl_card_put(frame->disc, request->ground ? request->ground->centre : glms_vec3_zero(),
                request->ground ? request->ground->radius : 0);
    return card->have_shapes;
}
