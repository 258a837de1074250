#include "cloth/implicit_solve.h"

#include "config/memory.h"

#include <stdlib.h>
#include <string.h>

/* Vertices of one partial sum. */
#define RUN 256
/* Fewer vertices are done before other threads have woken up. */
#define SERIAL 1000

struct tl_solve_space tl_solve_space_create(size_t vertex_count)
{
    return (struct tl_solve_space){.vertex_count = vertex_count,
                                   .residual = TL_NEW_ARRAY(vec3d, vertex_count),
                                   .conditioned = TL_NEW_ARRAY(vec3d, vertex_count),
                                   .direction = TL_NEW_ARRAY(vec3d, vertex_count),
                                   .product = TL_NEW_ARRAY(vec3d, vertex_count),
                                   .inverse = tl_alloc(vertex_count, sizeof(double[9])),
                                   .sums = TL_NEW_ARRAY(double, vertex_count / RUN + 1)};
}

void tl_solve_space_release(struct tl_solve_space *space)
{
    free(space->residual);
    free(space->conditioned);
    free(space->direction);
    free(space->product);
    free(space->inverse);
    free(space->sums);
    *space = (struct tl_solve_space){0};
}

static vec3d filtered(const struct tl_filter *filter, vec3d v)
{
    if (filter->freedom == TL_MOVES_NOT)
        return (vec3d){0};
    if (filter->freedom == TL_MOVES_ACROSS)
        return vec3d_muladd(v, filter->direction, -vec3d_dot(v, filter->direction));
    return v;
}

static vec3d product_row(const struct tl_system *system, size_t vertex, const vec3d *p)
{
    return vec3d_muladd(tl_stiffness_row(system->stiffness, vertex, p), p[vertex], system->inertia[vertex]);
}

vec3d tl_solve_reaction(const struct tl_system *system, size_t vertex, const vec3d *step)
{
    return vec3d_sub(product_row(system, vertex, step), system->load[vertex]);
}

/* ---- The preconditioner ---- */

static bool invert(const double m[9], double out[9])
{
    double c0 = m[4] * m[8] - m[5] * m[7], c1 = m[5] * m[6] - m[3] * m[8], c2 = m[3] * m[7] - m[4] * m[6];
    double scale = 1 / (m[0] * c0 + m[1] * c1 + m[2] * c2);
    const double adjugate[9] = {c0, m[2] * m[7] - m[1] * m[8], m[1] * m[5] - m[2] * m[4],
                                c1, m[0] * m[8] - m[2] * m[6], m[2] * m[3] - m[0] * m[5],
                                c2, m[1] * m[6] - m[0] * m[7], m[0] * m[4] - m[1] * m[3]};
    bool good = isfinite(scale) && scale > 0;
    for (int i = 0; i < 9; i++) {
        out[i] = scale * adjugate[i];
        good = good && isfinite(out[i]);
    }
    return good;
}

/* S D S + s (I - S), S the filter: its inverse is that of D within what the filter lets through. */
static void confine(const struct tl_filter *filter, double block[9])
{
    double scale = (block[0] + block[4] + block[8]) / 3;
    double *rows[3] = {block, block + 3, block + 6};
    for (int i = 0; i < 3; i++) {
        vec3d row = filtered(filter, (vec3d){rows[i][0], rows[i][1], rows[i][2]});
        rows[i][0] = row.x, rows[i][1] = row.y, rows[i][2] = row.z;
    }
    for (int j = 0; j < 3; j++) {
        vec3d column = filtered(filter, (vec3d){rows[0][j], rows[1][j], rows[2][j]});
        rows[0][j] = column.x, rows[1][j] = column.y, rows[2][j] = column.z;
    }
    const double n[3] = {filter->direction.x, filter->direction.y, filter->direction.z};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            rows[i][j] += scale * n[i] * n[j];
}

static void condition_vertex(const struct tl_system *system, size_t vertex, double out[9])
{
    double block[9];
    tl_stiffness_diagonal(system->stiffness, vertex, block);
    for (int i = 0; i < 3; i++)
        block[4 * i] += system->inertia[vertex];
    double largest = fmax(fmax(block[0], block[4]), block[8]);
    if (system->filters[vertex].freedom == TL_MOVES_ACROSS)
        confine(&system->filters[vertex], block);
    if (!(largest > 0) || !invert(block, out)) /* next to singular: by its size alone */
        for (int i = 0; i < 9; i++)
            out[i] = i % 4 == 0 && largest > 0 ? 1 / largest : 0;
}

static vec3d conditioned(const struct tl_solve_space *space, const struct tl_filter *filter, size_t vertex)
{
    const double *m = space->inverse[vertex];
    vec3d r = space->residual[vertex];
    return filtered(filter,
                    (vec3d){m[0] * r.x + m[1] * r.y + m[2] * r.z, m[3] * r.x + m[4] * r.y + m[5] * r.z,
                            m[6] * r.x + m[7] * r.y + m[8] * r.z});
}

/* ---- Runs ---- */

static size_t run_count(const struct tl_solve_space *space)
{
    return (space->vertex_count + RUN - 1) / RUN;
}

static size_t run_end(const struct tl_solve_space *space, size_t run)
{
    return run + 1 < run_count(space) ? (run + 1) * RUN : space->vertex_count;
}

static double add_up(const struct tl_solve_space *space)
{
    double sum = 0;
    for (size_t run = 0; run < run_count(space); run++)
        sum += space->sums[run];
    return sum;
}

/* z = P^-1 r; returns r.z. */
static double condition(const struct tl_system *system, struct tl_solve_space *space)
{
#pragma omp parallel for schedule(static) if (space->vertex_count > SERIAL)
    for (size_t run = 0; run < run_count(space); run++) {
        double sum = 0;
        for (size_t i = run * RUN; i < run_end(space, run); i++) {
            space->conditioned[i] = conditioned(space, &system->filters[i], i);
            sum += vec3d_dot(space->residual[i], space->conditioned[i]);
        }
        space->sums[run] = sum;
    }
    return add_up(space);
}

/* product = A p; returns p.Ap. */
static double multiply(const struct tl_system *system, struct tl_solve_space *space, const vec3d *p)
{
#pragma omp parallel for schedule(static) if (space->vertex_count > SERIAL)
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

/* r = S (b - A step), or S b without a step. */
static void find_residual(const struct tl_system *system, struct tl_solve_space *space, const vec3d *step)
{
#pragma omp parallel for schedule(static) if (space->vertex_count > SERIAL)
    for (size_t i = 0; i < space->vertex_count; i++) {
        vec3d left = step ? vec3d_scale(tl_solve_reaction(system, i, step), -1) : system->load[i];
        space->residual[i] = filtered(&system->filters[i], left);
    }
}

/* step += share p, r -= share S A p, z = P^-1 r; returns r.z. */
static double advance(const struct tl_system *system, struct tl_solve_space *space, double share, vec3d *step)
{
#pragma omp parallel for schedule(static) if (space->vertex_count > SERIAL)
    for (size_t run = 0; run < run_count(space); run++) {
        double sum = 0;
        for (size_t i = run * RUN; i < run_end(space, run); i++) {
            step[i] = vec3d_muladd(step[i], space->direction[i], share);
            space->residual[i] =
                vec3d_muladd(space->residual[i], filtered(&system->filters[i], space->product[i]), -share);
            space->conditioned[i] = conditioned(space, &system->filters[i], i);
            sum += vec3d_dot(space->residual[i], space->conditioned[i]);
        }
        space->sums[run] = sum;
    }
    return add_up(space);
}

static void turn(struct tl_solve_space *space, double share)
{
#pragma omp parallel for schedule(static) if (space->vertex_count > SERIAL)
    for (size_t i = 0; i < space->vertex_count; i++)
        space->direction[i] = vec3d_muladd(space->conditioned[i], space->direction[i], share);
}

struct tl_solve_result tl_solve(const struct tl_system *system, struct tl_solve_space *space, vec3d *step)
{
    struct tl_solve_result result = {0};
#pragma omp parallel for schedule(static) if (space->vertex_count > SERIAL)
    for (size_t i = 0; i < space->vertex_count; i++)
        condition_vertex(system, i, space->inverse[i]);
    find_residual(system, space, NULL);
    double load = condition(system, space);
    find_residual(system, space, step);
    double left = condition(system, space);
    double goal = fmax(system->tolerance * system->tolerance * fmax(load, left), system->floor);
    memcpy(space->direction, space->conditioned, space->vertex_count * sizeof *space->direction);
    while (!(left <= goal) && result.iterations < system->most_iterations) {
        double curvature = multiply(system, space, space->direction);
        if (!(curvature > 0) || !isfinite(left))
            break;
        double before = left;
        left = advance(system, space, left / curvature, step);
        turn(space, left / before);
        result.iterations++;
    }
    result.converged = left <= goal;
    return result;
}
