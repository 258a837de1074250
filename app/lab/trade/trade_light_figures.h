/* Figures of the report that need no measuring of frames: the paper's figures 4 and 5 (lobes) and 8 (memory)
 * with those of this program. */
#ifndef TOILE_APP_LAB_TRADE_TRADE_LIGHT_FIGURES_H
#define TOILE_APP_LAB_TRADE_TRADE_LIGHT_FIGURES_H

#include "assets/environment.h"

#include <stdbool.h>
#include <stdio.h>

/* `quick`: fewer directions and exponents. `environment` is what the regions of the memory table are cut
 * from. */
void tl_trade_write_lobes(bool quick, FILE *out);
void tl_trade_write_memory(const tl_environment *environment, FILE *out);

#endif
