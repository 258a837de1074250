/* What `toile info` prints of a model as a garment: its rest shape and its openings. Threads: pure. */
#ifndef TOILE_APP_BATCH_INFO_GARMENT_H
#define TOILE_APP_BATCH_INFO_GARMENT_H

#include "assets/base/model.h"

#include <cJSON.h>

/* Adds members to the object. */
void tl_info_describe_garment(cJSON *object, const tl_model *model);

#endif
