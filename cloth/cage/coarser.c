#include "cloth/cage/coarser.h"

#include "assets/halfmesh/halfmesh.h"
#include "cloth/build.h"
#include "cloth/cage/cage_rest.h"
#include "cloth/cage/clearance.h"
#include "cloth/cage/follower.h"
#include "cloth/mesh/rigid.h"
#include "cloth/timestep.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* A cage that keeps a larger share of the vertices is not worth its time. */
#define WORTH_SHARE 0.6

/* Two triangles have a seam between them if their common side differs, in their rest shapes, by more than
 * this share of its length. Without a pattern lengths agree, and grains turn gradually. */
#define SEAM_OF_PATTERN 0.02
#define SEAM_OF_UVS     0.2

struct tl_coarser {
    struct tl_cage cage;
    tl_garment garment; /* three vertices a triangle, as each has a rest shape of its own */
    tl_cloth *cloth;
    struct tl_fans fans;   /* corners of the cage's triangles around each of its vertices */
    vec3d *made;           /* [cage's vertex_count] where it was made */
    vec3d *offsets;        /* [cloth's particles] from the cage, where it was made */
    tl_follower *follower; /* NULL before tl_coarser_restart */
};

/* ---- The cage ---- */

/* Whether a triangle's grain is known. */
static bool has_grain(const tl_cloth *cloth, uint32_t triangle)
{
    const tl_garment *garment = cloth->garment;
    const uint32_t *v = &garment->model.mesh.indices[3 * (size_t)cloth->topology.source[triangle]];
    const vec2s *uvs = garment->model.mesh.uvs;
    return garment->pattern ||
           glms_vec2_cross(glms_vec2_sub(uvs[v[1]], uvs[v[0]]), glms_vec2_sub(uvs[v[2]], uvs[v[0]])) != 0;
}

/* The side between two vertices in a triangle's rest shape. */
static vec2s rest_side(const tl_cloth *cloth, uint32_t triangle, uint32_t from, uint32_t to)
{
    const uint32_t *v = cloth->topology.triangles[triangle];
    vec2s ends[2] = {cloth->rest[triangle][2], cloth->rest[triangle][2]};
    for (int k = 0; k < 2; k++) {
        ends[0] = v[k] == from ? cloth->rest[triangle][k] : ends[0];
        ends[1] = v[k] == to ? cloth->rest[triangle][k] : ends[1];
    }
    return glms_vec2_sub(ends[1], ends[0]);
}

static bool is_seam(const tl_cloth *cloth, uint32_t triangle, int corner)
{
    uint32_t other = cloth->topology.neighbour[triangle][corner];
    if (other == TL_NONE || !has_grain(cloth, triangle) || !has_grain(cloth, other))
        return false;
    const uint32_t *v = cloth->topology.triangles[triangle];
    vec2s here = rest_side(cloth, triangle, v[(corner + 1) % 3], v[(corner + 2) % 3]);
    vec2s there = rest_side(cloth, other, v[(corner + 1) % 3], v[(corner + 2) % 3]);
    double share = cloth->garment->pattern ? SEAM_OF_PATTERN : SEAM_OF_UVS;
    return (double)glms_vec2_distance(here, there) > share * (double)glms_vec2_norm(here);
}

static bool make_cage(const tl_cloth *cloth, size_t vertex_target, struct tl_cage *out)
{
    const struct tl_topology *topology = &cloth->topology;
    bool(*seams)[3] = tl_alloc(topology->triangle_count, sizeof *seams);
    bool *held = TL_NEW_ARRAY(bool, topology->vertex_count);
    for (uint32_t t = 0; t < topology->triangle_count; t++)
        for (int k = 0; k < 3; k++)
            seams[t][k] = is_seam(cloth, t, k);
    for (size_t i = 0; i < cloth->pin_count; i++)
        held[cloth->pins[i].particle] = true;
    const struct tl_cage_source source = {.vertex_count = topology->vertex_count,
                                          .triangle_count = topology->triangle_count,
                                          .triangles = (const uint32_t(*)[3])topology->triangles,
                                          .rest = (const float(*)[3][2])cloth->rest,
                                          .seams = (const bool(*)[3])seams,
                                          .held = held};
    bool made = tl_cage_make(&source, vertex_target, out);
    free(seams);
    free(held);
    return made;
}

/* ---- The coarser cloth ---- */

static void make_garment(tl_coarser *coarser, const tl_cloth *cloth)
{
    const struct tl_cage *cage = &coarser->cage;
    tl_mesh *mesh = &coarser->garment.model.mesh;
    coarser->garment.model.name = tl_format("cage of %zu vertices", cage->vertex_count);
    mesh->vertex_count = mesh->index_count = 3 * cage->triangle_count;
    mesh->positions = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    mesh->indices = TL_NEW_ARRAY(uint32_t, mesh->index_count);
    coarser->garment.pattern = TL_NEW_ARRAY(vec2s, mesh->vertex_count);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        const float *rest = cage->rest[i / 3][i % 3];
        uint32_t vertex = cage->vertices[cage->triangles[i / 3][i % 3]];
        mesh->indices[i] = (uint32_t)i;
        mesh->positions[i] = vec3d_to_float(cloth->made_at[vertex]);
        coarser->garment.pattern[i] = (vec2s){{rest[0], rest[1]}};
    }
}

/* The particle of the coarser cloth that a corner of the cage's triangles became. */
static uint32_t particle_of(const tl_coarser *coarser, size_t triangle, size_t corner)
{
    return coarser->cloth->topology.weld[3 * triangle + corner];
}

static void take_pins(tl_coarser *coarser, const tl_cloth *from)
{
    const struct tl_cage *cage = &coarser->cage;
    tl_cloth *cloth = coarser->cloth;
    cloth->pin_count = 0;
    uint32_t *particles = TL_NEW_ARRAY(uint32_t, from->particles.count);
    memset(particles, 0xff, from->particles.count * sizeof *particles);
    for (size_t i = 0; i < 3 * cage->triangle_count; i++)
        particles[cage->vertices[cage->triangles[i / 3][i % 3]]] = particle_of(coarser, i / 3, i % 3);
    cloth->pins = tl_resize(cloth->pins, from->pin_count, sizeof *cloth->pins);
    for (size_t i = 0; i < from->pin_count; i++) {
        struct tl_pin pin = from->pins[i];
        pin.particle = particles[pin.particle];
        if (pin.particle != TL_NONE)
            cloth->pins[cloth->pin_count++] = pin;
    }
    free(particles);
}

/* Positions of the cage's vertices, as a new array. */
static vec3d *places_of(const tl_coarser *coarser)
{
    const struct tl_cage *cage = &coarser->cage;
    vec3d *places = TL_NEW_ARRAY(vec3d, cage->vertex_count);
    for (size_t i = 0; i < 3 * cage->triangle_count; i++)
        places[cage->triangles[i / 3][i % 3]] =
            coarser->cloth->particles.x[particle_of(coarser, i / 3, i % 3)];
    return places;
}

/* `preview` rests stretched by a share that grows with the square of its substep over the edge length
 * (xpbd.h). It is made the same on both meshes, or the cloth would be too short for the finer one. */
static int substeps_of(const tl_coarser *coarser, const tl_cloth *from)
{
    double ratio = sqrt((double)coarser->cage.vertex_count / (double)from->topology.vertex_count);
    bool rests_by_preview = from->params.solver == TL_CLOTH_PREVIEW;
    return rests_by_preview ? (int)fmax(ceil(tl_cloth_substeps_per_step(from) * ratio), 1)
                            : from->params.substeps;
}

static struct tl_cloth_params params_of(const tl_coarser *coarser, const tl_cloth *from)
{
    struct tl_cloth_params params = from->params;
    params.substeps = substeps_of(coarser, from);
    params.pin_above_m = 0;
    params.pin_colour = TL_PIN_NO_COLOUR;
    params.caged_above = 0;
    return params;
}

static bool make_cloth(tl_coarser *coarser, const tl_cloth *from)
{
    const struct tl_cage *cage = &coarser->cage;
    const struct tl_cloth_params params = params_of(coarser, from);
    tl_error error; /* of no interest: the cloth does without a cage then */
    make_garment(coarser, from);
    coarser->cloth = tl_cloth_create(&coarser->garment, &from->fabric, &params, &error);
    if (!coarser->cloth)
        return false;
    for (size_t i = 0; i < 3 * cage->triangle_count; i++)
        coarser->cloth->particles.x[particle_of(coarser, i / 3, i % 3)] =
            from->particles.x[cage->vertices[cage->triangles[i / 3][i % 3]]];
    take_pins(coarser, from);
    tl_cloth_set_constants(coarser->cloth);
    coarser->made = places_of(coarser);
    return true;
}

/* ---- The map ---- */

static vec3d point_of(const tl_coarser *coarser, const struct tl_cage_point *point, const vec3d *places)
{
    const uint32_t *v = coarser->cage.triangles[point->triangle];
    vec3d sum = {0};
    for (int k = 0; k < 3; k++)
        sum = vec3d_muladd(sum, places[v[k]], point->weights[k]);
    return sum;
}

static void take_offsets(tl_coarser *coarser, const tl_cloth *cloth)
{
    coarser->offsets = tl_resize(coarser->offsets, cloth->particles.count, sizeof *coarser->offsets);
    for (size_t i = 0; i < cloth->particles.count; i++) {
        const struct tl_cage_point *point = &coarser->cage.points[i];
        if (point->triangle != TL_NONE)
            coarser->offsets[i] = vec3d_sub(cloth->particles.x[i], point_of(coarser, point, coarser->made));
    }
}

tl_coarser *tl_coarser_create(const tl_cloth *cloth, size_t vertex_target)
{
    size_t count = cloth->topology.vertex_count;
    if (cloth->seams.pair_count > 0)
        return NULL;
    tl_coarser *coarser = TL_NEW(tl_coarser);
    bool worth = make_cage(cloth, vertex_target, &coarser->cage) &&
                 (double)coarser->cage.vertex_count <= WORTH_SHARE * (double)count;
    if (!worth || !make_cloth(coarser, cloth)) {
        tl_coarser_destroy(&coarser);
        return NULL;
    }
    coarser->fans = tl_fans_build((const uint32_t *)coarser->cage.triangles, 3 * coarser->cage.triangle_count,
                                  coarser->cage.vertex_count);
    take_offsets(coarser, cloth);
    return coarser;
}

void tl_coarser_destroy(tl_coarser **handle)
{
    tl_coarser *coarser = *handle;
    if (!coarser)
        return;
    tl_cloth_destroy(&coarser->cloth);
    tl_garment_release(&coarser->garment);
    tl_cage_release(&coarser->cage);
    tl_fans_release(&coarser->fans);
    free(coarser->made);
    free(coarser->offsets);
    tl_follower_destroy(&coarser->follower);
    free(coarser);
    *handle = NULL;
}

tl_cloth *tl_coarser_cloth(tl_coarser *coarser)
{
    return coarser->cloth;
}

/* ---- Carrying ---- */

/* Moves the free vertices to their places on the cage, and with `turns` by their turned offsets from there.
 */
static void place(const tl_coarser *coarser, const vec3d *places, const struct tl_rigid *turns,
                  struct tl_particles *particles)
{
    const struct tl_cage *cage = &coarser->cage;
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < particles->count; i++) {
        const struct tl_cage_point *point = &cage->points[i];
        if (point->triangle == TL_NONE || !(particles->w[i] > 0))
            continue;
        vec3d x = point_of(coarser, point, places);
        for (int k = 0; turns && k < 3; k++) {
            const struct tl_rigid *turn = &turns[cage->triangles[point->triangle][k]];
            x = vec3d_muladd(x, tl_rigid_turn(turn, coarser->offsets[i]), point->weights[k]);
        }
        particles->x[i] = x;
    }
}

void tl_coarser_carry(const tl_coarser *coarser, tl_cloth *cloth)
{
    const struct tl_cage *cage = &coarser->cage;
    struct tl_particles *particles = &cloth->particles;
    vec3d *places = places_of(coarser), *plain = TL_NEW_ARRAY(vec3d, particles->count);
    struct tl_rigid *turns = tl_alloc(cage->vertex_count, sizeof *turns);
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < cage->vertex_count; i++)
        turns[i] = tl_cage_motion(cage, &coarser->fans, i, coarser->made, places);
    place(coarser, places, NULL, particles);
    const struct tl_cloth_report without = tl_cloth_measure(cloth, NULL);
    memcpy(plain, particles->x, particles->count * sizeof *plain);
    place(coarser, places, turns, particles);
    const struct tl_cloth_report with = tl_cloth_measure(cloth, NULL);
    if (with.rms_strain > without.rms_strain || with.crossing_count > without.crossing_count)
        memcpy(particles->x, plain, particles->count * sizeof *plain);
    memset(particles->v, 0, particles->count * sizeof *particles->v);
    tl_cloth_set_constants(cloth);
    free(turns);
    free(plain);
    free(places);
}

/* ---- In motion ---- */

/* Lets the cage rest where the cloth does (cage_rest.h). Its weights stay. */
static void take_rest(tl_coarser *coarser, const tl_cloth *from)
{
    tl_cloth *cloth = coarser->cloth;
    const size_t render_count = cloth->topology.render_count, count = cloth->particles.count;
    tl_cage_rest(&coarser->cage, from, coarser->made, coarser->garment.pattern);
    double *masses = TL_NEW_ARRAY(double, count);
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, render_count);
    memcpy(masses, cloth->energy.masses, count * sizeof *masses);
    memcpy(weld, cloth->topology.weld, render_count * sizeof *weld);
    tl_cloth_build_mesh(cloth, weld, count);
    memcpy(cloth->energy.masses, masses, count * sizeof *masses);
    free(weld);
    free(masses);
}

void tl_coarser_restart(tl_coarser *coarser, const tl_cloth *cloth)
{
    const struct tl_cage *cage = &coarser->cage;
    struct tl_particles *particles = &coarser->cloth->particles;
    coarser->cloth->fabric = cloth->fabric;
    coarser->cloth->params = params_of(coarser, cloth);
    for (size_t i = 0; i < 3 * cage->triangle_count; i++) {
        const uint32_t to = particle_of(coarser, i / 3, i % 3);
        const uint32_t from = cage->vertices[cage->triangles[i / 3][i % 3]];
        particles->x[to] = cloth->particles.x[from];
        particles->v[to] = cloth->particles.v[from];
    }
    free(coarser->made);
    coarser->made = places_of(coarser);
    take_rest(coarser, cloth);
    take_pins(coarser, cloth);
    tl_cloth_set_constants(coarser->cloth);
    tl_cloth_mark_start(coarser->cloth);
}

void tl_coarser_bind(tl_coarser *coarser, const tl_cloth *cloth)
{
    vec3d *places = places_of(coarser);
    if (!coarser->follower)
        coarser->follower = tl_follower_create(&coarser->cage, &cloth->topology);
    tl_follower_start(coarser->follower, places, cloth->particles.x);
    free(places);
}

/* Values by vertices of the cage, as a new array. */
static struct tl_clearance *clearances_of(const tl_coarser *coarser, const tl_collider *collider)
{
    const struct tl_cage *cage = &coarser->cage;
    struct tl_clearance *of_particles = TL_NEW_ARRAY(struct tl_clearance, coarser->cloth->particles.count);
    struct tl_clearance *clearances = TL_NEW_ARRAY(struct tl_clearance, cage->vertex_count);
    tl_cloth_clearances(coarser->cloth, collider, of_particles);
    for (size_t i = 0; i < 3 * cage->triangle_count; i++)
        clearances[cage->triangles[i / 3][i % 3]] = of_particles[particle_of(coarser, i / 3, i % 3)];
    free(of_particles);
    return clearances;
}

void tl_coarser_follow(tl_coarser *coarser, const tl_collider *collider, const tl_cloth *cloth,
                       struct tl_particles *particles)
{
    vec3d *places = places_of(coarser);
    struct tl_clearance *clearances = clearances_of(coarser, collider);
    tl_follower_move(coarser->follower,
                     &(struct tl_follower_cage){places, clearances, collider, cloth->params.self_contact},
                     particles);
    free(clearances);
    free(places);
}

void tl_coarser_place(const tl_coarser *coarser, uint32_t particle, uint32_t corners[3], float shares[3])
{
    const struct tl_cage_point *point = &coarser->cage.points[particle];
    double clamped[3];
    corners[0] = corners[1] = corners[2] = particle;
    shares[0] = 1, shares[1] = shares[2] = 0;
    if (point->triangle == TL_NONE)
        return;
    tl_cage_point_shares(point, clamped);
    for (int k = 0; k < 3; k++) {
        const uint32_t corner = coarser->cage.vertices[coarser->cage.triangles[point->triangle][k]];
        if (corner == particle) {
            corners[0] = corners[1] = corners[2] = particle;
            shares[0] = 1, shares[1] = shares[2] = 0;
            return;
        }
        corners[k] = corner;
        shares[k] = (float)clamped[k];
    }
}

uint32_t tl_coarser_vertex_near(const tl_coarser *coarser, uint32_t particle)
{
    const struct tl_cage_point *point = &coarser->cage.points[particle];
    uint32_t best = 0;
    if (point->triangle == TL_NONE)
        return TL_NONE;
    for (uint32_t k = 1; k < 3; k++)
        best = point->weights[k] > point->weights[best] ? k : best;
    return 3 * point->triangle + best;
}
