#include "assets/base/garment.h"

#include "config/base/memory.h"

#include <stdlib.h>

const char *const tl_rest_names[] = {"auto", "uv", "mesh", NULL};

void tl_garment_take_pins(tl_garment *garment)
{
    const tl_model *model = &garment->model;
    if (!model->pins)
        return;
    free(garment->pins);
    garment->pin_count = 0;
    garment->pins = TL_NEW_ARRAY(uint32_t, model->mesh.vertex_count);
    for (uint32_t i = 0; i < model->mesh.vertex_count; i++)
        if (model->pins[i] > 0.5f)
            garment->pins[garment->pin_count++] = i;
}

void tl_garment_release(tl_garment *garment)
{
    tl_model_release(&garment->model);
    free(garment->pattern);
    free(garment->modelled);
    free(garment->seams);
    free(garment->pins);
    free(garment->holds);
    *garment = (tl_garment){0};
}
