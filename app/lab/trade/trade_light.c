/* The axis of light: what the paper measured, and the ways beyond it. Five looks: three glossinesses in the
 * scene's light; then two in which the image is one number of interest: irradiance, and the share of a
 * uniform sky that is seen. */
#include "app/lab/trade/trade.h"
#include "app/lab/trade/trade_light_figures.h"
#include "app/report/report.h"
#include "config/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PLAIN(diffuse, specular, glossiness)                                                                 \
    {                                                                                                        \
        "material.use_file=false", "material.diffuse=[" diffuse "]", "material.specular=[" specular "]",     \
            "material.glossiness=" glossiness                                                                \
    }
#define EVEN(share) share ", " share ", " share

enum { LOOK_MATT, LOOK_SATIN, LOOK_GLOSSY, LOOK_IRRADIANCE, LOOK_SKY };
static const struct tl_trade_look looks[] = {
    {"g=0", "glossiness 0", PLAIN(EVEN("0.5"), EVEN("0.5"), "0"), {NULL}, false},
    {"g=0.7", "glossiness 0.7", PLAIN(EVEN("0.5"), EVEN("0.5"), "0.7"), {NULL}, false},
    {"g=0.95", "glossiness 0.95", PLAIN(EVEN("0.5"), EVEN("0.5"), "0.95"), {NULL}, false},
    {"irradiance", "irradiance", PLAIN(EVEN("1"), EVEN("0"), "0"), {NULL}, false},
    {"sky", "visibility of a uniform sky", PLAIN(EVEN("1"), EVEN("0"), "0"), {NULL}, true},
};

#define PAPER(...)                                                                                           \
    "paper",                                                                                                 \
    {                                                                                                        \
        "light.lobe=dual", __VA_ARGS__                                                                       \
    }
static const struct tl_entrant entrants[] = {
    {"presets", {"paper", PAPER(NULL)}, true, true, 0},
    {"presets", {"draft", "draft", {NULL}}, true, false, 0},
    {"presets", {"review", "review", {NULL}}, true, true, 0},
    {"presets", {"final", "final", {NULL}}, false, true, 0},

    {"regions, paper", {"paper N=6", PAPER("light.regions=6")}, true, false, 0},
    {"regions, paper", {"paper N=24", PAPER("light.regions=24")}, false, false, 0},
    {"regions, paper", {"paper N=48", PAPER("light.regions=48")}, false, false, 0},
    {"regions, paper", {"paper N=96", PAPER(NULL)}, false, false, 0},
    {"regions, paper", {"paper N=192", PAPER("light.regions=192")}, false, false, 0},
    {"regions, paper", {"paper N=384", PAPER("light.regions=384", "light.map_size=128")}, false, false, 0},

    {"regions, rays", {"rays N=24", "review", {"light.regions=24", "light.refresh=6"}}, false, false, 0},
    {"regions, rays", {"rays N=48", "review", {"light.regions=48", "light.refresh=6"}}, false, false, 0},
    {"regions, rays", {"rays N=96", "review", {"light.regions=96", "light.refresh=12"}}, false, false, 0},
    {"regions, rays", {"rays N=192", "review", {"light.regions=192", "light.refresh=24"}}, false, false, 0},
    {"regions, rays", {"rays N=384", "review", {"light.regions=384", "light.refresh=48"}}, false, false, 0},
    {"regions, rays",
     {"rays N=384 all", "review", {"light.regions=384", "light.refresh=0"}},
     false,
     false,
     0},

    {"map size", {"paper 32", PAPER("light.map_size=32")}, false, false, 0},
    {"map size", {"paper 64", PAPER("light.map_size=64")}, true, false, 0},
    {"map size", {"paper 128", PAPER("light.map_size=128")}, false, false, 0},
    {"map size", {"paper 256", PAPER(NULL)}, false, false, 0},
    {"map size", {"paper 512", PAPER("light.map_size=512")}, false, false, 0},

    {"filter", {"no filter", PAPER("light.filter=none")}, false, false, 0},
    {"filter", {"Gauss", PAPER("light.filter=gauss")}, false, false, 0},
    {"filter", {"cosine", PAPER("light.filter=cosine")}, false, false, 0},
    {"filter", {"box", PAPER("light.filter=box")}, false, false, 0},
    {"filter", {"root of cosine", PAPER(NULL)}, false, false, 0},
    {"filter", {"exact slices", PAPER("light.prefilter=slices")}, false, false, 0},

    {"back-end", {"vsm, unblurred", PAPER("light.prefilter=slices", "light.blur_m=0")}, false, false, 0},
    {"back-end", {"depth", PAPER("light.prefilter=slices", "light.visibility=depth")}, false, false, 0},
    {"back-end",
     {"depth, sphere cut, sun",
      PAPER("light.prefilter=slices", "light.visibility=depth", "light.cut=sphere", "light.sun=true")},
     false,
     false,
     0},
    {"back-end",
     {"depth, difference", PAPER("light.prefilter=slices", "light.visibility=depth", "light.cut=sphere",
                                 "light.sun=true", "light.composition=difference")},
     false,
     false,
     0},
    {"back-end",
     {"depth, ratio", PAPER("light.prefilter=slices", "light.visibility=depth", "light.cut=sphere",
                            "light.sun=true", "light.composition=ratio")},
     false,
     false,
     0},

    {"rounds", {"rays, 64 rounds", "review", {"light.jitter=true", "light.rounds=64"}}, false, false, 0},
    {"rounds",
     {"depth maps, 32 rounds",
      "paper",
      {"light.lobe=dual", "light.prefilter=slices", "light.visibility=depth", "light.jitter=true",
       "light.rounds=32", "light.map_size=128"}},
     false,
     false,
     0},

    {"other methods", {"no occlusion", "review", {"light.method=unshadowed"}}, true, true, 0},
    {"other methods", {"ambient occlusion", "review", {"light.method=ao"}}, false, true, 0},
    {"other methods", {"ambient occlusion, coloured", "review", {"light.method=ao_colour"}}, false, true, 0},
    {"other methods", {"lights", PAPER("light.method=lights")}, true, true, 0},
};

/* ---- Figures of the report ---- */

/* One line of a plot: rows of a group, x from the row's settings. */
enum axis_value { BY_REGIONS, BY_MAP_SIZE, BY_DRAWS, VALUE_CPU, VALUE_ERROR };

static double value_of(const struct tl_trade_row *row, enum axis_value which)
{
    switch (which) {
    case BY_REGIONS:
        return row->settings.light.regions;
    case BY_MAP_SIZE:
        return row->settings.light.map_size;
    case BY_DRAWS:
        return row->draws;
    case VALUE_CPU:
        return row->taken.cpu_ms;
    case VALUE_ERROR:
        return 100 * row->error.rel_rmse;
    }
    return NAN;
}

struct lines {
    struct tl_plot_point *points;
    size_t count;
    struct tl_plot_series series[TL_PLOT_STYLES];
    size_t series_count;
};

static void begin_line(struct lines *lines, const struct tl_trade *trade, const char *name)
{
    if (!lines->points)
        lines->points = TL_NEW_ARRAY(struct tl_plot_point, TL_PLOT_STYLES * (trade->row_count + 1));
    lines->series[lines->series_count++] =
        (struct tl_plot_series){.name = name, .points = &lines->points[lines->count], .line = true};
}

static void add_point(struct lines *lines, const struct tl_trade_row *row, enum axis_value x,
                      enum axis_value y)
{
    lines->points[lines->count++] =
        (struct tl_plot_point){value_of(row, x), value_of(row, y), row->name, false};
    lines->series[lines->series_count - 1].count++;
}

static void add_group_line(struct lines *lines, const struct tl_trade *trade, const char *group, int look,
                           enum axis_value x, enum axis_value y)
{
    if (!tl_trade_next(trade, NULL, group, look, false))
        return;
    begin_line(lines, trade, group);
    for (const struct tl_trade_row *row = NULL; (row = tl_trade_next(trade, row, group, look, false));)
        add_point(lines, row, x, y);
}

/* A quick run leaves single points, which make no line. */
static void print_lines(struct lines *lines, const char *x_label, const char *y_label, const char *caption,
                        FILE *out)
{
    bool joined = false;
    for (size_t i = 0; i < lines->series_count; i++)
        joined |= lines->series[i].count > 1;
    if (joined)
        tl_report_plot(out,
                       &(struct tl_plot){x_label, y_label, true, true, lines->series, lines->series_count},
                       caption);
    free(lines->points);
    *lines = (struct lines){0};
}

static void print_sweeps(const struct tl_trade *trade, FILE *out)
{
    struct lines lines = {0};
    const int look = LOOK_SATIN;
    tl_report_heading(out, "Regions and shadow maps");
    add_group_line(&lines, trade, "regions, paper", look, BY_REGIONS, VALUE_CPU);
    add_group_line(&lines, trade, "regions, rays", look, BY_REGIONS, VALUE_CPU);
    print_lines(&lines, "regions N", "CPU ms a frame", "Time against N, as the paper's figure 7 has it.",
                out);
    add_group_line(&lines, trade, "map size", look, BY_MAP_SIZE, VALUE_CPU);
    print_lines(&lines, "shadow map, texels a side", "CPU ms a frame", "Time against map size, N = 96.", out);
    add_group_line(&lines, trade, "regions, paper", look, BY_REGIONS, VALUE_ERROR);
    add_group_line(&lines, trade, "regions, rays", look, BY_REGIONS, VALUE_ERROR);
    print_lines(&lines, "regions N", "relative RMSE, %", "Error against N, glossiness 0.7, in motion.", out);
    add_group_line(&lines, trade, "map size", look, BY_MAP_SIZE, VALUE_ERROR);
    print_lines(&lines, "shadow map, texels a side", "relative RMSE, %",
                "Error against map size, N = 96, glossiness 0.7, in motion.", out);
}

/* How the variants that average get nearer to the truth while nothing moves. */
static void print_rest(const struct tl_trade *trade, FILE *out)
{
    struct lines lines = {0};
    const int look = LOOK_SATIN;
    for (const struct tl_trade_row *row = NULL; (row = tl_trade_next(trade, row, NULL, look, false));) {
        bool measured = strcmp(row->group, "rounds") == 0 || strcmp(row->group, "presets") == 0;
        if (!row->settings.light.jitter || !measured || lines.series_count == TL_PLOT_STYLES)
            continue;
        begin_line(&lines, trade, row->name);
        add_point(&lines, row, BY_DRAWS, VALUE_ERROR);
        for (const struct tl_trade_row *rest = NULL;
             (rest = tl_trade_next(trade, rest, row->group, look, true));)
            if (strcmp(rest->name, row->name) == 0)
                add_point(&lines, rest, BY_DRAWS, VALUE_ERROR);
    }
    if (!lines.series_count)
        return;
    tl_report_heading(out, "At rest");
    print_lines(&lines, "frames drawn since the motion stopped", "relative RMSE, %",
                "Jittered directions, averaged while nothing moves. Glossiness 0.7.", out);
}

static void print_figures(const struct tl_trade *trade, FILE *out)
{
    print_rest(trade, out);
    print_sweeps(trade, out);
    if (trade->complete) { /* Ctrl-C asks for haste */
        tl_trade_write_lobes(trade->quick, out);
        tl_trade_write_memory(trade->environment, out);
    }
}

const struct tl_trade_axis tl_trade_light = {
    .name = "light",
    .title = "The trade of light: error against time",
    .text =
        "Down and left is better. Every mark is one choice of settings that drew the same moving cloth; the "
        "dashed line joins those that nothing else beats in both.",
    .scene = "review",
    .truth = {.name = "reference", .assignments = {"light.method=reference", "light.lobe=dual"}},
    .looks = looks,
    .look_count = TL_COUNT(looks),
    .quick_look = LOOK_SATIN,
    .entrants = entrants,
    .entrant_count = TL_COUNT(entrants),
    .warm = 16,
    .measured = 3,
    .rests = true,
    .figures = print_figures,
};
