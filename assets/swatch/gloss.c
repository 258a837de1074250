/* Gloss and all texels' normals are one least-squares problem. S is moved by what is left of the pictures
 * along the highlight after both are projected off what the texels' own unknowns can explain, whose best
 * values it depends on [Golub and Pereyra 1973]; then the normals follow. This is done for each of a row of
 * exponents; the best one stays. */
#include "assets/swatch/swatch_internal.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define TEXELS_MAX 1024 /* that are looked at */
#define EXPONENTS  30   /* from 2 to 300, four an octave */
#define TURNS      8
#define STEPS      3
#define EXPLAINED  0.05 /* less is left than with no gloss, relative to that */
#define LOOKED_FOR 12   /* the exponent 16 */
#define COVERED    0.01 /* share of values at which a lobe has half of its peak: fewer do not show it */

static double exponent_of(double index)
{
    return pow(2, 1 + index / 4);
}

struct fitted_texel {
    struct tl_swatch_texel texel;
    double body[3]; /* as of matt cloth */
};

struct trial {
    double specular, left; /* squared, over all texels */
    double covered;        /* share of values */
};

/* Takes out of `values` what the rows explain. */
static bool project(const struct tl_swatch_texel *texel, double (*rows)[3], double *values)
{
    struct tl_swatch_normal_equations sum = {0};
    double x[3], spread;
    for (size_t k = 0; k < texel->count; k++)
        tl_swatch_add(&sum, rows[k], texel->weights[k], values[k]);
    if (!tl_swatch_invert(&sum, x, &spread))
        return false;
    for (size_t k = 0; k < texel->count; k++)
        values[k] -= tl_swatch_dot(rows[k], x);
    return true;
}

struct gloss_sums {
    double by, own, covered, values;
};

static void add_texel(const struct tl_swatch_texel *texel, const struct tl_swatch_gloss *gloss,
                      const double body[3], struct gloss_sums *sums)
{
    const struct tl_swatch_gloss one = {.exponent = gloss->exponent, .specular = 1};
    double errors[TL_SWATCH_LAMPS_MAX], lobe[TL_SWATCH_LAMPS_MAX], rows[TL_SWATCH_LAMPS_MAX][3], normal[3];
    memcpy(normal, body, sizeof normal);
    tl_swatch_unit(normal);
    tl_swatch_errors(texel, gloss, texel->weights, body, errors, rows);
    for (size_t k = 0; k < texel->count; k++) {
        lobe[k] = tl_swatch_highlight(&one, texel, normal, k, NULL);
        sums->covered += lobe[k] > (gloss->exponent + 1) / 4 ? texel->weights[k] : 0;
        sums->values += texel->weights[k];
        lobe[k] *= texel->lights[k].strength;
    }
    if (!project(texel, rows, lobe) || !project(texel, rows, errors))
        return;
    for (size_t k = 0; k < texel->count; k++) {
        sums->by += texel->weights[k] * errors[k] * lobe[k];
        sums->own += texel->weights[k] * lobe[k] * lobe[k];
    }
}

static struct trial try_exponent(const struct fitted_texel *fitted, size_t count, double exponent)
{
    struct trial trial = {0};
    struct tl_swatch_gloss gloss = {.exponent = exponent};
    double(*bodies)[3] = tl_alloc(count, sizeof *bodies);
    for (size_t i = 0; i < count; i++)
        memcpy(bodies[i], fitted[i].body, sizeof bodies[i]);
    for (int turn = 0; turn < TURNS; turn++) {
        struct gloss_sums sums = {0};
        for (size_t i = 0; i < count; i++)
            add_texel(&fitted[i].texel, &gloss, bodies[i], &sums);
        gloss.specular = fmax(gloss.specular + (sums.own > 0 ? sums.by / sums.own : 0), 0);
        trial = (struct trial){gloss.specular, 0, sums.values > 0 ? sums.covered / sums.values : 0};
        for (size_t i = 0; i < count; i++)
            trial.left +=
                turn % 4 == 1
                    ? tl_swatch_settle(&fitted[i].texel, &gloss, fitted[i].texel.weights, STEPS, bodies[i])
                    : tl_swatch_descend(&fitted[i].texel, &gloss, fitted[i].texel.weights, STEPS, bodies[i]);
    }
    free(bodies);
    return trial;
}

/* The exponent between those that were tried, by a parabola through the best and its neighbours. */
static struct tl_swatch_gloss best_of(const struct trial *trials, double matt)
{
    int best = -1;
    bool is_shown = trials[LOOKED_FOR].covered > COVERED;
    for (int i = 1; i < EXPONENTS - 1; i++)
        if (trials[i].specular > 0 && trials[i].covered > COVERED &&
            (best < 0 || trials[i].left < trials[best].left))
            best = i;
    if (best < 0 || !(trials[best].left < (1 - EXPLAINED) * matt))
        return (struct tl_swatch_gloss){.is_shown = is_shown};
    double below = trials[best - 1].left, above = trials[best + 1].left,
           bend = below - 2 * trials[best].left + above,
           step = bend > 0 ? fmin(fmax(0.5 * (below - above) / bend, -0.5), 0.5) : 0;
    const struct trial *beside = &trials[step < 0 ? best - 1 : best + 1];
    return (struct tl_swatch_gloss){exponent_of(best + step),
                                    (1 - fabs(step)) * trials[best].specular + fabs(step) * beside->specular,
                                    true};
}

struct tl_swatch_gloss tl_swatch_fit_gloss(const struct tl_swatch_rig *rig, const tl_image *pictures)
{
    const struct tl_swatch_gloss none = {0};
    size_t all = (size_t)pictures->width * (size_t)pictures->height, every = all / TEXELS_MAX + 1, count = 0;
    double mean_mm = tl_swatch_mean_mm(rig), matt = 0, errors[TL_SWATCH_LAMPS_MAX];
    struct fitted_texel *fitted = TL_NEW_ARRAY(struct fitted_texel, TEXELS_MAX);
    struct trial trials[EXPONENTS];
    for (size_t i = 0; i < all; i += every) {
        struct fitted_texel *here = &fitted[count];
        tl_swatch_texel_read(rig, mean_mm, pictures, i, &here->texel);
        if (!tl_swatch_matt(&here->texel, here->texel.weights, here->body))
            continue;
        matt += tl_swatch_errors(&here->texel, &none, here->texel.weights, here->body, errors, NULL);
        count++;
    }
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < EXPONENTS; i++)
        trials[i] = try_exponent(fitted, count, exponent_of(i));
    free(fitted);
    return best_of(trials, matt);
}
