/* The light that up to sixteen points send back, by rays: directions drawn from the environment, the same for
 * all, and from each of a point's glossy lobes, combined by the balance heuristic [Veach 1997, 9.2.2]. */
#ifndef TOILE_RENDER_REFERENCE_GATHER_H
#define TOILE_RENDER_REFERENCE_GATHER_H

#include "render/reference/random.h"
#include "render/reference/spot.h"

enum { TL_SPOTS = 16 };

/* As struct tl_spot; by axis or channel, then by spot. */
struct tl_spots {
    int count;
    float point[3][TL_SPOTS], horizon[3][TL_SPOTS], normal[3][TL_SPOTS], axis[3][TL_SPOTS];
    float exponent[TL_SPOTS];
    float diffuse[3][TL_SPOTS], glossy[3][TL_SPOTS];
    /* Of those that have any, by spot. */
    bool any_layered, layered[TL_SPOTS];
    struct tl_spot_layers layers[TL_SPOTS];
    vec3s viewer[TL_SPOTS];
};

void tl_spots_add(struct tl_spots *spots, const struct tl_spot *spot);

/* `count` directions from as many strata of the environment's curve. Every stratum is parted again among
 * `slots` calls with the same `shared` numbers, of which this is number `slot`. */
void tl_gather_directions(const struct tl_sky *sky, int count, int slot, int slots, struct tl_random shared,
                          struct tl_random own, struct tl_skylight *out);

struct tl_gathering {
    const struct tl_reference_scene *scene;
    int strata;
    const struct tl_skylight *sky; /* one direction from each stratum */
    int lobe_samples;              /* directions from the lobe */
    bool reflect;                  /* near mirrors see the directly lit scene */
    struct tl_random random;
};

/* Radiance towards the viewer by channel, then by spot. Returns how many rays it took. */
size_t tl_gather(const struct tl_gathering *asked, const struct tl_spots *spots, float light[3][TL_SPOTS]);

#endif
