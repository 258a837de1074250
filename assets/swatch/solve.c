#include "assets/swatch/swatch_internal.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define REWEIGHTINGS  10
#define CAUCHY        2.385 /* scales of the residual at which a weight is half [Holland and Welsch 1977] */
#define SCALE_MIN     0.003 /* relative to the brightest value */
#define STEPS         8     /* a descent */
#define UNKNOWN_MAX   0.05
#define MEDIAN_OF_MAX 65536

struct swatch_solving {
    const struct tl_swatch_rig *rig;
    const tl_image *pictures;
    double mean_mm;
    struct tl_swatch_gloss gloss;
    double scale; /* residuals, relative to a texel's brightest value; 0: no texel is weighed by them */
    struct tl_swatch_maps *out;
    float *residuals; /* by texel, relative to its brightest value; -1: unknown, or of three lamps */
    struct row_errors {
        double squares[TL_SWATCH_LAMPS_MAX], errors[TL_SWATCH_LAMPS_MAX], weights[TL_SWATCH_LAMPS_MAX],
            values[TL_SWATCH_LAMPS_MAX];
        size_t unknown;
    } * rows;
};

struct solution {
    double normal[3], albedo;
    double weights[TL_SWATCH_LAMPS_MAX], errors[TL_SWATCH_LAMPS_MAX];
};

static double brightest_of(const struct tl_swatch_texel *texel)
{
    double brightest = 0;
    for (size_t k = 0; k < texel->count; k++)
        brightest = fmax(brightest, texel->values[k]);
    return brightest;
}

/* Normal and albedo of a texel, by least squares that are weighted again by what they leave. */
static bool solve_texel(const struct swatch_solving *solving, const struct tl_swatch_texel *texel,
                        struct solution *out)
{
    double body[3] = {0}, half = CAUCHY * solving->scale * brightest_of(texel);
    memcpy(out->weights, texel->weights, sizeof out->weights);
    if (!tl_swatch_matt(texel, out->weights, body))
        return false;
    if (solving->gloss.specular > 0)
        tl_swatch_settle(texel, &solving->gloss, out->weights, STEPS, body);
    tl_swatch_errors(texel, &solving->gloss, out->weights, body, out->errors, NULL);
    for (int i = 0; half > 0 && i < REWEIGHTINGS; i++) {
        for (size_t k = 0; k < texel->count; k++)
            out->weights[k] = texel->weights[k] / (1 + out->errors[k] * out->errors[k] / (half * half));
        tl_swatch_descend(texel, &solving->gloss, out->weights, 2, body);
        tl_swatch_errors(texel, &solving->gloss, out->weights, body, out->errors, NULL);
    }
    memcpy(out->normal, body, sizeof body);
    out->albedo = tl_swatch_unit(out->normal);
    return true;
}

static void write_colour(const struct swatch_solving *solving, const struct tl_swatch_texel *texel,
                         size_t index, const struct solution *solution)
{
    double above[3] = {0}, below = 0;
    for (size_t k = 0; k < texel->count; k++) {
        const float *value = tl_image_floats(&solving->pictures[k]) + 3 * index;
        double e = texel->lights[k].strength,
               row = e * fmax(tl_swatch_dot(solution->normal, texel->lights[k].direction), 0),
               shine = e * tl_swatch_highlight(&solving->gloss, texel, solution->normal, k, NULL);
        below += solution->weights[k] * row * row;
        for (int c = 0; c < 3; c++)
            above[c] += solution->weights[k] * row * ((double)value[c] - shine);
    }
    for (int c = 0; c < 3; c++)
        tl_image_floats(&solving->out->albedo)[3 * index + (size_t)c] =
            below > 0 ? (float)fmax(above[c] / below, 0) : 0;
}

static void solve_at(const struct swatch_solving *solving, size_t index, struct row_errors *row)
{
    float *normal = tl_image_floats(&solving->out->normal) + 3 * index;
    struct tl_swatch_texel texel;
    struct solution solution = {0};
    double squares = 0, freedom = -3, brightest;
    tl_swatch_texel_read(solving->rig, solving->mean_mm, solving->pictures, index, &texel);
    brightest = brightest_of(&texel);
    solving->residuals[index] = -1;
    if (!solve_texel(solving, &texel, &solution)) {
        memset(normal, 0, 3 * sizeof *normal);
        memset(tl_image_floats(&solving->out->albedo) + 3 * index, 0, 3 * sizeof *normal);
        row->unknown++;
        return;
    }
    for (int i = 0; i < 3; i++)
        normal[i] = (float)solution.normal[i];
    write_colour(solving, &texel, index, &solution);
    for (size_t k = 0; k < texel.count; k++) {
        double error = solution.errors[k], weight = solution.weights[k];
        squares += texel.weights[k] * error * error;
        freedom += texel.weights[k];
        row->squares[k] += weight * error * error;
        row->errors[k] += weight * error;
        row->values[k] += weight * texel.values[k];
        row->weights[k] += weight;
    }
    if (freedom > 0.5 && brightest > 0)
        solving->residuals[index] = (float)(sqrt(squares / freedom) / brightest);
}

static void solve_all(struct swatch_solving *solving)
{
    int width = solving->pictures->width, height = solving->pictures->height;
    memset(solving->rows, 0, (size_t)height * sizeof *solving->rows);
#pragma omp parallel for schedule(static)
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            solve_at(solving, (size_t)y * (size_t)width + (size_t)x, &solving->rows[y]);
}

static int compare(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* The median of what texels leave. */
static double median(const struct swatch_solving *solving, size_t count)
{
    size_t every = count / MEDIAN_OF_MAX + 1, kept = 0;
    float *some = TL_NEW_ARRAY(float, count / every + 1);
    for (size_t i = 0; i < count; i += every)
        if (solving->residuals[i] >= 0)
            some[kept++] = solving->residuals[i];
    qsort(some, kept, sizeof *some, compare);
    double middle = kept > 0 ? (double)some[kept / 2] : 0;
    free(some);
    return middle;
}

static void sum_rows(const struct swatch_solving *solving, int height, size_t count)
{
    struct tl_swatch_maps *out = solving->out;
    struct row_errors total = {0};
    double squares = 0, means = 0;
    for (int y = 0; y < height; y++) {
        const struct row_errors *row = &solving->rows[y];
        total.unknown += row->unknown;
        for (size_t k = 0; k < solving->rig->count; k++) {
            total.squares[k] += row->squares[k];
            total.errors[k] += row->errors[k];
            total.values[k] += row->values[k];
            total.weights[k] += row->weights[k];
        }
    }
    for (size_t k = 0; k < solving->rig->count; k++) {
        double weight = total.weights[k], mean = total.values[k] / weight;
        out->lamps[k].used = (float)(weight / (double)count);
        if (!(mean > 0))
            continue;
        out->lamps[k].residual = (float)(sqrt(total.squares[k] / weight) / mean);
        out->lamps[k].bias = (float)(total.errors[k] / weight / mean);
        squares += total.squares[k] / weight;
        means += mean * mean;
    }
    out->residual = means > 0 ? (float)sqrt(squares / means) : 0;
    out->unknown = (float)((double)total.unknown / (double)count);
}

/* Takes the mean slope out: a swatch lies flat. Texels without a normal become level. */
static void level(struct tl_swatch_maps *swatch, size_t count)
{
    double sums[2] = {0}, known = 0;
    float *normals = tl_image_floats(&swatch->normal);
    for (size_t i = 0; i < count; i++) {
        const float *n = normals + 3 * i;
        if (!(n[2] > 0))
            continue;
        for (int c = 0; c < 2; c++)
            sums[c] += (double)n[c] / fmax((double)n[2], 0.05);
        known++;
    }
    const double mean[2] = {known > 0 ? sums[0] / known : 0, known > 0 ? sums[1] / known : 0};
    swatch->lean_deg = (float)(atan(hypot(mean[0], mean[1])) * 57.29577951308232);
    for (size_t i = 0; i < count; i++) {
        float *n = normals + 3 * i;
        double up = n[2] > 0 ? (double)n[2] : 1,
               to[3] = {(double)n[0] - mean[0] * up, (double)n[1] - mean[1] * up, up};
        if (!(n[2] > 0))
            memcpy(to, (const double[3]){0, 0, 1}, sizeof to);
        tl_swatch_unit(to);
        for (int c = 0; c < 3; c++)
            n[c] = (float)to[c];
    }
}

/* The square of the distance from the middle, 1 in the corners. */
static double off_middle(const tl_image *image, size_t index)
{
    size_t row = index / (size_t)image->width, column = index % (size_t)image->width;
    double width = image->width, height = image->height, x = (double)column + 0.5 - 0.5 * width,
           y = (double)row + 0.5 - 0.5 * height;
    return 4 * (x * x + y * y) / (width * width + height * height);
}

/* Fits 1 + b q + c q^2 to the albedo over off_middle, and divides by it where that is darker in the corners.
 * Fills texels without an albedo. */
static void even_out(struct tl_swatch_maps *swatch, bool even, size_t count)
{
    struct tl_swatch_normal_equations sum = {0};
    double fit[3] = {1, 0, 0}, spread, means[3] = {0}, known = 0;
    float *albedo = tl_image_floats(&swatch->albedo);
    for (size_t i = 0; i < count; i++) {
        const float *a = albedo + 3 * i;
        double q = off_middle(&swatch->albedo, i);
        if (!(a[0] + a[1] + a[2] > 0))
            continue;
        const double row[3] = {1, q, q * q};
        tl_swatch_add(&sum, row, 1, (double)(a[0] + a[1] + a[2]) / 3);
    }
    bool fitted = even && tl_swatch_invert(&sum, fit, &spread) && fit[0] > 0;
    double corner = fitted ? (fit[0] + fit[1] + fit[2]) / fit[0] : 1;
    swatch->corner = corner > 0.2 && corner < 0.995 ? (float)corner : 1;
    for (size_t i = 0; i < count; i++) {
        float *a = albedo + 3 * i;
        double q = off_middle(&swatch->albedo, i),
               light = swatch->corner < 1 ? 1 + (fit[1] * q + fit[2] * q * q) / fit[0] : 1;
        bool is_known = a[0] + a[1] + a[2] > 0;
        known += is_known;
        for (int c = 0; c < 3; c++) {
            a[c] = (float)((double)a[c] / light);
            means[c] += (double)a[c];
        }
    }
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 3 && known > 0; c++)
            if (!(albedo[3 * i] + albedo[3 * i + 1] + albedo[3 * i + 2] > 0))
                albedo[3 * i + c] = (float)(means[c] / known);
}

/* The gloss, then normals: first of all lamps alike, which gives the scale of what is left, then without
 * those that fit worse. */
static void solve_in_turn(struct swatch_solving *solving, size_t count)
{
    solving->gloss = tl_swatch_fit_gloss(solving->rig, solving->pictures);
    solve_all(solving);
    solving->scale = fmax(median(solving, count), SCALE_MIN);
    solve_all(solving);
}

bool tl_swatch_solve(const struct tl_swatch_rig *rig, const tl_image *pictures, struct tl_swatch_maps *out,
                     tl_error *error)
{
    int width = pictures->width, height = pictures->height;
    size_t count = (size_t)width * (size_t)height;
    *out = (struct tl_swatch_maps){.normal = tl_image_create(width, height, 3, TL_IMAGE_F32),
                                   .albedo = tl_image_create(width, height, 3, TL_IMAGE_F32)};
    struct swatch_solving solving = {.rig = rig,
                                     .pictures = pictures,
                                     .mean_mm = tl_swatch_mean_mm(rig),
                                     .out = out,
                                     .residuals = TL_NEW_ARRAY(float, count),
                                     .rows = TL_NEW_ARRAY(struct row_errors, (size_t)height)};
    solve_in_turn(&solving, count);
    sum_rows(&solving, height, count);
    free(solving.residuals);
    free(solving.rows);
    if (out->unknown > (float)UNKNOWN_MAX) {
        double unknown = 100 * (double)out->unknown;
        tl_swatch_release(out);
        return tl_fail(
            error, TL_INPUT,
            "%.0f %% of the swatch is lit by fewer than three lamps: set lamps higher, or take more "
            "pictures",
            unknown);
    }
    level(out, count);
    even_out(out, rig->even, count);
    out->has_gloss = solving.gloss.is_shown;
    if (solving.gloss.specular > 0) {
        out->glossiness = (float)(1 - 1 / solving.gloss.exponent);
        out->specular = (float)solving.gloss.specular;
    }
    return true;
}

void tl_swatch_release(struct tl_swatch_maps *swatch)
{
    tl_image_release(&swatch->normal);
    tl_image_release(&swatch->albedo);
    *swatch = (struct tl_swatch_maps){0};
}
