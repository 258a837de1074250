#include "cloth/solvers/implicit/implicit.h"

#include "config/memory.h"

#include <stdlib.h>
#include <string.h>

/* Times that a step is solved again for particles that stick, slip or let go otherwise than was assumed. */
#define ROUNDS 8
/* Iterations that all further rounds may take in any case: in motion contact changes with every step anyway;
 * at rest, when solves are short, it must agree. */
#define AGREEMENT_LEAST 30
/* Times that a step is linearised, and then halved, while it would gain energy. */
#define LINEARISED 4
#define HALVINGS   6

struct tl_implicit {
    size_t count;
    struct tl_stiffness stiffness;
    tl_factor *factor;
    struct tl_solve_space space;
    struct tl_filter *filters;
    struct tl_touch *touches;
    struct tl_press *presses;   /* [the contacts' probe_count] */
    double *inertia, *resisted; /* N/m: mu, and with the friction of what slips */
    vec3d *push;                /* N: inertia and gravity */
    vec3d *load, *resisted_load;
    vec3d *elastic; /* N */
    vec3d *given;   /* m, the filtered parts of the step */
    vec3d *step;    /* m */
    vec3d *at;      /* m, positions where the forces are linearised, and of a trial */
};

tl_implicit *tl_implicit_create(const struct tl_implicit_problem *problem,
                                const struct tl_particles *particles)
{
    tl_implicit *implicit = TL_NEW(tl_implicit);
    size_t count = particles->count;
    implicit->count = count;
    implicit->stiffness = tl_stiffness_build(problem->energy, problem->fabric, &problem->springs, count);
    implicit->factor = tl_factor_create(problem->energy, problem->fabric, &problem->springs,
                                        &implicit->stiffness, particles->w, problem->h);
    implicit->space = tl_solve_space_create(count);
    implicit->filters = TL_NEW_ARRAY(struct tl_filter, count);
    implicit->touches = TL_NEW_ARRAY(struct tl_touch, count);
    implicit->presses = TL_NEW_ARRAY(struct tl_press, problem->contacts->probe_count);
    implicit->inertia = TL_NEW_ARRAY(double, count);
    implicit->resisted = TL_NEW_ARRAY(double, count);
    implicit->push = TL_NEW_ARRAY(vec3d, count);
    implicit->load = TL_NEW_ARRAY(vec3d, count);
    implicit->resisted_load = TL_NEW_ARRAY(vec3d, count);
    implicit->elastic = TL_NEW_ARRAY(vec3d, count);
    implicit->given = TL_NEW_ARRAY(vec3d, count);
    implicit->step = TL_NEW_ARRAY(vec3d, count);
    implicit->at = TL_NEW_ARRAY(vec3d, count);
    return implicit;
}

void tl_implicit_destroy(tl_implicit **handle)
{
    tl_implicit *implicit = *handle;
    if (!implicit)
        return;
    tl_stiffness_release(&implicit->stiffness);
    tl_factor_destroy(&implicit->factor);
    tl_solve_space_release(&implicit->space);
    void *const arrays[] = {implicit->presses,  implicit->filters, implicit->touches, implicit->inertia,
                            implicit->resisted, implicit->push,    implicit->load,    implicit->resisted_load,
                            implicit->elastic,  implicit->given,   implicit->step,    implicit->at};
    for (size_t i = 0; i < TL_COUNT(arrays); i++)
        free(arrays[i]);
    free(implicit);
    *handle = NULL;
}

/* ---- Energy ---- */

static double add_hand(const struct tl_hand *hand, const vec3d *x, vec3d *forces)
{
    if (hand->particle == TL_NONE)
        return 0;
    vec3d way = vec3d_sub(hand->target, x[hand->particle]);
    double length = vec3d_norm(way), k = hand->stiffness, most = hand->most_force;
    double force = fmin(k * length, most);
    forces[hand->particle] = vec3d_muladd(forces[hand->particle], vec3d_unit_or(way, (vec3d){0}), force);
    return force < most ? 0.5 * k * length * length : most * length - 0.5 * most * most / k;
}

/* k/2 (length - rest)^2. */
static double add_spring(const struct tl_link *link, double stiffness, const vec3d *x, vec3d *forces)
{
    vec3d apart = vec3d_sub(x[link->b], x[link->a]);
    double stretch = vec3d_norm(apart) - link->rest;
    vec3d pull = vec3d_scale(vec3d_unit_or(apart, (vec3d){0}), stiffness * stretch);
    forces[link->a] = vec3d_add(forces[link->a], pull);
    forces[link->b] = vec3d_sub(forces[link->b], pull);
    return 0.5 * stiffness * stretch * stretch;
}

/* Of all that pulls, with its forces. */
static double elastic_energy(const struct tl_implicit_problem *problem, size_t count, const vec3d *x,
                             vec3d *forces)
{
    double energy = tl_energy_forces(problem->energy, problem->fabric, count, x, forces);
    for (size_t i = 0; i < problem->springs.count; i++)
        energy += add_spring(&problem->springs.links[i], problem->springs.stiffness, x, forces);
    return energy + add_hand(&problem->hand, x, forces);
}

static double kinetic_energy(const struct tl_particles *particles)
{
    double energy = 0;
    for (size_t i = 0; i < particles->count; i++)
        if (particles->w[i] > 0)
            energy += 0.5 * vec3d_dot(particles->v[i], particles->v[i]) / particles->w[i];
    return energy;
}

/* Kinetic, elastic and gravity's, the last from the step's start, once a step has led to x. */
static double energy_at(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                        const struct tl_particles *particles, const vec3d *x)
{
    double energy = elastic_energy(problem, implicit->count, x, implicit->elastic);
    for (size_t i = 0; i < implicit->count; i++) {
        vec3d step = vec3d_sub(x[i], particles->previous[i]);
        double mass = particles->w[i] > 0 ? 1 / particles->w[i] : 0;
        energy +=
            mass * (0.5 * vec3d_dot(step, step) / (problem->h * problem->h) + problem->gravity * step.y);
    }
    return energy;
}

/* ---- The linear system ---- */

static vec3d inertial_way(const struct tl_implicit_problem *problem, vec3d v)
{
    vec3d way = vec3d_scale(v, problem->h);
    way.y -= problem->gravity * problem->h * problem->h;
    return vec3d_scale(way, 1 / (1 + problem->drag * problem->h));
}

static double inertia_of(const struct tl_implicit_problem *problem, double inverse_mass)
{
    return inverse_mass > 0 ? (1 + problem->drag * problem->h) / (inverse_mass * problem->h * problem->h) : 0;
}

/* What holds for the whole step: inertia, planes, and what it starts from. */
static void begin(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                  const struct tl_particles *particles)
{
    for (size_t i = 0; i < implicit->count; i++) {
        double w = particles->w[i];
        vec3d way = w > 0 ? inertial_way(problem, particles->v[i]) : (vec3d){0};
        implicit->inertia[i] = inertia_of(problem, w);
        implicit->push[i] = vec3d_scale(way, implicit->inertia[i]);
        implicit->step[i] = way;
        implicit->at[i] = particles->previous[i];
        implicit->touches[i].near = false;
        if (w > 0)
            tl_touch_begin(&implicit->touches[i], problem->contacts, &problem->contact, i,
                           particles->previous[i], way);
    }
}

/* Adds the hand's stiffness, of its two the lesser: across what it pulls. */
static void linearise_pull(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                           const struct tl_particles *particles)
{
    const struct tl_hand *hand = &problem->hand;
    uint32_t i = hand->particle;
    if (i == TL_NONE || !(particles->w[i] > 0))
        return;
    double length = vec3d_distance(hand->target, implicit->at[i]);
    double stiffness = fmin(hand->stiffness, hand->most_force / length);
    implicit->inertia[i] = inertia_of(problem, particles->w[i]) + stiffness;
    implicit->load[i] = vec3d_muladd(implicit->load[i], implicit->given[i], stiffness);
}

static double stiffest(const struct tl_cloth_fabric *fabric)
{
    return fmax(fmax(fabric->stretch_weft, fabric->stretch_warp), fabric->shear);
}

/* K and the load mu (y - x) + f + K (at - x) at the present `at`, whose elastic forces are known. */
static void linearise(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                      const struct tl_particles *particles)
{
    tl_stiffness_assemble(&implicit->stiffness, problem->energy, problem->fabric, &problem->springs,
                          implicit->at);
    for (size_t i = 0; i < implicit->count; i++)
        implicit->given[i] = vec3d_sub(implicit->at[i], particles->previous[i]);
#pragma omp parallel for schedule(static) if (implicit->count > TL_SERIAL)
    for (size_t i = 0; i < implicit->count; i++) {
        vec3d carried = tl_stiffness_row(&implicit->stiffness, i, implicit->given);
        implicit->load[i] = vec3d_add(vec3d_add(implicit->push[i], implicit->elastic[i]), carried);
    }
    linearise_pull(implicit, problem, particles);
    tl_presses_add(implicit->presses, problem->contacts, &implicit->stiffness, implicit->load);
}

/* What each particle may do, what of its step is given, and what friction resists. */
static void apply_touches(tl_implicit *implicit, const struct tl_particles *particles)
{
    for (size_t i = 0; i < implicit->count; i++) {
        const struct tl_touch *touch = &implicit->touches[i];
        struct tl_filter *filter = &implicit->filters[i];
        *filter = tl_touch_filter(touch, &implicit->given[i]);
        if (!(particles->w[i] > 0)) {
            filter->freedom = TL_MOVES_NOT;
            implicit->given[i] = vec3d_sub(particles->x[i], particles->previous[i]);
        }
        double resistance = filter->freedom == TL_MOVES_ACROSS ? touch->resistance : 0;
        implicit->resisted[i] = implicit->inertia[i] + resistance;
        implicit->resisted_load[i] = vec3d_muladd(implicit->load[i], touch->plane.motion, resistance);
    }
}

/* Keeps what the step does where it is free, and gives the rest. */
static void impose_given(tl_implicit *implicit)
{
    for (size_t i = 0; i < implicit->count; i++) {
        const struct tl_filter *filter = &implicit->filters[i];
        vec3d missing = vec3d_sub(implicit->given[i], implicit->step[i]);
        if (filter->freedom == TL_MOVES_NOT)
            implicit->step[i] = implicit->given[i];
        else if (filter->freedom == TL_MOVES_ACROSS)
            implicit->step[i] =
                vec3d_muladd(implicit->step[i], filter->direction, vec3d_dot(missing, filter->direction));
    }
}

/* Whether every particle does what was assumed. */
static bool judge_touches(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                          const struct tl_system *system)
{
    struct tl_system without_friction = *system;
    without_friction.inertia = implicit->inertia;
    without_friction.load = implicit->load;
    bool agreed = true;
#pragma omp parallel for schedule(static) reduction(&& : agreed) if (implicit->count > TL_SERIAL)
    for (size_t i = 0; i < implicit->count; i++)
        if (implicit->touches[i].near) {
            vec3d reaction = tl_solve_reaction(&without_friction, i, implicit->step);
            bool same = tl_touch_judge(&implicit->touches[i], &problem->contact, implicit->step[i], reaction,
                                       implicit->inertia[i]);
            agreed = agreed && same;
        }
    return agreed;
}

/* Squared residuals that need no more work: of speeds of 1e-5 m/s, as closely as others are solved; and
 * rounding, of positions within a few metres. */
static double residual_floor(const tl_implicit *implicit, const struct tl_implicit_problem *problem)
{
    const double rounding_m = 4e-15;
    double still_m = 1e-5 * problem->tolerance * problem->h, inertia = 0;
    for (size_t i = 0; i < implicit->count; i++)
        inertia += implicit->inertia[i];
    return inertia * (still_m * still_m + rounding_m * rounding_m) +
           (double)implicit->count * stiffest(problem->fabric) * rounding_m * rounding_m;
}

/* What only falls and flies keeps its momentum to rounding, however little is solved: elastic forces add up
 * to nothing, so its mean way is that of inertia. */
static void keep_momentum(tl_implicit *implicit, const struct tl_implicit_problem *problem)
{
    vec3d missing = {0};
    double inertia = 0;
    bool free = problem->hand.particle == TL_NONE;
    for (size_t i = 0; i < problem->contacts->probe_count && free; i++)
        free = !implicit->presses[i].presses;
    for (size_t i = 0; i < implicit->count && free; i++) {
        free = implicit->filters[i].freedom == TL_MOVES_FREELY;
        missing =
            vec3d_add(missing, vec3d_muladd(implicit->push[i], implicit->step[i], -implicit->inertia[i]));
        inertia += implicit->inertia[i];
    }
    for (size_t i = 0; i < implicit->count && free; i++)
        implicit->step[i] = vec3d_muladd(implicit->step[i], missing, 1 / inertia);
}

/* Solves until contact agrees; adds to `total`. */
static void solve(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                  const struct tl_particles *particles, struct tl_solve_result *total)
{
    struct tl_system system = {.stiffness = &implicit->stiffness,
                               .factor = implicit->factor,
                               .inertia = implicit->resisted,
                               .load = implicit->resisted_load,
                               .filters = implicit->filters,
                               .tolerance = problem->tolerance,
                               .floor = residual_floor(implicit, problem)};
    bool agreed = false;
    int left = problem->most_iterations;
    for (int round = 0; round < ROUNDS && !agreed && left > 0; round++) {
        apply_touches(implicit, particles);
        impose_given(implicit);
        system.most_iterations = left;
        struct tl_solve_result result = tl_solve(&system, &implicit->space, implicit->given, implicit->step);
        system.floor = result.goal; /* later rounds need no more than the first */
        left = round == 0 ? (int)(problem->agreement * result.iterations) + AGREEMENT_LEAST
                          : left - result.iterations;
        total->iterations += result.iterations;
        total->converged = total->converged && (result.converged || round > 0);
        bool touches_agree = judge_touches(implicit, problem, &system);
        agreed = tl_presses_judge(implicit->presses, problem->contacts, implicit->step, &implicit->stiffness,
                                  implicit->load) &&
                 touches_agree;
    }
}

/* ---- A step ---- */

/* at = previous + given + share (step - given). */
static void place(tl_implicit *implicit, const struct tl_particles *particles, double share)
{
    for (size_t i = 0; i < implicit->count; i++)
        implicit->at[i] =
            vec3d_add(particles->previous[i], vec3d_mix(implicit->given[i], implicit->step[i], share));
}

/* The energy that a step may end with: what pins and contacts move does work of its own, so that their move
 * alone may be where it starts. */
static double allowed_energy(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                             const struct tl_particles *particles, double before)
{
    place(implicit, particles, 0);
    return fmax(before, energy_at(implicit, problem, particles, implicit->at));
}

/* Halves the step until it gains no energy; at last only what is given is left of it. */
static void shorten(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                    const struct tl_particles *particles, double most)
{
    double share = 0.5;
    for (int halving = 1; halving < HALVINGS; halving++, share /= 2) {
        place(implicit, particles, share);
        if (energy_at(implicit, problem, particles, implicit->at) <= most)
            return;
    }
    place(implicit, particles, 0);
}

/* Linearises until no energy is gained; returns whether it had to be shortened. */
static bool find_step(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                      const struct tl_particles *particles, double before, struct tl_solve_result *total)
{
    double most = before;
    for (int times = 1;; times++) {
        linearise(implicit, problem, particles);
        solve(implicit, problem, particles, total);
        keep_momentum(implicit, problem);
        place(implicit, particles, 1);
        double after = energy_at(implicit, problem, particles, implicit->at);
        if (after > most && times == 1) {
            most = allowed_energy(implicit, problem, particles, before);
            place(implicit, particles, 1);
            after = energy_at(implicit, problem, particles, implicit->at); /* and the forces there */
        }
        if (after <= most)
            return false;
        if (times == LINEARISED) {
            shorten(implicit, problem, particles, most);
            return true;
        }
    }
}

void tl_implicit_step(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                      struct tl_particles *particles, struct tl_implicit_tally *tally)
{
    const double rounding = 1e-9;
    struct tl_solve_result total = {.converged = true};
    begin(implicit, problem, particles);
    tl_presses_begin(implicit->presses, problem->contacts, &problem->contact, particles->previous,
                     implicit->inertia, stiffest(problem->fabric));
    double before =
        elastic_energy(problem, implicit->count, implicit->at, implicit->elastic) + kinetic_energy(particles);
    bool shortened = find_step(implicit, problem, particles, before * (1 + rounding), &total);
    memcpy(particles->x, implicit->at, implicit->count * sizeof *implicit->at);
    tally->steps++;
    tally->iterations += (size_t)total.iterations;
    tally->unconverged += !total.converged;
    tally->shortened += shortened;
}
