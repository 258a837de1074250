#include "render/envmap/light_map_bake.h"

#include "config/base/interrupt.h"
#include "config/base/memory.h"
#include "render/reference/gather.h"

#include <stdlib.h>
#include <string.h>

/* Sets of directions; batches of points take them in turn. */
enum { GROUPS = 64 };

static void gather_batch(const struct tl_reference_scene *scene, int directions,
                         const struct tl_sky_sample *sky, const struct tl_baked_point *items, size_t count,
                         uint64_t batch, float *light)
{
    struct tl_shading_points points = {0};
    float sums[3][TL_SHADING_POINTS];
    for (size_t i = 0; i < count; i++) {
        const struct tl_shading_point point = {.point = items[i].point,
                                               .horizon = items[i].normal,
                                               .normal = items[i].normal,
                                               .axis = items[i].normal,
                                               .exponent = 1,
                                               .diffuse = {{1, 1, 1}}};
        tl_shading_points_add(&points, &point);
    }
    const struct tl_gather_request request = {.scene = scene,
                                              .strata = directions,
                                              .sky = sky,
                                              .lobe_samples = 0,
                                              .random = tl_random_begin(batch, 0)};
    tl_gather(&request, &points, sums);
    for (size_t i = 0; i < count; i++) {
        for (size_t c = 0; c < 3; c++)
            light[4 * items[i].at + c] = sums[c][i];
        light[4 * items[i].at + 3] = 1;
    }
}

void tl_light_map_gather(const struct tl_reference_scene *scene, int directions,
                         const struct tl_baked_point *points, size_t count, float *light)
{
    struct tl_sky_sample *sky = TL_NEW_ARRAY(struct tl_sky_sample, (size_t)GROUPS * (size_t)directions);
    size_t batches = (count + TL_SHADING_POINTS - 1) / TL_SHADING_POINTS;
#pragma omp parallel for schedule(dynamic)
    for (int group = 0; group < GROUPS; group++)
        tl_gather_sample_sky(&scene->sky, directions, 0, 1, tl_random_begin(~(uint64_t)group, 0),
                             tl_random_begin(~(uint64_t)group, 1), sky + (size_t)group * (size_t)directions);
#pragma omp parallel for schedule(dynamic)
    for (size_t batch = 0; batch < batches; batch++) {
        if (tl_interrupted())
            continue;
        size_t first = batch * TL_SHADING_POINTS, left = count - first;
        gather_batch(scene, directions, sky + batch % GROUPS * (size_t)directions, points + first,
                     left < TL_SHADING_POINTS ? left : TL_SHADING_POINTS, batch, light);
    }
    free(sky);
}

static void pad_texel(const float *from, int side, int x, int y, float out[4])
{
    float sum[4] = {0, 0, 0, 0};
    for (int i = 0; i < 9; i++) {
        int nx = x + i % 3 - 1, ny = y + i / 3 - 1;
        if (nx < 0 || ny < 0 || nx >= side || ny >= side)
            continue;
        const float *other = from + 4 * ((size_t)ny * (size_t)side + (size_t)nx);
        for (size_t c = 0; c < 4; c++)
            sum[c] += other[3] > 0 ? other[c] : 0;
    }
    for (size_t c = 0; c < 4 && sum[3] > 0; c++)
        out[c] = sum[c] / sum[3];
}

void tl_light_map_pad(float *light, int side, int rounds)
{
    size_t count = 4 * (size_t)side * (size_t)side;
    float *from = TL_NEW_ARRAY(float, count);
    for (int round = 0; round < rounds; round++) {
        memcpy(from, light, count * sizeof *from);
        for (int y = 0; y < side; y++)
            for (int x = 0; x < side; x++) {
                float *texel = light + 4 * ((size_t)y * (size_t)side + (size_t)x);
                if (!(texel[3] > 0))
                    pad_texel(from, side, x, y, texel);
            }
    }
    free(from);
}
