#include "app/lab/experiments/experiment.h"

#include "config/base/memory.h"

#include <string.h>

static bool has_id(const struct tl_experiment *experiment, const char *id)
{
    for (size_t i = 0; i < TL_COUNT(experiment->ids) && experiment->ids[i]; i++)
        if (id && strcmp(experiment->ids[i], id) == 0)
            return true;
    return !experiment->ids[0];
}

const struct tl_technique *tl_experiment_next(const struct tl_experiment *experiment, enum tl_output output,
                                              const struct tl_technique *after)
{
    const struct tl_technique *end = experiment->techniques + experiment->technique_count;
    for (const struct tl_technique *t = after ? after + 1 : experiment->techniques; t < end; t++)
        if (t->names[output] && has_id(experiment, t->id))
            return t;
    return NULL;
}

size_t tl_experiment_count(const struct tl_experiment *experiment, enum tl_output output)
{
    size_t count = 0;
    for (const struct tl_technique *t = NULL; (t = tl_experiment_next(experiment, output, t));)
        count++;
    return count;
}

const char *const *tl_experiment_choices(const struct tl_option_table *table, const char *option)
{
    size_t i = 0;
    while (strcmp(table->rows[i].name, option) != 0)
        i++;
    return table->rows[i].choices;
}
