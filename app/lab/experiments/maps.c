/* Environment maps: how directions become a picture, what is prefiltered into it, how it is looked up
 * [Heidrich and Seidel 1999]. Ids B1 to B8. */
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

/* Passes, vectors at vertices, and light maps: three sections of one id. */
#define SEVERAL "maps.passes=several"
#define HALVES  "maps.layout=paraboloid", "maps.look_up=matrix"
static const struct tl_technique passes[] = {
    {.picture = "several passes, float target", .id = "B8", SET(SEVERAL)},
    {.picture = "several passes, 8 bits up to a radiance of 4",
     .golden = "envmap_passes",
     .id = "B8",
     SET(SEVERAL, "maps.pass_target=fixed8", "maps.pass_white=4")},
    {.picture = "several passes, 8 bits up to a radiance of 1",
     .id = "B8",
     SET(SEVERAL, "maps.pass_target=fixed8", "maps.pass_white=1")},
    {.picture = "several passes, 8 bits up to a radiance of 16",
     .id = "B8",
     SET(SEVERAL, "maps.pass_target=fixed8", "maps.pass_white=16")},
    {.picture = "several passes, float target, paraboloid in two halves", .id = "B8", SET(SEVERAL, HALVES)},
};
static const struct tl_technique vectors[] = {
    {.picture = "cube, vectors at vertices",
     .golden = "envmap_vectors",
     .id = "B8",
     SET("maps.vectors=vertex")},
    {.picture = "paraboloid by matrix, vectors at vertices", .id = "B8", SET("maps.vectors=vertex", HALVES)},
    {.picture = "sphere, vectors at vertices", .id = "B8", SET("maps.vectors=vertex", "maps.layout=sphere")},
};

static const struct tl_technique light_maps[] = {
    {.picture = "environment map, no shadows", .id = "B8", SET("maps.light_map=0")},
    {.picture = "light maps of 32 texels", .id = "B8", SET("maps.light_map=32")},
    {.picture = "light maps of 128 texels",
     .golden = "envmap_light_map",
     .id = "B8",
     SET("maps.light_map=128")},
};

static const struct tl_experiment_appearance edges[] = {
    {.title = "edges of 8 cm", .assignments = {"cloth.edge_m=0.08"}},
    {.title = "edges of 4 cm", .assignments = {"cloth.edge_m=0.04"}},
    {.title = "edges of 2 cm", .assignments = {"cloth.edge_m=0.02"}},
    {.title = "edges of 1 cm", .assignments = {"cloth.edge_m=0.01"}},
};

static const struct tl_experiment experiments[] = {
    {.output = TL_OUTPUT_PICTURES,
     .name = "b1",
     .scene = "gallery",
     .title = "B1  Layouts of environment maps",
     .source = "[Heidrich and Seidel 1999, 4.1, figures 4, 5 and 6]",
     .text =
         "A mirror shows the map itself. The sphere map compresses the directions behind it into its rim, "
         "and has to be rebuilt when the view turns; paraboloids and the cube map do not. In the strip "
         "the camera turns.",
     .exact = TL_EXACT_INTEGRAL,
     .exact_text = "the environment itself, read where each ray points",
     .motion = TL_MOTION_CAMERA,
     .motion_step = 15,
     .claims = {{"cube, 128 a face", "cube, 32 a face", "[Wimmer n.d.]"},
                {"dual paraboloid, 256", "dual paraboloid, 128", "[Heidrich and Seidel 1999, 4.1]"},
                {"dual paraboloid, 128", "sphere, 128, rebuilt for the view",
                 "[Heidrich and Seidel 1999, 4.1]"}},
     .solid = "sphere",
     .base = {UNSEWN, "light.method=maps", "maps.mode=mirror"},
     .reference_alone = true,
     .by_flip = true,
     .ids = {"B1"},
     METHODS(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "b3",
     .scene = "gallery",
     .title = "B3  Levels that keep the light",
     .source = "[Heidrich and Seidel 1999, 4.2 and eq. 6]",
     .text = "Texels are weighted by their solid angle when a map is reduced [Heidrich and Seidel 1999, eq. "
             "6], so that "
             "even a few texels hold the diffuse light.",
     .exact = TL_EXACT_INTEGRAL,
     .exact_text = "the environment summed over all directions at every sample, without a map",
     .solid = "sphere",
     .base = {UNSEWN, "light.method=maps", "maps.mode=diffuse"},
     .reference_alone = true,
     .ids = {"B3"},
     METHODS(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "b4",
     .scene = "gallery",
     .title = "B4  Two look-ups of a paraboloid",
     .source = "[Heidrich and Seidel 1999, 4.1 and eq. 7]",
     .text = "Reflection vectors are computed directly; or by the texture matrix P S M^-1 and a "
             "projective look-up, where the alpha of the first map selects the half.",
     .exact = TL_EXACT_INTEGRAL,
     .exact_text = "the environment itself, read where each ray points",
     .solid = "sphere",
     .base = {UNSEWN, "light.method=maps", "maps.mode=mirror", "maps.layout=paraboloid", "maps.size=256"},
     .by_flip = true,
     .ids = {"B4"},
     METHODS(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "b5",
     .scene = "gallery",
     .title = "B5  Terms that a map can hold",
     .source =
         "[Heidrich and Seidel 1999, 4.3, 4.5 and figure 8; Wimmer n.d., Refractive Environment Mapping]",
     .text = "Each picture shows one term alone: prefiltered for a diffuse or a glossy lobe, and looked "
             "up along the reflected ray, the refracted ray, or straight through.",
     .exact = TL_EXACT_INTEGRAL,
     .exact_text =
         "the environment without a map; summed over all directions at every sample, or read where the "
         "mirrored or refracted ray points",
     .side = 384,
     .solid = "torus",
     .base = {UNSEWN, "light.method=maps", "maps.layout=paraboloid", "maps.size=128"},
     .by_flip = true,
     .ids = {"B5"},
     METHODS(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "b2",
     .scene = "gallery",
     .title = "B2  The scene in its own map",
     .source = "[Wimmer n.d., Cube Maps for Env Mapping]",
     .text = "The environment map is captured from the middle of the scene, so that the reflections "
             "include the ground, as it is seen from there. A map knows no shadows, and no mirror in a "
             "mirror: the exact picture has both. In the strip the camera turns.",
     .exact_text = "every reflected ray traced, and what it hits lit",
     .motion = TL_MOTION_CAMERA,
     .motion_step = 15,
     .claims = {{"captured every frame", "the environment alone", "[Wimmer n.d.]"}},
     .solid = "torus",
     .base = {"light.method=maps", "maps.mode=mirror", "image.ground=true"},
     .reference = {.assignments = {TRACED, "material.diffuse=[0, 0, 0]", "material.specular=[1, 1, 1]",
                                   "material.glossiness=0.9999", "light.reflect_scene=true", FEW_SAMPLES,
                                   "reference.lobe_samples=16"}},
     .by_flip = true,
     .ids = {"B2"},
     METHODS(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "b6",
     .scene = "gallery",
     .title = "B6  Fresnel's term from a table of one row",
     .source = "[Heidrich and Seidel 1999, 4.4 and figure 7]",
     .text = "A mirror over a diffuse base, with the indices of refraction of the paper's figure 7. "
             "Reflection that is added to the light of the base creates energy at grazing angles; a coat "
             "transmits only the rest.",
     .exact = TL_EXACT_INTEGRAL,
     .exact_text = "the environment summed over all directions at every sample, without a map",
     .side = 384,
     .solid = "torus",
     .base = {UNSEWN, "light.method=maps", "maps.mode=mirror", "maps.size=128", "material.fresnel=dielectric",
              "material.specular=[1, 1, 1]"},
     .by_flip = true,
     .ids = {"B6"},
     METHODS(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "b7",
     .scene = "gallery",
     .title = "B7  Bumps under an environment",
     .source = "[Heidrich and Seidel 1999, 5.2 and figure 10]",
     .text = "Normal maps in tangent frames that are rebuilt every frame; the environment is looked up "
             "in world space at every pixel.",
     .exact = TL_EXACT_INTEGRAL,
     .exact_text =
         "the environment without a map, about the same bumped normals; summed over all directions, "
         "or read where the mirrored ray points",
     .side = 384,
     .solid = "torus",
     .base = {UNSEWN, "light.method=maps", "maps.size=128"},
     .by_flip = true,
     .ids = {"B7"},
     METHODS(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "b8",
     .scene = "gallery",
     .title = "B8  A pass for each texture",
     .source = "[Heidrich and Seidel 1999, 4.1 and 4.4]",
     .text = "Fresnel's term is drawn into the alpha of a target, then the mirror's map is added multiplied "
             "by it, and the diffuse map by what it leaves [Heidrich and Seidel 1999, 4.4]; a paraboloid's "
             "maps are added one half at a time [4.2]. A target of 8 bits has 255 steps up to a radiance of "
             "its own, and loses what is brighter.",
     .exact_text = "the same maps, read and combined in one pass",
     .side = 384,
     .solid = "torus",
     .base = {"light.method=maps", "maps.mode=mirror", "maps.fresnel=coat", "material.fresnel=dielectric",
              "material.specular=[1, 1, 1]"},
     .reference = {.assignments = {"maps.passes=one"}},
     .by_flip = true,
     .ids = {"B8"},
     METHODS(passes)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "b8_vectors",
     .scene = "gallery",
     .title = "B8  Reflection vectors at vertices",
     .source = "[Heidrich and Seidel 1999, 4.1; Wimmer n.d., Reflective Environment Mapping]",
     .text = "Reflection vectors are computed at vertices and interpolated, as OpenGL generates texture "
             "coordinates. They come shorter than 1, which a cube map ignores; spheres and paraboloids take "
             "them for unit vectors.",
     .exact_text = "vectors computed at every sample of the same mesh",
     .side = 384,
     .solid = "torus",
     .base = {"light.method=maps", "maps.mode=mirror", "maps.size=256"},
     .reference = {.assignments = {"maps.vectors=pixel"}},
     .by_flip = true,
     .ids = {"B8"},
     APPEARANCES(edges),
     METHODS(vectors)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "b8_light_maps",
     .scene = "gallery",
     .title = "B8  Light maps",
     .source = "[Heidrich and Seidel 1999, 4.3]",
     .text =
         "Where neither light nor surfaces move, diffuse light with its shadows is baked into a texture over "
         "each surface's UVs, and multiplied by the material's colour [Wimmer n.d.].",
     .exact_text = "every sample lit by rays to the environment, without bounces",
     .side = 384,
     .solid = "torus",
     .base = {"light.method=maps", "maps.mode=diffuse", "light.bounce=off", "image.ground=true",
              "reference.strata=256"},
     .reference = {.assignments = {TRACED, "material.specular=[0, 0, 0]", FEW_SAMPLES}},
     .ids = {"B8"},
     METHODS(light_maps)},
};
const struct tl_experiment_list tl_maps_experiments = {experiments, TL_COUNT(experiments)};
