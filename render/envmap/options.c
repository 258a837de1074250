#include "render/envmap/options.h"

#include "render/env/layout.h"
#include "render/local/shading.h"
#include "render/plan/affects.h"

static const char *const look_up_names[] = {"direct", "matrix", NULL};
static const char *const mode_names[] = {"surface", "mirror",       "refraction", "diffuse",
                                         "glossy",  "transmission", NULL};

static const char *const passes_names[] = {"one", "several", NULL};
static const char *const vectors_names[] = {"pixel", "vertex", NULL};
static const char *const fresnel_names[] = {"off", "additive", "coat", NULL};

typedef struct tl_maps_params maps_params;
static const struct tl_option rows[] = {
    TL_OPTION_ENUM(maps_params, layout, TL_AFFECTS_APPEARANCE | TL_AFFECTS_LAYOUT, tl_layout_names,
                   "projection of the environment map; sphere is rebuilt whenever the view turns"),
    TL_OPTION_INT(
        maps_params, size, TL_AFFECTS_APPEARANCE | TL_AFFECTS_ENVMAP | TL_AFFECTS_CAPTURE, TL_MAPS_SIZE_MIN,
        TL_MAPS_SIZE_MAX, "texels",
        "side of a cube face, height of the other layouts, a power of two; larger: sharper mirrors"),
    TL_OPTION_ENUM(
        maps_params, look_up, TL_AFFECTS_APPEARANCE | TL_AFFECTS_LOOK_UP, look_up_names,
        "matrix: paraboloids by projective texture matrices and the first map's alpha, as in 1999"),
    TL_OPTION_ENUM(maps_params, mode, TL_AFFECTS_APPEARANCE | TL_AFFECTS_LOOK_UP, mode_names,
                   "surface: diffuse and gloss; mirror; refraction by the material's index; a single term; "
                   "transmission: straight through a thin sheet"),
    TL_OPTION_ENUM(maps_params, fresnel, TL_AFFECTS_APPEARANCE | TL_AFFECTS_LOOK_UP, fresnel_names,
                   "combines mirrors with the light below them by material.fresnel; additive: sum of both; "
                   "coat: only light that is not reflected reaches the layer below"),
    TL_OPTION_BOOL(maps_params, minify, TL_AFFECTS_APPEARANCE | TL_AFFECTS_LOOK_UP,
                   "mirrors and refraction read mip levels, weighted by solid angle, where a pixel covers "
                   "many texels of the map"),
    TL_OPTION_ENUM(maps_params, passes, TL_AFFECTS_APPEARANCE | TL_AFFECTS_LOOK_UP, passes_names,
                   "several: a pass for each texture, added up by blending: Fresnel's term into alpha, then "
                   "each map multiplied by it; paraboloids by matrices in two halves"),
    TL_OPTION_ENUM(maps_params, pass_target, TL_AFFECTS_APPEARANCE | TL_AFFECTS_LOOK_UP, tl_pass_target_names,
                   "precision of the target in which several passes are blended"),
    TL_OPTION_FLOAT(maps_params, pass_white, TL_AFFECTS_APPEARANCE | TL_AFFECTS_LOOK_UP, 0.01, 100000, "",
                    "radiance of the largest value of a fixed8 target, which clamps what is brighter; "
                    "smaller: finer steps"),
    TL_OPTION_ENUM(maps_params, vectors, TL_AFFECTS_APPEARANCE | TL_AFFECTS_LOOK_UP, vectors_names,
                   "where directions of look-ups are computed; vertex: at vertices, without bumps, "
                   "interpolated without renormalisation"),
    TL_OPTION_INT(
        maps_params, light_map, TL_AFFECTS_APPEARANCE | TL_AFFECTS_ENVMAP, 0, 1024, "texels",
        "side of the textures of diffuse light with shadows, baked over the UVs of each surface, or at "
        "its vertices where UVs overlap; what moves is baked again in every frame; 0: none"),
    TL_OPTION_INT(maps_params, capture_every, TL_AFFECTS_APPEARANCE, 0, 1000000, "frames",
                  "redraws the scene into the map if it has changed and this many frames have passed; 0: the "
                  "map holds the environment only"),
    TL_OPTION_VECTOR(
        maps_params, capture_at, TL_AFFECTS_APPEARANCE | TL_AFFECTS_CAPTURE, -10000, 10000, "m",
        "point of the capture, relative to the centre of the scene; surfaces around it are left out"),
};
const struct tl_option_table tl_maps_options =
    TL_OPTION_TABLE("maps", "classic environment mapping, light.method maps: unshadowed but for light maps",
                    rows, maps_params, .layout = TL_LAYOUT_CUBE, .size = 128, .minify = true,
                    .pass_target = TL_PASS_TARGET_FLOAT, .pass_white = 1);
