#include "tests/render/brdf/ggx/ggx_fitter.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Half of the directions lie where equal shares of the facets reflect, half are even over the hemisphere. */
#define RINGS       28
#define SECTORS     48
#define POINTS_MAX  (2 * RINGS * SECTORS)
#define UNKNOWN_MAX (FITTER_LOBES_MAX * FITTER_FIGURES)

/* |x| is smoothed to sqrt(x^2 + e^2) - e. */
#define SMOOTH 0.02 /* e over the gloss and a twentieth of the albedo */
#define ENERGY 3.0  /* what a squared error of the energy weighs */
#define STEP   0.5  /* of a figure, at most, in a round */

struct ray {
    double x, y, z;
};

struct fitter {
    double width, elevation;
    struct ray viewer;
    int count;
    struct ray points[POINTS_MAX];
    double solid[POINTS_MAX], gloss[POINTS_MAX], cosine[POINTS_MAX]; /* to the facet */
    double albedo;
    double lobes[FITTER_LOBES_MAX][POINTS_MAX], rest[POINTS_MAX], share[POINTS_MAX];
    double slopes[UNKNOWN_MAX][POINTS_MAX]; /* derivatives */
};

static double square(double x)
{
    return x * x;
}

static struct ray mirrored_at(struct ray h, struct ray v)
{
    const double twice = 2 * (h.x * v.x + h.y * v.y + h.z * v.z);
    return (struct ray){twice * h.x - v.x, twice * h.y - v.y, twice * h.z - v.z};
}

static double lambda_of(double width, double cosine)
{
    return (sqrt(1 + square(width) * (1 / square(cosine) - 1)) - 1) / 2;
}

/* f_r cos a with F = 1 [Walter et al. 2007, eq. 20 and 33; Heitz 2014, eq. 72 and 99], the pdf of directions
 * in which facets reflect as often as they are there, and the cosine to the facet. */
static double gloss_of(const struct fitter *fitter, struct ray l, double *pdf, double *cosine)
{
    const struct ray v = fitter->viewer;
    const double x = l.x + v.x, y = l.y + v.y, z = l.z + v.z, length = sqrt(x * x + y * y + z * z);
    const double up = z / length, squared = square(fitter->width);
    const double density = squared / (M_PI * square(square(up) * (squared - 1) + 1));
    *cosine = (v.x * x + v.y * y + v.z * z) / length;
    *pdf = density * up / (4 * *cosine);
    return density / (1 + lambda_of(fitter->width, l.z) + lambda_of(fitter->width, v.z)) / (4 * v.z);
}

static void add_point(struct fitter *fitter, struct ray l)
{
    if (!(l.z > 0))
        return;
    const int i = fitter->count;
    double pdf;
    fitter->gloss[i] = gloss_of(fitter, l, &pdf, &fitter->cosine[i]);
    fitter->points[i] = l;
    fitter->solid[i] = 1 / (RINGS * SECTORS * (pdf + 1 / (2 * M_PI)));
    fitter->albedo += fitter->solid[i] * fitter->gloss[i];
    fitter->count++;
}

struct fitter *fitter_create(double width, double elevation)
{
    struct fitter *fitter = TL_NEW(struct fitter);
    fitter->width = width;
    fitter->elevation = elevation;
    fitter->viewer = (struct ray){cos(elevation), 0, sin(elevation)};
    for (int ring = 0; ring < RINGS; ring++)
        for (int sector = 0; sector < SECTORS; sector++) {
            const double part = (ring + 0.5) / RINGS, turn = 2 * M_PI * (sector + 0.5) / SECTORS;
            const double slope = width * sqrt(part / (1 - part)), up = 1 / sqrt(1 + square(slope));
            const struct ray h = {up * slope * cos(turn), up * slope * sin(turn), up};
            const double flat = sqrt(1 - square(part));
            if (h.x * fitter->viewer.x + h.z * fitter->viewer.z > 0)
                add_point(fitter, mirrored_at(h, fitter->viewer));
            add_point(fitter, (struct ray){flat * cos(turn), flat * sin(turn), part});
        }
    return fitter;
}

void fitter_destroy(struct fitter **fitter)
{
    free(*fitter);
    *fitter = NULL;
}

static void evaluate_lobe(const struct fitter *fitter, const double figures[FITTER_FIGURES], double *values)
{
    const double angle = figures[FITTER_FACET] * fitter->width;
    const struct ray axis = mirrored_at((struct ray){sin(angle), 0, cos(angle)}, fitter->viewer);
    const double variance = exp(figures[FITTER_VARIANCE]) * square(fitter->width);
    const double exponent = fmax(1 / variance - 1, 1);
    const double scale = exp(figures[FITTER_WEIGHT]) * (exponent + 1) / (2 * M_PI);
    for (int i = 0; i < fitter->count; i++) {
        const double cosine = axis.x * fitter->points[i].x + axis.z * fitter->points[i].z;
        values[i] = cosine > 0 ? scale * pow(cosine, exponent) : 0;
    }
}

/* Leaves the difference in `rest`. */
static void evaluate(struct fitter *fitter, int count, const struct fitted *lobes)
{
    for (int k = 0; k < count; k++)
        evaluate_lobe(fitter, lobes->lobes[k], fitter->lobes[k]);
    for (int i = 0; i < fitter->count; i++) {
        double sum = 0;
        for (int k = 0; k < count; k++)
            sum += fitter->lobes[k][i];
        fitter->rest[i] = sum - fitter->gloss[i];
    }
}

static double edge_of(const struct fitter *fitter, int i)
{
    return SMOOTH * (fitter->gloss[i] + 0.05 * fitter->albedo);
}

/* Weights, which are logarithms, move more freely. */
static double pull_of(int figure, double pull)
{
    return figure == FITTER_WEIGHT ? 0.3 * pull : pull;
}

static double loss_of(const struct fitter *fitter, int count, const struct fitted *lobes,
                      const struct fitted *target, double pull)
{
    double sum = 0, energy = 0;
    for (int i = 0; i < fitter->count; i++) {
        const double edge = edge_of(fitter, i);
        sum += fitter->solid[i] * (sqrt(square(fitter->rest[i]) + square(edge)) - edge);
        energy += fitter->solid[i] * fitter->rest[i];
    }
    sum = sum / fitter->albedo + ENERGY * square(energy / fitter->albedo);
    for (int k = 0; target && k < count; k++)
        for (int j = 0; j < FITTER_FIGURES; j++)
            sum += pull_of(j, pull) * square(lobes->lobes[k][j] - target->lobes[k][j]);
    return sum;
}

/* Exponents are at least 1; axes lie no more than 0.3 rad below the horizon. */
static void limit(const struct fitter *fitter, int count, struct fitted *lobes)
{
    const double polar = M_PI / 2 - fitter->elevation, below = M_PI / 2 + 0.3;
    const double width = fitter->width, widest = log(0.5 / square(width));
    const double first = (polar - below) / 2 / width, last = fmin((polar + below) / 2, 1.5) / width;
    for (int k = 0; k < count; k++) {
        double *figures = lobes->lobes[k];
        figures[FITTER_FACET] = fmin(fmax(figures[FITTER_FACET], first), last);
        figures[FITTER_VARIANCE] = fmin(fmax(figures[FITTER_VARIANCE], -7), widest);
        figures[FITTER_WEIGHT] = fmin(fmax(figures[FITTER_WEIGHT], -7), 0.5);
    }
}

/* Solves by elimination with pivots; `matrix` and `right` are overwritten. */
static bool solve(int count, double matrix[UNKNOWN_MAX][UNKNOWN_MAX], double right[UNKNOWN_MAX])
{
    for (int i = 0; i < count; i++) {
        int pivot = i;
        for (int j = i + 1; j < count; j++)
            pivot = fabs(matrix[j][i]) > fabs(matrix[pivot][i]) ? j : pivot;
        if (!(fabs(matrix[pivot][i]) > 1e-300))
            return false;
        for (int k = 0; k < count; k++) {
            const double kept = matrix[i][k];
            matrix[i][k] = matrix[pivot][k];
            matrix[pivot][k] = kept;
        }
        const double kept = right[i];
        right[i] = right[pivot];
        right[pivot] = kept;
        for (int j = i + 1; j < count; j++) {
            const double ratio = matrix[j][i] / matrix[i][i];
            for (int k = i; k < count; k++)
                matrix[j][k] -= ratio * matrix[i][k];
            right[j] -= ratio * right[i];
        }
    }
    for (int i = count - 1; i >= 0; i--) {
        for (int k = i + 1; k < count; k++)
            right[i] -= matrix[i][k] * right[k];
        right[i] /= matrix[i][i];
    }
    return true;
}

struct normal_equations {
    double matrix[UNKNOWN_MAX][UNKNOWN_MAX], right[UNKNOWN_MAX];
};

/* The smoothed L1 as weighted least squares, whose weights are of this round. */
static void linearise(struct fitter *fitter, int count, const struct fitted *lobes,
                      const struct fitted *target, double pull, struct normal_equations *out)
{
    const double change = 1e-4;
    const int unknown = count * FITTER_FIGURES;
    double energy = 0, by[UNKNOWN_MAX];
    for (int i = 0; i < fitter->count; i++) {
        const double size = sqrt(square(fitter->rest[i]) + square(edge_of(fitter, i)));
        fitter->share[i] = fitter->solid[i] / size / fitter->albedo;
        energy += fitter->solid[i] * fitter->rest[i] / fitter->albedo;
    }
    for (int q = 0; q < unknown; q++) {
        const int k = q / FITTER_FIGURES, j = q % FITTER_FIGURES;
        double moved[FITTER_FIGURES];
        memcpy(moved, lobes->lobes[k], sizeof moved);
        moved[j] += change;
        evaluate_lobe(fitter, moved, fitter->slopes[q]);
        by[q] = 0;
        for (int i = 0; i < fitter->count; i++) {
            fitter->slopes[q][i] = (fitter->slopes[q][i] - fitter->lobes[k][i]) / change;
            by[q] += fitter->solid[i] * fitter->slopes[q][i] / fitter->albedo;
        }
        out->right[q] = -2 * ENERGY * energy * by[q];
        for (int i = 0; i < fitter->count; i++)
            out->right[q] -= fitter->share[i] * fitter->slopes[q][i] * fitter->rest[i];
        for (int r = 0; r <= q; r++) {
            double sum = 2 * ENERGY * by[q] * by[r];
            for (int i = 0; i < fitter->count; i++)
                sum += fitter->share[i] * fitter->slopes[q][i] * fitter->slopes[r][i];
            out->matrix[q][r] = out->matrix[r][q] = sum;
        }
        if (target) {
            out->matrix[q][q] += 2 * pull_of(j, pull);
            out->right[q] -= 2 * pull_of(j, pull) * (lobes->lobes[k][j] - target->lobes[k][j]);
        }
    }
}

double fitter_fit(struct fitter *fitter, int count, const struct fitted *target, double pull, int rounds,
                  struct fitted *lobes)
{
    const int unknown = count * FITTER_FIGURES;
    double damping = 1e-2;
    limit(fitter, count, lobes);
    evaluate(fitter, count, lobes);
    double minimum = loss_of(fitter, count, lobes, target, pull);
    for (int round = 0; round < rounds; round++) {
        struct normal_equations equations;
        linearise(fitter, count, lobes, target, pull, &equations);
        const struct fitted before = *lobes;
        double gain = 0;
        for (int attempt = 0; attempt < 6 && !(gain > 0); attempt++) {
            struct normal_equations damped = equations;
            for (int q = 0; q < unknown; q++)
                damped.matrix[q][q] += damping * equations.matrix[q][q] + 1e-7;
            *lobes = before;
            if (solve(unknown, damped.matrix, damped.right)) {
                for (int q = 0; q < unknown; q++)
                    lobes->lobes[q / FITTER_FIGURES][q % FITTER_FIGURES] +=
                        fmin(fmax(damped.right[q], -STEP), STEP);
                limit(fitter, count, lobes);
                evaluate(fitter, count, lobes);
                gain = minimum - loss_of(fitter, count, lobes, target, pull);
            }
            damping = gain > 0 ? fmax(damping / 3, 1e-6) : 4 * damping;
        }
        if (!(gain > 0))
            *lobes = before;
        minimum -= fmax(gain, 0);
        if (!(gain > 1e-7))
            break;
    }
    evaluate(fitter, count, lobes);
    return minimum;
}

/* Schlick's term with F0 = 0. */
static double rim_at(double cosine)
{
    return pow(1 - fmin(cosine, 1), 5);
}

struct fitter_errors fitter_errors(struct fitter *fitter, int count, const struct fitted *lobes,
                                   const double *cosines)
{
    struct fitter_errors sums = {0, 0, 0};
    double plastic = 0;
    evaluate(fitter, count, lobes);
    for (int i = 0; i < fitter->count; i++) {
        const double solid = fitter->solid[i] / fitter->albedo;
        sums.l1 += solid * fabs(fitter->rest[i]);
        sums.energy += solid * (fitter->rest[i] + fitter->gloss[i]);
        plastic += solid * fitter->gloss[i] * (0.04 + 0.96 * rim_at(fitter->cosine[i]));
        for (int k = 0; k < count; k++)
            sums.plastic += solid * fitter->lobes[k][i] * (0.04 + 0.96 * rim_at(cosines[k]));
    }
    sums.plastic /= plastic;
    return sums;
}

/* Each direction's light belongs to the lobes by what they send there. What they would then reflect together
 * is scaled to what the gloss does, for lobes of the same energy. */
void fitter_cosines(struct fitter *fitter, int count, const struct fitted *lobes,
                    double cosines[FITTER_LOBES_MAX])
{
    double rims[FITTER_LOBES_MAX], all = 0, reflected = 0, energy = 0;
    evaluate(fitter, count, lobes);
    for (int i = 0; i < fitter->count; i++)
        all += fitter->solid[i] * fitter->gloss[i] * rim_at(fitter->cosine[i]);
    for (int k = 0; k < count; k++) {
        double sum = 0, rim = 0, own = 0;
        for (int i = 0; i < fitter->count; i++) {
            const double total = fmax(fitter->rest[i] + fitter->gloss[i], 1e-30);
            const double part = fitter->solid[i] * fitter->gloss[i] * fitter->lobes[k][i] / total;
            sum += part;
            rim += part * rim_at(fitter->cosine[i]);
            own += fitter->solid[i] * fitter->lobes[k][i];
        }
        rims[k] = rim / fmax(sum, 1e-30);
        reflected += own * rims[k];
        energy += own / fitter->albedo;
    }
    for (int k = 0; k < count; k++)
        cosines[k] = 1 - pow(rims[k] * all * energy / reflected, 0.2);
}
