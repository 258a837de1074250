/* Turns samples into the linear image, and the image into a screen's values: background, exposure, tone
 * mapping (Khronos PBR Neutral), sRGB. */
#ifndef TOILE_RENDER_PRESENT_PRESENT_H
#define TOILE_RENDER_PRESENT_PRESENT_H

#include "render/present/backdrop.h"
#include "render/present/linear_image.h"
#include "render/present/options.h"
#include "render/present/picture.h"
#include "render/present/tone_map.h"
#include "render/scene/view.h"

/* The background; or none and no tone mapping, for colours that stand for numbers. */
enum tl_shown {
    TL_SHOWN_ON_GREY,
    TL_SHOWN_ON_BLURRED,
    TL_SHOWN_ON_LATLONG,
    TL_SHOWN_ON_CUBE,
    TL_SHOWN_AS_IT_IS,
    TL_SHOWN_COUNT
};

/* One of several images whose mean is the image. */
struct tl_image_part {
    float *texels; /* [height][width][4] */
    size_t bytes;
    int before; /* how many there were before it; 0: the image itself is made */
};

struct tl_present {
    tl_program resolve;
    tl_program shows[TL_SHOWN_COUNT][2]; /* made when first used; the second where sizes are the same */
    struct tl_linear_image image;
    struct tl_image_part part; /* that is made on the CPU for it */
    struct tl_picture picture; /* the image as it was shown last */
    struct tl_backdrop backdrop;
    struct tl_encoding encoding;
};

struct tl_show_request {
    struct tl_view view;
    float environment_yaw;             /* rad */
    const tl_environment *environment; /* that the backdrop was made of */
    const struct tl_image_params *params;
    struct tl_picture_part part;
};

bool tl_present_create(struct tl_present *present, tl_gpu *gpu, tl_error *error);
void tl_present_release(struct tl_present *present);
bool tl_present_reload(struct tl_present *present, tl_error *error); /* its shaders */

/* Sizes in pixels. `before`: the image becomes the mean of what is made and so many that were made before it,
 * of the same size and on the same side; 0: what is made. A whole number of samples a pixel side: their box
 * filter; else render/present/resample.h, on the CPU, where it takes a third of the time that software GL
 * would. */
void tl_present_resolve(struct tl_present *present, tl_gpu *gpu, const tl_texture *lights,
                        const tl_texture *points, int width, int height, int before);

/* The same for light on the CPU, [rows][columns][4]: premultiplied by the coverage in alpha. */
void tl_present_resolve_texels(struct tl_present *present, const float *texels, int columns, int rows,
                               int width, int height, int before);

/* Begins an image that is made on the CPU, as tl_linear_image_begin_cpu; the second call ends it. */
float *tl_present_begin_cpu_image(struct tl_present *present, int width, int height, int before);
void tl_present_end_cpu_image(struct tl_present *present);
/* Takes an image that was made elsewhere: F32 RGBA, rows downwards. */
void tl_present_set_image(struct tl_present *present, const tl_image *image);

/* Shows the image in `picture`: on the CPU when it is there and has as many pixels as the picture, else by
 * show.frag. Both give the same bytes within 1. False when the environment is seen behind and is larger than
 * GL can hold. */
bool tl_present_show(struct tl_present *present, tl_gpu *gpu, const struct tl_show_request *request,
                     tl_error *error);

size_t tl_present_bytes(const struct tl_present *present); /* image and picture, without the backdrop */

#endif
