/* What can be shed of a frame, level by level: what a level makes of the settings, and what it adds to their
 * error.
 *
 * Errors are mean FLIP against the ray-traced image over covered pixels, in motion, and independent: they add
 * as squares. They are measured by `toile trade --axis levels`. Pure. */
#ifndef TOILE_APP_BUDGET_LEVELS_H
#define TOILE_APP_BUDGET_LEVELS_H

#include "app/scene/settings.h"

#include <stdint.h>

/* In the order in which people miss it least. */
enum tl_knob {
    TL_KNOB_REFRESH, /* light.refresh: visibility renewed a frame, of rays or of shadow maps */
    TL_KNOB_REGIONS, /* light.regions: how much of the tree of regions is used */
    TL_KNOB_RELIEF,  /* detail.steps, where relief is marched */
    TL_KNOB_CLOTH,   /* cloth.dt: substeps of the solver */
    TL_KNOB_SCALE,   /* image.scale: samples of the image, last of all */
    TL_KNOB_COUNT
};
extern const char *const tl_knob_names[TL_KNOB_COUNT + 1];

/* Level 0 is what the settings ask for; each further one is cheaper. */
struct tl_levels {
    uint8_t of[TL_KNOB_COUNT];
};

/* True when there are such levels: those of a record may come from anywhere. */
bool tl_levels_exist(const struct tl_levels *levels);

/* The settings of a frame at these levels, which must exist. */
struct tl_settings tl_levels_apply(const struct tl_levels *levels, const struct tl_settings *settings);

/* The part of the settings that levels are about: cheap to copy. */
struct tl_level_scope {
    struct tl_render_settings drawn;
    struct tl_cloth_params cloth;
};

struct tl_level_scope tl_level_scope_of(const struct tl_settings *settings);
struct tl_level_scope tl_level_scope_at(const struct tl_levels *levels, const struct tl_level_scope *full);

/* Levels of a knob that differ in these settings: at least 1. */
int tl_levels_count(enum tl_knob knob, const struct tl_level_scope *full);

/* What is shown at these levels, beyond the error that the settings have by themselves. */
double tl_levels_error(const struct tl_levels *levels, const struct tl_level_scope *full);

/* The setting that a knob turns: regions, regions renewed, steps, substeps a frame, scale. */
double tl_level_value(enum tl_knob knob, const struct tl_level_scope *scope);

#endif
