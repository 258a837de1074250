/* The job "inspect": the samples' colours of a view in place of their light. Inside of a renderer. */
#ifndef TOILE_RENDER_INSPECT_JOB_H
#define TOILE_RENDER_INSPECT_JOB_H

#include "render/frame/frame.h"

/* Facts of a frame whose view is not light, but for those of its materials. */
tl_bits tl_inspect_facts(int view);
/* Whether rounds at rest change what is shown. */
bool tl_inspect_averages(int view);
/* Takes a tl_renderer. */
bool tl_inspect_run(void *context, int level, tl_error *error);

#endif
