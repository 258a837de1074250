/* Draws the pictures of the gallery: one session and one renderer for each object, whose settings change from
 * picture to picture. Sizes in pixels. Threads: the one that opened it, because of its GL context. */
#ifndef TOILE_APP_LAB_GALLERY_SHOTS_H
#define TOILE_APP_LAB_GALLERY_SHOTS_H

#include "app/lab/experiments/picture.h"
#include "app/lab/gallery/panels.h"
#include "app/scene/session.h"

#define TL_STRIP_FRAMES 5
#define TL_STRIP_SIDE   256

/* One object, with the settings that it was last drawn with. */
struct tl_viewpoint {
    tl_session *session;
    tl_renderer *renderer; /* one each, because a revision is unique within one session only */
    struct tl_settings exact_settings;
    enum tl_exact exact_kind;
    struct tl_gallery_shot exact; /* kept: successive pictures of a section often share it */
};

struct tl_shots {
    tl_gpu *gpu;
    struct tl_viewpoint viewpoints[TL_PICTURE_OBJECTS];
};

/* Errors: false without a device; close it in any case. */
bool tl_shots_open(struct tl_shots *shots, tl_error *error);
void tl_shots_close(struct tl_shots *shots);

/* Pixels of one picture of an experiment. */
int tl_shots_side(const struct tl_experiment *experiment);

/* The settings of a picture in the gallery: tl_picture_settings with its size and its samples a pixel. */
bool tl_shots_settings(const struct tl_experiment_picture *picture, enum tl_picture_object object, int side,
                       bool exact, struct tl_settings *out, tl_error *error);

/* Draws the technique, with its time; release `out`. */
bool tl_shots_draw(struct tl_shots *shots, const struct tl_experiment_picture *picture,
                   enum tl_picture_object object, struct tl_gallery_shot *out, tl_error *error);
/* Draws the exact picture of the same, unless it is the last one that was drawn; borrowed until the next. */
const struct tl_gallery_shot *tl_shots_exact(struct tl_shots *shots,
                                             const struct tl_experiment_picture *picture,
                                             enum tl_picture_object object, tl_error *error);

/* Draws the solid with these settings, its light and its layers. Release both in any case. */
bool tl_shots_layers(struct tl_shots *shots, const struct tl_settings *settings, tl_image *light,
                     struct tl_aovs *layers, tl_error *error);
/* The layer whose first channel this is; NULL: there is none. */
const tl_image *tl_shots_layer(const struct tl_aovs *aovs, const char *channel);

/* Draws the experiment's motion, frames of the exact picture and of the technique. Release the frames in any
 * case. */
bool tl_shots_strip(struct tl_shots *shots, const struct tl_experiment_picture *picture,
                    struct tl_gallery_shot exact[TL_STRIP_FRAMES],
                    struct tl_gallery_shot tested[TL_STRIP_FRAMES], tl_error *error);

#endif
