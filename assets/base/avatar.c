#include "assets/base/avatar.h"

void tl_avatar_release(tl_avatar *avatar)
{
    tl_model_release(&avatar->model);
}
