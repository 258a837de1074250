/* One frame of the cloth: by itself, or by a cage.
 *
 * A garment of 100,000 vertices takes seconds a frame when all of them are simulated. Cloth of more than
 * params.caged_above vertices is moved by a cage of CAGE_VERTICES (coarser.h), which has its weight, its pins
 * and its contacts, and which it follows (follower.h); it is the cloth itself that settles. The reference
 * solver moves every cloth itself, and cloth whose seams are open moves itself until they are closed. */
#include "cloth/build.h"
#include "cloth/cage/coarser.h"
#include "cloth/step/advance.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* The number of the first dress, which two cores move in 20 ms a frame. */
#define CAGE_VERTICES 3000

bool tl_cloth_is_caged(const tl_cloth *cloth)
{
    const int above = cloth->params.caged_above;
    return above > 0 && cloth->topology.vertex_count > (size_t)above && !cloth->has_no_cage &&
           cloth->params.solver != TL_CLOTH_REFERENCE && cloth->seams.pair_count == 0;
}

static void make_cage(tl_cloth *cloth)
{
    struct tl_progress progress = tl_progress_begin("making a cage to move the cloth by");
    tl_progress_update(&progress, 0, 1);
    cloth->cage = tl_coarser_create(cloth, CAGE_VERTICES);
    cloth->destroy_cage = tl_coarser_destroy;
    cloth->has_no_cage = !cloth->cage;
    cloth->caged_cloth = cloth->cage ? tl_coarser_cloth(cloth->cage) : NULL;
    cloth->cage_revision++;
    tl_progress_end(&progress);
    if (cloth->cage)
        tl_info("the garment of %zu vertices moves by a cage of %zu; cloth.caged_above=0 moves all of them",
                cloth->topology.vertex_count, cloth->caged_cloth->topology.vertex_count);
}

static bool stands_still(const struct tl_particles *particles)
{
    for (size_t i = 0; i < particles->count; i++)
        if (vec3d_dot(particles->v[i], particles->v[i]) > 0)
            return false;
    return true;
}

/* A cage is only nearly in balance where the cloth is. It comes to rest by itself, and the cloth follows
 * it from there on. */
static bool restart_cage(tl_cloth *cloth, const tl_collider *collider, tl_error *error)
{
    tl_cloth *cage = tl_coarser_cloth(cloth->cage);
    tl_coarser_restart(cloth->cage, cloth);
    if (cloth->energy.is_prestressed && stands_still(&cloth->particles)) {
        if (!tl_cloth_come_to_rest(cage, collider, error))
            return false;
        tl_cloth_mark_start(cage);
    }
    tl_coarser_bind(cloth->cage, cloth);
    cloth->cage_is_current = true;
    return true;
}

/* A pull is one of the cage's nearest vertex, by the same way. */
static void pass_pull_on(tl_cloth *cloth)
{
    tl_cloth *cage = tl_coarser_cloth(cloth->cage);
    const uint32_t particle = cloth->grabbed ? cloth->topology.weld[cloth->grabbed_vertex] : 0;
    const uint32_t vertex = cloth->grabbed ? tl_coarser_vertex_near(cloth->cage, particle) : TL_NONE;
    if (vertex == TL_NONE) {
        tl_cloth_release(cage);
        return;
    }
    if (!cage->grabbed || cage->grabbed_vertex != vertex)
        cloth->cage_grab =
            vec3d_sub(cage->particles.x[cage->topology.weld[vertex]], cloth->particles.x[particle]);
    tl_cloth_grab(cage, vertex, vec3d_to_float(vec3d_add(cloth->grab_target, cloth->cage_grab)));
}

static bool advance_caged(tl_cloth *cloth, const tl_collider *collider,
                          const struct tl_advance_params *advance, tl_error *error)
{
    struct tl_particles *particles = &cloth->particles;
    const size_t count = particles->count;
    if (!cloth->cage_is_current && !restart_cage(cloth, collider, error))
        return false;
    pass_pull_on(cloth);
    if (collider)
        tl_pins_bind(cloth->pins, cloth->pin_count, collider, cloth->fabric.thickness_m);
    if (!tl_cloth_advance(tl_coarser_cloth(cloth->cage), collider, advance, error))
        return false;
    cloth->good_x = tl_resize(cloth->good_x, count, sizeof *cloth->good_x);
    memcpy(cloth->good_x, particles->x, count * sizeof *cloth->good_x);
    tl_pins_place(cloth->pins, cloth->pin_count, collider, 1, particles);
    tl_coarser_follow(cloth->cage, collider, cloth, particles);
    for (size_t i = 0; i < count; i++)
        particles->v[i] = vec3d_scale(vec3d_sub(particles->x[i], cloth->good_x[i]), cloth->params.frame_rate);
    cloth->grab_from = cloth->grab_target;
    cloth->time_s += 1 / cloth->params.frame_rate;
    cloth->was_caged = true;
    return true;
}

bool tl_cloth_step(tl_cloth *cloth, const tl_collider *collider, tl_error *error)
{
    const struct tl_advance_params advance = {.clock = true};
    if (tl_cloth_is_caged(cloth) && !cloth->cage)
        make_cage(cloth);
    if (tl_cloth_is_caged(cloth))
        return advance_caged(cloth, collider, &advance, error);
    if (cloth->was_caged)
        tl_cloth_set_constants(cloth); /* forgets contacts, which are those of where it was before */
    return tl_cloth_advance(cloth, collider, &advance, error);
}

uint64_t tl_cloth_cage(const tl_cloth *cloth, struct tl_cage_places *out)
{
    const size_t count = cloth->topology.render_count;
    const bool is_moved = cloth->cage && cloth->cage_is_current;
    uint32_t *vertices = out && is_moved ? TL_NEW_ARRAY(uint32_t, cloth->particles.count) : NULL;
    for (size_t i = count; vertices && i-- > 0;) /* the first vertex at each place */
        vertices[cloth->topology.weld[i]] = (uint32_t)i;
    for (size_t i = 0; vertices && i < count; i++) {
        uint32_t corners[3];
        tl_coarser_place(cloth->cage, cloth->topology.weld[i], corners, out->shares[i]);
        for (int k = 0; k < 3; k++)
            out->from[i][k] = vertices[corners[k]];
    }
    free(vertices);
    return is_moved ? cloth->cage_revision : 0;
}
