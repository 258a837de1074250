/* The regions as lights whose lobes are known in closed form, so that every sample can sum over all of them.
 *
 * Region i stands for P_i(d, s) by its power times a cosine lobe about its direction, broadened by its
 * spread. The sum of all regions is then not quite E(d, s), the exact light; `gain` is what it must be
 * multiplied by, by direction and channel, so that light is exact where everything is seen:
 *
 *     c = E sum v_i w_i / sum w_i = gain sum v_i w_i (docs/notes/visibility.md, 2)
 *
 * Environment's frame. Pure; results do not depend on the number of threads. */
#ifndef TOILE_RENDER_LIGHT_REGION_LIGHTS_H
#define TOILE_RENDER_LIGHT_REGION_LIGHTS_H

#include "config/base/simd.h"
#include "render/env/lobes.h"
#include "render/light/terms.h"
#include "render/pem/regions.h"

#define TL_REGION_GROUPS_MAX (TL_REGIONS_MAX / TL_LANES)

/* A region's lobe is sharper than this only in maps that no shadow is read from: near mirrors have rays. */
#define TL_REGION_LOBE_MAX 1000.0f

enum tl_region_weight {
    TL_WEIGHT_POWER, /* what the region is: its power, spread over it */
    TL_WEIGHT_POINT, /* its power from its direction only */
    TL_WEIGHT_WHITE  /* its solid angle: light that is the same everywhere */
};

/* Sixteen regions that lie side by side, one a lane. */
struct tl_region_group {
    float x[TL_LANES], y[TL_LANES], z[TL_LANES]; /* direction */
    float sine[TL_LANES];                        /* of the half-angle over which the light is spread */
    float inverse_sine[TL_LANES];
    float spread[TL_LANES]; /* rad, root mean square */
    float power[3][TL_LANES];
    /* A cone that contains the directions of all of its light. */
    vec3s axis;
    float reach_sine, reach_cosine; /* of its half-angle; 2 and -2: it is half the sphere or more */
};

struct tl_region_lights {
    int group_count;
    struct tl_region_group groups[TL_REGION_GROUPS_MAX];
    float spread_max; /* of any region */
    bool is_exact;    /* there are gains: the weight is POWER */
    /* Corrections for the exponents that were asked for. K_1 about a normal is a cosine and needs no power,
     * so it has a table of its own. */
    struct tl_lobes gain, diffuse_gain;
};

/* Replaces what `lights` held, in two steps. The first is quick and makes no gains; the second makes those of
 * `exponents`, bits as in `lobes`, that are not there yet. `lobes` are E, of the exponents that will be asked
 * for. Most of what lights take is the gains of the sharpest lobes. */
void tl_region_lights_begin(struct tl_region_lights *lights, const struct tl_regions *regions,
                            enum tl_region_weight weight);
void tl_region_lights_add(struct tl_region_lights *lights, const struct tl_lobes *lobes, uint32_t exponents);
bool tl_region_lights_have(const struct tl_region_lights *lights, uint32_t exponents);
void tl_region_lights_release(struct tl_region_lights *lights);

/* Exponents of a lobe of exponent `s`, by region. */
struct tl_region_exponents {
    float s; /* 0: nothing yet */
    float broadened[TL_REGION_GROUPS_MAX][TL_LANES];
};
TL_INLINE void tl_region_broaden(struct tl_region_exponents *exponents, const struct tl_region_lights *lights,
                                 float s)
{
    if (exponents->s == s)
        return;
    exponents->s = s;
    for (int g = 0; g < lights->group_count; g++)
        for (int lane = 0; lane < TL_LANES; lane++)
            exponents->broadened[g][lane] =
                lobe_broadened_exponent(tl_minf(s, TL_REGION_LOBE_MAX), lights->groups[g].spread[lane]);
}

#endif
