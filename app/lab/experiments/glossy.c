/* Glossy self-shadowing with partial environment maps, step by step [Knuth et al. 2014], what goes beyond it,
 * the solvers of the cloth, and what a time budget gives up. Ids D1 to D8, D12 to D16, E2, F2. */
#include "app/lab/experiments/rows_internal.h"

/* The paper's sum with nothing approximated but what a section is about: exact lobes, plain shadow maps. */
#define EXACT_LOBES "light.prefilter=slices", "light.visibility=depth"
#define RAYS(...)   PRESET("review", "light.bounce=off", __VA_ARGS__)

static const struct tl_technique techniques[] = {
    {.picture = "12 regions", .id = "D1", SET("light.regions=12")},
    {.picture = "48 regions", .id = "D1", SET("light.regions=48")},
    {.picture = "192 regions", .id = "D1", SET("light.regions=192")},
    {.picture = "48 regions, cut by variance", .id = "D1", SET("light.regions=48", "light.cut=sphere")},

    {.picture = "no filter", .id = "D2", SET("light.filter=none")},
    {.picture = "Gauss", .id = "D2", SET("light.filter=gauss")},
    {.picture = "cosine", .id = "D2", SET("light.filter=cosine")},
    {.picture = "box", .id = "D2", SET("light.filter=box")},
    {.picture = "root of cosine", .id = "D2", SET("light.filter=sqrt_cosine")},

    {.picture = "variance maps of 64 texels", .id = "D5", SET("light.map_size=64")},
    {.picture = "variance maps of 256 texels", .id = "D5", SET("light.map_size=256")},
    {.picture = "256 texels, not blurred", .id = "D5", SET("light.map_size=256", "light.blur_m=0")},
    {.picture = "256 texels in half precision", .id = "D5", SET("light.map_size=256", "light.moments=half")},
    {.picture = "256 texels, leaks reduced",
     .id = "D5",
     SET("light.map_size=256", "light.bleed_reduction=0.2")},
    {.picture = "plain depth of 256 texels", .id = "D5", SET("light.map_size=256", "light.visibility=depth")},

    {.picture = "sum of regions", .id = "D6", SET("light.composition=sum")},
    {.picture = "sum, one PEM a pass", .id = "D6", SET("light.composition=sum", "light.pems_per_pass=1")},
    {.picture = "exact light less what is hidden", .id = "D6", SET("light.composition=difference")},
    {.picture = "exact light times its visible share", .id = "D6", SET("light.composition=ratio")},

    {.picture = "one lobe between normal and mirror", .id = "D7", SET("light.lobe=single")},
    {.picture = "two lobes", .id = "D7", SET("light.lobe=dual")},

    {.picture = "PEMs of 16 texels a side", .id = "D8", SET("light.pem_size=16")},
    {.picture = "PEMs of 64 texels a side", .id = "D8", SET("light.pem_size=64")},
    {.picture = "PEMs of 256 texels a side", .id = "D8", SET("light.pem_size=256")},

    {.picture = "48 regions by rays", .id = "D12", RAYS("light.regions=48")},
    {.picture = "192 regions by rays", .id = "D12", RAYS("light.regions=192")},
    {.picture = "192 regions, share at vertices", .id = "D12", RAYS("light.ratio_at=vertices")},
    {.picture = "192 regions, no repair", .id = "D12", RAYS("light.repair_rest=0")},

    {.picture = "the sun in its region", .id = "D13", RAYS("light.sun=false")},
    {.picture = "the sun by rays of its own", .id = "D13", RAYS("light.sun=true")},

    {.picture = "what a mirror hits is black", .id = "D14", RAYS("light.reflect_scene=false")},
    {.picture = "what a mirror hits is lit", .id = "D14", RAYS("light.reflect_scene=true")},

    {.picture = "no bounces", .id = "D15", PRESET("review", "light.bounce=off")},
    {.picture = "one bounce", .id = "D15", PRESET("review", "light.bounce=one")},
    {.picture = "all bounces", .id = "D15", PRESET("review", "light.bounce=all")},

    {.picture = "PEMs as cube maps", .id = "D16", SET("light.pem_layout=cube")},
    {.picture = "PEMs as cropped paraboloids", .id = "D16", SET("light.pem_layout=paraboloid")},

    {.picture = "preview", .id = "E2", SET("cloth.solver=preview")},
    {.picture = "settle", .id = "E2", SET("cloth.solver=settle")},

    {.picture = "scale 0.35", .id = "F2", SET("image.scale=0.35")},
    {.picture = "scale 0.5", .id = "F2", SET("image.scale=0.5")},
    {.picture = "scale 0.7", .id = "F2", SET("image.scale=0.7")},
    {.picture = "24 regions", .id = "F2", SET("light.regions=24")},
    {.picture = "full quality", .id = "F2"},
};

#define GREY(diffuse, specular)                                                                              \
    "material.diffuse=[" diffuse ", " diffuse ", " diffuse "]",                                              \
        "material.specular=[" specular ", " specular ", " specular "]"

static const struct tl_experiment_appearance glosses[] = {
    {.title = "glossiness 0.3", .assignments = {"material.glossiness=0.3"}},
    {.title = "glossiness 0.95", .assignments = {"material.glossiness=0.95"}},
};

static const struct tl_experiment_appearance narrow[] = {
    {.title = "glossiness 0.95", .assignments = {"material.glossiness=0.95"}},
    {.title = "glossiness 0.99", .assignments = {"material.glossiness=0.99"}},
};

static const struct tl_experiment experiments[] = {
    {.output = TL_OUTPUT_PICTURES,
     .name = "d1",
     .scene = "gallery",
     .title = "D1  Cutting the environment into regions",
     .text = "The environment is cut into regions of about equal light, and each casts one shadow. Lobes are "
             "exact and shadow maps plain, so that the number of regions is what differs.",
     .exact_text = "ray traced",
     .claims = {{"48 regions", "12 regions", "The design of this program"},
                {"192 regions", "48 regions", "The design of this program"}},
     .solid = "torus",
     .base = {"scene.preset=paper", "light.lobe=dual", "image.ground=true", GREY("0.4", "0.2"), EXACT_LOBES},
     .reference = {.assignments = {TRACED, FEW_SAMPLES}},
     .reference_alone = true,
     .side = 384,
     .ids = {"D1"},
     TECHNIQUES(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "d2",
     .scene = "gallery",
     .title = "D2  Filters between the levels of a PEM",
     .text =
         "Each level of a PEM is half as large as the one before and filtered across the borders of faces; "
         "what a lobe reads is the level of its width.",
     .exact_text = "the same regions and shadows with exact lobes, each by direct convolution (D4)",
     .claims = {{"root of cosine", "box", "Section 5 of [002]"},
                {"root of cosine", "no filter", "Section 5 of [002]"}},
     .solid = "sphere",
     .base = {"scene.preset=paper", "light.lobe=dual", "light.regions=24", GREY("0.3", "0.5"),
              "material.glossiness=0.95"},
     .reference = {.assignments = {"light.prefilter=slices"}},
     .reference_alone = true,
     .side = 384,
     .ids = {"D2"},
     TECHNIQUES(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "d5",
     .scene = "gallery",
     .title = "D5  Shadows from moments of depth",
     .text =
         "Each region has a map of the mean of depth and of its square; Chebyshev's inequality bounds the "
         "visible share from the two. Moments in half precision take half the memory (D8). A blur as wide as "
         "the region softens the shadow. Matt cloth on a "
         "matt ground, exact lobes.",
     .exact_text = "ray traced",
     .claims = {{"variance maps of 256 texels", "variance maps of 64 texels", "The design of this program"},
                {"variance maps of 256 texels", "256 texels, not blurred", "The design of this program"},
                {"variance maps of 256 texels", "256 texels in half precision",
                 "The design of this program"}},
     .solid = "torus",
     .base = {"scene.preset=paper", "light.lobe=dual", "image.ground=true", GREY("0.5", "0"),
              "light.prefilter=slices"},
     .reference = {.assignments = {TRACED, FEW_SAMPLES}},
     .reference_alone = true,
     .side = 384,
     .ids = {"D5"},
     TECHNIQUES(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "d6",
     .scene = "gallery",
     .title = "D6  Adding the regions up",
     .text =
         "The paper adds the shadowed light of all regions, twelve PEMs a pass. The same regions also give "
         "the share of the exact light that is hidden, or that is visible.",
     .exact_text = "ray traced",
     .solid = "torus",
     .base = {"scene.preset=paper", "light.lobe=dual", GREY("0.4", "0.2"), "material.glossiness=0.7",
              EXACT_LOBES},
     .reference = {.assignments = {TRACED, FEW_SAMPLES}},
     .reference_alone = true,
     .side = 384,
     .ids = {"D6"},
     TECHNIQUES(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "d7",
     .scene = "gallery",
     .title = "D7  One lobe or two",
     .text =
         "One look-up between normal and mirror direction by glossiness, or a diffuse and a glossy one. They "
         "are two materials: each is compared with its own.",
     .exact_text = "the same lobes ray traced",
     .solid = "torus",
     .base = {"scene.preset=paper", GREY("0.4", "0.3"), EXACT_LOBES},
     .reference = {.assignments = {"light.method=reference", FEW_SAMPLES}},
     .side = 384,
     .ids = {"D7"},
     APPEARANCES(glosses),
     TECHNIQUES(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "d8",
     .scene = "gallery",
     .title = "D8  Memory",
     .text = "Twice the side of a PEM takes four times the memory; a narrow lobe shows what that gives. The "
             "table "
             "below has the bytes of all regions.",
     .exact_text = "the same regions and shadows with exact lobes, each by direct convolution (D4)",
     .claims = {{"PEMs of 64 texels a side", "PEMs of 16 texels a side", "The design of this program"},
                {"PEMs of 256 texels a side", "PEMs of 64 texels a side", "The design of this program"}},
     .solid = "sphere",
     .base = {"scene.preset=paper", "light.lobe=dual", "light.regions=24", GREY("0.1", "0.8"),
              "material.glossiness=0.99"},
     .reference = {.assignments = {"light.prefilter=slices"}},
     .reference_alone = true,
     .side = 384,
     .ids = {"D8"},
     TECHNIQUES(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "d12",
     .scene = "gallery",
     .title = "D12  Visibility kept at vertices",
     .text =
         "Rays towards every region are kept with the vertices; at each sample the exact light is multiplied "
         "by its visible share.",
     .exact_text = "ray traced",
     .claims = {{"192 regions by rays", "48 regions by rays", "The cache's design"}},
     .solid = "torus",
     .base = {"image.ground=true", GREY("0.4", "0.2"), "material.glossiness=0.7", "light.bounce=off"},
     .reference = {.assignments = {TRACED, FEW_SAMPLES}},
     .reference_alone = true,
     .side = 384,
     .ids = {"D12"},
     TECHNIQUES(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "d13",
     .scene = "gallery",
     .title = "D13  A sun of its own",
     .text =
         "The studio's small strong lamp stays in its region, as wide as that is, or leaves it and casts its "
         "own shadow.",
     .exact_text = "ray traced",
     .claims = {{"the sun by rays of its own", "the sun in its region", "The design of this program"}},
     .solid = "torus",
     .base = {"image.ground=true", GREY("0.4", "0"), "light.bounce=off"},
     .reference = {.assignments = {TRACED, FEW_SAMPLES}},
     .reference_alone = true,
     .side = 384,
     .ids = {"D13"},
     TECHNIQUES(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "d14",
     .scene = "gallery",
     .title = "D14  Near mirrors",
     .text =
         "A lobe of exponent 200 and more is one ray. In the paper what it hits is black; here it is lit.",
     .exact_text = "ray traced, what mirrors hit lit",
     .claims = {{"what a mirror hits is lit", "what a mirror hits is black", "The design of this program"}},
     .solid = "torus",
     .base = {"image.ground=true", GREY("0.1", "0.8"), "material.glossiness=0.998", "light.bounce=off"},
     .reference = {.assignments = {TRACED, "light.reflect_scene=true", FEW_SAMPLES,
                                   "reference.lobe_samples=16"}},
     .by_flip = true,
     .reference_alone = true,
     .side = 384,
     .ids = {"D14"},
     TECHNIQUES(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "d15",
     .scene = "gallery",
     .title = "D15  Light between surfaces",
     .text =
         "White cloth on a grey ground: light that surfaces send on to each other, not at all, once, or as "
         "often as it likes.",
     .exact_text = "ray traced with four bounces",
     .claims = {{"one bounce", "no bounces", "Conservation of energy"},
                {"all bounces", "one bounce", "Conservation of energy"}},
     .solid = "torus",
     .base = {"image.ground=true", GREY("0.8", "0")},
     .reference = {.assignments = {TRACED, "light.bounce=all", FEW_SAMPLES, "reference.bounce_samples=4"}},
     .reference_alone = true,
     .side = 256,
     .ids = {"D15"},
     TECHNIQUES(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "d16",
     .scene = "gallery",
     .title = "D16  PEMs as cropped paraboloid maps",
     .text =
         "A PEM is black but for its region and what the filters spread its light over. Each level is stored "
         "as parts of paraboloid maps, cropped to that, twice as dense as the cube. The table below has the "
         "bytes of both.",
     .exact_text = "the same regions and shadows with exact lobes, each by direct convolution (D4)",
     .solid = "sphere",
     .base = {"scene.preset=paper", "light.lobe=dual", "light.regions=24", GREY("0.1", "0.8")},
     .reference = {.assignments = {"light.prefilter=slices"}},
     .reference_alone = true,
     .side = 384,
     .ids = {"D16"},
     APPEARANCES(narrow),
     TECHNIQUES(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "e2",
     .scene = "gallery",
     .title = "E2  Solvers of the cloth",
     .text = "Three integrators over one energy. The sheet falls over the ball and comes to rest; the solid "
             "is no "
             "cloth and stays equal.",
     .exact_text = "the solver `reference`, whose step follows the fabric's stiffness",
     .motion = TL_MOTION_CLOTH,
     .motion_step = 4,
     .solid = "torus",
     .base = {LAMPLIT, "cloth.edge_m=0.02", "material.glossiness=0.5"},
     .reference = {.assignments = {"cloth.solver=reference"}},
     .by_flip = true,
     .side = 384,
     .ids = {"E2"},
     TECHNIQUES(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "f2",
     .scene = "gallery",
     .title = "F2  What a time budget gives up",
     .text =
         "Under a budget a frame has fewer samples, or fewer regions; the rows' times are what each gains.",
     .exact_text = "ray traced",
     .claims = {{"scale 0.7", "scale 0.5", "The planner of this program"},
                {"full quality", "24 regions", "The planner of this program"}},
     .solid = "torus",
     .base = {"image.ground=true", "light.bounce=off", "weave.pattern=twill", "weave.warp_pitch_mm=8",
              "weave.weft_pitch_mm=8", "weave.crimp_mm=1"},
     .reference = {.assignments = {TRACED, FEW_SAMPLES}},
     .reference_alone = true,
     .by_flip = true,
     .side = 384,
     .ids = {"F2"},
     TECHNIQUES(techniques)},
};
const struct tl_experiment_list tl_glossy_experiments = {experiments, TL_COUNT(experiments)};
