#include "render/present/resolve.h"

#include "config/base/simd.h"

#include <stddef.h>
#include <string.h>

/* One row of pixels from the `side` rows of samples that begin at `from`. Sums run along rows, then columns,
 * as in resolve.frag. */
TL_CLONES static void average_row(const float *from, size_t row_floats, int side, int width, float *to)
{
    float count = (float)(side * side);
    for (int x = 0; x < width; x++) {
        float sum[4] = {0};
        for (int y = 0; y < side; y++)
            for (int i = 0; i < side; i++)
                for (int c = 0; c < 4; c++)
                    sum[c] += from[(size_t)y * row_floats + 4 * (size_t)(x * side + i) + (size_t)c];
        for (int c = 0; c < 4; c++)
            to[4 * x + c] = sum[c] / count;
    }
}

void tl_resolve(const struct tl_resample *resolve)
{
    int side = resolve->from_width / resolve->to_width;
    size_t from_floats = 4 * (size_t)resolve->from_width, to_floats = 4 * (size_t)resolve->to_width;
    if (side * resolve->to_width != resolve->from_width ||
        side * resolve->to_height != resolve->from_height) {
        tl_resample(resolve);
        return;
    }
#pragma omp parallel for
    for (int y = 0; y < resolve->to_height; y++) {
        const float *from = resolve->from + (size_t)(y * side) * from_floats;
        float *to = resolve->to + (size_t)y * to_floats;
        if (side == 1)
            memcpy(to, from, to_floats * sizeof *to);
        else
            average_row(from, from_floats, side, resolve->to_width, to);
    }
}
