/* Error against time: every technique of an experiment draws the same recorded motion and is compared with
 * the experiment's reference, once under each appearance.
 *
 * Times are medians over frames, of process CPU time and of wall time, in milliseconds. trade.csv is for
 * programs, report.html for people. */
#ifndef TOILE_APP_LAB_TRADE_TRADE_H
#define TOILE_APP_LAB_TRADE_TRADE_H

#include "app/lab/experiments/experiment.h"
#include "app/scene/headless.h"

struct tl_trade_row {
    const char *group, *name; /* literals */
    int appearance;
    bool rest;
    int draws; /* of the compared frame: 1 in motion; at rest what was averaged, when the method averages */
    double budget_ms;
    struct tl_render_settings settings;
    struct tl_taken taken; /* ms a frame, medians */
    struct tl_measured_error error;
    struct tl_render_memory memory;
};

struct tl_trade_picture {
    const char *name; /* literal */
    int appearance;
    void *png;
    size_t size;
    struct tl_measured_error error; /* zero for the reference */
};

struct tl_trade {
    const struct tl_experiment *experiment;
    struct tl_trade_row *rows;
    size_t row_count;
    struct tl_trade_picture *pictures;
    size_t picture_count;
    char **refusals; /* "name: message" of techniques that the renderer refused */
    size_t refusal_count;
    bool complete; /* false: interrupted */
    bool quick;
    const tl_environment *environment;    /* of the last appearance; borrowed from the session */
    struct tl_recording_report recording; /* of the first appearance */
};

struct tl_trade_options {
    bool quick;        /* a few techniques and frames, as a test that it works */
    const char *group; /* of the techniques that are measured, in a quick run too; NULL: all */
    int frames;        /* measured ones, at most 16; 0: as many as the experiment has */
    bool as_read;      /* under the scene's own appearance, none of the experiment's */
    bool in_turn; /* every frame is drawn by all techniques in turn: ratios of their times are those of the
                     same minutes. One that is refused ends the run */
};

/* Opens the scene that an experiment is measured in, as its first appearance has it: the command line's scene
 * or the experiment's, then the experiment's base, the appearance and the command line's assignments, of
 * which a later one overrides an earlier one. */
bool tl_trade_headless(const struct tl_experiment *experiment, const struct tl_arguments *arguments,
                       const struct tl_trade_options *options, struct tl_headless *headless, tl_error *error);

/* Measures the techniques. On Ctrl-C the error
 * is TL_INTERRUPTED and `out` holds what was measured until then. Release `out` in any case. */
bool tl_trade_measure(const struct tl_experiment *experiment, const struct tl_arguments *arguments,
                      const struct tl_trade_options *options, struct tl_headless *headless,
                      struct tl_trade *out, tl_error *error);
void tl_trade_release(struct tl_trade *trade);

/* trade.csv: a row for every technique, appearance and state. */
void tl_trade_write_csv(const struct tl_trade *trade, FILE *out);
/* FOLDER/report.html. */
bool tl_trade_write_report(const struct tl_trade *trade, const char *folder, tl_error *error);

#endif
