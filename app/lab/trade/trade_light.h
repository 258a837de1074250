/* Figures of the page of `toile trade --axis light` that need no measuring of frames: the paper's figures 4
 * and 5 (lobes) and 8 (memory) with those of this program, as sections {title, text, items} of figures
 * (app/report/report.h). Pure. */
#ifndef TOILE_APP_LAB_TRADE_TRADE_LIGHT_H
#define TOILE_APP_LAB_TRADE_TRADE_LIGHT_H

#include "assets/environment/environment.h"

#include <cjson/cJSON.h>

#include <stdbool.h>

/* `quick`: fewer directions and exponents. */
void tl_trade_add_lobes(bool quick, cJSON *figures);
/* `environment` is what the regions of the table are cut from. */
void tl_trade_add_memory(const tl_environment *environment, cJSON *figures);

#endif
