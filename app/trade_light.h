/* What a trade has measured, and how it is written: trade.csv for programs, report.html for people. */
#ifndef TOILE_APP_TRADE_LIGHT_H
#define TOILE_APP_TRADE_LIGHT_H

#include "app/measure.h"

/* The garment as it is measured. Three glossinesses in the scene's light; then two in which the image is one
 * number of interest: irradiance, and the share of a uniform sky that is seen. */
enum tl_look { TL_LOOK_MATT, TL_LOOK_SATIN, TL_LOOK_GLOSSY, TL_LOOK_IRRADIANCE, TL_LOOK_SKY, TL_LOOK_COUNT };
struct tl_look_row {
    const char *name, *title;
    float diffuse, specular, glossiness;
    bool sky; /* under a uniform one */
};
extern const struct tl_look_row tl_looks[TL_LOOK_COUNT];

struct tl_trade_row {
    const char *group, *name; /* literals */
    int look;                 /* enum tl_look */
    bool rest;
    int draws; /* of the compared frame: 1 in motion; at rest what was averaged, when the method averages */
    struct tl_light_params light;
    struct tl_taken taken; /* ms a frame, medians */
    struct tl_measured_error error;
    struct tl_render_memory memory;
};

struct tl_trade_picture {
    const char *name; /* literal */
    int look;
    void *png;
    size_t size;
    struct tl_measured_error error; /* zeroed for the oracle */
};

struct tl_trade {
    struct tl_trade_row *rows;
    size_t row_count;
    struct tl_trade_picture *pictures;
    size_t picture_count;
    char **refusals; /* "name: message" of contenders that the renderer refused */
    size_t refusal_count;
    bool complete; /* false: interrupted */
    bool quick;
    const tl_environment *environment; /* borrowed from the session */
    struct tl_film_report film;
    int width, height;
};

/* Measures light (trade_light.c). `quick`: a few contenders and frames, to see that all is well. Interrupted:
 * TL_INTERRUPTED, and `out` holds what was done. */
bool tl_trade_light(struct tl_stage *stage, bool quick, struct tl_trade *out, tl_error *error);
void tl_trade_release(struct tl_trade *trade);

/* Rows to or from a file's content (trade_light_write.c). */
void tl_trade_write_csv(const struct tl_trade *trade, FILE *out);
void tl_trade_write_html(const struct tl_trade *trade, FILE *out);

#endif
