#include "app/gallery.h"

#include "config/memory.h"

/* ---- B: environment maps ---- */

static const struct tl_exhibit b1[] = {
    {"B1", "cube, 128 a face", {"maps.layout=cube", "maps.size=128"}, {NULL}},
    {"B1", "sphere, 128, made anew for the view", {"maps.layout=sphere", "maps.size=128"}, {NULL}},
    {"B1", "sphere, 256", {"maps.layout=sphere", "maps.size=256"}, {NULL}},
    {"B1", "dual paraboloid, 128", {"maps.layout=paraboloid", "maps.size=128"}, {NULL}},
    {"B1", "dual paraboloid, 256", {"maps.layout=paraboloid", "maps.size=256"}, {NULL}},
    {"B1", "lat-long, 256 x 128", {"maps.layout=latlong", "maps.size=128"}, {NULL}},
    {"B1", "octahedral, 128", {"maps.layout=octahedral", "maps.size=128"}, {NULL}},
    {"B1", "cube, 32 a face", {"maps.layout=cube", "maps.size=32"}, {NULL}},
};

static const struct tl_exhibit b4[] = {
    {"B4", "paraboloid, looked up directly", {"maps.look_up=direct"}, {NULL}},
    {"B4", "paraboloid, through the projective matrix", {"maps.look_up=matrix"}, {NULL}},
};

static const struct tl_exhibit b5[] = {
    {"B5", "diffuse", {"maps.mode=diffuse"}, {NULL}},
    {"B5", "glossy, g = 0.7", {"maps.mode=glossy", "material.glossiness=0.7"}, {NULL}},
    {"B5", "glossy, g = 0.9", {"maps.mode=glossy", "material.glossiness=0.9"}, {NULL}},
    {"B5", "glossy, g = 0.97", {"maps.mode=glossy", "material.glossiness=0.97"}, {NULL}},
    {"B5", "mirror", {"maps.mode=mirror"}, {NULL}},
    {"B5", "refraction, index 1.5", {"maps.mode=refraction", "material.index=1.5"}, {NULL}},
    {"B5", "refraction, index 1.1", {"maps.mode=refraction", "material.index=1.1"}, {NULL}},
    {"B5", "transmission through a thin sheet", {"maps.mode=transmission"}, {NULL}},
};

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
    {.name = "b1",
     .heading = "B1  The sphere of directions as a picture",
     .text =
         "A mirror shows the map itself. Exact is a cube of 256 texels a face. The sphere map loses what "
         "lies "
         "behind in its rim and has to be made anew when the view turns; paraboloids and the cube do not.",
     .solid = "sphere",
     .base = {"light.method=maps", "maps.mode=mirror"},
     .exact = {"maps.layout=cube", "maps.size=256"},
     .one_truth = true,
     .by_flip = true,
     WALL(b1)},
    {.name = "b4",
     .heading = "B4  Two ways to look a paraboloid up",
     .text = "Reflection vectors computed directly, or by the texture matrix P S M^-1 and a projective "
             "look-up, the "
             "first map's alpha choosing the half: the same picture.",
     .solid = "sphere",
     .base = {"light.method=maps", "maps.mode=mirror", "maps.layout=paraboloid", "maps.size=256"},
     .exact = {"maps.look_up=direct"},
     WALL(b4)},
    {.name = "b5",
     .heading = "B5  What a map can be asked for",
     .text = "One term alone each: prefiltered for a diffuse or a glossy lobe, looked up along the mirrored "
             "or the "
             "refracted ray, or straight through. Exact is the same from a cube of 256 texels a face.",
     .solid = "torus",
     .base = {"light.method=maps", "maps.layout=paraboloid", "maps.size=128"},
     .exact = {"maps.layout=cube", "maps.size=256"},
     WALL(b5)},
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
