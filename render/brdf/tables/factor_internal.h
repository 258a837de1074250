/* The least-squares problem of factor.h for one channel and one size of its tables. */
#ifndef TOILE_RENDER_BRDF_TABLES_FACTOR_INTERNAL_H
#define TOILE_RENDER_BRDF_TABLES_FACTOR_INTERNAL_H

#include <stddef.h>
#include <stdint.h>

/* The factors of a sample: p at l and at v, q, r; and how many texels each interpolates. */
enum { AT_LIGHT, AT_VIEWER, AT_HALF, AT_ANGLE, FACTORS };
enum { TEXELS = 16 };
static const int factor_first[FACTORS + 1] = {0, 4, 8, 12, TEXELS};

/* Texels of one table among the unknowns, rows from v = 0 up. */
struct factor_grid {
    int width, height;
    size_t first;
};
enum { GRID_DIRECTION, GRID_HALF, GRID_ANGLE, GRIDS };

struct factor_row {
    uint32_t texels[TEXELS]; /* unknowns */
    float shares[TEXELS];    /* bilinear, of each factor 1 in all */
};

struct factor_problem {
    struct factor_grid grids[GRIDS];
    size_t unknowns, row_count;
    struct factor_row *rows;
};

/* The fitted quantity: errors are those of logarithms, which makes a first guess unnecessary, or of square
 * roots, by which the bright parts are right where the product cannot have the form of the samples. The
 * square of an error of the root of f is a quarter of (f^ - f)^2 / f, between an absolute and a relative
 * error. */
enum factor_measure { FACTOR_LOGS, FACTOR_ROOTS };
struct factor_aim {
    enum factor_measure measure;
    const double *wanted;  /* values of the samples, > 0 */
    const double *weights; /* of the squared errors */
    double smoothness;     /* weight of the second differences */
    int steps;             /* linearisations, at most */
};

/* Improves the logarithms of the texels by least squares. */
void factor_solve(const struct factor_problem *problem, const struct factor_aim *aim, double *logs);

/* The logarithm of the product at a row. */
double factor_log_at(const struct factor_row *row, const double *logs);

#endif
