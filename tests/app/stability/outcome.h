/* Outcomes of the extreme cases. Every case has its error measured, as a share of what is right and in a unit
 * of its own. It is bounded where the error is at most TL_STATED_SHARE and the bound of its row; coarse where
 * its row states a wider bound, which only a row that names a remedy may do; or refused with a clear message.
 * Any other outcome is a failure of the program. */
#ifndef TOILE_TESTS_APP_STABILITY_OUTCOME_H
#define TOILE_TESTS_APP_STABILITY_OUTCOME_H

#include <cjson/cJSON.h>
#include <stdbool.h>

enum tl_outcome {
    TL_OUTCOME_EXACT,
    TL_OUTCOME_BOUNDED,
    TL_OUTCOME_COARSE,
    TL_OUTCOME_REFUSED,
    TL_OUTCOME_SILENT, /* out of its bound, and not refused */
    TL_OUTCOME_NAN,
    TL_OUTCOME_COUNT
};
extern const char *const tl_outcome_names[TL_OUTCOME_COUNT];

/* No case with a larger error is called bounded. */
#define TL_STATED_SHARE 0.25

/* The error of a case: a share of what is right, 0.25 for 25 %, and the same in `unit`. NaN where there is
 * none, as of a refusal. */
struct tl_cell_error {
    double share, own;
    const char *unit; /* "mm", "stops"; static */
};
#define TL_CELL_NO_ERROR ((struct tl_cell_error){.share = NAN, .own = NAN, .unit = ""})

/* The outcome of an error: exact up to `exact`, else by `bound`, which is above TL_STATED_SHARE only for a
 * case that may be coarse. */
enum tl_outcome tl_outcome_of(double share, double exact, double bound);

struct tl_stability {
    int counts[TL_OUTCOME_COUNT];
    cJSON *rows; /* an object a cell: its axis, outcome, error_percent, error and unit, then members of its
                    own */
};

/* Counts a cell and adds its row, which has the axis, the outcome and the error. A cell that is called exact
 * or bounded with an error above TL_STATED_SHARE counts as SILENT. The row is owned by `stability`. */
cJSON *tl_stability_add(struct tl_stability *stability, const char *axis, enum tl_outcome outcome,
                        const struct tl_cell_error *error);
/* Number of all cells counted so far. */
int tl_stability_cells(const struct tl_stability *stability);

#endif
