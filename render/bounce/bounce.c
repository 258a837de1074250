#include "render/bounce/bounce.h"

#include "config/colour/srgb.h"
#include "config/memory.h"
#include "render/env/exponent.h"
#include "render/trace/spread.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rays of a vertex in an update; in motion one in SHARES of the vertices that the camera sees is traced in
 * each, and one in HIT_SHARES of those that only rays have hit. At rest every vertex has ROUNDS updates. */
#define RAYS       16
#define SHARES     8
#define HIT_SHARES 32
#define ROUNDS     4
/* Updates of a new scene before its first: until what rays hit is known itself. */
#define FIRST_UPDATES 4
/* A vertex that was neither seen nor hit for so many updates is traced no more. */
#define FORGET 32
/* Texels along a face of the coarse sky: 11 degrees each. */
#define SKY_SIZE 8

/* ---- Following the scene ---- */

static vec3s mean_colour(const struct tl_map *map, vec3s colour)
{
    const tl_image *image = map->image;
    if (!image || image->type != TL_IMAGE_U8 || image->channels < 3)
        return colour;
    const size_t most = 4096, count = (size_t)image->width * (size_t)image->height;
    const size_t step = count / most + 1;
    double sums[3] = {0};
    size_t taken = 0;
    for (size_t i = 0; i < count; i += step, taken++)
        for (int c = 0; c < 3; c++)
            sums[c] += (double)tl_srgb_to_linear(
                (float)((const uint8_t *)image->texels)[i * (size_t)image->channels + (size_t)c] / 255);
    for (int c = 0; c < 3 && taken > 0; c++)
        colour.raw[c] *= (float)(sums[c] / (double)taken);
    return colour;
}

/* Of a material that reflects more than it receives, so much: light between two of them would grow for ever.
 */
#define MOST_REFLECTED 0.98f

/* All light that a surface sends back in even light: matt, and the mean over all directions of Schlick's
 * reflectance; without what a lobe of exponent s about the mirrored view has below the horizon: 1 / (2 s + 4)
 * in the mean over views by their cosine. (At s = 1, where a view at angle a loses (1 - cos a) / 2, it is
 * 1/6; at 2, 4, 10, 30 and 100 sampling agrees within 1e-4.) */
static vec3s albedo_of(vec3s diffuse, vec3s specular, float glossiness)
{
    vec3s albedo;
    float above = 1 - 1 / (2 * tl_lobe_exponent(glossiness) + 4);
    for (int c = 0; c < 3; c++) {
        float f0 = specular.raw[c];
        float gloss = f0 > 0 ? above * (f0 + (1 - f0) / 21) : 0;
        albedo.raw[c] = fminf(diffuse.raw[c] + gloss, MOST_REFLECTED);
    }
    return albedo;
}

static void follow_materials(struct tl_bounce *bounce, const struct tl_triangle_ranges *ranges)
{
    for (size_t s = 0; s < ranges->surface_count; s++) {
        const tl_surface *surface = ranges->surfaces[s];
        for (size_t p = 0; p < surface->part_count; p++) {
            const struct tl_mesh_part *part = &surface->parts[p];
            const tl_material *material = &surface->materials[part->material];
            vec3s front =
                albedo_of(mean_colour(&material->diffuse_map, tl_material_colour(material)),
                          mean_colour(&material->specular_map, material->specular), material->glossiness);
            vec3s back = material->back.is_given ? albedo_of(material->back.diffuse, material->back.specular,
                                                             material->glossiness)
                                                 : front;
            vec3s emission = mean_colour(&material->emission_map, material->emission);
            vec3s transmission = glms_vec3_minv(
                material->transmission,
                glms_vec3_subs(glms_vec3_negate(glms_vec3_maxv(front, back)), -MOST_REFLECTED));
            for (size_t i = part->first_index; i < part->first_index + part->index_count; i++) {
                size_t v = bounce->first_vertex[s] + surface->indices[i];
                bounce->albedos[2 * v] = front;
                bounce->albedos[2 * v + 1] = back;
                bounce->emissions[2 * v] = bounce->emissions[2 * v + 1] = emission;
                bounce->transmissions[v] = transmission;
                bounce->openness[v] = material->openness;
            }
        }
    }
}

static void free_vertices(struct tl_bounce *bounce)
{
    free(bounce->first_vertex);
    free(bounce->albedos);
    free(bounce->emissions);
    free(bounce->transmissions);
    free(bounce->openness);
    free(bounce->found);
    free(bounce->shown);
    free(bounce->direct);
    free(bounce->sent);
    free(bounce->rounds);
    free(bounce->wanted);
    free(bounce->seen);
    free(bounce->weights);
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
    for (size_t s = 0; s < ranges->surface_count; s++)
        bounce->first_vertex[s + 1] = bounce->first_vertex[s] + ranges->surfaces[s]->vertex_count;
    bounce->vertex_count = bounce->first_vertex[ranges->surface_count];
    size_t count = 2 * bounce->vertex_count;
    bounce->albedos = TL_NEW_ARRAY(vec3s, count);
    bounce->emissions = TL_NEW_ARRAY(vec3s, count);
    bounce->transmissions = TL_NEW_ARRAY(vec3s, bounce->vertex_count);
    bounce->openness = TL_NEW_ARRAY(float, bounce->vertex_count);
    bounce->found = TL_NEW_ARRAY(struct tl_bounced, count);
    bounce->shown = TL_NEW_ARRAY(struct tl_bounced, count);
    bounce->direct = TL_NEW_ARRAY(vec3s, count);
    bounce->sent = TL_NEW_ARRAY(vec3s, count);
    bounce->rounds = TL_NEW_ARRAY(uint16_t, count);
    bounce->wanted = TL_NEW_ARRAY(uint32_t, count);
    bounce->seen = TL_NEW_ARRAY(uint32_t, count);
    bounce->weights = TL_NEW_ARRAY(float, count);
    bounce->update = 0;
    follow_materials(bounce, ranges);
}

static void follow_sky(struct tl_bounce *bounce, const struct tl_bounce_request *request)
{
    if (bounce->sky.texels && bounce->sky_revision == request->cube_revision)
        return;
    const tl_cube *cube = request->cube;
    tl_cube_release(&bounce->sky);
    bounce->sky = tl_cube_create(SKY_SIZE);
    bounce->sky_revision = request->cube_revision;
    float weights[SKY_SIZE * SKY_SIZE] = {0};
    for (int y = 0; y < cube->size; y++)
        for (int x = 0; x < cube->size; x++) {
            int to = y * SKY_SIZE / cube->size * SKY_SIZE + x * SKY_SIZE / cube->size;
            float angle = tl_cube_solid_angle(cube->size, x, y);
            weights[to] += angle;
            for (int face = 0; face < 6; face++)
                for (int c = 0; c < 3; c++)
                    bounce->sky.texels[3 * (face * SKY_SIZE * SKY_SIZE + to) + c] +=
                        angle * cube->texels[3 * ((face * cube->size + y) * cube->size + x) + c];
        }
    for (int i = 0; i < 6 * SKY_SIZE * SKY_SIZE; i++)
        for (int c = 0; c < 3 && weights[i % (SKY_SIZE * SKY_SIZE)] > 0; c++)
            bounce->sky.texels[3 * i + c] /= weights[i % (SKY_SIZE * SKY_SIZE)];
}

/* ---- What is wanted ---- */

/* What lets light through is lit from both sides. */
static void want_vertex(struct tl_bounce *bounce, size_t vertex, bool back)
{
    /* Threads may want one vertex at once: they write the same. */
    __atomic_store_n(&bounce->wanted[2 * vertex + back], bounce->update, __ATOMIC_RELAXED);
    if (glms_vec3_max(bounce->transmissions[vertex]) > 0)
        __atomic_store_n(&bounce->wanted[2 * vertex + !back], bounce->update, __ATOMIC_RELAXED);
}

static void want(struct tl_bounce *bounce, const struct tl_triangle_ranges *ranges, size_t surface,
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
    want(bounce, ranges, surface, corners, back);
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

/* ---- Rays ---- */

/* A direction spread by the cosine about the normal, fixed to the surface by its tangent. */
static vec3s ray_direction(vec3s normal, vec3s tangent, vec2s at)
{
    vec3s along = glms_vec3_sub(tangent, glms_vec3_scale(normal, glms_vec3_dot(normal, tangent)));
    if (!(glms_vec3_norm2(along) > 1e-6f))
        along = glms_vec3_cross(normal, fabsf(normal.x) < 0.6f ? (vec3s){{1, 0, 0}} : (vec3s){{0, 1, 0}});
    along = glms_vec3_normalize(along);
    vec3s across = glms_vec3_cross(normal, along);
    float radius = sqrtf(at.x), angle = 2 * (float)M_PI * at.y;
    vec3s direction = glms_vec3_scale(normal, sqrtf(fmaxf(1 - at.x, 1e-4f)));
    direction = glms_vec3_add(direction, glms_vec3_scale(along, radius * cosf(angle)));
    direction = glms_vec3_add(direction, glms_vec3_scale(across, radius * sinf(angle)));
    return glms_vec3_normalize(direction);
}

/* Sums over the rays of a vertex. */
struct gathered {
    int count; /* rays whose end is known */
    struct tl_bounced light;
    vec3s open, all; /* of the coarse sky */
};

static vec3s sky_towards(const struct tl_bounce *bounce, const struct tl_bounce_request *request, vec3s d)
{
    return tl_cube_sample(&bounce->sky, tl_turn_direction(d, -request->environment_yaw));
}

/* What the corners of a triangle send, between them. False where that is not known yet. */
static bool sent_from(const struct tl_bounce *bounce, size_t surface, const uint32_t corners[3], bool back,
                      const float weights[3], vec3s *sent)
{
    float known = 0;
    *sent = (vec3s){{0, 0, 0}};
    for (int k = 0; k < 3; k++) {
        size_t at = 2 * (bounce->first_vertex[surface] + corners[k]) + back;
        if (bounce->rounds[at] == 0)
            continue;
        known += weights[k];
        *sent = glms_vec3_add(*sent, glms_vec3_scale(bounce->sent[at], weights[k]));
    }
    if (!(known > 0.1f))
        return false;
    *sent = glms_vec3_divs(*sent, known);
    return true;
}

/* Adds light of a direction to the sums of a vertex: of directions that are spread by the cosine, even light
 * has the mean direction 2/3 n, and the gradient 3/4 n. */
static void count_hit(struct tl_bounced *sum, vec3s direction, vec3s light)
{
    sum->arrives = glms_vec3_add(sum->arrives, light);
    for (int c = 0; c < 3; c++)
        sum->along[c] = glms_vec3_muladds(direction, 0.75f * 1.5f * light.raw[c], sum->along[c]);
}

/* sum += share * light. */
static void add_bounced(struct tl_bounced *sum, const struct tl_bounced *light, float share)
{
    sum->arrives = glms_vec3_muladds(light->arrives, share, sum->arrives);
    for (int c = 0; c < 3; c++)
        sum->along[c] = glms_vec3_muladds(light->along[c], share, sum->along[c]);
}

/* What a ray meets first, as far as it was not shown already. */
struct met {
    vec3s sent;
    float cover;    /* the share of the ray that ends there */
    float beyond_m; /* where the rest goes on */
    bool is_known;  /* false: the light that it sends is not known yet */
};

static struct met meet(struct tl_bounce *bounce, const struct tl_bounce_request *request, vec3s origin,
                       vec3s direction, float from_m)
{
    struct tl_trace_hit hit = tl_trace_nearest(request->trace, origin, direction, from_m,
                                               tl_ground_distance(request->ground, origin, direction));
    struct met met = {.is_known = true, .beyond_m = INFINITY};
    vec3s point;
    uint32_t triangle;
    float weights[3];
    if (hit.surface != TL_TRACE_NONE) {
        const uint32_t *corners = request->ranges->surfaces[hit.surface]->indices + 3 * (size_t)hit.triangle;
        const float shares[3] = {1 - hit.u - hit.v, hit.u, hit.v};
        want(bounce, request->ranges, hit.surface, corners, hit.back);
        met.is_known = sent_from(bounce, hit.surface, corners, hit.back, shares, &met.sent);
        met.cover = 1 - bounce->openness[bounce->first_vertex[hit.surface] + corners[0]];
        met.beyond_m = hit.distance_m + tl_trace_offset(request->trace);
    } else if (tl_ground_meet(request->ground, origin, direction, &point, &triangle, weights)) {
        const size_t last = request->ranges->surface_count - 1;
        const uint32_t *corners = request->ground->indices + 3 * (size_t)triangle;
        want(bounce, request->ranges, last, corners, false);
        met.is_known = sent_from(bounce, last, corners, false, weights, &met.sent);
        met.cover = tl_ground_cover(request->ground, point.x, point.z);
    }
    return met;
}

/* Follows one ray to its end, through open sheets: to a surface, the ground or the sky. The last sheet counts
 * as closed. */
static void follow_ray(struct tl_bounce *bounce, const struct tl_bounce_request *request, vec3s origin,
                       vec3s direction, struct gathered *sums)
{
    const vec3s sky = sky_towards(bounce, request, direction);
    vec3s sent = {{0, 0, 0}};
    float share = 1, from_m = 0;
    sums->all = glms_vec3_add(sums->all, sky);
    for (int layer = 0; layer <= TL_TRANSPARENCY_LAYERS && share > 0; layer++) {
        struct met met = meet(bounce, request, origin, direction, from_m);
        if (!met.is_known)
            return;
        if (layer == TL_TRANSPARENCY_LAYERS && met.cover > 0)
            met.cover = 1;
        sent = glms_vec3_muladds(met.sent, share * met.cover, sent);
        share *= 1 - met.cover;
        from_m = met.beyond_m;
        if (!(from_m < INFINITY))
            break;
    }
    sums->count++;
    count_hit(&sums->light, direction, sent);
    sums->open = glms_vec3_add(sums->open, glms_vec3_scale(sky, share));
}

/* The share of a ray's light that open sheets let through; 0 behind anything else. */
static float shown_to(const struct tl_bounce_request *request, vec3s origin, vec3s direction, float to_m)
{
    const struct tl_ray_packet packet = {.count = 1,
                                         .origin_x = {origin.x},
                                         .origin_y = {origin.y},
                                         .origin_z = {origin.z},
                                         .direction_x = {direction.x},
                                         .direction_y = {direction.y},
                                         .direction_z = {direction.z},
                                         .to_m = to_m};
    float shown[16];
    tl_trace_transmittance_packet(request->trace, &packet, shown);
    return shown[0];
}

static vec3s sunlight(const struct tl_bounce_request *request, vec3s origin, vec3s normal)
{
    vec3s light = {{0, 0, 0}};
    for (int i = 0; i < request->suns->count; i++) {
        const struct tl_sun *sun = &request->suns->items[i];
        vec3s direction = tl_turn_direction(sun->direction, request->environment_yaw);
        float cosine = glms_vec3_dot(normal, direction);
        if (!(cosine > 0))
            continue;
        float open = shown_to(request, origin, direction, INFINITY) *
                     tl_ground_visibility(request->ground, origin, direction);
        light = glms_vec3_add(light, glms_vec3_scale(sun->power, open * cosine / (float)M_PI));
    }
    return light;
}

static vec3s lamplight(const struct tl_bounce_request *request, vec3s origin, vec3s normal)
{
    vec3s light = {{0, 0, 0}};
    for (size_t i = 0; i < request->lamp_count; i++) {
        const struct tl_lamplight lamp = tl_lamp_at(&request->lamps[i], origin, normal);
        float cosine = glms_vec3_dot(normal, lamp.direction);
        if (!(cosine > 0))
            continue;
        float open = shown_to(request, origin, lamp.direction, lamp.distance_m) *
                     tl_ground_visibility_to(request->ground, origin, lamp.direction, lamp.distance_m);
        light = glms_vec3_add(light, glms_vec3_scale(lamp.irradiance, open * cosine / (float)M_PI));
    }
    return light;
}

static void trace_vertex(struct tl_bounce *bounce, const struct tl_bounce_request *request, size_t surface,
                         uint32_t vertex, bool back)
{
    const tl_surface *from = request->ranges->surfaces[surface];
    size_t at = 2 * (bounce->first_vertex[surface] + vertex) + back;
    const vec3s zero = {{0, 0, 0}};
    vec3s normal = glms_vec3_scale(from->normals[vertex], back ? -1.0f : 1.0f);
    vec3s tangent =
        from->tangents
            ? (vec3s){{from->tangents[vertex].x, from->tangents[vertex].y, from->tangents[vertex].z}}
            : zero;
    vec3s origin =
        glms_vec3_add(from->positions[vertex], glms_vec3_scale(normal, tl_trace_offset(request->trace)));
    uint32_t round = request->moved ? 0 : bounce->rounds[at];
    struct gathered sums = {0};
    for (uint32_t k = 0; k < RAYS; k++)
        follow_ray(bounce, request, origin,
                   ray_direction(normal, tangent, tl_spread((uint32_t)at, round * RAYS + k)), &sums);
    vec3s direct = tl_lobes_fetch(request->lobes, tl_turn_direction(normal, -request->environment_yaw),
                                  (struct tl_exponent_blend){.index = 0});
    for (int c = 0; c < 3; c++)
        direct.raw[c] *= sums.all.raw[c] > 0 ? sums.open.raw[c] / sums.all.raw[c] : 1;
    direct = glms_vec3_add(direct, sunlight(request, origin, normal));
    direct = glms_vec3_add(direct, lamplight(request, origin, normal));
    const float kept = (float)round / (float)(round + 1), added = 1 - kept;
    struct tl_bounced now = {0};
    add_bounced(&now, &bounce->found[at], kept);
    add_bounced(&now, &sums.light, sums.count > 0 ? added / (float)sums.count : 0);
    bounce->found[at] = now;
    bounce->direct[at] =
        glms_vec3_add(glms_vec3_scale(bounce->direct[at], kept), glms_vec3_scale(direct, added));
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
    add_bounced(&bounce->shown[to], &bounce->found[from], 1);
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
            add_bounced(&mean, &bounce->shown[at], 1 / bounce->weights[at]);
        bounce->shown[at] = mean;
    }
}

/* What arrives at a vertex and is sent on. */
static vec3s received(const struct tl_bounce *bounce, const struct tl_bounce_request *request, size_t at)
{
    return request->all ? glms_vec3_add(bounce->direct[at], bounce->found[at].arrives) : bounce->direct[at];
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
        add_bounced(&bounce->shown[at], &bounce->shown[from], share);
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

/* The light that vertices send on from now on. */
static void send(struct tl_bounce *bounce, const struct tl_bounce_request *request, const struct probe *due,
                 size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const size_t vertex = bounce->first_vertex[due[i].surface] + due[i].vertex;
        const size_t at = 2 * vertex + due[i].back, other = 2 * vertex + !due[i].back;
        bounce->rounds[at] = (uint16_t)(request->moved ? 1 : bounce->rounds[at] + 1);
        vec3s sent =
            glms_vec3_muladd(bounce->albedos[at], received(bounce, request, at), bounce->emissions[at]);
        bounce->sent[at] =
            glms_vec3_muladd(bounce->transmissions[vertex], received(bounce, request, other), sent);
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
        trace_vertex(bounce, request, due[i].surface, due[i].vertex, due[i].back);
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
    follow_sky(bounce, request);
    struct tl_bounce_request first = *request;
    first.moved = first.at_once = true;
    while (bounce->update < FIRST_UPDATES)
        update(bounce, &first);
    update(bounce, request);
}

void tl_bounce_release(struct tl_bounce *bounce)
{
    free_vertices(bounce);
    tl_cube_release(&bounce->sky);
    *bounce = (struct tl_bounce){0};
}

size_t tl_bounce_bytes(const struct tl_bounce *bounce)
{
    return 2 * bounce->vertex_count *
               (4 * sizeof(vec3s) + sizeof(vec3s) / 2 + sizeof(float) / 2 + 2 * sizeof(struct tl_bounced) +
                sizeof(uint16_t) + 2 * sizeof(uint32_t) + sizeof(float)) +
           (bounce->first_vertex ? (bounce->surface_count + 1) * sizeof(size_t) : 0);
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
        add_bounced(&light, &bounce->shown[at], sample->weights[k]);
    }
    return light;
}
