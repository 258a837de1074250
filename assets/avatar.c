#include "assets/avatar.h"

bool tl_avatar_load(const char *path, tl_avatar *out, tl_error *error)
{
    return tl_model_load(path, &out->model, error);
}

void tl_avatar_release(tl_avatar *avatar)
{
    tl_model_release(&avatar->model);
}
