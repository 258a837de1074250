#include "render/bounce/bounce_internal.h"

#include "config/base/memory.h"

#include <stdlib.h>

/* Factor by which fewer of the vertices that only rays have hit are traced in motion.
 */
#define HIT_SHARES 4
/* At rest every N-th vertex is traced in each update; N: */
#define REST_SHARES 8
/* Updates of a new scene before its first: until what rays hit is known itself. */
#define FIRST_UPDATES 4
/* A vertex that was neither seen nor hit for so many updates is traced no more. */
#define FORGET 32

/* ---- Following the scene ---- */

static void free_vertices(struct tl_bounce *bounce)
{
    free(bounce->first_vertex);
    free(bounce->first_part);
    free(bounce->materials);
    free(bounce->parts);
    free(bounce->found);
    free(bounce->shown);
    free(bounce->sky_lit);
    free(bounce->point_lit);
    free(bounce->sent);
    free(bounce->states);
    free(bounce->wanted);
    free(bounce->seen);
    tl_vertex_rings_release(&bounce->rings);
}

static void note_parts(struct tl_bounce *bounce, const struct tl_triangle_ranges *ranges)
{
    for (size_t s = 0; s < ranges->surface_count; s++) {
        const tl_surface *surface = ranges->surfaces[s];
        for (size_t p = 0; p < surface->part_count; p++) {
            const struct tl_mesh_part *part = &surface->parts[p];
            for (size_t i = part->first_index; i < part->first_index + part->index_count; i++)
                bounce->parts[bounce->first_vertex[s] + surface->indices[i]] =
                    (uint32_t)(bounce->first_part[s] + p);
        }
    }
}

static void follow_shapes(struct tl_bounce *bounce, const struct tl_bounce_request *request)
{
    const struct tl_triangle_ranges *ranges = request->ranges;
    if (bounce->first_vertex && bounce->shapes_revision == request->shapes_revision)
        return;
    free_vertices(bounce);
    bounce->shapes_revision = request->shapes_revision;
    bounce->surface_count = ranges->surface_count;
    bounce->first_vertex = TL_NEW_ARRAY(size_t, ranges->surface_count + 1);
    bounce->first_part = TL_NEW_ARRAY(size_t, ranges->surface_count + 1);
    for (size_t s = 0; s < ranges->surface_count; s++) {
        bounce->first_vertex[s + 1] = bounce->first_vertex[s] + ranges->surfaces[s]->vertex_count;
        bounce->first_part[s + 1] = bounce->first_part[s] + ranges->surfaces[s]->part_count;
    }
    bounce->vertex_count = bounce->first_vertex[ranges->surface_count];
    size_t count = 2 * bounce->vertex_count;
    bounce->materials = tl_bounce_materials_read(ranges);
    bounce->parts = TL_NEW_ARRAY(uint32_t, bounce->vertex_count);
    bounce->found = TL_NEW_ARRAY(struct tl_bounced, count);
    bounce->shown = TL_NEW_ARRAY(struct tl_bounced, count);
    bounce->sky_lit = TL_NEW_ARRAY(vec3s, count);
    bounce->point_lit = TL_NEW_ARRAY(vec3s, count);
    bounce->sent = TL_NEW_ARRAY(vec3s, count);
    bounce->states = TL_NEW_ARRAY(uint8_t, count);
    bounce->wanted = TL_NEW_ARRAY(uint32_t, count);
    bounce->seen = TL_NEW_ARRAY(uint32_t, count);
    bounce->rings = tl_vertex_rings_make(ranges);
    bounce->update = 0;
    note_parts(bounce, ranges);
}

/* ---- Selection of vertices ---- */

/* Parts that let light through are lit from both sides. */
static void want_vertex(struct tl_bounce *bounce, size_t vertex, bool back)
{
    /* Threads may want one vertex at once: they write the same. */
    __atomic_store_n(&bounce->wanted[2 * vertex + back], bounce->update, __ATOMIC_RELAXED);
    if (glms_vec3_max(bounce->materials[bounce->parts[vertex]].transmission) > 0)
        __atomic_store_n(&bounce->wanted[2 * vertex + !back], bounce->update, __ATOMIC_RELAXED);
}

void tl_bounce_want(struct tl_bounce *bounce, const struct tl_triangle_ranges *ranges, size_t surface,
                    const uint32_t corners[3], bool back)
{
    const size_t first = bounce->first_vertex[surface];
    for (int k = 0; k < 3; k++) {
        const uint32_t *from = tl_light_from(ranges->surfaces[surface], &corners[k]);
        for (int j = 0; j < (from == &corners[k] ? 1 : 3); j++)
            want_vertex(bounce, first + from[j], back);
    }
}

/* Vertices that the camera sees. */
static void want_triangle(struct tl_bounce *bounce, const struct tl_triangle_ranges *ranges,
                          uint32_t triangle)
{
    uint32_t corners[3];
    size_t surface;
    bool back = triangle & TL_SAMPLE_BACK;
    tl_triangle_find(ranges, triangle & ~TL_SAMPLE_BACK, corners, &surface);
    tl_bounce_want(bounce, ranges, surface, corners, back);
    for (int k = 0; k < 3; k++) {
        const size_t first = bounce->first_vertex[surface];
        const uint32_t *from = tl_light_from(ranges->surfaces[surface], &corners[k]);
        bounce->seen[2 * (first + corners[k]) + back] = bounce->update;
        for (int j = 0; j < (from == &corners[k] ? 1 : 3); j++)
            bounce->seen[2 * (first + from[j]) + back] = bounce->update;
    }
}

static void want_seen(struct tl_bounce *bounce, const struct tl_bounce_request *request)
{
    const struct tl_samples *samples = request->samples;
    for (size_t i = 0; samples && i < samples->count; i++)
        if (i == 0 || samples->items[i].triangle != samples->items[i - 1].triangle)
            want_triangle(bounce, request->ranges, samples->items[i].triangle);
    for (size_t i = 0; !samples && i < request->seen_count; i++)
        want_triangle(bounce, request->ranges, request->seen[i]);
}

/* ---- Updates ---- */

struct probe {
    uint32_t surface, vertex;
    bool back;
};

static bool is_due(const struct tl_bounce *bounce, const struct tl_bounce_request *request, size_t at)
{
    if (bounce->wanted[at] == 0 || bounce->update - bounce->wanted[at] > FORGET)
        return false;
    if (bounce->states[at] == TL_BOUNCE_UNKNOWN)
        return true;
    bool is_hit_only = bounce->seen[at] == 0 || bounce->update - bounce->seen[at] > FORGET;
    uint32_t shares =
        request->moved ? (uint32_t)request->shares * (is_hit_only ? HIT_SHARES : 1) : REST_SHARES;
    return (request->moved || bounce->states[at] < TL_BOUNCE_LAST) &&
           (request->at_once || (at / 2 + bounce->update) % shares == 0);
}

/* Lists the vertices that are traced in this update. */
static size_t list_due(struct tl_bounce *bounce, const struct tl_bounce_request *request, struct probe *due)
{
    size_t count = 0, at = 0;
    bounce->is_done = !request->moved;
    for (size_t s = 0; s < bounce->surface_count; s++)
        for (size_t v = 0; v < bounce->first_vertex[s + 1] - bounce->first_vertex[s]; v++)
            for (int back = 0; back < 2; back++, at++) {
                if (request->moved && bounce->states[at] > TL_BOUNCE_OLD)
                    bounce->states[at] = TL_BOUNCE_OLD;
                bool lacks = bounce->wanted[at] > 0 && bounce->states[at] < TL_BOUNCE_LAST &&
                             bounce->update - bounce->wanted[at] <= FORGET;
                bounce->is_done = bounce->is_done && !lacks;
                if (is_due(bounce, request, at))
                    due[count++] = (struct probe){(uint32_t)s, (uint32_t)v, back};
            }
    return count;
}

/* Light that a side sends to all sides: of the sky and of what bounces to it by its albedo, of suns and lamps
 * its gloss as well. */
static vec3s reflected(const struct tl_bounce *bounce, const struct tl_bounce_request *request,
                       const struct tl_bounce_material *material, size_t at)
{
    vec3s soft = bounce->sky_lit[at];
    if (request->all)
        soft = glms_vec3_add(soft, bounce->found[at].arrives);
    const vec3s sent = glms_vec3_muladd(material->albedo[at % 2], soft, material->emission);
    return glms_vec3_muladd(material->whole[at % 2], bounce->point_lit[at], sent);
}

static vec3s transmitted(const struct tl_bounce *bounce, const struct tl_bounce_request *request,
                         const struct tl_bounce_material *material, size_t other)
{
    vec3s light = glms_vec3_add(bounce->sky_lit[other], bounce->point_lit[other]);
    if (request->all)
        light = glms_vec3_add(light, bounce->found[other].arrives);
    return glms_vec3_mul(material->transmission, light);
}

static enum tl_bounce_state state_after(const struct tl_bounce_request *request, enum tl_bounce_state state)
{
    const enum tl_bounce_state minimum = request->at_once ? TL_BOUNCE_FIRST : TL_BOUNCE_OLD;
    if (request->moved)
        return minimum;
    return state >= minimum ? state + 1 : request->at_once ? TL_BOUNCE_FIRST : TL_BOUNCE_MIXED;
}

/* The light that vertices send on from now on. */
static void send(struct tl_bounce *bounce, const struct tl_bounce_request *request, const struct probe *due,
                 size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const size_t vertex = bounce->first_vertex[due[i].surface] + due[i].vertex;
        const size_t at = 2 * vertex + due[i].back, other = 2 * vertex + !due[i].back;
        const struct tl_bounce_material *material = &bounce->materials[bounce->parts[vertex]];
        bounce->states[at] = (uint8_t)state_after(request, bounce->states[at]);
        bounce->sent[at] = glms_vec3_add(reflected(bounce, request, material, at),
                                         transmitted(bounce, request, material, other));
    }
}

static void update(struct tl_bounce *bounce, const struct tl_bounce_request *request)
{
    bounce->update++;
    want_seen(bounce, request);
    struct probe *due = TL_NEW_ARRAY(struct probe, 2 * bounce->vertex_count + 1);
    size_t count = list_due(bounce, request, due);
#pragma omp parallel for schedule(dynamic, 64)
    for (size_t i = 0; i < count; i++)
        tl_bounce_trace(bounce, request, due[i].surface, due[i].vertex, due[i].back);
    send(bounce, request, due, count);
    if (count > 0 || request->moved) /* in motion others are seen */
        tl_bounce_smooth(bounce, request->ranges, request->moved);
    free(due);
}

void tl_bounce_update(struct tl_bounce *bounce, const struct tl_bounce_request *request)
{
    follow_shapes(bounce, request);
    tl_bounce_sky_follow(&bounce->sky, request->cube, request->cube_revision);
    struct tl_bounce_request first = *request;
    first.moved = first.at_once = true;
    while (bounce->update < FIRST_UPDATES)
        update(bounce, &first);
    update(bounce, request);
}

void tl_bounce_release(struct tl_bounce *bounce)
{
    free_vertices(bounce);
    tl_bounce_sky_release(&bounce->sky);
    *bounce = (struct tl_bounce){0};
}

size_t tl_bounce_bytes(const struct tl_bounce *bounce)
{
    return 2 * bounce->vertex_count *
               (3 * sizeof(vec3s) + 2 * sizeof(struct tl_bounced) + sizeof(uint32_t) / 2 + sizeof(uint8_t) +
                2 * sizeof(uint32_t)) +
           tl_vertex_rings_bytes(&bounce->rings) +
           (bounce->first_vertex ? 2 * (bounce->surface_count + 1) * sizeof(size_t) : 0);
}

struct tl_bounced tl_bounced_at(const struct tl_bounce *bounce, const struct tl_triangle_ranges *ranges,
                                const tl_sample *sample)
{
    uint32_t corners[3];
    size_t surface;
    struct tl_bounced light = {0};
    tl_triangle_find(ranges, sample->triangle & ~TL_SAMPLE_BACK, corners, &surface);
    for (int k = 0; k < 3; k++) {
        size_t at =
            2 * (bounce->first_vertex[surface] + corners[k]) + (sample->triangle & TL_SAMPLE_BACK ? 1 : 0);
        tl_bounced_add_light(&light, &bounce->shown[at], sample->weights[k]);
    }
    return light;
}
