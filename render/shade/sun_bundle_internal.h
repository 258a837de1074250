/* Rays of pixels towards one place of a sun or towards a lamp, gathered until they are a packet. */
#ifndef TOILE_RENDER_SHADE_SUN_BUNDLE_INTERNAL_H
#define TOILE_RENDER_SHADE_SUN_BUNDLE_INTERNAL_H

#include "render/shade/sun_pixels.h"

#include <math.h>

#define TL_SUN_BUNDLE 16 /* rays */

/* The sun's state at a pixel. From FACED on: how much of it reaches a surface that faces it, in steps of
 * the root, because every open sheet on the way multiplies it. LISTED, a bit: it has been asked for more. */
enum tl_sun_state {
    TL_SUN_UNKNOWN = 0,
    TL_SUN_AWAY = 1,
    TL_SUN_EMPTY = 2,
    TL_SUN_FACED = 64,
    TL_SUN_LISTED = 128
};
#define TL_SUN_STEPS 63

static inline bool tl_sun_is_faced(uint8_t state)
{
    return state >= TL_SUN_FACED && state < TL_SUN_LISTED;
}

/* `share` in 0 .. 1. */
static inline uint8_t tl_sun_state_of(float share)
{
    return (uint8_t)(TL_SUN_FACED + (int)(sqrtf(share) * TL_SUN_STEPS + 0.5f));
}

/* The share of a state that is, or was before it was listed, that of a pixel facing the sun; else 0. */
static inline float tl_sun_share_of(uint8_t state)
{
    const float root = (float)(state & (TL_SUN_FACED - 1)) / TL_SUN_STEPS; /* 1 of all of it */
    return state & TL_SUN_FACED ? root * root : 0;
}

struct tl_sun_bundle {
    const struct tl_sun_pixels_request *request;
    const struct tl_pixel_light *light;
    float offset_m;
    struct tl_ray_packet rays;
    uint32_t pixels[TL_SUN_BUNDLE];
    float ground[TL_SUN_BUNDLE]; /* what the ground leaves */
    size_t count;                /* rays traced so far */
};

/* The light must outlive the bundle. */
struct tl_sun_bundle tl_sun_bundle_begin(const struct tl_sun_pixels_request *request,
                                         const struct tl_pixel_light *light);

/* The origin of a covered pixel's rays, as tl_sample_start has it. False where the surface faces away. */
bool tl_sun_start(const struct tl_sun_bundle *bundle, uint32_t pixel, vec3s *start);

void tl_sun_bundle_add(struct tl_sun_bundle *bundle, uint32_t pixel, vec3s start);

/* Traces what was gathered: seen[i] of pixels[i]. Returns how many there were. */
int tl_sun_bundle_trace(struct tl_sun_bundle *bundle, float seen[TL_SUN_BUNDLE]);

#endif
