#include "render/brdf/tables/factor_internal.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Damping at the start, and that at which no step is left to try. */
#define DAMPING     1e-2
#define DAMPING_MAX 1e6
/* A step that improves by less than this share is the last. */
#define ENOUGH 1e-3
/* Conjugate gradients end after so many steps, or when the residual has fallen to this share. */
#define STEPS_MAX 20
#define DONE      1e-6

/* Products beyond this are cut, so that their squares stay finite. */
#define LOG_MAX 100

/* One linearisation: the derivative of a row's logarithm by each of its texels' logarithms. */
struct linear {
    const struct factor_problem *problem;
    const struct factor_aim *aim;
    double *weights;  /* of squared errors of logarithms */
    double *diagonal; /* of the matrix, nearly */
    double damping;   /* share of the diagonal that is added to it (Levenberg and Marquardt) */
    float *slopes;    /* TEXELS a row */
};

/* The logarithm of one factor, with the slopes by its texels where `slopes` is not NULL. */
static double log_of_factor(const struct factor_row *row, const double *logs, int factor, float *slopes)
{
    double largest = -INFINITY, sum = 0, parts[4];
    int first = factor_first[factor], count = factor_first[factor + 1] - first;
    for (int k = 0; k < count; k++)
        largest = fmax(largest, logs[row->texels[first + k]]);
    for (int k = 0; k < count; k++) {
        parts[k] = (double)row->shares[first + k] * exp(logs[row->texels[first + k]] - largest);
        sum += parts[k];
    }
    for (int k = 0; slopes && k < count; k++)
        slopes[first + k] = (float)(parts[k] / sum);
    return largest + log(sum);
}

double factor_log_at(const struct factor_row *row, const double *logs)
{
    double sum = 0;
    for (int f = 0; f < FACTORS; f++)
        sum += log_of_factor(row, logs, f, NULL);
    return sum;
}

/* ---- Second differences ---- */

/* Adds smoothness D^T D x for the three texels i - step, i, i + step. */
static void add_bend(double smoothness, const double *x, size_t i, size_t step, double *out)
{
    double bend = smoothness * (x[i - step] - 2 * x[i] + x[i + step]);
    out[i - step] += bend;
    out[i] -= 2 * bend;
    out[i + step] += bend;
}

static void add_smoothness(const struct factor_grid *grid, double smoothness, const double *x, double *out)
{
    size_t width = (size_t)grid->width;
    for (int j = 0; j < grid->height; j++)
        for (int i = 0; i < grid->width; i++) {
            size_t at = grid->first + (size_t)j * width + (size_t)i;
            if (i > 0 && i + 1 < grid->width)
                add_bend(smoothness, x, at, 1, out);
            if (j > 0 && j + 1 < grid->height)
                add_bend(smoothness, x, at, width, out);
            if (i + 1 == grid->width || j + 1 == grid->height)
                continue;
            double twist = 2 * smoothness * (x[at] - x[at + 1] - x[at + width] + x[at + width + 1]);
            out[at] += twist;
            out[at + 1] -= twist;
            out[at + width] -= twist;
            out[at + width + 1] += twist;
        }
}

/* ---- The normal equations ---- */

/* out = (B^T W B + smoothness D^T D + damping) x */
static void multiply(const struct linear *linear, const double *x, double *out)
{
    const struct factor_problem *problem = linear->problem;
    memset(out, 0, problem->unknowns * sizeof *out);
    for (size_t i = 0; i < problem->row_count; i++) {
        const uint32_t *texels = problem->rows[i].texels;
        const float *slopes = linear->slopes + TEXELS * i;
        double sum = 0;
        for (int k = 0; k < TEXELS; k++)
            sum += (double)slopes[k] * x[texels[k]];
        sum *= linear->weights[i];
        for (int k = 0; k < TEXELS; k++)
            out[texels[k]] += (double)slopes[k] * sum;
    }
    for (int g = 0; g < GRIDS; g++)
        add_smoothness(&problem->grids[g], linear->aim->smoothness, x, out);
    for (size_t i = 0; i < problem->unknowns; i++)
        out[i] += linear->damping * linear->diagonal[i] * x[i];
}

/* The error of row i where the product has logarithm `value`. */
static double error_at(const struct factor_aim *aim, size_t i, double value)
{
    return aim->measure == FACTOR_LOGS ? log(aim->wanted[i]) - value
                                       : sqrt(aim->wanted[i]) - exp(fmin(value, LOG_MAX) / 2);
}

/* right = B^T W (wanted - value at logs) - smoothness D^T D logs */
static void begin(struct linear *linear, const double *logs, double *right)
{
    double *diagonal = linear->diagonal;
    const struct factor_aim *aim = linear->aim;
    const struct factor_problem *problem = linear->problem;
    memset(right, 0, problem->unknowns * sizeof *right);
    for (int g = 0; g < GRIDS; g++)
        add_smoothness(&problem->grids[g], -linear->aim->smoothness, logs, right);
    for (size_t i = 0; i < problem->unknowns; i++)
        diagonal[i] = 16 * linear->aim->smoothness;
    for (size_t i = 0; i < problem->row_count; i++) {
        const struct factor_row *row = &problem->rows[i];
        float *slopes = linear->slopes + TEXELS * i;
        double value = 0;
        for (int f = 0; f < FACTORS; f++)
            value += log_of_factor(row, logs, f, slopes);
        double gain =
            aim->measure == FACTOR_LOGS ? 1 : exp(fmin(value, LOG_MAX) / 2) / 2; /* root by logarithm */
        linear->weights[i] = aim->weights[i] * gain * gain;
        for (int k = 0; k < TEXELS; k++) {
            double weighted = linear->weights[i] * (double)slopes[k];
            right[row->texels[k]] += aim->weights[i] * gain * (double)slopes[k] * error_at(aim, i, value);
            diagonal[row->texels[k]] += weighted * (double)slopes[k];
        }
    }
}

static double dot(const double *a, const double *b, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += a[i] * b[i];
    return sum;
}

/* change = the solution, by conjugate gradients with the diagonal as preconditioner. `residual` holds the
 * right side. */
static void solve_linear(const struct linear *linear, double *residual, double *change)
{
    const double *diagonal = linear->diagonal;
    size_t count = linear->problem->unknowns;
    double *direction = TL_NEW_ARRAY(double, count), *product = TL_NEW_ARRAY(double, count),
           *scaled = TL_NEW_ARRAY(double, count);
    memset(change, 0, count * sizeof *change);
    for (size_t i = 0; i < count; i++)
        direction[i] = scaled[i] = residual[i] / diagonal[i];
    double now = dot(residual, scaled, count), first = now;
    for (int step = 0; step < STEPS_MAX && now > DONE * DONE * first; step++) {
        multiply(linear, direction, product);
        double length = now / dot(direction, product, count), before = now;
        for (size_t i = 0; i < count; i++) {
            change[i] += length * direction[i];
            residual[i] -= length * product[i];
            scaled[i] = residual[i] / diagonal[i];
        }
        now = dot(residual, scaled, count);
        for (size_t i = 0; i < count; i++)
            direction[i] = scaled[i] + now / before * direction[i];
    }
    free(direction);
    free(product);
    free(scaled);
}

/* ---- Gauss and Newton ---- */

static double bending(const struct factor_problem *problem, const double *logs, double *scratch)
{
    memset(scratch, 0, problem->unknowns * sizeof *scratch);
    for (int g = 0; g < GRIDS; g++)
        add_smoothness(&problem->grids[g], 1, logs, scratch);
    return dot(logs, scratch, problem->unknowns);
}

static double badness(const struct linear *linear, const double *logs, double *scratch)
{
    const struct factor_problem *problem = linear->problem;
    double sum = linear->aim->smoothness * bending(problem, logs, scratch);
    for (size_t i = 0; i < problem->row_count; i++) {
        double off = error_at(linear->aim, i, factor_log_at(&problem->rows[i], logs));
        sum += linear->aim->weights[i] * off * off;
    }
    return sum;
}

void factor_solve(const struct factor_problem *problem, const struct factor_aim *aim, double *logs)
{
    size_t count = problem->unknowns;
    struct linear linear = {problem,
                            aim,
                            TL_NEW_ARRAY(double, problem->row_count),
                            TL_NEW_ARRAY(double, count),
                            DAMPING,
                            TL_NEW_ARRAY(float, TEXELS * problem->row_count)};
    double *right = TL_NEW_ARRAY(double, count), *change = TL_NEW_ARRAY(double, count),
           *tried = TL_NEW_ARRAY(double, count);
    double now = badness(&linear, logs, right);
    for (int step = 0; step < aim->steps && linear.damping < DAMPING_MAX; step++) {
        begin(&linear, logs, right);
        solve_linear(&linear, right, change);
        for (size_t i = 0; i < count; i++)
            tried[i] = logs[i] + change[i];
        double next = badness(&linear, tried, right);
        linear.damping *= next < now ? 0.25 : 16;
        if (!(next < now))
            continue;
        memcpy(logs, tried, count * sizeof *logs);
        bool is_done = now - next < ENOUGH * now;
        now = next;
        if (is_done)
            break;
    }
    free(linear.weights);
    free(linear.diagonal);
    free(linear.slopes);
    free(right);
    free(change);
    free(tried);
}
