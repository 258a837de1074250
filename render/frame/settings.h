/* The options of a frame, table by table.
 *
 * Units and the meaning of 0 stand in each table's rows (options.c). Lifetime: plain values. Threads: any.
 * Errors: none; values come from tl_options_set, which checks them. */
#ifndef TOILE_RENDER_FRAME_SETTINGS_H
#define TOILE_RENDER_FRAME_SETTINGS_H

#include "render/detail/options.h"
#include "render/envmap/options.h"
#include "render/light/options.h"
#include "render/local/shading.h"
#include "render/present/options.h"
#include "render/reference/options.h"
#include "render/reference/reference.h"

/* A zeroed struct is no valid value: begin with tl_options_reset on its bindings. */
struct tl_render_settings {
    /* Light and shadows of the environment. */
    struct tl_light_params light;
    /* Bumps of the fabric. */
    struct tl_detail_params detail;
    /* Environment maps, read with light.method maps alone. */
    struct tl_maps_params maps;
    /* Shading of surfaces by lamps. */
    struct tl_shading_params shading;
    /* Size and content of the image, and how it is shown. */
    struct tl_image_params image;
    /* The ray-traced reference, read with light.method reference, and by light maps. */
    struct tl_reference_params reference;
};

/* Binds the option tables to the members of `settings`, which the bindings point into and write through. */
#define TL_RENDER_TABLES 6
void tl_render_settings_bind(struct tl_render_settings *settings,
                             struct tl_binding bindings[TL_RENDER_TABLES]);

/* Returns the settings as the jobs use them: the number of regions rounded to a multiple of six, sizes to
 * powers of two, and visibility by rays for views other than light.
 */
struct tl_render_settings tl_render_settings_resolve(const struct tl_render_settings *settings);

/* The number of times that paths follow light from surface to surface. */
int tl_frame_bounces(const struct tl_light_params *light, const struct tl_reference_params *reference);

/* The reference's part of these settings. All three are borrowed. */
struct tl_reference_request tl_frame_reference_request(const tl_frame *frame,
                                                       const struct tl_render_settings *settings,
                                                       const struct tl_ground *ground);

#endif
