#include "app/lab/experiments/experiments.h"

#include "app/lab/experiments/rows_internal.h"

#include <string.h>

static const struct tl_experiment_list *const families[] = {
    &tl_shading_experiments, &tl_maps_experiments,  &tl_detail_experiments,   &tl_light_experiments,
    &tl_glossy_experiments,  &tl_cloth_experiments, &tl_material_experiments, &tl_budget_experiments};

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
