#include "app/lab/gallery/gallery_figures.h"

#include "app/lab/experiments/experiment.h"
#include "app/report/report.h"
#include "config/base/memory.h"
#include "render/brdf/facets.h"
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

/* ---- A1, A3 to A5: error of tables over size and precision ---- */

enum { MODELS = TL_REFLECT_BANKS + 1 };
static const int sizes[] = {16, 32, 64, 128, 256, 512};

static void add_sizes(int precision, const char *caption, cJSON *figures)
{
    const char *const *names = tl_experiment_choices(&tl_material_options, "model");
    cJSON *series = tl_report_add_plot(
        figures, &(const struct tl_report_plot){"texels a side", "relative RMSE, %", true, true, caption});
    for (size_t model = 0; model < MODELS; model++) {
        struct tl_brdf brdf = brdf_of((int)model, 0.9f);
        cJSON *points = tl_report_add_series(series, names[model], false);
        for (size_t i = 0; i < TL_COUNT(sizes); i++) {
            struct tl_brdf_table_params params = {
                .size = sizes[i], .precision = precision, .range = TL_RANGE_SCALED};
            tl_report_add_point(points, sizes[i], 100 * tl_brdf_table_error(&brdf, &params).steep);
        }
    }
}

static void add_tables(cJSON *figures)
{
    add_sizes(TL_PRECISION_FLOAT, "Tables in float against the formula, away from grazing, glossiness 0.9.",
              figures);
    add_sizes(TL_PRECISION_FIXED8, "The same in 8 bits: what is left are their steps, not their size.",
              figures);
}

/* ---- A2: what the singular factor's range darkens ---- */

static void add_grazing(cJSON *figures)
{
    static const struct {
        const char *name;
        int precision, range;
    } kinds[] = {{"8 bits, cut at 1", TL_PRECISION_FIXED8, TL_RANGE_CLAMPED},
                 {"8 bits, by a constant", TL_PRECISION_FIXED8, TL_RANGE_SCALED},
                 {"16 bits, by a constant", TL_PRECISION_FIXED16, TL_RANGE_SCALED}};
    struct tl_brdf brdf = brdf_of(TL_REFLECT_TORRANCE_SPARROW, 0.9f);
    cJSON *series = tl_report_add_plot(
        figures,
        &(const struct tl_report_plot){
            .x_label = "degrees of the viewer from the normal",
            .y_label = "light shown over light due",
            .caption =
                "Torrance-Sparrow, glossiness 0.9, from 512 texels a side: cut at 1, the factor G / (pi cos "
                "b) darkens from 71 degrees on, where 1 / (pi cos b) passes it; divided by its greatest "
                "value it does not."});
    for (size_t t = 0; t < TL_COUNT(kinds); t++) {
        struct tl_brdf_table_params params = {
            .size = 512, .precision = kinds[t].precision, .range = kinds[t].range};
        struct tl_brdf_tables tables = tl_brdf_tables_make(&brdf, &params);
        cJSON *points = tl_report_add_series(series, kinds[t].name, false);
        for (int degrees = 1; degrees < 90; degrees += 2)
            tl_report_add_point(points, degrees,
                                tl_brdf_table_ratio(&brdf, &tables, (float)cos(degrees * M_PI / 180)));
        tl_brdf_tables_release(&tables);
    }
}

/* ---- A3: what folding all terms into one table costs ---- */

/* Measured over the whole light, ambient and diffuse included, so that both kinds of table compare alike. */
static void add_folded(cJSON *figures)
{
    static const struct {
        const char *name;
        int model, precision;
    } kinds[] = {{"Phong, 8 bits", TL_REFLECT_PHONG, TL_PRECISION_FIXED8},
                 {"Blinn-Phong, 8 bits", TL_REFLECT_BLINN_PHONG, TL_PRECISION_FIXED8},
                 {"cosine lobe, 8 bits", TL_REFLECT_COSINE_LOBE, TL_PRECISION_FIXED8},
                 {"Phong, float", TL_REFLECT_PHONG, TL_PRECISION_FLOAT}};
    cJSON *series = tl_report_add_plot(
        figures, &(const struct tl_report_plot){"texels a side", "relative RMSE, %", true, true,
                                                "Ambient, diffuse and gloss folded into one table, one "
                                                "look-up for all three, against the formula "
                                                "(shading.table_terms=all). A table holds one "
                                                "colour: cloth whose yarns and prints differ from texel to "
                                                "texel would need a table for each, so its diffuse light "
                                                "stays out of the table, where it costs one product."});
    for (size_t t = 0; t < TL_COUNT(kinds); t++) {
        struct tl_brdf brdf = brdf_of(kinds[t].model, 0.9f);
        cJSON *points = tl_report_add_series(series, kinds[t].name, false);
        for (size_t i = 0; i < TL_COUNT(sizes); i++) {
            struct tl_brdf_table_params params = {.size = sizes[i],
                                                  .precision = kinds[t].precision,
                                                  .range = TL_RANGE_SCALED,
                                                  .folded = true,
                                                  .ambient = {{0.02f, 0.02f, 0.02f}},
                                                  .diffuse = {{0.3f, 0.3f, 0.3f}}};
            tl_report_add_point(points, sizes[i], 100 * tl_brdf_table_error(&brdf, &params).steep);
        }
    }
}

/* ---- A9: normalisations over the angle between vertices ---- */

static void add_normalise(cJSON *figures)
{
    static const int angles[] = {5, 10, 15, 20, 25, 30, 35, 40, 45, 60, 75, 90};
    static const int methods[] = {TL_NORMALISE_NONE, TL_NORMALISE_CUBE8, TL_NORMALISE_CUBE16,
                                  TL_NORMALISE_NEWTON, TL_NORMALISE_NEWTON8};
    const double degree = M_PI / 180;
    char *caption = tl_format("Newton's one step beats the cube map of 8 bits up to %.0f degrees between "
                              "vertices, and in 8 bits and a "
                              "sign, as register combiners have them, up to %.0f.",
                              tl_normalise_limit(TL_NORMALISE_NEWTON, TL_NORMALISE_CUBE8) / degree,
                              tl_normalise_limit(TL_NORMALISE_NEWTON8, TL_NORMALISE_CUBE8) / degree);
    cJSON *series = tl_report_add_plot(
        figures, &(const struct tl_report_plot){"degrees between the vectors at two vertices",
                                                "rms distance from unit vectors", false, true, caption});
    for (size_t m = 0; m < TL_COUNT(methods); m++) {
        cJSON *points = tl_report_add_series(series, tl_normalisation_names[methods[m]], false);
        for (size_t i = 0; i < TL_COUNT(angles); i++)
            tl_report_add_point(points, angles[i], tl_normalise_error(methods[m], angles[i] * degree).vector);
    }
    free(caption);
}

/* ---- A10: a highlight by each power, and their banding ---- */

static double shown_by(int method, int exponent, const uint8_t *table, double cosine)
{
    if (method == TL_POWER_FIXED8)
        return (double)register_power((float)cosine, ilogb(exponent));
    if (method == TL_POWER_TABLE)
        return (double)tl_power_table_at(table, TL_POWER_TABLE_SIZE, (float)cosine);
    return pow(cosine, exponent);
}

static void add_highlight(int exponent, cJSON *figures)
{
    enum { STEPS = 300 };
    uint8_t table[TL_POWER_TABLE_SIZE];
    tl_power_table_make((float)exponent, TL_POWER_TABLE_SIZE, table);
    struct tl_power_error fixed = tl_power_error(TL_POWER_FIXED8, exponent, TL_POWER_TABLE_SIZE);
    struct tl_power_error lines = tl_power_error(TL_POWER_TABLE, exponent, TL_POWER_TABLE_SIZE);
    char *caption = tl_format("A highlight of n = %d. In 8 bits and a sign it has %d levels, the widest step "
                              "is %.3f; a table of 256 "
                              "values errs by %.4f near 1, where the power is steepest, and shows no step.",
                              exponent, fixed.levels, fixed.band, lines.max_near_one);
    cJSON *series = tl_report_add_plot(
        figures, &(const struct tl_report_plot){.x_label = "degrees from the highlight's middle",
                                                .y_label = "shown",
                                                .caption = caption});
    double end = acos(pow(0.01, 1.0 / exponent));
    for (int method = 0; method < TL_POWER_COUNT; method++) {
        cJSON *points = tl_report_add_series(series, tl_power_names[method], method == TL_POWER_POW);
        for (int i = 0; i < STEPS; i++) {
            double angle = end * i / (STEPS - 1);
            tl_report_add_point(points, angle * 180 / M_PI, shown_by(method, exponent, table, cos(angle)));
        }
    }
    free(caption);
}

static void add_powers(cJSON *figures)
{
    add_highlight(8, figures);
    add_highlight(64, figures);
    add_highlight(256, figures);
}

/* ---- B6: the two indices of the paper's figure 7 ---- */

static void add_fresnel(cJSON *figures)
{
    static const float indices[] = {1.5f, 200};
    static const char *const names[] = {"index 1.5", "index 200"};
    cJSON *series = tl_report_add_plot(
        figures,
        &(const struct tl_report_plot){.x_label = "degrees from the normal",
                                       .y_label = "reflectance",
                                       .caption = "Fresnel's term for the two indices of the paper's figure "
                                                  "7: the first is a mirror at grazing "
                                                  "angles alone, the second nearly everywhere."});
    for (int k = 0; k < 2; k++) {
        cJSON *points = tl_report_add_series(series, names[k], false);
        for (int degrees = 0; degrees <= 90; degrees++)
            tl_report_add_point(points, degrees,
                                (double)fresnel_dielectric(indices[k], (float)cos(degrees * M_PI / 180)));
    }
}

/* ---- D3, D4: levels by exponent, and lobes' errors ---- */

enum { CHAIN_SIDE = 128 }; /* texels */

/* Levels rise as exponents fall: each is narrower by half than the next, and a lobe's volume is
 * 2 pi / (s + 1). */
static void add_levels(cJSON *figures)
{
    enum { STEPS = TL_LOBE_STEPS - 1 }; /* the last is a mirror, s infinite */
    static struct tl_lobe_table table;
    tl_lobe_calibrate(CHAIN_SIDE, TL_CHAIN_SQRT_COSINE, &table);
    cJSON *series = tl_report_add_plot(
        figures,
        &(const struct tl_report_plot){
            "exponent s", "level of the chain", true, false,
            "D3: the level of a chain of 128 texels a face whose response to a texel has the volume of the "
            "cosine lobe, by the filter of the paper. It falls from the first exponent to the last."});
    cJSON *points = tl_report_add_series(series, "level of equal volume", false);
    for (int i = 0; i < STEPS; i++)
        tl_report_add_point(points, STEPS / (double)(STEPS - i), (double)table.level[i]);
}

static void add_lobes(cJSON *figures)
{
    static const float exponents[] = {1, 4, 16, 64, 256, 1024};
    static const int methods[] = {TL_CHAIN_SQRT_COSINE, TL_LOBE_SLICES};
    enum { COUNT = TL_COUNT(exponents) };
    const struct tl_lobe_curves curves = {.cube_size = CHAIN_SIDE,
                                          .direction_count = 26,
                                          .region_count = 24,
                                          .exponent_count = COUNT,
                                          .exponents = exponents};
    add_levels(figures);
    cJSON *series = tl_report_add_plot(
        figures,
        &(const struct tl_report_plot){
            "exponent s", "mean L1 error of the lobe, %", true, true,
            "D4: integral |E - K| / integral K over the sphere, E being what is shown of one lit texel and "
            "K the cosine lobe, mean over 26 texels: the middles, edges and corners of the cube's faces."});
    for (size_t m = 0; m < TL_COUNT(methods); m++) {
        struct tl_lobe_curve_point curve[COUNT];
        cJSON *points = tl_report_add_series(series, tl_lobe_method_names[methods[m]], false);
        tl_lobe_curve(&curves, methods[m], curve);
        for (size_t i = 0; i < COUNT; i++)
            tl_report_add_point(points, (double)exponents[i], 100 * curve[i].mean);
    }
}

/* ---- D8, D16: bytes of PEMs and shadow maps, whole and cropped, by size and number of regions ---- */

#define MEBIBYTE 1048576.0

static void add_side(cJSON *rows, int side, const double *mib, int count)
{
    char name[16];
    snprintf(name, sizeof name, "%d", side);
    tl_report_add_row(rows, name, mib, count);
}

static void add_memory(cJSON *figures)
{
    static const struct tl_report_column columns[] = {{"texels a side", 0},
                                                      {"level 0 alone, MiB", 3},
                                                      {"with mip levels, MiB", 3},
                                                      {"shadow maps of as many texels, RG32F, MiB", 3},
                                                      {"the same in RG16F, MiB", 3}};
    static const int sides[] = {16, 32, 64, 128, 256};
    const int regions = 24; /* as in the section's pictures */
    cJSON *rows = tl_report_add_table(figures, columns, TL_COUNT(columns));
    for (size_t i = 0; i < TL_COUNT(sides); i++) {
        const double mib[] = {(double)tl_memory_cubes(regions, sides[i]) / MEBIBYTE,
                              (double)tl_memory_chains(regions, sides[i]) / MEBIBYTE,
                              (double)tl_memory_shadow_maps(regions, sides[i], 8) / MEBIBYTE,
                              (double)tl_memory_shadow_maps(regions, sides[i], 4) / MEBIBYTE};
        add_side(rows, sides[i], mib, TL_COUNT(mib));
    }
}

static void add_crops(cJSON *figures)
{
    static const int sides[] = {32, 64, 128}, counts[] = {24, 96};
    static const struct tl_report_column columns[] = {{"texels a side", 0},
                                                      {"24 regions, cubes, MiB", 3},
                                                      {"paraboloids, MiB", 3},
                                                      {"96 regions, cubes, MiB", 3},
                                                      {"paraboloids, MiB", 3}};
    cJSON *rows = tl_report_add_table(figures, columns, TL_COUNT(columns));
    for (size_t i = 0; i < TL_COUNT(sides); i++) {
        double mib[2 * TL_COUNT(counts)];
        tl_cube even = tl_cube_create(sides[i]); /* regions of equal solid angle */
        for (int k = 0; k < 18 * sides[i] * sides[i]; k++)
            even.texels[k] = 1;
        for (size_t k = 0; k < TL_COUNT(counts); k++) {
            struct tl_regions regions = {0};
            tl_regions_cut(&even, counts[k], &regions);
            mib[2 * k] = (double)tl_memory_chains(counts[k], sides[i]) / MEBIBYTE;
            mib[2 * k + 1] =
                (double)tl_memory_paraboloids(&even, &regions, TL_CHAIN_SQRT_COSINE, 12) / MEBIBYTE;
            tl_regions_release(&regions);
        }
        add_side(rows, sides[i], mib, TL_COUNT(mib));
        tl_cube_release(&even);
    }
}

void tl_gallery_add_figures(const char *section, cJSON *figures)
{
    static const struct {
        const char *section;
        void (*add)(cJSON *figures);
    } all[] = {{"a1", add_tables},    {"a2", add_grazing}, {"a3", add_folded},
               {"a9", add_normalise}, {"a10", add_powers}, {"b6", add_fresnel},
               {"d4", add_lobes},     {"d8", add_memory},  {"d16", add_crops}};
    for (size_t i = 0; i < TL_COUNT(all); i++)
        if (strcmp(all[i].section, section) == 0)
            all[i].add(figures);
}
