#include "render/brdf/ggx/ggx_lobes.h"

#include "render/brdf/ggx/ggx_lobes_internal.h"

#include <math.h>
#include <stddef.h>

#define FINEST (1 / 1000.0f)

const short tl_ggx_table[] = {
#include "render/brdf/ggx/ggx_lobes_table.inc"
};

/* A place between two rows: the first, and the share of the second. */
struct between_rows {
    int first;
    float share;
};

static struct between_rows between_rows(float at, int count)
{
    at = fminf(fmaxf(at, 0), (float)(count - 1));
    const int first = at < (float)(count - 1) ? (int)at : count - 2;
    return (struct between_rows){first, at - (float)first};
}

static struct between_rows rows_of_width(float width)
{
    const float step = (1 - TL_GGX_FIRST_ROUGHNESS) / (TL_GGX_ROUGHNESSES - 1);
    return between_rows((sqrtf(width) - TL_GGX_FIRST_ROUGHNESS) / step, TL_GGX_ROUGHNESSES);
}

static struct between_rows rows_of_elevation(float sine)
{
    const float step = (1 - TL_GGX_FIRST_ELEVATION) / (TL_GGX_ELEVATIONS - 1);
    const float root = sqrtf(asinf(fminf(fmaxf(sine, 0), 1)) / (float)M_PI_2);
    return between_rows((root - TL_GGX_FIRST_ELEVATION) / step, TL_GGX_ELEVATIONS);
}

static float exponent_of(float logarithm, float width)
{
    return fmaxf(1 / (exp2f(logarithm) * width * width) - 1, 1);
}

int tl_ggx_lobes(float width, float sine, int max_count, struct tl_ggx_lobe lobes[TL_GGX_LOBES_MAX])
{
    const int fit = max_count < 3 ? 0 : max_count < 5 ? 1 : max_count < 7 ? 2 : 3;
    const int count = 2 * fit + 1, first = fit * fit;
    const struct between_rows wide = rows_of_width(width), high = rows_of_elevation(sine);
    for (int k = 0; k < count; k++) {
        float figures[TL_GGX_FIGURES] = {0};
        for (int corner = 0; corner < 4; corner++) {
            const int i = corner & 1, j = corner >> 1;
            const float share = (i ? wide.share : 1 - wide.share) * (j ? high.share : 1 - high.share);
            const short *row =
                tl_ggx_row(wide.first + i, high.first + j) + (size_t)(first + k) * TL_GGX_FIGURES;
            for (int f = 0; f < TL_GGX_FIGURES; f++)
                figures[f] += share * (float)row[f];
        }
        lobes[k] = (struct tl_ggx_lobe){.facet = FINEST * figures[0] * width,
                                        .exponent = exponent_of(FINEST * figures[1], width),
                                        .weight = 0.1f * FINEST * figures[2],
                                        .cosine = FINEST * figures[3]};
    }
    return count;
}

/* Between two rows a logarithm lies between theirs. */
void tl_ggx_exponents(float width, float *min, float *max)
{
    const int first = rows_of_width(width).first;
    float minimum = tl_ggx_row(first, 0)[1], maximum = minimum;
    for (int i = first; i < first + 2; i++)
        for (int j = 0; j < TL_GGX_ELEVATIONS; j++)
            for (int k = 0; k < TL_GGX_LOBES_ALL; k++) {
                const float logarithm = tl_ggx_row(i, j)[k * TL_GGX_FIGURES + 1];
                minimum = fminf(minimum, logarithm);
                maximum = fmaxf(maximum, logarithm);
            }
    *min = exponent_of(FINEST * maximum, width);
    *max = exponent_of(FINEST * minimum, width);
}
