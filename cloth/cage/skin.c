#include "cloth/cage/skin.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The standard deviation at which diffusion ends, in edge lengths of the coarse mesh. Normals of a plane bent
 * onto a cylinder then are the most even with 8 bones: within 0.015; 0.055 without diffusion, 0.019 with
 * 0.25, 0.016 with 0.35 and 0.038 with 0.45, whose smaller weights are missed. */
#define WIDTH 0.3

/* One round mixes this share of its neighbours' mean into a vertex. */
#define MIXED 0.7

/* Diffused weights are computed this many standard deviations far from where they were. */
#define REACH 2.5

/* The edges around each vertex. */
struct rings {
    struct tl_fans fans; /* items: ends of edges, 2 e + side */
    const uint32_t (*edges)[2];
};

static uint32_t neighbour_at(const struct rings *rings, uint32_t item)
{
    return rings->edges[item / 2][1 - item % 2];
}

/* The vertices that a bone's weights spread over: vertices, by number of rounds from where they were not 0.
 */
struct weight_patch {
    uint32_t *slots;    /* [vertex_count] of the vertices in the patch, plus 1; else 0 */
    uint32_t *vertices; /* [slot] */
    double *now, *next; /* [slot] weights */
    size_t count;
};

static void add(struct weight_patch *patch, uint32_t vertex, double weight)
{
    if (patch->slots[vertex] == 0) {
        patch->vertices[patch->count] = vertex;
        patch->now[patch->count] = 0;
        patch->slots[vertex] = (uint32_t)++patch->count;
    }
    patch->now[patch->slots[vertex] - 1] += weight;
}

static void widen(struct weight_patch *patch, const struct rings *rings, size_t rounds)
{
    size_t begin = 0;
    for (size_t round = 0; round < rounds; round++) {
        const size_t end = patch->count;
        for (size_t i = begin; i < end; i++) {
            const uint32_t v = patch->vertices[i];
            for (uint32_t n = rings->fans.first[v]; n < rings->fans.first[v + 1]; n++)
                add(patch, neighbour_at(rings, rings->fans.items[n]), 0);
        }
        begin = end;
    }
}

static void diffuse(struct weight_patch *patch, const struct rings *rings)
{
    for (size_t i = 0; i < patch->count; i++) {
        const uint32_t v = patch->vertices[i], first = rings->fans.first[v], end = rings->fans.first[v + 1];
        double sum = 0;
        for (uint32_t n = first; n < end; n++) {
            const uint32_t slot = patch->slots[neighbour_at(rings, rings->fans.items[n])];
            sum += slot > 0 ? patch->now[slot - 1] : 0;
        }
        patch->next[i] = (1 - MIXED) * patch->now[i] + (end > first ? MIXED * sum / (end - first) : 0);
    }
    double *swapped = patch->now;
    patch->now = patch->next;
    patch->next = swapped;
}

static void clear(struct weight_patch *patch)
{
    for (size_t i = 0; i < patch->count; i++)
        patch->slots[patch->vertices[i]] = 0;
    patch->count = 0;
}

struct bone_weights {
    size_t count;
    uint32_t *vertices;
    float *weights;
};

struct spread {
    size_t rounds, reach; /* of diffusion, and of edges that it passes */
};

/* A round moves a weight by the square root of MIXED / 2 edges along each axis. */
static struct spread spread_of(const struct tl_skin_source *source)
{
    const double edges = sqrt((double)source->topology->vertex_count / (double)source->bone_count);
    const double deviation = WIDTH * edges;
    return (struct spread){.rounds = (size_t)ceil(deviation * deviation * 2 / MIXED),
                           .reach = (size_t)ceil(REACH * deviation)};
}

/* `lists`: the vertices of each bone's triangles. */
static struct bone_weights spread_bone(const struct tl_skin_source *source, const struct rings *rings,
                                       const struct tl_fans *lists, uint32_t bone, struct weight_patch *patch)
{
    const struct spread spread = spread_of(source);
    for (uint32_t n = lists->first[bone]; n < lists->first[bone + 1]; n++)
        add(patch, lists->items[n] / 3, source->shares[lists->items[n] / 3][lists->items[n] % 3]);
    widen(patch, rings, spread.reach);
    for (size_t round = 0; round < spread.rounds; round++)
        diffuse(patch, rings);
    struct bone_weights column = {.count = patch->count,
                                  .vertices = TL_NEW_ARRAY(uint32_t, patch->count),
                                  .weights = TL_NEW_ARRAY(float, patch->count)};
    memcpy(column.vertices, patch->vertices, patch->count * sizeof *column.vertices);
    for (size_t i = 0; i < patch->count; i++)
        column.weights[i] = (float)patch->now[i];
    clear(patch);
    return column;
}

/* Puts a weight into a list of TL_SKIN_BONES + 1 that falls; equal ones stay in the order of their bones. */
static void insert(uint32_t *bones, double *weights, uint32_t bone, double weight)
{
    size_t at = TL_SKIN_BONES + 1;
    while (at > 0 && weight > weights[at - 1])
        at--;
    for (size_t i = TL_SKIN_BONES; i > at; i--) {
        bones[i] = bones[i - 1];
        weights[i] = weights[i - 1];
    }
    if (at <= TL_SKIN_BONES) {
        bones[at] = bone;
        weights[at] = weight;
    }
}

/* Takes the largest weights of a vertex, of `count` in the order of their bones. */
static void take_largest(const uint32_t *all, const float *of_all, size_t count, struct tl_skin *skin,
                         size_t vertex)
{
    uint32_t bones[TL_SKIN_BONES + 1];
    double weights[TL_SKIN_BONES + 1] = {0}, sum = 0;
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        insert(bones, weights, all[i], (double)of_all[i]);
    const double next = weights[0] > weights[TL_SKIN_BONES] ? weights[TL_SKIN_BONES] : 0;
    for (size_t i = 0; i < TL_SKIN_BONES && weights[i] > next; i++, kept++)
        sum += weights[i] - next;
    for (size_t i = 0; i < kept; i++) {
        skin->bones[vertex][i] = bones[i];
        skin->weights[vertex][i] = (weights[i] - next) / sum;
    }
    skin->counts[vertex] = (uint8_t)kept;
}

/* Turns the bones' columns into the vertices' rows. */
static void take_rows(const struct bone_weights *columns, size_t bone_count, struct tl_skin *skin)
{
    size_t *first = TL_NEW_ARRAY(size_t, skin->vertex_count + 2);
    for (size_t b = 0; b < bone_count; b++)
        for (size_t i = 0; i < columns[b].count; i++)
            first[columns[b].vertices[i] + 2]++;
    for (size_t v = 0; v < skin->vertex_count; v++)
        first[v + 2] += first[v + 1];
    uint32_t *bones = TL_NEW_ARRAY(uint32_t, first[skin->vertex_count + 1]);
    float *weights = TL_NEW_ARRAY(float, first[skin->vertex_count + 1]);
    for (size_t b = 0; b < bone_count; b++)
        for (size_t i = 0; i < columns[b].count; i++) {
            const size_t at = first[columns[b].vertices[i] + 1]++;
            bones[at] = (uint32_t)b;
            weights[at] = columns[b].weights[i];
        }
#pragma omp parallel for schedule(static)
    for (size_t v = 0; v < skin->vertex_count; v++)
        take_largest(bones + first[v], weights + first[v], first[v + 1] - first[v], skin, v);
    free(bones);
    free(weights);
    free(first);
}

static struct weight_patch make_patch(size_t vertex_count)
{
    return (struct weight_patch){.slots = TL_NEW_ARRAY(uint32_t, vertex_count),
                                 .vertices = TL_NEW_ARRAY(uint32_t, vertex_count),
                                 .now = TL_NEW_ARRAY(double, vertex_count),
                                 .next = TL_NEW_ARRAY(double, vertex_count)};
}

static void release_patch(struct weight_patch *patch)
{
    free(patch->slots);
    free(patch->vertices);
    free(patch->now);
    free(patch->next);
}

/* The places in `corners` at which each bone stands. */
static struct tl_fans list_places(const struct tl_skin_source *source)
{
    const size_t count = source->topology->vertex_count;
    uint32_t *corners = TL_NEW_ARRAY(uint32_t, 3 * count);
    for (size_t i = 0; i < 3 * count; i++) /* one bone more has those without a place */
        corners[i] = source->corners[i / 3][0] == TL_NONE ? (uint32_t)source->bone_count
                                                          : source->corners[i / 3][i % 3];
    struct tl_fans lists = tl_fans_build(corners, 3 * count, source->bone_count + 1);
    free(corners);
    return lists;
}

struct tl_skin tl_skin_make(const struct tl_skin_source *source)
{
    const struct tl_topology *topology = source->topology;
    const size_t count = topology->vertex_count;
    struct tl_skin skin = {.vertex_count = count,
                           .counts = TL_NEW_ARRAY(uint8_t, count),
                           .bones = tl_alloc(count, sizeof *skin.bones),
                           .weights = tl_alloc(count, sizeof *skin.weights)};
    const uint32_t(*edges)[2] = (const uint32_t(*)[2])topology->edges;
    struct rings rings = {tl_fans_build((const uint32_t *)edges, 2 * topology->edge_count, count), edges};
    struct tl_fans lists = list_places(source);
    struct bone_weights *columns = TL_NEW_ARRAY(struct bone_weights, source->bone_count);
#pragma omp parallel
    {
        struct weight_patch patch = make_patch(count);
#pragma omp for schedule(dynamic, 16)
        for (size_t b = 0; b < source->bone_count; b++)
            columns[b] = spread_bone(source, &rings, &lists, (uint32_t)b, &patch);
        release_patch(&patch);
    }
    take_rows(columns, source->bone_count, &skin);
    for (size_t b = 0; b < source->bone_count; b++) {
        free(columns[b].vertices);
        free(columns[b].weights);
    }
    free(columns);
    tl_fans_release(&lists);
    tl_fans_release(&rings.fans);
    return skin;
}

void tl_skin_release(struct tl_skin *skin)
{
    free(skin->counts);
    free(skin->bones);
    free(skin->weights);
    *skin = (struct tl_skin){0};
}

vec3d tl_skin_point(const struct tl_skin *skin, size_t vertex, const struct tl_rigid *motions, vec3d from)
{
    vec3d sum = {0};
    for (size_t i = 0; i < skin->counts[vertex]; i++)
        sum = vec3d_muladd(sum, tl_rigid_point(&motions[skin->bones[vertex][i]], from),
                           skin->weights[vertex][i]);
    return sum;
}
