/* Further figures of the page of `toile trade --axis light`: the paper's plots over regions and map sizes,
 * the approach to the reference at rest, lobes and memory. */
#ifndef TOILE_APP_LAB_TRADE_TRADE_LIGHT_H
#define TOILE_APP_LAB_TRADE_TRADE_LIGHT_H

#include "app/lab/trade/trade.h"

/* Writes into an open page (app/report/report.h). */
void tl_trade_write_light_figures(const struct tl_trade *trade, FILE *out);

#endif
