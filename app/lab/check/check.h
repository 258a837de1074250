/* What must hold in every frame of every scene: one table of invariants, each a function that looks at one
 * frame as a renderer has drawn it and tells how far off it is, and where.
 *
 * Nothing here draws or simulates: whoever asks (cmd_check.c, a test that breaks something on purpose) hands
 * over the frame, the renderer and what was made beside them. Results do not depend on the number of threads,
 * and a NaN anywhere is a failure, never a pass. Ownership: everything is borrowed. Threads: the one that the
 * GL context is current on. */
#ifndef TOILE_APP_LAB_CHECK_CHECK_H
#define TOILE_APP_LAB_CHECK_CHECK_H

#include "app/scene/session.h"
#include "render/renderer.h"

/* The cloth of a frame, and what it may draw its energy from. */
struct tl_checked_cloth {
    struct tl_cloth_report report;
    double strain_limit; /* of the solver; 0: none */
    double kept_m;       /* the distance that contacts keep */
    double first_strain; /* the largest in frame 0; NaN: this is it */
    double weight_n;     /* newtons, of all of it */
    /* Kinetic, elastic and potential, of the frames since nothing has worked on it but gravity; NaN: this is
     * the first. */
    double least_energy_j;
    double allowed_speed; /* m/s: what its fall, its wearer and the wind can give it */
    bool is_driven;       /* a hand, a clip or the wind works on it */
    bool is_held;         /* the hand does */
    bool is_dragged;      /* its wearer moves */
    bool is_hurried;      /* a budget may take from its steps */
    /* How far its centre of mass has gone sideways since frame 0, where nothing touches or drives it; else
     * NaN. */
    double drift_m;
};

/* One frame. What is NULL or 0 was not made for it, and what needs it is not measured. */
struct tl_checked {
    int number;
    const tl_frame *frame;
    const struct tl_render_settings *settings;
    const tl_renderer *renderer;    /* has drawn it */
    const tl_image *image;          /* what it drew, as tl_renderer_read gives it; NULL: it cannot be drawn */
    bool is_sampled;                /* what takes long is to be measured */
    const tl_image *fresh;          /* the same by a renderer that had nothing to reuse */
    const tl_renderer *white;       /* has drawn it unshadowed in white light ... */
    const tl_image *white_image;    /* ... and this is it; */
    const tl_image *white_shadowed; /* with shadows */
    const struct tl_checked_cloth *cloth;
    uint64_t hash, first_hash; /* of positions and image; when the same frame was drawn first; 0: not yet */
    uint64_t places_hash, first_places_hash; /* the same of positions alone */
    double predicted_ms, budget_ms;          /* of the plan while it lasts; what was asked for */
    double least_ms; /* of the cheapest plan there is, where that is more than the budget */
    bool is_reduced; /* a budget took from the image: it is not what the oracle is asked for */
};

enum { TL_CHECK_PLACE_SIZE = 112 };

/* What one invariant found in one frame. */
struct tl_finding {
    bool is_measured;
    double worst; /* 0 and above: how far off, in the invariant's own measure */
    double bound;
    char place[TL_CHECK_PLACE_SIZE]; /* where: a vertex, a pixel, a region; "" when nowhere in particular */
    int x, y;                        /* the pixel, from the upper left; -1: none */
    int surface;                     /* the vertex and its surface; -1: none */
    size_t vertex;
};

struct tl_invariant {
    const char *name; /* "surface.finite" */
    const char *says; /* what must hold, and what `worst` counts */
    double bound;     /* worst <= bound; a finding may set its own where this one is NaN */
    const char *why;  /* of the bound */
    bool of_picture;  /* needs a drawn frame: a renderer and an image */
    void (*measure)(const struct tl_checked *checked, struct tl_finding *finding);
};

extern const struct tl_invariant tl_invariants[];
enum { TL_INVARIANTS_MAX = 32 };
extern const size_t tl_invariant_count;

/* The worst of all frames so far, by invariant. */
struct tl_verdict {
    struct tl_finding finding;
    int frame;
    bool ok;
};
struct tl_verdicts {
    int frames;
    struct tl_verdict items[TL_INVARIANTS_MAX];
};

/* Measures all invariants (only those of geometry when there is no image) and adds what they found. Returns
 * the index of the first one that this frame breaks, -1 when all hold; `broken` (or NULL) is what that one
 * found. */
int tl_check_frame(const struct tl_checked *checked, struct tl_verdicts *verdicts, struct tl_finding *broken);
int tl_verdicts_failed(const struct tl_verdicts *verdicts); /* how many are broken */

/* For the functions of the table: `worst` replaces what was found so far when it is worse. Returns whether it
 * is, so that a place is only put into words then. */
bool tl_finding_add(struct tl_finding *finding, double worst);
void tl_finding_place(struct tl_finding *finding, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void tl_finding_pixel(struct tl_finding *finding, int x, int y);
void tl_finding_vertex(struct tl_finding *finding, const tl_frame *frame, size_t surface, size_t vertex);

/* FNV-1a over what a frame shows: positions of all surfaces, and the image; NULL: without it. */
uint64_t tl_check_hash(const tl_frame *frame, const tl_image *image);

#endif
