/* Fits lobes to GGX by brute force, from formulas of its own: what makes and tests the table of
 * render/brdf/ggx/ggx_lobes.h. Double precision; one fit at a time. */
#ifndef TOILE_TESTS_RENDER_BRDF_GGX_GGX_FITTER_H
#define TOILE_TESTS_RENDER_BRDF_GGX_GGX_FITTER_H

#define FITTER_LOBES_MAX 7
#define FITTER_FIGURES   3 /* of a lobe */

/* In units in which they change little with the width of the facets. */
enum {
    FITTER_FACET /* angle of its facet towards the viewer, rad, over the width */,
    FITTER_VARIANCE /* natural logarithm of its variance over the squared width */,
    FITTER_WEIGHT /* natural logarithm */
};

struct fitted {
    double lobes[FITTER_LOBES_MAX][FITTER_FIGURES];
};

/* Directions of light and their solid angles, and the gloss there, towards one viewer. */
struct fitter;
/* `width`: of the facets; `elevation` of the viewer, rad. */
struct fitter *fitter_create(double width, double elevation);
void fitter_destroy(struct fitter **fitter);

/* Moves the lobes to where they miss the least, and closer to `target`, which weighs `pull`; NULL: nothing
 * pulls. Returns what was made least: L1, smoothed, and what the rest weighs. */
double fitter_fit(struct fitter *fitter, int count, const struct fitted *target, double pull, int rounds,
                  struct fitted *lobes);

struct fitter_errors {
    double l1;      /* over the gloss's own integral */
    double energy;  /* of the lobes over that of the gloss */
    double plastic; /* ... with Schlick's term for F0 = 0.04 */
};
/* `cosines`: at which a lobe's Fresnel term is evaluated. */
struct fitter_errors fitter_errors(struct fitter *fitter, int count, const struct fitted *lobes,
                                   const double *cosines);

/* The cosine at which Schlick's term is the mean over a lobe's part of the gloss. */
void fitter_cosines(struct fitter *fitter, int count, const struct fitted *lobes,
                    double cosines[FITTER_LOBES_MAX]);

#endif
