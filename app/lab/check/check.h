/* The table of invariants that every frame of every scene must satisfy. Each is a function that measures the
 * deviation of one drawn frame and its place. Nothing here draws or simulates: the caller (check_run.c, or a
 * test that breaks something on purpose) passes the frame, its renderer and the auxiliary images. Results do
 * not depend on the number of threads, and a NaN anywhere is a failure, never a pass. Ownership: everything
 * is borrowed. Threads: the one that the GL context is current on. */
#ifndef TOILE_APP_LAB_CHECK_CHECK_H
#define TOILE_APP_LAB_CHECK_CHECK_H

#include "app/lab/check/checked.h"
#include "app/lab/check/finding.h"

struct tl_invariant {
    const char *name; /* "surface.finite" */
    const char *says; /* what must hold, and what `worst` counts */
    double bound;     /* worst <= bound; a finding may set its own where this one is NaN */
    const char *why;  /* of the bound */
    bool of_picture;  /* needs a drawn frame: a renderer and an image */
    void (*measure)(const struct tl_checked *checked, struct tl_finding *finding);
};

extern const struct tl_invariant tl_invariants[];
enum { TL_INVARIANTS_MAX = 40 };
extern const size_t tl_invariant_count;

/* The worst of all frames so far, by invariant. */
struct tl_verdict {
    struct tl_finding finding;
    int frame;
    bool ok;
};
/* What an earlier, clean run of the same scene found (baseline.h). */
struct tl_check_baseline {
    double worst[TL_INVARIANTS_MAX]; /* by invariant; NaN: not measured then */
    double elastic_j;                /* of the cloth in frame 0; NaN: none */
};

struct tl_verdicts {
    int frames;
    const struct tl_check_baseline *baseline; /* NULL: the general bounds hold */
    struct tl_verdict items[TL_INVARIANTS_MAX];
};

/* Measures all invariants (only those of geometry when there is no image) and merges the findings into
 * `verdicts`. Returns the index of the first broken invariant, -1: none; `broken` (or NULL) receives its
 * finding. */
int tl_check_frame(const struct tl_checked *frame, struct tl_verdicts *verdicts, struct tl_finding *broken);
/* The bound of an invariant: at most half as much again as the clean run found, and a tenth of the general
 * bound for what rounding and other machines change. */
double tl_check_bound(const struct tl_check_baseline *baseline, size_t invariant, double general);
int tl_verdicts_failed(const struct tl_verdicts *verdicts); /* number of broken invariants */

/* FNV-1a over the positions of all surfaces, and the image unless it is NULL. */
uint64_t tl_check_hash(const tl_frame *frame, const tl_image *image);

#endif
