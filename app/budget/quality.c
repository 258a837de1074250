#include "app/budget/quality.h"

#include "config/memory.h"

#include <assert.h>
#include <math.h>

const char *const tl_control_names[] = {"ratio", "refresh", "regions", "relief", "cloth", "scale", NULL};

/* Each level divides the scale by the fourth root of two, so two levels halve the number of samples. */
static const float scales[] = {1,      0.841f, 0.707f, 0.595f, 0.5f,   0.42f, 0.354f,
                               0.297f, 0.25f,  0.21f,  0.177f, 0.149f, 0.125f};

static const int level_counts[TL_CONTROL_COUNT] = {2, 3, 4, 3, 3, TL_COUNT(scales)};

#define REGIONS_MIN  24
#define REFRESH_MIN  2
#define RELIEF_MIN   8
#define SUBSTEPS_MIN 8     /* of the preview solver, per frame */
#define SAMPLES_MIN  0.25f /* a pixel side: with fewer a garment cannot be made out */

static int halved(int value, int times, int minimum)
{
    int half = value >> times;
    return half > minimum ? half : minimum < value ? minimum : value;
}

static int all_refreshed(const struct tl_light_params *light)
{
    bool is_all = light->refresh == 0 || light->refresh > light->regions;
    return is_all ? light->regions : light->refresh;
}

/* Each level doubles the step; once a frame is one step, it halves the number of substeps instead. */
static void apply_cloth(int level, struct tl_cloth_params *cloth)
{
    double longest_s = 1 / cloth->frame_rate;
    for (int i = 0; i < level; i++)
        if (cloth->dt < longest_s)
            cloth->dt = fmin(2 * cloth->dt, longest_s);
        else if (cloth->solver == TL_CLOTH_PREVIEW)
            cloth->substeps = halved(cloth->substeps, 1, SUBSTEPS_MIN);
}

struct tl_quality_scope tl_quality_scope_of(const struct tl_settings *settings)
{
    return (struct tl_quality_scope){tl_settings_render(settings), settings->cloth};
}

struct tl_quality_scope tl_quality_scope_at(const struct tl_quality *levels,
                                            const struct tl_quality_scope *full)
{
    struct tl_quality_scope applied = *full;
    struct tl_light_params *light = &applied.drawn.light;
    int *steps = &applied.drawn.detail.steps;
    float *scale = &applied.drawn.image.scale;
    if (levels->of[TL_CONTROL_RATIO] > 0)
        light->ratio_at = TL_RATIO_AT_VERTICES;
    if (levels->of[TL_CONTROL_REFRESH] > 0)
        light->refresh = halved(all_refreshed(light), levels->of[TL_CONTROL_REFRESH], REFRESH_MIN);
    light->regions = halved(light->regions, levels->of[TL_CONTROL_REGIONS], REGIONS_MIN);
    *steps = halved(*steps, levels->of[TL_CONTROL_RELIEF], RELIEF_MIN);
    apply_cloth(levels->of[TL_CONTROL_CLOTH], &applied.cloth);
    assert(levels->of[TL_CONTROL_SCALE] < TL_COUNT(scales));
    float least = SAMPLES_MIN / (float)applied.drawn.image.supersample;
    *scale = fmaxf(*scale * scales[levels->of[TL_CONTROL_SCALE]], fminf(*scale, least));
    return applied;
}

bool tl_quality_is_valid(const struct tl_quality *levels)
{
    for (int control = 0; control < TL_CONTROL_COUNT; control++)
        if (levels->of[control] >= level_counts[control])
            return false;
    return true;
}

struct tl_settings tl_quality_apply(const struct tl_quality *levels, const struct tl_settings *settings)
{
    struct tl_settings changed = *settings;
    const struct tl_quality_scope full = tl_quality_scope_of(settings);
    struct tl_quality_scope applied = tl_quality_scope_at(levels, &full);
    changed.light = applied.drawn.light;
    changed.detail = applied.drawn.detail;
    changed.image = applied.drawn.image;
    changed.cloth = applied.cloth;
    return changed;
}

/* ---- The number of levels in these settings ---- */

static bool has_regions(const struct tl_light_params *light)
{
    return light->method != TL_METHOD_UNSHADOWED && light->method != TL_METHOD_REFERENCE &&
           light->method != TL_METHOD_MAPS;
}

static bool is_used(enum tl_control control, const struct tl_quality_scope *full)
{
    const struct tl_light_params *light = &full->drawn.light;
    switch (control) {
    case TL_CONTROL_RATIO:
        return light->method == TL_METHOD_PEM && light->visibility == TL_VISIBILITY_RAYS;
    case TL_CONTROL_REFRESH:
    case TL_CONTROL_REGIONS:
        return has_regions(light);
    case TL_CONTROL_RELIEF:
        return full->drawn.detail.mode == TL_DETAIL_RELIEF;
    case TL_CONTROL_CLOTH:
        return full->cloth.solver != TL_CLOTH_REFERENCE; /* whose step follows the fabric */
    default:
        return light->method != TL_METHOD_REFERENCE;
    }
}

static bool is_same(const struct tl_quality_scope *a, const struct tl_quality_scope *b)
{
    return a->drawn.light.regions == b->drawn.light.regions &&
           a->drawn.light.refresh == b->drawn.light.refresh &&
           a->drawn.light.ratio_at == b->drawn.light.ratio_at &&
           a->drawn.detail.steps == b->drawn.detail.steps &&
           a->drawn.image.scale == b->drawn.image.scale && // NOLINT: whether it was changed at all
           a->cloth.dt == b->cloth.dt &&                   // NOLINT
           a->cloth.substeps == b->cloth.substeps;
}

/* A control ends where its next level would change nothing. */
int tl_quality_count(enum tl_control control, const struct tl_quality_scope *full)
{
    struct tl_quality levels = {{0}};
    struct tl_quality_scope before = *full;
    int count = 1;
    for (; is_used(control, full) && count < level_counts[control]; count++) {
        levels.of[control] = (uint8_t)count;
        struct tl_quality_scope after = tl_quality_scope_at(&levels, full);
        if (is_same(&after, &before))
            break;
        before = after;
    }
    return count;
}

static double substeps_of(const struct tl_cloth_params *cloth)
{
    const double rounding = 1e-9;
    double steps = fmax(ceil(1 / (cloth->frame_rate * cloth->dt) - rounding), 1);
    return cloth->solver == TL_CLOTH_PREVIEW ? steps * cloth->substeps : steps;
}

double tl_quality_value(enum tl_control control, const struct tl_quality_scope *scope)
{
    switch (control) {
    case TL_CONTROL_RATIO:
        return scope->drawn.light.ratio_at;
    case TL_CONTROL_REFRESH:
        return all_refreshed(&scope->drawn.light);
    case TL_CONTROL_REGIONS:
        return scope->drawn.light.regions;
    case TL_CONTROL_RELIEF:
        return scope->drawn.detail.steps;
    case TL_CONTROL_CLOTH:
        return substeps_of(&scope->cloth);
    default:
        return (double)scope->drawn.image.scale;
    }
}

/* ---- The error of levels ---- */

/* Linear interpolation in a table whose entries are octaves apart, clamped to its ends. */
static double along(const double *table, int count, double octave)
{
    double place = fmin(fmax(octave, 0), count - 1);
    int below = place < count - 1 ? (int)place : count - 2;
    double share = place - below;
    return (1 - share) * table[below] + share * table[below + 1];
}

/* Squared error of the regions and of how many are renewed in a frame, by a table of [24, 48, 96, 192
 * regions] x [3, 6 .. 96 renewed]. Entries are the error over that of 192 regions all renewed: the root mean
 * square of g = 0.7 in the studio and g = 0.95 under a sun. 3 renewed of more than 24 was not measured; the
 * entry continues the step before it. */
static double light_square(const struct tl_light_params *light)
{
    static const double errors[4][6] = {{0.0621, 0.0559, 0.0509, 0.0495, 0.0495, 0.0495},
                                        {0.0441, 0.0401, 0.0356, 0.0310, 0.0298, 0.0298},
                                        {0.0389, 0.0336, 0.0271, 0.0218, 0.0179, 0.0179},
                                        {0.0431, 0.0364, 0.0280, 0.0166, 0.0098, 0}};
    double renewed = log2(all_refreshed(light) / 3.0), of_regions[4];
    for (int i = 0; i < 4; i++)
        of_regions[i] = along(errors[i], 6, renewed);
    double error = along(of_regions, 4, log2(light->regions / 24.0));
    return error * error;
}

/* Squared error of 2, 1 .. 1/8 samples a pixel side against many, for the same two appearances. The errors of
 * the settings' own image and of a level's image are independent, so their squares add. A weave that is
 * marched loses two to three times as much. */
/* Missing detail is seen in any picture, light that is off only beside another one: over the garment's worst
 * 5 % a quarter of the samples errs by 4 times its mean, fewer regions by 2 (`toile trade --axis levels`). */
#define SAMPLING_WEIGHT 2

static double sampling_square(const struct tl_image_params *image)
{
    static const double errors[] = {0.009, 0.018, 0.034, 0.069, 0.136};
    double samples = (double)image->scale * image->supersample;
    double error = SAMPLING_WEIGHT * along(errors, TL_COUNT(errors), log2(2 / samples));
    return error * error;
}

/* The smallest error that a level adds. Where no difference was measured it keeps the settings as long as
 * they fit the budget. */
#define UNSEEN 2e-4

/* Fewer steps of relief make no visible difference (0.0004 at 8 steps). */
static const double relief_errors[] = {0, UNSEEN, 2 * UNSEEN};

/* Ratios that are interpolated between vertices: against ratios at every sample, all else the same. */
static const double ratio_errors[] = {0, 0.004};

/* Error of the next frame from the same state, where a hem swings: a replayed flight's image against the
 * original, mean of three frames. It is not the error after many frames, when two runs have diverged into
 * drapes that are both plausible. */
static const double cloth_errors[] = {0, 0.039, 0.056};

double tl_quality_error(const struct tl_quality *levels, const struct tl_quality_scope *full)
{
    assert(levels->of[TL_CONTROL_RELIEF] < TL_COUNT(relief_errors) &&
           levels->of[TL_CONTROL_CLOTH] < TL_COUNT(cloth_errors));
    const struct tl_quality_scope at = tl_quality_scope_at(levels, full);
    double relief = relief_errors[levels->of[TL_CONTROL_RELIEF]],
           cloth = cloth_errors[levels->of[TL_CONTROL_CLOTH]];
    double ratio = ratio_errors[at.drawn.light.ratio_at] - ratio_errors[full->drawn.light.ratio_at];
    double square = relief * relief + cloth * cloth + ratio * ratio;
    if (has_regions(&full->drawn.light)) {
        double unseen = UNSEEN * (levels->of[TL_CONTROL_REGIONS] + levels->of[TL_CONTROL_REFRESH]);
        square += fmax(light_square(&at.drawn.light) - light_square(&full->drawn.light), unseen * unseen);
    }
    if (levels->of[TL_CONTROL_SCALE] > 0)
        square += sampling_square(&at.drawn.image) + sampling_square(&full->drawn.image);
    return sqrt(square);
}
