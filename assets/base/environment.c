#include "assets/base/environment.h"

#include <stdlib.h>

bool tl_environment_is_black(const tl_environment *environment)
{
    const tl_image *image = &environment->image;
    const float *values = tl_image_floats(image);
    const size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    if (!values || environment->peak > 0)
        return false;
    for (size_t i = 0; i < count; i++)
        if (values[i] > 0)
            return false;
    return true;
}

void tl_environment_release(tl_environment *environment)
{
    free(environment->name);
    tl_image_release(&environment->image);
    tl_image_release(&environment->backdrop);
    *environment = (tl_environment){0};
}
