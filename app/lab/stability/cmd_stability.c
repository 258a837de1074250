/* toile stability: the extremes, cell by cell. Each is exact, bounded, coarse or refused; anything else is
 * a failure. */
#include "app/cli/json.h"
#include "app/cli/topic.h"
#include "app/lab/stability/commands.h"
#include "app/lab/stability/stability.h"

#include <stdio.h>

static void print_json(struct tl_stability *stability)
{
    static const char *const keys[TL_OUTCOME_COUNT] = {"exact",   "bounded", "coarse",
                                                       "refused", "silent",  "nan"};
    cJSON *object = cJSON_CreateObject();
    cJSON_AddNumberToObject(object, "cells", tl_stability_cells(stability));
    for (int i = 0; i < TL_OUTCOME_COUNT; i++)
        cJSON_AddNumberToObject(object, keys[i], stability->counts[i]);
    cJSON_AddItemToObject(object, "rows", stability->rows);
    stability->rows = NULL;
    tl_json_print(object);
}

static void print_counts(const struct tl_stability *stability)
{
    const int *counts = stability->counts;
    printf("\n%d cells: %d exact, %d bounded by %.0f %%, %d coarse, %d refused, %d silent, %d with NaN\n",
           tl_stability_cells(stability), counts[TL_OUTCOME_EXACT], counts[TL_OUTCOME_BOUNDED],
           100 * TL_STATED_SHARE, counts[TL_OUTCOME_COARSE], counts[TL_OUTCOME_REFUSED],
           counts[TL_OUTCOME_SILENT], counts[TL_OUTCOME_NAN]);
}

bool tl_command_stability(const struct tl_arguments *arguments, tl_error *error)
{
    enum { LIGHT, CLOTH, DETAIL, SHADING };
    static const char *const topics[] = {
        [LIGHT] = "light", [CLOTH] = "cloth", [DETAIL] = "detail", [SHADING] = "shading", NULL};
    struct tl_arguments scene;
    int topic;
    if (!tl_topic_take("stability", arguments, topics, true, &scene, &topic, error))
        return false;
    struct tl_stability stability = {.rows = cJSON_CreateArray()};
    bool all = topic < 0;
    bool done = (!(all || topic == CLOTH) || tl_stability_cloth(&scene, &stability, error)) &&
                (!(all || topic == LIGHT) || tl_stability_light(&scene, &stability, error)) &&
                (!(all || topic == DETAIL) || tl_stability_detail(&scene, &stability, error)) &&
                (!(all || topic == SHADING) || tl_stability_shading(&scene, &stability, error));
    if (done && arguments->json)
        print_json(&stability);
    else if (done)
        print_counts(&stability);
    cJSON_Delete(stability.rows);
    int silent = stability.counts[TL_OUTCOME_SILENT], nan = stability.counts[TL_OUTCOME_NAN];
    if (done && silent + nan > 0)
        done = tl_fail(error, TL_UNSTABLE, "stability: %d cells silently out of their bounds, %d with NaN",
                       silent, nan);
    return done;
}
