#include "render/pem/lobe.h"
#include "render/env/exponent.h"

#include "config/base/memory.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

/* The integral over the sphere of each texel's hat, the function that a bilinear fetch makes of a single
 * white texel. The volume of a level is the sum of its texels times these. Midpoint rule on a grid of half
 * the texel size. */
static double *hat_volumes(int size)
{
    double *volumes = TL_NEW_ARRAY(double, 6 * (size_t)size * (size_t)size);
    int grid = 2 * size < 32 ? 32 : 2 * size;
    for (int face = 0; face < 6; face++) {
        for (int y = 0; y < grid; y++) {
            for (int x = 0; x < grid; x++) {
                float s = ((float)x + 0.5f) / (float)grid, t = ((float)y + 0.5f) / (float)grid;
                struct tl_cube_taps taps = tl_cube_taps(size, tl_cube_direction(face, s, t));
                double solid_angle = (double)tl_cube_solid_angle(grid, x, y);
                for (int i = 0; i < 4; i++)
                    volumes[taps.texel[i]] += solid_angle * (double)taps.weight[i];
            }
        }
    }
    return volumes;
}

/* The curve of volume / peak against level is sampled at several blends between every two levels. They are
 * denser towards the coarser level, where the remaining weight of the finer level's sharp peak still
 * dominates. */
#define BLENDS_PER_LEVEL 24
static double blend_of(int step)
{
    double rest = 1 - (double)step / BLENDS_PER_LEVEL;
    return 1 - rest * rest;
}

struct curve {
    int count;                                                       /* (levels - 1) * BLENDS_PER_LEVEL + 1 */
    double widths[(TL_CHAIN_LEVELS_MAX - 1) * BLENDS_PER_LEVEL + 1]; /* sr */
};

/* The red channel; all three are equal. */
static float red_of(const tl_cube *cube, int texel)
{
    return cube->texels[3 * (size_t)texel];
}

static double level_volume(const tl_cube *level, const double *hats)
{
    assert(hats); /* the chain has as many levels as there are tables */
    double volume = 0;
    for (int i = 0; i < 6 * level->size * level->size; i++)
        volume += (double)red_of(level, i) * hats[i];
    return volume;
}

static vec3s texel_direction(const tl_cube *cube, int i)
{
    int face = i / (cube->size * cube->size), y = i / cube->size % cube->size, x = i % cube->size;
    return tl_cube_direction(face, ((float)x + 0.5f) / (float)cube->size,
                             ((float)y + 0.5f) / (float)cube->size);
}

/* Peaks of the blends of two levels. Both levels are bilinear, so the peak lies at a texel of one or the
 * other. */
static void raise_peaks(const tl_cube *at, const tl_cube *fine, const tl_cube *coarse,
                        double peaks[BLENDS_PER_LEVEL])
{
    for (int i = 0; i < 6 * at->size * at->size; i++) {
        if (red_of(at, i) <= 0)
            continue;
        vec3s direction = texel_direction(at, i);
        double a = (double)tl_cube_sample(fine, direction).x, b = (double)tl_cube_sample(coarse, direction).x;
        for (int step = 0; step < BLENDS_PER_LEVEL; step++)
            peaks[step] = fmax(peaks[step], a + (b - a) * blend_of(step));
    }
}

/* Adds the widths of the response to one white texel. */
static void add_lobe(const tl_cube *impulse, enum tl_chain_filter filter, double *const hats[],
                     struct curve *curve)
{
    struct tl_chain chain = tl_chain_build(impulse, filter);
    int last = chain.level_count - 1;
    double *widths = curve->widths;
    for (int level = 0; level < last; level++) {
        const tl_cube *fine = &chain.levels[level], *coarse = &chain.levels[level + 1];
        double peaks[BLENDS_PER_LEVEL] = {0};
        raise_peaks(fine, fine, coarse, peaks);
        raise_peaks(coarse, fine, coarse, peaks);
        double a = level_volume(fine, hats[level]), b = level_volume(coarse, hats[level + 1]);
        for (int step = 0; step < BLENDS_PER_LEVEL; step++)
            *widths++ += (a + (b - a) * blend_of(step)) / peaks[step];
    }
    double peak = 0;
    for (int i = 0; i < 6; i++)
        peak = fmax(peak, (double)red_of(&chain.levels[last], i));
    *widths += level_volume(&chain.levels[last], hats[last]) / peak;
    tl_chain_release(&chain);
}

/* Texel i of a sequence that is spread evenly over a face (Roberts' R2 sequence). */
#define POSITIONS 64
static int position_texel(int size, int i)
{
    double x = fmod(0.5 + i * 0.7548776662466927, 1), y = fmod(0.5 + i * 0.5698402909980532, 1);
    return (int)(y * size) * size + (int)(x * size);
}

static struct curve measure_curve(int size, enum tl_chain_filter filter)
{
    tl_cube impulse = tl_cube_create(size);
    struct curve curve = {.count = 1};
    double *hats[TL_CHAIN_LEVELS_MAX] = {0};
    int level_count = 0;
    for (int level_size = size; level_size > 0; level_size /= 2)
        hats[level_count++] = hat_volumes(level_size);
    curve.count += (level_count - 1) * BLENDS_PER_LEVEL;

    for (int i = 0; i < POSITIONS; i++) {
        float *texel = impulse.texels + 3 * (size_t)position_texel(size, i);
        texel[0] = texel[1] = texel[2] = 1;
        add_lobe(&impulse, filter, hats, &curve);
        texel[0] = texel[1] = texel[2] = 0;
    }
    for (int i = 0; i < curve.count; i++) {
        curve.widths[i] /= POSITIONS;
        if (i >
            0) /* a blend may be slightly narrower than its finer level, but the table must be monotonic */
            curve.widths[i] = fmax(curve.widths[i], curve.widths[i - 1]);
    }
    for (int i = 0; i < level_count; i++)
        free(hats[i]);
    tl_cube_release(&impulse);
    return curve;
}

/* The level at which the curve reaches a width, clamped to both ends. Between two steps the peak is linear in
 * the blend and the volume nearly constant, so the reciprocal of the width is interpolated. */
static float find_level(const struct curve *curve, double width)
{
    if (width <= curve->widths[0])
        return 0;
    for (int i = 1; i < curve->count; i++) {
        if (width > curve->widths[i])
            continue;
        int level = (i - 1) / BLENDS_PER_LEVEL, step = (i - 1) % BLENDS_PER_LEVEL;
        double before = 1 / curve->widths[i - 1], after = 1 / curve->widths[i];
        double part = (before - 1 / width) / (before - after);
        return (float)(level + blend_of(step) + part * (blend_of(step + 1) - blend_of(step)));
    }
    int last = (curve->count - 1) / BLENDS_PER_LEVEL;
    return (float)last;
}

void tl_lobe_calibrate(int size, enum tl_chain_filter filter, struct tl_lobe_table *out)
{
    struct curve curve = measure_curve(size, filter);
    for (int i = 0; i < TL_LOBE_STEPS; i++) {
        double exponent = (double)tl_lobe_exponent((float)i / (TL_LOBE_STEPS - 1));
        out->level[i] = find_level(&curve, 2 * M_PI / (exponent + 1));
    }
    /* g = 1 is an exact mirror, even where one texel is wider than the lobe of s = 1e6. */
    out->level[TL_LOBE_STEPS - 1] = 0;
}
