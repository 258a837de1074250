/* Settling, before the first frame: sewing, balance (relax.h), and rest in motion (advance.h). */
#include "cloth/build.h"
#include "cloth/cage/coarser.h"
#include "cloth/measure.h"
#include "cloth/step/advance.h"
#include "cloth/step/relax.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* 1/s, of the cloth while it hangs from a hold and is carried by its seams. */
#define HANG_DRAG 5

void tl_cloth_log_unsettled(const tl_cloth *cloth)
{
    tl_info(
        "the cloth is out of balance by %.2g of its weight after settling (%.2g for 99 %% of its vertices)",
        cloth->balance.residual.rms, cloth->balance.residual.high);
}

/* Vertices of a cloth to those of the next coarser one: edges of half the number. Cages of fewer than FEWEST
 * are not made: a skirt of 650 vertices folds another way than a finer one. */
#define RATIO  4
#define FEWEST 1500

static tl_coarser *make_coarser(const tl_cloth *cloth)
{
    const size_t target = cloth->topology.vertex_count / RATIO;
    return cloth->params.cages && target >= FEWEST ? tl_coarser_create(cloth, target) : NULL;
}

static bool balance(tl_cloth *cloth, const tl_collider *collider, tl_error *error);

/* Balances a coarser version of the cloth, if it has one, and carries the cloth to where that has come to. A
 * coarser cloth that fails is left out: the cloth itself can settle without. */
static bool balance_coarser(tl_cloth *cloth, const tl_collider *collider)
{
    tl_error error = {0};
    tl_coarser *coarser = make_coarser(cloth);
    bool carried = coarser && balance(tl_coarser_cloth(coarser), collider, &error);
    if (carried)
        tl_coarser_carry(coarser, cloth);
    else if (coarser && !tl_interrupted())
        tl_info("a coarser version of the cloth could not be settled, so it settles without: %s",
                error.message);
    tl_coarser_destroy(&coarser);
    return carried;
}

static bool balance(tl_cloth *cloth, const tl_collider *collider, tl_error *error)
{
    const bool carried = balance_coarser(cloth, collider);
    return tl_cloth_relax(cloth, collider, carried, &cloth->balance.residual, error);
}

/* `preview` closes seams. */
static struct tl_cloth_params params_of_sewing(const struct tl_cloth_params *chosen)
{
    struct tl_cloth_params params = *chosen;
    params.solver = TL_CLOTH_PREVIEW;
    return params;
}

/* While seams close, cloth need not hang as it will: fine panels need no more substeps than coarse ones. A
 * dress of 15,000 vertices is sewn in 52 s of CPU time with 30, and crosses itself nowhere; with as many as
 * it hangs by in 116 s, and in 112 places. */
#define SEWING_SUBSTEPS 30

static bool close_seams(tl_cloth *cloth, const tl_collider *collider, const struct tl_cloth_params *params,
                        tl_error *error)
{
    struct tl_cloth_params now = params_of_sewing(params);
    const double pair_count = (double)cloth->seams.pair_count;
    struct tl_progress progress = tl_progress_begin("sewing");
    bool good = true;
    now.substeps = now.substeps > 0 ? now.substeps : SEWING_SUBSTEPS;
    if (collider && cloth->seams.elapsed_s == 0)
        tl_seams_find_ways(&cloth->seams, &cloth->topology, cloth->particles.x, collider);
    while (good && tl_seams_are_closing(&cloth->seams)) {
        const struct tl_advance_params advance = {.drag = tl_seams_drag(&cloth->seams)};
        tl_cloth_use_solver(cloth, &now);
        good = tl_cloth_advance(cloth, collider, &advance, error);
        tl_progress_update(&progress, pair_count - (double)cloth->seams.pair_count, pair_count);
    }
    tl_cloth_use_solver(cloth, params);
    tl_progress_end(&progress);
    return good;
}

/* Seconds for which a garment that is held by its waist hangs from there, until it sits. */
#define HANG_S 0.5

static bool holds_height(const tl_garment *garment)
{
    for (size_t i = 0; i < garment->hold_count; i++)
        if (garment->holds[i].axis == 1)
            return true;
    return false;
}

static bool hang(tl_cloth *cloth, const tl_collider *collider, const struct tl_cloth_params *params,
                 tl_error *error)
{
    const struct tl_cloth_params now = params_of_sewing(params);
    const struct tl_advance_params advance = {.drag = HANG_DRAG};
    bool good = true;
    cloth->hanging = true;
    for (double hung_s = 0; good && hung_s < HANG_S; hung_s += 1 / params->frame_rate) {
        tl_cloth_use_solver(cloth, &now);
        good = tl_cloth_advance(cloth, collider, &advance, error);
    }
    cloth->hanging = false;
    return good;
}

bool tl_cloth_sew(tl_cloth *cloth, const tl_collider *collider, tl_error *error)
{
    const struct tl_cloth_params chosen = cloth->params;
    bool good = close_seams(cloth, collider, &chosen, error);
    memset(cloth->particles.v, 0, cloth->particles.count * sizeof(vec3d));
    return good;
}

/* Weights, for 99 % of the vertices. Cloth that is farther from balance, as tight suits in creases of the
 * body and coarse meshes are, is not prestressed: its tension is that of an instant, and throws it about. */
#define PRESTRESS_RESIDUAL 10

/* The cage of cloth that moves by one comes to rest when it is made. */
static bool rest_in_motion(tl_cloth *cloth, const tl_collider *collider, tl_error *error)
{
    const struct tl_particles *particles = &cloth->particles;
    tl_cloth_set_prestress(cloth, cloth->balance.residual.high < PRESTRESS_RESIDUAL);
    if (tl_cloth_is_caged(cloth))
        return true;
    vec3d *from = TL_NEW_ARRAY(vec3d, particles->count);
    memcpy(from, particles->x, particles->count * sizeof *from);
    const bool good = tl_cloth_come_to_rest(cloth, collider, error);
    cloth->balance.moved_m = tl_cloth_moved_from(cloth, from);
    free(from);
    return good;
}

bool tl_cloth_settle(tl_cloth *cloth, const tl_collider *collider, tl_error *error)
{
    const struct tl_cloth_params chosen = cloth->params, *params = &chosen;
    const bool is_new = cloth->seams.pair_count > 0 && cloth->seams.elapsed_s == 0;
    cloth->settled = false;
    cloth->balance = (struct tl_balance){0};
    tl_cloth_set_prestress(cloth, false);
    if (!(params->settle_s > 0))
        return true;
    bool good = close_seams(cloth, collider, params, error);
    if (good && is_new && holds_height(cloth->garment))
        good = hang(cloth, collider, params, error);
    tl_cloth_use_solver(cloth, params);
    good = good && balance(cloth, collider, error);
    cloth->settled = good && tl_residual_is_balance(&cloth->balance.residual);
    if (good && params->solver == TL_CLOTH_PREVIEW)
        good = rest_in_motion(cloth, collider, error);
    if (good && !cloth->settled)
        tl_cloth_log_unsettled(cloth);
    memset(cloth->particles.v, 0, cloth->particles.count * sizeof(vec3d));
    return good;
}
