#include "app/lab/check/baseline.h"

#include "config/base/file.h"
#include "config/base/hash.h"

#include <cjson/cJSON.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LIMIT_BYTES ((size_t)1 << 20)

uint64_t tl_baseline_scene(const struct tl_settings *settings, const struct tl_check_params *params)
{
    const struct tl_option_filter all = {.any_of = UINT64_MAX};
    const double parts[] = {params->frames, params->every, params->furnace, params->still, params->budget_ms};
    return tl_hash(tl_settings_hash(settings, all), parts, sizeof parts);
}

static double number_of(const cJSON *object, const char *key)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    return cJSON_IsNumber(item) ? item->valuedouble : (double)NAN;
}

static const char *string_of(const cJSON *object, const char *key)
{
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, key));
    return text ? text : "";
}

static void read_rows(const cJSON *rows, struct tl_check_baseline *out)
{
    const cJSON *row;
    for (size_t i = 0; i < TL_INVARIANTS_MAX; i++)
        out->worst[i] = NAN;
    cJSON_ArrayForEach(row, rows) for (size_t i = 0; i < tl_invariant_count; i++)
    {
        if (strcmp(tl_invariants[i].name, string_of(row, "name")) == 0)
            out->worst[i] = number_of(row, "worst");
    }
}

bool tl_baseline_load(const char *file, uint64_t scene, struct tl_check_baseline *out, tl_error *error)
{
    char *data = NULL, wanted[17];
    size_t size = 0;
    if (!tl_file_read_small(file, LIMIT_BYTES, &data, &size, error))
        return false;
    snprintf(wanted, sizeof wanted, "%016" PRIx64, scene);
    cJSON *result = cJSON_ParseWithLength(data, size);
    free(data);
    const cJSON *rows = cJSON_GetObjectItemCaseSensitive(result, "invariants");
    bool good = true;
    if (!cJSON_IsArray(rows))
        good = tl_fail(error, TL_INPUT,
                       "%s: is no result of a check: write one with `toile check --json > FILE`", file);
    else if (strcmp(string_of(result, "scene"), wanted) != 0)
        good = tl_fail(error, TL_INPUT,
                       "%s: was recorded with another scene or other options: record it again with the same "
                       "command and --json",
                       file);
    else if (number_of(result, "failed") > 0)
        good = tl_fail(error, TL_INPUT, "%s: this run broke invariants: a baseline must be clean", file);
    if (good) {
        read_rows(rows, out);
        out->elastic_j = number_of(result, "elastic_j");
    }
    cJSON_Delete(result);
    return good;
}
