/* The options of a frame, table by table, as its jobs use them. */
#ifndef TOILE_RENDER_FRAME_SETTINGS_H
#define TOILE_RENDER_FRAME_SETTINGS_H

#include "render/detail/options.h"
#include "render/envmap/options.h"
#include "render/light/options.h"
#include "render/local/shading.h"
#include "render/present/options.h"
#include "render/reference/options.h"
#include "render/reference/reference.h"

struct tl_render_settings {
    struct tl_light_params light;
    struct tl_detail_params detail;
    struct tl_maps_params maps;
    struct tl_shading_params shading; /* under lamps */
    struct tl_image_params image;
    struct tl_reference_params reference;
};

/* The option tables of these settings, bound to them. */
#define TL_RENDER_TABLES 6
void tl_render_settings_bind(struct tl_render_settings *settings,
                             struct tl_binding bindings[TL_RENDER_TABLES]);

/* Returns the settings as the jobs use them: the number of regions rounded to a multiple of six, sizes to
 * powers of two, and visibility by rays for views other than light.
 */
struct tl_render_settings tl_render_settings_resolve(const struct tl_render_settings *settings);

/* The number of times that the reference follows light from surface to surface. */
int tl_reference_bounces(const struct tl_light_params *light, const struct tl_reference_params *reference);
/* The reference's part of these settings. All three are borrowed. */
struct tl_reference_request tl_frame_reference_request(const tl_frame *frame,
                                                       const struct tl_render_settings *settings,
                                                       const struct tl_ground *ground);

#endif
