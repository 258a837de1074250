#include "render/inspect/seen.h"

#include <string.h>

void tl_seen_regions_make(const struct tl_regions *regions, float yaw, struct tl_seen_regions *out)
{
    memset(out, 0, sizeof *out);
    out->group_count = (regions->count + TL_LANES - 1) / TL_LANES;
    for (int i = 0; i < regions->count; i++) {
        struct tl_seen_group *group = &out->groups[i / TL_LANES];
        const struct tl_region *region = &regions->items[i];
        vec3s direction = tl_turn_direction(region->direction, yaw);
        group->x[i % TL_LANES] = direction.x;
        group->y[i % TL_LANES] = direction.y;
        group->z[i % TL_LANES] = direction.z;
        group->weight[i % TL_LANES] = region->importance;
    }
}

/* Results so far, one a lane. */
struct lanes {
    float all[TL_LANES], seen[TL_LANES];
    float best[TL_LANES];
    int32_t best_group[TL_LANES];
};

TL_INLINE void add_group(const struct tl_seen_group *group, int number, const uint16_t *const rows[TL_TAPS],
                         const float weights[TL_TAPS], vec3s normal, struct lanes *lanes)
{
    size_t first = (size_t)number * TL_LANES;
    for (int lane = 0; lane < TL_LANES; lane++) {
        float cosine = group->x[lane] * normal.x + group->y[lane] * normal.y + group->z[lane] * normal.z;
        float light = group->weight[lane] * tl_maxf(cosine, 0);
        float visibility = weights[0] * (float)rows[0][first + (size_t)lane] +
                           weights[1] * (float)rows[1][first + (size_t)lane] +
                           weights[2] * (float)rows[2][first + (size_t)lane];
        float arriving = light * visibility;
        lanes->all[lane] += light;
        lanes->seen[lane] += arriving;
        lanes->best_group[lane] = arriving > lanes->best[lane] ? number : lanes->best_group[lane];
        lanes->best[lane] = tl_maxf(arriving, lanes->best[lane]);
    }
}

/* Among equals the lowest. */
static int find_strongest(const struct lanes *lanes)
{
    int strongest = -1;
    float best = 0;
    for (int lane = 0; lane < TL_LANES; lane++) {
        int region = lanes->best_group[lane] * TL_LANES + lane;
        if (lanes->best[lane] > best || (lanes->best[lane] == best && best > 0 && region < strongest)) {
            best = lanes->best[lane];
            strongest = region;
        }
    }
    return strongest;
}

TL_CLONES static void sum_groups(const struct tl_seen_regions *regions, const uint16_t *const rows[TL_TAPS],
                                 const float weights[TL_TAPS], vec3s normal, struct lanes *lanes)
{
    for (int g = 0; g < regions->group_count; g++)
        add_group(&regions->groups[g], g, rows, weights, normal, lanes);
}

struct tl_seen tl_seen_at(const struct tl_seen_regions *regions, const uint16_t *values, size_t stride,
                          const struct tl_taps *taps, vec3s normal)
{
    const uint16_t *rows[TL_TAPS];
    float weights[TL_TAPS];
    for (int t = 0; t < TL_TAPS; t++) {
        rows[t] = values + taps->point[t] * stride;
        weights[t] = taps->weight[t] * (1 / TL_VISIBILITY_ONE);
    }
    struct lanes lanes = {0};
    sum_groups(regions, rows, weights, normal, &lanes);
    float all = tl_sum_lanes(lanes.all), seen = tl_sum_lanes(lanes.seen);
    struct tl_seen result = {.strongest = find_strongest(&lanes)};
    if (all > 0)
        result.visibility = fminf(fmaxf(seen / all, 0), 1);
    if (result.strongest >= 0 && seen > 0)
        result.share = fminf(lanes.best[result.strongest % TL_LANES] / seen, 1);
    return result;
}

float tl_seen_region(const uint16_t *values, size_t stride, const struct tl_taps *taps, int region)
{
    float sum = 0;
    for (int t = 0; t < TL_TAPS; t++)
        sum += taps->weight[t] * (float)values[taps->point[t] * stride + (size_t)region];
    return fminf(fmaxf(sum / TL_VISIBILITY_ONE, 0), 1);
}
