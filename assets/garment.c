#include "assets/garment.h"

#include "assets/model.h"

bool tl_garment_load(const char *path, tl_garment *out, tl_error *error)
{
    return tl_garment_load_in(path, TL_UNITS_AUTO, out, error);
}

bool tl_garment_load_in(const char *path, enum tl_units units, tl_garment *out, tl_error *error)
{
    *out = (tl_garment){0};
    if (!tl_model_load_in(path, units, &out->model, error))
        return false;
    tl_garment_take_pins(out);
    return true;
}
