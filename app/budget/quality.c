#include "app/budget/quality.h"

#include "config/base/memory.h"

#include <assert.h>
#include <math.h>

const char *const tl_control_names[] = {"ratio", "refresh", "regions", "relief", "scale", NULL};

/* Each level divides the scale by the fourth root of two, so two levels halve the number of samples. */
static const float scales[] = {1,      0.841f, 0.707f, 0.595f, 0.5f,   0.42f, 0.354f,
                               0.297f, 0.25f,  0.21f,  0.177f, 0.149f, 0.125f};

static const int level_counts[TL_CONTROL_COUNT] = {2, 3, 4, 3, TL_COUNT(scales)};

#define REGIONS_MIN       24
#define REFRESH_MIN       2
#define RELIEF_MIN        8
#define BOUNCE_SHARES_MAX 32    /* a second and more until all that is seen was renewed */
#define SAMPLES_MIN       0.25f /* along the side of a pixel: with fewer a garment is not recognisable */

static int halved(int value, int times, int minimum)
{
    int half = value >> times;
    return half > minimum ? half : minimum < value ? minimum : value;
}

static int doubled(int value, int times, int maximum)
{
    int more = value << times;
    return more < maximum ? more : maximum > value ? maximum : value;
}

static int all_refreshed(const struct tl_light_params *light)
{
    bool is_all = light->refresh == 0 || light->refresh > light->regions;
    return is_all ? light->regions : light->refresh;
}

struct tl_render_settings tl_quality_at(const struct tl_quality *levels,
                                        const struct tl_render_settings *full)
{
    struct tl_render_settings applied = *full;
    struct tl_light_params *light = &applied.light;
    int *steps = &applied.detail.steps;
    float *scale = &applied.image.scale;
    if (levels->of[TL_CONTROL_RATIO] > 0)
        light->ratio_at = TL_RATIO_AT_VERTICES;
    if (levels->of[TL_CONTROL_REFRESH] > 0) {
        light->refresh = halved(all_refreshed(light), levels->of[TL_CONTROL_REFRESH], REFRESH_MIN);
        light->bounce_shares =
            doubled(light->bounce_shares, levels->of[TL_CONTROL_REFRESH], BOUNCE_SHARES_MAX);
    }
    light->regions = halved(light->regions, levels->of[TL_CONTROL_REGIONS], REGIONS_MIN);
    *steps = halved(*steps, levels->of[TL_CONTROL_RELIEF], RELIEF_MIN);
    assert(levels->of[TL_CONTROL_SCALE] < TL_COUNT(scales));
    float minimum = SAMPLES_MIN / (float)applied.image.supersample;
    *scale = fmaxf(*scale * scales[levels->of[TL_CONTROL_SCALE]], fminf(*scale, minimum));
    return applied;
}

bool tl_quality_is_valid(const struct tl_quality *levels)
{
    for (int control = 0; control < TL_CONTROL_COUNT; control++)
        if (levels->of[control] >= level_counts[control])
            return false;
    return true;
}

void tl_quality_apply(const struct tl_quality *levels, struct tl_settings *settings)
{
    const int visibility = settings->light.visibility; /* auto stays */
    const struct tl_render_settings full = tl_settings_render(settings);
    const struct tl_render_settings applied = tl_quality_at(levels, &full);
    settings->light = applied.light;
    settings->light.visibility = visibility;
    settings->detail = applied.detail;
    settings->image = applied.image;
}

/* ---- The number of levels in these settings ---- */

static bool has_regions(const struct tl_light_params *light)
{
    return light->method != TL_METHOD_UNSHADOWED && light->method != TL_METHOD_REFERENCE &&
           light->method != TL_METHOD_MAPS;
}

static bool is_used(enum tl_control control, const struct tl_render_settings *full)
{
    const struct tl_light_params *light = &full->light;
    switch (control) {
    case TL_CONTROL_RATIO:
        return light->method == TL_METHOD_PEM && light->visibility == TL_VISIBILITY_RAYS;
    case TL_CONTROL_REFRESH:
    case TL_CONTROL_REGIONS:
        return has_regions(light);
    case TL_CONTROL_RELIEF:
        return full->detail.mode == TL_DETAIL_RELIEF;
    default:
        return light->method != TL_METHOD_REFERENCE;
    }
}

static bool is_same(const struct tl_render_settings *a, const struct tl_render_settings *b)
{
    return a->light.regions == b->light.regions && a->light.refresh == b->light.refresh &&
           a->light.bounce_shares == b->light.bounce_shares && a->light.ratio_at == b->light.ratio_at &&
           a->detail.steps == b->detail.steps &&
           a->image.scale == b->image.scale; // NOLINT: whether it was changed at all
}

/* A control ends where its next level would change nothing. */
int tl_quality_count(enum tl_control control, const struct tl_render_settings *full)
{
    struct tl_quality levels = {{0}};
    struct tl_render_settings before = *full;
    int count = 1;
    for (; is_used(control, full) && count < level_counts[control]; count++) {
        levels.of[control] = (uint8_t)count;
        struct tl_render_settings after = tl_quality_at(&levels, full);
        if (is_same(&after, &before))
            break;
        before = after;
    }
    return count;
}

double tl_quality_value(enum tl_control control, const struct tl_render_settings *settings)
{
    switch (control) {
    case TL_CONTROL_RATIO:
        return settings->light.ratio_at;
    case TL_CONTROL_REFRESH:
        return all_refreshed(&settings->light);
    case TL_CONTROL_REGIONS:
        return settings->light.regions;
    case TL_CONTROL_RELIEF:
        return settings->detail.steps;
    default:
        return (double)settings->image.scale;
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
 * regions] x [3, 6 .. 96 renewed]. Entries are the error over that of 192 regions of which 96 are renewed:
 * satin 512 x 512, ratios at vertices, five frames of a flight (docs/notes/budgets.md) and two
 * of `toile trade --axis levels`. 3 renewed of more than 24 was not measured; the entry continues the step
 * before it. Where no difference was measured up to two thousandths are made up: fewer never count as better.
 * So it is of 24 and 48 regions of which 6 are renewed: either is better in one of the two measurements. */
static double light_square(const struct tl_light_params *light)
{
    static const double errors[4][6] = {{0.135, 0.122, 0.0980, 0.0975, 0.0970, 0.0965},
                                        {0.134, 0.120, 0.0970, 0.0965, 0.0960, 0.0955},
                                        {0.110, 0.080, 0.0500, 0.0350, 0.0020, 0.0010},
                                        {0.163, 0.137, 0.1110, 0.0690, 0.0430, 0}};
    double renewed = log2(all_refreshed(light) / 3.0), of_regions[4];
    for (int i = 0; i < 4; i++)
        of_regions[i] = along(errors[i], 6, renewed);
    double error = along(of_regions, 4, log2(light->regions / 24.0));
    return error * error;
}

/* The error of fewer samples counts twice: missing detail is visible in a single picture, an error of light
 * only next to the correct one. */
#define SAMPLING_WEIGHT 2

/* Squared error of 2, 1 .. 1/4 samples a pixel side against many: satin 900 x 800 and denim 1280 x 720 with
 * ratios at vertices, root mean square (`toile trade --axis levels`). The errors of the settings' own image
 * and of a level's image are independent, so their squares add. */
static double sampling_square(const struct tl_image_params *image)
{
    static const double errors[] = {0.014, 0.052, 0.143, 0.294};
    double samples = (double)image->scale * image->supersample;
    double error = SAMPLING_WEIGHT * along(errors, TL_COUNT(errors), log2(2 / samples));
    return error * error;
}

/* The smallest error that a level adds. Where no difference was measured it keeps the settings as long as
 * they fit the budget. */
#define UNSEEN 1e-3

/* Fewer steps of relief make no visible difference (a mean of 0.0004 at 8 steps). */
static const double relief_errors[] = {0, UNSEEN, 2 * UNSEEN};

/* Ratios that are interpolated between vertices: in the flight of the regions 0.277 against the ray-traced
 * image, where ratios at every sample have 0.248. */
static const double ratio_errors[] = {0, 0.123};

double tl_quality_error(const struct tl_quality *levels, const struct tl_render_settings *full)
{
    assert(levels->of[TL_CONTROL_RELIEF] < TL_COUNT(relief_errors));
    const struct tl_render_settings at = tl_quality_at(levels, full);
    double relief = relief_errors[levels->of[TL_CONTROL_RELIEF]];
    double ratio = ratio_errors[at.light.ratio_at] - ratio_errors[full->light.ratio_at];
    double square = relief * relief + ratio * ratio;
    if (has_regions(&full->light)) {
        double unseen = UNSEEN * (levels->of[TL_CONTROL_REGIONS] + levels->of[TL_CONTROL_REFRESH]);
        square += fmax(light_square(&at.light) - light_square(&full->light), unseen * unseen);
    }
    if (levels->of[TL_CONTROL_SCALE] > 0)
        square += sampling_square(&at.image) + sampling_square(&full->image);
    return sqrt(square);
}

int tl_quality_better(enum tl_control control, const struct tl_quality *levels,
                      const struct tl_render_settings *full)
{
    const double error = tl_quality_error(levels, full);
    struct tl_quality better = *levels;
    while (better.of[control] > 0) {
        better.of[control]--;
        if (tl_quality_error(&better, full) < error)
            return better.of[control];
    }
    return -1;
}
