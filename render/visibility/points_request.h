/* The inputs of visibility at points, and the taps with which a sample reads it: shared by points.c and its
 * parts. */
#ifndef TOILE_RENDER_VISIBILITY_POINTS_REQUEST_H
#define TOILE_RENDER_VISIBILITY_POINTS_REQUEST_H

#include "render/env/sun.h"
#include "render/gbuffer/samples.h"
#include "render/pem/regions.h"
#include "render/surfaces/ground.h"
#include "render/trace/trace.h"
#include "render/visibility/options.h"

#define TL_TAPS 3

/* The taps of a sample: values of `point[i]` times `weight[i]`; weights sum to 1, unused ones are 0. */
struct tl_taps {
    uint32_t point[TL_TAPS];
    float weight[TL_TAPS];
};

/* Values of visibility are 16-bit shares of this. */
#define TL_VISIBILITY_ONE 65535.0f

struct tl_points_request {
    const tl_trace *trace;
    const struct tl_triangle_ranges *ranges;
    const struct tl_samples *samples; /* NULL: only the points of `seen` are wanted; no suns and no repair */
    const uint32_t *seen; /* [seen_count]: without samples: global triangles, and TL_SAMPLE_BACK */
    size_t seen_count;
    const struct tl_regions *regions;
    const struct tl_suns *suns; /* NULL: none stand apart */
    uint64_t
        regions_revision;     /* changes when the regions do: values are carried over to the nearest region */
    uint64_t shapes_revision; /* changes when vertex numbers do: everything is forgotten */
    const struct tl_ground *ground; /* NULL: none */
    float environment_yaw;          /* rad */
    const struct tl_ray_params *params;
    bool moved; /* surfaces, environment or yaw differ from the last frame: values are replaced, not averaged
                 */
    bool only_camera;  /* nothing but the camera moved: what is known of the scene is as true as before, and a
                          frame must be quick */
    bool whole_rounds; /* every frame traces all regions, however long that takes */
};

#endif
