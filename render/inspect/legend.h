/* Legends of the views (image.view): title, unit, range and colours.
 *
 * Colours are sRGB, each channel in [0, 1], as a screen gets them: views are shown without exposure or tone
 * mapping. A legend has a scale (stops, between which colours are mixed linearly in sRGB), a list of entries,
 * or both. Errors: none. Lifetime: a legend owns its texts. Threads: any; the functions are pure. */
#ifndef TOILE_RENDER_INSPECT_LEGEND_H
#define TOILE_RENDER_INSPECT_LEGEND_H

#include "render/pem/regions.h"
#include "render/present/options.h"

#define TL_LEGEND_STOPS   33
#define TL_LEGEND_ENTRIES 8

struct tl_legend_stop {
    float value; /* in the legend's unit */
    vec3s colour;
};

struct tl_legend_entry {
    char label[40];
    vec3s colour;
};

struct tl_legend {
    char title[64];  /* "strain along the warp" */
    char unit[8];    /* of the stops' values: "%", or "" */
    char note[160];  /* how to read the colours, and how the range was chosen; "" */
    float low, high; /* values at the scale's ends; values beyond have the colour of that end */
    int stop_count;  /* 0: no scale */
    struct tl_legend_stop stops[TL_LEGEND_STOPS];
    int entry_count;
    struct tl_legend_entry entries[TL_LEGEND_ENTRIES];
};

/* The view, and what its legend depends on. */
struct tl_legend_source {
    enum tl_image_view view;
    float range;                      /* strain views: strain at the scale's ends, 0.05 is 5 % */
    bool range_is_given;              /* by image.view_range; else chosen from the cloth */
    int region;                       /* visibility view: this region; -1: all */
    const struct tl_regions *regions; /* region view: the strongest are listed; NULL: none */
};

/* Makes the legend of a view; that of TL_VIEW_LIGHT is empty. */
void tl_legend_make(const struct tl_legend_source *source, struct tl_legend *out);

/* Returns the colour of a value on the legend's scale; stop_count must not be 0. */
vec3s tl_legend_colour(const struct tl_legend *legend, float value);

/* Returns whether a view shows the strain of the cloth. */
bool tl_view_is_strain(int view);
/* Returns whether a view shows the visibility of the environment, by rays. */
bool tl_view_is_visibility(int view);
/* Returns the component of strain that a strain view shows: 0 warp, 1 weft, 2 shear. */
int tl_view_strain_axis(int view);

/* The colour of surfaces without the value that a view shows: no strain, no UVs. It is shaded by the angle to
 * the viewer. */
extern const vec3s tl_legend_crossing; /* of triangles that cross */
extern const vec3s tl_legend_unknown;

/* The checker of the UV view: squares within blocks, each even (0) or odd (1). */
#define TL_CHECKER_SQUARE_MM 20
#define TL_CHECKER_BLOCK_MM  100
vec3s tl_checker_colour(int block, int square);
/* The distance of the lines along the warp in the tangent view. */
#define TL_HATCH_MM 20

/* Returns the colour of a unit vector d: 0.5 + 0.5 d. */
vec3s tl_direction_colour(vec3s direction);
/* Returns the colour of a number, the same in every run and different for different numbers. */
vec3s tl_number_colour(uint32_t number);

#endif
