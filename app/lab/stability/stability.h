/* The contract of the extremes, for every axis alike: each cell meets its stated bound or is refused with a
 * clear message. Anything else is a failure of the program. */
#ifndef TOILE_APP_LAB_STABILITY_STABILITY_H
#define TOILE_APP_LAB_STABILITY_STABILITY_H

#include "app/cli/arguments.h"
#include "app/lab/stability/outcome.h"

/* One axis each. They print a table unless the arguments ask for JSON, and add to `out`. */
bool tl_stability_light(const struct tl_arguments *arguments, struct tl_stability *out, tl_error *error);
bool tl_stability_detail(const struct tl_arguments *arguments, struct tl_stability *out, tl_error *error);
bool tl_stability_shading(const struct tl_arguments *arguments, struct tl_stability *out, tl_error *error);
bool tl_stability_cloth(const struct tl_arguments *arguments, struct tl_stability *out, tl_error *error);

#endif
