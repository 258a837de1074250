#include "app/fabric/shimmer.h"

#include "assets/specimen/cusick.h"
#include "config/base/memory.h"
#include "config/colour/luminance.h"

#include <math.h>
#include <stdlib.h>

#define SIDE      64 /* pixels of the frames */
#define FINER     8  /* ... of the truth, along each axis, for one of a frame's */
#define STEPS     5
#define PITCH_DEG 55
#define FOV_DEG   1.79 /* so that a pixel is as wide as of 1080 rows under 30 degrees */

/* The k-th camera: moved over the cloth by parts of a pixel whose ratio is irrational, so that no step
 * repeats one before. */
static void aim_camera(struct tl_settings *settings, const struct tl_camera_params *start, int k, int finer)
{
    const double pixel_m = 2 * (double)start->distance_m * tan(FOV_DEG / 2 * M_PI / 180) / SIDE;
    settings->camera = *start;
    settings->camera.target[0] += (float)(0.382 * k * pixel_m);
    settings->camera.target[2] += (float)(0.236 * k * pixel_m);
    settings->image.width = settings->image.height = finer * SIDE;
}

/* Adds the luminances of a frame, each over finer x finer of its pixels, times `factor`. */
static bool add_frame(struct tl_headless *headless, int finer, double factor, double *sums, tl_error *error)
{
    tl_image image = {0};
    if (!tl_session_apply(headless->session, &headless->settings, error) ||
        !tl_headless_draw(headless, error) || !tl_renderer_read(headless->renderer, &image, error))
        return false;
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++)
            sums[y / finer * SIDE + x / finer] +=
                factor *
                tl_luminance_exact(tl_image_floats(&image) +
                                   4 * ((size_t)y * (size_t)image.width + (size_t)x)) /
                (finer * finer);
    tl_image_release(&image);
    return true;
}

/* Frames less their truth, step by step: differences[STEPS][SIDE * SIDE]; *brightness is the truth's mean. */
static bool find_differences(struct tl_headless *headless, const struct tl_camera_params *start,
                             double *differences, double *brightness, tl_error *error)
{
    const int finer[] = {1, FINER};
    double sum[2] = {0};
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < STEPS; k++) {
            double *to = differences + (size_t)k * SIDE * SIDE;
            aim_camera(&headless->settings, start, k, finer[i]);
            if (i == 1) /* finer pixels are samples enough */
                headless->settings.image.supersample = 1;
            if (!add_frame(headless, finer[i], i == 0 ? 1 : -1, to, error))
                return false;
            for (int p = 0; p < SIDE * SIDE; p++)
                sum[i] += to[p];
        }
    *brightness = (sum[0] - sum[1]) / (STEPS * SIDE * SIDE); /* frames less what is left after the truth */
    return true;
}

bool tl_shimmer_measure(struct tl_headless *headless, double *out, tl_error *error)
{
    const struct tl_settings kept = headless->settings;
    struct tl_camera_params start = {.yaw_deg = 20,
                                     .pitch_deg = PITCH_DEG,
                                     .distance_m = 1,
                                     .target = {0, (float)TL_CUSICK_HEIGHT_M, 0},
                                     .fov_deg = (float)FOV_DEG};
    double *differences = TL_NEW_ARRAY(double, (size_t)STEPS *SIDE *SIDE);
    double brightness = 0, variance = 0;
    headless->settings.light.method = TL_METHOD_UNSHADOWED;
    headless->settings.light.jitter = false;
    const bool done = find_differences(headless, &start, differences, &brightness, error);
    for (int p = 0; done && p < SIDE * SIDE; p++) {
        double mean = 0;
        for (int k = 0; k < STEPS; k++)
            mean += differences[k * SIDE * SIDE + p] / STEPS;
        for (int k = 0; k < STEPS; k++) {
            const double off = differences[k * SIDE * SIDE + p] - mean;
            variance += off * off / (STEPS * SIDE * SIDE);
        }
    }
    *out = brightness > 0 ? sqrt(variance) / brightness : 0;
    free(differences);
    headless->settings = kept;
    return done;
}
