/* From samples to the linear image, and from the image to a screen: background, exposure, tone mapping
 * (Khronos PBR Neutral), sRGB. */
#ifndef TOILE_RENDER_PRESENT_PRESENT_H
#define TOILE_RENDER_PRESENT_PRESENT_H

#include "assets/environment.h"
#include "render/gpu/gpu.h"
#include "render/pem/pems.h"
#include "render/present/linear_image.h"
#include "render/present/options.h"
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

struct tl_present {
    tl_program resolve;
    tl_program shows[TL_SHOWN_COUNT][2]; /* made when first used; the second where sizes are the same */
    struct tl_linear_image image;
    tl_target shown;     /* RGBA8, for images; windows have their own */
    tl_texture backdrop; /* the environment in its own layout */
    tl_texture blurred;  /* the whole cube, filtered */
    float blurred_scale;
};

struct tl_show_request {
    struct tl_view view;
    float environment_yaw; /* rad */
    const struct tl_image_params *params;
    unsigned framebuffer;         /* GL name */
    int width, height;            /* pixels */
    int first_column, end_column; /* columns that are drawn: [first, end) */
};

bool tl_present_create(struct tl_present *present, tl_gpu *gpu, tl_error *error);
void tl_present_release(struct tl_present *present);
bool tl_present_reload(struct tl_present *present, tl_error *error); /* its shaders */

/* Sizes in pixels. A whole number of samples a pixel side: their box filter; else render/present/resample.h,
 * on the CPU, where it takes a third of the time that software GL would. */
void tl_present_resolve(struct tl_present *present, tl_gpu *gpu, const tl_texture *lights,
                        const tl_texture *points, int width, int height);

/* Begins an image that is made on the CPU: tl_linear_image_begin_cpu. */
float *tl_present_begin_cpu_image(struct tl_present *present, int width, int height);
/* Takes an image that was made elsewhere: F32 RGBA, rows downwards. */
void tl_present_set_image(struct tl_present *present, const tl_image *image);

/* Makes the backdrop from the environment. False when the environment is larger than GL can hold. */
bool tl_present_set_backdrop(struct tl_present *present, tl_gpu *gpu, const tl_environment *environment,
                             const tl_cube *cube, int filter, tl_error *error);
/* A screen for pictures, as large as the image. */
const tl_target *tl_present_screen(struct tl_present *present, tl_gpu *gpu);
bool tl_present_show(struct tl_present *present, tl_gpu *gpu, const struct tl_show_request *request,
                     tl_error *error);

size_t tl_present_bytes(const struct tl_present *present); /* targets; without the backdrop */

#endif
