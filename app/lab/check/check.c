#include "app/lab/check/check.h"

#include "app/lab/check/check_measures.h"
#include "app/lab/truth/truth.h"
#include "config/base/hash.h"
#include "config/base/memory.h"

#include <assert.h>
#include <math.h>

/* The bound depends on the settings: the function sets it. */
#define BY_SETTINGS NAN

/* A row reads name, what must hold: what is measured, bound, reason of the bound, needs an image, function.
 */
const struct tl_invariant tl_invariants[] = {
    {"surface.finite", "positions, normals, tangents and UVs are finite: number of values that are not", 0,
     "a NaN spreads over the image", false, tl_measure_finite},
    {"surface.normals", "normals have unit length: |length - 1|", 1e-4,
     "frames.h guarantees 1e-5; ten times that is a thousandth of a half float's step in the G-buffer", false,
     tl_measure_normals},
    {"surface.sides", "normals are the angle-weighted mean of their faces, on the same side: 1 - cosine",
     1e-4,
     "0.8 degrees: positions are rounded to 1e-7 m, which turns a face of 1 mm by 1e-4, and by 1e-2 the mean "
     "of faces that cancel to a hundredth",
     false, tl_measure_sides},
    {"surface.tangents",
     "tangents have unit length, are perpendicular to normals, and have w = 1 or -1: largest deviation", 1e-4,
     "as surface.normals", false, tl_measure_tangents},
    {"surface.handed",
     "tangents run along u, and w is the handedness of the UVs: vertices where no face agrees", 0,
     "a mean of directions is within 90 degrees of at least one of them", false, tl_measure_handed},
    {"image.finite", "pixels are finite: number of values that are not", 0, "a NaN spreads in every filter",
     true, tl_measure_pixels},
    {"image.coverage", "alpha lies in [0, 1]: largest distance outside", 1e-6,
     "rounding of a mean of a few shares", true, tl_measure_coverage},
    {"image.negative", "radiance is not negative: largest amount below 0", 0, "negative light does not exist",
     true, tl_measure_negative},
    {"image.fresh", "an image that reuses earlier results equals the image of a new renderer: relative RMSE",
     BY_SETTINGS,
     "maps: equal up to rounding; rays: two images, each with the error that `toile bench light` reports",
     true, tl_measure_fresh},
    {"image.oracle",
     "the image equals the ray-traced reference in every covered pixel: relative RMSE less the reference's "
     "own",
     BY_SETTINGS,
     "1 to 4 % are usual by rays; 21 % where a few small lamps are all light, whose glints at grazing angles "
     "end "
     "elsewhere; 12 % by maps. --baseline makes it that of the scene",
     true, tl_measure_oracle},
    {"image.mean",
     "the image is as bright as the reference, and the garment in it: relative difference of their light, "
     "less three "
     "standard errors, of the worst channel",
     BY_SETTINGS, "at most 6 % by rays, and 20 % by maps, in the same scenes", true, tl_measure_mean},
    {"image.patch",
     "no patch differs from the reference: of four tiles of 4 x 4 pixels in a square the least difference of "
     "means, less "
     "three standard errors, relative to the sum of the means of tile and image",
     BY_SETTINGS, "a black patch gives 0.5; at most half of the bound in the same scenes", true,
     tl_measure_patch},
    {"image.tile", "no tile of 4 x 4 pixels differs from the reference: the same, of every tile alone",
     BY_SETTINGS,
     "0.1 to 0.2 are usual by rays, 1.2 at a rim of light of a small lamp; --baseline makes it that of the "
     "scene",
     true, tl_measure_tile},
    {"image.place", "outlines lie where the reference's do: displacement, pixels", BY_SETTINGS,
     "0.003 is usual; half a pixel reads as 0.3, because edges are sharper than their gradients", true,
     tl_measure_place},
    {"maps.moments",
     "shadow maps hold finite depths with E[z^2] >= E[z]^2: largest violation, relative to E[z^2]",
     BY_SETTINGS,
     "sums of up to 129 weights in single precision, twice; moments rounded to half precision three times",
     true, tl_measure_moments},
    {"visibility.range", "VIS lies in [0, 1] for every sample, region and sun: largest distance outside",
     1e-5, "rounding of four weights that sum to 1", true, tl_measure_visibility},
    {"visibility.regions",
     "VIS of a region, averaged over the sampled points, equals what rays find: difference from the mean "
     "over directions of the region, less three standard deviations of one direction, times the region's "
     "light relative to the mean region's (at most 1)",
     0.15,
     "cached values are a few frames old and belong to vertices: at most 0.10 in 7300 cases of dress, "
     "review, a T-shirt's motion and a walk, with 24 to 384 regions",
     true, tl_measure_leaks},
    {"visibility.age",
     "in motion VIS is renewed in turn: share of the light on the sampled points whose VIS is older than "
     "four "
     "rounds of the regions",
     0.1, "0.0004 is usual: late ones go first", true, tl_measure_age},
    {"light.environment", "cube and suns hold the light of the environment: relative difference", 0.01,
     "cube.h: a texel keeps its energy within 1 %", true, tl_measure_environment},
    {"light.regions", "the regions hold the light of the cube, each texel once: relative difference", 1e-4,
     "sums of 1e5 floats in blocks", true, tl_measure_regions},
    {"light.exact",
     "unshadowed light through a lobe equals the integral over the cube: largest difference, relative to the "
     "brightest",
     0.012, "interpolation between directions and exponents, under 1 % of a lobe (test_slices.c)", true,
     tl_measure_exact},
    {"light.sum",
     "the light P_i of all regions sums to that of the undivided environment: largest difference, relative "
     "to the brightest",
     0.012, "as light.exact", true, tl_measure_sum},
    {"light.slices",
     "each region's slice holds that region's light along its own direction: relative difference", 0.05,
     "interpolation and crop of a slice (test_slices.c)", true, tl_measure_slices},
    {"light.pems",
     "PEMs sum to the filtered undivided cube, texel by texel: difference, relative to texel plus mean", 1e-3,
     "half floats: each PEM is rounded by 2^-11 of itself at most", true, tl_measure_pems},
    {"furnace.albedo", "white light gives exactly the albedo where nothing shadows: largest difference", 0.01,
     "a uniform sky through merged cells: 0.7 % (test_lobes.c); half floats", true, tl_measure_furnace},
    {"furnace.shadowed", "shadows never add white light: largest increase", 0.01, "as furnace.albedo", true,
     tl_measure_furnace_shadowed},
    {"cloth.strain", "no edge is longer or shorter than cloth can be: largest strain", BY_SETTINGS,
     "0.5, or twice the solver's strain limit; 1 in frame 0, and 1.25 times frame 0 later; 1 when a budget "
     "reduces substeps; 3 TL_HAND_STRAIN when a hand holds the cloth; TL_CAUGHT_STRAIN when a moving wearer "
     "drags it; TL_CLOTH_MAX_STRAIN when particles are caught",
     false, tl_measure_strain},
    {"cloth.stretch",
     "the weave as a whole is neither stretched nor crushed: root mean square strain of the edges",
     BY_SETTINGS, "the solver's strain limit, at least 0.1", false, tl_measure_stretch},
    {"cloth.inside", "no particle is below the avatar's skin or the ground: largest depth, metres", 1e-3,
     "a third of the contact distance; the skin of a moving body is followed in steps", false,
     tl_measure_inside},
    {"cloth.crossing", "the cloth does not pass through itself: pairs of triangles that cross", 0,
     "planes separate what is near, and nothing else can reach (cloth/self_contact/self_contact.h)", false,
     tl_measure_crossing},
    {"cloth.seams", "no seam is open: pairs of vertices that are apart", 0,
     "sewing welds what meets, and draws until it has met", false, tl_measure_seams},
    {"cloth.energy",
     "kinetic and potential energy do not exceed the minimum of the total energy since something last drove "
     "the garment: gain, as the height in metres that it would lift the garment by",
     BY_SETTINGS, "a contact lifts a particle by the contact distance at most", false, tl_measure_energy},
    {"cloth.momentum",
     "a garment that falls freely falls vertically: horizontal displacement of its centre of mass, metres",
     1e-5,
     "internal forces and uniform drag sum to zero; rounding of positions to single precision leaves less "
     "than a tenth of it",
     false, tl_measure_momentum},
    {"cloth.fall",
     "alone in the air the garment falls as y'' = -g - damping y': difference of its centre of mass after a "
     "third "
     "of a second, and how far it went sideways, relative to the fall",
     BY_SETTINGS, "one hundredth, and the solver's step over the time: each step is wrong by half of itself",
     false, tl_measure_fall},
    {"cloth.droop",
     "strips of the fabric along weft and warp, clamped at one end, droop as the elastica of its bending "
     "stiffness and weight: difference of the end's height, relative to the droop",
     0.03, "strips of 20 cells: half of one hundredth with every solver (test_bending.c), and its step",
     false, tl_measure_droop},
    {"cloth.slide",
     "a sheet of the fabric slides down an incline as x'' = g (sin - friction cos) - damping x': difference "
     "of the way, relative to it",
     BY_SETTINGS, "two hundredths, and the solver's step over the time", false, tl_measure_slide},
    {"cloth.rest",
     "the garment begins as in the clean run that --baseline names: relative difference of its elastic "
     "energy",
     0.01, "the same code on the same scene gives the same to the bit; machines round differently", false,
     tl_measure_rest},
    {"cloth.speed", "no particle is faster than fall, wearer, hand and wind can make it: ratio", 1,
     "three times the sum of their speeds, for the end of a whip; plus, with the reference solver, which has "
     "no damping, the speed that its strain can become",
     false, tl_measure_speed},
    {"run.repeat", "a frame that is played again has the same positions and pixels: frames that differ", 0,
     "bit-identical, with any number of threads", true, tl_measure_repeat},
    {"plan.budget", "the predicted time of the chosen plan is within the budget, where any plan's is: ratio",
     1, "what the governor guarantees (app/budget/governor.h)", false, tl_measure_budget},
};
const size_t tl_invariant_count = TL_COUNT(tl_invariants);
static_assert(TL_COUNT(tl_invariants) <= TL_INVARIANTS_MAX, "room for every verdict");

/* The deviation relative to its bound; absolute where the bound is 0. */
static double severity(const struct tl_finding *finding)
{
    return finding->bound > 0 ? finding->worst / finding->bound : finding->worst;
}

/* A broken finding is worse than one that holds; then the larger severity is worse. */
static bool is_worse(const struct tl_verdict *verdict, const struct tl_finding *finding, bool ok)
{
    if (!verdict->finding.is_measured || verdict->ok != ok)
        return !verdict->finding.is_measured || !ok;
    return !isnan(verdict->finding.worst) && !(severity(finding) <= severity(&verdict->finding));
}

double tl_check_bound(const struct tl_check_baseline *baseline, size_t invariant, double general)
{
    const double share = 1.5, rest = 0.1;
    double own = share * baseline->worst[invariant] + rest * general;
    return own < general ? own : general; /* a NaN is not less */
}

/* Merges the finding of an invariant. Returns whether it holds, or was not measured. */
static bool measure(size_t number, const struct tl_checked *checked, struct tl_verdicts *verdicts,
                    struct tl_finding *finding)
{
    const struct tl_invariant *invariant = &tl_invariants[number];
    struct tl_verdict *verdict = &verdicts->items[number];
    *finding = (struct tl_finding){.bound = invariant->bound, .x = -1, .y = -1, .surface = -1};
    if (checked->image || !invariant->of_picture)
        invariant->measure(checked, finding);
    if (!finding->is_measured)
        return true;
    if (verdicts->baseline)
        finding->bound = tl_check_bound(verdicts->baseline, number, finding->bound);
    bool ok = finding->worst <= finding->bound;
    if (is_worse(verdict, finding, ok))
        *verdict = (struct tl_verdict){*finding, checked->number, ok};
    return ok;
}

static struct tl_truth compare(const struct tl_checked *checked)
{
    const tl_image *const images[] = {checked->image, checked->in_motion};
    struct tl_truth truth;
    tl_error error = {0};
    if (!tl_truth_compare(checked->frame, checked->settings, checked->renderer, images,
                          checked->in_motion ? 2 : 1, &truth, &error))
        truth = (struct tl_truth){
            .error = NAN, .mean_error = NAN, .garment_error = NAN, .tile_error = NAN, .patch_error = NAN};
    return truth;
}

int tl_check_frame(const struct tl_checked *frame, struct tl_verdicts *verdicts, struct tl_finding *broken)
{
    struct tl_checked checked = *frame;
    struct tl_truth truth;
    int first_broken = -1;
    if (checked.image && checked.is_sampled && !checked.is_reduced &&
        tl_truth_is_comparable(checked.settings)) {
        truth = compare(&checked);
        checked.truth = &truth;
    }
    for (size_t i = 0; i < tl_invariant_count; i++) {
        struct tl_finding finding;
        if (measure(i, &checked, verdicts, &finding) || first_broken >= 0)
            continue;
        first_broken = (int)i;
        if (broken)
            *broken = finding;
    }
    verdicts->frames++;
    return first_broken;
}

int tl_verdicts_failed(const struct tl_verdicts *verdicts)
{
    int failed = 0;
    for (size_t i = 0; i < tl_invariant_count; i++)
        failed += verdicts->items[i].finding.is_measured && !verdicts->items[i].ok;
    return failed;
}

uint64_t tl_check_hash(const tl_frame *frame, const tl_image *image)
{
    uint64_t hash = TL_HASH_START;
    for (size_t s = 0; s < frame->surface_count; s++)
        hash = tl_hash(hash, frame->surfaces[s].positions, frame->surfaces[s].vertex_count * sizeof(vec3s));
    return image ? tl_hash(hash, image->texels,
                           (size_t)image->width * (size_t)image->height * 4 * sizeof(float))
                 : hash;
}
