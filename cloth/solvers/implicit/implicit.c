#include "cloth/solvers/implicit/implicit.h"

#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Maximum solves of a step for its contact states: particles that stick, slip or separate otherwise than
 * assumed. */
#define ROUNDS 8
/* Iterations that further rounds may take in any case. In motion contact changes with every step, so the
 * budget is relative; at rest solves are short, and the contact states must become consistent. */
#define MIN_CONTACT_ITERATIONS 30
/* Maximum linearisations of a step, and then halvings, while it would gain energy. */
#define LINEARISED 4
#define HALVINGS   6

struct tl_implicit {
    size_t count;
    struct tl_stiffness stiffness;
    tl_factor *factor;
    struct tl_conjugate_gradient_space space;
    struct tl_motion_filter *filters;
    struct tl_contact_constraint *constraints;
    struct tl_penalty_contact *penalties; /* [the contacts' sample_count] */
    double *inertia,
        *inertia_with_friction; /* N/m: mu, and mu plus the friction resistance of slipping contacts */
    vec3d *inertial_load;       /* N: mu (y - x) */
    vec3d *load, *load_with_friction;
    vec3d *elastic;    /* N */
    vec3d *prescribed; /* m, the prescribed part of the step, which filters remove from the solve */
    vec3d *step;       /* m */
    vec3d *at;         /* m, positions at which the forces are linearised, and those of a trial step */
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
    implicit->space = tl_conjugate_gradient_space_create(count);
    implicit->filters = TL_NEW_ARRAY(struct tl_motion_filter, count);
    implicit->constraints = TL_NEW_ARRAY(struct tl_contact_constraint, count);
    implicit->penalties = TL_NEW_ARRAY(struct tl_penalty_contact, problem->contacts->sample_count);
    implicit->inertia = TL_NEW_ARRAY(double, count);
    implicit->inertia_with_friction = TL_NEW_ARRAY(double, count);
    implicit->inertial_load = TL_NEW_ARRAY(vec3d, count);
    implicit->load = TL_NEW_ARRAY(vec3d, count);
    implicit->load_with_friction = TL_NEW_ARRAY(vec3d, count);
    implicit->elastic = TL_NEW_ARRAY(vec3d, count);
    implicit->prescribed = TL_NEW_ARRAY(vec3d, count);
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
    tl_conjugate_gradient_space_release(&implicit->space);
    void *const arrays[] = {implicit->penalties,
                            implicit->filters,
                            implicit->constraints,
                            implicit->inertia,
                            implicit->inertia_with_friction,
                            implicit->inertial_load,
                            implicit->load,
                            implicit->load_with_friction,
                            implicit->elastic,
                            implicit->prescribed,
                            implicit->step,
                            implicit->at};
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
    vec3d inertial = vec3d_sub(hand->target, x[hand->particle]);
    double length = vec3d_norm(inertial), k = hand->stiffness, max = hand->max_force;
    double force = fmin(k * length, max);
    forces[hand->particle] = vec3d_muladd(forces[hand->particle], vec3d_unit_or(inertial, (vec3d){0}), force);
    return force < max ? 0.5 * k * length * length : max * length - 0.5 * max * max / k;
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

/* Elastic energy of the cloth, springs and pull; writes their forces. */
static double elastic_energy(const struct tl_implicit_problem *problem, size_t count, const vec3d *x,
                             vec3d *forces)
{
    double energy = tl_energy_evaluate(problem->energy, problem->fabric, count, x, forces);
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

/* Total energy after a step that ends at x: kinetic, elastic and gravitational, the latter relative to the
 * start. */
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

static vec3d inertial_step(const struct tl_implicit_problem *problem, vec3d v)
{
    vec3d inertial = vec3d_scale(v, problem->h);
    inertial.y -= problem->gravity * problem->h * problem->h;
    return vec3d_scale(inertial, 1 / (1 + problem->drag * problem->h));
}

static double inertia_of(const struct tl_implicit_problem *problem, double inverse_mass)
{
    return inverse_mass > 0 ? (1 + problem->drag * problem->h) / (inverse_mass * problem->h * problem->h) : 0;
}

/* Sets what does not change while a step is solved: inertia, contact planes and the initial guess, the
 * inertial step. */
static void begin(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                  const struct tl_particles *particles)
{
    for (size_t i = 0; i < implicit->count; i++) {
        double w = particles->w[i];
        vec3d inertial = w > 0 ? inertial_step(problem, particles->v[i]) : (vec3d){0};
        implicit->inertia[i] = inertia_of(problem, w);
        implicit->inertial_load[i] = vec3d_scale(inertial, implicit->inertia[i]);
        implicit->step[i] = inertial;
        implicit->at[i] = particles->previous[i];
        implicit->constraints[i].has_plane = false;
        if (w > 0)
            tl_contact_constraint_begin(&implicit->constraints[i], problem->contacts, &problem->contact, i,
                                        particles->previous[i], inertial);
    }
}

/* Adds the pull's stiffness. Along the spring it is k, or 0 once the force is at its bound; across it force /
 * length. Adding the smaller of k and max_force / length in all directions keeps the matrix symmetric
 * positive definite. */
static void linearise_hand(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                           const struct tl_particles *particles)
{
    const struct tl_hand *hand = &problem->hand;
    uint32_t i = hand->particle;
    if (i == TL_NONE || !(particles->w[i] > 0))
        return;
    double length = vec3d_distance(hand->target, implicit->at[i]);
    double stiffness = fmin(hand->stiffness, hand->max_force / length);
    implicit->inertia[i] = inertia_of(problem, particles->w[i]) + stiffness;
    implicit->load[i] = vec3d_muladd(implicit->load[i], implicit->prescribed[i], stiffness);
}

static double max_stiffness(const struct tl_cloth_fabric *fabric)
{
    return fmax(fmax(fabric->stretch_weft, fabric->stretch_warp), fabric->shear);
}

/* Assembles K and the load mu (y - x) + f + K (at - x) at the positions `at`, whose elastic forces are known.
 * The last term makes the unknown the whole step from x, also when `at` is the end of an earlier trial. */
static void linearise(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                      const struct tl_particles *particles)
{
    tl_stiffness_assemble(&implicit->stiffness, problem->energy, problem->fabric, &problem->springs,
                          implicit->at);
    for (size_t i = 0; i < implicit->count; i++)
        implicit->prescribed[i] = vec3d_sub(implicit->at[i], particles->previous[i]);
#pragma omp parallel for schedule(static) if (implicit->count > TL_PARALLEL_ROWS)
    for (size_t i = 0; i < implicit->count; i++) {
        vec3d carried = tl_stiffness_row(&implicit->stiffness, i, implicit->prescribed);
        implicit->load[i] = vec3d_add(vec3d_add(implicit->inertial_load[i], implicit->elastic[i]), carried);
    }
    linearise_hand(implicit, problem, particles);
    tl_penalty_contacts_add(implicit->penalties, problem->contacts, &implicit->stiffness, implicit->load);
}

/* Sets each particle's degrees of freedom, the prescribed part of its step, and the friction resistance. */
static void apply_constraints(tl_implicit *implicit, const struct tl_particles *particles)
{
    for (size_t i = 0; i < implicit->count; i++) {
        const struct tl_contact_constraint *constraint = &implicit->constraints[i];
        struct tl_motion_filter *filter = &implicit->filters[i];
        *filter = tl_contact_constraint_filter(constraint, &implicit->prescribed[i]);
        if (!(particles->w[i] > 0)) {
            filter->allowed = TL_DOF_NONE;
            implicit->prescribed[i] = vec3d_sub(particles->x[i], particles->previous[i]);
        }
        double resistance = filter->allowed == TL_DOF_TANGENTIAL ? constraint->resistance : 0;
        implicit->inertia_with_friction[i] = implicit->inertia[i] + resistance;
        implicit->load_with_friction[i] =
            vec3d_muladd(implicit->load[i], constraint->plane.motion, resistance);
    }
}

/* Replaces the filtered part of the initial guess by the prescribed part; the free part is kept. */
static void impose_prescribed(tl_implicit *implicit)
{
    for (size_t i = 0; i < implicit->count; i++) {
        const struct tl_motion_filter *filter = &implicit->filters[i];
        vec3d missing = vec3d_sub(implicit->prescribed[i], implicit->step[i]);
        if (filter->allowed == TL_DOF_NONE)
            implicit->step[i] = implicit->prescribed[i];
        else if (filter->allowed == TL_DOF_TANGENTIAL)
            implicit->step[i] =
                vec3d_muladd(implicit->step[i], filter->direction, vec3d_dot(missing, filter->direction));
    }
}

/* Compares every contact's assumed state with its reaction; returns whether all agree. */
static bool update_constraints(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                               const struct tl_linear_system *system)
{
    struct tl_linear_system without_friction = *system;
    without_friction.inertia = implicit->inertia;
    without_friction.load = implicit->load;
    bool agreed = true;
#pragma omp parallel for schedule(static) reduction(&& : agreed) if (implicit->count > TL_PARALLEL_ROWS)
    for (size_t i = 0; i < implicit->count; i++)
        if (implicit->constraints[i].has_plane) {
            vec3d reaction = tl_reaction_at(&without_friction, i, implicit->step);
            bool same = tl_contact_constraint_update(&implicit->constraints[i], &problem->contact,
                                                     implicit->step[i], reaction, implicit->inertia[i]);
            agreed = agreed && same;
        }
    return agreed;
}

/* The squared residual (J, in the preconditioner's norm) below which a solve ends whatever its start: what
 * corresponds to a velocity of 1e-5 m/s solved to the same tolerance, and to the rounding of positions within
 * a few metres. At rest the relative criterion alone would chase rounding errors. */
static double residual_floor(const tl_implicit *implicit, const struct tl_implicit_problem *problem)
{
    const double rounding_m = 4e-15;
    double still_m = 1e-5 * problem->tolerance * problem->h, inertia = 0;
    for (size_t i = 0; i < implicit->count; i++)
        inertia += implicit->inertia[i];
    return inertia * (still_m * still_m + rounding_m * rounding_m) +
           (double)implicit->count * max_stiffness(problem->fabric) * rounding_m * rounding_m;
}

/* Restores the total momentum of cloth that touches nothing: elastic forces sum to 0, so the mean step must
 * be the inertial one, which an inexact solve misses. One translation of all corrects it. */
static void keep_momentum(tl_implicit *implicit, const struct tl_implicit_problem *problem)
{
    vec3d missing = {0};
    double inertia = 0;
    bool free = problem->hand.particle == TL_NONE;
    for (size_t i = 0; i < problem->contacts->sample_count && free; i++)
        free = !implicit->penalties[i].active;
    for (size_t i = 0; i < implicit->count && free; i++) {
        free = implicit->filters[i].allowed == TL_DOF_ALL;
        missing = vec3d_add(
            missing, vec3d_muladd(implicit->inertial_load[i], implicit->step[i], -implicit->inertia[i]));
        inertia += implicit->inertia[i];
    }
    for (size_t i = 0; i < implicit->count && free; i++)
        implicit->step[i] = vec3d_muladd(implicit->step[i], missing, 1 / inertia);
}

/* Solves for the step, and again while contact states change. Later rounds start from the last solution and
 * aim at the first round's residual: more exactness would be wasted on them. Adds to `total`. */
static void solve(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                  const struct tl_particles *particles, struct tl_conjugate_gradient_result *total)
{
    struct tl_linear_system system = {.stiffness = &implicit->stiffness,
                                      .factor = implicit->factor,
                                      .inertia = implicit->inertia_with_friction,
                                      .load = implicit->load_with_friction,
                                      .filters = implicit->filters,
                                      .tolerance = problem->tolerance,
                                      .floor = residual_floor(implicit, problem)};
    bool agreed = false;
    int left = problem->max_iterations;
    for (int round = 0; round < ROUNDS && !agreed && left > 0; round++) {
        apply_constraints(implicit, particles);
        impose_prescribed(implicit);
        system.max_iterations = left;
        struct tl_conjugate_gradient_result result =
            tl_conjugate_gradient_solve(&system, &implicit->space, implicit->prescribed, implicit->step);
        system.floor = result.goal; /* later rounds need no more than the first */
        left = round == 0 ? (int)(problem->contact_budget * result.iterations) + MIN_CONTACT_ITERATIONS
                          : left - result.iterations;
        total->iterations += result.iterations;
        total->converged = total->converged && (result.converged || round > 0);
        bool constraints_agree = update_constraints(implicit, problem, &system);
        agreed = tl_penalty_contacts_update(implicit->penalties, problem->contacts, implicit->step,
                                            &implicit->stiffness, implicit->load) &&
                 constraints_agree;
    }
}

/* ---- A step ---- */

/* at = previous + prescribed + share (step - prescribed). */
static void set_trial(tl_implicit *implicit, const struct tl_particles *particles, double share)
{
    for (size_t i = 0; i < implicit->count; i++)
        implicit->at[i] =
            vec3d_add(particles->previous[i], vec3d_mix(implicit->prescribed[i], implicit->step[i], share));
}

/* The energy that a step may end with. Pins and contact planes that move do work, so the bound is at least
 * the energy after the prescribed part of the step alone. */
static double allowed_energy(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                             const struct tl_particles *particles, double before)
{
    set_trial(implicit, particles, 0);
    return fmax(before, energy_at(implicit, problem, particles, implicit->at));
}

/* Halves the free part of the step until no energy is gained; after the last halving only the prescribed part
 * is left. */
static void shorten(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                    const struct tl_particles *particles, double max)
{
    double share = 0.5;
    for (int halving = 1; halving < HALVINGS; halving++, share /= 2) {
        set_trial(implicit, particles, share);
        if (energy_at(implicit, problem, particles, implicit->at) <= max)
            return;
    }
    set_trial(implicit, particles, 0);
}

/* Linearises and solves until no energy is gained; returns whether the step had to be shortened. */
static bool find_step(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                      const struct tl_particles *particles, double before,
                      struct tl_conjugate_gradient_result *total)
{
    double max = before;
    for (int times = 1;; times++) {
        linearise(implicit, problem, particles);
        solve(implicit, problem, particles, total);
        keep_momentum(implicit, problem);
        set_trial(implicit, particles, 1);
        double after = energy_at(implicit, problem, particles, implicit->at);
        if (after > max && times == 1) {
            max = allowed_energy(implicit, problem, particles, before);
            set_trial(implicit, particles, 1);
            after = energy_at(implicit, problem, particles, implicit->at); /* again, for the forces there */
        }
        if (after <= max)
            return false;
        if (times == LINEARISED) {
            shorten(implicit, problem, particles, max);
            return true;
        }
    }
}

void tl_implicit_step(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                      struct tl_particles *particles, struct tl_implicit_tally *tally)
{
    const double rounding = 1e-9;
    struct tl_conjugate_gradient_result total = {.converged = true};
    begin(implicit, problem, particles);
    tl_penalty_contacts_begin(implicit->penalties, problem->contacts, &problem->contact, particles->previous,
                              implicit->inertia, max_stiffness(problem->fabric));
    double before =
        elastic_energy(problem, implicit->count, implicit->at, implicit->elastic) + kinetic_energy(particles);
    bool shortened = find_step(implicit, problem, particles, before * (1 + rounding), &total);
    memcpy(particles->x, implicit->at, implicit->count * sizeof *implicit->at);
    tally->steps++;
    tally->iterations += (size_t)total.iterations;
    tally->unconverged += !total.converged;
    tally->shortened += shortened;
}
