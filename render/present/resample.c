#include "render/present/resample.h"

#include "config/memory.h"
#include "config/simd.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define TAPS_MAX 12 /* downwards by image.supersample at most, which is 8 */

/* The source rows or columns that one row or column of the result reads. Indices beyond the border stand for
 * the border. */
struct reads {
    int first, count;
    bool is_between; /* upwards: the result lies between the second and the third */
    float weights[TAPS_MAX];
};

static struct reads read_up(double at)
{
    int before = (int)floor(at);
    float t = (float)(at - before), t2 = t * t, t3 = t2 * t;
    return (struct reads){.first = before - 1,
                          .count = 4,
                          .is_between = true,
                          .weights = {0.5f * (-t3 + 2 * t2 - t), 0.5f * (3 * t3 - 5 * t2 + 2),
                                      0.5f * (-3 * t3 + 4 * t2 + t), 0.5f * (t3 - t2)}};
}

static struct reads read_down(double begin, double end)
{
    struct reads reads = {.first = (int)floor(begin)};
    for (int i = reads.first; i < end && reads.count < TAPS_MAX; i++)
        reads.weights[reads.count++] = (float)((fmin(i + 1, end) - fmax(i, begin)) / (end - begin));
    return reads;
}

static struct reads *list_reads(int from, int to)
{
    struct reads *reads = TL_NEW_ARRAY(struct reads, (size_t)to);
    double ratio = (double)from / to;
    for (int i = 0; i < to; i++)
        reads[i] = ratio < 1 ? read_up((i + 0.5) * ratio - 0.5) : read_down(i * ratio, (i + 1) * ratio);
    return reads;
}

TL_INLINE int within(int i, int count)
{
    return i < 0 ? 0 : i < count ? i : count - 1;
}

TL_INLINE float between(float value, float a, float b)
{
    return tl_lesser(tl_greater(value, tl_lesser(a, b)), tl_greater(a, b));
}

TL_CLONES static void resample_row(const float *from, int from_width, const struct reads *columns,
                                   int to_width, float *to)
{
    for (int x = 0; x < to_width; x++) {
        const struct reads *read = &columns[x];
        float sum[4] = {0};
        for (int t = 0; t < read->count; t++) {
            const float *texel = from + 4 * (size_t)within(read->first + t, from_width);
            for (int c = 0; c < 4; c++)
                sum[c] += read->weights[t] * texel[c];
        }
        const float *before = from + 4 * (size_t)within(read->first + 1, from_width);
        const float *after = from + 4 * (size_t)within(read->first + 2, from_width);
        for (int c = 0; c < 4; c++)
            to[4 * x + c] = read->is_between ? between(sum[c], before[c], after[c]) : sum[c];
    }
}

/* One row of the result from rows of `count` floats. */
TL_CLONES static void blend_rows(const float *rows, int row_count, int count, const struct reads *read,
                                 float *to)
{
    memset(to, 0, (size_t)count * sizeof *to);
    for (int t = 0; t < read->count; t++) {
        const float *row = rows + (size_t)within(read->first + t, row_count) * (size_t)count;
        for (int i = 0; i < count; i++)
            to[i] += read->weights[t] * row[i];
    }
    if (!read->is_between)
        return;
    const float *before = rows + (size_t)within(read->first + 1, row_count) * (size_t)count;
    const float *after = rows + (size_t)within(read->first + 2, row_count) * (size_t)count;
    for (int i = 0; i < count; i++)
        to[i] = between(to[i], before[i], after[i]);
}

void tl_resample(const struct tl_resample *resample)
{
    struct reads *columns = list_reads(resample->from_width, resample->to_width);
    struct reads *rows = list_reads(resample->from_height, resample->to_height);
    int row_floats = 4 * resample->to_width;
    float *wide = tl_resize(NULL, (size_t)row_floats * (size_t)resample->from_height, sizeof *wide);
#pragma omp parallel for
    for (int y = 0; y < resample->from_height; y++)
        resample_row(resample->from + 4 * (size_t)y * (size_t)resample->from_width, resample->from_width,
                     columns, resample->to_width, wide + (size_t)y * (size_t)row_floats);
#pragma omp parallel for
    for (int y = 0; y < resample->to_height; y++)
        blend_rows(wide, resample->from_height, row_floats, &rows[y],
                   resample->to + (size_t)y * (size_t)row_floats);
    free(wide);
    free(rows);
    free(columns);
}
