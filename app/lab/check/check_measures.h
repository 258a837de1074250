/* The functions of the table of invariants (check.c), by what they look at. */
#ifndef TOILE_APP_LAB_CHECK_CHECK_MEASURES_H
#define TOILE_APP_LAB_CHECK_CHECK_MEASURES_H

#include "app/lab/check/checked.h"
#include "app/lab/check/finding.h"

typedef void tl_measure(const struct tl_checked *checked, struct tl_finding *finding);

/* check_surface.c: against their definitions, from positions, triangles and UVs alone. */
tl_measure tl_measure_finite, tl_measure_normals, tl_measure_sides, tl_measure_tangents, tl_measure_handed;

/* check_image.c */
tl_measure tl_measure_pixels, tl_measure_coverage, tl_measure_negative, tl_measure_fresh, tl_measure_repeat;
tl_measure tl_measure_budget;

/* check_light.c */
tl_measure tl_measure_environment, tl_measure_regions, tl_measure_exact, tl_measure_sum;
tl_measure tl_measure_slices, tl_measure_pems;

/* check_visibility.c */
tl_measure tl_measure_moments, tl_measure_visibility, tl_measure_leaks, tl_measure_age;

/* check_oracle.c */
tl_measure tl_measure_oracle, tl_measure_mean, tl_measure_patch, tl_measure_tile, tl_measure_place;

/* check_furnace.c */
tl_measure tl_measure_furnace, tl_measure_furnace_shadowed;

/* check_cloth.c */
tl_measure tl_measure_strain, tl_measure_stretch, tl_measure_inside, tl_measure_crossing, tl_measure_seams,
    tl_measure_energy, tl_measure_momentum, tl_measure_speed, tl_measure_rest;

/* check_trials.c */
tl_measure tl_measure_fall, tl_measure_droop, tl_measure_slide;

#endif
