/* Materials. Ids A13, C9, C10. The gallery shows what makes cloth of them; a clear coat, fuzz, knits, open
 * cloth that shows what is behind it and a weave of two yarns have a golden alone. */
#include "app/lab/experiments/rows_internal.h"

static const struct tl_technique coats[] = {
    {.golden = "coat", SET("material.coat=1", "material.coat_glossiness=0.98")},
};

static const struct tl_technique fuzzes[] = {
    {.golden = "fuzz", SET("material.fuzz=1", "material.fuzz_colour=[0.9, 0.6, 0.3]")},
};

static const struct tl_technique open_cloths[] = {
    {.golden = "open_cloth", SET("material.openness=0.4")},
    {.golden = "open_cloth_transmission",
     SET("material.openness=0.2", "material.transmission=[0.3, 0.2, 0.1]")},
};

static const struct tl_technique weaves[] = {
    {.golden = "weave_satin",
     SET("weave.pattern=satin", "weave.texels_per_yarn=16", "weave.warp_pitch_mm=20",
         "weave.weft_pitch_mm=20", "weave.crimp_mm=2", "weave.weft_gloss=-0.6")},
    {.golden = "weave_rib",
     SET("weave.pattern=rib", "weave.texels_per_yarn=16", "weave.wale_mm=14", "weave.course_mm=11",
         "weave.yarn_mm=6", "weave.streaks=0.3")},
};

#define SATIN                                                                                                \
    "material.model=ward", "material.ward=bounded", "material.width_weft=0.16", "material.width_warp=0.062", \
        "material.diffuse=[0.55, 0.045, 0.08]", "material.specular=[0.07, 0.07, 0.07]",                      \
        "material.thread=0.85"
#define BANDS "material.thread_along=0.2", "material.thread_across=0.45"

#define DULL "material.thread=0", "material.model=phong", "material.glossiness=0.5"

static const struct tl_technique cloths[] = {
    {.picture = "threads: one lobe", .id = "C10", SET("material.thread_along=0")},
    {.picture = "threads: surface and inside", .id = "C10", SET(BANDS)},
    {.picture = "shot silk",
     .id = "C10",
     SET(BANDS, "material.diffuse=[0.03, 0.32, 0.13]", "material.warp_share=0.6",
         "material.weft_colour=[0.9, 0, 0.15]")},
    {.picture = "GGX, roughness 0.5",
     .id = "C10",
     SET("material.thread=0", "material.model=torrance_sparrow", "material.facets=ggx",
         "material.width_weft=0.25", "material.specular=[0.3, 0.3, 0.3]")},
    {.picture = "fuzz", .id = "C10", SET(DULL, "material.fuzz=1", "material.fuzz_colour=[0.9, 0.6, 0.3]")},
    {.picture = "rough and matt",
     .id = "C10",
     SET(DULL, "material.specular=[0, 0, 0]", "material.diffuse_roughness=0.6")},
    {.picture = "a rib knit",
     .id = "C10",
     SET(DULL, "weave.pattern=rib", "weave.wale_mm=14", "weave.course_mm=11", "weave.yarn_mm=6")},
};

/* Twice as large as on cloth, so that a sheet's hem shows them at a gallery's size. */
static const struct tl_technique seams[] = {
    {.picture = "nothing sewn", .id = "C9", SET("construction.show=never")},
    {.picture = "plain seams and hems", .id = "C9", SET("construction.seam=plain", "construction.hem=plain")},
    {.picture = "topstitched",
     .id = "C9",
     SET("construction.seam=topstitched", "construction.hem=topstitched")},
    {.picture = "flat-felled, hem of two rows",
     .id = "C9",
     SET("construction.seam=flat_felled", "construction.hem=twice")},
    {.picture = "bound in tape", .id = "C9", SET("construction.seam=bound", "construction.hem=bound")},
};

#define ELONGATED "material.model=ward", "material.width_weft=0.4", "material.width_warp=0.1"

static const struct tl_technique factored[] = {
    {.picture = "Ward, 16 texels", .id = "A13", SET(ELONGATED, "shading.table_size=16")},
    {.picture = "Ward, 32 texels", .id = "A13", SET(ELONGATED, "shading.table_size=32")},
    {.picture = "Ward", .id = "A13", SET(ELONGATED)},
    {.picture = "Ward, two tables a pass", .id = "A13", SET(ELONGATED, "shading.max_textures_per_pass=2")},
    {.picture = "Torrance-Sparrow",
     .golden = "brdf_factored",
     .id = "A13",
     SET("material.model=torrance_sparrow", "material.width_weft=0.3")},
    {.picture = "cosine lobe", .id = "A13", SET("material.model=cosine_lobe")},
    {.picture = "Phong", .id = "A13", SET("material.model=phong")},
};

#define WORN "weave.picture_mm=32", "material.diffuse=[1, 1, 1]"

static const struct tl_technique photographs[] = {
    {.picture = "4 lamps", .id = "C15", SET("weave.pictures=@photographs-04", WORN)},
    {.picture = "6 lamps", .id = "C15", SET("weave.pictures=@photographs-06", WORN)},
    {.picture = "8 lamps", .id = "C15", SET("weave.pictures=@photographs-08", WORN)},
    {.picture = "12 lamps", .id = "C15", SET("weave.pictures=@photographs-12", WORN)},
};

#define GAUSSIAN "material.model=torrance_sparrow", "material.width_weft=0.2"
#define SAMPLED  "material.samples=@samples.txt"

static const struct tl_technique sampled[] = {
    {.picture = "Gaussian facets, not sampled", .id = "A13", SET(GAUSSIAN)},
    {.picture = "Gaussian facets", .id = "A13", SET(GAUSSIAN, SAMPLED)},
    {.picture = "Ward", .id = "A13", SET(ELONGATED, SAMPLED)},
    {.picture = "cosine lobe", .id = "A13", SET("material.model=cosine_lobe", SAMPLED)},
    {.picture = "threads of Banks", .id = "A13", SET("material.model=banks", SAMPLED)},
};

static const struct tl_experiment experiments[] = {
    {.output = TL_OUTPUT_PICTURES,
     .name = "c10",
     .scene = "gallery",
     .title = "C10  Threads, fuzz, knits",
     .source = "[Sadeghi et al. 2013]",
     .text = "Light that has been inside a thread is a coloured band under the white light of its surface; "
             "in shot "
             "silk warps and wefts have bands of different colours. Under an environment a few lobes stand "
             "for each of "
             "these, shadowed by rays kept at vertices.",
     .exact_text = "ray traced",
     .solid = "torus",
     .base = {"scene.environment=studio", "light.method=pem", SATIN},
     .reference = {.assignments = {TRACED, FEW_SAMPLES}},
     .side = 384,
     .ids = {"C10"},
     METHODS(cloths)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "c9",
     .scene = "gallery",
     .title = "C9  Seams, hems, stitches",
     .text =
         "Heights over the distance to a border and the length along it, in closed form: the ditch of a "
         "seam, "
         "its allowances and pucker, a hem with its folded rim, stitches in thread. What is smaller than a "
         "pixel widens the gloss. The row without anything sewn has the light's error alone.",
     .exact_text = "ray traced; it evaluates the same heights at each point",
     .solid = "dress",
     .solid_only = {"scene.avatar=form", "cloth.edge_m=0.02", "camera.target=[0.08, 1.02, 0.12]",
                    "camera.distance_m=0.55", "camera.pitch_deg=5"},
     .base = {"scene.environment=studio", "light.method=pem", "material.diffuse=[0.12, 0.2, 0.4]",
              "material.specular=[0.04, 0.04, 0.04]", "material.glossiness=0.5", "construction.show=always",
              "construction.thread=[0.8, 0.45, 0.1]", "construction.hem_mm=28", "construction.stitch_mm=5.6",
              "construction.thread_mm=0.8", "construction.pucker_mm=0.5", "construction.thickness_mm=0.5"},
     .reference = {.assignments = {TRACED, FEW_SAMPLES}},
     .side = 384,
     .ids = {"C9"},
     METHODS(seams)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "a13",
     .scene = "gallery",
     .title = "A13  Tables factored out of samples",
     .source = "[Heidrich and Seidel 1999, 6; McCool et al. 2001]",
     .text =
         "Samples of each model, 12 for each texel along and across, are factored numerically into four "
         "tables: of "
         "the light, of the viewer, of the half vector, and of its angles to light and normal [McCool et al. "
         "2001]. Tables have 64 texels a side unless stated. Phong's model is not reciprocal, as every "
         "product of this form is. Measured reflectance, material.samples, is drawn in the same way.",
     .exact_text = "the formula itself, evaluated in float at every sample",
     .solid = "torus",
     .base = {LAMPLIT, "shading.reflectance=factored", "shading.table_size=64", "material.glossiness=0.9",
              "material.specular=[0.15, 0.15, 0.15]"},
     .reference = {.assignments = {"shading.reflectance=direct"}},
     .ids = {"A13"},
     METHODS(factored)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "c15",
     .scene = "gallery",
     .title = "C15  A fabric from photographs",
     .source = "[Heidrich and Seidel 1999, 5; Woodham 1980]",
     .text =
         "A weave of two colours is drawn from above, 32 mm of it, under lamps around it, and these pictures "
         "are measured as toile fabric PICTURES --lights does. The objects wear the normals and colours that "
         "come of it, with the weave's own gloss, under another lamp.",
     .exact_text = "the weave itself",
     .solid = "torus",
     .base = {LAMPLIT, UNSEWN, "material.glossiness=0.9", "material.specular=[0.06, 0.06, 0.06]"},
     .reference = {.assignments = {"weave.pictures=", WOVEN("8", "1"), "weave.warp_tint=[1, 0.8, 0.6]",
                                   "material.diffuse=[0.5, 0.3, 0.2]"}},
     .photographed = true,
     .side = 384,
     .ids = {"C15"},
     METHODS(photographs)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "a13_environment",
     .scene = "gallery",
     .title = "A13  Samples under an environment",
     .source = "[Knuth et al. 2014, 6]",
     .text = "20,000 samples of each model over even light. Lobes that are fitted to them once, even light, "
             "a surface "
             "and threads, are drawn as those of any cloth. The first picture has no samples, and the "
             "error of light alone.",
     .exact_text = "the model itself, ray traced",
     .solid = "torus",
     .base = {"scene.environment=studio", "light.method=pem", "material.glossiness=0.9", UNSEWN,
              "material.diffuse=[0.3, 0.16, 0.1]", "material.specular=[0.15, 0.15, 0.15]"},
     .reference = {.assignments = {TRACED, FEW_SAMPLES, "material.samples="}},
     .sampled = true,
     .side = 256,
     .ids = {"A13"},
     METHODS(sampled)},
    {.output = TL_OUTPUT_GOLDEN,
     .name = "coat",
     .title = "A clear coat",
     .scene = "gallery",
     .solid = "torus",
     .base = {"light.method=unshadowed"},
     METHODS(coats)},
    {.output = TL_OUTPUT_GOLDEN,
     .name = "fuzz",
     .title = "Short fibres that stand on cloth",
     .scene = "gallery",
     .solid = "torus",
     .base = {"light.method=unshadowed"},
     METHODS(fuzzes)},
    {.output = TL_OUTPUT_GOLDEN,
     .name = "weave",
     .title = "A satin of matt wefts, and a rib knit",
     .scene = "gallery",
     .solid = "torus",
     .base = {LAMPLIT},
     METHODS(weaves)},
    {.output = TL_OUTPUT_GOLDEN,
     .name = "open cloth",
     .title = "Open cloth over a ball",
     .scene = "gallery",
     .solid = "sheet",
     .base = {"scene.avatar=ball", "cloth.edge_m=0.05", "camera.target=[0, 0.27, 0]",
              "camera.distance_m=1.15", "light.method=unshadowed"},
     METHODS(open_cloths)},
};
const struct tl_experiment_list tl_material_experiments = {experiments, TL_COUNT(experiments)};
