/* The contract of the extremes, for every axis alike: each cell meets its stated bound or is refused with a
 * clear message. Anything else is a failure of the program. */
#ifndef TOILE_APP_LAB_STABILITY_STABILITY_H
#define TOILE_APP_LAB_STABILITY_STABILITY_H

#include "app/cli/arguments.h"

#include <cjson/cJSON.h>

enum tl_outcome {
    TL_OUTCOME_EXACT,
    TL_OUTCOME_BOUNDED,
    TL_OUTCOME_REFUSED,
    TL_OUTCOME_SILENT, /* out of its bound without a word */
    TL_OUTCOME_NAN,
    TL_OUTCOME_COUNT
};
extern const char *const tl_outcome_names[TL_OUTCOME_COUNT];

struct tl_stability {
    int counts[TL_OUTCOME_COUNT];
    cJSON *rows; /* one object a cell, for --json */
};

/* Counts a cell and begins its row: axis and outcome are in it. */
cJSON *tl_stability_add(struct tl_stability *stability, const char *axis, enum tl_outcome outcome);
int tl_stability_cells(const struct tl_stability *stability);

/* One axis each. They print a table unless the arguments ask for JSON, and add to `out`. */
bool tl_stability_light(const struct tl_arguments *arguments, struct tl_stability *out, tl_error *error);
bool tl_stability_detail(const struct tl_arguments *arguments, struct tl_stability *out, tl_error *error);
bool tl_stability_shading(const struct tl_arguments *arguments, struct tl_stability *out, tl_error *error);
bool tl_stability_cloth(const struct tl_arguments *arguments, struct tl_stability *out, tl_error *error);

#endif
