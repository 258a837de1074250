/* Table "image": size of the image, and how it is shown. */
#ifndef TOILE_RENDER_PRESENT_OPTIONS_H
#define TOILE_RENDER_PRESENT_OPTIONS_H

#include "config/options.h"

enum tl_background { TL_BACKGROUND_ENVIRONMENT, TL_BACKGROUND_BLURRED, TL_BACKGROUND_GREY };

/* Views of the image: render/inspect. */
enum tl_image_view {
    TL_VIEW_LIGHT,
    TL_VIEW_NORMAL, /* with bumps */
    TL_VIEW_SMOOTH, /* ... without */
    TL_VIEW_TANGENT,
    TL_VIEW_UV,
    TL_VIEW_ALBEDO,
    TL_VIEW_GLOSS,
    TL_VIEW_VISIBILITY,
    TL_VIEW_REGION,
    TL_VIEW_STRAIN_WARP,
    TL_VIEW_STRAIN_WEFT,
    TL_VIEW_STRAIN_SHEAR,
    TL_VIEW_CROSSING, /* triangles that pass through others of their surface */
    TL_VIEW_COUNT
};
extern const char *const tl_image_view_names[]; /* "light", "normal" ...; NULL-terminated */

struct tl_image_params { /* table "image" */
    int width, height;
    int supersample;   /* samples per pixel side, box filtered in linear light */
    float exposure_ev; /* for show only */
    bool adapt;        /* to environments from files: brightness and white; for show only */
    int background;    /* enum tl_background; for show only */
    bool ground;       /* a ground disc at y = 0 */
    float ground_grey; /* its reflectance; 0: the environment's own */
    int view;          /* enum tl_image_view */
    int view_region;   /* visibility view: of this region; -1: of all, by their power */
    float view_range;  /* strain views: percent at the legend's ends; 0: automatic */
    float scale;       /* samples a side over those that supersample asks for, (0, 1] */
    bool legend;       /* pictures of a view have a legend */
};
/* Size of the G-buffer and of the light. */
void tl_image_samples(const struct tl_image_params *image, int *width, int *height);
extern const struct tl_option_table tl_image_options;

#endif
