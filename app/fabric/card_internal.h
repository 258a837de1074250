/* A fabric card in the making, for app/fabric/ alone. */
#ifndef TOILE_APP_FABRIC_CARD_INTERNAL_H
#define TOILE_APP_FABRIC_CARD_INTERNAL_H

#include "app/fabric/fabric.h"
#include "app/settings/settings.h"
#include "config/colour/lab.h"
#include "config/colour/srgb.h"

#include <cairo.h>

/* Sides of what is shown, on the cloth and on the page. */
#define TL_CARD_SWATCH_MM  100 /* both: at true scale */
#define TL_CARD_CLOSE_MM   10  /* on the cloth */
#define TL_CARD_PICTURE_MM 58  /* of close-up, ball and drape on the page */
#define TL_CARD_PER_MM     6   /* pixels of a picture per millimetre of the page */
#define TL_CARD_WIDTH_MM   210 /* A4 */
#define TL_CARD_HEIGHT_MM  297

#define TL_CARD_FIGURES 12
struct tl_card_figure {
    const char *name, *unit;
    double value;
    char source[128]; /* a field of the file, an option, a formula, a simulation */
};

struct tl_card_colour {
    float rgb[3]; /* linear */
    struct tl_lab lab;
    struct tl_hex hex;
};

struct tl_card {
    struct tl_fabric fabric;
    struct tl_settings settings; /* of the specimen "disc" in this fabric */
    struct tl_card_figure figures[TL_CARD_FIGURES];
    int figure_count;
    bool has_colour; /* the fabric states how it looks */
    struct tl_card_colour base, measured;
    double difference; /* CIEDE2000, between these */
    double drape;      /* Cusick's coefficient */
    int folds;
    double shimmer;                     /* app/fabric/shimmer.h */
    bool is_at_rest;                    /* the disc */
    tl_image shadow;                    /* of the disc (assets/specimen/cusick.h) */
    tl_image swatch, close, ball, disc; /* U8 x3; empty where no page is written */
    char *notes;                        /* the comments at the head of the fabric's own file; "" */
    char *unused;                       /* the fields that are not used */
};

/* Drapes, measures and, `with_pictures`, draws. */
bool tl_card_draw_views(struct tl_card *card, bool with_pictures, tl_error *error);

/* Fills figures and base colour, after the views. */
bool tl_card_fill_figures(struct tl_card *card, tl_error *error);

struct tl_card_colour tl_card_colour_of(const float rgb[3]);

/* Draws the page on a context whose unit is a millimetre. */
void tl_card_draw_page(const struct tl_card *card, cairo_t *cairo);

#endif
