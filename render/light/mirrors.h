/* Near mirrors: samples whose lobe is so narrow that one visibility a region is too coarse for it get rays
 * along the lobe. What such a ray hits is lit like any other sample, instead of black [as in Knuth et al.
 * 2014, 6]: it becomes a sample itself, behind the camera's own.
 *
 *     F ks [ E(r, s) sum v_m E(w_m, M s) / sum E(w_m, M s)  +  1/M sum (1 - v_m) L(hit_m) ]
 *
 * with M directions w_m spread over the lobe. What is hit shows its plain material: no weave, no normal map,
 * maps at their nearest texel; behind open cloth it shows the environment. A mirror in a mirror shows the
 * environment only. World space, metres. Results do not depend on the number of threads. */
#ifndef TOILE_RENDER_LIGHT_MIRRORS_H
#define TOILE_RENDER_LIGHT_MIRRORS_H

#include "render/gbuffer/samples.h"
#include "render/trace/trace.h"

#define TL_MIRROR_RAYS_MAX 8
/* Lobes from this exponent on are narrower than the texels of most environments: their ray reads the
 * environment, suns and all. */
#define TL_PERFECT_EXPONENT 1e5f

/* Values of `hits` for rays without a sample. */
enum { TL_MIRROR_OPEN = 0xffffffff, TL_MIRROR_BLACK = 0xfffffffe };

struct tl_mirror {
    int ray_count; /* M; 0: no mirror */
    vec3s directions[TL_MIRROR_RAYS_MAX];
    uint32_t hits[TL_MIRROR_RAYS_MAX]; /* index into the samples; TL_MIRROR_OPEN: the environment */
};

struct tl_mirrors {
    size_t capacity;
    struct tl_mirror *items; /* one a sample, those that mirrors show included */
};

/* The number of rays M of a lobe: they represent it once M s is beyond the resolution of the exact lobes. */
int tl_mirror_ray_count(float exponent);

/* Direction m of `count` that stand for a lobe: even shares of its volume. `axis` unit. */
vec3s tl_mirror_direction(vec3s axis, float exponent, int m, int count);

/* Traces, and appends what is hit to `samples`. `ground` NULL: none. */
void tl_mirrors_trace(struct tl_mirrors *mirrors, const tl_trace *trace,
                      const struct tl_triangle_ranges *ranges, const struct tl_ground *ground,
                      struct tl_samples *samples);
void tl_mirrors_release(struct tl_mirrors *mirrors);

#endif
