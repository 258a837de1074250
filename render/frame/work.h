/* Estimates the work of each job of the next frame from the last frame's counts, at other settings, for the
 * cost model (render/plan/cost.h).
 *
 * Reads the renderer's state and changes nothing. Counts are doubles: they are estimates. Threads: the
 * renderer's. Errors: none. */
#ifndef TOILE_RENDER_FRAME_WORK_H
#define TOILE_RENDER_FRAME_WORK_H

#include "render/frame/job_io.h"

/* The quantities that the jobs' work depends on, estimated for the next frame. */
struct tl_work_sizes {
    /* Borrowed: the settings of the next frame. */
    const struct tl_render_settings *settings;
    /* Samples of the frame, and those of them that a surface covers. */
    double texels, covered;
    /* Visible points that visibility is stored at. */
    double points;
    /* Groups of TL_LANES regions; 0: light is unshadowed. */
    double groups;
    /* The most lobes through which a sample sums the regions' light; at least 1. */
    double lobes;
    /* Rays a point; 0: visibility is complete. */
    double refreshed;
    double triangles;
    /* Ratios at vertices light the pixels. */
    bool at_vertices;
    /* A material has a normal or a height map. */
    bool is_bumpy;
    /* Lamps that are lit, and suns that are separate from the regions. */
    double lamps, suns;
    /* Regions whose light is not cached from an earlier frame; 0: all are. And texels of the lobes that it is
     * computed for. */
    double new_regions, lobe_texels;
};

/* Counts of a frame, kept because its surfaces may be freed after the draw. */
struct tl_work_counts {
    double triangles, vertices;
    /* Lobes that the materials need, as bits of env/lobes.h. */
    uint32_t exponents;
    /* Lamps that are lit. */
    int lamps;
    /* Ratios at vertices could light the pixels. */
    bool fits_vertices;
    /* Any material is. */
    bool is_glossy, is_faceted, is_bumpy;
};

/* `facts` are the frame's (facts.h). `exponents` are those that an earlier frame needed; 0: they are found
 * out. */
struct tl_work_counts tl_work_count(const tl_frame *frame, const struct tl_render_settings *settings,
                                    tl_bits facts, uint32_t exponents);
/* `resources` and `counts` are those of the last frame; `settings` are those of the next. */
struct tl_work_sizes tl_work_estimate_sizes(const struct tl_resources *resources,
                                            const struct tl_work_counts *counts,
                                            const struct tl_render_settings *settings);

/* Computes the work of every job in the order of the table; 0 for those whose work is always the same. The
 * parts of a job's row in work.c are ms on the machine described there. */
void tl_work_estimate(const struct tl_work_sizes *sizes, struct tl_work out[TL_JOB_COUNT]);

#endif
