/* What `toile info` prints of a model as a garment: its rest shape and its openings. Threads: pure. */
#ifndef TOILE_APP_BATCH_INFO_GARMENT_H
#define TOILE_APP_BATCH_INFO_GARMENT_H

#include "assets/base/model.h"
#include "assets/pattern/pattern.h"

#include <cJSON.h>

/* Adds members to the object. Sews the model if it has stitches: it may get more vertices. */
void tl_info_describe_garment(cJSON *object, tl_model *model);

/* Adds the openings of a sewing pattern: the edges that no stitch joins, as long as they are cut. */
void tl_info_describe_sewn(cJSON *object, const tl_pattern *pattern);

#endif
