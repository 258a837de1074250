/* Settling: simulating until rest, before the first frame. */
#include "cloth/build.h"
#include "cloth/cage/coarser.h"
#include "cloth/measure.h"
#include "cloth/solvers/xpbd.h"
#include "cloth/step/advance.h"
#include "cloth/step/calibrate.h"
#include "cloth/step/relax.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Settling runs through two phases of decreasing drag. Under the first drag a fall ends at 2 m/s and a swing
 * of 0.5 m dies within a period. Cloth that merely creeps under strong drag would still swing freely without
 * it, so rest is accepted only in the second phase. Each phase has a minimum duration because a cloth that
 * starts at rest has no speed yet. */
static const struct phase {
    double drag, min_s;
} phases[] = {{5, 0.25}, {1, 0.5}};

/* The only phase of cloth that was carried here from a coarser version. Its forces are out of balance, so
 * that it has speed from the first frame on, and its folds rearrange in waves: a dress of 10,500 vertices
 * comes to rest in 67 frames, a skirt of 11,700 in 77, in 54 and 93 under a drag of 6. Stopping all cloth at
 * each peak of its kinetic energy [Barnes 1999] was slower: ripples make a peak every few frames, and wide
 * swings never gather speed (a skirt of 10,000 vertices: 116 frames, 67 under this drag). */
static const struct phase carried_phase = {4, 0.25};

/* Far from rest, contact changes with every step, so that exact stick and slip states are wasted work. Near
 * rest, solves are so short that MIN_CONTACT_ITERATIONS of implicit.c suffices for all contact rounds anyway.
 */
#define CONTACT_BUDGET 0.25

/* `preview` comes near to rest at a fraction of the others' cost; the chosen solver does the last phase. */
static struct tl_cloth_params params_of_phase(const struct tl_cloth_params *chosen, size_t phase)
{
    struct tl_cloth_params params = *chosen;
    if (phase + 1 < TL_COUNT(phases))
        params.solver = TL_CLOTH_PREVIEW;
    return params;
}

void tl_cloth_log_unsettled(const tl_cloth *cloth)
{
    if (cloth->params.settling == TL_SETTLING_BALANCE) {
        tl_info("the cloth is out of balance by %.2g of its weight after settling (%.2g for 99 %% of its "
                "vertices)",
                cloth->residual.rms, cloth->residual.high);
        return;
    }
    tl_info("the cloth still moves at %.3f m/s after settling for %g s: increase cloth.settle_s",
            cloth->unsettled_speed, cloth->params.settle_s);
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

/* Settles a coarser version of the cloth, if it has one, and carries the cloth to where that has come to. A
 * coarser cloth that fails is left out: the cloth itself can settle without. */
static bool settle_coarser(tl_cloth *cloth, const tl_collider *collider)
{
    tl_error error = {0};
    tl_coarser *coarser = make_coarser(cloth);
    bool carried = coarser && tl_cloth_settle(tl_coarser_cloth(coarser), collider, &error);
    if (carried)
        tl_coarser_carry(coarser, cloth);
    else if (coarser && !tl_interrupted())
        tl_info("a coarser version of the cloth could not be settled, so it settles without: %s",
                error.message);
    tl_coarser_destroy(&coarser);
    return carried;
}

static struct tl_advance_params advance_params(const struct tl_cloth_params *params, double drag)
{
    return (struct tl_advance_params){.drag = drag,
                                      .contact_budget = CONTACT_BUDGET,
                                      /* slower slip than settle_speed counts as rest: such contacts stick */
                                      .min_slip_speed = fmax(TL_MIN_SLIP_SPEED, params->settle_speed)};
}

/* A vertex of a fine mesh may tremble for ever, between contact and its neighbours, by a tenth of a
 * millimetre a frame that it does not keep. Cloth is also at rest when over this time no vertex has gone as
 * far as at half of settle_speed. */
#define STILL_S 0.5

/* Positions of the cloth when the present span of STILL_S began. */
struct still_span {
    vec3d *from; /* [particles.count]; NULL: it has not begun */
    double since_s;
};

/* Whether a span ends here in which nothing has gone anywhere; begins the next one when it ends. */
static bool stayed(struct still_span *span, const tl_cloth *cloth, double now_s)
{
    const struct tl_particles *particles = &cloth->particles;
    double farthest_m = 0, span_s = now_s - span->since_s;
    if (span->from && span_s < STILL_S)
        return false;
    for (size_t i = 0; span->from && i < particles->count; i++)
        farthest_m = fmax(farthest_m, vec3d_distance(particles->x[i], span->from[i]));
    bool still = span->from && farthest_m < 0.5 * cloth->params.settle_speed * span_s;
    span->from = tl_resize(span->from, particles->count, sizeof *span->from);
    memcpy(span->from, particles->x, particles->count * sizeof *span->from);
    span->since_s = now_s;
    return still;
}

/* While seams close, cloth need not hang as it will: fine panels need no more substeps than coarse ones. A
 * dress of 15,000 vertices is sewn in 52 s of CPU time with 30, and crosses itself nowhere; with as many as
 * it hangs by in 116 s, and in 112 places. */
#define SEWING_SUBSTEPS 30

static bool close_seams(tl_cloth *cloth, const tl_collider *collider, const struct tl_cloth_params *params,
                        tl_error *error)
{
    struct tl_cloth_params now = params_of_phase(params, 0);
    const double pair_count = (double)cloth->seams.pair_count;
    struct tl_progress progress = tl_progress_begin("sewing");
    bool good = true;
    now.substeps = now.substeps > 0 ? now.substeps : SEWING_SUBSTEPS;
    if (collider && cloth->seams.elapsed_s == 0)
        tl_seams_find_ways(&cloth->seams, &cloth->topology, cloth->particles.x, collider);
    while (good && tl_seams_are_closing(&cloth->seams)) {
        const struct tl_advance_params advance = advance_params(params, tl_seams_drag(&cloth->seams));
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
    const struct tl_cloth_params now = params_of_phase(params, 0);
    const struct tl_advance_params advance = advance_params(params, phases[0].drag);
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

/* Relaxes the cloth, after which `preview` is calibrated to rest there. */
static bool settle_in_balance(tl_cloth *cloth, const tl_collider *collider, tl_error *error)
{
    tl_cloth_use_solver(cloth, &cloth->params);
    const bool carried = settle_coarser(cloth, collider);
    if (!tl_cloth_relax(cloth, collider, carried, &cloth->residual, error))
        return false;
    cloth->settled = tl_residual_is_balance(&cloth->residual);
    tl_cloth_calibrate(cloth, collider);
    if (!cloth->settled)
        tl_cloth_log_unsettled(cloth);
    return true;
}

bool tl_cloth_settle(tl_cloth *cloth, const tl_collider *collider, tl_error *error)
{
    const struct tl_cloth_params chosen = cloth->params, *params = &chosen;
    double frame_s = 1 / params->frame_rate;
    /* The frame that ends sewing counts. */
    double settled_s = tl_seams_are_closing(&cloth->seams) ? frame_s : 0, phase_s = settled_s;
    size_t phase = 0;
    cloth->settled = false;
    cloth->residual = (struct tl_residual){0};
    tl_xpbd_reset_rest(&cloth->energy);
    bool is_new = cloth->seams.pair_count > 0 && cloth->seams.elapsed_s == 0;
    bool good = !(params->settle_s > 0) || close_seams(cloth, collider, params, error);
    if (good && params->settle_s > 0 && is_new && holds_height(cloth->garment))
        good = hang(cloth, collider, params, error);
    if (good && params->settle_s > 0 && params->settling == TL_SETTLING_BALANCE) {
        tl_cloth_use_solver(cloth, params);
        return settle_in_balance(cloth, collider, error);
    }
    bool tried = false, carried = false;
    struct still_span span = {0};
    struct tl_progress progress = tl_progress_begin("settling the cloth");
    while (good && !cloth->settled && settled_s < params->settle_s) {
        if (!tried) {
            tried = true;
            tl_cloth_use_solver(cloth, params);
            carried = settle_coarser(cloth, collider);
            phase = carried ? TL_COUNT(phases) - 1 : phase;
        }
        const struct phase *run = carried ? &carried_phase : &phases[phase];
        const struct tl_advance_params advance = advance_params(params, run->drag);
        const struct tl_cloth_params now = params_of_phase(params, phase);
        tl_cloth_use_solver(cloth, &now);
        good = tl_cloth_advance(cloth, collider, &advance, error);
        settled_s += frame_s;
        phase_s += frame_s;
        bool still = stayed(&span, cloth, settled_s);
        if (phase_s > run->min_s && (still || tl_cloth_frame_speed(cloth) < params->settle_speed)) {
            phase_s = 0;
            cloth->settled = good && ++phase == TL_COUNT(phases);
        }
        tl_progress_update(&progress, settled_s, params->settle_s);
    }
    tl_progress_end(&progress);
    free(span.from);
    tl_cloth_use_solver(cloth, params);
    bool timed_out = good && !cloth->settled && params->settle_s > 0;
    cloth->unsettled_speed = timed_out ? tl_cloth_frame_speed(cloth) : 0;
    if (timed_out)
        tl_cloth_log_unsettled(cloth);
    memset(cloth->particles.v, 0, cloth->particles.count * sizeof(vec3d));
    return good;
}
