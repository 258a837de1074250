#include "render/reference/reference.h"

#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "render/reference/lamps.h"
#include "render/reference/radiance.h"
#include "render/scene/view.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Pixels along the side of a tile. A batch holds the same sample of each pixel of a tile. */
enum { TILE = 4, TILE_PIXELS = TILE * TILE };

#define GROUPS_MAX 64
#define DIRECTIONS_MAX                                                                                       \
    (1 << 20) /* largest number of sky samples of all groups together, unless one group has more */

struct reference_drawing {
    const struct tl_reference_scene *scene;
    const struct tl_reference_request *request;
    struct tl_view view;
    int width, height; /* pixels */
    int tiles_x, tiles_y;
    /* Sky samples of the current replicate: `groups` sets for each sample of a pixel. Tiles reuse the groups
     * in turn, because sampling the sky costs as much as tracing the rays. */
    int groups;
    struct tl_sky_sample *directions; /* [groups][samples][strata] */
    float *replicate;                 /* [height][width][4], of the current replicate */
    double *sums;                     /* [height][width][4], sums over the finished replicates */
    double *squares;                  /* [height][width][3], sums of squares */
    size_t rays;
    struct tl_progress progress;
};

/* A camera ray and the fraction of the pixel sample that it carries. */
struct camera_ray {
    struct tl_ray_differential ray;
    size_t pixel;
    float share;
};

/* One sample of each pixel of a tile. */
struct camera_rays {
    int count;
    struct camera_ray items[TL_SHADING_POINTS];
};

/* The hits of a batch of camera rays. */
struct hits {
    struct tl_shading_points points;
    size_t pixel[TL_SHADING_POINTS];
    float cover[TL_SHADING_POINTS];
    vec3s lamplight[TL_SHADING_POINTS];
    size_t rays; /* rays traced for the batch so far */
};

static struct camera_rays make_camera_rays(const struct reference_drawing *drawing, int tile, int sample)
{
    int side = drawing->request->supersample;
    int left = tile % drawing->tiles_x * TILE, top = tile / drawing->tiles_x * TILE;
    struct camera_rays camera_rays = {0};
    for (int i = 0; i < TILE_PIXELS; i++) {
        int x = left + i % TILE, y = top + i / TILE;
        if (x >= drawing->width || y >= drawing->height)
            continue;
        camera_rays.items[camera_rays.count++] = (struct camera_ray){
            .ray = tl_camera_ray(&drawing->view, drawing->width * side, drawing->height * side,
                                 x * side + sample % side, y * side + sample / side),
            .pixel = (size_t)y * (size_t)drawing->width + (size_t)x,
            .share = 1};
    }
    return camera_rays;
}

/* Intersects the camera rays with the scene. Behind open sheets the rays continue with the fraction that
 * these let through. The last layer counts as closed. */
static void intersect(const struct reference_drawing *drawing, bool last, struct camera_rays *camera_rays,
                      struct hits *hits)
{
    int through = 0;
    hits->points.count = 0;
    hits->points.any_layered = false;
    hits->rays = 0;
    for (int i = 0; i < camera_rays->count; i++) {
        struct camera_ray ray = camera_rays->items[i];
        struct tl_shading_point point = tl_shading_point_find(drawing->scene, &ray.ray);
        if (!(point.cover > 0))
            continue;
        float openness = point.layered && !last ? point.layers.openness : 0;
        hits->pixel[hits->points.count] = ray.pixel;
        hits->cover[hits->points.count] = ray.share * point.cover * (1 - openness);
        hits->lamplight[hits->points.count] = tl_reference_lamps(drawing->scene, &point, &hits->rays);
        tl_shading_points_add(&hits->points, &point);
        ray.share *= openness;
        ray.ray.from_m = point.distance_m + drawing->scene->offset_m;
        if (ray.share > 0)
            camera_rays->items[through++] = ray;
    }
    camera_rays->count = through;
}

static struct tl_sky_sample *directions_of(const struct reference_drawing *drawing, int group, int sample)
{
    int side = drawing->request->supersample;
    size_t set = (size_t)group * (size_t)(side * side) + (size_t)sample;
    return drawing->directions + set * (size_t)drawing->request->params->strata;
}

/* Tiles take the groups in turn; after each round the order is shifted, so that the tiles of a column do not
 * share a group. */
static const struct tl_sky_sample *directions_for(const struct reference_drawing *drawing, int tile,
                                                  int sample)
{
    const int shift = 37;
    return directions_of(drawing, (tile + tile / drawing->groups * shift) % drawing->groups, sample);
}

static void sample_sky(const struct reference_drawing *drawing, int replicate)
{
    int side = drawing->request->supersample, samples = side * side;
    int strata = drawing->request->params->strata;
#pragma omp parallel for schedule(dynamic)
    for (int set = 0; set < drawing->groups * samples; set++) {
        int group = set / samples, sample = set % samples;
        uint64_t key = (uint64_t)(replicate + 1) << 32 | (uint32_t)group;
        tl_gather_sample_sky(&drawing->scene->sky, strata, sample, samples, tl_random_begin(~key, 0),
                             tl_random_begin(~key, 1 + (uint64_t)sample),
                             directions_of(drawing, group, sample));
    }
}

/* Shades sample `sample` of the pixels of a tile at layer `layer`, counted from the camera through open
 * sheets. Returns the number of rays. */
static size_t accumulate(const struct reference_drawing *drawing, int replicate, int tile, int sample,
                         int layer, const struct hits *hits)
{
    const struct tl_reference_params *params = drawing->request->params;
    int side = drawing->request->supersample, samples = side * side;
    const struct tl_radiance_request radiance_request = {
        .direct = {.scene = drawing->scene,
                   .strata = params->strata,
                   .sky = directions_for(drawing, tile, sample),
                   .lobe_samples = params->lobe_samples,
                   .random = tl_random_begin((uint64_t)replicate << 32 | (uint32_t)tile,
                                             (uint64_t)sample + (uint64_t)layer * (uint64_t)samples)},
        .bounces = drawing->scene->bounces,
        .bounce_samples = params->bounce_samples,
        .reflect = drawing->scene->reflect};
    float light[3][TL_SHADING_POINTS];
    size_t rays = tl_radiance(&radiance_request, &hits->points, light);
    for (int i = 0; i < hits->points.count; i++) {
        float *pixel = drawing->replicate + 4 * hits->pixel[i], share = hits->cover[i] / (float)samples;
        for (int c = 0; c < 3; c++)
            pixel[c] = fminf(pixel[c] + share * (light[c][i] + hits->lamplight[i].raw[c]), FLT_MAX);
        pixel[3] += share;
    }
    return rays + hits->rays;
}

static size_t draw_sample(const struct reference_drawing *drawing, int replicate, int tile, int sample)
{
    struct camera_rays camera_rays = make_camera_rays(drawing, tile, sample);
    struct hits hits = {0};
    size_t rays = TILE_PIXELS;
    for (int layer = 0; layer <= TL_TRANSPARENCY_LAYERS && camera_rays.count > 0; layer++) {
        intersect(drawing, layer == TL_TRANSPARENCY_LAYERS, &camera_rays, &hits);
        if (hits.points.count > 0)
            rays += accumulate(drawing, replicate, tile, sample, layer, &hits);
    }
    return rays;
}

/* Draws one replicate. Each tile writes its own pixels only, so that the result does not depend on the number
 * of threads. False when interrupted. */
static bool draw_replicate(struct reference_drawing *drawing, int replicate)
{
    int tiles = drawing->tiles_x * drawing->tiles_y, done = 0;
    int samples = drawing->request->supersample * drawing->request->supersample;
    size_t rays = 0;
    for (size_t i = 0; i < 4 * (size_t)drawing->width * (size_t)drawing->height; i++)
        drawing->replicate[i] = 0;
    sample_sky(drawing, replicate);
#pragma omp parallel for schedule(dynamic) reduction(+ : rays)
    for (int tile = 0; tile < tiles; tile++) {
        if (tl_interrupted())
            continue;
        for (int sample = 0; sample < samples; sample++)
            rays += draw_sample(drawing, replicate, tile, sample);
#pragma omp critical
        tl_progress_update(&drawing->progress, (double)replicate * tiles + ++done,
                           (double)drawing->request->params->replicates * tiles);
    }
    drawing->rays += rays;
    return !tl_interrupted();
}

static void add_replicate(struct reference_drawing *drawing)
{
#pragma omp parallel for
    for (size_t p = 0; p < (size_t)drawing->width * (size_t)drawing->height; p++) {
        for (size_t c = 0; c < 4; c++) {
            double value = (double)drawing->replicate[4 * p + c];
            drawing->sums[4 * p + c] += value;
            if (c < 3)
                drawing->squares[3 * p + c] += value * value;
        }
    }
}

/* The variance of a pixel's mean, from the variance of the replicates. */
static double variance_of_mean(double sum, double squares, int replicates)
{
    double count = replicates;
    return fmax(squares - sum * sum / count, 0) / (count * (count - 1));
}

static double standard_error(const struct reference_drawing *drawing, int replicates)
{
    double variances = 0, mean = 0, values = 0;
    for (size_t p = 0; replicates > 1 && p < (size_t)drawing->width * (size_t)drawing->height; p++) {
        if (!(drawing->sums[4 * p + 3] > 0))
            continue;
        for (size_t c = 0; c < 3; c++) {
            double sum = drawing->sums[4 * p + c];
            variances += variance_of_mean(sum, drawing->squares[3 * p + c], replicates);
            mean += sum / replicates;
            values++;
        }
    }
    return mean > 0 ? sqrt(variances / values) / (mean / values) : 0;
}

static tl_image mean_image(const struct reference_drawing *drawing, int replicates)
{
    tl_image image = tl_image_create(drawing->width, drawing->height, 4, TL_IMAGE_F32);
    for (size_t i = 0; i < 4 * (size_t)drawing->width * (size_t)drawing->height; i++)
        tl_image_floats(&image)[i] = (float)(drawing->sums[i] / replicates);
    return image;
}

static int draw_replicates(struct reference_drawing *drawing)
{
    int done = 0;
    drawing->progress = tl_progress_begin("tracing the reference");
    while (done < drawing->request->params->replicates && draw_replicate(drawing, done)) {
        add_replicate(drawing);
        done++;
    }
    tl_progress_end(&drawing->progress);
    return done;
}

static void allocate_directions(struct reference_drawing *drawing)
{
    int side = drawing->request->supersample;
    int64_t one = (int64_t)side * side * drawing->request->params->strata;
    int64_t groups = one > 0 ? DIRECTIONS_MAX / one : 1;
    drawing->groups = (int)(groups < 1 ? 1 : groups > GROUPS_MAX ? GROUPS_MAX : groups);
    drawing->directions = TL_NEW_ARRAY(struct tl_sky_sample, (size_t)(drawing->groups * one));
}

bool tl_reference_draw(const struct tl_reference_request *request, tl_image *out,
                       struct tl_reference_report *report, tl_error *error)
{
    struct tl_reference_scene scene;
    if (!tl_reference_scene_make(request, &scene, error))
        return false;
    int width = request->width, height = request->height;
    size_t pixels = (size_t)width * (size_t)height;
    struct reference_drawing drawing = {.scene = &scene,
                                        .request = request,
                                        .view = tl_view_make(&request->frame->camera, width, height),
                                        .width = width,
                                        .height = height,
                                        .tiles_x = (width + TILE - 1) / TILE,
                                        .tiles_y = (height + TILE - 1) / TILE,
                                        .replicate = TL_NEW_ARRAY(float, 4 * pixels),
                                        .sums = TL_NEW_ARRAY(double, 4 * pixels),
                                        .squares = TL_NEW_ARRAY(double, 3 * pixels)};
    allocate_directions(&drawing);
    int done = draw_replicates(&drawing);
    *report = (struct tl_reference_report){done, standard_error(&drawing, done), drawing.rays};
    if (done > 0)
        *out = mean_image(&drawing, done);
    free(drawing.directions);
    free(drawing.replicate);
    free(drawing.sums);
    free(drawing.squares);
    tl_reference_scene_release(&scene);
    return done > 0 ||
           tl_fail(error, TL_INTERRUPTED, "the reference: interrupted before its first replicate");
}
