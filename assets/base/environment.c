#include "assets/base/environment.h"

#include <stdlib.h>

void tl_environment_release(tl_environment *environment)
{
    free(environment->name);
    tl_image_release(&environment->image);
    tl_image_release(&environment->backdrop);
    *environment = (tl_environment){0};
}
