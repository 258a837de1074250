/* What each setting of the cloth does to a fit: the built-in dress and skirt at rest on the form, by settings
 * that differ from the default in one thing each. Heights, lengths and eases as `toile measure` has them are
 * compared with those of the same mesh solved by the reference. Equal drapes need not have equal folds: a fit
 * is compared, not the places of vertices. */
#ifndef TOILE_APP_LAB_CLOTH_TRADE_FIT_H
#define TOILE_APP_LAB_CLOTH_TRADE_FIT_H

#include "app/measure/cost.h"
#include "config/base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

enum tl_fit_figure {
    TL_FIT_HEM,  /* height of the hem's middle above the ground */
    TL_FIT_NECK, /* length of the opening */
    TL_FIT_WAIST,
    TL_FIT_BUST_EASE, /* girth of the cloth at rest minus the body's */
    TL_FIT_WAIST_EASE,
    TL_FIT_HIP_EASE,
    TL_FIT_FIGURES
};

struct tl_trade_fit_row {
    const char *garment, *name;
    double edge_m;
    double figures[TL_FIT_FIGURES]; /* m; NaN: the garment has none */
    double rms_strain;
    struct tl_taken taken; /* to come to rest */
    bool settled;          /* before cloth.settle_s was over */
    size_t particles;
    size_t compared_with; /* index of the row of the reference; its own: it is the reference */
};

struct tl_trade_fit {
    struct tl_trade_fit_row *rows;
    size_t row_count;
};

/* Adds the rows to `out`, which starts as {0}. `quick`: the dress alone, coarse, and a few settings. Errors:
 * those of the drapes, among them TL_INTERRUPTED; rows until then are kept. */
bool tl_trade_fit(bool quick, struct tl_trade_fit *out, tl_error *error);
void tl_trade_fit_release(struct tl_trade_fit *fit);

void tl_trade_fit_write_csv(const struct tl_trade_fit *fit, FILE *out);

#endif
