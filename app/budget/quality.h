/* Quality controls: what is reduced so that a frame fits its budget, level by level; what a level makes of
 * the settings, and how much it adds to their error.
 *
 * Errors are FLIP against the ray-traced image over the garment's pixels, in motion, the mean of its worst 5
 * %: what a viewer notices first. They are taken as independent: their squares add. They are measured by
 * `toile trade --axis levels`. Threads: all functions are pure. */
#ifndef TOILE_APP_BUDGET_QUALITY_H
#define TOILE_APP_BUDGET_QUALITY_H

#include "app/settings/settings.h"

#include <stdint.h>

/* In the order in which the loss is least noticed. */
enum tl_control {
    TL_CONTROL_RATIO,   /* light.ratio_at: the ratio of visible to exact light at samples, or at vertices */
    TL_CONTROL_REFRESH, /* light.refresh, light.bounce_shares: visibility and bounced light renewed a frame */
    TL_CONTROL_REGIONS, /* light.regions: how much of the tree of regions is used */
    TL_CONTROL_RELIEF,  /* detail.steps, where relief is marched */
    TL_CONTROL_SCALE,   /* image.scale: samples of the image, last of all */
    TL_CONTROL_COUNT
};
extern const char *const tl_control_names[TL_CONTROL_COUNT + 1];

/* Level 0 is what the settings ask for; each further one is cheaper. */
struct tl_quality {
    uint8_t of[TL_CONTROL_COUNT];
};

/* True when every level exists. Levels that are read from a file must be checked before they are used. */
bool tl_quality_is_valid(const struct tl_quality *levels);

/* The settings that a frame is drawn with at these levels, which must exist. Levels change nothing else:
 * neither the session nor how a garment falls depends on how fast a machine is. */
struct tl_render_settings tl_quality_at(const struct tl_quality *levels,
                                        const struct tl_render_settings *full);
/* The same in the settings of a headless session. */
void tl_quality_apply(const struct tl_quality *levels, struct tl_settings *settings);

/* The number of levels of a control that differ in these settings: at least 1. */
int tl_quality_count(enum tl_control control, const struct tl_render_settings *full);

/* The error that these levels add to that of the settings. */
double tl_quality_error(const struct tl_quality *levels, const struct tl_render_settings *full);

/* The next better level of a control: the nearest below its own at which the error is smaller; -1 where none
 * is. More regions are worse where so few are renewed in a frame that all of them are old. */
int tl_quality_better(enum tl_control control, const struct tl_quality *levels,
                      const struct tl_render_settings *full);

/* The value that a control sets: regions, regions renewed, steps, scale. */
double tl_quality_value(enum tl_control control, const struct tl_render_settings *settings);

#endif
