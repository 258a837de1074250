#include "assets/avatar.h"

#include "assets/model.h"

bool tl_avatar_load(const char *path, tl_avatar *out, tl_error *error)
{
    return tl_avatar_load_in(path, TL_UNITS_AUTO, out, error);
}

bool tl_avatar_load_in(const char *path, enum tl_units units, tl_avatar *out, tl_error *error)
{
    return tl_model_load_in(path, units, &out->model, error);
}
