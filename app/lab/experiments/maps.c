/* Environment maps: how directions become a picture, what is prefiltered into it, how it is looked up
 * [Heidrich and Seidel 1999]. Ids B1 to B7. */
#include "app/lab/experiments/rows_internal.h"

#define BUMPY WOVEN("8", "2")

static const struct tl_technique techniques[] = {
    {.picture = "cube, 128 a face", .id = "B1", SET("maps.layout=cube", "maps.size=128")},
    {.picture = "sphere, 128, rebuilt for the view", .id = "B1", SET("maps.layout=sphere", "maps.size=128")},
    {.picture = "sphere, 256", .id = "B1", SET("maps.layout=sphere", "maps.size=256")},
    {.picture = "dual paraboloid, 128",
     .golden = "envmap_paraboloid",
     .id = "B1",
     SET("maps.layout=paraboloid", "maps.size=128")},
    {.picture = "dual paraboloid, 256", .id = "B1", SET("maps.layout=paraboloid", "maps.size=256")},
    {.picture = "lat-long, 256 x 128", .id = "B1", SET("maps.layout=latlong", "maps.size=128")},
    {.picture = "octahedral, 128", .id = "B1", SET("maps.layout=octahedral", "maps.size=128")},
    {.picture = "cube, 32 a face", .id = "B1", SET("maps.layout=cube", "maps.size=32")},

    {.picture = "cube, down to 4 texels a face", .id = "B3", SET("maps.size=4")},
    {.picture = "cube, 16", .id = "B3", SET("maps.size=16")},
    {.picture = "paraboloid, down to 4 texels", .id = "B3", SET("maps.layout=paraboloid", "maps.size=4")},
    {.picture = "paraboloid, 16", .id = "B3", SET("maps.layout=paraboloid", "maps.size=16")},
    {.picture = "sphere, 16", .id = "B3", SET("maps.layout=sphere", "maps.size=16")},

    {.picture = "paraboloid, looked up directly", .id = "B4", SET("maps.look_up=direct")},
    {.picture = "paraboloid, projective matrix", .id = "B4", SET("maps.look_up=matrix")},

    {.picture = "diffuse", .id = "B5", SET("maps.mode=diffuse")},
    {.picture = "glossy, g = 0.7", .id = "B5", SET("maps.mode=glossy", "material.glossiness=0.7")},
    {.picture = "glossy, g = 0.9",
     .golden = "envmap_glossy",
     .id = "B5",
     SET("maps.mode=glossy", "material.glossiness=0.9")},
    {.picture = "glossy, g = 0.97", .id = "B5", SET("maps.mode=glossy", "material.glossiness=0.97")},
    {.picture = "mirror", .id = "B5", SET("maps.mode=mirror")},
    {.picture = "refraction, index 1.5",
     .golden = "envmap_refraction",
     .id = "B5",
     SET("maps.mode=refraction", "material.index=1.5")},
    {.picture = "refraction, index 1.1", .id = "B5", SET("maps.mode=refraction", "material.index=1.1")},
    {.picture = "transmission through a thin sheet", .id = "B5", SET("maps.mode=transmission")},

    {.picture = "the environment alone", .id = "B2", SET("maps.capture_every=0")},
    {.picture = "captured every frame", .id = "B2", SET("maps.capture_every=1")},

    {.picture = "index 1.5, additive", .id = "B6", SET("maps.fresnel=additive", "material.index=1.5")},
    {.picture = "index 1.5, coat", .id = "B6", SET("maps.fresnel=coat", "material.index=1.5")},
    {.picture = "index 200, additive", .id = "B6", SET("maps.fresnel=additive", "material.index=200")},
    {.picture = "index 200, coat", .id = "B6", SET("maps.fresnel=coat", "material.index=200")},

    {.picture = "smooth", .id = "B7", SET("weave.pattern=none")},
    {.picture = "woven, glossy", .id = "B7", SET(BUMPY)},
    {.picture = "woven, mirror", .id = "B7", SET(BUMPY, "maps.mode=mirror")},
};

static const struct tl_experiment experiments[] = {
    {.output = TL_OUTPUT_PICTURES,
     .name = "b1",
     .scene = "gallery",
     .title = "B1  Layouts of environment maps",
     .text = "A mirror shows the map itself. Reference: a cube map of 256 texels a face. The sphere map "
             "compresses the directions behind it into its rim, and has to be rebuilt when the view "
             "turns; paraboloids and the cube map do not.",
     .solid = "sphere",
     .base = {"light.method=maps", "maps.mode=mirror"},
     .reference = {.assignments = {"maps.layout=cube", "maps.size=256"}},
     .reference_alone = true,
     .by_flip = true,
     .ids = {"B1"},
     TECHNIQUES(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "b3",
     .scene = "gallery",
     .title = "B3  Levels that keep the light",
     .text = "Texels are weighted by their solid angle when a map is reduced [op. cit., eq. 6], so that "
             "even a few texels hold the diffuse light. Reference: a cube map of 256 texels a face.",
     .solid = "sphere",
     .base = {"light.method=maps", "maps.mode=diffuse"},
     .reference = {.assignments = {"maps.layout=cube", "maps.size=256"}},
     .reference_alone = true,
     .ids = {"B3"},
     TECHNIQUES(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "b4",
     .scene = "gallery",
     .title = "B4  Two look-ups of a paraboloid",
     .text = "Reflection vectors are computed directly; or by the texture matrix P S M^-1 and a "
             "projective look-up, where the alpha of the first map selects the half. Both give the same "
             "picture.",
     .solid = "sphere",
     .base = {"light.method=maps", "maps.mode=mirror", "maps.layout=paraboloid", "maps.size=256"},
     .reference = {.assignments = {"maps.look_up=direct"}},
     .ids = {"B4"},
     TECHNIQUES(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "b5",
     .scene = "gallery",
     .title = "B5  Terms that a map can hold",
     .text = "Each picture shows one term alone: prefiltered for a diffuse or a glossy lobe, and looked "
             "up along the reflected ray, the refracted ray, or straight through. Reference: a cube map "
             "of 256 texels a face.",
     .solid = "torus",
     .base = {"light.method=maps", "maps.layout=paraboloid", "maps.size=128"},
     .reference = {.assignments = {"maps.layout=cube", "maps.size=256"}},
     .by_flip = true,
     .ids = {"B5"},
     TECHNIQUES(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "b2",
     .scene = "gallery",
     .title = "B2  The scene in its own map",
     .text = "The environment map is captured from the middle of the scene, so that the reflections "
             "include the objects around it. Reference: a capture in every frame.",
     .solid = "torus",
     .base = {"light.method=maps", "maps.mode=mirror", "image.ground=true"},
     .reference = {.assignments = {"maps.capture_every=1"}},
     .by_flip = true,
     .ids = {"B2"},
     TECHNIQUES(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "b6",
     .scene = "gallery",
     .title = "B6  Fresnel's term from a table of one row",
     .text = "The indices of refraction are those of the paper's figure 7. Reflection that is added to "
             "the light of the base creates energy at grazing angles; a coat transmits only the rest. "
             "Reference: a cube map of 256 texels a face.",
     .solid = "torus",
     .base = {"light.method=maps", "maps.size=128", "material.fresnel=dielectric",
              "material.specular=[1, 1, 1]"},
     .reference = {.assignments = {"maps.size=256"}},
     .ids = {"B6"},
     TECHNIQUES(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "b7",
     .scene = "gallery",
     .title = "B7  Bumps under an environment",
     .text = "Normal maps in tangent frames that are rebuilt every frame; the environment is looked up "
             "in world space at every pixel. Reference: a cube map of 256 texels a face.",
     .solid = "torus",
     .base = {"light.method=maps", "maps.size=128"},
     .reference = {.assignments = {"maps.size=256"}},
     .by_flip = true,
     .ids = {"B7"},
     TECHNIQUES(techniques)},
};
const struct tl_experiment_list tl_maps_experiments = {experiments, TL_COUNT(experiments)};
