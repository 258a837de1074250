#include "tests/app/stability/outcome.h"

#include "app/cli/json.h"

#include <math.h>

const char *const tl_outcome_names[TL_OUTCOME_COUNT] = {"exact",   "bounded", "coarse",
                                                        "refused", "SILENT",  "NaN"};

enum tl_outcome tl_outcome_of(double share, double exact, double bound)
{
    if (isnan(share))
        return TL_OUTCOME_NAN;
    if (!(share <= bound))
        return TL_OUTCOME_SILENT;
    return share <= exact             ? TL_OUTCOME_EXACT
           : share <= TL_STATED_SHARE ? TL_OUTCOME_BOUNDED
                                      : TL_OUTCOME_COARSE;
}

cJSON *tl_stability_add(struct tl_stability *stability, const char *axis, enum tl_outcome outcome,
                        const struct tl_cell_error *error)
{
    cJSON *row = cJSON_CreateObject();
    if (outcome <= TL_OUTCOME_BOUNDED && !(error->share <= TL_STATED_SHARE))
        outcome = TL_OUTCOME_SILENT;
    stability->counts[outcome]++;
    cJSON_AddStringToObject(row, "axis", axis);
    cJSON_AddStringToObject(row, "outcome", tl_outcome_names[outcome]);
    tl_json_add_number(row, "error_percent", 100 * error->share);
    tl_json_add_number(row, "error", error->own);
    cJSON_AddStringToObject(row, "unit", error->unit);
    cJSON_AddItemToArray(stability->rows, row);
    return row;
}

int tl_stability_cells(const struct tl_stability *stability)
{
    int cells = 0;
    for (int i = 0; i < TL_OUTCOME_COUNT; i++)
        cells += stability->counts[i];
    return cells;
}
