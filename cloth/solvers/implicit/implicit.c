#include "cloth/solvers/implicit/implicit.h"

#include "config/memory.h"

#include <stdlib.h>
#include <string.h>

/* Times that a step is solved again for particles that stick, slip or let go otherwise than was assumed. */
#define ROUNDS 8
/* Iterations that all further rounds may take in any case: in motion contact changes with every step anyway;
 * at rest, when solves are short, it must agree. */
#define MIN_CONTACT_ITERATIONS 30
/* Times that a step is linearised, and then halved, while it would gain energy. */
#define LINEARISED 4
#define HALVINGS   6

struct tl_implicit {
    size_t count;
    struct tl_stiffness stiffness;
    tl_factor *factor;
    struct tl_conjugate_gradient_space space;
    struct tl_motion_filter *filters;
    struct tl_contact_constraint *constraints;
    struct tl_penalty_contact *penalties;    /* [the contacts' sample_count] */
    double *inertia, *inertia_with_friction; /* N/m: mu, and with the friction of what slips */
    vec3d *inertial_load;                    /* N: inertia and gravity */
    vec3d *load, *load_with_friction;
    vec3d *elastic;    /* N */
    vec3d *prescribed; /* m, the filtered parts of the step */
    vec3d *step;       /* m */
    vec3d *at;         /* m, positions where the forces are linearised, and of a trial */
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

/* Of all that pulls, with its forces. */
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

/* What holds for the whole step: inertia, planes, and what it starts from. */
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

/* Adds the hand's stiffness, of its two the lesser: across what it pulls. */
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

/* K and the load mu (y - x) + f + K (at - x) at the present `at`, whose elastic forces are known. */
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

/* What each particle may do, what of its step is given, and what friction resists. */
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

/* Keeps what the step does where it is free, and gives the rest. */
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

/* Whether every particle does what was assumed. */
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

/* Squared residuals that need no more work: of speeds of 1e-5 m/s, as closely as others are solved; and
 * rounding, of positions within a few metres. */
static double residual_floor(const tl_implicit *implicit, const struct tl_implicit_problem *problem)
{
    const double rounding_m = 4e-15;
    double still_m = 1e-5 * problem->tolerance * problem->h, inertia = 0;
    for (size_t i = 0; i < implicit->count; i++)
        inertia += implicit->inertia[i];
    return inertia * (still_m * still_m + rounding_m * rounding_m) +
           (double)implicit->count * max_stiffness(problem->fabric) * rounding_m * rounding_m;
}

/* What only falls and flies keeps its momentum to rounding, however little is solved: elastic forces add up
 * to nothing, so its mean way is that of inertia. */
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

/* Solves until contact agrees; adds to `total`. */
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

/* at = previous + given + share (step - given). */
static void set_trial(tl_implicit *implicit, const struct tl_particles *particles, double share)
{
    for (size_t i = 0; i < implicit->count; i++)
        implicit->at[i] =
            vec3d_add(particles->previous[i], vec3d_mix(implicit->prescribed[i], implicit->step[i], share));
}

/* The energy that a step may end with: what pins and contacts move does work of its own, so that their move
 * alone may be where it starts. */
static double allowed_energy(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                             const struct tl_particles *particles, double before)
{
    set_trial(implicit, particles, 0);
    return fmax(before, energy_at(implicit, problem, particles, implicit->at));
}

/* Halves the step until it gains no energy; at last only what is given is left of it. */
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

/* Linearises until no energy is gained; returns whether it had to be shortened. */
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
            after = energy_at(implicit, problem, particles, implicit->at); /* and the forces there */
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
