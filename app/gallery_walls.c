#include "app/gallery.h"

#include "config/memory.h"

/* ---- D: self-shadowing ---- */

static const struct tl_exhibit d9[] = {
    {"D9", "no occlusion", {"light.method=unshadowed"}, {NULL}},
    {"D9", "ambient occlusion", {"light.method=ao"}, {NULL}},
    {"D9", "ambient occlusion with colour", {"light.method=ao_colour"}, {NULL}},
    {"D9", "lights instead of PEMs", {"light.method=lights"}, {NULL}},
    {"D9", "the 2014 algorithm", {"scene.preset=paper", "light.regions=96"}, {NULL}},
    {"D9",
     "the 2014 algorithm, two lobes",
     {"scene.preset=paper", "light.regions=96", "light.lobe=dual"},
     {NULL}},
    {"D9", "PEMs by rays (review)", {"scene.preset=review"}, {NULL}},
    {"D9", "PEMs by rays (final)", {"scene.preset=final"}, {NULL}},
};

#define WALL(array) .exhibits = (array), .exhibit_count = TL_COUNT(array)

const struct tl_gallery_wall tl_gallery_walls[] = {
    {.name = "d9",
     .heading = "D9  The comparison of figure 6",
     .text =
         "What each method makes of the same light: exact is the ray-traced reference. Ambient occlusion "
         "darkens "
         "folds but knows no direction; lights in place of prefiltered regions show themselves in the gloss.",
     .solid = "torus",
     .base = {"image.ground=true"},
     .exact = {"light.method=reference", "light.lobe=dual"},
     .one_truth = true,
     WALL(d9)},
};
const size_t tl_gallery_wall_count = TL_COUNT(tl_gallery_walls);
