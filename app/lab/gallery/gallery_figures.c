#include "app/lab/gallery/gallery_figures.h"

#include "app/lab/experiments/experiment.h"
#include "app/report/cells.h"
#include "app/report/report.h"
#include "config/memory.h"
#include "render/brdf/fresnel.h"
#include "render/brdf/normalise.h"
#include "render/brdf/power.h"
#include "render/brdf/tables/table_error.h"
#include "render/pem/lobe.h"
#include "render/pem/lobe_error.h"
#include "render/pem/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct tl_brdf brdf_of(int model, float glossiness)
{
    tl_material material = tl_material_default("figure");
    material.glossiness = glossiness;
    material.gloss.model = model;
    struct tl_brdf brdf = tl_brdf_of(&material, material.specular, glossiness);
    if (model == TL_REFLECT_WARD)
        brdf.gloss.width_warp *= 0.4f;
    return brdf;
}

/* ---- A1, A3 to A5 ---- */

enum { MODELS = TL_REFLECT_BANKS + 1 };
static const int sizes[] = {16, 32, 64, 128, 256, 512};

static void plot_sizes(int precision, const char *caption, FILE *out)
{
    const char *const *names = tl_experiment_choices(&tl_material_options, "model");
    struct tl_plot_point points[MODELS][TL_COUNT(sizes)];
    struct tl_plot_series series[MODELS];
    for (size_t model = 0; model < MODELS; model++) {
        struct tl_brdf brdf = brdf_of((int)model, 0.9f);
        for (size_t i = 0; i < TL_COUNT(sizes); i++) {
            struct tl_brdf_table_params params = {
                .size = sizes[i], .precision = precision, .range = TL_RANGE_SCALED};
            points[model][i] = (struct tl_plot_point){
                sizes[i], 100 * tl_brdf_table_error(&brdf, &params).steep, names[model], false};
        }
        series[model] = (struct tl_plot_series){
            .name = names[model], .points = points[model], .count = TL_COUNT(sizes), .line = true};
    }
    tl_report_plot(
        out, &(struct tl_plot){"texels a side", "relative RMSE, %", true, true, series, TL_COUNT(series)},
        caption);
}

void tl_gallery_table_figures(FILE *out)
{
    plot_sizes(TL_PRECISION_FLOAT, "Tables in float against the formula, away from grazing, glossiness 0.9.",
               out);
    plot_sizes(TL_PRECISION_FIXED8, "The same in 8 bits: what is left are their steps, not their size.", out);
}

/* ---- A2 ---- */

void tl_gallery_grazing_figures(FILE *out)
{
    static const struct {
        const char *name;
        int precision, range;
    } kinds[] = {{"8 bits, cut at 1", TL_PRECISION_FIXED8, TL_RANGE_CLAMPED},
                 {"8 bits, by a constant", TL_PRECISION_FIXED8, TL_RANGE_SCALED},
                 {"16 bits, by a constant", TL_PRECISION_FIXED16, TL_RANGE_SCALED}};
    enum { ANGLES = 45 };
    struct tl_plot_point points[TL_COUNT(kinds)][ANGLES];
    struct tl_plot_series series[TL_COUNT(kinds)];
    struct tl_brdf brdf = brdf_of(TL_REFLECT_TORRANCE_SPARROW, 0.9f);
    for (size_t t = 0; t < TL_COUNT(kinds); t++) {
        struct tl_brdf_table_params params = {
            .size = 512, .precision = kinds[t].precision, .range = kinds[t].range};
        struct tl_brdf_tables tables = tl_brdf_tables_make(&brdf, &params);
        for (int i = 0; i < ANGLES; i++) {
            double degrees = 2.0 * i + 1;
            double ratio = tl_brdf_table_ratio(&brdf, &tables, (float)cos(degrees * M_PI / 180));
            points[t][i] = (struct tl_plot_point){degrees, ratio, kinds[t].name, false};
        }
        tl_brdf_tables_release(&tables);
        series[t] = (struct tl_plot_series){
            .name = kinds[t].name, .points = points[t], .count = ANGLES, .line = true};
    }
    tl_report_plot(
        out,
        &(struct tl_plot){"degrees of the viewer from the normal", "light shown over light due", false, false,
                          series, TL_COUNT(series)},
        "Torrance-Sparrow, glossiness 0.9, from 512 texels a side: cut at 1, the factor G / (pi cos b) "
        "darkens from 71 degrees on, where 1 / (pi cos b) passes it; divided by its greatest value it does "
        "not.");
}

/* ---- A3 ---- */

/* Measured over the whole light, ambient and diffuse included, so that both kinds of table compare alike. */
void tl_gallery_folded_figures(FILE *out)
{
    static const struct {
        const char *name;
        int model, precision;
    } kinds[] = {{"Phong, 8 bits", TL_REFLECT_PHONG, TL_PRECISION_FIXED8},
                 {"Blinn-Phong, 8 bits", TL_REFLECT_BLINN_PHONG, TL_PRECISION_FIXED8},
                 {"cosine lobe, 8 bits", TL_REFLECT_COSINE_LOBE, TL_PRECISION_FIXED8},
                 {"Phong, float", TL_REFLECT_PHONG, TL_PRECISION_FLOAT}};
    struct tl_plot_point points[TL_COUNT(kinds)][TL_COUNT(sizes)];
    struct tl_plot_series series[TL_COUNT(kinds)];
    for (size_t t = 0; t < TL_COUNT(kinds); t++) {
        struct tl_brdf brdf = brdf_of(kinds[t].model, 0.9f);
        for (size_t i = 0; i < TL_COUNT(sizes); i++) {
            struct tl_brdf_table_params params = {.size = sizes[i],
                                                  .precision = kinds[t].precision,
                                                  .range = TL_RANGE_SCALED,
                                                  .folded = true,
                                                  .ambient = {{0.02f, 0.02f, 0.02f}},
                                                  .diffuse = {{0.3f, 0.3f, 0.3f}}};
            points[t][i] = (struct tl_plot_point){sizes[i], 100 * tl_brdf_table_error(&brdf, &params).steep,
                                                  kinds[t].name, false};
        }
        series[t] = (struct tl_plot_series){
            .name = kinds[t].name, .points = points[t], .count = TL_COUNT(sizes), .line = true};
    }
    tl_report_plot(
        out, &(struct tl_plot){"texels a side", "relative RMSE, %", true, true, series, TL_COUNT(series)},
        "Ambient, diffuse and gloss folded into one table, one look-up for all three, against the formula. A "
        "folded table holds one colour: cloth whose yarns and prints differ from texel to texel would need a "
        "table for each, so the shaders keep the diffuse term out of the table, where it costs one product, "
        "and "
        "no option folds it.");
}

/* ---- A9 ---- */

void tl_gallery_normalise_figures(FILE *out)
{
    static const int angles[] = {5, 10, 15, 20, 25, 30, 35, 40, 45, 60, 75, 90};
    static const int methods[] = {TL_NORMALISE_NONE, TL_NORMALISE_CUBE8, TL_NORMALISE_CUBE16,
                                  TL_NORMALISE_NEWTON, TL_NORMALISE_NEWTON_FIXED};
    struct tl_plot_point points[TL_COUNT(methods)][TL_COUNT(angles)];
    struct tl_plot_series series[TL_COUNT(methods)];
    for (size_t m = 0; m < TL_COUNT(methods); m++) {
        const char *name = tl_normalisation_names[methods[m]];
        for (size_t i = 0; i < TL_COUNT(angles); i++) {
            double error = tl_normalise_error(methods[m], angles[i] * M_PI / 180).vector;
            points[m][i] = (struct tl_plot_point){angles[i], error, name, false};
        }
        series[m] = (struct tl_plot_series){
            .name = name, .points = points[m], .count = TL_COUNT(angles), .line = true};
    }
    const double degree = M_PI / 180;
    char caption[300];
    snprintf(
        caption, sizeof caption,
        "Newton's one step beats the cube map of 8 bits up to %.0f degrees between vertices, and in 8 bits "
        "and a sign, as register combiners have them, up to %.0f.",
        tl_normalise_limit(TL_NORMALISE_NEWTON, TL_NORMALISE_CUBE8) / degree,
        tl_normalise_limit(TL_NORMALISE_NEWTON_FIXED, TL_NORMALISE_CUBE8) / degree);
    tl_report_plot(out,
                   &(struct tl_plot){"degrees between the vectors at two vertices",
                                     "rms distance from unit vectors", false, true, series, TL_COUNT(series)},
                   caption);
}

/* ---- A10 ---- */

static double shown_by(int method, int exponent, const uint8_t *table, double cosine)
{
    if (method == TL_POWER_FIXED8)
        return (double)tl_power_fixed8((float)cosine, ilogb(exponent));
    if (method == TL_POWER_TABLE)
        return (double)tl_power_table_at(table, TL_POWER_TABLE_SIZE, (float)cosine);
    return pow(cosine, exponent);
}

static void plot_highlight(int exponent, FILE *out)
{
    enum { STEPS = 300 };
    uint8_t table[TL_POWER_TABLE_SIZE];
    tl_power_table_make((float)exponent, TL_POWER_TABLE_SIZE, table);
    double end = acos(pow(0.01, 1.0 / exponent));
    struct tl_plot_point(*points)[STEPS] = tl_alloc(TL_POWER_COUNT, sizeof *points);
    struct tl_plot_series series[TL_POWER_COUNT];
    for (int method = 0; method < TL_POWER_COUNT; method++) {
        for (int i = 0; i < STEPS; i++) {
            double angle = end * i / (STEPS - 1);
            points[method][i] =
                (struct tl_plot_point){angle * 180 / M_PI, shown_by(method, exponent, table, cos(angle)),
                                       tl_power_names[method], false};
        }
        series[method] = (struct tl_plot_series){.name = tl_power_names[method],
                                                 .points = points[method],
                                                 .count = STEPS,
                                                 .line = method != TL_POWER_POW,
                                                 .front = method == TL_POWER_POW};
    }
    struct tl_power_error fixed = tl_power_error(TL_POWER_FIXED8, exponent, TL_POWER_TABLE_SIZE);
    struct tl_power_error lines = tl_power_error(TL_POWER_TABLE, exponent, TL_POWER_TABLE_SIZE);
    char caption[300];
    snprintf(caption, sizeof caption,
             "A highlight of n = %d. In 8 bits and a sign it has %d levels, the widest step is %.3f; a table "
             "of 256 "
             "values errs by %.4f near 1, where the power is steepest, and shows no step.",
             exponent, fixed.levels, fixed.band, lines.max_near_one);
    tl_report_plot(out,
                   &(struct tl_plot){"degrees from the highlight's middle", "shown", false, false, series,
                                     TL_POWER_COUNT},
                   caption);
    free(points);
}

void tl_gallery_power_figures(FILE *out)
{
    plot_highlight(8, out);
    plot_highlight(64, out);
    plot_highlight(256, out);
}

/* ---- B6 ---- */

void tl_gallery_fresnel_figures(FILE *out)
{
    static const float indices[] = {1.5f, 200};
    static const char *const names[] = {"index 1.5", "index 200"};
    enum { ANGLES = 91 };
    struct tl_plot_point points[2][ANGLES];
    struct tl_plot_series series[2];
    for (int k = 0; k < 2; k++) {
        for (int degrees = 0; degrees < ANGLES; degrees++) {
            float cosine = (float)cos(degrees * M_PI / 180);
            points[k][degrees] = (struct tl_plot_point){
                degrees, (double)tl_fresnel_dielectric(indices[k], cosine), names[k], false};
        }
        series[k] =
            (struct tl_plot_series){.name = names[k], .points = points[k], .count = ANGLES, .line = true};
    }
    tl_report_plot(
        out, &(struct tl_plot){"degrees from the normal", "reflectance", false, false, series, 2},
        "Fresnel's term for the two indices of the paper's figure 7: the first is a mirror at grazing "
        "angles alone, the second nearly everywhere.");
}

/* ---- D3, D4 ---- */

enum { CHAIN_SIDE = 128 }; /* texels */

/* Levels rise as exponents fall: each is narrower by half than the next, and a lobe's volume is
 * 2 pi / (s + 1). */
static void plot_levels(FILE *out)
{
    enum { STEPS = TL_LOBE_STEPS - 1 }; /* the last is a mirror, s infinite */
    static struct tl_lobe_table table;
    struct tl_plot_point *points = TL_NEW_ARRAY(struct tl_plot_point, STEPS);
    tl_lobe_calibrate(CHAIN_SIDE, TL_CHAIN_SQRT_COSINE, &table);
    for (int i = 0; i < STEPS; i++)
        points[i] = (struct tl_plot_point){STEPS / (double)(STEPS - i), (double)table.level[i],
                                           "level of equal volume", false};
    const struct tl_plot_series series = {
        .name = "level of equal volume", .points = points, .count = STEPS, .line = true};
    tl_report_plot(
        out, &(struct tl_plot){"exponent s", "level of the chain", true, false, &series, 1},
        "D3: the level of a chain of 128 texels a face whose response to a texel has the volume of "
        "the cosine lobe, by the filter of the paper. It falls from the first exponent to the last.");
    free(points);
}

static void plot_lobe_errors(FILE *out)
{
    static const float exponents[] = {1, 4, 16, 64, 256, 1024};
    static const int methods[] = {TL_CHAIN_SQRT_COSINE, TL_LOBE_SLICES};
    enum { COUNT = TL_COUNT(exponents) };
    const struct tl_lobe_curves curves = {.cube_size = CHAIN_SIDE,
                                          .direction_count = 26,
                                          .region_count = 24,
                                          .exponent_count = COUNT,
                                          .exponents = exponents};
    struct tl_plot_point points[TL_COUNT(methods)][COUNT];
    struct tl_plot_series series[TL_COUNT(methods)];
    for (size_t m = 0; m < TL_COUNT(methods); m++) {
        const char *name = tl_lobe_method_names[methods[m]];
        struct tl_lobe_curve_point curve[COUNT];
        tl_lobe_curve(&curves, methods[m], curve);
        for (size_t i = 0; i < COUNT; i++)
            points[m][i] = (struct tl_plot_point){(double)exponents[i], 100 * curve[i].mean, name, false};
        series[m] = (struct tl_plot_series){.name = name, .points = points[m], .count = COUNT, .line = true};
    }
    tl_report_plot(
        out,
        &(struct tl_plot){"exponent s", "mean L1 error of the lobe, %", true, true, series, TL_COUNT(series)},
        "D4: integral |E - K| / integral K over the sphere, E being what is shown of one lit texel "
        "and K the cosine lobe, mean over 26 texels: the middles, edges and corners of the cube's "
        "faces.");
}

void tl_gallery_lobe_figures(FILE *out)
{
    plot_levels(out);
    plot_lobe_errors(out);
}

/* ---- D8 ---- */

void tl_gallery_memory_figures(FILE *out)
{
    static const char *const heads[] = {"texels a side", "level 0 alone, MiB", "with mip levels, MiB",
                                        "shadow maps of as many texels, RG32F, MiB",
                                        "the same in RG16F, MiB"};
    static const int sides[] = {16, 32, 64, 128, 256};
    const int regions = 24; /* as in the section's pictures */
    const double mebibyte = 1 << 20;
    struct tl_cells cells = {0};
    for (size_t i = 0; i < TL_COUNT(heads); i++)
        tl_cells_add(&cells, "%s", heads[i]);
    for (size_t i = 0; i < TL_COUNT(sides); i++) {
        tl_cells_add(&cells, "%d", sides[i]);
        tl_cells_add(&cells, "%.3f", (double)tl_memory_cubes(regions, sides[i]) / mebibyte);
        tl_cells_add(&cells, "%.3f", (double)tl_memory_chains(regions, sides[i]) / mebibyte);
        tl_cells_add(&cells, "%.3f", (double)tl_memory_shadow_maps(regions, sides[i], 8) / mebibyte);
        tl_cells_add(&cells, "%.3f", (double)tl_memory_shadow_maps(regions, sides[i], 4) / mebibyte);
    }
    tl_cells_print(&cells, TL_COUNT(heads), out);
}

/* ---- D16 ---- */

void tl_gallery_crop_figures(FILE *out)
{
    static const int sides[] = {32, 64, 128}, counts[] = {24, 96};
    static const char *const heads[] = {"texels a side", "24 regions, cubes, MiB", "paraboloids, MiB",
                                        "96 regions, cubes, MiB", "paraboloids, MiB"};
    const double mebibyte = 1 << 20;
    struct tl_cells cells = {0};
    for (size_t i = 0; i < TL_COUNT(heads); i++)
        tl_cells_add(&cells, "%s", heads[i]);
    for (size_t i = 0; i < TL_COUNT(sides); i++) {
        tl_cube even = tl_cube_create(sides[i]); /* regions of equal solid angle */
        for (int k = 0; k < 18 * sides[i] * sides[i]; k++)
            even.texels[k] = 1;
        tl_cells_add(&cells, "%d", sides[i]);
        for (size_t k = 0; k < TL_COUNT(counts); k++) {
            struct tl_regions regions = {0};
            tl_regions_cut(&even, counts[k], &regions);
            tl_cells_add(&cells, "%.3f", (double)tl_memory_chains(counts[k], sides[i]) / mebibyte);
            tl_cells_add(&cells, "%.3f",
                         (double)tl_memory_paraboloids(&even, &regions, TL_CHAIN_SQRT_COSINE, 12) / mebibyte);
            tl_regions_release(&regions);
        }
        tl_cube_release(&even);
    }
    tl_cells_print(&cells, TL_COUNT(heads), out);
}

/* ---- Which section has which ---- */

void tl_gallery_write_figures(const char *section, FILE *out)
{
    static const struct {
        const char *section;
        void (*write)(FILE *out);
    } figures[] = {{"a1", tl_gallery_table_figures},  {"a2", tl_gallery_grazing_figures},
                   {"a3", tl_gallery_folded_figures}, {"a9", tl_gallery_normalise_figures},
                   {"a10", tl_gallery_power_figures}, {"b6", tl_gallery_fresnel_figures},
                   {"d4", tl_gallery_lobe_figures},   {"d8", tl_gallery_memory_figures},
                   {"d16", tl_gallery_crop_figures}};
    for (size_t i = 0; i < TL_COUNT(figures); i++)
        if (strcmp(figures[i].section, section) == 0)
            figures[i].write(out);
}
