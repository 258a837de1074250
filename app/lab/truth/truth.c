#include "app/lab/truth/truth.h"

#include "config/base/memory.h"
#include "render/inside.h"
#include "render/reference/lamps.h"
#include "render/reference/radiance.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

enum { TILE = TL_TRUTH_TILE, TILE_PIXELS = TILE * TILE, PAIRS = 4, REPLICATES = 2 * PAIRS, SUSPECTS = 48 };
static_assert((int)TILE_PIXELS == (int)TL_SHADING_POINTS, "a tile is a batch");

/* Rays of one replicate. The two of a pair trace the same samples of a pixel, so that they differ by the
 * noise of the light alone. */
struct effort {
    int strata, lobe_samples;
    bool all_samples; /* of a pixel, in every replicate; else one for a pair, in turn */
};
static const struct effort quick = {.strata = 8, .lobe_samples = 1},
                           thorough = {.strata = 48, .lobe_samples = 8, .all_samples = true};
enum { STRATA_MAX = 48 };

struct comparison {
    struct tl_reference_scene scene;
    struct tl_view view;
    int width, height, side; /* pixels; samples along one of them */
    int tiles_x, tiles_y;
    float *cover;               /* [height][width] the reference's, by quick rays */
    const tl_material *garment; /* materials of the last surface */
    size_t garment_materials;
    struct tile_light **thorough; /* of each tile that was traced with many rays so far; else NULL */
};

/* The light of a tile, by pixel, replicate and channel. */
struct tile_light {
    double rgb[TILE_PIXELS][REPLICATES][3];
    double cover[TILE_PIXELS];
    bool is_garment[TILE_PIXELS]; /* some ray hits it */
};

/* Sums over pixels, by channel: of the reference's light, of image - reference, and of the variance of the
 * reference's noise in that. */
struct channel_sums {
    double light[3], difference[3], variance[3];
};

/* What is kept of a tile. */
struct tile_sums {
    int count;               /* of covered pixels */
    double square, variance; /* of the pixels' differences; of the reference's noise in them; over channels */
    struct channel_sums all, garment;
    double worst;    /* the largest square of a pixel, */
    int worst_pixel; /* and which */
};

/* ---- The reference in a tile ---- */

/* One sample of each pixel of a tile, or what is left of it behind layers of open cloth. */
struct sample_rays {
    int count, pixels[TILE_PIXELS];
    struct tl_ray_differential rays[TILE_PIXELS];
    float shares[TILE_PIXELS];
};

struct sample_hits {
    struct tl_shading_points points;
    int pixels[TILE_PIXELS];
    float shares[TILE_PIXELS];
    vec3s lamplight[TILE_PIXELS];
    bool is_garment[TILE_PIXELS];
};

static struct sample_rays rays_of(const struct comparison *comparison, int tile, int sample)
{
    int side = comparison->side;
    int left = tile % comparison->tiles_x * TILE, top = tile / comparison->tiles_x * TILE;
    struct sample_rays rays = {0};
    for (int i = 0; i < TILE_PIXELS; i++) {
        int x = left + i % TILE, y = top + i / TILE;
        if (x >= comparison->width || y >= comparison->height)
            continue;
        rays.rays[rays.count] =
            tl_camera_ray(&comparison->view, comparison->width * side, comparison->height * side,
                          x * side + sample % side, y * side + sample / side);
        rays.pixels[rays.count] = i;
        rays.shares[rays.count++] = 1;
    }
    return rays;
}

/* The rays that continue behind open cloth are left in `rays`. The last layer counts as closed. */
static void intersect(const struct comparison *comparison, bool last, struct sample_rays *rays,
                      struct sample_hits *hits)
{
    int through = 0;
    size_t traced = 0;
    *hits = (struct sample_hits){0};
    for (int i = 0; i < rays->count; i++) {
        struct tl_shading_point point = tl_shading_point_find(&comparison->scene, &rays->rays[i]);
        if (!(point.cover > 0))
            continue;
        float openness = point.layered && !last ? point.layers.openness : 0;
        int at = hits->points.count;
        hits->pixels[at] = rays->pixels[i];
        hits->shares[at] = rays->shares[i] * point.cover * (1 - openness);
        hits->lamplight[at] = tl_reference_lamps(&comparison->scene, &point, &traced);
        hits->is_garment[at] = point.material >= comparison->garment &&
                               point.material < comparison->garment + comparison->garment_materials;
        tl_shading_points_add(&hits->points, &point);
        if (!(openness > 0))
            continue;
        rays->rays[through] = rays->rays[i];
        rays->rays[through].from_m = point.distance_m + comparison->scene.offset_m;
        rays->pixels[through] = rays->pixels[i];
        rays->shares[through++] = rays->shares[i] * openness;
    }
    rays->count = through;
}

struct tracing {
    const struct comparison *comparison;
    struct effort effort;
    int tile, replicate;
    const struct tl_sky_sample *sky;
    double weight; /* of a sample in its pixel's mean */
};

static void add_light(const struct tracing *tracing, const struct sample_hits *hits, uint64_t turn,
                      struct tile_light *light)
{
    const struct tl_reference_scene *scene = &tracing->comparison->scene;
    const struct tl_radiance_request request = {
        .direct = {.scene = scene,
                   .strata = tracing->effort.strata,
                   .sky = tracing->sky,
                   .lobe_samples = tracing->effort.lobe_samples,
                   .random =
                       tl_random_begin((uint64_t)tracing->tile << 16 | (uint64_t)tracing->replicate, turn)},
        .bounces = scene->bounces,
        .bounce_samples = tracing->effort.lobe_samples,
        .reflect = scene->reflect};
    float gathered[3][TL_SHADING_POINTS];
    tl_radiance(&request, &hits->points, gathered);
    for (int i = 0; i < hits->points.count; i++) {
        double share = tracing->weight * (double)hits->shares[i];
        for (int c = 0; c < 3; c++)
            light->rgb[hits->pixels[i]][tracing->replicate][c] +=
                share * (double)(gathered[c][i] + hits->lamplight[i].raw[c]);
        light->cover[hits->pixels[i]] += share / REPLICATES;
        light->is_garment[hits->pixels[i]] |= hits->is_garment[i];
    }
}

static void trace_sample(const struct tracing *tracing, int sample, struct tile_light *light)
{
    struct sample_rays rays = rays_of(tracing->comparison, tracing->tile, sample);
    for (int layer = 0; layer <= TL_TRANSPARENCY_LAYERS && rays.count > 0; layer++) {
        struct sample_hits hits;
        intersect(tracing->comparison, layer == TL_TRANSPARENCY_LAYERS, &rays, &hits);
        if (hits.points.count > 0)
            add_light(tracing, &hits, (uint64_t)sample << 8 | (uint64_t)layer, light);
    }
}

static struct tile_light trace_tile(const struct comparison *comparison, int tile, struct effort effort)
{
    struct tile_light light = {0};
    struct tl_sky_sample sky[STRATA_MAX];
    int samples = comparison->side * comparison->side;
    for (int r = 0; r < REPLICATES; r++) {
        uint64_t key = (uint64_t)tile * REPLICATES + (uint64_t)r;
        tl_gather_sample_sky(&comparison->scene.sky, effort.strata, 0, 1, tl_random_begin(~key, 0),
                             tl_random_begin(~key, 1), sky);
        const struct tracing tracing = {comparison, effort, tile,
                                        r,          sky,    effort.all_samples ? 1.0 / samples : 1};
        if (!effort.all_samples)
            trace_sample(&tracing, (r / 2 + tile) % samples, &light);
        for (int sample = 0; effort.all_samples && sample < samples; sample++)
            trace_sample(&tracing, sample, &light);
    }
    return light;
}

/* ---- Comparison ---- */

/* The mean of replicates, and the variance of that mean, from the differences of pairs. */
static double mean_of(const double *values, int stride, double *variance)
{
    double sum = 0, squares = 0;
    for (int pair = 0; pair < PAIRS; pair++) {
        double one = values[(ptrdiff_t)2 * pair * stride], other = values[(ptrdiff_t)(2 * pair + 1) * stride];
        sum += one + other;
        squares += (one - other) * (one - other);
    }
    *variance = squares / (REPLICATES * REPLICATES);
    return sum / REPLICATES;
}

/* Adds one pixel, with the variance of its own noise. */
static void compare_pixel(const double light[REPLICATES][3], const float *got, int pixel,
                          struct tile_sums *sums, struct channel_sums *to)
{
    double square = 0;
    for (int c = 0; c < 3; c++) {
        double variance, mean = mean_of(&light[0][c], 3, &variance), off = (double)got[c] - mean;
        square += off * off;
        sums->variance += variance;
        to->light[c] += mean;
        to->difference[c] += off;
    }
    sums->square += square;
    sums->count++;
    if (!(square <= sums->worst)) { /* a NaN is kept */
        sums->worst = square;
        sums->worst_pixel = pixel;
    }
}

static void add_channels(const struct channel_sums *from, struct channel_sums *to)
{
    for (int c = 0; c < 3; c++) {
        to->light[c] += from->light[c];
        to->difference[c] += from->difference[c];
        to->variance[c] += from->variance[c];
    }
}

/* Pixels of a tile share the rays' directions, so that the noise of their sum is that of whole replicates. */
static struct tile_sums compare_tile(const struct comparison *comparison, const tl_image *image, int tile,
                                     const struct tile_light *light)
{
    int left = tile % comparison->tiles_x * TILE, top = tile / comparison->tiles_x * TILE;
    struct tile_sums sums = {.worst = -1};
    double whole[2][REPLICATES][3] = {{{0}}}; /* without and with the garment */
    for (int i = 0; i < TILE_PIXELS; i++) {
        int x = left + i % TILE, y = top + i / TILE;
        if (x >= comparison->width || y >= comparison->height)
            continue;
        int pixel = y * comparison->width + x;
        bool is_garment = light->is_garment[i];
        const float *got = tl_image_floats(image) + 4 * (size_t)pixel;
        if (!(got[3] > 0) && !(light->cover[i] > 0))
            continue;
        compare_pixel(light->rgb[i], got, pixel, &sums, is_garment ? &sums.garment : &sums.all);
        for (int r = 0; r < REPLICATES; r++)
            for (int c = 0; c < 3; c++)
                whole[is_garment][r][c] += light->rgb[i][r][c];
    }
    for (int c = 0; c < 3; c++) {
        mean_of(&whole[0][0][c], 3, &sums.all.variance[c]);
        mean_of(&whole[1][0][c], 3, &sums.garment.variance[c]);
    }
    add_channels(&sums.garment, &sums.all);
    return sums;
}

/* The tiles' light of many rays. It is the same for every image and each list of suspects, which share most
 * tiles. */
static void trace_thoroughly(const struct comparison *comparison, const int *tiles, int count)
{
    int needed[SUSPECTS], needed_count = 0;
    assert(count <= SUSPECTS);
    for (int i = 0; i < count; i++)
        if (!comparison->thorough[tiles[i]]) {
            comparison->thorough[tiles[i]] = TL_NEW(struct tile_light);
            needed[needed_count++] = tiles[i];
        }
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < needed_count; i++)
        *comparison->thorough[needed[i]] = trace_tile(comparison, needed[i], thorough);
}

/* ---- All tiles ---- */

static void keep_cover(const struct comparison *comparison, int tile, const struct tile_light *light)
{
    int left = tile % comparison->tiles_x * TILE, top = tile / comparison->tiles_x * TILE;
    for (int i = 0; i < TILE_PIXELS; i++) {
        int x = left + i % TILE, y = top + i / TILE;
        if (x < comparison->width && y < comparison->height)
            comparison->cover[y * comparison->width + x] = (float)light->cover[i];
    }
}

/* How far the image's outlines lie from the reference's, in pixels: the displacement d that explains the
 * difference of coverages best, image - reference = -d . gradient, by least squares over all pixels [Lucas
 * and Kanade 1981]. Returns false where outlines do not run in two directions. */
static bool find_displacement(const struct comparison *comparison, const tl_image *image, vec2s *out)
{
    const float *got = tl_image_floats(image) + 3, *cover = comparison->cover;
    double xx = 0, xy = 0, yy = 0, x_off = 0, y_off = 0;
    int width = comparison->width;
    for (int y = 1; y + 1 < comparison->height; y++)
        for (int x = 1; x + 1 < width; x++) {
            int at = y * width + x;
            double along = 0.5 * (double)(cover[at + 1] - cover[at - 1]);
            double down = 0.5 * (double)(cover[at + width] - cover[at - width]);
            double off = (double)(cover[at] - got[4 * (ptrdiff_t)at]);
            xx += along * along, xy += along * down, yy += down * down;
            x_off += along * off, y_off += down * off;
        }
    double determinant = xx * yy - xy * xy;
    *out = (vec2s){
        {(float)((yy * x_off - xy * y_off) / determinant), (float)((xx * y_off - xy * x_off) / determinant)}};
    return determinant > 1e-3 * xx * yy;
}

static void add_all(const struct tile_sums *tiles, int count, struct tile_sums *whole)
{
    *whole = (struct tile_sums){.worst = -1};
    for (int i = 0; i < count; i++) {
        whole->count += tiles[i].count;
        whole->square += tiles[i].square;
        whole->variance += tiles[i].variance;
        add_channels(&tiles[i].all, &whole->all);
        add_channels(&tiles[i].garment, &whole->garment);
        if (tiles[i].count > 0 && !(tiles[i].worst <= whole->worst)) {
            whole->worst = tiles[i].worst;
            whole->worst_pixel = tiles[i].worst_pixel;
        }
    }
}

/* |difference| less so many standard errors, relative to `base`, of the worst channel. */
static double worst_channel(const struct channel_sums *sums, const double base[3], double deviations)
{
    double worst = 0;
    for (int c = 0; c < 3; c++) {
        double off = fabs(sums->difference[c]) - deviations * sqrt(sums->variance[c]);
        if (base[c] > 0 && !(off / base[c] <= worst))
            worst = off / base[c];
    }
    return worst;
}

/* As struct tl_truth has it, less `deviations` standard errors. */
static double tile_error(const struct tile_sums *tile, const struct tile_sums *whole, double deviations)
{
    double base[3];
    for (int c = 0; c < 3; c++)
        base[c] = tile->all.light[c] + whole->all.light[c] / whole->count * TILE_PIXELS;
    return worst_channel(&tile->all, base, deviations);
}

struct suspect {
    double error;
    int tile; /* of a block: its upper left one */
};

/* Descending; NaN first. */
static int by_error(const void *a, const void *b)
{
    const struct suspect *x = a, *y = b;
    if (isnan(x->error) || isnan(y->error))
        return (isnan(y->error) ? 1 : 0) - (isnan(x->error) ? 1 : 0);
    return (x->error < y->error) - (x->error > y->error);
}

/* The least error of a block of 2 x 2 tiles; a NaN counts as more than any number. */
static double min_of(const double errors[4])
{
    double minimum = NAN;
    for (int i = 0; i < 4; i++)
        minimum = fmin(minimum, errors[i]); /* of a NaN and a number: the number */
    return minimum;
}

static int tile_of_block(const struct comparison *comparison, int block, int i)
{
    return block + i % 2 + i / 2 * comparison->tiles_x;
}

static double thorough_error(const struct comparison *comparison, const tl_image *image, int tile,
                             const struct tile_sums *whole)
{
    struct tile_sums sums = compare_tile(comparison, image, tile, comparison->thorough[tile]);
    return tile_error(&sums, whole, 3);
}

/* Few rays are too noisy to find the worst tile or block: those that seem to be are traced again. */
static void find_worst_tile(const struct comparison *comparison, const tl_image *image,
                            struct suspect *suspects, int count, const struct tile_sums *whole,
                            struct tl_truth *out)
{
    int again = count < SUSPECTS ? count : SUSPECTS, tiles[SUSPECTS] = {0};
    qsort(suspects, (size_t)count, sizeof *suspects, by_error);
    for (int i = 0; i < again; i++)
        tiles[i] = suspects[i].tile;
    trace_thoroughly(comparison, tiles, again);
    for (int i = 0; i < again; i++)
        suspects[i].error = thorough_error(comparison, image, tiles[i], whole);
    qsort(suspects, (size_t)again, sizeof *suspects, by_error);
    out->tile_error = suspects[0].error;
    out->tile_x = suspects[0].tile % comparison->tiles_x * TILE + TILE / 2;
    out->tile_y = suspects[0].tile / comparison->tiles_x * TILE + TILE / 2;
}

static void find_worst_block(const struct comparison *comparison, const tl_image *image,
                             struct suspect *suspects, int count, const struct tile_sums *whole,
                             struct tl_truth *out)
{
    int again = count < SUSPECTS / 4 ? count : SUSPECTS / 4, tiles[SUSPECTS] = {0};
    double errors[SUSPECTS];
    qsort(suspects, (size_t)count, sizeof *suspects, by_error);
    for (int i = 0; i < 4 * again; i++)
        tiles[i] = tile_of_block(comparison, suspects[i / 4].tile, i % 4);
    trace_thoroughly(comparison, tiles, 4 * again);
    for (int i = 0; i < 4 * again; i++)
        errors[i] = thorough_error(comparison, image, tiles[i], whole);
    for (int i = 0; i < again; i++)
        suspects[i].error = min_of(errors + (ptrdiff_t)4 * i);
    qsort(suspects, (size_t)again, sizeof *suspects, by_error);
    out->patch_error = again > 0 ? suspects[0].error : 0;
    out->patch_x = again > 0 ? (suspects[0].tile % comparison->tiles_x + 1) * TILE : 0;
    out->patch_y = again > 0 ? (suspects[0].tile / comparison->tiles_x + 1) * TILE : 0;
}

static void find_worst(const struct comparison *comparison, const tl_image *image,
                       const struct tile_sums *tiles, const struct tile_sums *whole, struct tl_truth *out)
{
    int count = comparison->tiles_x * comparison->tiles_y, blocks = 0;
    struct suspect *suspects = TL_NEW_ARRAY(struct suspect, (size_t)count);
    for (int i = 0; i < count; i++)
        suspects[i] = (struct suspect){tile_error(&tiles[i], whole, 1), i};
    find_worst_tile(comparison, image, suspects, count, whole, out);
    for (int y = 0; y + 1 < comparison->tiles_y; y++)
        for (int x = 0; x + 1 < comparison->tiles_x; x++) {
            int block = y * comparison->tiles_x + x;
            double errors[4];
            for (int i = 0; i < 4; i++)
                errors[i] = tile_error(&tiles[tile_of_block(comparison, block, i)], whole, 1);
            suspects[blocks++] = (struct suspect){min_of(errors), block};
        }
    find_worst_block(comparison, image, suspects, blocks, whole, out);
    free(suspects);
}

static struct tl_truth judge(const struct comparison *comparison, const tl_image *image,
                             const struct tile_sums *tiles)
{
    struct tl_truth out = {0};
    struct tile_sums whole;
    add_all(tiles, comparison->tiles_x * comparison->tiles_y, &whole);
    out.has_outlines = find_displacement(comparison, image, &out.displacement);
    if (whole.count > 0) {
        double values = 3.0 * whole.count, square = (whole.square - whole.variance) / values;
        double mean = (whole.all.light[0] + whole.all.light[1] + whole.all.light[2]) / values;
        out.error = square <= 0 ? 0 : sqrt(square) / mean;
        out.mean_error = worst_channel(&whole.all, whole.all.light, 3);
        out.garment_error = worst_channel(&whole.garment, whole.garment.light, 3);
        out.worst_x = whole.worst_pixel % comparison->width;
        out.worst_y = whole.worst_pixel / comparison->width;
        find_worst(comparison, image, tiles, &whole, &out);
    }
    return out;
}

/* A NaN is worse than any number. */
static bool is_worse(double a, double b)
{
    return isnan(a) || a > b;
}

/* Keeps the worse of both in `a`, figure by figure. */
static void keep_worse(struct tl_truth *a, const struct tl_truth *b)
{
    if (is_worse(b->error, a->error)) {
        a->error = b->error;
        a->worst_x = b->worst_x;
        a->worst_y = b->worst_y;
    }
    if (is_worse(b->tile_error, a->tile_error)) {
        a->tile_error = b->tile_error;
        a->tile_x = b->tile_x;
        a->tile_y = b->tile_y;
    }
    if (is_worse(b->patch_error, a->patch_error)) {
        a->patch_error = b->patch_error;
        a->patch_x = b->patch_x;
        a->patch_y = b->patch_y;
    }
    if (b->has_outlines && (!a->has_outlines || is_worse((double)glms_vec2_norm(b->displacement),
                                                         (double)glms_vec2_norm(a->displacement)))) {
        a->has_outlines = true;
        a->displacement = b->displacement;
    }
    a->mean_error = is_worse(b->mean_error, a->mean_error) ? b->mean_error : a->mean_error;
    a->garment_error = is_worse(b->garment_error, a->garment_error) ? b->garment_error : a->garment_error;
}

static void compare(const struct comparison *comparison, const tl_image *const *images, int image_count,
                    struct tl_truth *out)
{
    int count = comparison->tiles_x * comparison->tiles_y;
    struct tile_sums *tiles = TL_NEW_ARRAY(struct tile_sums, (size_t)count * (size_t)image_count);
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < count; i++) {
        struct tile_light light = trace_tile(comparison, i, quick);
        for (int k = 0; k < image_count; k++)
            tiles[k * count + i] = compare_tile(comparison, images[k], i, &light);
        keep_cover(comparison, i, &light);
    }
    for (int k = 0; k < image_count; k++) {
        struct tl_truth one = judge(comparison, images[k], tiles + (ptrdiff_t)k * count);
        if (k == 0)
            *out = one;
        else
            keep_worse(out, &one);
    }
    free(tiles);
}

bool tl_truth_is_comparable(const struct tl_render_settings *settings)
{
    return settings->light.method == TL_METHOD_PEM && settings->image.view == TL_VIEW_LIGHT;
}

/* The materials of the frame's last surface. */
static void find_garment(const tl_frame *frame, struct comparison *comparison)
{
    const tl_surface *garment = &frame->surfaces[frame->surface_count - 1];
    comparison->garment = garment->materials;
    for (size_t p = 0; p < garment->part_count; p++) {
        size_t needed = (size_t)garment->parts[p].material + 1;
        if (needed > comparison->garment_materials)
            comparison->garment_materials = needed;
    }
}

bool tl_truth_compare(const tl_frame *frame, const struct tl_render_settings *settings,
                      const tl_renderer *renderer, const tl_image *const *images, int image_count,
                      struct tl_truth *out, tl_error *error)
{
    const struct tl_ground *ground = tl_ground_drawn(tl_renderer_frame_resources(renderer));
    const struct tl_reference_request request = tl_frame_reference_request(frame, settings, ground);
    int width = images[0]->width, height = images[0]->height;
    struct comparison comparison = {.view = tl_view_make(&frame->camera, width, height),
                                    .width = width,
                                    .height = height,
                                    .side = settings->image.supersample,
                                    .tiles_x = (width + TILE - 1) / TILE,
                                    .tiles_y = (height + TILE - 1) / TILE};
    size_t tile_count = (size_t)comparison.tiles_x * (size_t)comparison.tiles_y;
    find_garment(frame, &comparison);
    if (!tl_reference_scene_make(&request, &comparison.scene, error))
        return false;
    comparison.cover = TL_NEW_ARRAY(float, (size_t)width *(size_t)height);
    comparison.thorough = TL_NEW_ARRAY(struct tile_light *, tile_count);
    compare(&comparison, images, image_count, out);
    for (size_t i = 0; i < tile_count; i++)
        free(comparison.thorough[i]);
    free(comparison.thorough);
    free(comparison.cover);
    tl_reference_scene_release(&comparison.scene);
    return true;
}
