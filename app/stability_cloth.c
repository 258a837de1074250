#include "app/stability.h"

bool tl_stability_cloth(const struct tl_arguments *arguments, struct tl_stability *out, tl_error *error)
{
    (void)arguments;
    (void)out;
    (void)error;
    return true;
}
