/* Methods of light: the 2014 algorithm's parameters, the back-ends that go beyond it, and other methods. Id
 * D9. */
#include "app/lab/experiments/rows_internal.h"

#define PAPER(...)     PRESET("paper", __VA_ARGS__)
#define PAPER_SLICES   "light.prefilter=slices"
#define SPHERE_CUT_SUN PAPER_SLICES, "light.visibility=depth", "light.cut=sphere", "light.sun=true"

static const struct tl_technique techniques[] = {
    {.page = "paper", .group = "presets", PAPER("light.regions=96"), .quick = true, .shown = true},
    /* One lobe is another material than the reference's two: its error is mostly that of the material. */
    {.page = "paper, a single lobe", .group = "presets", PAPER("light.lobe=single")},
    {.page = "draft", .group = "presets", PRESET("draft"), .quick = true},
    {.page = "review", .bound = "review", .group = "presets", PRESET("review"), .quick = true, .shown = true},
    {.page = "review by GL maps",
     .group = "back-end",
     SET("light.visibility=depth", "light.prefilter=slices", "light.composition=difference",
         "light.jitter=true", "light.refresh=0")},

    {.page = "paper N=6", .group = "regions, paper", PAPER("light.regions=6"), .quick = true},
    {.page = "paper N=24", .group = "regions, paper", PAPER("light.regions=24")},
    {.page = "paper N=48", .group = "regions, paper", PAPER("light.regions=48")},
    {.page = "paper N=96", .group = "regions, paper", PAPER(NULL)},
    {.page = "paper N=192", .group = "regions, paper", PAPER("light.regions=192")},
    {.page = "paper N=384", .group = "regions, paper", PAPER("light.regions=384", "light.map_size=128")},
    {.page = "rays N=24", .group = "regions, rays", PRESET("review", "light.regions=24", "light.refresh=6")},
    {.page = "rays N=48", .group = "regions, rays", PRESET("review", "light.regions=48", "light.refresh=6")},
    {.page = "rays N=96", .group = "regions, rays", PRESET("review", "light.regions=96", "light.refresh=12")},
    {.page = "rays N=192",
     .group = "regions, rays",
     PRESET("review", "light.regions=192", "light.refresh=24")},
    {.page = "rays N=384",
     .group = "regions, rays",
     PRESET("review", "light.regions=384", "light.refresh=48")},
    {.page = "rays N=384 all",
     .group = "regions, rays",
     PRESET("review", "light.regions=384", "light.refresh=0")},

    {.page = "paper, cubes", .group = "PEMs, paper", PAPER("light.pem_layout=cube")},
    {.page = "paper, paraboloids", .group = "PEMs, paper", PAPER("light.pem_layout=paraboloid")},

    {.page = "paper 32", .group = "map size", PAPER("light.map_size=32")},
    {.page = "paper 64", .group = "map size", PAPER("light.map_size=64"), .quick = true},
    {.page = "paper 128", .group = "map size", PAPER("light.map_size=128")},
    {.page = "paper 256", .group = "map size", PAPER(NULL)},
    {.page = "paper 512", .group = "map size", PAPER("light.map_size=512")},

    {.page = "no filter", .group = "filter", PAPER("light.filter=none")},
    {.page = "Gauss", .group = "filter", PAPER("light.filter=gauss")},
    {.page = "cosine", .group = "filter", PAPER("light.filter=cosine")},
    {.page = "box", .group = "filter", PAPER("light.filter=box")},
    {.page = "root of cosine", .group = "filter", PAPER(NULL)},
    {.page = "exact slices", .group = "filter", PAPER(PAPER_SLICES)},

    {.page = "vsm, unblurred", .group = "back-end", PAPER(PAPER_SLICES, "light.blur_m=0")},
    {.page = "vsm in full precision", .group = "back-end", PAPER(PAPER_SLICES, "light.moments=float")},
    {.page = "depth", .group = "back-end", PAPER(PAPER_SLICES, "light.visibility=depth")},
    {.page = "depth, sphere cut, sun", .group = "back-end", PAPER(SPHERE_CUT_SUN)},
    {.page = "depth, difference", .group = "back-end", PAPER(SPHERE_CUT_SUN, "light.composition=difference")},
    {.page = "depth, ratio", .group = "back-end", PAPER(SPHERE_CUT_SUN, "light.composition=ratio")},

    {.page = "rays, 64 rounds", .group = "rounds", PRESET("review", "light.jitter=true", "light.rounds=64")},
    {.page = "depth maps, 32 rounds",
     .group = "rounds",
     PAPER(PAPER_SLICES, "light.visibility=depth", "light.jitter=true", "light.rounds=32",
           "light.map_size=128")},

    {.page = "no occlusion",
     .group = "other methods",
     PRESET("review", "light.method=unshadowed"),
     .quick = true,
     .shown = true},
    {.page = "ambient occlusion",
     .group = "other methods",
     PRESET("review", "light.method=ao"),
     .shown = true},
    {.page = "ambient occlusion, coloured",
     .group = "other methods",
     PRESET("review", "light.method=ao_colour"),
     .shown = true},
    {.page = "lights", .group = "other methods", PAPER("light.method=lights"), .quick = true, .shown = true},

    /* In extreme scenes the paper's N = 96 at 128 texels shows nothing more, and takes four times as long. */
    {.bound = "paper", PAPER("light.regions=24", "light.pem_size=64")},
    {.bound = "unshadowed", PAPER("light.regions=24", "light.pem_size=64", "light.method=unshadowed")},
};

/* Figure 6: everything by the paper's method, but for the one option. */
static const struct tl_technique figure_6[] = {
    {.picture = "no occlusion", .id = "D9", SET("light.method=unshadowed")},
    {.picture = "ambient occlusion", .id = "D9", SET("light.method=ao")},
    {.picture = "ambient occlusion with colour", .id = "D9", SET("light.method=ao_colour")},
    {.picture = "lights instead of PEMs", .id = "D9", SET("light.method=lights")},
    {.picture = "the 2014 algorithm", .id = "D9", SET("light.method=pem")},
    {.picture = "the 2014 algorithm, exact lobes", .id = "D9", SET("light.method=pem", PAPER_SLICES)},
    {.picture = "PEMs by rays (review)", .id = "D9", SET("scene.preset=review", "light.bounce=off")},
};

#define EVEN(share) share ", " share ", " share
#define PLAIN(diffuse, specular, glossiness)                                                                 \
    "material.use_file=false", "material.diffuse=[" EVEN(diffuse) "]",                                       \
        "material.specular=[" EVEN(specular) "]", "material.glossiness=" glossiness

/* Three glossinesses in the scene's light; then two appearances whose image is one quantity of interest:
 * irradiance, and the visible share of a uniform sky. */
static const struct tl_experiment_appearance materials[] = {
    {.name = "g=0", .title = "glossiness 0", .assignments = {PLAIN("0.5", "0.5", "0")}},
    {.name = "g=0.7", .title = "glossiness 0.7", .assignments = {PLAIN("0.5", "0.5", "0.7")}},
    {.name = "g=0.95", .title = "glossiness 0.95", .assignments = {PLAIN("0.5", "0.5", "0.95")}},
    {.name = "irradiance", .title = "irradiance", .assignments = {PLAIN("1", "0", "0")}},
    {.name = "sky",
     .title = "visibility of a uniform sky",
     .assignments = {PLAIN("1", "0", "0")},
     .uniform_sky = true},
};

static const struct tl_experiment_appearance glossy[] = {
    {.title = "glossiness 0.99", .assignments = {PLAIN("0", "0.8", "0.99")}},
    {.title = "glossiness 0.95", .assignments = {PLAIN("0", "0.8", "0.95")}},
};

static const struct tl_experiment experiments[] = {
    {.output = TL_OUTPUT_PAGE,
     .name = "light",
     .title = "The trade of light: error against time",
     .text = FRONT,
     .scene = "review",
     .reference = {.assignments = {TRACED}},
     APPEARANCES(materials),
     .quick_appearance = 1,
     METHODS(techniques),
     .warm_up = 16,
     .measured = 3,
     .rests = true},
    /* Two replicates: a standard error of 0.5 %, for the bounds are wide. */
    {.output = TL_OUTPUT_BOUNDS,
     .name = "light",
     .scene = "review",
     .reference = {.assignments = {TRACED, "reference.replicates=2"}},
     METHODS(techniques)},
    {.output = TL_OUTPUT_PICTURES,
     .name = "d9",
     .scene = "gallery",
     .title = "D9  The comparison of figure 6",
     .source = "[Knuth et al. 2014, 5 and figure 6]",
     .text =
         "Cloth of a pure gloss, without a diffuse term and without bounces, by 96 regions. Rows differ by "
         "light.method alone, but for two: ambient occlusion has exact lobes in this program, and so has "
         "one row of the 2014 algorithm; the last row is the preset review.",
     .exact_text = "ray traced",
     .claims = {{"the 2014 algorithm", "no occlusion", "[Knuth et al. 2014, figure 6]"},
                {"the 2014 algorithm, exact lobes", "ambient occlusion with colour",
                 "[Knuth et al. 2014, figure 6]"},
                {"the 2014 algorithm", "lights instead of PEMs", "[Knuth et al. 2014, 3]",
                 "torus (glossiness 0.95)"}},
     .solid = "torus",
     .base = {"scene.preset=paper", "light.bounce=off"},
     .reference = {.assignments = {TRACED, FEW_SAMPLES}},
     .reference_alone = true,
     .side = 384,
     .ids = {"D9"},
     APPEARANCES(glossy),
     METHODS(figure_6)},
};
const struct tl_experiment_list tl_light_experiments = {experiments, TL_COUNT(experiments)};
