/* The table of jobs that make a frame. */
#ifndef TOILE_RENDER_FRAME_JOBS_H
#define TOILE_RENDER_FRAME_JOBS_H

#include "render/plan/plan.h"

/* The jobs, in execution order; each run function takes the struct tl_resources. */
extern const tl_job tl_frame_jobs[];
extern const int tl_frame_job_count;

#endif
