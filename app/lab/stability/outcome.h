/* Outcomes of the extreme cases. Every case meets its stated bound or is refused with a clear message; any
 * other outcome is a failure of the program. */
#ifndef TOILE_APP_LAB_STABILITY_OUTCOME_H
#define TOILE_APP_LAB_STABILITY_OUTCOME_H

#include <cjson/cJSON.h>

enum tl_outcome {
    TL_OUTCOME_EXACT,
    TL_OUTCOME_BOUNDED,
    TL_OUTCOME_REFUSED,
    TL_OUTCOME_SILENT, /* out of its bound, and not refused */
    TL_OUTCOME_NAN,
    TL_OUTCOME_COUNT
};
extern const char *const tl_outcome_names[TL_OUTCOME_COUNT];

struct tl_stability {
    int counts[TL_OUTCOME_COUNT];
    cJSON *rows; /* one object a cell, for --json */
};

/* Counts a cell and adds its row, which has the axis and the outcome. The row is owned by `stability`. */
cJSON *tl_stability_add(struct tl_stability *stability, const char *axis, enum tl_outcome outcome);
/* Number of all cells counted so far. */
int tl_stability_cells(const struct tl_stability *stability);

#endif
