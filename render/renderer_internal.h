/* The state of a renderer: the resources of the last frame, and the cost models and input hashes that plan
 * the next one. */
#ifndef TOILE_RENDER_RENDERER_INTERNAL_H
#define TOILE_RENDER_RENDERER_INTERNAL_H

#include "render/frame/settings.h"
#include "render/frame/work.h"
#include "render/gpu/timer.h"

struct tl_renderer {
    struct tl_resources resources;

    /* The arguments of the last draw and what follows from them. Pointers in `frame` are borrowed. */
    tl_frame frame;
    struct tl_render_settings settings;
    struct tl_work_counts counts;
    struct tl_rest rest;
    uint64_t hashes[TL_INPUT_COUNT]; /* of its inputs */
    tl_bits moving;                  /* inputs that changed before the last frame */

    tl_plan plan;
    struct tl_cost_job costs[TL_JOBS_MAX];
    struct tl_machine_load load;
    double slowness; /* tl_cost_slowness of the last frame; 0 before the first */
    uint64_t shaders_stamp;
    tl_timer *timer; /* NULL: GL runs on the CPU */
    bool card_fails; /* the graphics card could not draw a frame: the CPU draws from then on */
};

#endif
