/* A checked run: a scene is played and the invariants are measured in every frame.
 *
 * The camera walks round. A garment that nothing else moves stands still for a tenth of the frames, then a
 * hand swings its hem, and in the last third it is let go and comes to rest. Then the first tenth is played
 * again, by another renderer, and must be the same to the bit. Borrows the headless context. Threads: the one
 * of the GL context. */
#ifndef TOILE_APP_LAB_CHECK_CHECK_RUN_H
#define TOILE_APP_LAB_CHECK_CHECK_RUN_H

#include "app/lab/check/check.h"
#include "app/scene/headless.h"

struct tl_check_params {
    int frames, every; /* how many; from one frame whose sampled checks are made to the next */
    bool furnace;      /* those in white light too, where sampled checks are made */
    bool still;        /* no hand */
    double budget_ms;  /* 0: none; else the planner's, whose levels are kept and played again */
    const struct tl_check_baseline *baseline; /* NULL: none */
    const char *keep; /* folder for the first frame that breaks something; NULL: it is not kept */
};

struct tl_check_outcome {
    struct tl_verdicts verdicts;
    double elastic_j; /* of the cloth in frame 0; NaN: none */
    uint64_t hash;    /* of all frames: positions and images */
    int broken;       /* the invariant that broke first; -1: none */
    int broken_frame;
    struct tl_finding found; /* there */
    bool is_kept;
};

/* False only where the run cannot go on: bad input, no device, a refused step of the cloth, Ctrl-C. `out`
 * holds the findings until then. A broken invariant is no failure. */
bool tl_check_play(struct tl_headless *headless, const struct tl_check_params *params,
                   struct tl_check_outcome *out, tl_error *error);

#endif
