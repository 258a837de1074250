/* The axes of `toile stability`. Each runs its extreme cases and judges them by the contract in outcome.h. */
#ifndef TOILE_TESTS_APP_STABILITY_STABILITY_H
#define TOILE_TESTS_APP_STABILITY_STABILITY_H

#include "app/cli/arguments.h"
#include "tests/app/stability/outcome.h"

/* One axis each. They add their cells to `out`. */
bool tl_stability_light(const struct tl_arguments *arguments, struct tl_stability *out, tl_error *error);
bool tl_stability_detail(const struct tl_arguments *arguments, struct tl_stability *out, tl_error *error);
bool tl_stability_shading(const struct tl_arguments *arguments, struct tl_stability *out, tl_error *error);
bool tl_stability_cloth(const struct tl_arguments *arguments, struct tl_stability *out, tl_error *error);

#endif
