/* Sewing patterns: flat panels with their outlines, the stitches that join them, and where each panel hangs
 * before it is sewn. Read from GarmentCode's pattern JSON [Korosteleva and Sorkine-Hornung 2023] and that of
 * its predecessor [Korosteleva and Lee 2021].
 *
 * Lengths are in metres. A panel's own axes are those of its outer side: x to the right and y up as one who
 * stands outside sees it, so that its outline runs counter-clockwise. Lifetime: a pattern owns everything
 * that it points to, until tl_pattern_release. Threads: pure. */
#ifndef TOILE_ASSETS_PATTERN_PATTERN_H
#define TOILE_ASSETS_PATTERN_PATTERN_H

#include "assets/sewing/panel.h"
#include "config/base/error.h"

#include <stdbool.h>
#include <stddef.h>

/* Checked before memory is asked for. */
#define TL_LIMIT_PATTERN_BYTES    ((size_t)16 << 20)
#define TL_LIMIT_PATTERN_PANELS   1024
#define TL_LIMIT_PATTERN_EDGES    1024 /* of one panel */
#define TL_LIMIT_PATTERN_STITCHES 16384
#define TL_LIMIT_PATTERN_METRES   100.0 /* of a coordinate */

/* One edge of an outline: a Bezier curve or an arc. */
struct tl_pattern_edge {
    char *label; /* "" for none */
    struct tl_pattern_hold {
        bool is_set;
        int axis, side;    /* as in struct tl_hold */
        double level;      /* m */
    } hold;                /* of its vertices (tl_pattern_hold) */
    struct tl_curve curve; /* a line or a curve of second degree, too; unused in arcs */
    bool is_arc;
    struct tl_point centre;      /* of an arc */
    double radius, start, sweep; /* m; rad, counter-clockwise from x */
};

struct tl_pattern_panel {
    char *name, *label; /* label "" for none */
    /* (x, y) of the panel hangs at origin + x across + y up, in world axes; the last two are unit vectors. */
    double origin[3], across[3], up[3];
    size_t edge_count;
    struct tl_pattern_edge *edges; /* counter-clockwise; each begins where the one before it ends */
};

/* Two edges that are sewn together. Outlines run alike, so the start of the one meets the end of the other,
 * except where the outer side of one comes upon the inner side of the other (`right_wrong`). */
struct tl_pattern_stitch {
    struct tl_pattern_side {
        size_t panel, edge;
    } sides[2];
    bool right_wrong;
};

typedef struct tl_pattern {
    char *name; /* the file's name without folders */
    size_t panel_count;
    struct tl_pattern_panel *panels;
    size_t stitch_count;
    struct tl_pattern_stitch *stitches;
} tl_pattern;

/* Whether the extension is that of a pattern, .json. The file need not exist. */
bool tl_pattern_is_file(const char *path);

/* Reads a file: lines, curves of second and third degree, arcs; the old `curvature: [x, y]`; relative and
 * absolute curvature; edges in any order. Errors: TL_INPUT, one line with the panel and the edge; *out is
 * zeroed then. */
bool tl_pattern_load(const char *path, tl_pattern *out, tl_error *error);
void tl_pattern_release(tl_pattern *pattern); /* frees and zeroes */

double tl_pattern_edge_length(const struct tl_pattern_edge *edge);
struct tl_point tl_pattern_edge_start(const struct tl_pattern_edge *edge);
/* The edge's start and its inner divisions, at equal lengths; out [segments]. */
void tl_pattern_edge_divide(const struct tl_pattern_edge *edge, int segments, struct tl_point *out);

double tl_pattern_panel_area(const struct tl_pattern_panel *panel); /* m^2 */

/* The excess of the longer side of a stitch over the shorter, as a share of the shorter: it is gathered
 * there. */
double tl_pattern_stitch_ease(const tl_pattern *pattern, size_t stitch);

#endif
