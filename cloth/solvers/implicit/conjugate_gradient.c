#include "cloth/solvers/implicit/conjugate_gradient.h"

#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Vertices of one partial sum. */
#define RUN 256

struct tl_conjugate_gradient_space tl_conjugate_gradient_space_create(size_t vertex_count)
{
    return (struct tl_conjugate_gradient_space){.vertex_count = vertex_count,
                                                .residual = TL_NEW_ARRAY(vec3d, vertex_count),
                                                .conditioned = TL_NEW_ARRAY(vec3d, vertex_count),
                                                .direction = TL_NEW_ARRAY(vec3d, vertex_count),
                                                .product = TL_NEW_ARRAY(vec3d, vertex_count),
                                                .sums = TL_NEW_ARRAY(double, vertex_count / RUN + 1)};
}

void tl_conjugate_gradient_space_release(struct tl_conjugate_gradient_space *space)
{
    free(space->residual);
    free(space->conditioned);
    free(space->direction);
    free(space->product);
    free(space->sums);
    *space = (struct tl_conjugate_gradient_space){0};
}

static vec3d filtered(const struct tl_motion_filter *filter, vec3d v)
{
    if (filter->allowed == TL_DOF_NONE)
        return (vec3d){0};
    if (filter->allowed == TL_DOF_TANGENTIAL)
        return vec3d_muladd(v, filter->direction, -vec3d_dot(v, filter->direction));
    return v;
}

static vec3d product_row(const struct tl_linear_system *system, size_t vertex, const vec3d *p)
{
    return vec3d_muladd(tl_stiffness_row(system->stiffness, vertex, p), p[vertex], system->inertia[vertex]);
}

vec3d tl_reaction_at(const struct tl_linear_system *system, size_t vertex, const vec3d *step)
{
    return vec3d_sub(product_row(system, vertex, step), system->load[vertex]);
}

/* ---- Runs ---- */

static size_t run_count(const struct tl_conjugate_gradient_space *space)
{
    return (space->vertex_count + RUN - 1) / RUN;
}

static size_t run_end(const struct tl_conjugate_gradient_space *space, size_t run)
{
    return run + 1 < run_count(space) ? (run + 1) * RUN : space->vertex_count;
}

static double add_up(const struct tl_conjugate_gradient_space *space)
{
    double sum = 0;
    for (size_t run = 0; run < run_count(space); run++)
        sum += space->sums[run];
    return sum;
}

/* z = S P^-1 r; returns r.z. */
static double precondition(const struct tl_linear_system *system, struct tl_conjugate_gradient_space *space)
{
    tl_factor_solve(system->factor, space->residual, space->conditioned);
#pragma omp parallel for schedule(static) if (space->vertex_count > TL_PARALLEL_ROWS)
    for (size_t run = 0; run < run_count(space); run++) {
        double sum = 0;
        for (size_t i = run * RUN; i < run_end(space, run); i++) {
            space->conditioned[i] = filtered(&system->filters[i], space->conditioned[i]);
            sum += vec3d_dot(space->residual[i], space->conditioned[i]);
        }
        space->sums[run] = sum;
    }
    return add_up(space);
}

/* product = A p; returns p.Ap. */
static double multiply(const struct tl_linear_system *system, struct tl_conjugate_gradient_space *space,
                       const vec3d *p)
{
#pragma omp parallel for schedule(static) if (space->vertex_count > TL_PARALLEL_ROWS)
    for (size_t run = 0; run < run_count(space); run++) {
        double sum = 0;
        for (size_t i = run * RUN; i < run_end(space, run); i++) {
            space->product[i] = product_row(system, i, p);
            sum += vec3d_dot(p[i], space->product[i]);
        }
        space->sums[run] = sum;
    }
    return add_up(space);
}

/* r = S (b - A step). */
static void find_residual(const struct tl_linear_system *system, struct tl_conjugate_gradient_space *space,
                          const vec3d *step)
{
#pragma omp parallel for schedule(static) if (space->vertex_count > TL_PARALLEL_ROWS)
    for (size_t i = 0; i < space->vertex_count; i++) {
        vec3d residual = vec3d_scale(tl_reaction_at(system, i, step), -1);
        space->residual[i] = filtered(&system->filters[i], residual);
    }
}

/* step += share p, r -= share S A p. */
static void update_step(const struct tl_linear_system *system, struct tl_conjugate_gradient_space *space,
                        double share, vec3d *step)
{
#pragma omp parallel for schedule(static) if (space->vertex_count > TL_PARALLEL_ROWS)
    for (size_t i = 0; i < space->vertex_count; i++) {
        step[i] = vec3d_muladd(step[i], space->direction[i], share);
        vec3d taken = filtered(&system->filters[i], space->product[i]);
        space->residual[i] = vec3d_muladd(space->residual[i], taken, -share);
    }
}

/* p = z + share p. */
static void update_direction(struct tl_conjugate_gradient_space *space, double share)
{
#pragma omp parallel for schedule(static) if (space->vertex_count > TL_PARALLEL_ROWS)
    for (size_t i = 0; i < space->vertex_count; i++)
        space->direction[i] = vec3d_muladd(space->conditioned[i], space->direction[i], share);
}

struct tl_conjugate_gradient_result tl_conjugate_gradient_solve(const struct tl_linear_system *system,
                                                                struct tl_conjugate_gradient_space *space,
                                                                const vec3d *prescribed, vec3d *step)
{
    struct tl_conjugate_gradient_result result = {0};
    find_residual(system, space, step);
    double from_step = precondition(system, space);
    find_residual(system, space, prescribed);
    double left = precondition(system, space);
    if (from_step < left) {
        find_residual(system, space, step);
        left = precondition(system, space);
    } else {
        memcpy(step, prescribed, space->vertex_count * sizeof *step);
    }
    result.goal = fmax(system->tolerance * system->tolerance * left, system->floor);
    memcpy(space->direction, space->conditioned, space->vertex_count * sizeof *space->direction);
    while (!(left <= result.goal) && result.iterations < system->max_iterations) {
        double curvature = multiply(system, space, space->direction);
        if (!(curvature > 0) || !isfinite(left))
            break;
        update_step(system, space, left / curvature, step);
        double before = left;
        left = precondition(system, space);
        update_direction(space, left / before);
        result.iterations++;
    }
    result.converged = left <= result.goal;
    return result;
}
