#include "app/lab/experiments/experiment.h"

#include "config/memory.h"

#include <string.h>

static const struct tl_experiment_list *const families[] = {&tl_shading_experiments,  &tl_maps_experiments,
                                                            &tl_detail_experiments,   &tl_light_experiments,
                                                            &tl_material_experiments, &tl_budget_experiments};

const struct tl_experiment *tl_experiment_at(enum tl_output output, size_t index)
{
    for (size_t f = 0; f < TL_COUNT(families); f++)
        for (size_t i = 0; i < families[f]->count; i++)
            if (families[f]->items[i].output == output && index-- == 0)
                return &families[f]->items[i];
    return NULL;
}

const struct tl_experiment *tl_experiment_find(enum tl_output output, const char *name)
{
    const struct tl_experiment *experiment;
    for (size_t i = 0; (experiment = tl_experiment_at(output, i)); i++)
        if (strcmp(experiment->name, name) == 0)
            return experiment;
    return NULL;
}

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
