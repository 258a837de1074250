/* A cache of one environment cube's slow results: its exact lobes, by exponent, and the lights of a few cuts
 * into regions, so that changing the number of regions back and forth is quick. What it returns is bit for
 * bit what would be computed. Pure. */
#ifndef TOILE_RENDER_FRAME_LIGHT_CACHE_H
#define TOILE_RENDER_FRAME_LIGHT_CACHE_H

#include "render/light/options.h"
#include "render/light/region_lights.h"

#define TL_LIGHTS_KEPT 4

struct tl_kept_lights {
    uint64_t revision; /* of the cube that they add up to; 0: empty */
    int regions, cut;  /* as light.regions and light.cut */
    enum tl_region_weight weight;
    uint64_t used; /* when, counted by tl_light_cache.uses */
    struct tl_regions cut_regions;
    struct tl_region_lights lights;
};

struct tl_light_cache {
    uint64_t revision; /* rises with every new cube */
    struct tl_lobes lobes;
    uint32_t exponents;        /* of the lobes: that the last frame needed */
    uint32_t exponents_before; /* ... that were needed before these: kept for appearances that alternate */
    struct tl_kept_lights kept[TL_LIGHTS_KEPT];
    uint64_t uses;
    const struct tl_region_lights *current; /* those that light the image: never replaced */
};

/* Begins with another cube: discards all lobes, and kept lights are no longer found. */
void tl_light_cache_begin(struct tl_light_cache *cache);
void tl_light_cache_release(struct tl_light_cache *cache);

/* Makes the lobes of the exponents `needed` (bits of env/lobes.h) that are not there. Those that neither this
 * frame nor the last different one needs are released: all of them, with all that is made of them, would take
 * more than 100 MB. */
void tl_light_cache_need(struct tl_light_cache *cache, const tl_cube *cube, uint32_t needed);

/* The regions of a cut, whatever their lights' weight; NULL: not kept. */
const struct tl_regions *tl_light_cache_regions(const struct tl_light_cache *cache, int regions, int cut);

/* The lights of these options: kept ones or new ones of `regions`, complete for the exponents needed last.
 * Valid until the cache replaces them, which it does not as long as they are `current`. */
const struct tl_region_lights *tl_light_cache_lights(struct tl_light_cache *cache, int region_count, int cut,
                                                     enum tl_region_weight weight,
                                                     const struct tl_regions *regions);
/* Returns whether these lights are in the cache, complete. */
bool tl_light_cache_has(const struct tl_light_cache *cache, const struct tl_light_params *light);
/* Computes the lights of these options from this cube and keeps them. */
void tl_light_cache_prepare(struct tl_light_cache *cache, const tl_cube *cube,
                            const struct tl_light_params *light);
/* Adds regions and lights of the present cube that were made elsewhere, as far as the cache lacks them. */
void tl_light_cache_keep(struct tl_light_cache *cache, const struct tl_light_params *light,
                         struct tl_regions *regions, struct tl_region_lights *lights);

/* The cut that the options ask for, but of an environment without light the fewest regions; and what a
 * region's light is to the method. */
void tl_light_cut_regions(const tl_cube *cube, int regions, int cut, struct tl_regions *out);
enum tl_region_weight tl_light_region_weight(const struct tl_light_params *light);

#endif
