#include "app/budget/levels.h"

#include "config/memory.h"

#include <assert.h>
#include <math.h>

const char *const tl_knob_names[] = {"refresh", "regions", "relief", "cloth", "scale", NULL};

/* A fourth root of two a level: the samples halve with every other. */
static const float scales[] = {1,      0.841f, 0.707f, 0.595f, 0.5f,   0.42f, 0.354f,
                               0.297f, 0.25f,  0.21f,  0.177f, 0.149f, 0.125f};

static const int level_counts[TL_KNOB_COUNT] = {3, 4, 3, 3, TL_COUNT(scales)};

#define REGIONS_MIN  24
#define REFRESH_MIN  2
#define RELIEF_MIN   8
#define SUBSTEPS_MIN 8    /* of preview, a frame */
#define SCALE_MIN    0.1f /* of the option */

static int halved(int value, int times, int least)
{
    int half = value >> times;
    return half > least ? half : least < value ? least : value;
}

static int all_refreshed(const struct tl_light_params *light)
{
    bool is_all = light->refresh == 0 || light->refresh > light->regions;
    return is_all ? light->regions : light->refresh;
}

/* Twice as long a step, and once a frame is one step, half as many substeps. */
static void apply_cloth(int level, struct tl_cloth_params *cloth)
{
    double longest_s = 1 / cloth->frame_rate;
    for (int i = 0; i < level; i++)
        if (cloth->dt < longest_s)
            cloth->dt = fmin(2 * cloth->dt, longest_s);
        else if (cloth->solver == TL_CLOTH_PREVIEW)
            cloth->substeps = halved(cloth->substeps, 1, SUBSTEPS_MIN);
}

struct tl_level_scope tl_level_scope_of(const struct tl_settings *settings)
{
    return (struct tl_level_scope){tl_settings_render(settings), settings->cloth};
}

struct tl_level_scope tl_level_scope_at(const struct tl_levels *levels, const struct tl_level_scope *full)
{
    struct tl_level_scope applied = *full;
    struct tl_light_params *light = &applied.drawn.light;
    int *steps = &applied.drawn.detail.steps;
    float *scale = &applied.drawn.image.scale;
    if (levels->of[TL_KNOB_REFRESH] > 0)
        light->refresh = halved(all_refreshed(light), levels->of[TL_KNOB_REFRESH], REFRESH_MIN);
    light->regions = halved(light->regions, levels->of[TL_KNOB_REGIONS], REGIONS_MIN);
    *steps = halved(*steps, levels->of[TL_KNOB_RELIEF], RELIEF_MIN);
    apply_cloth(levels->of[TL_KNOB_CLOTH], &applied.cloth);
    assert(levels->of[TL_KNOB_SCALE] < TL_COUNT(scales));
    *scale = fmaxf(*scale * scales[levels->of[TL_KNOB_SCALE]], fminf(*scale, SCALE_MIN));
    return applied;
}

bool tl_levels_exist(const struct tl_levels *levels)
{
    for (int knob = 0; knob < TL_KNOB_COUNT; knob++)
        if (levels->of[knob] >= level_counts[knob])
            return false;
    return true;
}

struct tl_settings tl_levels_apply(const struct tl_levels *levels, const struct tl_settings *settings)
{
    struct tl_settings changed = *settings;
    const struct tl_level_scope full = tl_level_scope_of(settings);
    struct tl_level_scope applied = tl_level_scope_at(levels, &full);
    changed.light = applied.drawn.light;
    changed.detail = applied.drawn.detail;
    changed.image = applied.drawn.image;
    changed.cloth = applied.cloth;
    return changed;
}

/* ---- What a knob does to these settings ---- */

static bool has_regions(const struct tl_light_params *light)
{
    return light->method != TL_METHOD_UNSHADOWED && light->method != TL_METHOD_REFERENCE &&
           light->method != TL_METHOD_MAPS;
}

static bool is_used(enum tl_knob knob, const struct tl_level_scope *full)
{
    const struct tl_light_params *light = &full->drawn.light;
    switch (knob) {
    case TL_KNOB_REFRESH:
    case TL_KNOB_REGIONS:
        return has_regions(light);
    case TL_KNOB_RELIEF:
        return full->drawn.detail.mode == TL_DETAIL_RELIEF;
    case TL_KNOB_CLOTH:
        return full->cloth.solver != TL_CLOTH_REFERENCE; /* whose step follows the fabric */
    default:
        return light->method != TL_METHOD_REFERENCE;
    }
}

static bool is_same(const struct tl_level_scope *a, const struct tl_level_scope *b)
{
    return a->drawn.light.regions == b->drawn.light.regions &&
           a->drawn.light.refresh == b->drawn.light.refresh &&
           a->drawn.detail.steps == b->drawn.detail.steps &&
           a->drawn.image.scale == b->drawn.image.scale && // NOLINT: whether it was changed at all
           a->cloth.dt == b->cloth.dt &&                   // NOLINT
           a->cloth.substeps == b->cloth.substeps;
}

/* A knob ends where its next level would change nothing. */
int tl_levels_count(enum tl_knob knob, const struct tl_level_scope *full)
{
    struct tl_levels levels = {{0}};
    struct tl_level_scope before = *full;
    int count = 1;
    for (; is_used(knob, full) && count < level_counts[knob]; count++) {
        levels.of[knob] = (uint8_t)count;
        struct tl_level_scope after = tl_level_scope_at(&levels, full);
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

double tl_level_value(enum tl_knob knob, const struct tl_level_scope *scope)
{
    switch (knob) {
    case TL_KNOB_REFRESH:
        return all_refreshed(&scope->drawn.light);
    case TL_KNOB_REGIONS:
        return scope->drawn.light.regions;
    case TL_KNOB_RELIEF:
        return scope->drawn.detail.steps;
    case TL_KNOB_CLOTH:
        return substeps_of(&scope->cloth);
    default:
        return (double)scope->drawn.image.scale;
    }
}

/* ---- What they err by ---- */

/* Straight between the points of a table, by octaves; beyond its ends, the ends. */
static double along(const double *table, int count, double octave)
{
    double place = fmin(fmax(octave, 0), count - 1);
    int below = place < count - 1 ? (int)place : count - 2;
    double share = place - below;
    return (1 - share) * table[below] + share * table[below + 1];
}

/* Of 24, 48, 96 and 192 regions with 3, 6 .. 96 of them renewed a frame, beyond the last of them; root mean
 * square of g = 0.7 in the studio and 0.95 under a sun. 3 of more than 24 was not measured: the step before
 * goes on. */
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

/* Of 2, 1 .. 1/8 samples a pixel side, against many; the same looks. What the settings' own image has of it
 * is not what a level's image has, so that they add. A weave that is marched loses two to three times as
 * much. */
static double sampling_square(const struct tl_image_params *image)
{
    static const double errors[] = {0.009, 0.018, 0.034, 0.069, 0.136};
    double samples = (double)image->scale * image->supersample;
    double error = along(errors, TL_COUNT(errors), log2(2 / samples));
    return error * error;
}

/* What a level adds at least: where no difference was measured, what is asked for is kept as long as it fits.
 */
#define UNSEEN 2e-4

/* Fewer steps are not seen (0.0004 at 8). */
static const double relief_errors[] = {0, UNSEEN, 2 * UNSEEN};

/* Of the next frame from the same state, where a hem swings: drapes that part for good are no error that
 * anybody sees. A replayed flight's image against its original, mean of three frames. */
static const double cloth_errors[] = {0, 0.039, 0.056};

double tl_levels_error(const struct tl_levels *levels, const struct tl_level_scope *full)
{
    assert(levels->of[TL_KNOB_RELIEF] < TL_COUNT(relief_errors) &&
           levels->of[TL_KNOB_CLOTH] < TL_COUNT(cloth_errors));
    const struct tl_level_scope at = tl_level_scope_at(levels, full);
    double relief = relief_errors[levels->of[TL_KNOB_RELIEF]],
           cloth = cloth_errors[levels->of[TL_KNOB_CLOTH]];
    double square = relief * relief + cloth * cloth;
    if (has_regions(&full->drawn.light)) {
        double unseen = UNSEEN * (levels->of[TL_KNOB_REGIONS] + levels->of[TL_KNOB_REFRESH]);
        square += fmax(light_square(&at.drawn.light) - light_square(&full->drawn.light), unseen * unseen);
    }
    if (levels->of[TL_KNOB_SCALE] > 0)
        square += sampling_square(&at.drawn.image) + sampling_square(&full->drawn.image);
    return sqrt(square);
}
