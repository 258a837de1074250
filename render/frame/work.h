/* Estimates the work of each job of the next frame from the last frame's counts, at other settings. Reads the
 * renderer's state and changes nothing. */
#ifndef TOILE_RENDER_FRAME_WORK_H
#define TOILE_RENDER_FRAME_WORK_H

#include "render/frame/resources.h"

/* The quantities that the jobs' work depends on, estimated for the next frame. */
struct tl_work_sizes {
    const struct tl_render_settings *settings;
    double texels, covered; /* samples of the frame; those covered by a surface */
    double points;          /* visible points that visibility is stored at */
    double groups;          /* of TL_LANES regions; 0 where light is unshadowed */
    double lobes;           /* max a sample sums the regions' light through */
    double refreshed;       /* rays a point */
    double triangles;
    bool at_vertices;   /* ratios at vertices light the pixels */
    bool is_bumpy;      /* a material has a normal or a height map */
    double lamps, suns; /* lamps that are lit; suns that are separate from the regions */
    double new_regions; /* regions whose light is not cached from an earlier frame */
};
/* Counts of a frame, kept because its surfaces may be freed after the draw. */
struct tl_work_counts {
    double triangles;
    int lamps;
    bool fits_vertices;                   /* ratios at vertices can light the pixels */
    bool is_glossy, is_faceted, is_bumpy; /* any material */
};
/* `facts` are the frame's (facts.h). */
struct tl_work_counts tl_work_count(const tl_frame *frame, tl_bits facts);
/* `resources` and `counts` are those of the last frame; `settings` are those of the next. */
struct tl_work_sizes tl_work_estimate_sizes(const struct tl_resources *resources,
                                            const struct tl_work_counts *counts,
                                            const struct tl_render_settings *settings);

/* The work of the jobs of the same names; `context` is a struct tl_work_sizes. */
struct tl_work tl_lights_work(const void *context);
struct tl_work tl_gbuffer_work(const void *context);
struct tl_work tl_samples_work(const void *context);
struct tl_work tl_ids_work(const void *context);
struct tl_work tl_ratios_work(const void *context);
struct tl_work tl_sun_pixels_work(const void *context);
struct tl_work tl_shade_work(const void *context);
struct tl_work tl_trace_work(const void *context);
struct tl_work tl_points_work(const void *context);
struct tl_work tl_bounce_work(const void *context);
struct tl_work tl_compose_work(const void *context);
struct tl_work tl_inspect_work(const void *context);
struct tl_work tl_passes_work(const void *context); /* light */
struct tl_work tl_maps_work(const void *context);   /* and blur */
struct tl_work tl_resolve_work(const void *context);
struct tl_work tl_lamps_work(const void *context);
struct tl_work tl_lamp_maps_work(const void *context);
struct tl_work tl_sample_rays_work(const void *context); /* transparency, mirrors, lamp_rays */

#endif
