#include "render/present/resample.h"

#include "config/base/memory.h"
#include "config/base/simd.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define TAPS_MAX  12 /* downwards by image.supersample at most, which is 8 */
#define BAND_ROWS 32 /* of the result, that a thread makes at a time from rows that stay in its cache */

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
    return tl_minf(tl_maxf(value, tl_minf(a, b)), tl_maxf(a, b));
}

/* Upwards: the cubic through four texels, kept between the two in the middle. */
TL_INLINE void read_four(const struct reads *read, const float *a, const float *b, const float *c,
                         const float *d, float *to)
{
    for (int k = 0; k < 4; k++) {
        float sum = read->weights[0] * a[k] + read->weights[1] * b[k] + read->weights[2] * c[k] +
                    read->weights[3] * d[k];
        to[k] = between(sum, b[k], c[k]);
    }
}

TL_CLONES static void resample_row(const float *from, int from_width, const struct reads *columns,
                                   int to_width, float *to)
{
    for (int x = 0; x < to_width; x++) {
        const struct reads *read = &columns[x];
        float sum[4] = {0};
        if (read->is_between) {
            const float *texels[4];
            for (int t = 0; t < 4; t++)
                texels[t] = from + 4 * (size_t)within(read->first + t, from_width);
            read_four(read, texels[0], texels[1], texels[2], texels[3], to + 4 * (size_t)x);
            continue;
        }
        for (int t = 0; t < read->count; t++) {
            const float *texel = from + 4 * (size_t)within(read->first + t, from_width);
            for (int c = 0; c < 4; c++)
                sum[c] += read->weights[t] * texel[c];
        }
        for (int c = 0; c < 4; c++)
            to[4 * x + c] = sum[c];
    }
}

/* One row of the result from `rows` of `count` floats, of which the first is row `first`. */
TL_CLONES static void blend_rows(const float *rows, int first, int row_count, int count,
                                 const struct reads *read, float *to)
{
    const float *row[TAPS_MAX];
    for (int t = 0; t < read->count; t++)
        row[t] = rows + (size_t)(within(read->first + t, row_count) - first) * (size_t)count;
    if (read->is_between) {
        for (int i = 0; i < count; i++) {
            float sum = read->weights[0] * row[0][i] + read->weights[1] * row[1][i] +
                        read->weights[2] * row[2][i] + read->weights[3] * row[3][i];
            to[i] = between(sum, row[1][i], row[2][i]);
        }
        return;
    }
    memset(to, 0, (size_t)count * sizeof *to);
    for (int t = 0; t < read->count; t++)
        for (int i = 0; i < count; i++)
            to[i] += read->weights[t] * row[t][i];
}

/* Rows begin .. end - 1 of the result, by way of `wide`: the rows that they read, as wide as the result. */
static void resample_band(const struct tl_resample *resample, const struct reads *columns,
                          const struct reads *rows, int begin, int end, float *wide)
{
    const size_t row_floats = 4 * (size_t)resample->to_width;
    const int first = within(rows[begin].first, resample->from_height);
    const int last = within(rows[end - 1].first + rows[end - 1].count - 1, resample->from_height);
    for (int y = first; y <= last; y++)
        resample_row(resample->from + 4 * (size_t)y * (size_t)resample->from_width, resample->from_width,
                     columns, resample->to_width, wide + (size_t)(y - first) * row_floats);
    for (int y = begin; y < end; y++)
        blend_rows(wide, first, resample->from_height, (int)row_floats, &rows[y],
                   resample->to + (size_t)y * row_floats);
}

void tl_resample(const struct tl_resample *resample)
{
    struct reads *columns = list_reads(resample->from_width, resample->to_width);
    struct reads *rows = list_reads(resample->from_height, resample->to_height);
    const size_t read_rows =
        (size_t)BAND_ROWS * (size_t)resample->from_height / (size_t)resample->to_height + TAPS_MAX;
#pragma omp parallel
    {
        float *wide = tl_alloc(4 * (size_t)resample->to_width * read_rows, sizeof *wide);
#pragma omp for schedule(dynamic)
        for (int begin = 0; begin < resample->to_height; begin += BAND_ROWS)
            resample_band(resample, columns, rows, begin,
                          begin + BAND_ROWS < resample->to_height ? begin + BAND_ROWS : resample->to_height,
                          wide);
        free(wide);
    }
    free(rows);
    free(columns);
}
