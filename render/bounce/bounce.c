#include "render/bounce/bounce_internal.h"

#include "config/memory.h"

#include <stdlib.h>
#include <string.h>

/* In motion one in SHARES of the vertices that the camera sees is traced in each update, and one in
 * HIT_SHARES of those that only rays have hit. At rest every vertex has ROUNDS updates. */
#define SHARES     8
#define HIT_SHARES 32
#define ROUNDS     2
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
    free(bounce->rounds);
    free(bounce->wanted);
    free(bounce->seen);
    free(bounce->weights);
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
    bounce->rounds = TL_NEW_ARRAY(uint16_t, count);
    bounce->wanted = TL_NEW_ARRAY(uint32_t, count);
    bounce->seen = TL_NEW_ARRAY(uint32_t, count);
    bounce->weights = TL_NEW_ARRAY(float, count);
    bounce->update = 0;
    note_parts(bounce, ranges);
}

/* ---- What is wanted ---- */

/* What lets light through is lit from both sides. */
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

/* What the camera sees. */
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
    if (bounce->rounds[at] == 0)
        return true;
    bool is_hit_only = bounce->seen[at] == 0 || bounce->update - bounce->seen[at] > FORGET;
    uint32_t shares = request->moved && is_hit_only ? HIT_SHARES : SHARES;
    return (request->moved || bounce->rounds[at] < ROUNDS) &&
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
                if (request->moved && bounce->rounds[at] > 1)
                    bounce->rounds[at] = 1;
                bool lacks = bounce->wanted[at] > 0 && bounce->rounds[at] < ROUNDS &&
                             bounce->update - bounce->wanted[at] <= FORGET;
                bounce->is_done = bounce->is_done && !lacks;
                if (is_due(bounce, request, at))
                    due[count++] = (struct probe){(uint32_t)s, (uint32_t)v, back};
            }
    return count;
}

/* Adds a corner's light to that of another. */
static void lend(struct tl_bounce *bounce, size_t to, size_t from)
{
    if (bounce->rounds[from] == 0)
        return;
    tl_bounced_add(&bounce->shown[to], &bounce->found[from], 1);
    bounce->weights[to] += 1;
}

/* Lends three vertices to each other; in motion only to what the camera sees. */
static void lend_three(struct tl_bounce *bounce, const uint32_t vertices[3], size_t first, bool seen_only)
{
    for (int k = 0; k < 3; k++) {
        const size_t a = first + 2 * (size_t)vertices[k], b = first + 2 * (size_t)vertices[(k + 1) % 3];
        if (a == b || (seen_only && bounce->seen[a] != bounce->update && bounce->seen[b] != bounce->update))
            continue;
        lend(bounce, a, b);
        lend(bounce, b, a);
    }
}

/* Neighbours are the corners of a triangle, or the vertices that one takes its light from. */
static void lend_all(struct tl_bounce *bounce, const struct tl_triangle_ranges *ranges, size_t side,
                     bool seen_only)
{
    for (size_t at = side; at < 2 * bounce->vertex_count; at += 2)
        lend(bounce, at, at);
    for (size_t s = 0; s < bounce->surface_count; s++) {
        const tl_surface *surface = ranges->surfaces[s];
        const struct tl_light_mesh *mesh = surface->light_mesh;
        const size_t first = 2 * bounce->first_vertex[s] + side;
        for (size_t v = 0; mesh && v < surface->vertex_count; v++)
            if (mesh->from[v][0] != v)
                lend_three(bounce, mesh->from[v], first, seen_only);
        for (size_t i = 0; !mesh && i < surface->index_count; i += 3)
            lend_three(bounce, surface->indices + i, first, seen_only);
    }
}

/* Means of each vertex and its neighbours: bounced light varies slowly, the noise of sixteen rays does not.
 */
static void smooth(struct tl_bounce *bounce, const struct tl_triangle_ranges *ranges, bool seen_only)
{
    const size_t count = 2 * bounce->vertex_count;
    memset(bounce->shown, 0, count * sizeof *bounce->shown);
    memset(bounce->weights, 0, count * sizeof *bounce->weights);
#pragma omp parallel for
    for (size_t side = 0; side < 2; side++)
        lend_all(bounce, ranges, side, seen_only);
#pragma omp parallel for
    for (size_t at = 0; at < count; at++) {
        struct tl_bounced mean = {0};
        if (bounce->weights[at] > 0)
            tl_bounced_add(&mean, &bounce->shown[at], 1 / bounce->weights[at]);
        bounce->shown[at] = mean;
    }
}

/* A vertex without light of its own has the mean of those from which it takes it, as far as theirs is known.
 */
static void take_mean(struct tl_bounce *bounce, const struct tl_light_mesh *mesh, size_t vertex, size_t first)
{
    const size_t at = first + 2 * vertex;
    float known = 0;
    bounce->rounds[at] = 0;
    bounce->shown[at] = (struct tl_bounced){0};
    bounce->sent[at] = (vec3s){{0, 0, 0}};
    for (int k = 0; k < 3; k++) {
        const size_t from = first + 2 * (size_t)mesh->from[vertex][k];
        known += bounce->rounds[from] > 0 ? mesh->shares[vertex][k] : 0;
    }
    for (int k = 0; k < 3 && known > 0; k++) {
        const size_t from = first + 2 * (size_t)mesh->from[vertex][k];
        const float share = bounce->rounds[from] > 0 ? mesh->shares[vertex][k] / known : 0;
        bounce->rounds[at] =
            bounce->rounds[at] > bounce->rounds[from] ? bounce->rounds[at] : bounce->rounds[from];
        tl_bounced_add(&bounce->shown[at], &bounce->shown[from], share);
        bounce->sent[at] = glms_vec3_muladds(bounce->sent[from], share, bounce->sent[at]);
    }
}

static void fill_light_meshes(struct tl_bounce *bounce, const struct tl_triangle_ranges *ranges)
{
    for (size_t s = 0; s < bounce->surface_count; s++) {
        const struct tl_light_mesh *mesh = ranges->surfaces[s]->light_mesh;
        const size_t count = mesh ? ranges->surfaces[s]->vertex_count : 0;
#pragma omp parallel for schedule(static)
        for (size_t v = 0; v < count; v++)
            for (size_t side = 0; side < 2 && mesh->from[v][0] != v; side++)
                take_mean(bounce, mesh, v, 2 * bounce->first_vertex[s] + side);
    }
}

/* What a side sends to all sides: of the sky and of what bounces to it as its albedo says, of suns and lamps
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

/* The light that vertices send on from now on. */
static void send(struct tl_bounce *bounce, const struct tl_bounce_request *request, const struct probe *due,
                 size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const size_t vertex = bounce->first_vertex[due[i].surface] + due[i].vertex;
        const size_t at = 2 * vertex + due[i].back, other = 2 * vertex + !due[i].back;
        const struct tl_bounce_material *material = &bounce->materials[bounce->parts[vertex]];
        bounce->rounds[at] = (uint16_t)(request->moved ? 1 : bounce->rounds[at] + 1);
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
    if (count > 0) {
        smooth(bounce, request->ranges, request->moved);
        fill_light_meshes(bounce, request->ranges);
    }
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
               (3 * sizeof(vec3s) + 2 * sizeof(struct tl_bounced) + sizeof(uint32_t) / 2 + sizeof(uint16_t) +
                2 * sizeof(uint32_t) + sizeof(float)) +
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
