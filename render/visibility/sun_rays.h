/* Shadows of the suns, by rays from every sample: one to a place of the sun, all samples to the same, and
 * more where a sample's neighbours in the image disagree, which is where penumbrae are
 * (docs/notes/visibility.md, 3). At rest every round goes to other places of the sun, and is averaged in.
 * Part of points.c. */
#ifndef TOILE_RENDER_VISIBILITY_SUN_RAYS_H
#define TOILE_RENDER_VISIBILITY_SUN_RAYS_H

#include "render/visibility/points_request.h"
#include "render/visibility/ray_origins.h"

struct tl_sun_rays {
    size_t capacity;             /* samples */
    float *visible[TL_SUNS_MAX]; /* [samples]: the mean over rounds, in [0, 1]; NULL beyond the suns there
                                    were */
    float *seen;                 /* [samples]: in this round */
    int count;                   /* suns of the last update */
    int rounds;                  /* frames in the means */
    uint8_t *marks, *spread;     /* [height][width]: what was seen; ... and in the 5 x 5 texels about it */
    size_t texel_capacity;
    uint32_t *doubtful; /* [samples]: those that disagree with a neighbour */
};

/* `origins` are of the request's samples; `again`: these and all else are as they were, so rounds go on.
 * Returns the number of rays. */
size_t tl_sun_rays_update(struct tl_sun_rays *rays, const struct tl_points_request *request,
                          const struct tl_ray_origins *origins, bool again);

void tl_sun_rays_release(struct tl_sun_rays *rays);
size_t tl_sun_rays_bytes(const struct tl_sun_rays *rays);

#endif
