/* The regions of the environment that a point sees, from visibility kept at points
 * (render/visibility/points.h). Pure. */
#ifndef TOILE_RENDER_INSPECT_SEEN_H
#define TOILE_RENDER_INSPECT_SEEN_H

#include "config/base/simd.h"
#include "render/pem/regions.h"
#include "render/visibility/points.h"

#define TL_SEEN_GROUPS_MAX ((TL_REGIONS_MAX + TL_LANES - 1) / TL_LANES)

/* Regions side by side, sixteen a group; lanes beyond the last have no weight. World. */
struct tl_seen_regions {
    int group_count;
    struct tl_seen_group {
        float x[TL_LANES], y[TL_LANES], z[TL_LANES];
        float weight[TL_LANES]; /* luminance of the region's power */
    } groups[TL_SEEN_GROUPS_MAX];
};
/* Fills `out` for an environment that is turned by `yaw` (rad). */
void tl_seen_regions_make(const struct tl_regions *regions, float yaw, struct tl_seen_regions *out);

struct tl_seen {
    float visibility; /* [0, 1]: mean over the regions, each weighted by what it would give a matt surface */
    int strongest;    /* region that gives the most; -1: none gives any */
    float share;      /* [0, 1]: of the light of all regions */
};

/* `values` and `stride` as tl_points_values gives them; `normal` unit, world. Where no region
 * is above the horizon the visibility is 0. */
struct tl_seen tl_seen_at(const struct tl_seen_regions *regions, const uint16_t *values, size_t stride,
                          const struct tl_taps *taps, vec3s normal);

/* Visibility of one region, [0, 1]. */
float tl_seen_region(const uint16_t *values, size_t stride, const struct tl_taps *taps, int region);

#endif
