#include "app/lab/gallery/gallery.h"
#include "app/lab/gallery/gallery_figures.h"

#include "config/memory.h"

/* ---- A: one lamp, in the dark ---- */

#define LAMPLIT "scene.environment=none", "light.method=unshadowed", "lamp.kind=directional"
#define BUMPY   "weave.pattern=plain", "weave.warp_pitch_mm=8", "weave.weft_pitch_mm=8", "weave.crimp_mm=2"
#define COARSE                                                                                               \
    "weave.pattern=plain", "weave.warp_pitch_mm=20", "weave.weft_pitch_mm=20", "weave.crimp_mm=5",           \
        "weave.texels_per_yarn=16"

static const struct tl_exhibit a1[] = {
    {"A1", "direct", {NULL}, {NULL}},
    {"A1", "tables 256, float", {"shading.reflectance=table"}, {NULL}},
    {"A1", "tables 256, 16 bit", {"shading.reflectance=table", "shading.table_precision=fixed16"}, {NULL}},
    {"A1", "tables 256, 8 bit", {"shading.reflectance=table", "shading.table_precision=fixed8"}, {NULL}},
    {"A1",
     "tables 32, 8 bit",
     {"shading.reflectance=table", "shading.table_precision=fixed8", "shading.table_size=32"},
     {NULL}},
    {"A1",
     "Beckmann, V-grooves",
     {"material.facets=beckmann", "material.masking=v_grooves", "shading.reflectance=table"},
     {NULL}},
    {"A1", "smoother: slopes 0.1", {"material.width_weft=0.1", "shading.reflectance=table"}, {NULL}},
    {"A1",
     "conductor",
     {"material.fresnel=conductor", "material.index=1", "material.extinction=3", "shading.reflectance=table"},
     {NULL}},
};

static const struct tl_exhibit a2[] = {
    {"A2", "8 bit, cut at 1", {"shading.table_range=clamped"}, {NULL}},
    {"A2", "8 bit, divided and multiplied back", {"shading.table_range=scaled"}, {NULL}},
    {"A2", "16 bit, divided", {"shading.table_range=scaled", "shading.table_precision=fixed16"}, {NULL}},
    {"A2", "float", {"shading.table_precision=float"}, {NULL}},
};

static const struct tl_exhibit a3[] = {
    {"A3", "Phong", {"material.model=phong"}, {NULL}},
    {"A3", "Phong, 8 bit", {"material.model=phong", "shading.table_precision=fixed8"}, {NULL}},
    {"A3", "Blinn-Phong", {"material.model=blinn_phong"}, {NULL}},
    {"A3", "Blinn-Phong, 8 bit", {"material.model=blinn_phong", "shading.table_precision=fixed8"}, {NULL}},
    {"A3", "cosine lobe", {"material.model=cosine_lobe"}, {NULL}},
    {"A3",
     "cosine lobe, 64, 8 bit",
     {"material.model=cosine_lobe", "shading.table_precision=fixed8", "shading.table_size=64"},
     {NULL}},
};

static const struct tl_exhibit a4[] = {
    {"A4", "equal widths", {"material.width_weft=0.2", "material.width_warp=0.2"}, {NULL}},
    {"A4", "shine across the warp", {"material.width_weft=0.4", "material.width_warp=0.1"}, {NULL}},
    {"A4",
     "turned by 45 degrees",
     {"material.width_weft=0.4", "material.width_warp=0.1", "material.rotation_deg=45"},
     {NULL}},
    {"A4",
     "turned by 90 degrees",
     {"material.width_weft=0.4", "material.width_warp=0.1", "material.rotation_deg=90"},
     {NULL}},
    {"A4",
     "from tables, 8 bit",
     {"material.width_weft=0.4", "material.width_warp=0.1", "shading.reflectance=table",
      "shading.table_precision=fixed8"},
     {NULL}},
};

static const struct tl_exhibit a5[] = {
    {"A5", "threads along the weft", {NULL}, {NULL}},
    {"A5", "threads along the warp", {"material.rotation_deg=90"}, {NULL}},
    {"A5", "from a table", {"shading.reflectance=table"}, {NULL}},
    {"A5", "from a table, 8 bit", {"shading.reflectance=table", "shading.table_precision=fixed8"}, {NULL}},
};

static const struct tl_exhibit a6[] = {
    {"A6", "matrix, far lamp", {"shading.coordinates=matrix"}, {NULL}},
    {"A6", "vertex, far lamp", {"shading.coordinates=vertex"}, {NULL}},
    {"A6", "pixel, far lamp", {"shading.coordinates=pixel"}, {NULL}},
    {"A6",
     "matrix, near lamp",
     {"shading.coordinates=matrix", "lamp.kind=point", "lamp.distance_m=0.5",
      "lamp.irradiance=[0.6, 0.6, 0.6]"},
     {NULL}},
    {"A6",
     "vertex, near lamp",
     {"shading.coordinates=vertex", "lamp.kind=point", "lamp.distance_m=0.5",
      "lamp.irradiance=[0.6, 0.6, 0.6]"},
     {NULL}},
    {"A6",
     "pixel, near lamp",
     {"shading.coordinates=pixel", "lamp.kind=point", "lamp.distance_m=0.5",
      "lamp.irradiance=[0.6, 0.6, 0.6]"},
     {NULL}},
};

static const struct tl_exhibit a7[] = {
    {"A7", "one pass", {NULL}, {NULL}},
    {"A7", "two passes, float target", {"shading.max_textures_per_pass=1"}, {NULL}},
    {"A7",
     "two passes, 8-bit target",
     {"shading.max_textures_per_pass=1", "shading.pass_target=fixed8"},
     {NULL}},
};

static const struct tl_exhibit a8[] = {
    {"A8", "Gouraud, edges of 4 cm", {"shading.frequency=gouraud", "cloth.edge_m=0.04"}, {NULL}},
    {"A8", "fast Phong, edges of 4 cm", {"shading.frequency=fast_phong", "cloth.edge_m=0.04"}, {NULL}},
    {"A8", "Phong, edges of 4 cm", {"shading.frequency=phong", "cloth.edge_m=0.04"}, {NULL}},
    {"A8", "Gouraud, edges of 2 cm", {"shading.frequency=gouraud", "cloth.edge_m=0.02"}, {NULL}},
    {"A8", "fast Phong, edges of 2 cm", {"shading.frequency=fast_phong", "cloth.edge_m=0.02"}, {NULL}},
    {"A8", "Gouraud, edges of 1 cm", {"shading.frequency=gouraud", "cloth.edge_m=0.01"}, {NULL}},
    {"A8", "fast Phong, edges of 1 cm", {"shading.frequency=fast_phong", "cloth.edge_m=0.01"}, {NULL}},
};

static const struct tl_exhibit a9[] = {
    {"A9", "none", {"shading.normalisation=none"}, {NULL}},
    {"A9", "8-bit cube map", {"shading.normalisation=cube8"}, {NULL}},
    {"A9", "one Newton step", {"shading.normalisation=newton"}, {NULL}},
    {"A9", "16-bit cube map", {"shading.normalisation=cube16"}, {NULL}},
    {"A9", "exact", {"shading.normalisation=exact"}, {NULL}},
};

static const struct tl_exhibit a10[] = {
    {"A10", "squaring, 8+1 bit, n = 10", {"shading.power=fixed8", "material.glossiness=0.9"}, {NULL}},
    {"A10", "squaring, 8+1 bit, n = 50", {"shading.power=fixed8", "material.glossiness=0.98"}, {NULL}},
    {"A10", "squaring, 8+1 bit, n = 200", {"shading.power=fixed8", "material.glossiness=0.995"}, {NULL}},
    {"A10", "table, n = 10", {"shading.power=table", "material.glossiness=0.9"}, {NULL}},
    {"A10", "table, n = 50", {"shading.power=table", "material.glossiness=0.98"}, {NULL}},
    {"A10", "table, n = 200", {"shading.power=table", "material.glossiness=0.995"}, {NULL}},
};

static const struct tl_exhibit a11[] = {
    {"A11", "tangent space, edges of 4 cm", {"shading.space=tangent", "cloth.edge_m=0.04"}, {NULL}},
    {"A11", "tangent space, edges of 2 cm", {"shading.space=tangent", "cloth.edge_m=0.02"}, {NULL}},
    {"A11", "tangent space, edges of 1 cm", {"shading.space=tangent", "cloth.edge_m=0.01"}, {NULL}},
};

static const struct tl_exhibit a12[] = {
    {"A12", "step", {"shading.self_shadow=step"}, {NULL}},
    {"A12", "ramp", {"shading.self_shadow=ramp"}, {NULL}},
};

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

static const struct tl_exhibit b3[] = {
    {"B3", "cube, down to 4 texels a face", {"maps.size=4"}, {NULL}},
    {"B3", "cube, 16", {"maps.size=16"}, {NULL}},
    {"B3", "paraboloid, down to 4 texels", {"maps.layout=paraboloid", "maps.size=4"}, {NULL}},
    {"B3", "paraboloid, 16", {"maps.layout=paraboloid", "maps.size=16"}, {NULL}},
    {"B3", "sphere, 16", {"maps.layout=sphere", "maps.size=16"}, {NULL}},
};

static const struct tl_exhibit b4[] = {
    {"B4", "paraboloid, looked up directly", {"maps.look_up=direct"}, {NULL}},
    {"B4", "paraboloid, projective matrix", {"maps.look_up=matrix"}, {NULL}},
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

static const struct tl_exhibit b2[] = {
    {"B2", "the environment alone", {"maps.capture_every=0"}, {NULL}},
    {"B2", "captured every frame", {"maps.capture_every=1"}, {NULL}},
};

static const struct tl_exhibit b6[] = {
    {"B6", "index 1.5, additive", {"maps.fresnel=additive", "material.index=1.5"}, {NULL}},
    {"B6", "index 1.5, coat", {"maps.fresnel=coat", "material.index=1.5"}, {NULL}},
    {"B6", "index 200, additive", {"maps.fresnel=additive", "material.index=200"}, {NULL}},
    {"B6", "index 200, coat", {"maps.fresnel=coat", "material.index=200"}, {NULL}},
};

static const struct tl_exhibit b7[] = {
    {"B7", "smooth", {"weave.pattern=none"}, {NULL}},
    {"B7", "woven, glossy", {BUMPY}, {NULL}},
    {"B7", "woven, mirror", {BUMPY, "maps.mode=mirror"}, {NULL}},
};

/* ---- C: fabric detail ---- */

static const struct tl_exhibit c1[] = {
    {"C1", "normal map by finite differences", {"detail.mode=normal"}, {NULL}},
    {"C2", "Blinn's perturbed normal", {"detail.mode=blinn"}, {NULL}},
    {"C1", "normal map, bumps twice as high", {"detail.mode=normal", "detail.height_scale=2"}, {NULL}},
    {"C1", "normal map, half as high", {"detail.mode=normal", "detail.height_scale=0.5"}, {NULL}},
};

static const struct tl_exhibit c3[] = {
    {"C3", "frames of edges of 4 cm", {"cloth.edge_m=0.04"}, {NULL}},
    {"C3", "frames of edges of 2 cm", {"cloth.edge_m=0.02"}, {NULL}},
    {"C3", "frames of edges of 1 cm", {"cloth.edge_m=0.01"}, {NULL}},
};

static const struct tl_exhibit c4[] = {
    {"C4", "normal map alone", {"detail.mode=normal"}, {NULL}},
    {"C4", "parallax", {"detail.mode=parallax"}, {NULL}},
    {"C4", "offset-limited parallax", {"detail.mode=parallax_limited"}, {NULL}},
};

static const struct tl_exhibit c5[] = {
    {"C5", "no shadow", {"detail.shadow=none"}, {NULL}},
    {"C5", "horizon map, 8 angles", {"detail.shadow=horizon", "detail.angles=8"}, {NULL}},
    {"C5", "horizon map, 16 angles", {"detail.shadow=horizon", "detail.angles=16"}, {NULL}},
    {"C5", "horizon map, 32 angles", {"detail.shadow=horizon", "detail.angles=32"}, {NULL}},
    {"C5", "relief, 32 steps", {"detail.shadow=relief", "detail.steps=32"}, {NULL}},
};

static const struct tl_exhibit c6[] = {
    {"C6", "4 steps", {"detail.steps=4", "detail.refine=0"}, {NULL}},
    {"C6", "4 steps, refined", {"detail.steps=4", "detail.refine=5"}, {NULL}},
    {"C6", "16 steps", {"detail.steps=16", "detail.refine=0"}, {NULL}},
    {"C6", "16 steps, refined", {"detail.steps=16", "detail.refine=5"}, {NULL}},
    {"C6", "64 steps, refined", {"detail.steps=64", "detail.refine=5"}, {NULL}},
};

static const struct tl_exhibit c7[] = {
    {"C7", "all yarns alike", {NULL}, {NULL}},
    {"C7", "matt weft", {"weave.weft_gloss=-0.6"}, {NULL}},
    {"C7", "matt warp", {"weave.warp_gloss=-0.6"}, {NULL}},
};

static const struct tl_exhibit c8[] = {
    {"C8", "no widening", {"detail.minify=none"}, {NULL}},
    {"C8", "Toksvig", {"detail.minify=toksvig"}, {NULL}},
    {"C8", "LEAN", {"detail.minify=lean"}, {NULL}},
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
    {.name = "a1",
     .heading = "A1  Torrance-Sparrow from two tables",
     .text = "F D and G / (pi cos b) in a table each, multiplied per pixel [Heidrich and Seidel 1999, "
             "section 3.1]. "
             "Exact is the formula itself.",
     .solid = "torus",
     .base = {LAMPLIT, "material.model=torrance_sparrow", "material.fresnel=dielectric",
              "material.width_weft=0.3", "material.specular=[1, 1, 1]"},
     .exact = {"shading.reflectance=direct"},
     WALL(a1),
     .figures = tl_gallery_table_figures},
    {.name = "a2",
     .heading = "A2  The factor that has no bound",
     .text = "G / (pi cos b) grows without bound towards grazing views. Cut at 1, as fixed-point hardware "
             "does, it "
             "darkens them; divided by its greatest value and multiplied back it does not, but spends its "
             "bits there. "
             "The lamp stands behind, where it shows.",
     .solid = "torus",
     .base = {LAMPLIT, "material.model=torrance_sparrow", "material.width_weft=0.2",
              "material.specular=[1, 1, 1]", "lamp.yaw_deg=190", "lamp.pitch_deg=25",
              "shading.reflectance=table", "shading.table_precision=fixed8"},
     .exact = {"shading.reflectance=direct"},
     WALL(a2),
     .figures = tl_gallery_grazing_figures},
    {.name = "a3",
     .heading = "A3  Phong, Blinn-Phong and cosine lobe",
     .text = "One table each. Exact is the formula.",
     .solid = "torus",
     .base = {LAMPLIT, "shading.reflectance=table", "material.specular=[0.15, 0.15, 0.15]"},
     .exact = {"shading.reflectance=direct"},
     WALL(a3),
     .figures = tl_gallery_folded_figures},
    {.name = "a4",
     .heading = "A4  Ward's elliptical Gaussian",
     .text = "Facets spread unlike along weft and warp: the highlight lies across the narrower. Exact is the "
             "formula.",
     .solid = "sphere",
     .base = {LAMPLIT, "material.model=ward", "material.specular=[0.15, 0.15, 0.15]"},
     .exact = {"shading.reflectance=direct"},
     WALL(a4)},
    {.name = "a5",
     .heading = "A5  Banks's threads",
     .text = "A thread has no normal but a circle of them; the one in the plane of thread and lamp counts.",
     .solid = "sphere",
     .base = {LAMPLIT, "material.model=banks", "material.specular=[0.15, 0.15, 0.15]"},
     .exact = {"shading.reflectance=direct"},
     WALL(a5)},
    {.name = "a6",
     .heading = "A6  Where table coordinates come from",
     .text = "One texture matrix for a lamp and a viewer far away; per vertex with a local viewer; per "
             "pixel. Exact is "
             "the last, evaluated directly.",
     .solid = "torus",
     .base = {LAMPLIT, "shading.reflectance=table", "material.model=blinn_phong",
              "material.specular=[0.15, 0.15, 0.15]"},
     .exact = {"shading.coordinates=pixel", "shading.reflectance=direct"},
     WALL(a6)},
    {.name = "a7",
     .heading = "A7  Passes",
     .text = "Hardware with one texture a pass multiplies the factors by blending; what the target cannot "
             "hold is lost.",
     .solid = "torus",
     .base = {LAMPLIT, "shading.reflectance=table", "material.model=torrance_sparrow",
              "material.width_weft=0.3", "material.specular=[1, 1, 1]"},
     .exact = {"shading.max_textures_per_pass=4", "shading.pass_target=float"},
     WALL(a7)},
    {.name = "a8",
     .heading = "A8  How often light is evaluated",
     .text = "At vertices the highlight is lost first; interpolated vectors that are not made unit again dim "
             "it between "
             "vertices. Exact is Phong shading on the same mesh.",
     .solid = "torus",
     .base = {LAMPLIT, "material.specular=[0.15, 0.15, 0.15]"},
     .exact = {"shading.frequency=phong"},
     WALL(a8)},
    {.name = "a9",
     .heading = "A9  Making interpolated vectors unit",
     .text = "As in figure 9 of [001]: one step of Newton's is better than the cube map of 8 bits as long as "
             "less than 38 "
             "degrees lie between vertices, the one of 16 bits is nearly exact. Edges of 1.5 cm; folds turn "
             "more.",
     .solid = "torus",
     .base = {LAMPLIT, "material.specular=[0.15, 0.15, 0.15]", "cloth.edge_m=0.008"},
     .exact = {"shading.normalisation=exact"},
     WALL(a9),
     .figures = tl_gallery_normalise_figures},
    {.name = "a10",
     .heading = "A10  Powers of little precision",
     .text = "As in figure 10 of [001]: repeated squaring in fixed point bands, a table with linear "
             "interpolation is weak "
             "where the power is steep.",
     .solid = "sphere",
     .base = {LAMPLIT, "material.specular=[0.2, 0.2, 0.2]"},
     .exact = {"shading.power=pow"},
     WALL(a10),
     .figures = tl_gallery_power_figures},
    {.name = "a11",
     .heading = "A11  In which space",
     .text = "Vectors taken into tangent space at vertices and interpolated, against lighting in the world "
             "at every "
             "pixel: what differs is how the frame turns across a triangle.",
     .solid = "torus",
     .base = {LAMPLIT, BUMPY, "material.specular=[0.15, 0.15, 0.15]"},
     .exact = {"shading.space=world"},
     WALL(a11)},
    {.name = "a12",
     .heading = "A12  A bumped surface's own shadow",
     .text = "Light ends at the horizon of the smooth surface, at once or along a steep ramp. Exact is the "
             "step; the "
             "ramp's difference is its width. The lamp stands to the side.",
     .solid = "torus",
     .base = {LAMPLIT, BUMPY, "lamp.yaw_deg=-70", "lamp.pitch_deg=10"},
     .exact = {"shading.self_shadow=step"},
     WALL(a12)},
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
    {.name = "b3",
     .heading = "B3  Levels that keep the light",
     .text = "Texels weigh by their solid angle when a map shrinks [op. cit., eq. 6], so that even a few "
             "texels hold the "
             "diffuse light. Exact is a cube of 256 texels a face.",
     .solid = "sphere",
     .base = {"light.method=maps", "maps.mode=diffuse"},
     .exact = {"maps.layout=cube", "maps.size=256"},
     .one_truth = true,
     WALL(b3)},
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
     .by_flip = true,
     WALL(b5)},
    {.name = "b2",
     .heading = "B2  The scene in its own map",
     .text = "A cube drawn from the middle of the scene instead of the environment alone, so that what "
             "stands around is "
             "mirrored. Exact is a capture in every frame.",
     .solid = "torus",
     .base = {"light.method=maps", "maps.mode=mirror", "image.ground=true"},
     .exact = {"maps.capture_every=1"},
     .by_flip = true,
     WALL(b2)},
    {.name = "b6",
     .heading = "B6  Fresnel's term from a table of one row",
     .text = "The indices of the paper's figure 7. Added to what lies below, energy is made from nothing at "
             "grazing "
             "angles; a coat lets through only the rest. Exact is the same from a cube of 256 texels a face.",
     .solid = "torus",
     .base = {"light.method=maps", "maps.size=128", "material.fresnel=dielectric",
              "material.specular=[1, 1, 1]"},
     .exact = {"maps.size=256"},
     WALL(b6),
     .figures = tl_gallery_fresnel_figures},
    {.name = "b7",
     .heading = "B7  Bumps under an environment",
     .text = "Normal maps in a frame that is made anew every frame, looked up in world space at every pixel. "
             "Exact: a "
             "cube of 256 texels a face.",
     .solid = "torus",
     .base = {"light.method=maps", "maps.size=128"},
     .exact = {"maps.size=256"},
     .by_flip = true,
     WALL(b7)},
    {.name = "c1",
     .heading = "C1, C2  Heights as normals",
     .text =
         "A weave of yarns 8 mm apart. Exact is Blinn's perturbed normal at every pixel, which knows how the "
         "parametrisation stretches; the normal map assumes square patches.",
     .solid = "torus",
     .base = {LAMPLIT, BUMPY},
     .exact = {"detail.mode=blinn"},
     WALL(c1)},
    {.name = "c3",
     .heading = "C3  Frames made anew every frame",
     .text = "A highlight that follows the threads, on the coarser meshes against the finest of the same "
             "kind: exact is the "
             "ray-traced reference of the same mesh.",
     .solid = "torus",
     .base = {"material.model=ward", "material.width_weft=0.4", "material.width_warp=0.1",
              "material.specular=[0.15, 0.15, 0.15]"},
     .exact = {"light.method=reference"},
     WALL(c3)},
    {.name = "c4",
     .heading = "C4  Parallax",
     .text = "Looking up where the view meets the mean height moves bumps as one moves; limiting the shift "
             "tames it at "
             "grazing views. Exact is relief mapping with 256 steps.",
     .solid = "torus",
     .base = {LAMPLIT, COARSE},
     .exact = {"detail.mode=relief", "detail.steps=256", "detail.refine=8"},
     WALL(c4)},
    {.name = "c5",
     .heading = "C5  Shadows of bumps",
     .text = "Horizon angles baked for some directions a texel, front and back, against a march through the "
             "heights. Exact is the march with 256 steps. Between two directions a horizon's slope is linear "
             "in the direction, which is right for a straight yarn; near the terminator, where the lamp "
             "stands lowest over the cloth, eight of them still miss the gaps between yarns.",
     .solid = "torus",
     .base = {LAMPLIT, COARSE, "detail.mode=relief", "lamp.yaw_deg=-70", "lamp.pitch_deg=20"},
     .exact = {"detail.shadow=relief", "detail.steps=256"},
     WALL(c5)},
    {.name = "c6",
     .heading = "C6  Relief by number of steps",
     .text =
         "From cone to cone, each so wide that a ray goes under the field once at most before it leaves it; "
         "then halvings of the last step. Exact is 256 steps.",
     .solid = "torus",
     .base = {LAMPLIT, COARSE, "detail.mode=relief"},
     .exact = {"detail.steps=256", "detail.refine=8"},
     WALL(c6)},
    {.name = "c7",
     .heading = "C7  Yarns that differ in gloss",
     .text = "Glossiness per texel. Exact is the ray-traced reference.",
     .solid = "torus",
     .base = {BUMPY},
     .exact = {"light.method=reference"},
     WALL(c7)},
    {.name = "c8",
     .heading = "C8  A fine weave far away",
     .text = "Yarns 2.4 mm apart, not two pixels. Bumps that vanish leave plastic; roughness widened "
             "by the spread of "
             "their normals keeps the cloth. Exact is 8 x 8 samples a pixel.",
     .solid = "torus",
     .base = {LAMPLIT, "weave.pattern=plain", "weave.warp_pitch_mm=2.4", "weave.weft_pitch_mm=2.4",
              "weave.crimp_mm=0.6", "material.specular=[0.15, 0.15, 0.15]"},
     .exact = {"image.supersample=8", "detail.minify=none"},
     WALL(c8)},
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
