#include "render/metrics/compare.h"

#include "render/metrics/flip.h"

#include "config/base/memory.h"
#include "config/colour/luminance.h"
#include "config/colour/srgb.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Below this range the filters of FLIP are narrower than a pixel; above it they only cost time (a phone in
 * the hand has 120). */
#define PIXELS_PER_DEGREE_MIN 10
#define PIXELS_PER_DEGREE_MAX 1000

/* An image prepared for comparison: linear RGB and its covered pixels. */
struct plain {
    size_t count;
    float *rgb; /* [count][3] */
    bool *covered;
};

static float channel_value(const tl_image *image, size_t index, bool colour)
{
    if (image->type == TL_IMAGE_F32)
        return tl_image_floats(image)[index];
    float value = (float)tl_image_bytes(image)[index] / 255;
    return colour && !image->linear ? tl_srgb_to_linear(value) : value;
}

static bool plain_create(const tl_image *image, const char *role, struct plain *out, tl_error *error)
{
    size_t channels = (size_t)image->channels, colours = channels >= 3 ? 3 : 1;
    *out = (struct plain){.count = (size_t)image->width * (size_t)image->height};
    out->rgb = TL_NEW_ARRAY(float, 3 * out->count);
    out->covered = TL_NEW_ARRAY(bool, out->count);
    for (size_t i = 0; i < out->count; i++) {
        for (size_t c = 0; c < 3; c++) {
            float value = channel_value(image, channels * i + (colours == 3 ? c : 0), true);
            if (!isfinite(value))
                return tl_fail(error, TL_INPUT,
                               "the %s image: pixel (%zu, %zu) is not a finite number: render it again", role,
                               i % (size_t)image->width, i / (size_t)image->width);
            out->rgb[3 * i + c] = value;
        }
        out->covered[i] = channels == colours || channel_value(image, channels * i + colours, false) > 0;
    }
    return true;
}

static void plain_release(struct plain *plain)
{
    free(plain->rgb);
    free(plain->covered);
    *plain = (struct plain){0};
}

/* Merges the coverage of both images into `reference->covered`: a pixel counts if either image covers it.
 * Returns the number of covered pixels. */
static size_t join_coverage(const struct plain *test, struct plain *reference)
{
    size_t covered = 0;
    for (size_t i = 0; i < test->count; i++) {
        reference->covered[i] |= test->covered[i];
        covered += reference->covered[i];
    }
    return covered;
}

static void measure_difference(const struct plain *test, const struct plain *reference,
                               struct tl_comparison *out)
{
    double squares = 0, sum = 0, worst = 0;
    for (size_t i = 0; i < test->count; i++) {
        double square = 0;
        for (size_t c = 3 * i; reference->covered[i] && c < 3 * i + 3; c++) {
            double difference = (double)test->rgb[c] - (double)reference->rgb[c];
            square += difference * difference;
            sum += (double)reference->rgb[c];
            out->max_abs = fmax(out->max_abs, fabs(difference));
        }
        squares += square;
        out->worst = square > worst ? i : out->worst;
        worst = fmax(worst, square);
    }
    out->worst_share = squares > 0 ? worst / squares : 0;
    double values = 3 * (double)out->covered;
    /* Against a black reference only an equal image has a finite error. */
    out->rel_rmse = squares > 0 ? sqrt(squares / values) / (sum / values) : 0;
}

static bool needs_hdr(const struct plain *reference)
{
    for (size_t i = 0; i < 3 * reference->count; i++)
        if (reference->covered[i / 3] && reference->rgb[i] > 1)
            return true;
    return false;
}

static bool find_exposures(const struct plain *reference, struct tl_comparison *out, tl_error *error)
{
    float *luminances = TL_NEW_ARRAY(float, out->covered);
    size_t count = 0;
    for (size_t i = 0; i < reference->count; i++) {
        const float *rgb = reference->rgb + 3 * i;
        if (reference->covered[i])
            luminances[count++] = tl_luminance(rgb);
    }
    bool found = tl_flip_exposures(luminances, count, &out->exposure_start, &out->exposure_stop);
    free(luminances);
    return found || tl_fail(error, TL_INPUT,
                            "the reference image: half of its covered pixels are black, so HDR-FLIP finds no "
                            "exposure for them: compare as LDR");
}

static bool measure_flip(const struct tl_flip_frame *frame, const struct plain *test,
                         const struct plain *reference, struct tl_comparison *out, tl_error *error)
{
    if (out->hdr && !find_exposures(reference, out, error))
        return false;
    float *map = TL_NEW_ARRAY(float, test->count);
    if (out->hdr)
        tl_flip_hdr(frame, test->rgb, reference->rgb, out->exposure_start, out->exposure_stop, map);
    else
        tl_flip_ldr(frame, test->rgb, reference->rgb, map);
    double covered = 0, all = 0;
    for (size_t i = 0; i < test->count; i++) {
        all += (double)map[i];
        covered += reference->covered[i] ? (double)map[i] : 0;
    }
    out->flip_mean = covered / (double)out->covered;
    out->flip_frame = all / (double)test->count;
    free(map);
    return true;
}

static bool check_sizes(const tl_image *a, const tl_image *b, tl_error *error)
{
    return (a->width == b->width && a->height == b->height) ||
           tl_fail(error, TL_INPUT, "compare: one image is %d x %d, the other %d x %d: render both the same",
                   a->width, a->height, b->width, b->height);
}

static bool frame_of(const tl_image *image, double pixels_per_degree, struct tl_flip_frame *out,
                     tl_error *error)
{
    *out = (struct tl_flip_frame){image->width, image->height,
                                  pixels_per_degree > 0 ? pixels_per_degree : TL_FLIP_PIXELS_PER_DEGREE};
    return (out->pixels_per_degree >= PIXELS_PER_DEGREE_MIN &&
            out->pixels_per_degree <= PIXELS_PER_DEGREE_MAX) ||
           tl_fail(error, TL_USAGE, "compare: %g pixels per degree: give %d to %d", pixels_per_degree,
                   PIXELS_PER_DEGREE_MIN, PIXELS_PER_DEGREE_MAX);
}

/* Besides the two images: both as colours and coverage, what FLIP takes, its map and the luminances. */
static bool request_memory(const struct tl_flip_frame *frame, tl_error *error)
{
    const uint64_t plain_bytes = 3 * sizeof(float) + sizeof(bool), map_bytes = 2 * sizeof(float);
    uint64_t pixels = (uint64_t)frame->width * (uint64_t)frame->height;
    char what[64];
    snprintf(what, sizeof what, "compare: images of %d x %d", frame->width, frame->height);
    return tl_memory_request(what, pixels * (2 * plain_bytes + map_bytes) + tl_flip_bytes(frame), error);
}

bool tl_image_compare(const tl_image *a, const tl_image *b, int hdr, double pixels_per_degree,
                      struct tl_comparison *out, tl_error *error)
{
    *out = (struct tl_comparison){0};
    struct tl_flip_frame frame;
    if (!check_sizes(a, b, error) || !frame_of(a, pixels_per_degree, &frame, error) ||
        !request_memory(&frame, error))
        return false;

    struct plain test = {0}, reference = {0};
    bool done = false;
    if (!plain_create(a, "tested", &test, error) || !plain_create(b, "reference", &reference, error))
        goto cleanup;
    out->covered = join_coverage(&test, &reference);
    if (out->covered == 0) {
        tl_fail(error, TL_INPUT,
                "compare: neither image covers a pixel (alpha > 0): render something into them");
        goto cleanup;
    }
    measure_difference(&test, &reference, out);
    out->hdr = hdr < 0 ? needs_hdr(&reference) : hdr > 0;
    done = measure_flip(&frame, &test, &reference, out, error);
cleanup:
    plain_release(&test);
    plain_release(&reference);
    return done;
}

/* ---- One object's pixels ---- */

static bool is_object(const tl_image *mask, size_t pixel)
{
    return channel_value(mask, pixel * (size_t)mask->channels, false) > 0.5f;
}

static int compare_falling(const void *a, const void *b)
{
    float first = *(const float *)a, second = *(const float *)b;
    return (first < second) - (first > second);
}

/* The mean of the first `count` values. */
static double mean_of(const float *values, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += (double)values[i];
    return count ? sum / (double)count : (double)NAN;
}

/* Keeps the mask's values of the map, and sorts them from the largest down. */
static void measure_object(const tl_image *mask, float *map, size_t count, struct tl_object_error *out)
{
    for (size_t i = 0; i < count; i++)
        if (is_object(mask, i))
            map[out->pixels++] = map[i];
    qsort(map, out->pixels, sizeof *map, compare_falling);
    out->flip_mean = mean_of(map, out->pixels);
    out->flip_worst = mean_of(map, (size_t)ceil(TL_FLIP_WORST_SHARE * (double)out->pixels));
}

bool tl_image_compare_object(const tl_image *a, const tl_image *b, const tl_image *mask,
                             double pixels_per_degree, struct tl_object_error *out, tl_error *error)
{
    *out = (struct tl_object_error){.flip_mean = NAN, .flip_worst = NAN};
    struct tl_flip_frame frame;
    if (!check_sizes(a, b, error) || !frame_of(a, pixels_per_degree, &frame, error) ||
        !request_memory(&frame, error))
        return false;
    if (mask->width != a->width || mask->height != a->height)
        return tl_fail(error, TL_INPUT,
                       "compare: the mask is %d x %d, the images are %d x %d: give one of "
                       "their size",
                       mask->width, mask->height, a->width, a->height);
    struct plain test = {0}, reference = {0};
    bool done = plain_create(a, "tested", &test, error) && plain_create(b, "reference", &reference, error);
    if (done) {
        float *map = TL_NEW_ARRAY(float, test.count);
        tl_flip_ldr(&frame, test.rgb, reference.rgb, map);
        measure_object(mask, map, test.count, out);
        free(map);
    }
    plain_release(&test);
    plain_release(&reference);
    return done;
}
