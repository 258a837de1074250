#include "cloth/cage/follower.h"

#include "cloth/cage/patches.h"
#include "cloth/cage/simplicial.h"
#include "cloth/cage/skin.h"
#include "cloth/contact/contact.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* The depth below a vertex from which a body's surface is queried. */
#define NEAR_M 0.005

/* A vertex stays above a body by this share of the height of the cage's nearest vertex, so that layers keep
 * their order there: by 1 mm where the cage lies on the body. */
#define HEIGHT_SHARE (1.0 / 3)

/* Rounds in which crossings are removed. The first ones halve the way from the cage of what crosses, the
 * others end it, and send to its corners what crosses on the cage. Four to twelve are enough where a dress of
 * 121,000 vertices is blown or pulled; after the last one all of the mesh goes to its corners. */
enum { ROUNDS = 40, HALVING_ROUNDS = 4 };

/* The share of its way from the cage, and of that from its corner, that a vertex takes back in a frame. */
#define RETURN 0.1

struct tl_follower {
    const struct tl_cage *cage;
    const struct tl_topology *topology;
    struct tl_fans fans; /* corners of the cage's triangles around each of its vertices */
    struct tl_skin skin;
    uint32_t *corners; /* [topology's vertex_count] the corner of the cage that a vertex becomes */
    struct tl_patches patches;
    vec3d *made;         /* [cage's vertex_count] at the start */
    vec3d *from;         /* [topology's vertex_count] the same */
    double *lost;        /* [cage's vertex_count] share of the way from the cage that is left out */
    double *gone;        /* [topology's vertex_count] share of the way to its corner that a vertex has gone */
    bool *raised;        /* [cage's vertex_count] it was, in this round */
    bool *changed;       /* [cage's triangle_count] one of its bones' was */
    bool *bent;          /* the same: some of its bones' ways are shortened */
    size_t *first_bones; /* [cage's triangle_count + 1] of each patch, in `bones` */
    uint32_t *bones;     /* that move its triangles */
};

void tl_cage_point_shares(const struct tl_cage_point *point, double out[3])
{
    double sum = 0;
    for (int k = 0; k < 3; k++)
        sum += fmax(point->weights[k], 0);
    for (int k = 0; k < 3; k++)
        out[k] = fmax(point->weights[k], 0) / sum;
}

enum { RING = 64 };

struct tl_rigid tl_cage_motion(const struct tl_cage *cage, const struct tl_fans *fans, size_t vertex,
                               const vec3d *before, const vec3d *now)
{
    vec3s from[RING], to[RING];
    size_t count = 0;
    for (uint32_t n = fans->first[vertex]; n < fans->first[vertex + 1]; n++) {
        const uint32_t *v = cage->triangles[fans->items[n] / 3];
        for (int k = 0; k < 3 && count < RING; k++) {
            from[count] = vec3d_to_float(before[v[k]]);
            to[count++] = vec3d_to_float(now[v[k]]);
        }
    }
    return tl_rigid_fit(from, to, count);
}

/* ---- Preparation ---- */

/* Blends the vertices' motions, and maps them to corners. */
static void bind(tl_follower *follower)
{
    const struct tl_cage *cage = follower->cage;
    const struct tl_topology *topology = follower->topology;
    uint32_t(*corners)[3] = tl_alloc(topology->vertex_count, sizeof *corners);
    double(*shares)[3] = tl_alloc(topology->vertex_count, sizeof *shares);
    for (size_t i = 0; i < topology->vertex_count; i++) {
        const struct tl_cage_point *point = &cage->points[i];
        const bool has_place = point->triangle != TL_NONE;
        for (int k = 0; k < 3; k++)
            corners[i][k] = has_place ? cage->triangles[point->triangle][k] : TL_NONE;
        if (has_place)
            tl_cage_point_shares(point, shares[i]);
    }
    const struct tl_skin_source source = {.topology = topology,
                                          .bone_count = cage->vertex_count,
                                          .corners = (const uint32_t(*)[3])corners,
                                          .shares = (const double(*)[3])shares};
    const struct tl_coarse_mesh coarse = {(const uint32_t(*)[3])cage->triangles, &follower->fans};
    follower->skin = tl_skin_make(&source);
    follower->corners = TL_NEW_ARRAY(uint32_t, topology->vertex_count);
    tl_simplicial_map(&source, &coarse, follower->corners);
    free(corners);
    free(shares);
}

static struct tl_patches make_patches(const struct tl_cage *cage, const struct tl_topology *topology)
{
    uint32_t *patch_of = TL_NEW_ARRAY(uint32_t, topology->triangle_count);
    for (size_t t = 0; t < topology->triangle_count; t++) /* corners of triangles have a place */
        patch_of[t] = cage->points[topology->triangles[t][0]].triangle;
    struct tl_patches patches =
        tl_patches_make(topology, patch_of, cage->triangle_count, (const uint32_t(*)[3])cage->triangles);
    free(patch_of);
    return patches;
}

/* The bones of each patch, each once. */
static void list_bones(tl_follower *follower)
{
    const struct tl_fans *lists = &follower->patches.lists;
    const struct tl_skin *skin = &follower->skin;
    const size_t count = follower->cage->triangle_count;
    size_t *seen = TL_NEW_ARRAY(size_t, follower->cage->vertex_count), capacity = 0, listed = 0;
    follower->first_bones = TL_NEW_ARRAY(size_t, count + 1);
    for (size_t patch = 0; patch < count; patch++) {
        for (uint32_t n = 3 * lists->first[patch]; n < 3 * lists->first[patch + 1]; n++) {
            const uint32_t vertex = follower->topology->triangles[lists->items[n / 3]][n % 3];
            for (size_t k = 0; k < skin->counts[vertex]; k++) {
                const uint32_t bone = skin->bones[vertex][k];
                if (seen[bone] == patch + 1)
                    continue;
                seen[bone] = patch + 1;
                if (listed == capacity) {
                    capacity = 2 * capacity + 64;
                    follower->bones = tl_resize(follower->bones, capacity, sizeof *follower->bones);
                }
                follower->bones[listed++] = bone;
            }
        }
        follower->first_bones[patch + 1] = listed;
    }
    free(seen);
}

tl_follower *tl_follower_create(const struct tl_cage *cage, const struct tl_topology *topology)
{
    tl_follower *follower = TL_NEW(tl_follower);
    follower->cage = cage;
    follower->topology = topology;
    follower->fans =
        tl_fans_build((const uint32_t *)cage->triangles, 3 * cage->triangle_count, cage->vertex_count);
    bind(follower);
    follower->patches = make_patches(cage, topology);
    list_bones(follower);
    follower->made = TL_NEW_ARRAY(vec3d, cage->vertex_count);
    follower->from = TL_NEW_ARRAY(vec3d, topology->vertex_count);
    follower->lost = TL_NEW_ARRAY(double, cage->vertex_count);
    follower->gone = TL_NEW_ARRAY(double, topology->vertex_count);
    follower->raised = TL_NEW_ARRAY(bool, cage->vertex_count);
    follower->bent = TL_NEW_ARRAY(bool, cage->triangle_count);
    follower->changed = TL_NEW_ARRAY(bool, cage->triangle_count);
    return follower;
}

void tl_follower_destroy(tl_follower **handle)
{
    tl_follower *follower = *handle;
    if (!follower)
        return;
    tl_fans_release(&follower->fans);
    tl_skin_release(&follower->skin);
    tl_patches_release(&follower->patches);
    free(follower->made);
    free(follower->from);
    free(follower->lost);
    free(follower->gone);
    free(follower->corners);
    free(follower->raised);
    free(follower->changed);
    free(follower->bent);
    free(follower->first_bones);
    free(follower->bones);
    free(follower);
    *handle = NULL;
}

void tl_follower_start(tl_follower *follower, const vec3d *places, const vec3d *x)
{
    memcpy(follower->made, places, follower->cage->vertex_count * sizeof *places);
    memcpy(follower->from, x, follower->topology->vertex_count * sizeof *x);
    for (size_t i = 0; i < follower->cage->vertex_count; i++)
        follower->lost[i] = 0;
    for (size_t i = 0; i < follower->topology->vertex_count; i++)
        follower->gone[i] = 0;
}

/* ---- A frame ---- */

static bool is_moved(const tl_follower *follower, const struct tl_particles *particles, size_t i)
{
    return follower->skin.counts[i] > 0 && particles->w[i] > 0;
}

/* Lifts a point off the body, where the height of the nearest vertex of the cage above it leaves that
 * possible. */
static vec3d lift(const struct tl_follower_cage *cage, uint32_t nearest, vec3d x)
{
    struct tl_contact_height at;
    const struct tl_clearance *clearance = &cage->clearances[nearest];
    const vec3d up = vec3d_from(clearance->up);
    if (!cage->collider ||
        !((double)clearance->height_m + vec3d_dot(vec3d_sub(x, cage->places[nearest]), up) < NEAR_M) ||
        !tl_contacts_height_asked(cage->collider, x, &at))
        return x;
    const double kept = HEIGHT_SHARE * fmax((double)clearance->height_m, 0);
    return vec3d_muladd(x, at.up, fmax(kept - at.height_m, 0));
}

static vec3d flat_at(const tl_follower *follower, size_t i, const vec3d *places)
{
    const struct tl_cage_point *point = &follower->cage->points[i];
    double shares[3];
    vec3d sum = {0};
    tl_cage_point_shares(point, shares);
    for (int k = 0; k < 3; k++)
        sum = vec3d_muladd(sum, places[follower->cage->triangles[point->triangle][k]], shares[k]);
    return sum;
}

static double lost_at(const tl_follower *follower, size_t i)
{
    double sum = 0;
    for (size_t k = 0; k < follower->skin.counts[i]; k++)
        sum += follower->skin.weights[i][k] * follower->lost[follower->skin.bones[i][k]];
    return sum;
}

/* In its corner it is where the cage is to the bit, without a lift. */
static vec3d placed(const tl_follower *follower, const struct tl_follower_cage *cage, size_t i, vec3d way_end)
{
    const double lost = lost_at(follower, i), gone = follower->gone[i];
    const vec3d corner = cage->places[follower->corners[i]];
    if (gone == 1)
        return vec3d_as_drawn(corner);
    if (lost == 0 && gone == 0)
        return way_end;
    const vec3d at = vec3d_mix(way_end, flat_at(follower, i, cage->places), lost);
    return vec3d_as_drawn(lift(cage, follower->skin.bones[i][0], vec3d_mix(at, corner, gone)));
}

/* Places the particles between `way_ends` and the cage; its triangles may cut into the body. */
static void place(const tl_follower *follower, const struct tl_follower_cage *cage, const vec3d *way_ends,
                  struct tl_particles *particles)
{
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < particles->count; i++)
        if (is_moved(follower, particles, i))
            particles->x[i] = placed(follower, cage, i, way_ends[i]);
}

/* Whether all of a triangle lies on the cage. */
static bool is_flat(const tl_follower *follower, uint32_t triangle)
{
    bool flat = true;
    for (int k = 0; k < 3; k++) {
        const uint32_t vertex = follower->topology->triangles[triangle][k];
        for (size_t n = 0; n < follower->skin.counts[vertex]; n++)
            flat = flat && follower->lost[follower->skin.bones[vertex][n]] == 1;
    }
    return flat;
}

/* Leaves `share` of the ways of what moves a triangle. */
static void shorten(tl_follower *follower, uint32_t triangle, double share)
{
    for (int k = 0; k < 3; k++) {
        const uint32_t vertex = follower->topology->triangles[triangle][k];
        for (size_t n = 0; n < follower->skin.counts[vertex]; n++) {
            const uint32_t bone = follower->skin.bones[vertex][n];
            if (!follower->raised[bone])
                follower->lost[bone] = 1 - (1 - follower->lost[bone]) * share;
            follower->raised[bone] = true;
        }
    }
}

/* Returns whether any of a triangle was not in its corners. */
static bool send_to_corners(tl_follower *follower, uint32_t triangle)
{
    bool any = false;
    for (int k = 0; k < 3; k++) {
        const uint32_t vertex = follower->topology->triangles[triangle][k];
        if (follower->gone[vertex] == 1)
            continue;
        follower->gone[vertex] = 1;
        follower->raised[follower->skin.bones[vertex][0]] = true; /* has no way left: it is flat */
        any = true;
    }
    return any;
}

/* Moves what crosses towards the cage. Returns whether there was any way left. */
static bool move_in(tl_follower *follower, const struct tl_near_pairs *pairs, double share)
{
    bool any = false;
    memset(follower->raised, 0, follower->cage->vertex_count * sizeof *follower->raised);
    for (size_t i = 0; i < 2 * pairs->count; i++)
        if (is_flat(follower, pairs->pairs[i / 2][i % 2]))
            any = send_to_corners(follower, pairs->pairs[i / 2][i % 2]) || any;
    for (size_t i = 0; i < 2 * pairs->count; i++)
        if (!is_flat(follower, pairs->pairs[i / 2][i % 2])) {
            shorten(follower, pairs->pairs[i / 2][i % 2], share);
            any = true;
        }
    return any;
}

/* Patches whose vertices are not on their own way may be bent in their plane, and cross although they face
 * alike. */
static void mark_patches(tl_follower *follower)
{
    for (size_t patch = 0; patch < follower->cage->triangle_count; patch++) {
        follower->changed[patch] = follower->bent[patch] = false;
        for (size_t n = follower->first_bones[patch]; n < follower->first_bones[patch + 1]; n++) {
            follower->changed[patch] |= follower->raised[follower->bones[n]];
            follower->bent[patch] |= follower->lost[follower->bones[n]] > 0;
        }
    }
}

static void send_all_to_corners(tl_follower *follower)
{
    for (size_t i = 0; i < follower->topology->vertex_count; i++)
        follower->gone[i] = 1;
}

static void uncross(tl_follower *follower, const struct tl_follower_cage *cage, const vec3d *way_ends,
                    struct tl_particles *particles)
{
    struct tl_near_pairs pairs = {0};
    const struct tl_patch_marks marks = {follower->changed, follower->bent};
    int round = 0;
    mark_patches(follower);
    tl_patches_crossings(&follower->patches, follower->topology, particles->x,
                         &(struct tl_patch_marks){.bent = follower->bent}, &pairs);
    while (round < ROUNDS && pairs.count > 0 && move_in(follower, &pairs, round < HALVING_ROUNDS ? 0.5 : 0)) {
        mark_patches(follower);
        place(follower, cage, way_ends, particles);
        tl_patches_crossings(&follower->patches, follower->topology, particles->x, &marks, &pairs);
        round++;
    }
    if (round == ROUNDS && pairs.count > 0) {
        send_all_to_corners(follower);
        place(follower, cage, way_ends, particles);
    }
    tl_near_pairs_release(&pairs);
}

void tl_follower_move(tl_follower *follower, const struct tl_follower_cage *cage,
                      struct tl_particles *particles)
{
    const size_t bone_count = follower->cage->vertex_count;
    struct tl_rigid *motions = tl_alloc(bone_count, sizeof *motions);
    vec3d *way_ends = TL_NEW_ARRAY(vec3d, particles->count);
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < bone_count; i++) {
        motions[i] = tl_cage_motion(follower->cage, &follower->fans, i, follower->made, cage->places);
        follower->lost[i] = fmax(follower->lost[i] - RETURN, 0);
    }
    for (size_t i = 0; i < particles->count; i++)
        follower->gone[i] = fmax(follower->gone[i] - RETURN, 0);
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < particles->count; i++)
        if (is_moved(follower, particles, i))
            way_ends[i] = vec3d_as_drawn(lift(cage, follower->skin.bones[i][0],
                                              tl_skin_point(&follower->skin, i, motions, follower->from[i])));
    place(follower, cage, way_ends, particles);
    if (cage->self_contact)
        uncross(follower, cage, way_ends, particles);
    free(way_ends);
    free(motions);
}
