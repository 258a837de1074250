#include "render/brdf/tables/factor.h"

#include "config/base/memory.h"
#include "render/brdf/tables/factor_internal.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Samples below this share of the mean f_r cos a count by their own size against it. */
#define DARK_SHARE 0.1
/* A value that is 0 or almost has the logarithm of this share of the mean. */
#define BLACK_SHARE 1e-4
/* Weight of second differences against the mean weight of the samples at a texel. */
#define SMOOTHNESS 1e-3
#define LEVELS     3
#define STEPS      6 /* linearisations of a level */

static const int factor_inputs[FACTORS][2] = {[AT_LIGHT] = {TL_AXIS_L_U, TL_AXIS_L_V},
                                              [AT_VIEWER] = {TL_AXIS_V_U, TL_AXIS_V_V},
                                              [AT_HALF] = {TL_AXIS_H_U, TL_AXIS_H_V},
                                              [AT_ANGLE] = {TL_AXIS_H_DOT_L, TL_AXIS_H_RADIUS}};
static const int factor_grids[FACTORS] = {GRID_DIRECTION, GRID_DIRECTION, GRID_HALF, GRID_ANGLE};
static const struct tl_brdf_frame own_frame = {{{0, 0, 1}}, {{1, 0, 0}}, {{0, 1, 0}}};

/* ---- Places of samples in the tables ---- */

static float low_of(int input)
{
    return input == TL_AXIS_H_DOT_L || input == TL_AXIS_H_RADIUS ? 0 : -1;
}

/* Maps [low, 1] to the centres of the first and the last texel, as in tables.c. */
static struct tl_brdf_axis axis_of(int input, int count)
{
    if (count == 1)
        return (struct tl_brdf_axis){.input = TL_AXIS_NONE, .bias = 0.5f};
    float scale = (float)(count - 1) / (float)count / (1 - low_of(input));
    return (struct tl_brdf_axis){
        .input = input, .scale = scale, .bias = 0.5f / (float)count - low_of(input) * scale};
}

/* The texel before an input's place and the way beyond it, in texels. */
static float place_of(int input, float value, int count, int *texel)
{
    float low = low_of(input), place = (value - low) / (1 - low) * (float)(count - 1);
    place = fminf(fmaxf(place, 0), (float)(count - 1));
    *texel = (int)fminf(place, (float)(count - 2));
    return place - (float)*texel;
}

static void place_factor(const struct factor_grid *grid, const int inputs[2],
                         const float values[TL_AXIS_COUNT], uint32_t *texels, float *shares)
{
    int x, y = 0;
    float right = place_of(inputs[0], values[inputs[0]], grid->width, &x);
    float up = grid->height > 1 ? place_of(inputs[1], values[inputs[1]], grid->height, &y) : 0;
    size_t at = grid->first + (size_t)y * (size_t)grid->width + (size_t)x;
    for (int k = 0; k < (grid->height > 1 ? 4 : 2); k++) {
        texels[k] = (uint32_t)(at + (size_t)(k & 1) + (size_t)(k >> 1) * (size_t)grid->width);
        shares[k] = (k & 1 ? right : 1 - right) * (k >> 1 ? up : 1 - up);
    }
}

static struct factor_problem problem_of(const struct tl_reflectance_samples *samples, int size)
{
    size_t half = (size_t)size / 2, whole = (size_t)size;
    struct factor_problem problem = {
        .grids = {[GRID_DIRECTION] = {(int)half, (int)half, 0},
                  [GRID_HALF] = {size, size, half * half},
                  [GRID_ANGLE] = {(int)half, (int)half, half * half + whole * whole}},
        .unknowns = 2 * half * half + whole * whole,
        .row_count = samples->count,
        .rows = TL_NEW_ARRAY(struct factor_row, samples->count),
    };
    for (size_t i = 0; i < samples->count; i++) {
        float values[TL_AXIS_COUNT];
        tl_brdf_inputs(&own_frame, samples->items[i].l, samples->items[i].v, values);
        for (int f = 0; f < FACTORS; f++)
            place_factor(&problem.grids[factor_grids[f]], factor_inputs[f], values,
                         problem.rows[i].texels + factor_first[f], problem.rows[i].shares + factor_first[f]);
    }
    return problem;
}

/* ---- One channel ---- */

struct channel {
    double *wanted;                     /* the samples' values, > 0 */
    double *log_weights, *root_weights; /* of squared errors of the logarithms, of the roots */
    double *logs;                       /* of the texels of the last level */
};

static struct channel channel_of(const struct tl_reflectance_samples *samples, int channel)
{
    struct channel out = {.wanted = TL_NEW_ARRAY(double, samples->count),
                          .log_weights = TL_NEW_ARRAY(double, samples->count),
                          .root_weights = TL_NEW_ARRAY(double, samples->count)};
    double mean = 0;
    for (size_t i = 0; i < samples->count; i++)
        mean +=
            (double)(samples->items[i].value.raw[channel] * samples->items[i].l.z) / (double)samples->count;
    mean = fmax(mean, 1e-12);
    for (size_t i = 0; i < samples->count; i++) {
        const struct tl_reflectance_sample *sample = &samples->items[i];
        double cosine = (double)sample->l.z, value = (double)sample->value.raw[channel],
               seen = value * cosine;
        out.wanted[i] = fmax(value, BLACK_SHARE * mean);
        out.log_weights[i] = fmax(seen, BLACK_SHARE * mean) / (seen + DARK_SHARE * mean);
        out.root_weights[i] = 4 * cosine / mean;
    }
    return out;
}

/* Interpolates the logarithms of a coarser level. */
static void refine(const struct factor_problem *coarse, const double *from, const struct factor_problem *fine,
                   double *to)
{
    for (int g = 0; g < GRIDS; g++) {
        const struct factor_grid *source = &coarse->grids[g], *target = &fine->grids[g];
        for (int j = 0; j < target->height; j++)
            for (int i = 0; i < target->width; i++) {
                float values[TL_AXIS_COUNT] = {0}, shares[4];
                uint32_t texels[4];
                static const int inputs[] = {TL_AXIS_L_U, TL_AXIS_L_V};
                values[TL_AXIS_L_U] = 2 * (float)i / (float)(target->width - 1) - 1;
                values[TL_AXIS_L_V] = target->height > 1 ? 2 * (float)j / (float)(target->height - 1) - 1 : 0;
                place_factor(source, inputs, values, texels, shares);
                double sum = 0;
                for (int k = 0; k < (source->height > 1 ? 4 : 2); k++)
                    sum += (double)shares[k] * from[texels[k]];
                to[target->first + (size_t)j * (size_t)target->width + (size_t)i] = sum;
            }
    }
}

/* Begins with the mean logarithm in q. */
static double *first_guess(const struct factor_problem *problem, const struct channel *channel)
{
    double *logs = TL_NEW_ARRAY(double, problem->unknowns), sum = 0, weight = 0;
    memset(logs, 0, problem->unknowns * sizeof *logs);
    for (size_t i = 0; i < problem->row_count; i++) {
        sum += channel->log_weights[i] * log(channel->wanted[i]);
        weight += channel->log_weights[i];
    }
    const struct factor_grid *half = &problem->grids[GRID_HALF];
    for (size_t i = 0; i < (size_t)half->width * (size_t)half->height; i++)
        logs[half->first + i] = sum / weight;
    return logs;
}

static double sum_of(const double *values, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += values[i];
    return sum;
}

static void solve_level(const struct factor_problem *problem, const struct channel *channel,
                        enum factor_measure measure)
{
    const double share =
        SMOOTHNESS * sum_of(channel->log_weights, problem->row_count) / (double)problem->unknowns;
    const struct factor_aim aim = {measure, channel->wanted,
                                   measure == FACTOR_LOGS ? channel->log_weights : channel->root_weights,
                                   share, STEPS};
    factor_solve(problem, &aim, channel->logs);
}

static void solve_channel(const struct factor_problem problems[LEVELS], struct channel *channel)
{
    channel->logs = first_guess(&problems[0], channel);
    solve_level(&problems[0], channel, FACTOR_LOGS);
    for (int level = 0; level < LEVELS; level++) {
        if (level > 0) {
            double *finer = TL_NEW_ARRAY(double, problems[level].unknowns);
            refine(&problems[level - 1], channel->logs, &problems[level], finer);
            free(channel->logs);
            channel->logs = finer;
        }
        solve_level(&problems[level], channel, FACTOR_ROOTS);
    }
}

/* ---- The tables ---- */

static bool is_grey(const struct tl_reflectance_samples *samples)
{
    for (size_t i = 0; i < samples->count; i++) {
        const float *value = samples->items[i].value.raw;
        if (value[0] != value[1] || value[0] != value[2])
            return false;
    }
    return true;
}

static struct tl_brdf_table table_of(const struct factor_problem *problem, int factor,
                                     const struct channel *channels, int channel_count)
{
    const struct factor_grid *grid = &problem->grids[factor_grids[factor]];
    size_t texels = (size_t)grid->width * (size_t)grid->height;
    float *values = TL_NEW_ARRAY(float, texels *(size_t)channel_count);
    for (size_t i = 0; i < texels; i++)
        for (int c = 0; c < channel_count; c++)
            values[i * (size_t)channel_count + (size_t)c] = expf((float)channels[c].logs[grid->first + i]);
    return (struct tl_brdf_table){.width = grid->width,
                                  .height = grid->height,
                                  .channels = channel_count,
                                  .precision = TL_PRECISION_FLOAT,
                                  .texels = values,
                                  .scale = 1,
                                  .x = axis_of(factor_inputs[factor][0], grid->width),
                                  .y = axis_of(factor_inputs[factor][1], grid->height)};
}

static double bridged_share(const struct factor_problem *problem, const bool *reached)
{
    const struct factor_grid *grid = &problem->grids[GRID_DIRECTION];
    size_t inside = 0, empty = 0;
    for (int j = 0; j < grid->height; j++)
        for (int i = 0; i < grid->width; i++) {
            double x = 2.0 * i / (grid->width - 1) - 1, y = 2.0 * j / (grid->height - 1) - 1;
            if (x * x + y * y > 1)
                continue;
            inside++;
            empty += !reached[grid->first + (size_t)j * (size_t)grid->width + (size_t)i];
        }
    return (double)empty / (double)inside;
}

static bool *reached_texels(const struct factor_problem *problem)
{
    bool *reached = TL_NEW_ARRAY(bool, problem->unknowns);
    memset(reached, 0, problem->unknowns * sizeof *reached);
    for (size_t i = 0; i < problem->row_count; i++)
        for (int k = 0; k < TEXELS; k++)
            reached[problem->rows[i].texels[k]] |= problem->rows[i].shares[k] > 0;
    return reached;
}

/* No level is so coarse that a lobe falls between its texels. */
static int level_size(int size, int level)
{
    int coarse = size >> (LEVELS - 1 - level);
    return coarse < TL_FACTOR_SIZE_MIN ? TL_FACTOR_SIZE_MIN : coarse;
}

int tl_factor_size(size_t samples)
{
    int size = TL_FACTOR_SIZE_MIN;
    while (size < TL_FACTOR_SIZE_MAX &&
           samples >= (size_t)24 * (size_t)size * (size_t)size) /* of twice the size: 6 size^2 texels */
        size *= 2;
    return size;
}

struct tl_brdf_tables tl_brdf_tables_factor(const struct tl_reflectance_samples *samples, int size,
                                            double *bridged)
{
    assert(size >= TL_FACTOR_SIZE_MIN);
    struct tl_brdf_tables tables = {.count = FACTORS, .times_cos_a = true};
    struct factor_problem problems[LEVELS];
    struct channel channels[3];
    int count = is_grey(samples) ? 1 : 3;
    for (int level = 0; level < LEVELS; level++)
        problems[level] = problem_of(samples, level_size(size, level));
    const struct factor_problem *last = &problems[LEVELS - 1];
    bool *reached = reached_texels(last);
#pragma omp parallel for schedule(dynamic, 1)
    for (int c = 0; c < count; c++) {
        channels[c] = channel_of(samples, c);
        solve_channel(problems, &channels[c]);
    }
    for (int f = 0; f < FACTORS; f++)
        tables.tables[f] = table_of(last, f, channels, count);
    if (bridged)
        *bridged = bridged_share(last, reached);
    for (int c = 0; c < count; c++) {
        free(channels[c].wanted);
        free(channels[c].log_weights);
        free(channels[c].root_weights);
        free(channels[c].logs);
    }
    for (int level = 0; level < LEVELS; level++)
        free(problems[level].rows);
    free(reached);
    return tables;
}
