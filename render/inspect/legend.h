/* What the colours of a view stand for (image.view): title, unit, range, colours. Pure.
 *
 * Colours are sRGB, each channel in [0, 1], as a screen gets them: views are shown as they are, without
 * exposure or tone mapping. A legend is either a scale (stops, between which colours are mixed linearly in
 * sRGB) or a list of entries, or both. */
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
    char note[160];  /* how to read it, and where its range comes from; "" */
    float low, high; /* values at the scale's ends; what lies beyond has the end's colour */
    int stop_count;  /* 0: no scale */
    struct tl_legend_stop stops[TL_LEGEND_STOPS];
    int entry_count;
    struct tl_legend_entry entries[TL_LEGEND_ENTRIES];
};

/* What a legend needs to know beyond the view. */
struct tl_legend_source {
    enum tl_image_view view;
    float range;                      /* strain views: share of 1 at the scale's ends */
    bool range_is_given;              /* ... by image.view_range */
    int region;                       /* visibility: of this region; -1: of all */
    const struct tl_regions *regions; /* region: its strongest are listed; NULL: none are */
};

/* No stops and no entries for TL_VIEW_LIGHT. */
void tl_legend_make(const struct tl_legend_source *source, struct tl_legend *out);

/* The colour of a value on the legend's scale; stop_count must not be 0. */
vec3s tl_legend_colour(const struct tl_legend *legend, float value);

bool tl_view_is_strain(int view);
/* Whether it shows what rays see of the environment. */
bool tl_view_is_visibility(int view);
/* 0 warp, 1 weft, 2 shear. */
int tl_view_strain_axis(int view);

/* Where there is nothing to tell: no strain, no UVs. Shaded by how it faces the viewer. */
extern const vec3s tl_legend_unknown;

/* The uv view's checker: squares within blocks; even and odd. */
#define TL_CHECKER_SQUARE_MM 20
#define TL_CHECKER_BLOCK_MM  100
vec3s tl_checker_colour(int block, int square);
/* The tangent view's lines along the warp. */
#define TL_HATCH_MM 20

/* A direction as a colour: 0.5 + 0.5 d. */
vec3s tl_direction_colour(vec3s direction);
/* A colour of its own for each number, the same in every run. */
vec3s tl_number_colour(uint32_t number);

#endif
