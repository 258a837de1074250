/* Garments for measurements: flat squares and strips, and a tube and a triangle whose equilibrium under their
 * own weight is known in closed form. Metres. Release with tl_garment_release. Pure. */
#ifndef TOILE_APP_LAB_EXPERIMENTS_CLOSED_FORM_H
#define TOILE_APP_LAB_EXPERIMENTS_CLOSED_FORM_H

#include "assets/garment.h"
#include "cloth/cloth.h"

enum tl_sheet_hold { TL_SHEET_FREE, TL_SHEET_EDGE, TL_SHEET_CORNERS };

/* `side` x `side` vertices, 1 m square, the first row held by all or by its ends. It hangs from y = 0 in the
 * plane z = 0 as in its pattern, or lies in y = 0. */
tl_garment tl_sheet_make(int side, enum tl_sheet_hold hold, bool lies);

/* A strip of `columns` x 2 square cells that lies in y = 1, along +x from its clamp, which is at 0: the two
 * columns of vertices half a cell before and after it are held, because the curvature of a hinge stands for
 * half a cell on either side. `length_m`: from the clamp to the free end. Its length runs along the weft, or
 * else along the warp. */
tl_garment tl_strip_make(double length_m, int columns, bool is_warp);
/* How far the free end hangs below the clamp, in lengths of the strip, where weight per area times length^3
 * over bending stiffness is TL_STRIP_LOAD: the elastica B theta'' = -w (L - s) cos theta, theta(0) = 0,
 * theta'(L) = 0 (solved in tests/cloth/energy/test_bending.c). */
#define TL_STRIP_LOAD  8
#define TL_STRIP_DROOP 0.64063

/* A tube of `columns` cells around, hung by its rim at y = 0. Every vertex of a row is like its neighbours,
 * so that it hangs by rows: row j sinks by sum over i <= j of height_i (weight below row i) / (k columns
 * width), for any triangulation (docs/notes/cloth.md, closed forms). Of `row_count` rows of cells the first
 * half may be shorter than the others by `mass_ratio`; all cells' heights and widths differ by its root at
 * most. */
struct tl_tube {
    int columns, row_count;
    double height_m; /* of all rows, at rest */
    double mass_ratio;
};

/* Rest height of a row of cells, and how much of the tube's area hangs on its upper end in that row. */
double tl_tube_row_height(const struct tl_tube *tube, int row);
double tl_tube_width(const struct tl_tube *tube); /* of a cell */

/* Displacement downwards of the vertices of rows 0..row_count, metres; `out` has row_count + 1. */
void tl_tube_sink(const struct tl_tube *tube, const struct tl_cloth_fabric *fabric, double gravity,
                  double *out);

/* How far below its true rest `preview` holds the tube's lower end, at most, in substeps of h seconds: one
 * sweep leaves every vertex of mass m moved by the pushes that come after those it was balanced by, h^2 T / m
 * under the tension T of what hangs on it. (Cells whose diagonal is strained further than cloth may be are
 * refused.) */
double tl_tube_slack(const struct tl_tube *tube, const struct tl_cloth_fabric *fabric, double gravity,
                     double h);

/* Rows lowered by `sink` (or NULL: as in its pattern), vertices then moved by up to `scramble` of their own
 * cell's sides, by a fixed hash. */
tl_garment tl_tube_make(const struct tl_tube *tube, const double *sink, double scramble);

/* One triangle of 1 m, hung by its upper edge, which ends a metre below: its lower corner carries a third of
 * the weight and sinks by density * gravity / 3k metres. */
double tl_triangle_sink(const struct tl_cloth_fabric *fabric, double gravity);
tl_garment tl_triangle_make(double sink, double scramble);

#endif
