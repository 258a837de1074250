#include "assets/garment.h"

#include <stdlib.h>

bool tl_garment_load(const char *path, tl_garment *out, tl_error *error)
{
    return tl_garment_load_in(path, TL_UNITS_AUTO, out, error);
}

bool tl_garment_load_in(const char *path, enum tl_units units, tl_garment *out, tl_error *error)
{
    *out = (tl_garment){0};
    return tl_model_load_in(path, units, &out->model, error);
}

void tl_garment_release(tl_garment *garment)
{
    tl_model_release(&garment->model);
    free(garment->pattern);
    free(garment->seams);
    free(garment->pins);
    *garment = (tl_garment){0};
}
