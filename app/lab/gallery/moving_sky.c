#include "app/lab/gallery/moving_sky.h"

#include "app/lab/gallery/shots.h"
#include "assets/image/exr.h"

#include <math.h>
#include <stdlib.h>

#define HEIGHT     64 /* texels of a lat-long image */
#define TURN_DEG   35.0
#define HEIGHT_DEG 40.0 /* of the light over the horizon */
#define RADIUS_DEG 12.0

static double radians(double degrees)
{
    return degrees * M_PI / 180;
}

/* The direction of a texel: u = .5 + atan2(x, -z)/2pi, v = acos(y)/pi. */
static vec3s direction_of(double u, double v)
{
    const double angle = 2 * M_PI * (u - 0.5), polar = M_PI * v;
    return (vec3s){{(float)(sin(polar) * sin(angle)), (float)cos(polar), (float)(-sin(polar) * cos(angle))}};
}

static tl_image draw_sky(int frame)
{
    static const float sky[3] = {0.3f, 0.42f, 0.65f}, ground[3] = {0.1f, 0.09f, 0.08f},
                       light[3] = {14, 11, 7};
    const double turn = radians(TURN_DEG * (frame - (TL_STRIP_FRAMES - 1) / 2.0)), up = radians(HEIGHT_DEG);
    const vec3s towards = {{(float)(cos(up) * sin(turn)), (float)sin(up), (float)(cos(up) * cos(turn))}};
    tl_image image = tl_image_create(2 * HEIGHT, HEIGHT, 3, TL_IMAGE_F32);
    for (int i = 0; i < 2 * HEIGHT * HEIGHT; i++) {
        const vec3s d = direction_of((i % (2 * HEIGHT) + 0.5) / (2 * HEIGHT),
                                     ((double)(i / (2 * HEIGHT)) + 0.5) / HEIGHT);
        const bool lit = (double)glms_vec3_dot(d, towards) > cos(radians(RADIUS_DEG));
        const float *colour = lit ? light : d.y > 0 ? sky : ground;
        for (size_t c = 0; c < 3; c++)
            tl_image_floats(&image)[3 * (size_t)i + c] = colour[c];
    }
    return image;
}

static bool save_sky(const char *path, int frame, tl_error *error)
{
    static const char *const channels[] = {"R", "G", "B"};
    tl_image image = draw_sky(frame);
    bool saved = tl_exr_save(path, &(const struct tl_exr_layer){channels, &image}, 1, error);
    tl_image_release(&image);
    return saved;
}

bool tl_moving_sky_make(const struct tl_experiment_picture *picture, tl_error *error)
{
    bool saved = true;
    for (int i = 0; saved && i < TL_PICTURE_OBJECTS * TL_STRIP_FRAMES; i++) {
        char name[32];
        snprintf(name, sizeof name, "sky.%04d.exr", i / TL_PICTURE_OBJECTS);
        char *path = tl_picture_file(picture, (enum tl_picture_object)(i % TL_PICTURE_OBJECTS), name);
        saved = save_sky(path, i / TL_PICTURE_OBJECTS, error);
        free(path);
    }
    return saved;
}
