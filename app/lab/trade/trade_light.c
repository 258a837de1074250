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

/* The filters that the paper has in its figures, and exact lobes: of the whole environment and of its
 * regions. */
static const int methods[] = {TL_CHAIN_GAUSS,       TL_CHAIN_COSINE, TL_CHAIN_BOX,
                              TL_CHAIN_SQRT_COSINE, TL_LOBE_WHOLE,   TL_LOBE_SLICES};
#define SECTIONS (TL_COUNT(methods) - 1) /* a section is of the whole environment */

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
    const float s = 4;
    float shown[ANGLES], wanted[ANGLES];
    cJSON *series = tl_report_add_plot(
        items,
        &(const struct tl_report_plot){
            .x_label = "degrees from the texel",
            .y_label = "shown of a texel of power 1",
            .caption = "The paper's figure 4: one lit texel in the middle of a face, prefiltered for s = "
                       "4, along a great circle through it. Dashed: what it should be."});
    for (size_t m = 0; m <= SECTIONS; m++) {
        bool truth = m == SECTIONS;
        if (!truth)
            tl_lobe_section(CUBE_SIZE, methods[m], s, ANGLES, shown, wanted);
        cJSON *points =
            tl_report_add_series(series, truth ? "the cosine lobe" : tl_lobe_method_names[methods[m]], truth);
        for (int i = 0; i < ANGLES; i++)
            tl_report_add_point(points, -180 + 360.0 * i / (ANGLES - 1),
                                (double)(truth ? wanted[i] : shown[i]));
    }
}

/* Figure 5: error over the exponent. */
static void add_curves(bool quick, cJSON *items)
{
    static const float exponents[] = {1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024};
    enum { COUNT = TL_COUNT(exponents) };
    const struct tl_lobe_curves curves = {.cube_size = CUBE_SIZE,
                                          .direction_count = quick ? 4 : 100,
                                          .region_count = 96,
                                          .exponent_count = quick ? 3 : COUNT,
                                          .exponents = exponents};
    static const struct tl_report_column columns[] = {
        {"filter", 0}, {"mean error, %", 2}, {"worst, %", 2}, {"energy, min", 3}, {"energy, max", 3}};
    cJSON *series = tl_report_add_plot(
        items,
        &(const struct tl_report_plot){
            "exponent s", "mean L1 error of the lobe, %", true, true,
            "The paper's figure 5: error = integral |E - K| / integral K over the sphere, E being what is "
            "shown of one lit texel and K the cosine lobe; mean over directions, cube corners among them."});
    cJSON *rows = tl_report_add_table(items, columns, TL_COUNT(columns));
    for (size_t m = 0; m < TL_COUNT(methods); m++) {
        struct tl_lobe_curve_point curve[COUNT];
        const char *name = tl_lobe_method_names[methods[m]];
        double mean = 0, worst = 0, low = INFINITY, high = 0;
        tl_lobe_curve(&curves, methods[m], curve);
        cJSON *points = tl_report_add_series(series, name, false);
        for (int i = 0; i < curves.exponent_count; i++) {
            tl_report_add_point(points, (double)exponents[i], 100 * curve[i].mean);
            mean += curve[i].mean / curves.exponent_count;
            worst = fmax(worst, curve[i].worst);
            low = fmin(low, curve[i].energy_low);
            high = fmax(high, curve[i].energy_high);
        }
        tl_report_add_row(rows, name, (const double[]){100 * mean, 100 * worst, low, high}, 4);
    }
}

void tl_trade_add_lobes(bool quick, cJSON *figures)
{
    cJSON *items = add_section(figures, "Prefilters and their lobes", "");
    add_sections(items);
    add_curves(quick, items);
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
