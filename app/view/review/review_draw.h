/* When an image of the review window is drawn, and how it gets on the screen: within the budget while
 * something moves, sharp and with smooth edges as soon as nothing does. Owns `image`. */
#ifndef TOILE_APP_VIEW_REVIEW_REVIEW_DRAW_H
#define TOILE_APP_VIEW_REVIEW_REVIEW_DRAW_H

#include "app/budget/governor.h"
#include "app/view/window/frame_times.h"
#include "config/base/error.h"

struct tl_review;

struct tl_review_times {       /* of the last frame that had such a part */
    double frame, cloth, draw; /* ms; frame: from its start to the swap of buffers */
    double began_s;            /* when the current frame began */
    double panel_s;            /* when the panel was built */
    double lap_s;              /* when its last part ended */
    const char *longest;       /* its longest part so far other than drawing */
    double longest_ms;
};

/* The way in which images at rest are drawn. */
struct tl_review_rest {
    struct tl_quality levels;
    int samples;     /* a pixel side */
    bool is_shifted; /* the mean of shifted images: tl_frame.smooth */
};

/* The last image. */
struct tl_review_image {
    tl_quality_governor *governor;
    struct tl_quality_choice choice;
    bool is_budgeted, is_new; /* drawn within the budget; not presented yet */
    bool is_exact;            /* drawn for a file, however long that took */
    bool is_resting;          /* one of those that refine the picture at rest */
    struct tl_review_rest rest;
    struct tl_review_times times;
    struct tl_frame_times frame_times, rest_times; /* of images in motion, and at rest */
    struct tl_frame_times window_times;            /* of images in motion, without drawing and cloth */
    int drawn_count, shown_count;
    double shown_s; /* time of the last presented frame */
    char *title;    /* of the window; NULL before the first image */
};

/* Simulates and draws what is due. What cannot be drawn is reported, and the last good settings are drawn
 * instead; false only when these fail too, or on an interrupt. */
bool tl_review_update_image(struct tl_review *review, tl_error *error);
/* Whether the image is one of a rest: every pixel drawn, edges smoothed. */
bool tl_review_is_sharp(const struct tl_review *review);
/* Draws the first image, in the settings as they are. */
bool tl_review_draw_first(struct tl_review *review, tl_error *error);
/* Draws an image for a file at the quality of the settings, as `toile render` does, and with smooth edges;
 * unless there is one. */
bool tl_review_draw_sharp(struct tl_review *review, tl_error *error);
/* Whether drawing again would not refine the image: its rounds and its shifted images are averaged. */
bool tl_review_is_at_rest(const struct tl_review *review);

/* Ends a part of the current frame other than drawing; --verbose logs the longest part of a slow frame. */
void tl_review_lap(struct tl_review *review, const char *part);
/* Puts the last image, and the panel as it was built, on the screen. */
bool tl_review_present(struct tl_review *review, tl_error *error);

#endif
