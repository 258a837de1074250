#include "cloth/step/relax.h"

#include "cloth/contacts.h"
#include "cloth/mesh/denormals.h"
#include "cloth/solvers/relaxation.h"
#include "cloth/step/advance.h"
#include "cloth/timestep.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* A stage lasts for a time in which waves travel as in the cloth itself, and so takes more steps of stiff
 * cloth. */
struct stage {
    double time_s;
    double drag; /* 1/s */
};

/* In the first stage the cloth falls into place, as it would in the air: under ten times the drag friction
 * holds a dress where it is 10 mm wide at the neck, and after a start with a hundred times the drag 2 mm
 * short of that. In the second one folds come to rest. */
static const struct stage whole_stages[] = {{0.6, 6.7}, {0.15, 27}};

/* Applies to cloth with edges of CARRIED_EDGE_M that comes from a coarser one; for finer cloth times and
 * drags are scaled, so that the steps are as many: long waves have come to rest on the coarser one. */
static const struct stage carried_stages[] = {{0.435, 13.3}};
#define CARRIED_EDGE_M 0.02

/* The last steps of the last stage are a round, after which the cloth is looked at. If it is not in balance
 * it goes on in rounds until this many in succession have not made the residual less. */
#define ROUND_STEPS 500
#define VAIN_ROUNDS 3
#define LESS_SHARE  0.98

/* Steps between moves outside of the avatar, as between those of a step of motion. */
#define BLOCK 60
/* Blocks between computations of the masses: stiffness grows where cloth is crushed. */
#define MASS_BLOCKS 10

/* Share of the relative velocity of each edge's ends that inner friction takes a step. With five times as
 * much the residual is four times as large, and with none 25 times. */
#define INNER_SHARE 0.02

struct relaxing {
    tl_cloth *cloth;
    const tl_collider *collider;
    double h;
    double *w; /* [particles.count + 1] 1/kg, the cloth's own; while it is relaxed, particles.w are others */
    double *sums;   /* [particles.count + 1] N/m */
    vec3d *loads;   /* [particles.count] N */
    vec3d *start;   /* [particles.count] m */
    size_t steps;   /* so far */
    size_t planned; /* by the stages */
};

static void set_masses(const struct relaxing *relaxing)
{
    tl_cloth *cloth = relaxing->cloth;
    tl_energy_row_sums(&cloth->energy, &cloth->fabric, cloth->particles.count, cloth->particles.x,
                       relaxing->sums);
    tl_relaxation_masses(relaxing->sums, relaxing->w, cloth->particles.count, relaxing->h,
                         cloth->particles.w);
}

static void begin(struct relaxing *relaxing)
{
    tl_cloth *cloth = relaxing->cloth;
    const size_t count = cloth->particles.count;
    relaxing->h = tl_cloth_substep(cloth);
    relaxing->w = TL_NEW_ARRAY(double, count + 1);
    relaxing->sums = TL_NEW_ARRAY(double, count + 1);
    relaxing->loads = TL_NEW_ARRAY(vec3d, count);
    relaxing->start = TL_NEW_ARRAY(vec3d, count);
    memcpy(relaxing->w, cloth->particles.w, (count + 1) * sizeof *relaxing->w);
    memcpy(relaxing->start, cloth->particles.x, count * sizeof *relaxing->start);
    memset(cloth->particles.v, 0, count * sizeof *cloth->particles.v);
    for (size_t i = 0; i < count; i++)
        relaxing->loads[i].y = relaxing->w[i] > 0 ? -cloth->params.gravity / relaxing->w[i] : 0;
    set_masses(relaxing);
    if (relaxing->collider)
        tl_pins_bind(cloth->pins, cloth->pin_count, relaxing->collider, cloth->fabric.thickness_m);
    tl_cloth_prepare_contact(cloth);
}

static void end(struct relaxing *relaxing)
{
    struct tl_particles *particles = &relaxing->cloth->particles;
    memcpy(particles->w, relaxing->w, (particles->count + 1) * sizeof *particles->w);
    memset(particles->v, 0, particles->count * sizeof *particles->v);
    free(relaxing->w);
    free(relaxing->sums);
    free(relaxing->loads);
    free(relaxing->start);
}

/* The collider is at rest, at the end of its motion. */
static void relax_step(const struct relaxing *relaxing, double keep)
{
    tl_cloth *cloth = relaxing->cloth;
    struct tl_particles *particles = &cloth->particles;
    const double h = relaxing->h;
    const struct tl_relaxation relaxation = {
        .forces = cloth->forces, .loads = relaxing->loads, .keep = keep, .h = h};
    const struct tl_particle_kernel then = tl_relaxation_kernel(particles, &relaxation);
    const struct tl_contact_params contact = tl_cloth_contact_params(cloth, h, 1, 1);
    tl_cloth_renew_contact(cloth, h, 1, false);
    tl_particles_damp(particles, (const uint32_t(*)[2])cloth->topology.edges, cloth->topology.edge_count,
                      INNER_SHARE);
    tl_energy_forces(&cloth->energy, &cloth->fabric, particles->x, cloth->forces, &then);
    if (cloth->seams.pair_count > 0)
        tl_seams_solve(&cloth->seams, particles, h);
    tl_cloth_solve_contact(cloth, &contact);
    tl_particles_finish(particles, h);
}

static void relax_block(struct relaxing *relaxing, size_t steps, double keep)
{
    tl_cloth *cloth = relaxing->cloth;
    const struct tl_contact_params contact = tl_cloth_contact_params(cloth, BLOCK * relaxing->h, 1, 1);
    unsigned denormals = tl_denormals_off();
    if (relaxing->steps / BLOCK % MASS_BLOCKS == 0)
        set_masses(relaxing);
    tl_contacts_begin(&cloth->contacts, relaxing->collider);
    tl_contacts_update(&cloth->contacts, cloth->particles.x, cloth->fabric.thickness_m, 1);
    if (tl_cloth_is_tangled(cloth))
        tl_layers_update(&cloth->layers, &cloth->topology, cloth->particles.x);
    tl_pins_place(cloth->pins, cloth->pin_count, relaxing->collider, 1, &cloth->particles);
    for (size_t i = 0; i < steps; i++)
        relax_step(relaxing, keep);
    tl_cloth_keep_outside(cloth, relaxing->collider, &contact);
    tl_denormals_restore(denormals);
    relaxing->steps += steps;
}

/* Whether time is left. */
static bool has_time(const struct relaxing *relaxing)
{
    return (double)relaxing->steps * relaxing->h < relaxing->cloth->params.settle_s;
}

static bool run(struct relaxing *relaxing, size_t steps, double keep, struct tl_progress *progress,
                tl_error *error)
{
    for (size_t done = 0; done < steps && has_time(relaxing); done += BLOCK) {
        if (tl_interrupted())
            return tl_fail(error, TL_INTERRUPTED, "cloth: interrupted while it settled");
        const size_t left = steps - done;
        relax_block(relaxing, left < BLOCK ? left : BLOCK, keep);
        if (!tl_cloth_check_state(relaxing->cloth, error))
            return false;
        const size_t total =
            relaxing->planned > relaxing->steps ? relaxing->planned : relaxing->steps + ROUND_STEPS;
        tl_progress_update(progress, (double)relaxing->steps, (double)total);
    }
    return true;
}

/* The planes of contact are those at points through which vertices came. At rest each gets its own. */
static void renew_planes(const struct relaxing *relaxing)
{
    tl_contacts_forget(&relaxing->cloth->contacts);
}

static struct tl_residual measure(const struct relaxing *relaxing)
{
    tl_cloth *cloth = relaxing->cloth;
    double *others = cloth->particles.w;
    cloth->particles.w = relaxing->w;
    struct tl_residual residual = tl_cloth_residual(cloth, relaxing->collider);
    cloth->particles.w = others;
    return residual;
}

/* Rounds until the cloth is in balance, as far as it comes. */
static bool run_rounds(struct relaxing *relaxing, double keep, struct tl_progress *progress,
                       struct tl_residual *residual, tl_error *error)
{
    double lowest = HUGE_VAL;
    bool good = true;
    int vain = 0;
    do {
        renew_planes(relaxing);
        good = run(relaxing, ROUND_STEPS, keep, progress, error);
        *residual = measure(relaxing);
        vain = residual->bounded_rms < LESS_SHARE * lowest ? 0 : vain + 1;
        lowest = fmin(lowest, residual->bounded_rms);
    } while (good && !tl_residual_is_balance(residual) && vain < VAIN_ROUNDS && has_time(relaxing));
    return good;
}

/* Runs all stages but for the steps of the first round. */
static bool run_stages(struct relaxing *relaxing, const struct stage *stages, size_t stage_count,
                       double scale, double step_s, struct tl_progress *progress, tl_error *error)
{
    bool good = true;
    for (size_t i = 0; i < stage_count; i++)
        relaxing->planned += (size_t)ceil(scale * stages[i].time_s / step_s);
    for (size_t i = 0; i < stage_count && good; i++) {
        size_t steps = (size_t)ceil(scale * stages[i].time_s / step_s);
        if (i + 1 == stage_count)
            steps -= steps < ROUND_STEPS ? steps : ROUND_STEPS;
        good = run(relaxing, steps, exp(-stages[i].drag / scale * step_s), progress, error);
    }
    return good;
}

bool tl_cloth_relax(tl_cloth *cloth, const tl_collider *collider, bool carried, struct tl_residual *residual,
                    tl_error *error)
{
    const struct stage *stages = carried ? carried_stages : whole_stages;
    const size_t stage_count = carried ? TL_COUNT(carried_stages) : TL_COUNT(whole_stages);
    struct relaxing relaxing = {.cloth = cloth, .collider = collider};
    if (!tl_cloth_order_layers(cloth, collider, error))
        return false;
    begin(&relaxing);
    const double scale = carried ? tl_cloth_mean_edge(cloth) / CARRIED_EDGE_M : 1;
    const double step_s = fmin(cloth->wave_step_s, whole_stages[0].time_s);
    struct tl_progress progress = tl_progress_begin("settling the cloth");
    bool good = run_stages(&relaxing, stages, stage_count, scale, step_s, &progress, error);
    good = good && run_rounds(&relaxing, exp(-stages[stage_count - 1].drag / scale * step_s), &progress,
                              residual, error);
    tl_progress_end(&progress);
    if (!good && !tl_interrupted())
        memcpy(cloth->particles.x, relaxing.start, cloth->particles.count * sizeof *relaxing.start);
    end(&relaxing);
    return good;
}
