/* The table itself: the experiments of all families. Pure. */
#ifndef TOILE_APP_LAB_EXPERIMENTS_EXPERIMENTS_H
#define TOILE_APP_LAB_EXPERIMENTS_EXPERIMENTS_H

#include "app/lab/experiments/experiment.h"

/* The experiments that one writer takes, in order; NULL past the last one. */
const struct tl_experiment *tl_experiment_at(enum tl_output output, size_t index);
/* NULL: none has this name. */
const struct tl_experiment *tl_experiment_find(enum tl_output output, const char *name);

#endif
