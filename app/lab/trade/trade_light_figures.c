#include "app/lab/trade/trade_light_figures.h"

#include "app/report/cells.h"
#include "app/report/report.h"
#include "config/memory.h"
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

/* Figure 4: one lit texel seen along a great circle through it. */
static void write_sections(FILE *out)
{
    enum { ANGLES = 181 };
    const float s = 4;
    float shown[ANGLES], wanted[ANGLES];
    struct tl_plot_point points[SECTIONS + 1][ANGLES];
    struct tl_plot_series series[SECTIONS + 1];
    for (size_t m = 0; m <= SECTIONS; m++) {
        bool truth = m == SECTIONS;
        if (!truth)
            tl_lobe_section(CUBE_SIZE, methods[m], s, ANGLES, shown, wanted);
        const char *name = truth ? "the cosine lobe" : tl_lobe_method_names[methods[m]];
        for (int i = 0; i < ANGLES; i++) {
            double degrees = -180 + 360.0 * i / (ANGLES - 1);
            points[m][i] =
                (struct tl_plot_point){degrees, (double)(truth ? wanted[i] : shown[i]), name, false};
        }
        series[m] = (struct tl_plot_series){
            .name = name, .points = points[m], .count = ANGLES, .line = !truth, .front = truth};
    }
    tl_report_plot(
        out,
        &(struct tl_plot){"degrees from the texel", "shown of a texel of power 1", false, false, series,
                          TL_COUNT(series)},
        "The paper's figure 4: one lit texel in the middle of a face, prefiltered for s = 4, along a great "
        "circle through it. Dashed: what it should be.");
}

/* Figure 5: error over the exponent. */
static void write_curves(bool quick, FILE *out)
{
    static const float exponents[] = {1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024};
    enum { COUNT = TL_COUNT(exponents) };
    const struct tl_lobe_curves curves = {.cube_size = CUBE_SIZE,
                                          .direction_count = quick ? 4 : 100,
                                          .region_count = 96,
                                          .exponent_count = quick ? 3 : COUNT,
                                          .exponents = exponents};
    struct tl_plot_point points[TL_COUNT(methods)][COUNT];
    struct tl_plot_series series[TL_COUNT(methods)];
    struct tl_cells cells = {0};
    static const char *const heads[] = {"filter", "mean error", "worst", "energy, least", "energy, most"};
    for (size_t i = 0; i < TL_COUNT(heads); i++)
        tl_cells_add(&cells, "%s", heads[i]);
    for (size_t m = 0; m < TL_COUNT(methods); m++) {
        struct tl_lobe_curve_point curve[COUNT];
        const char *name = tl_lobe_method_names[methods[m]];
        double mean = 0, worst = 0, low = INFINITY, high = 0;
        tl_lobe_curve(&curves, methods[m], curve);
        for (int i = 0; i < curves.exponent_count; i++) {
            points[m][i] = (struct tl_plot_point){(double)exponents[i], 100 * curve[i].mean, name, false};
            mean += curve[i].mean / curves.exponent_count;
            worst = fmax(worst, curve[i].worst);
            low = fmin(low, curve[i].energy_low);
            high = fmax(high, curve[i].energy_high);
        }
        series[m] = (struct tl_plot_series){
            .name = name, .points = points[m], .count = (size_t)curves.exponent_count, .line = true};
        tl_cells_add(&cells, "%s", name);
        tl_cells_add(&cells, "%.2f %%", 100 * mean);
        tl_cells_add(&cells, "%.2f %%", 100 * worst);
        tl_cells_add(&cells, "%.3f", low);
        tl_cells_add(&cells, "%.3f", high);
    }
    tl_report_plot(
        out,
        &(struct tl_plot){"exponent s", "mean L1 error of the lobe, %", true, true, series, TL_COUNT(series)},
        "The paper's figure 5: error = integral |E - K| / integral K over the sphere, E being what is "
        "shown of one lit texel and K the cosine lobe; mean over directions, cube corners among them.");
    tl_cells_print(&cells, TL_COUNT(heads), out);
}

void tl_trade_write_lobes(bool quick, FILE *out)
{
    tl_report_heading(out, "Prefilters and their lobes");
    write_sections(out);
    write_curves(quick, out);
}

void tl_trade_write_memory(const tl_environment *environment, FILE *out)
{
    static const char *const heads[] = {
        "regions",     "the paper, 128",        "RGBA16F, no mips",      "with mips",
        "paraboloids", "the paper's maps, 256", "this program's, RG32F", "RG16F"};
    const int size = 128, map = 256;
    struct tl_cells cells = {0};
    tl_cube cube = tl_cube_from_environment(environment, size);
    tl_report_heading(out, "Memory");
    tl_report_paragraph(out,
                        "MiB, with the columns of the paper's figure 8. Its column of PEMs is twice what six "
                        "faces of 128 x 128 "
                        "RGBA16F take. Paraboloids: the paper's proposal, maps cropped to where a PEM is not "
                        "black (light.pem_layout), with mip levels, 12 regions a texture.");
    for (size_t i = 0; i < TL_COUNT(heads); i++)
        tl_cells_add(&cells, "%s", heads[i]);
    for (int i = 0; i < TL_PAPER_ROWS; i++) {
        const struct tl_paper_memory *row = &tl_paper_memory[i];
        struct tl_regions regions = {0};
        tl_regions_cut_sphere(&cube, row->regions, &regions);
        tl_cells_add(&cells, "%d", row->regions);
        tl_cells_add(&cells, "%.1f", row->pems_mb[0]);
        tl_cells_add(&cells, "%.2f", (double)tl_memory_cubes(row->regions, size) / MEBIBYTE);
        tl_cells_add(&cells, "%.2f", (double)tl_memory_chains(row->regions, size) / MEBIBYTE);
        tl_cells_add(&cells, "%.2f",
                     (double)tl_memory_paraboloids(&cube, &regions, TL_CHAIN_SQRT_COSINE, 12) / MEBIBYTE);
        tl_cells_add(&cells, "%.2f", row->maps_mb[2]);
        tl_cells_add(&cells, "%.2f", (double)tl_memory_shadow_maps(row->regions, map, 8) / MEBIBYTE);
        tl_cells_add(&cells, "%.2f", (double)tl_memory_shadow_maps(row->regions, map, 4) / MEBIBYTE);
        tl_regions_release(&regions);
    }
    tl_cells_print(&cells, TL_COUNT(heads), out);
    tl_cube_release(&cube);
}
