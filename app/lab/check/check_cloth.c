/* Invariants of the cloth. Momentum is checked for free cloth only, because wearer and ground exchange
 * momentum with the rest; for worn cloth the energy is checked, which may rise only while something drives
 * it. */
#include "app/lab/check/check_measures.h"
#include "cloth/contact/caught.h"
#include "cloth/drive/hand.h"

#include <math.h>

/* Strains that a drape does not exceed: of cloth that fits; of the shortest edges in frame 0, when a file has
 * the garment inside its wearer (MakeHuman's sports suit, up to 8 mm inside: 0.64). */
#define DRAPED_STRAIN 0.5
#define WORN_STRAIN   1.0
#define LATER         1.25 /* times the largest strain in frame 0 */

/* A hand yields before it strains the edges that it holds by TL_HAND_STRAIN. The next edges may be strained
 * by as much again (tests/cloth/drive/test_hand.c: 0.96), and edges that the wearer holds back by half as
 * much more (trousers about a leg: 1.21). */
#define HELD_STRAIN (3 * TL_HAND_STRAIN)

/* Strain with the smallest number of substeps that a budget chooses: with eight a frame instead of sixty the
 * dress's worst edge has 0.85 instead of 0.16. */
#define HURRIED_STRAIN 1.0

/* Root mean square over all edges: the default strain limit of `preview`. */
#define USUAL_STRAIN 0.1

/* Metres: the rounding of positions on an avatar to single precision. */
#define ROUNDED_M 1e-6

static double energy_of(const struct tl_cloth_report *report)
{
    return report->kinetic_energy + report->elastic_energy + report->potential_energy;
}

/* The bound of the strain. A moving wearer drags cloth along between its parts; at the end of every step
 * edges that are strained beyond TL_CAUGHT_STRAIN slip, so that none exceeds it (a skirt on a walking man
 * reaches 1.43; cloth.stretch checks that only a few edges do). Particles that are caught between two
 * surfaces are pushed out only after that, and move with an arm until then. */
static double strain_bound(const struct tl_checked_cloth *cloth)
{
    double draped = DRAPED_STRAIN;
    if (cloth->report.caught_count > 0)
        draped = TL_CLOTH_MAX_STRAIN;
    else if (cloth->is_held)
        draped = HELD_STRAIN;
    else if (cloth->is_dragged)
        draped = TL_CAUGHT_STRAIN;
    else if (cloth->is_hurried)
        draped = HURRIED_STRAIN;
    double kept = fmax(draped, 2 * cloth->strain_limit);
    return isnan(cloth->first_strain) ? fmax(kept, WORN_STRAIN) : fmax(kept, LATER * cloth->first_strain);
}

void tl_measure_strain(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (!checked->cloth)
        return;
    const struct tl_cloth_report *report = &checked->cloth->report;
    finding->bound = strain_bound(checked->cloth);
    /* The maximum of the strains skips NaNs; the sum of the energies does not. */
    tl_finding_add(finding, isfinite(energy_of(report)) ? report->max_strain : (double)NAN);
    tl_finding_place(finding, "garment: %zu of %zu particles caught", report->caught_count,
                     report->vertex_count);
}

/* A few edges may exceed the strain limit where cloth is caught; the mean must not. */
void tl_measure_stretch(const struct tl_checked *checked, struct tl_finding *finding)
{
    const struct tl_checked_cloth *cloth = checked->cloth;
    if (!cloth)
        return;
    finding->bound = fmax(USUAL_STRAIN, cloth->strain_limit);
    tl_finding_add(finding, cloth->report.rms_strain);
    tl_finding_place(finding, "garment: root mean square over %zu edges", cloth->report.edge_count);
}

void tl_measure_inside(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (!checked->cloth)
        return;
    const struct tl_cloth_report *report = &checked->cloth->report;
    tl_finding_add(finding, report->deepest_m);
    tl_finding_place(finding, "garment: %zu of %zu particles caught", report->caught_count,
                     report->vertex_count);
}

/* Cloth without contact with itself may cross. */
void tl_measure_crossing(const struct tl_checked *checked, struct tl_finding *finding)
{
    const struct tl_checked_cloth *cloth = checked->cloth;
    if (!cloth || !cloth->cannot_cross)
        return;
    tl_finding_add(finding, (double)cloth->report.crossing_count);
    tl_finding_place(finding, "garment: of %zu triangles in %zu pieces", cloth->report.triangle_count,
                     cloth->report.piece_count);
}

void tl_measure_seams(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (!checked->cloth)
        return;
    tl_finding_add(finding, (double)checked->cloth->report.open_seams);
    tl_finding_place(finding, "garment: %zu pieces", checked->cloth->report.piece_count);
}

/* Kinetic and potential energy may rise to the minimum of the total energy, because elastic energy may turn
 * into them. The elastic energy of this frame is left out of the sum: `preview` does not balance its
 * constraints, so that gravity and swing strain the cloth without losing energy of their own. */
void tl_measure_energy(const struct tl_checked *checked, struct tl_finding *finding)
{
    const struct tl_checked_cloth *cloth = checked->cloth;
    if (!cloth || cloth->is_driven || isnan(cloth->min_energy_j) || !(cloth->weight_n > 0))
        return;
    finding->bound = fmax(cloth->kept_m, ROUNDED_M);
    double energy_j = cloth->report.kinetic_energy + cloth->report.potential_energy;
    double gain_m = (energy_j - cloth->min_energy_j) / cloth->weight_n;
    tl_finding_add(finding, gain_m < 0 ? 0 : gain_m);
    tl_finding_place(finding, "garment: %.4g J of motion and height after %.4g J of all", energy_j,
                     cloth->min_energy_j);
}

void tl_measure_momentum(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (checked->cloth && !isnan(checked->cloth->drift_m))
        tl_finding_add(finding, checked->cloth->drift_m);
}

void tl_measure_speed(const struct tl_checked *checked, struct tl_finding *finding)
{
    const struct tl_checked_cloth *cloth = checked->cloth;
    if (!cloth || !(cloth->allowed_speed > 0)) /* flat cloth in the first frame, or nothing that drives it */
        return;
    tl_finding_add(finding, cloth->report.max_speed / cloth->allowed_speed);
    tl_finding_place(finding, "garment: %.3g m/s of %.3g", cloth->report.max_speed, cloth->allowed_speed);
}

void tl_measure_rest(const struct tl_checked *checked, struct tl_finding *finding)
{
    const struct tl_checked_cloth *cloth = checked->cloth;
    if (!cloth || !(cloth->first_elastic_j > 0))
        return;
    double elastic_j = cloth->report.elastic_energy;
    tl_finding_add(finding, fabs(elastic_j - cloth->first_elastic_j) / cloth->first_elastic_j);
    tl_finding_place(finding, "garment: %.6g J of %.6g", elastic_j, cloth->first_elastic_j);
}
