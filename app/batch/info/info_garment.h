/* Prints a garment for `toile info`: its rest shape, its openings, its pattern. Threads: pure. */
#ifndef TOILE_APP_BATCH_INFO_INFO_GARMENT_H
#define TOILE_APP_BATCH_INFO_INFO_GARMENT_H

#include "app/audit/audit.h"
#include "assets/base/model.h"
#include "assets/pattern/pattern.h"

#include <cJSON.h>

/* Adds members to the object, and findings to the audit. Sews the model if it has stitches: it may get more
 * vertices. */
void tl_info_describe_garment(cJSON *object, tl_model *model, tl_audit *audit);

/* A new object about a sewing pattern: its panels, stitches, seams that gather or ease, and the openings as
 * they are cut. */
cJSON *tl_info_describe_pattern(const tl_pattern *pattern, tl_audit *audit);

#endif
