/* Fabric detail: heights as normals, parallax and relief, their shadows, weaves too fine to be seen, maps
 * baked of finer meshes, normal maps lit in texture space or held in object space, and relief at outlines.
 * Ids C1 to C8, C11 to C14.
 */
#include "app/lab/experiments/rows_internal.h"

#define BUMPY  WOVEN("8", "2")
#define COARSE WOVEN("20", "5")
#define MARCHED                                                                                              \
    "ray traced; through heights it marches in four steps a texel. It also casts the lamp's shadows from "   \
    "fold to fold, which the sheet's errors then contain: compare rows on the torus"

static const struct tl_technique techniques[] = {
    /* Methods that move the point of the look-up. */
    {.page = "normal",
     .picture = "normal map alone",
     .golden = "weave_plain",
     .group = "mode",
     .id = "C4",
     SET("detail.mode=normal"),
     .quick = true,
     .shown = true},
    {.page = "Blinn", .group = "mode", SET("detail.mode=blinn")},
    {.page = "offset map", .picture = "offset map", .group = "mode", .id = "C1", SET("detail.mode=offset")},
    {.page = "Blinn, at vertices",
     .picture = "Blinn's form with vectors of vertices",
     .group = "mode",
     .id = "C1",
     SET("detail.mode=eye_space")},
    {.page = "parallax", .picture = "parallax", .group = "mode", .id = "C4", SET("detail.mode=parallax")},
    {.page = "parallax, limited",
     .picture = "offset-limited parallax",
     .golden = "detail_parallax",
     .group = "mode",
     .id = "C4",
     SET("detail.mode=parallax_limited"),
     .shown = true},
    {.page = "relief", .group = "mode", SET("detail.mode=relief"), .quick = true, .shown = true},
    {.picture = "normal map by finite differences", .id = "C1", SET("detail.mode=normal")},
    {.picture = "normal map, bumps twice as high",
     .id = "C1",
     SET("detail.mode=normal", "detail.height_scale=2")},
    {.picture = "normal map, half as high", .id = "C1", SET("detail.mode=normal", "detail.height_scale=0.5")},

    {.picture = "frames of edges of 4 cm", .id = "C3", SET("cloth.edge_m=0.04")},
    {.picture = "frames of edges of 2 cm", .id = "C3", SET("cloth.edge_m=0.02")},
    {.picture = "frames of edges of 1 cm", .id = "C3", SET("cloth.edge_m=0.01")},

    /* Shadows of bumps. */
    {.page = "normal, horizon", .group = "shadow", SET("detail.shadow=horizon"), .shown = true},
    {.page = "limited, horizon",
     .group = "shadow",
     SET("detail.mode=parallax_limited", "detail.shadow=horizon")},
    {.page = "relief, horizon", .group = "shadow", SET("detail.mode=relief", "detail.shadow=horizon")},
    {.picture = "no shadow", .id = "C5", SET("detail.shadow=none")},
    {.picture = "horizon map, 8 angles",
     .golden = "detail_horizon",
     .id = "C5",
     SET("detail.shadow=horizon", "detail.angles=8")},
    {.picture = "horizon map, 16 angles", .id = "C5", SET("detail.shadow=horizon", "detail.angles=16")},
    {.picture = "horizon map, 32 angles", .id = "C5", SET("detail.shadow=horizon", "detail.angles=32")},

    /* Steps of a march. */
    {.page = "relief 4, shadow",
     .group = "steps",
     SET("detail.mode=relief", "detail.shadow=relief", "detail.steps=4")},
    {.page = "relief 8, shadow",
     .group = "steps",
     SET("detail.mode=relief", "detail.shadow=relief", "detail.steps=8")},
    {.page = "relief 16, shadow",
     .group = "steps",
     SET("detail.mode=relief", "detail.shadow=relief", "detail.steps=16")},
    {.page = "relief 32, shadow",
     .picture = "relief, 32 steps",
     .group = "steps",
     .id = "C5",
     SET("detail.mode=relief", "detail.shadow=relief", "detail.steps=32")},
    {.page = "relief 64, shadow",
     .group = "steps",
     SET("detail.mode=relief", "detail.shadow=relief", "detail.steps=64")},
    {.page = "relief 128, shadow",
     .group = "steps",
     SET("detail.mode=relief", "detail.shadow=relief", "detail.steps=128")},
    {.picture = "4 steps", .id = "C6", SET("detail.steps=4", "detail.refine=0")},
    {.picture = "4 steps, refined", .id = "C6", SET("detail.steps=4", "detail.refine=5")},
    {.picture = "16 steps", .id = "C6", SET("detail.steps=16", "detail.refine=0")},
    {.picture = "16 steps, refined",
     .golden = "detail_relief",
     .id = "C6",
     SET("detail.steps=16", "detail.refine=5")},
    {.picture = "64 steps, refined", .id = "C6", SET("detail.steps=64", "detail.refine=5")},

    {.picture = "all yarns alike", .id = "C7"},
    {.picture = "matt weft", .id = "C7", SET("weave.weft_gloss=-0.6")},
    {.picture = "matt warp", .id = "C7", SET("weave.warp_gloss=-0.6")},

    /* Treatment of bumps that are finer than pixels. */
    {.page = "no minification",
     .picture = "no widening",
     .group = "minify",
     .id = "C8",
     SET("detail.minify=none"),
     .quick = true,
     .shown = true},
    {.page = "Toksvig", .picture = "Toksvig", .group = "minify", .id = "C8", SET("detail.minify=toksvig")},
    {.page = "LEAN",
     .picture = "LEAN",
     .golden = "detail_lean",
     .group = "minify",
     .id = "C8",
     SET("detail.minify=lean"),
     .shown = true},
};

/* Maps baked of finer meshes. */
static const struct tl_technique baked[] = {
    {.picture = "the coarse mesh alone", .id = "C11", SET("detail.mode=normal")},
    {.picture = "baked normals", .id = "C11", SET("detail.normals=@normals.png")},
    {.picture = "baked normals, parallax by baked heights",
     .id = "C11",
     SET("detail.normals=@normals.png", "detail.heights=@heights.exr", "detail.mode=parallax_limited")},
    {.picture = "baked normals, relief by baked heights",
     .id = "C11",
     SET("detail.normals=@normals.png", "detail.heights=@heights.exr", "detail.mode=relief")},
};

/* Normal maps lit in texture space, and held in object space. */
#define TEXTURE_SPACE(size) "shading.space=texture", "shading.texture_size=" size
#define OBJECT_SPACE(size)  "shading.space=object", "shading.texture_size=" size
#define BY_MATRIX           "shading.coordinates=matrix"
#define POWER_8_BIT         "shading.power=table", "shading.pass_target=fixed8"
static const struct tl_technique lit_textures[] = {
    {.picture = "1024 texels, by matrix",
     .golden = "detail_lit_texture",
     .id = "C12",
     SET(TEXTURE_SPACE("1024"), BY_MATRIX)},
    {.picture = "at pixels, by matrix", .id = "C12", SET(BY_MATRIX)},
    {.picture = "512 texels, by matrix", .id = "C12", SET(TEXTURE_SPACE("512"), BY_MATRIX)},
    {.picture = "2048 texels, by matrix", .id = "C12", SET(TEXTURE_SPACE("2048"), BY_MATRIX)},
    {.picture = "2048 texels, by matrix and table, 8 bits",
     .id = "C12",
     SET(TEXTURE_SPACE("2048"), BY_MATRIX, POWER_8_BIT)},
    {.picture = "2048 texels, each texel's own vectors", .id = "C12", SET(TEXTURE_SPACE("2048"))},
    {.picture = "512 texels", .id = "C14", SET(OBJECT_SPACE("512"))},
    {.picture = "2048 texels", .id = "C14", SET(OBJECT_SPACE("2048"))},
    {.picture = "2048 texels of 8 bits",
     .id = "C14",
     SET(OBJECT_SPACE("2048"), "shading.pass_target=fixed8")},
};

/* Relief at outlines. */
#define CURVED(steps) "detail.curved=true", "detail.steps=" steps
static const struct tl_technique outlines[] = {
    {.picture = "curved, 32 steps", .golden = "detail_curved", .id = "C13", SET(CURVED("32"))},
    {.picture = "as on planes", .id = "C13", SET("detail.curved=false")},
    {.picture = "curved, 16 steps", .id = "C13", SET(CURVED("16"))},
    {.picture = "curved, 64 steps", .id = "C13", SET(CURVED("64"))},
};

static const struct tl_experiment_appearance threads[] = {
    {.name = "coarse",
     .title = "threads of twelve pixels",
     .assignments = {COARSE},
     .reference = {"detail.mode=relief", "detail.steps=256", "detail.refine=16", "detail.shadow=relief"}},
    {.name = "fine",
     .title = "threads finer than a pixel",
     .assignments = {WOVEN("0.8", "0.2"), "material.glossiness=0.8"},
     .reference = {"detail.minify=none", "image.supersample=8"}},
};

static const struct tl_experiment experiments[] = {
    {.output = TL_OUTPUT_PAGE,
     .name = "detail",
     .title = "The trade of fabric detail: error against time",
     .text =
         FRONT "The scene has one lamp. Where threads are visible, the reference is relief mapping of 256 "
               "steps with its own shadows; elsewhere, an image of 64 samples a pixel.",
     .scene = "review",
     .base = {LAMPLIT, "lamp.pitch_deg=25", "material.use_file=false"},
     APPEARANCES(threads),
     METHODS(techniques),
     .warm_up = 1,
     .measured = 9},
    {.output = TL_OUTPUT_PICTURES,
     .name = "c1",
     .scene = "gallery",
     .title = "C1, C2  Heights as normals",
     .source =
         "[Wimmer n.d., Mathematics, Basic Algorithm (Eye Space), Square Patch Assumption, Offset Bump Maps]",
     .text =
         "A weave of yarns 8 mm apart. Maps of normals and of offsets assume square patches; vectors B1, B2 "
         "and N of vertices, interpolated in eye space, follow the stretch of the parametrisation.",
     .exact_text = "Blinn's perturbed normal at every sample (C2), which follows the stretch of the "
                   "parametrisation; its own oracle is a cylinder in closed form (test cylinder)",
     .solid = "torus",
     .base = {LAMPLIT, BUMPY},
     .reference = {.assignments = {"detail.mode=blinn"}},
     .ids = {"C1"},
     METHODS(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "c3",
     .scene = "gallery",
     .title = "C3, E4  Frames rebuilt every frame",
     .source = "[Wimmer n.d., Creating Tangent Space]",
     .text = "A highlight that follows the threads, on meshes of three sizes. In the strip the sheet "
             "falls.",
     .exact_text = "the same mesh ray traced",
     .motion = TL_MOTION_CLOTH,
     .motion_step = 4,
     .solid = "torus",
     .base = {"material.model=ward", "material.width_weft=0.4", "material.width_warp=0.1",
              "material.specular=[0.15, 0.15, 0.15]"},
     .reference = {.assignments = {"light.method=reference", FEW_SAMPLES}},
     .side = 384,
     .ids = {"C3"},
     METHODS(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "c4",
     .scene = "gallery",
     .title = "C4  Parallax",
     .source = "[Wimmer n.d., Parallax normal mapping, Offset limited Parallax normal mapping]",
     .text = "Parallax mapping reads the maps where the view ray meets the mean height, so that bumps "
             "shift with the viewer; a limit on the shift is meant to reduce its errors at grazing "
             "views.",
     .exact_text = MARCHED,
     .claims = {{"offset-limited parallax", "parallax",
                 "[Wimmer n.d., Offset limited Parallax normal mapping]"},
                {"parallax", "normal map alone", "[Wimmer n.d., Parallax normal mapping]"}},
     .solid = "torus",
     .base = {LAMPLIT, COARSE, "weave.texels_per_yarn=16"},
     .reference = {.assignments = {"light.method=reference", "detail.mode=relief"}},
     .side = 256,
     .ids = {"C4"},
     METHODS(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "c5",
     .scene = "gallery",
     .title = "C5  Shadows of bumps",
     .source = "[Wimmer n.d., Horizon Mapping]",
     .text = "Horizon angles are stored for several directions a texel, on both sides of the cloth. "
             "Between two directions the slope of a horizon is linear, which is exact for a straight "
             "yarn.",
     .exact_text = "shadows marched through the heights in 256 steps; a march of 512 is equal to it within a "
                   "hundredth of these errors",
     .claims = {{"horizon map, 32 angles", "horizon map, 16 angles", "[Wimmer n.d.]"},
                {"horizon map, 16 angles", "horizon map, 8 angles", "[Wimmer n.d.]"},
                {"horizon map, 8 angles", "no shadow", "[Wimmer n.d.]"}},
     .solid = "torus",
     .base = {LAMPLIT, COARSE, "weave.texels_per_yarn=16", "detail.mode=relief", "lamp.yaw_deg=-70",
              "lamp.pitch_deg=20"},
     .reference = {.assignments = {"detail.shadow=relief", "detail.steps=256"}},
     .ids = {"C5"},
     METHODS(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "c6",
     .scene = "gallery",
     .title = "C6  Relief by number of steps",
     .source = "[Wimmer n.d., Relief Mapping]",
     .text = "Each step goes to the end of a cone which is so wide that the ray crosses the height field "
             "at most once within it; the last step is then bisected.",
     .exact_text = MARCHED,
     .claims = {{"16 steps", "4 steps", "[Wimmer n.d.]"},
                {"4 steps, refined", "4 steps", "[Wimmer n.d.]"},
                {"64 steps, refined", "16 steps, refined", "[Wimmer n.d.]"}},
     .solid = "torus",
     .base = {LAMPLIT, COARSE, "weave.texels_per_yarn=16", "detail.mode=relief"},
     .reference = {.assignments = {"light.method=reference"}},
     .side = 256,
     .ids = {"C6"},
     METHODS(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "c7",
     .scene = "gallery",
     .title = "C7  Yarns that differ in gloss",
     .source = "[Knuth et al. 2014, 6]",
     .text = "Glossiness varies from texel to texel.",
     .exact_text = "ray traced",
     .solid = "torus",
     .base = {BUMPY},
     .reference = {.assignments = {"light.method=reference", FEW_SAMPLES}},
     .side = 384,
     .ids = {"C7"},
     METHODS(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "c8",
     .scene = "gallery",
     .title = "C8  A fine weave far away",
     .source = "[Toksvig 2005; Olano and Baker 2010]",
     .text = "Yarns are 2.4 mm apart, about two pixels. Without its bumps the cloth would look like "
             "plastic; roughness is widened by the variance of their normals: by one, or by those "
             "along weft "
             "and warp and their covariance, which turns the highlight where bumps run across the "
             "cloth (test "
             "lean). Slopes of the built-in weaves and knits are correlated by less than 0.04. In "
             "the strip "
             "the camera turns: what changes more than the exact picture shimmers.",
     .exact_text = "64 samples a pixel, none of them widened",
     .side = 256,
     .supersample = 1,
     .motion = TL_MOTION_CAMERA,
     .motion_step = 0.5f,
     .claims = {{"LEAN", "Toksvig", "[Olano and Baker 2010]"}, {"Toksvig", "no widening", "[Toksvig 2005]"}},
     .solid = "torus",
     .base = {LAMPLIT, "weave.pattern=plain", "weave.warp_pitch_mm=2.4", "weave.weft_pitch_mm=2.4",
              "weave.crimp_mm=0.6", "material.specular=[0.15, 0.15, 0.15]"},
     .reference = {.assignments = {"image.supersample=8", "detail.minify=none"}},
     .ids = {"C8"},
     METHODS(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "c11",
     .scene = "gallery",
     .title = "C11  Maps baked of a finer mesh",
     .source = "[Heidrich and Seidel 1999, 5]",
     .text = "Wrinkles of 4 mm are in a mesh of 150,000 and one of 130,000 triangles. Garments of "
             "1,536 and 256 triangles, which lie amid them, take their normals and heights from maps of 512 "
             "texels a side (toile bake). Outlines stay those of the coarse meshes.",
     .exact_text = "the finer mesh, ray traced",
     .claims = {{"baked normals", "the coarse mesh alone", "[Heidrich and Seidel 1999, 5]"},
                {"baked normals, relief by baked heights", "baked normals", "[Wimmer n.d.]"}},
     .solid = "torus",
     .base = {"scene.garment=@coarse.obj", "scene.avatar=none", "scene.drape=authored", "scene.smooth=false",
              "construction.show=never"},
     .reference = {.assignments = {"scene.garment=@fine.obj", TRACED, FEW_SAMPLES}},
     .reference_alone = true,
     .baked = true,
     .side = 256,
     .ids = {"C11"},
     METHODS(baked)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "c12",
     .scene = "gallery",
     .title = "C12  Normal maps lit in texture space",
     .source = "[Heidrich and Seidel 1999, 5.1 and figure 9]",
     .text =
         "Lamps light the texels over the UVs of the surface: a matrix makes cosines of their normals, a "
         "table powers of these, and the result is mapped to the surface as any texture [Heidrich and Seidel "
         "1999, 5.1]. A matrix takes lamp and viewer to be at infinity. In the strip the camera turns.",
     .exact_text = "the formula itself, evaluated in float at every sample",
     .motion = TL_MOTION_CAMERA,
     .motion_step = 5,
     .claims = {{"2048 texels, by matrix", "512 texels, by matrix", "[Heidrich and Seidel 1999, 5.1]"},
                {"2048 texels, by matrix", "2048 texels, by matrix and table, 8 bits",
                 "[Heidrich and Seidel 1999, 5.1]"}},
     .solid = "torus",
     .base = {LAMPLIT, BUMPY, "material.model=blinn_phong", "material.specular=[0.15, 0.15, 0.15]",
              "detail.minify=none"},
     .reference = {.assignments = {"shading.space=world", "shading.coordinates=pixel"}},
     .ids = {"C12"},
     METHODS(lit_textures)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "c13",
     .scene = "gallery",
     .title = "C13  Relief at outlines",
     .source = "[Wimmer n.d., Advanced Methods]",
     .text =
         "View rays bend with the surface, by the turn of its normals within each triangle, and what they "
         "pass "
         "over is left out, so that the outline is that of the relief. Heights above the mesh end at the "
         "mesh's outline. On a displaced cylinder the outline is that of traced rays but for 0 to 5 % of the "
         "pixels that planes have wrong (test curved_relief).",
     .exact_text = "512 steps of the same march",
     .claims = {{"curved, 32 steps", "as on planes", "[Wimmer n.d.]"},
                {"curved, 64 steps", "curved, 16 steps", "[Wimmer n.d.]"}},
     .solid = "torus",
     .base = {LAMPLIT, COARSE, "weave.texels_per_yarn=16", "detail.mode=relief"},
     .reference = {.assignments = {CURVED("512"), "detail.refine=16"}},
     .ids = {"C13"},
     METHODS(outlines)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "c14",
     .scene = "gallery",
     .title = "C14  Normal maps in object space",
     .source = "[Heidrich and Seidel 1999, 5.1]",
     .text =
         "The map holds the normals of a pose, which a matrix takes to where the lamps are. Cloth in that "
         "pose is lit as by a map in tangent space, but for the size of texels. Cloth that moves has no "
         "such matrix: the nearest rotation stands for it, and what bends afterwards keeps the light of "
         "its pose. In the strip the sheet falls, with the map of its start.",
     .exact_text = "the map in tangent space, taken to world space at every sample",
     .motion = TL_MOTION_CLOTH,
     .motion_step = 4,
     .claims = {{"2048 texels", "512 texels", "[Heidrich and Seidel 1999, 5.1]"}},
     .solid = "torus",
     .base = {LAMPLIT, BUMPY, "material.specular=[0.15, 0.15, 0.15]", "detail.minify=none"},
     .reference = {.assignments = {"shading.space=world"}},
     .side = 384,
     .ids = {"C14"},
     METHODS(lit_textures)},
};

const struct tl_experiment_list tl_detail_experiments = {experiments, TL_COUNT(experiments)};
