/* The trade between time and error along an axis: every entrant, one choice of settings, draws the same
 * recorded motion and is compared with the axis's truth, once for each look of the garment.
 *
 * An axis is data (trade_light.c, trade_axes.c). Times are medians of process CPU time and of time on the
 * wall. trade.csv is for programs, report.html for people. */
#ifndef TOILE_APP_LAB_TRADE_TRADE_H
#define TOILE_APP_LAB_TRADE_TRADE_H

#include "app/measure/measure.h"

#define TL_TRADE_ASSIGNMENTS 10
#define TL_TRADE_LOOKS       5

/* How the garment and its light are seen. */
struct tl_trade_look {
    const char *name, *title;
    const char *scene[TL_TRADE_ASSIGNMENTS]; /* assignments over the scene's settings; NULL ends them */
    const char *truth[6];                    /* over the axis's truth, where looks differ in that */
    bool sky;                                /* under a uniform one of radiance 1 */
};

struct tl_entrant {
    const char *group;
    struct tl_setup choice;
    bool quick;   /* takes part in a quick run */
    bool picture; /* is shown beside the truth */
    double
        budget_ms; /* its levels are chosen for this budget (app/budget/governor.h); 0: they are as chosen */
};

struct tl_trade;

struct tl_trade_axis {
    const char *name, *title, *text;
    const char *scene;                      /* built-in, where none is named */
    const char *base[TL_TRADE_ASSIGNMENTS]; /* over the scene's settings */
    struct tl_setup truth;
    const struct tl_trade_look *looks;
    int look_count, quick_look;
    const struct tl_entrant *entrants;
    size_t entrant_count;
    int warm, measured; /* frames before the first measured one, and those measured */
    bool rests;         /* the last frame is drawn until it rests, too */
    bool by_wall;       /* plots have time on the wall: what is kept is a frame's time */
    bool by_flip;       /* ... and mean FLIP, not relative RMSE: errors as they are seen */
    void (*figures)(const struct tl_trade *trade, FILE *out); /* further ones of the report, or NULL */
};

extern const struct tl_trade_axis tl_trade_light; /* trade_light.c */
extern const struct tl_trade_axis tl_trade_resolution, tl_trade_detail, tl_trade_shading, tl_trade_overall,
    tl_trade_levels; /* trade_axes.c */

struct tl_trade_row {
    const char *group, *name; /* literals */
    int look;
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
    int look;
    void *png;
    size_t size;
    struct tl_measured_error error; /* zeroed for the truth */
};

struct tl_trade {
    const struct tl_trade_axis *axis;
    struct tl_trade_row *rows;
    size_t row_count;
    struct tl_trade_picture *pictures;
    size_t picture_count;
    char **refusals; /* "name: message" of entrants that the renderer refused */
    size_t refusal_count;
    bool complete; /* false: interrupted */
    bool quick;
    const tl_environment *environment; /* borrowed from the session */
    struct tl_recording_report recording;
    int width, height;
};

/* The settings that an axis is measured in: the command line's scene, the axis's base over it. */
bool tl_trade_stage(const struct tl_trade_axis *axis, const struct tl_arguments *arguments,
                    struct tl_stage *stage, tl_error *error);

/* Measures. `quick`: a few entrants and frames, to see that all is well. Interrupted: TL_INTERRUPTED, and
 * `out` holds what was done. */
bool tl_trade_measure(const struct tl_trade_axis *axis, struct tl_stage *stage, bool quick,
                      struct tl_trade *out, tl_error *error);
void tl_trade_release(struct tl_trade *trade);

/* Of a group (NULL: any), in order. `after` NULL begins; NULL at the end. */
const struct tl_trade_row *tl_trade_next(const struct tl_trade *trade, const struct tl_trade_row *after,
                                         const char *group, int look, bool rest);

void tl_trade_write_csv(const struct tl_trade *trade, FILE *out);
void tl_trade_write_html(const struct tl_trade *trade, FILE *out);

#endif
