/* The trade of cloth: every solver, at several sizes and settings, against converged runs of the reference.
 *
 * A sheet of 1 m that lies level and is clamped by an edge falls for half a second (nothing buckles until
 * then); its positions are compared with those of the same sheet solved with a step as short as changes no
 * more, and with those of the finest such sheet, which shows what the mesh is worth. A sheet held by two
 * corners comes to rest; its energy, strain and shape are compared with the reference's calmest rest at its
 * size: a drape has a mirror image of equal energy, so the nearer of the two counts (docs/notes/cloth.md). */
#ifndef TOILE_APP_LAB_CLOTH_TRADE_CLOTH_H
#define TOILE_APP_LAB_CLOTH_TRADE_CLOTH_H

#include "app/lab/cloth/trade_fit.h"
#include "app/measure/cost.h"
#include "config/base/error.h"

#include <stdio.h>

struct tl_trade_cloth_row {
    int solver; /* enum tl_cloth_solver */
    int side;   /* vertices */
    char name[48];
    double dt, substep_s; /* s */
    int substeps;
    struct tl_taken fall, rest; /* ms per simulated second; ms to come to rest */
    double error_m;             /* RMS, against the same sheet converged */
    double total_error_m;       /* RMS, against the finest sheet */
    double rest_error_m;        /* RMS of the drape, mirror-aware; NaN where it was not measured */
    double rest_energy_j;       /* above the one compared with */
    double rest_strain;         /* largest */
};

struct tl_trade_cloth {
    struct tl_trade_cloth_row *rows;
    size_t row_count;
    char **refusals; /* "name: message" */
    size_t refusal_count;
    int truth_side;
    struct tl_trade_fit fit;
    double truth_error_m; /* of the finest converged sheet against itself at twice the step */
    bool complete;
};

/* `quick`: two sizes, a few settings. Interrupted: TL_INTERRUPTED, and `out` holds what was done. */
bool tl_trade_cloth(bool quick, struct tl_trade_cloth *out, tl_error *error);
void tl_trade_cloth_release(struct tl_trade_cloth *trade);

void tl_trade_cloth_write_csv(const struct tl_trade_cloth *trade, FILE *out);
/* FOLDER/report.html. */
bool tl_trade_cloth_write_report(const struct tl_trade_cloth *trade, const char *folder, tl_error *error);

#endif
