#include "cloth/energy/folds.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

/* Bound of h^2 omega^2 of the springs' explicit force, beside that of bending (energy.c); 4 is the limit of
 * all. */
#define STABLE_PHASE_SQUARED 1

struct tl_folds tl_folds_build(struct tl_fold *all, size_t count, size_t vertex_count)
{
    struct tl_folds folds = {.count = count,
                             .vertex_count = vertex_count,
                             .all = all,
                             .first = TL_NEW_ARRAY(uint32_t, vertex_count + 1),
                             .ends = TL_NEW_ARRAY(struct tl_fold_end, 2 * count),
                             .springs = TL_NEW_ARRAY(struct tl_fold_spring, 2 * count)};
    uint32_t *next = TL_NEW_ARRAY(uint32_t, vertex_count + 1);
    for (size_t i = 0; i < 2 * count; i++)
        folds.first[all[i / 2].ends[i % 2] + 1]++;
    for (size_t i = 0; i < vertex_count; i++)
        next[i + 1] = folds.first[i + 1] += folds.first[i];
    for (size_t i = 0; i < 2 * count; i++) {
        const struct tl_fold *fold = &all[i / 2];
        uint32_t place = next[fold->ends[i % 2]]++;
        folds.ends[place] = (struct tl_fold_end){fold->ends[1 - i % 2],
                                                 nextafterf((float)(fold->reach * fold->reach), INFINITY)};
        folds.springs[place].reach = fold->reach;
    }
    free(next);
    return folds;
}

/* B of a strip that bends across the hinge. */
static double stiffness_across(const struct tl_fold *fold, const struct tl_cloth_fabric *fabric)
{
    double root = sqrt(fabric->bend_weft) * fold->across_weft + sqrt(fabric->bend_warp) * fold->across_warp;
    return root * root;
}

void tl_folds_set_fabric(struct tl_folds *folds, const struct tl_cloth_fabric *fabric)
{
    uint32_t *next = TL_NEW_ARRAY(uint32_t, folds->vertex_count + 1);
    for (size_t i = 0; i < folds->vertex_count; i++)
        next[i] = folds->first[i];
    for (size_t i = 0; i < 2 * folds->count; i++) {
        const struct tl_fold *fold = &folds->all[i / 2];
        folds->springs[next[fold->ends[i % 2]]++].stiffness = fold->spring * stiffness_across(fold, fabric);
    }
    free(next);
}

void tl_folds_set_step(struct tl_folds *folds, const double *inverse_masses, double h)
{
    double *shares = TL_NEW_ARRAY(double, folds->vertex_count);
    tl_folds_add_row_sums(folds, shares);
    for (size_t i = 0; i < folds->vertex_count; i++)
        shares[i] = fmin(1, STABLE_PHASE_SQUARED / (h * h * inverse_masses[i] * shares[i]));
    for (size_t i = 0; i < folds->vertex_count; i++)
        for (uint32_t k = folds->first[i]; k < folds->first[i + 1]; k++) {
            struct tl_fold_spring *spring = &folds->springs[k];
            spring->stable = spring->stiffness * fmin(shares[i], shares[folds->ends[k].other]);
        }
    free(shares);
}

void tl_folds_release(struct tl_folds *folds)
{
    free(folds->all);
    free(folds->first);
    free(folds->ends);
    free(folds->springs);
    *folds = (struct tl_folds){0};
}

/* Along the spring the Hessian is its stiffness; across it, less than 0. */
void tl_folds_add_row_sums(const struct tl_folds *folds, double *sums)
{
    for (size_t i = 0; i < folds->vertex_count; i++)
        for (uint32_t k = folds->first[i]; k < folds->first[i + 1]; k++)
            sums[i] += 2 * folds->springs[k].stiffness;
}
