#include "cloth/implicit.h"

#include "config/memory.h"

#include <stdlib.h>
#include <string.h>

/* Times that a step solves again for particles that stick, slip or let go otherwise than was assumed. */
#define ROUNDS 4
/* A particle nearer to its plane than this at the start is taken to touch it still. */
#define TOUCHING_M 1e-4
/* Halvings of a step that the guard tries. */
#define HALVINGS 6

enum touch { FREE, STICKS, SLIPS };

struct tl_implicit {
    size_t count;
    struct tl_stiffness stiffness;
    struct tl_solve_space space;
    struct tl_filter *filters;
    double *inertia;
    vec3d *load, *elastic; /* N: the right-hand side without friction, and elastic forces */
    vec3d *rubbed_load;    /* N, with the friction of those that slip */
    vec3d *given;          /* m, the filtered parts of the step */
    vec3d *step;           /* m */
    vec3d *trial;          /* m, positions */
    enum touch *touches;
    bool *bounded; /* has a plane */
    struct tl_contact_plane *planes;
    vec3d *rubs; /* N, friction on what slips */
};

tl_implicit *tl_implicit_create(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                                const struct tl_springs *springs, size_t vertex_count)
{
    tl_implicit *implicit = TL_NEW(tl_implicit);
    *implicit = (tl_implicit){.count = vertex_count,
                              .stiffness = tl_stiffness_build(energy, fabric, springs, vertex_count),
                              .space = tl_solve_space_create(vertex_count),
                              .filters = TL_NEW_ARRAY(struct tl_filter, vertex_count),
                              .inertia = TL_NEW_ARRAY(double, vertex_count),
                              .load = TL_NEW_ARRAY(vec3d, vertex_count),
                              .elastic = TL_NEW_ARRAY(vec3d, vertex_count),
                              .rubbed_load = TL_NEW_ARRAY(vec3d, vertex_count),
                              .given = TL_NEW_ARRAY(vec3d, vertex_count),
                              .step = TL_NEW_ARRAY(vec3d, vertex_count),
                              .trial = TL_NEW_ARRAY(vec3d, vertex_count),
                              .touches = TL_NEW_ARRAY(enum touch, vertex_count),
                              .bounded = TL_NEW_ARRAY(bool, vertex_count),
                              .planes = TL_NEW_ARRAY(struct tl_contact_plane, vertex_count),
                              .rubs = TL_NEW_ARRAY(vec3d, vertex_count)};
    return implicit;
}

void tl_implicit_destroy(tl_implicit **implicit)
{
    if (!*implicit)
        return;
    tl_stiffness_release(&(*implicit)->stiffness);
    tl_solve_space_release(&(*implicit)->space);
    void *const arrays[] = {(*implicit)->filters, (*implicit)->inertia,     (*implicit)->load,
                            (*implicit)->elastic, (*implicit)->rubbed_load, (*implicit)->given,
                            (*implicit)->step,    (*implicit)->trial,       (*implicit)->touches,
                            (*implicit)->bounded, (*implicit)->planes,      (*implicit)->rubs};
    for (size_t i = 0; i < TL_COUNT(arrays); i++)
        free(arrays[i]);
    free(*implicit);
    *implicit = NULL;
}

/* ---- Energy and forces of all that pulls ---- */

static double add_pull(const struct tl_pull *pull, const vec3d *x, vec3d *forces)
{
    if (pull->particle == TL_NONE)
        return 0;
    vec3d way = vec3d_sub(pull->target, x[pull->particle]);
    double length = vec3d_norm(way), k = pull->stiffness, most = pull->most_force;
    double force = fmin(k * length, most);
    forces[pull->particle] = vec3d_muladd(forces[pull->particle], vec3d_unit_or(way, (vec3d){0}), force);
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

static double elastic_energy(const struct tl_implicit_problem *problem, size_t count, const vec3d *x,
                             vec3d *forces)
{
    double energy = tl_energy_forces(problem->energy, problem->fabric, count, x, forces);
    for (size_t i = 0; i < problem->springs.count; i++)
        energy += add_spring(&problem->springs.links[i], problem->springs.stiffness, x, forces);
    return energy + add_pull(&problem->pull, x, forces);
}

/* ---- The linear system ---- */

/* mu and mu (y - x) + f. */
static void set_up(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                   const struct tl_particles *particles)
{
    double h = problem->h, drag = 1 + problem->drag * h;
    for (size_t i = 0; i < implicit->count; i++) {
        double w = particles->w[i], mass = w > 0 ? 1 / w : 0;
        vec3d push = vec3d_scale(particles->v[i], mass / h);
        push.y -= problem->gravity * mass;
        implicit->inertia[i] = mass * drag / (h * h);
        implicit->load[i] = vec3d_add(push, implicit->elastic[i]);
    }
}

/* The hand's own stiffness, of the smaller kind: across what it pulls. */
static void stiffen_pulled(tl_implicit *implicit, const struct tl_implicit_problem *problem, const vec3d *x)
{
    const struct tl_pull *pull = &problem->pull;
    if (pull->particle == TL_NONE)
        return;
    double length = vec3d_distance(pull->target, x[pull->particle]);
    implicit->inertia[pull->particle] +=
        pull->stiffness * length <= pull->most_force ? pull->stiffness : pull->most_force / length;
}

/* ---- Contact ---- */

/* How far a particle that only obeys its inertia would pass a plane; negative: not at all. */
static double trespass(const struct tl_contact_plane *plane, vec3d way)
{
    return plane->least - vec3d_dot(way, plane->normal);
}

/* Where the solver heeds one plane only, it is the one that would be passed the farthest. */
static void look_for_plane(tl_implicit *implicit, const struct tl_implicit_problem *problem, size_t i,
                           vec3d x, vec3d way)
{
    struct tl_contact_plane planes[TL_CONTACT_PLANES];
    size_t count = tl_contacts_planes(problem->contacts, &problem->contact, i, x, planes);
    implicit->bounded[i] = count > 0;
    for (size_t k = 0; k < count; k++)
        if (k == 0 || trespass(&planes[k], way) > trespass(&implicit->planes[i], way))
            implicit->planes[i] = planes[k];
    const struct tl_contact_plane *plane = &implicit->planes[i];
    double gap = count > 0 ? vec3d_dot(plane->motion, plane->normal) - plane->least : HUGE_VAL;
    if (gap > TOUCHING_M)
        implicit->touches[i] = FREE;
    else if (implicit->touches[i] == FREE && trespass(plane, way) > 0)
        implicit->touches[i] = STICKS;
}

static void look_for_planes(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                            const struct tl_particles *particles)
{
    double h = problem->h, keep = 1 / (1 + problem->drag * h);
    for (size_t i = 0; i < implicit->count; i++) {
        implicit->bounded[i] = false;
        if (!(particles->w[i] > 0))
            continue;
        vec3d way = vec3d_scale(particles->v[i], h * keep);
        way.y -= problem->gravity * h * h * keep;
        look_for_plane(implicit, problem, i, particles->previous[i], way);
    }
}

/* What each particle may do, what of its step is given, and friction. */
static void apply_touches(tl_implicit *implicit, const struct tl_particles *particles)
{
    for (size_t i = 0; i < implicit->count; i++) {
        const struct tl_contact_plane *plane = &implicit->planes[i];
        enum touch touch = implicit->bounded[i] ? implicit->touches[i] : FREE;
        double closing = plane->least - vec3d_dot(plane->motion, plane->normal);
        struct tl_filter filter = {.freedom = TL_MOVES_FREELY};
        vec3d given = {0};
        if (!(particles->w[i] > 0)) {
            filter.freedom = TL_MOVES_NOT;
            given = vec3d_sub(particles->x[i], particles->previous[i]);
        } else if (touch == STICKS) {
            filter.freedom = TL_MOVES_NOT;
            given = vec3d_muladd(plane->motion, plane->normal, closing);
        } else if (touch == SLIPS) {
            filter = (struct tl_filter){TL_MOVES_ACROSS, plane->normal};
            given = vec3d_scale(plane->normal, plane->least);
        }
        implicit->filters[i] = filter;
        implicit->given[i] = given;
        implicit->rubbed_load[i] =
            touch == SLIPS ? vec3d_add(implicit->load[i], implicit->rubs[i]) : implicit->load[i];
    }
}

/* Keeps what the step does where it is free, and gives the rest. */
static void impose_given(tl_implicit *implicit)
{
    for (size_t i = 0; i < implicit->count; i++) {
        const struct tl_filter *filter = &implicit->filters[i];
        vec3d step = implicit->step[i];
        if (filter->freedom == TL_MOVES_NOT)
            implicit->step[i] = implicit->given[i];
        else if (filter->freedom == TL_MOVES_ACROSS)
            implicit->step[i] = vec3d_muladd(
                step, filter->direction, vec3d_dot(vec3d_sub(implicit->given[i], step), filter->direction));
    }
}

/* What the reaction on a touching particle says it does. */
static enum touch judge_touching(tl_implicit *implicit, size_t i, vec3d reaction, double friction)
{
    const struct tl_contact_plane *plane = &implicit->planes[i];
    double pressed = vec3d_dot(reaction, plane->normal);
    if (!(pressed > 0))
        return FREE;
    vec3d rub = vec3d_muladd(reaction, plane->normal, -pressed);
    vec3d slip = vec3d_sub(implicit->step[i], plane->motion);
    slip = vec3d_muladd(slip, plane->normal, -vec3d_dot(slip, plane->normal));
    double most = friction * pressed;
    if (implicit->touches[i] == STICKS) {
        double held = vec3d_norm(rub);
        if (held <= most)
            return STICKS;
        implicit->rubs[i] = vec3d_scale(rub, most / held);
        return SLIPS;
    }
    if (vec3d_dot(slip, implicit->rubs[i]) > 0) /* friction stops, it does not drive */
        return STICKS;
    vec3d against = vec3d_unit_or(vec3d_scale(slip, -1), vec3d_unit_or(implicit->rubs[i], (vec3d){0}));
    implicit->rubs[i] = vec3d_scale(against, most);
    return SLIPS;
}

/* Whether every particle does what was assumed; else what it does is assumed next. */
static bool judge_touches(tl_implicit *implicit, const struct tl_system *system, double friction)
{
    size_t changed = 0;
#pragma omp parallel for schedule(static) reduction(+ : changed)
    for (size_t i = 0; i < implicit->count; i++) {
        if (!implicit->bounded[i])
            continue;
        enum touch touch = implicit->touches[i];
        if (touch == FREE && trespass(&implicit->planes[i], implicit->step[i]) > 0)
            touch = STICKS;
        else if (touch != FREE) {
            vec3d reaction = vec3d_add(tl_solve_reaction(system, i, implicit->step),
                                       vec3d_sub(system->load[i], implicit->load[i]));
            touch = judge_touching(implicit, i, reaction, friction);
        }
        changed += touch != implicit->touches[i];
        implicit->touches[i] = touch;
    }
    return changed == 0;
}

/* ---- A step ---- */

/* Inertia's own step, by as much as lowers the quadratic energy most: a free fall is solved by it. */
static void guess_step(tl_implicit *implicit, const struct tl_system *system,
                       const struct tl_implicit_problem *problem, const struct tl_particles *particles)
{
    double h = problem->h, keep = 1 / (1 + problem->drag * h);
    double along = 0, curvature = 0;
    for (size_t i = 0; i < implicit->count; i++) {
        vec3d way = vec3d_scale(particles->v[i], h * keep);
        way.y -= problem->gravity * h * h * keep;
        implicit->step[i] = particles->w[i] > 0 ? way : (vec3d){0};
    }
    for (size_t i = 0; i < implicit->count; i++) {
        vec3d product = vec3d_add(tl_solve_reaction(system, i, implicit->step), system->load[i]);
        along += vec3d_dot(implicit->step[i], system->load[i]);
        curvature += vec3d_dot(implicit->step[i], product);
    }
    double share = along / curvature;
    share = isfinite(share) ? fmax(fmin(share, 1), 0) : 0;
    for (size_t i = 0; i < implicit->count; i++)
        implicit->step[i] = vec3d_scale(implicit->step[i], share);
}

static struct tl_solve_result solve_with_contact(tl_implicit *implicit,
                                                 const struct tl_implicit_problem *problem,
                                                 const struct tl_particles *particles, double floor)
{
    struct tl_system system = {.stiffness = &implicit->stiffness,
                               .inertia = implicit->inertia,
                               .load = implicit->load,
                               .filters = implicit->filters,
                               .tolerance = problem->tolerance,
                               .floor = floor,
                               .most_iterations = problem->most_iterations};
    guess_step(implicit, &system, problem, particles);
    system.load = implicit->rubbed_load;
    struct tl_solve_result total = {.converged = true};
    bool agreed = false;
    for (int round = 0; round < ROUNDS && !agreed; round++) {
        apply_touches(implicit, particles);
        impose_given(implicit);
        struct tl_solve_result result = tl_solve(&system, &implicit->space, implicit->step);
        total.iterations += result.iterations;
        total.converged = total.converged && result.converged;
        agreed = judge_touches(implicit, &system, problem->contact.friction);
    }
    return total;
}

/* x = previous + given + share (step - given). */
static void place(const tl_implicit *implicit, const struct tl_particles *particles, double share, vec3d *x)
{
    for (size_t i = 0; i < implicit->count; i++) {
        vec3d step = vec3d_mix(implicit->given[i], implicit->step[i], share);
        x[i] = vec3d_add(particles->previous[i], step);
    }
}

/* Kinetic, elastic and gravity's energy after a step; gravity's from the step's start. */
static double energy_after(tl_implicit *implicit, const struct tl_implicit_problem *problem,
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

static double kinetic_energy(const struct tl_particles *particles)
{
    double energy = 0;
    for (size_t i = 0; i < particles->count; i++)
        if (particles->w[i] > 0)
            energy += 0.5 * vec3d_dot(particles->v[i], particles->v[i]) / particles->w[i];
    return energy;
}

static bool moves(const tl_implicit *implicit)
{
    for (size_t i = 0; i < implicit->count; i++)
        if (vec3d_dot(implicit->given[i], implicit->given[i]) > 0)
            return true;
    return false;
}

/* Returns whether it shortened the step. */
static bool guard(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                  struct tl_particles *particles, double before)
{
    double share = 1;
    place(implicit, particles, share, implicit->trial);
    /* What pins and contacts move does work of its own: then its energy alone is where the step starts. */
    if (moves(implicit)) {
        place(implicit, particles, 0, particles->x);
        before = fmax(before, energy_after(implicit, problem, particles, particles->x));
    }
    const double rounding = 1e-9;
    double most = before + rounding * fabs(before);
    bool shortened = false;
    for (int halving = 0; halving < HALVINGS; halving++) {
        double after = energy_after(implicit, problem, particles, implicit->trial);
        if (after <= most)
            break;
        shortened = true;
        share = halving + 1 < HALVINGS ? share / 2 : 0;
        place(implicit, particles, share, implicit->trial);
    }
    memcpy(particles->x, implicit->trial, implicit->count * sizeof *implicit->trial);
    return shortened;
}

/* Residuals (J) that are rounding: of a step of 1e-11 m, and of forces as large as the stiffness makes them.
 */
static double residual_floor(const tl_implicit *implicit)
{
    const double least_m = 1e-11;
    double inertia = 0;
    for (size_t i = 0; i < implicit->count; i++)
        inertia += implicit->inertia[i];
    return inertia * least_m * least_m;
}

void tl_implicit_step(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                      struct tl_particles *particles, struct tl_implicit_tally *tally)
{
    const vec3d *start = particles->previous;
    double before =
        kinetic_energy(particles) + elastic_energy(problem, implicit->count, start, implicit->elastic);
    tl_stiffness_assemble(&implicit->stiffness, problem->energy, problem->fabric, &problem->springs, start);
    set_up(implicit, problem, particles);
    double floor = residual_floor(implicit);
    stiffen_pulled(implicit, problem, start);
    look_for_planes(implicit, problem, particles);
    struct tl_solve_result result = solve_with_contact(implicit, problem, particles, floor);
    bool shortened = guard(implicit, problem, particles, before);
    tally->steps++;
    tally->iterations += (size_t)result.iterations;
    tally->unconverged += !result.converged;
    tally->shortened += shortened;
}
