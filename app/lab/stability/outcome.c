#include "app/lab/stability/outcome.h"

const char *const tl_outcome_names[TL_OUTCOME_COUNT] = {"exact", "bounded", "refused", "SILENT", "NaN"};

cJSON *tl_stability_add(struct tl_stability *stability, const char *axis, enum tl_outcome outcome)
{
    cJSON *row = cJSON_CreateObject();
    stability->counts[outcome]++;
    cJSON_AddStringToObject(row, "axis", axis);
    cJSON_AddStringToObject(row, "outcome", tl_outcome_names[outcome]);
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
