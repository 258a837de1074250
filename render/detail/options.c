#include "render/detail/options.h"

#include "render/plan/affects.h"

static const char *const mode_names[] = {"normal",           "blinn",  "offset", "eye_space", "parallax",
                                         "parallax_limited", "relief", NULL};
static const char *const shadow_names[] = {"none", "horizon", "relief", NULL};
static const char *const angle_names[] = {"8", "16", "32", NULL};
static const char *const minify_names[] = {"none", "toksvig", "lean", NULL};

typedef struct tl_detail_params params;
static const struct tl_option rows[] = {
    TL_OPTION_ENUM(
        params, mode, TL_AFFECTS_APPEARANCE | TL_AFFECTS_DETAIL_MAPS, mode_names,
        "rendering of bumps: the first four change the normal (blinn by the surface's derivatives, "
        "offset by maps of slopes, eye_space by both, at vertices), parallax and relief also "
        "displace the texture"),
    TL_OPTION_INT(params, steps, TL_AFFECTS_APPEARANCE | TL_AFFECTS_DETAIL, 1, 1024, "",
                  "relief: maximum number of cone steps through the heights; with too few, crests are missed "
                  "at grazing views"),
    TL_OPTION_INT(params, refine, TL_AFFECTS_APPEARANCE | TL_AFFECTS_DETAIL, 0, 32, "",
                  "relief: bisections of the last step; larger: more exact"),
    TL_OPTION_ENUM(params, shadow, TL_AFFECTS_APPEARANCE | TL_AFFECTS_DETAIL_MAPS, shadow_names,
                   "shadows of bumps on their own surface; relief: traced through the heights for lamps, in "
                   "place of horizon maps"),
    TL_OPTION_ENUM(params, angles, TL_AFFECTS_APPEARANCE | TL_AFFECTS_DETAIL_MAPS, angle_names,
                   "horizon: number of azimuths per texel; larger: more exact shadows of low lamps"),
    TL_OPTION_FLOAT(params, height_scale, TL_AFFECTS_APPEARANCE | TL_AFFECTS_DETAIL_MAPS, 0, 100, "",
                    "factor on the heights of weaves and height maps"),
    TL_OPTION_BOOL(params, silhouette, TL_AFFECTS_APPEARANCE | TL_AFFECTS_DETAIL,
                   "relief: clips the surface beyond the border of a map that does not repeat"),
    TL_OPTION_BOOL(
        params, curved, TL_AFFECTS_APPEARANCE | TL_AFFECTS_DETAIL,
        "relief: view rays follow the curvature of the surface, so that its outline shows the heights "
        "below the mesh; steps are equal, without cones"),
    TL_OPTION_ENUM(params, minify, TL_AFFECTS_APPEARANCE | TL_AFFECTS_DETAIL_MAPS, minify_names,
                   "widening of the gloss by bumps smaller than a pixel; none: they vanish, and distant "
                   "cloth looks like plastic"),
    TL_OPTION_PATH(
        params, normals, TL_AFFECTS_MATERIALS | TL_AFFECTS_APPEARANCE,
        "normal map over the garment's texture coordinates, a picture, as `toile bake` makes it of a finer "
        "mesh; empty: that of its file"),
    TL_OPTION_PATH(
        params, heights, TL_AFFECTS_MATERIALS | TL_AFFECTS_APPEARANCE,
        "heights over them in metres, an .exr, for parallax, relief and shadows; empty: those of its file"),
};
const struct tl_option_table tl_detail_options = TL_OPTION_TABLE(
    "detail", "fabric detail: bumps, their depth and their shadows", rows, params, .steps = 32, .refine = 5,
    .angles = TL_DETAIL_ANGLES_16, .height_scale = 1, .silhouette = true, .minify = TL_DETAIL_MINIFY_LEAN);
