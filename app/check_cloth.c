/* The cloth within its envelope. What is worn keeps no momentum, for its wearer and the ground take it: there
 * the energy is watched, which only something that works on the cloth may raise. */
#include "app/check_measures.h"

#include <math.h>

/* Edges that are caught between parts of a body stretch beyond what the solver otherwise keeps; without a
 * limit the fabric's stiffness has to hold, and what is stretched by half is no longer the garment that was
 * cut. */
#define CAUGHT_STRAIN 0.5

static double energy_of(const struct tl_cloth_report *report)
{
    return report->kinetic_energy + report->elastic_energy + report->potential_energy;
}

void tl_measure_strain(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (!checked->cloth)
        return;
    const struct tl_cloth_report *report = &checked->cloth->report;
    finding->bound = fmax(2 * checked->cloth->strain_limit, CAUGHT_STRAIN);
    /* The largest of numbers passes over what is none; a sum does not. */
    tl_finding_add(finding, isfinite(energy_of(report)) ? report->max_strain : (double)NAN);
    tl_finding_place(finding, "garment: %zu of %zu particles caught", report->caught_count,
                     report->vertex_count);
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

void tl_measure_energy(const struct tl_checked *checked, struct tl_finding *finding)
{
    const struct tl_checked_cloth *cloth = checked->cloth;
    if (!cloth || cloth->is_driven || isnan(cloth->least_energy_j) || !(cloth->weight_n > 0))
        return;
    double gain_m = (energy_of(&cloth->report) - cloth->least_energy_j) / cloth->weight_n;
    tl_finding_add(finding, gain_m < 0 ? 0 : gain_m);
    tl_finding_place(finding, "garment: %.4g J after %.4g J", energy_of(&cloth->report),
                     cloth->least_energy_j);
}

void tl_measure_speed(const struct tl_checked *checked, struct tl_finding *finding)
{
    const struct tl_checked_cloth *cloth = checked->cloth;
    if (!cloth)
        return;
    tl_finding_add(finding, cloth->report.max_speed / cloth->allowed_speed);
    tl_finding_place(finding, "garment: %.3g m/s of %.3g", cloth->report.max_speed, cloth->allowed_speed);
}
