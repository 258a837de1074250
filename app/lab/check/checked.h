/* One frame as the invariants see it: its settings, the renderer that drew it, and the images and cloth state
 * made for the checks.
 *
 * Metres, seconds, newtons, joules, milliseconds. Ownership: everything is borrowed. */
#ifndef TOILE_APP_LAB_CHECK_CHECKED_H
#define TOILE_APP_LAB_CHECK_CHECKED_H

#include "app/scene/session.h"
#include "render/renderer.h"

struct tl_truth;
struct tl_trials;

/* The cloth of a frame, with the state that its bounds depend on. */
struct tl_checked_cloth {
    struct tl_cloth_report report;
    double strain_limit; /* of the solver; 0: none */
    double kept_m;       /* the distance that contacts keep */
    double first_strain; /* the largest in frame 0; NaN: this is frame 0 */
    double weight_n;     /* of the garment, newtons */
    /* Minimum of kinetic + elastic + potential energy since only gravity acts on the cloth; NaN: no such
     * frame yet. */
    double min_energy_j;
    double allowed_speed;   /* m/s: what fall, wearer and wind can cause */
    double first_elastic_j; /* in frame 0, of the clean run that this one is compared with; NaN: none, or
                               later */
    bool is_driven;         /* by the hand, a clip or the wind */
    bool is_held;           /* by the hand */
    bool is_dragged;        /* by its moving wearer */
    bool is_hurried;        /* a budget may reduce its substeps */
    bool cannot_cross;      /* contact with itself is on */
    /* Horizontal displacement of the centre of mass since frame 0; NaN unless the cloth is free of contact
     * and drive. */
    double drift_m;
};

/* One frame. An invariant that needs a member which is NULL or 0 is not measured. */
struct tl_checked {
    int number;
    const tl_frame *frame;
    const struct tl_render_settings *settings;
    const tl_renderer *renderer;    /* drew the frame */
    const tl_image *image;          /* as tl_renderer_read gives it; NULL: the frame cannot be drawn */
    bool is_sampled;                /* the slow invariants are measured, too */
    const tl_image *fresh;          /* the same frame by a renderer without history */
    const tl_renderer *white;       /* drew the frame unshadowed in white light */
    const tl_image *white_image;    /* its image */
    const tl_image *white_shadowed; /* the same with shadows */
    const tl_image *in_motion;    /* the same frame with the ratio of light at vertices, as budgets draw it */
    const struct tl_truth *truth; /* the worse of both images against the reference; tl_check_frame sets it */
    const struct tl_checked_cloth *cloth;
    const struct tl_trials *trials; /* once, after the last frame */
    uint64_t hash, first_hash;      /* of positions and image, now and in the first run; 0: none */
    uint64_t positions_hash, first_positions_hash; /* of positions alone */
    double predicted_ms, budget_ms;                /* of the plan; of the command line */
    double min_ms;                                 /* of the cheapest plan, where it exceeds the budget */
    bool is_reduced; /* a budget reduced the image, which the reference does not model */
};

#endif
