#include "app/lab/check/check.h"

#include "app/lab/check/check_measures.h"
#include "config/hash.h"
#include "config/memory.h"

#include <assert.h>
#include <math.h>

/* The bound depends on the settings: the function says it. */
#define BY_SETTINGS NAN

/* clang-format off: a row reads name, what it says, bound, why, whether it is of the picture, function. */
const struct tl_invariant tl_invariants[] = {
    {"surface.finite", "positions, normals, tangents and UVs are numbers: values that are not", 0,
     "a NaN spreads over the picture", false, tl_measure_finite},
    {"surface.normals", "normals are unit: |length - 1|", 1e-4,
     "frames.h promises 1e-5; ten times that is a thousandth of a half float's step in the G-buffer", false,
     tl_measure_normals},
    {"surface.sides", "normals are the angle-weighted mean of their faces, on their side: 1 - cosine", 1e-4,
     "0.8 degrees: a place is rounded to 1e-7 m, which turns a face of a millimetre by 1e-4, and the mean of "
     "faces that cancel to a hundredth by 1e-2",
     false, tl_measure_sides},
    {"surface.tangents", "tangents are unit, at right angles to normals, with w 1 or -1: largest deviation",
     1e-4, "as surface.normals", false, tl_measure_tangents},
    {"surface.handed", "a tangent runs along u, and w is the UVs' handedness: vertices where no face agrees",
     0, "a mean of directions is within 90 degrees of one of them", false, tl_measure_handed},
    {"image.finite", "pixels are numbers: values that are not", 0, "a NaN spreads in every filter", true,
     tl_measure_pixels},
    {"image.coverage", "alpha lies in [0, 1]: how far outside", 1e-6, "the mean of a few shares, rounded",
     true, tl_measure_coverage},
    {"image.negative", "radiance is not below 0: how far below", 0, "there is no negative light", true,
     tl_measure_negative},
    {"image.fresh", "what is reused equals what a new renderer makes: relative RMSE", BY_SETTINGS,
     "maps: the same picture to rounding; rays: two pictures that each err as bench light states", true,
     tl_measure_fresh},
    {"image.oracle",
     "sampled pixels equal the ray-traced oracle: relative RMSE less the oracle's own, without the "
     "worst sixteenth",
     BY_SETTINGS, "the back-end's measured error, widened for so few pixels", true, tl_measure_oracle},
    {"maps.moments", "shadow maps hold finite depths, and E[z^2] >= E[z]^2: how far below, of E[z^2]", 1e-5,
     "sums of up to 129 weights in single precision, twice", true, tl_measure_moments},
    {"visibility.range", "VIS lies in [0, 1] for every sample, region and sun: how far outside", 1e-5,
     "four weights that sum to 1, rounded", true, tl_measure_visibility},
    {"visibility.regions",
     "VIS of a region is what rays see of it, on average over the sampled points: difference from their mean "
     "beyond three of their deviations from one direction of the region to the next, times the region's "
     "light up to the mean",
     0.15,
     "what is kept is a few frames old and lies at vertices: at most 0.10 in 7300 cases in dress, review, a "
     "T-shirt's motion and a walk, by 24 to 384 regions",
     true, tl_measure_leaks},
    {"light.environment", "cube and suns hold the environment's light: relative difference", 0.01,
     "cube.h: a texel keeps its energy within 1 %", true, tl_measure_environment},
    {"light.regions", "the regions hold the cube's light, none lost and none twice: relative difference",
     1e-4, "sums of 1e5 floats in blocks", true, tl_measure_regions},
    {"light.exact",
     "unshadowed light through a lobe equals the integral over the cube: largest difference, of the "
     "brightest",
     0.012, "interpolation between directions and exponents, under 1 % of a lobe (test_slices.c)", true,
     tl_measure_exact},
    {"light.sum",
     "the regions' light P_i sums to that of the undivided environment: largest difference, of the "
     "brightest",
     0.012, "as light.exact", true, tl_measure_sum},
    {"light.slices", "each region's slice is its own light, along its own direction: relative difference",
     0.05, "a slice's interpolation and crop (test_slices.c)", true, tl_measure_slices},
    {"light.pems", "PEMs sum to the filtered undivided cube, texel by texel: difference, of texel and mean",
     1e-3, "halves: each PEM is rounded by 2^-11 of itself at most", true, tl_measure_pems},
    {"furnace.albedo", "white light gives exactly the albedo where nothing shadows: largest difference", 0.01,
     "an even sky through merged cells: 0.7 % (test_lobes.c); half floats", true, tl_measure_furnace},
    {"furnace.shadowed", "shadows only take white light away: by how much it grows", 0.01,
     "as furnace.albedo", true, tl_measure_furnace_shadowed},
    {"cloth.strain", "no edge is longer or shorter than cloth can be: largest strain", BY_SETTINGS,
     "half, or twice what the solver is told to keep; when put on 1, and later a quarter more than then; "
     "what a budget hurries, 1; what a hand holds, three times what it yields at (TL_HAND_STRAIN); what a "
     "moving "
     "wearer drags, until it slips (TL_CAUGHT_STRAIN), and what it has caught, until it is refused "
     "(TL_CLOTH_MAX_STRAIN)",
     false, tl_measure_strain},
    {"cloth.stretch",
     "the weave as a whole is neither stretched nor crushed: root mean square of the edges' strains",
     BY_SETTINGS, "what the solver is told to keep of each edge, 0.1 if nothing", false, tl_measure_stretch},
    {"cloth.inside", "no particle is below the avatar's skin or the ground: deepest, metres", 1e-3,
     "a third of the distance that is kept; none is held inside, but a moving body's skin is followed in "
     "steps",
     false, tl_measure_inside},
    {"cloth.energy",
     "motion and height take no more than the least energy that there was since anything worked on the "
     "garment: gain, in metres that it would be lifted by",
     BY_SETTINGS, "a contact lifts what it meets by the distance that it keeps at most", false,
     tl_measure_energy},
    {"cloth.momentum",
     "a garment that falls free of everything falls straight: sideways way of its centre, metres", 1e-5,
     "its own forces and even drag sum to nothing; single precision's positions leave less than a tenth of "
     "it",
     false, tl_measure_momentum},
    {"cloth.speed", "no particle is faster than fall, wearer, hand and wind make it: ratio", 1,
     "three times their sum, for a whip's end; and with the reference solver, which damps nothing, what its "
     "strain can become",
     false, tl_measure_speed},
    {"run.repeat", "the same frame again gives the same positions and pixels: differing frames", 0,
     "to the bit, at any number of threads", true, tl_measure_repeat},
    {"plan.budget",
     "the chosen plan is predicted to keep the budget while it lasts, where any plan can: ratio", 1,
     "what the planner promises (app/budget/governor.h)", false, tl_measure_budget},
};
/* clang-format on */
const size_t tl_invariant_count = TL_COUNT(tl_invariants);
static_assert(TL_COUNT(tl_invariants) <= TL_INVARIANTS_MAX, "room for every verdict");

/* Of the bound, where there is one to be a part of. */
static double severity(const struct tl_finding *finding)
{
    return finding->bound > 0 ? finding->worst / finding->bound : finding->worst;
}

/* What is broken counts more than what is not, then what is worse. */
static bool is_worse(const struct tl_verdict *verdict, const struct tl_finding *finding, bool ok)
{
    if (!verdict->finding.is_measured || verdict->ok != ok)
        return !verdict->finding.is_measured || !ok;
    return !isnan(verdict->finding.worst) && !(severity(finding) <= severity(&verdict->finding));
}

int tl_check_frame(const struct tl_checked *checked, struct tl_verdicts *verdicts, struct tl_finding *broken)
{
    int first_broken = -1;
    for (size_t i = 0; i < tl_invariant_count; i++) {
        struct tl_finding finding = {.bound = tl_invariants[i].bound, .x = -1, .y = -1, .surface = -1};
        if (checked->image || !tl_invariants[i].of_picture)
            tl_invariants[i].measure(checked, &finding);
        if (!finding.is_measured)
            continue;
        bool ok = finding.worst <= finding.bound;
        if (is_worse(&verdicts->items[i], &finding, ok))
            verdicts->items[i] = (struct tl_verdict){finding, checked->number, ok};
        if (ok || first_broken >= 0)
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
