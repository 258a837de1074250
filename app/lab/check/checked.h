/* One frame as the invariants see it: its settings, the renderer that drew it, and the images and cloth state
 * made for the checks.
 *
 * Metres, seconds, newtons, joules, milliseconds. Ownership: everything is borrowed. */
#ifndef TOILE_APP_LAB_CHECK_CHECKED_H
#define TOILE_APP_LAB_CHECK_CHECKED_H

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

#endif
