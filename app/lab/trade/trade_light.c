#include "app/lab/trade/trade_light.h"

#include "app/report/report.h"
#include "config/base/memory.h"
#include "render/env/from_environment.h"
#include "render/pem/chain.h"
#include "render/pem/lobe_error.h"
#include "render/pem/memory.h"

#include <math.h>
#include <stdlib.h>

#define MEBIBYTE  1048576.0
#define CUBE_SIZE 128 /* texels, of the PEMs that are judged */

/* The five filters of the paper's figures 4 and 5, and exact lobes: of the whole environment and of its
 * regions. */
static const int methods[] = {TL_CHAIN_NONE,        TL_CHAIN_GAUSS, TL_CHAIN_COSINE, TL_CHAIN_BOX,
                              TL_CHAIN_SQRT_COSINE, TL_LOBE_WHOLE,  TL_LOBE_SLICES};
enum { METHODS = TL_COUNT(methods) };
#define SECTIONS (METHODS - 1) /* a section is of the whole environment */

static const char *method_name(int method)
{
    return method == TL_CHAIN_NONE ? "MIP map only" : tl_lobe_method_names[method];
}

/* Adds a section of figures to the page; returns its items. */
static cJSON *add_section(cJSON *figures, const char *title, const char *text)
{
    cJSON *section = cJSON_CreateObject();
    cJSON_AddStringToObject(section, "title", title);
    cJSON_AddStringToObject(section, "text", text);
    cJSON_AddItemToArray(figures, section);
    return cJSON_AddArrayToObject(section, "items");
}

/* Figure 4: one lit texel seen along a great circle through it. */
static void add_sections(cJSON *items)
{
    enum { ANGLES = 181 };
    const float s = 1;
    float shown[ANGLES], wanted[ANGLES];
    cJSON *series = tl_report_add_plot(
        items,
        &(const struct tl_report_plot){
            .x_label = "degrees from the texel",
            .y_label = "shown of a texel of power 1",
            .caption = "[Knuth et al. 2014, figure 4]: one lit texel in the middle of a face, prefiltered "
                       "for s = 1, along a great circle through it. Dashed: what it should be."});
    for (int m = 0; m <= SECTIONS; m++) {
        bool truth = m == SECTIONS;
        if (!truth)
            tl_lobe_section(CUBE_SIZE, methods[m], s, ANGLES, shown, wanted);
        cJSON *points =
            tl_report_add_series(series, truth ? "the cosine lobe" : method_name(methods[m]), truth);
        for (int i = 0; i < ANGLES; i++)
            tl_report_add_point(points, -180 + 360.0 * i / (ANGLES - 1),
                                (double)(truth ? wanted[i] : shown[i]));
    }
}

/* ---- Figure 5: error over the exponent ---- */

#define PER_OCTAVE 4 /* exponents, so that what lies between two levels of a chain shows */
enum { EXPONENTS = 10 * PER_OCTAVE + 1 };

struct errors {
    float exponents[EXPONENTS];
    int count;
    struct tl_lobe_curve_point points[METHODS][EXPONENTS];
    double box_at_best; /* at s = 1, with the level that fits each direction best */
};

static void measure(bool quick, struct errors *out)
{
    out->count = quick ? 6 : EXPONENTS;
    for (int i = 0; i < out->count; i++)
        out->exponents[i] = exp2f((float)i / (quick ? 1 : PER_OCTAVE));
    struct tl_lobe_curves curves = {.cube_size = CUBE_SIZE,
                                    .direction_count = quick ? 4 : 30,
                                    .region_count = 96,
                                    .exponent_count = out->count,
                                    .exponents = out->exponents};
    for (int m = 0; m < METHODS; m++)
        tl_lobe_curve(&curves, methods[m], out->points[m]);
    double worst;
    curves.exponent_count = 1;
    tl_lobe_min_error(&curves, TL_CHAIN_BOX, &out->box_at_best, &worst);
}

static int index_of(int method)
{
    int m = 0;
    while (methods[m] != method)
        m++;
    return m;
}

/* The mean error of a method's shape over the exponents from `from` up. */
static double mean_from(const struct errors *errors, int method, float from)
{
    double sum = 0;
    int count = 0;
    for (int i = 0; i < errors->count; i++)
        if (errors->exponents[i] >= from) {
            sum += errors->points[index_of(method)][i].same_volume_mean;
            count++;
        }
    return sum / count;
}

static bool box_is_nearest_at_one(const struct errors *errors)
{
    const struct tl_lobe_curve_point *box = errors->points[index_of(TL_CHAIN_BOX)];
    for (int m = 0; m < METHODS; m++)
        if (methods[m] < TL_LOBE_SLICES && errors->points[m][0].same_volume_mean < box->same_volume_mean)
            return false;
    return true;
}

static bool filters_beat_none(const struct errors *errors)
{
    bool beat = true;
    for (int m = 1; m < METHODS; m++)
        for (int i = 0; i < errors->count; i++)
            beat = beat && (methods[m] >= TL_LOBE_SLICES ||
                            errors->points[m][i].same_volume_mean < errors->points[0][i].same_volume_mean);
    return beat;
}

/* The statements of the paper on its figure 5, and whether these figures agree. */
static char *compare_with_paper(const struct errors *errors)
{
    const struct tl_lobe_curve_point box = errors->points[index_of(TL_CHAIN_BOX)][0],
                                     *cosine = errors->points[index_of(TL_CHAIN_COSINE)];
    double reached = fmin(fmin(box.mean, box.same_volume_mean), fmin(box.radial_mean, errors->box_at_best)),
           max_error = 0, root = mean_from(errors, TL_CHAIN_SQRT_COSINE, 16),
           beaten = mean_from(errors, TL_CHAIN_BOX, 16);
    for (int i = 0; i < errors->count; i++)
        max_error = fmax(max_error, cosine[i].same_volume_mean);
    return tl_format(
        "The paper finds the box nearest at s = 1: here %s. Every filter beats the MIP map alone: here %s. "
        "The root of the cosine beats the box as s rises: here %s, %.0f against %.0f %% in the mean from 16 "
        "on. It has \"roughly 4 %%\" for the box at s = 1, here %.0f %% by L1, %.0f %% at the same volume, "
        "%.0f %% by the volume of the plotted solid, and %.0f %% at the level that fits each direction best: "
        "%s. It has the cosine \"always below 10 %%\", here up to %.0f %%.",
        box_is_nearest_at_one(errors) ? "it is" : "it is not",
        filters_beat_none(errors) ? "it does" : "it does not", root < beaten ? "it does" : "it does not",
        100 * root, 100 * beaten, 100 * box.mean, 100 * box.same_volume_mean, 100 * box.radial_mean,
        100 * errors->box_at_best,
        reached > 0.05 ? "no reading of its text reaches its 4 %" : "one reading of its text reaches its 4 %",
        100 * max_error);
}

static void add_curves(const struct errors *errors, bool same_volume, const char *caption, cJSON *items)
{
    cJSON *series = tl_report_add_plot(
        items, &(const struct tl_report_plot){"exponent s",
                                              same_volume ? "mean error of the lobe's shape, %"
                                                          : "mean L1 error of the lobe, %",
                                              true, true, caption});
    for (int m = 0; m < METHODS; m++) {
        cJSON *points = tl_report_add_series(series, method_name(methods[m]), false);
        for (int i = 0; i < errors->count; i++) {
            const struct tl_lobe_curve_point *point = &errors->points[m][i];
            tl_report_add_point(points, (double)errors->exponents[i],
                                100 * (same_volume ? point->same_volume_mean : point->mean));
        }
    }
}

static void add_summary(const struct errors *errors, cJSON *items)
{
    static const struct tl_report_column columns[] = {
        {"filter", 0},   {"mean error, %", 2}, {"worst, %", 2},   {"same volume, mean, %", 2},
        {"at s = 1", 2}, {"energy, min", 3},   {"energy, max", 3}};
    cJSON *rows = tl_report_add_table(items, columns, TL_COUNT(columns));
    for (int m = 0; m < METHODS; m++) {
        const struct tl_lobe_curve_point *points = errors->points[m];
        double mean = 0, worst = 0, shape = 0, low = INFINITY, high = 0;
        for (int i = 0; i < errors->count; i++) {
            mean += points[i].mean / errors->count;
            shape += points[i].same_volume_mean / errors->count;
            worst = fmax(worst, points[i].worst);
            low = fmin(low, points[i].energy_low);
            high = fmax(high, points[i].energy_high);
        }
        tl_report_add_row(rows, method_name(methods[m]),
                          (const double[]){100 * mean, 100 * worst, 100 * shape,
                                           100 * points[0].same_volume_mean, low, high},
                          6);
    }
}

void tl_trade_add_lobes(bool quick, cJSON *figures)
{
    struct errors *errors = TL_NEW(struct errors);
    cJSON *items = add_section(figures, "Prefilters and their lobes", "");
    measure(quick, errors);
    char *compared = compare_with_paper(errors);
    add_sections(items);
    add_curves(errors, true, compared, items);
    add_curves(errors, false,
               "The same by integral |E - K| / integral K over the sphere, E being what is shown of one lit "
               "texel and K the cosine lobe, without making their volumes equal: the light of a pixel. Means "
               "over directions, cube corners among them.",
               items);
    add_summary(errors, items);
    free(compared);
    free(errors);
}

void tl_trade_add_memory(const tl_environment *environment, cJSON *figures)
{
    static const struct tl_report_column columns[] = {
        {"regions", 0},     {"the paper, 128", 1},        {"RGBA16F, no mips", 2},      {"with mips", 2},
        {"paraboloids", 2}, {"the paper's maps, 256", 2}, {"this program's, RG32F", 2}, {"RG16F", 2}};
    const int size = 128, map = 256;
    tl_cube cube = tl_cube_from_environment(environment, size);
    cJSON *rows = tl_report_add_table(
        add_section(
            figures, "Memory",
            "MiB, with the columns of the paper's figure 8. Its column of PEMs is twice what six faces of "
            "128 x 128 RGBA16F take. Paraboloids: the paper's proposal, maps cropped to where a PEM is not "
            "black (light.pem_layout), with mip levels, 12 regions a texture."),
        columns, TL_COUNT(columns));
    for (int i = 0; i < TL_PAPER_ROWS; i++) {
        const struct tl_paper_memory *row = &tl_paper_memory[i];
        struct tl_regions regions = {0};
        char name[16];
        snprintf(name, sizeof name, "%d", row->regions);
        tl_regions_cut_sphere(&cube, row->regions, &regions);
        const double mib[] = {row->pems_mb[0],
                              (double)tl_memory_cubes(row->regions, size) / MEBIBYTE,
                              (double)tl_memory_chains(row->regions, size) / MEBIBYTE,
                              (double)tl_memory_paraboloids(&cube, &regions, TL_CHAIN_SQRT_COSINE, 12) /
                                  MEBIBYTE,
                              row->maps_mb[2],
                              (double)tl_memory_shadow_maps(row->regions, map, 8) / MEBIBYTE,
                              (double)tl_memory_shadow_maps(row->regions, map, 4) / MEBIBYTE};
        tl_report_add_row(rows, name, mib, TL_COUNT(mib));
        tl_regions_release(&regions);
    }
    tl_cube_release(&cube);
}
