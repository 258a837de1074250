#include "render/reference/reference.h"

#include "config/interrupt.h"
#include "config/log.h"
#include "config/memory.h"
#include "render/reference/gather.h"
#include "render/reference/lamps.h"
#include "render/scene/view.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Pixels a side: a bundle holds the same sample of each. */
enum { TILE = 4, TILE_PIXELS = TILE * TILE };

#define GROUPS_MAX     64
#define DIRECTIONS_MAX (1 << 20) /* of all groups, where one is not more */

struct drawing {
    const struct tl_reference_scene *scene;
    const struct tl_reference_request *request;
    struct tl_view view;
    int width, height; /* pixels */
    int tiles_x, tiles_y;
    /* Of the current replicate: `groups` times a set of directions for each sample of a pixel. Tiles take
     * them in turn, because drawing them costs as much as tracing them. */
    int groups;
    struct tl_sky_sample *directions; /* [groups][samples][strata] */
    float *replicate;                 /* [height][width][4], of the one that is being drawn */
    double *sums;                     /* [height][width][4], over the replicates that are done */
    double *squares;                  /* [height][width][3] */
    size_t rays;
    struct tl_progress progress;
};

/* A ray of the camera on its way, and how much of it has got there. */
struct sight {
    struct tl_ray_differential ray;
    size_t pixel;
    float share;
};

/* One sample of each of a tile's pixels. */
struct sights {
    int count;
    struct sight items[TL_SHADING_POINTS];
};

/* What they meet. */
struct bundle {
    struct tl_shading_points spots;
    size_t pixel[TL_SHADING_POINTS];
    float cover[TL_SHADING_POINTS];
    vec3s lamplight[TL_SHADING_POINTS];
    size_t rays; /* spent on it */
};

static struct sights aim(const struct drawing *drawing, int tile, int sample)
{
    int side = drawing->request->supersample;
    int left = tile % drawing->tiles_x * TILE, top = tile / drawing->tiles_x * TILE;
    struct sights sights = {0};
    for (int i = 0; i < TILE_PIXELS; i++) {
        int x = left + i % TILE, y = top + i / TILE;
        if (x >= drawing->width || y >= drawing->height)
            continue;
        sights.items[sights.count++] =
            (struct sight){.ray = tl_camera_ray(&drawing->view, drawing->width * side, drawing->height * side,
                                                x * side + sample % side, y * side + sample / side),
                           .pixel = (size_t)y * (size_t)drawing->width + (size_t)x,
                           .share = 1};
    }
    return sights;
}

/* What the sights meet; they become what goes on through it. What is met last is taken as closed. */
static void find_spots(const struct drawing *drawing, bool last, struct sights *sights, struct bundle *bundle)
{
    int through = 0;
    bundle->spots.count = 0;
    bundle->spots.any_layered = false;
    bundle->rays = 0;
    for (int i = 0; i < sights->count; i++) {
        struct sight sight = sights->items[i];
        struct tl_shading_point spot = tl_shading_point_find(drawing->scene, &sight.ray);
        if (!(spot.cover > 0))
            continue;
        float openness = spot.layered && !last ? spot.layers.openness : 0;
        bundle->pixel[bundle->spots.count] = sight.pixel;
        bundle->cover[bundle->spots.count] = sight.share * spot.cover * (1 - openness);
        bundle->lamplight[bundle->spots.count] = tl_reference_lamps(drawing->scene, &spot, &bundle->rays);
        tl_shading_points_add(&bundle->spots, &spot);
        sight.share *= openness;
        sight.ray.from_m = spot.distance_m + drawing->scene->offset_m;
        if (sight.share > 0)
            sights->items[through++] = sight;
    }
    sights->count = through;
}

static struct tl_sky_sample *directions_of(const struct drawing *drawing, int group, int sample)
{
    int side = drawing->request->supersample;
    size_t set = (size_t)group * (size_t)(side * side) + (size_t)sample;
    return drawing->directions + set * (size_t)drawing->request->params->strata;
}

/* Every so many tiles have one group each; then the order is shifted, so that columns do not share them. */
static const struct tl_sky_sample *directions_for(const struct drawing *drawing, int tile, int sample)
{
    const int shift = 37;
    return directions_of(drawing, (tile + tile / drawing->groups * shift) % drawing->groups, sample);
}

static void draw_directions(const struct drawing *drawing, int replicate)
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

/* Sample `sample` of a tile's pixels, `behind` sheets that it has passed. Returns the number of rays. */
static size_t draw_spots(const struct drawing *drawing, int replicate, int tile, int sample, int behind,
                         const struct bundle *bundle)
{
    const struct tl_reference_params *params = drawing->request->params;
    int side = drawing->request->supersample, samples = side * side;
    const struct tl_gather_request gathering = {
        .scene = drawing->scene,
        .strata = params->strata,
        .sky = directions_for(drawing, tile, sample),
        .lobe_samples = params->lobe_samples,
        .reflect = drawing->scene->reflect,
        .random = tl_random_begin((uint64_t)replicate << 32 | (uint32_t)tile,
                                  (uint64_t)sample + (uint64_t)behind * (uint64_t)samples)};
    float light[3][TL_SHADING_POINTS];
    size_t rays = tl_gather(&gathering, &bundle->spots, light);
    for (int i = 0; i < bundle->spots.count; i++) {
        float *pixel = drawing->replicate + 4 * bundle->pixel[i], share = bundle->cover[i] / (float)samples;
        for (int c = 0; c < 3; c++)
            pixel[c] = fminf(pixel[c] + share * (light[c][i] + bundle->lamplight[i].raw[c]), FLT_MAX);
        pixel[3] += share;
    }
    return rays + bundle->rays;
}

static size_t draw_sample(const struct drawing *drawing, int replicate, int tile, int sample)
{
    struct sights sights = aim(drawing, tile, sample);
    struct bundle bundle = {0};
    size_t rays = TILE_PIXELS;
    for (int behind = 0; behind <= TL_TRANSPARENCY_LAYERS && sights.count > 0; behind++) {
        find_spots(drawing, behind == TL_TRANSPARENCY_LAYERS, &sights, &bundle);
        if (bundle.spots.count > 0)
            rays += draw_spots(drawing, replicate, tile, sample, behind, &bundle);
    }
    return rays;
}

/* Tiles own their pixels, so the number of threads does not show. False when interrupted. */
static bool draw_replicate(struct drawing *drawing, int replicate)
{
    int tiles = drawing->tiles_x * drawing->tiles_y, done = 0;
    int samples = drawing->request->supersample * drawing->request->supersample;
    size_t rays = 0;
    for (size_t i = 0; i < 4 * (size_t)drawing->width * (size_t)drawing->height; i++)
        drawing->replicate[i] = 0;
    draw_directions(drawing, replicate);
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

static void keep_replicate(struct drawing *drawing)
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

/* The variance of a pixel's mean, from the spread of the replicates. */
static double variance_of_mean(double sum, double squares, int replicates)
{
    double count = replicates;
    return fmax(squares - sum * sum / count, 0) / (count * (count - 1));
}

static double standard_error(const struct drawing *drawing, int replicates)
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

static tl_image mean_image(const struct drawing *drawing, int replicates)
{
    tl_image image = tl_image_create(drawing->width, drawing->height, 4, TL_IMAGE_F32);
    for (size_t i = 0; i < 4 * (size_t)drawing->width * (size_t)drawing->height; i++)
        tl_image_floats(&image)[i] = (float)(drawing->sums[i] / replicates);
    return image;
}

static int draw_replicates(struct drawing *drawing)
{
    int done = 0;
    drawing->progress = tl_progress_begin("tracing the reference");
    while (done < drawing->request->params->replicates && draw_replicate(drawing, done)) {
        keep_replicate(drawing);
        done++;
    }
    tl_progress_end(&drawing->progress);
    return done;
}

static void allocate_directions(struct drawing *drawing)
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
    struct drawing drawing = {.scene = &scene,
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
