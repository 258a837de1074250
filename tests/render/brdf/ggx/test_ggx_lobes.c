/* The table of lobes for GGX facets against fits by brute force (ggx_fitter.h): its lobes miss little more of
 * the gloss than the same lobes moved to where they miss the least, and hold its energy, at rows and between.
 *
 *     test_ggx_lobes --write render/brdf/ggx/ggx_lobes_table.inc
 *
 * makes the table, in some minutes. One row is fitted from a start that is given here, the others from their
 * neighbours, so that the lobes of neighbours correspond and can be interpolated. Then each is fitted again
 * while the mean of its neighbours pulls at it. */
#include "render/brdf/ggx/ggx_lobes.h"

#include "render/brdf/ggx/ggx_lobes_internal.h"
#include "tests/render/brdf/ggx/ggx_fitter.h"
#include "tests/testing.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define ROUGHNESSES TL_GGX_ROUGHNESSES
#define ELEVATIONS  TL_GGX_ELEVATIONS
#define FITS        4 /* of 1, 3, 5 and 7 lobes */
#define PULL        2e-2
#define PASSES      8
#define FIRST_PULLS 4 /* passes with a pull that falls to a fourth each time */

/* Of facets from roughness 0.1 on, and viewers from 0.1 rad above the surface on. */
#define ENERGY_OFF_ONE 0.035 /* of one lobe */
#define ENERGY_OFF     0.016
#define PLASTIC_OFF    0.11
#define LEFT_OVER      0.025

static double roughness_at(double row)
{
    const double first = (double)TL_GGX_FIRST_ROUGHNESS;
    return first + (1 - first) * row / (ROUGHNESSES - 1);
}

static double elevation_at(double row)
{
    const double first = (double)TL_GGX_FIRST_ELEVATION;
    const double root = first + (1 - first) * row / (ELEVATIONS - 1);
    return M_PI / 2 * root * root;
}

/* ---- Making the table ---- */

static struct fitted fits[ROUGHNESSES][ELEVATIONS];

static struct fitted start_of(int count)
{
    static const double starts[FITS][FITTER_LOBES_MAX][FITTER_FIGURES] = {
        {{0, 0, 0}},
        {{-0.3, -0.7, -1}, {0, 1.8, -1.4}, {0.3, -0.7, -1}},
        {{-0.9, 0, -1.6}, {-0.4, -0.7, -1.6}, {0, 2, -1.8}, {0.4, -0.7, -1.6}, {0.9, 0, -1.6}},
        {{-1, 0.6, -2.3},
         {-0.8, 0, -1.9},
         {-0.4, -0.7, -1.6},
         {0, 2, -1.8},
         {0.4, -0.7, -1.6},
         {0.8, 0, -1.9},
         {1, 0.6, -2.3}}};
    struct fitted start = {.lobes = {{0}}};
    memcpy(start.lobes, starts[count / 2], sizeof start.lobes);
    return start;
}

/* Lobes as wide as those of the roughest rows have several places that are about as good: neighbours pull
 * more. */
static double pull_at(int row)
{
    return PULL * (1 + 7 * fmax(roughness_at(row) - 0.72, 0) / 0.28);
}

static struct fitter *fitter_at(double row, double column)
{
    return fitter_create(pow(roughness_at(row), 2), elevation_at(column));
}

/* The best of the fits from several starts. */
static void fit_best(int row, int column, int count, const struct fitted *target, double pull,
                     const struct fitted *starts, int start_count)
{
    struct fitter *fitter = fitter_at(row, column);
    double minimum = INFINITY;
    for (int i = 0; i < start_count; i++) {
        struct fitted tried = starts[i];
        const double loss = fitter_fit(fitter, count, target, pull, 50, &tried);
        if (loss < minimum) {
            minimum = loss;
            fits[row][column] = tried;
        }
    }
    fitter_destroy(&fitter);
}

static void fit_row(int row, int from, int count)
{
    for (int column = ELEVATIONS - 1; column >= 0; column--) {
        struct fitted starts[3] = {fits[from][column], fits[from][column], fits[from][column]};
        if (column < ELEVATIONS - 1) {
            starts[1] = fits[row][column + 1];
            for (int k = 0; k < count; k++)
                for (int j = 0; j < FITTER_FIGURES; j++)
                    starts[2].lobes[k][j] +=
                        fits[row][column + 1].lobes[k][j] - fits[from][column + 1].lobes[k][j];
        }
        fit_best(row, column, count, &starts[2], pull_at(row), starts, 3);
    }
}

static void fit_again(int row, int column, int count, double pull)
{
    static const int steps[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    struct fitted starts[2] = {fits[row][column]};
    int neighbours = 0;
    for (int i = 0; i < 4; i++) {
        const int r = row + steps[i][0], c = column + steps[i][1];
        if (r < 0 || c < 0 || r >= ROUGHNESSES || c >= ELEVATIONS)
            continue;
        neighbours++;
        for (int k = 0; k < count; k++)
            for (int j = 0; j < FITTER_FIGURES; j++)
                starts[1].lobes[k][j] += fits[r][c].lobes[k][j];
    }
    for (int k = 0; k < count; k++)
        for (int j = 0; j < FITTER_FIGURES; j++)
            starts[1].lobes[k][j] /= neighbours;
    const struct fitted target = starts[1];
    fit_best(row, column, count, &target, pull * pull_at(row) * neighbours / 2, starts, 2);
}

static short rounded(double value, double unit)
{
    return (short)lround(fmin(fmax(value / unit, -32767), 32767));
}

/* The mean energy of the lobes between a row and its neighbours, and at it. Where exponents reach 1, lobes
 * between two rows have more than those at the rows. */
static double energy_about(int row, int column, int count)
{
    double sum = 0, weights = 0;
    for (int i = 0; i < 9; i++) {
        const int down = i / 3 - 1, right = i % 3 - 1, r = row + down, c = column + right;
        if (r < 0 || c < 0 || r >= ROUGHNESSES || c >= ELEVATIONS)
            continue;
        struct fitter *fitter = fitter_at(row + 0.5 * down, column + 0.5 * right);
        struct fitted mean = {.lobes = {{0}}};
        double cosines[FITTER_LOBES_MAX] = {0};
        for (int k = 0; k < count; k++)
            for (int j = 0; j < FITTER_FIGURES; j++) {
                const double a = fits[row][column].lobes[k][j], b = fits[r][c].lobes[k][j];
                const double d = fits[row][c].lobes[k][j], e = fits[r][column].lobes[k][j];
                mean.lobes[k][j] =
                    j == FITTER_WEIGHT ? log((exp(a) + exp(b) + exp(d) + exp(e)) / 4) : (a + b + d + e) / 4;
            }
        const double weight = (down ? 1 : 2) * (right ? 1 : 2);
        sum += weight * fitter_errors(fitter, count, &mean, cosines).energy;
        weights += weight;
        fitter_destroy(&fitter);
    }
    return sum / weights;
}

static void store(int row, int column, int count, short *table)
{
    struct fitter *fitter = fitter_at(row, column);
    const struct fitted *lobes = &fits[row][column];
    double cosines[FITTER_LOBES_MAX];
    fitter_cosines(fitter, count, lobes, cosines);
    const double energy = energy_about(row, column, count);
    for (int k = 0; k < count; k++) {
        short *figures = table + (ptrdiff_t)((count / 2) * (count / 2) + k) * TL_GGX_FIGURES;
        figures[0] = rounded(lobes->lobes[k][FITTER_FACET], 1e-3);
        figures[1] = rounded(lobes->lobes[k][FITTER_VARIANCE] / M_LN2, 1e-3);
        figures[2] = rounded(exp(lobes->lobes[k][FITTER_WEIGHT]) / energy, 1e-4);
        figures[3] = rounded(cosines[k], 1e-3);
    }
    fitter_destroy(&fitter);
}

static void make(int count, short *table)
{
    const int middle = (ROUGHNESSES - 1) / 2;
    struct fitted from = start_of(count);
    for (int column = ELEVATIONS - 1; column >= 0; column--) {
        const struct fitted target = from;
        fit_best(middle, column, count, &target, column < ELEVATIONS - 1 ? PULL : 0, &from, 1);
        from = fits[middle][column];
    }
    for (int row = middle - 1; row >= 0; row--)
        fit_row(row, row + 1, count);
    for (int row = middle + 1; row < ROUGHNESSES; row++)
        fit_row(row, row - 1, count);
    for (int pass = 0; pass < PASSES; pass++)
        for (int i = 0; i < ROUGHNESSES * ELEVATIONS; i++)
            fit_again(i / ELEVATIONS, i % ELEVATIONS, count, pow(4, fmax(FIRST_PULLS - pass, 0)));
    for (int i = 0; i < ROUGHNESSES * ELEVATIONS; i++)
        store(i / ELEVATIONS, i % ELEVATIONS, count,
              table + (ptrdiff_t)i * TL_GGX_LOBES_ALL * TL_GGX_FIGURES);
}

static int write_table(const char *path)
{
    static short table[ROUGHNESSES * ELEVATIONS * TL_GGX_LOBES_ALL * TL_GGX_FIGURES];
    for (int count = 1; count <= FITTER_LOBES_MAX; count += 2)
        make(count, table);
    FILE *file = fopen(path, "w");
    if (!file)
        return 1;
    for (size_t i = 0; i < TL_COUNT(table); i++)
        fprintf(file, "%d,%s", table[i], i % 16 == 15 ? "\n" : " ");
    return fclose(file) == 0 ? 0 : 1;
}

/* ---- Tests ---- */

/* The lobes of the table as the fitter has them. */
static struct fitted looked_up(double width, double elevation, int count, double cosines[FITTER_LOBES_MAX])
{
    struct tl_ggx_lobe lobes[TL_GGX_LOBES_MAX];
    struct fitted out = {.lobes = {{0}}};
    assert_int_equal(tl_ggx_lobes((float)width, (float)sin(elevation), count, lobes), count);
    for (int k = 0; k < count; k++) {
        out.lobes[k][FITTER_FACET] = (double)lobes[k].facet / width;
        out.lobes[k][FITTER_VARIANCE] = -log(((double)lobes[k].exponent + 1) * width * width);
        out.lobes[k][FITTER_WEIGHT] = log((double)lobes[k].weight);
        cosines[k] = (double)lobes[k].cosine;
    }
    return out;
}

/* Bounds are what was measured, rounded up: L1 in percent, mean over the viewers of a line. At rows the
 * table has what the fitter found, with rounding. */
static void test_lobes_match_the_gloss(void **state)
{
    (void)state;
    static const double bounds[FITS][2] = {{41, 40}, {17, 16}, {10.5, 9.5}, {8.7, 8}}; /* at rows, between */
    for (int fit = 0; fit < FITS; fit++)
        for (int between = 0; between < 2; between++) {
            const int count = 2 * fit + 1;
            double sum = 0, off = 0, plastic_off = 0;
            printf("%d lobes %s, L1 in percent by roughness:", count, between ? "between rows" : "at rows");
            for (int row = 0; row < ROUGHNESSES - between; row++) {
                double of_row = 0;
                for (int column = 2; column < ELEVATIONS - between; column++) {
                    const double r = row + 0.5 * between, c = column + 0.5 * between;
                    double cosines[FITTER_LOBES_MAX];
                    struct fitter *fitter = fitter_at(r, c);
                    const struct fitted lobes =
                        looked_up(pow(roughness_at(r), 2), elevation_at(c), count, cosines);
                    const struct fitter_errors errors = fitter_errors(fitter, count, &lobes, cosines);
                    of_row += errors.l1 / (ELEVATIONS - between - 2);
                    off = fmax(off, fabs(errors.energy - 1));
                    plastic_off = fmax(plastic_off, fabs(errors.plastic - 1));
                    fitter_destroy(&fitter);
                }
                printf(" %.1f", 100 * of_row);
                sum += of_row / (ROUGHNESSES - between);
            }
            printf("; mean %.1f; energy off by %.1f at most, with Fresnel's term by %.1f\n", 100 * sum,
                   100 * off, 100 * plastic_off);
            assert_true(100 * sum < bounds[fit][between]);
            assert_true(off < (fit == 0 ? ENERGY_OFF_ONE : ENERGY_OFF) && plastic_off < PLASTIC_OFF);
        }
}

/* Moved to where they miss the least, with nothing that pulls, lobes miss little less. */
static void test_fits_are_repeated(void **state)
{
    (void)state;
    static const int places[][2] = {{1, 6}, {4, 3}, {4, 9}, {6, 11}, {8, 7}};
    for (size_t i = 0; i < TL_COUNT(places); i++)
        for (int count = 3; count <= 7; count += 2) {
            const int row = places[i][0], column = places[i][1];
            double cosines[FITTER_LOBES_MAX], again[FITTER_LOBES_MAX];
            struct fitter *fitter = fitter_at(row, column);
            struct fitted lobes = looked_up(pow(roughness_at(row), 2), elevation_at(column), count, cosines);
            const double before = fitter_errors(fitter, count, &lobes, cosines).l1;
            fitter_cosines(fitter, count, &lobes, again);
            for (int k = 0; k < count; k++)
                assert_near(again[k], cosines[k], 0.01);
            fitter_fit(fitter, count, NULL, 0, 50, &lobes);
            const double after = fitter_errors(fitter, count, &lobes, again).l1;
            printf("roughness %.1f, elevation %.2f, %d lobes: L1 %.2f, fitted again %.2f\n",
                   roughness_at(row), elevation_at(column), count, 100 * before, 100 * after);
            assert_true(before < after + LEFT_OVER);
            fitter_destroy(&fitter);
        }
}

/* Exponents stay within what environments are filtered for. */
static void test_exponents_are_within_their_range(void **state)
{
    (void)state;
    for (float width = 0.01f; width <= 1; width += 0.018f) {
        float min, max;
        tl_ggx_exponents(width, &min, &max);
        for (float sine = 0.01f; sine <= 1; sine += 0.03f)
            for (int count = 1; count <= 7; count += 2) {
                struct tl_ggx_lobe lobes[TL_GGX_LOBES_MAX];
                assert_int_equal(tl_ggx_lobes(width, sine, count, lobes), count);
                for (int k = 0; k < count; k++)
                    assert_true(lobes[k].exponent >= 0.999f * min && lobes[k].exponent <= 1.001f * max);
            }
    }
}

int main(int argument_count, char **arguments)
{
    if (argument_count == 3 && strcmp(arguments[1], "--write") == 0)
        return write_table(arguments[2]);
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_lobes_match_the_gloss),
                                       cmocka_unit_test(test_fits_are_repeated),
                                       cmocka_unit_test(test_exponents_are_within_their_range)};
    return cmocka_run_group_tests_name("ggx", tests, NULL, NULL);
}
