#include "render/metrics/flip.h"

#include "config/memory.h"

#include <math.h>
#include <stdlib.h>

/* -- Colour [HPG 2020, section 4.1] --------------------------------------------------------------------- */

struct colour {
    float a, b, c;
};

/* Rec. 709 with D65 white, and its inverse. */
static struct colour xyz_from_rgb(struct colour rgb)
{
    return (struct colour){
        0.412386563f * rgb.a + 0.357591490f * rgb.b + 0.180450486f * rgb.c,
        0.212636820f * rgb.a + 0.715182981f * rgb.b + 0.072180194f * rgb.c,
        0.019330620f * rgb.a + 0.119197164f * rgb.b + 0.950372587f * rgb.c,
    };
}

static struct colour rgb_from_xyz(struct colour xyz)
{
    return (struct colour){
        3.241003275f * xyz.a - 1.537398934f * xyz.b - 0.498615861f * xyz.c,
        -0.969224334f * xyz.a + 1.875930071f * xyz.b + 0.041554224f * xyz.c,
        0.055639423f * xyz.a - 0.204011202f * xyz.b + 1.057148933f * xyz.c,
    };
}

static const struct colour white = {0.950428545f, 1, 1.088900371f};

/* Luminance and two opponents: CIELAB without its cube roots. */
static struct colour opponent_from_rgb(struct colour rgb)
{
    struct colour xyz = xyz_from_rgb(rgb);
    float x = xyz.a / white.a, y = xyz.b, z = xyz.c / white.c;
    return (struct colour){116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

static float clamp_unit(float value)
{
    return value < 0 ? 0 : value > 1 ? 1 : value;
}

static struct colour rgb_from_opponent(struct colour opponent)
{
    float y = (opponent.a + 16) / 116;
    struct colour xyz = {(y + opponent.b / 500) * white.a, y, (y - opponent.c / 200) * white.c};
    struct colour rgb = rgb_from_xyz(xyz);
    return (struct colour){clamp_unit(rgb.a), clamp_unit(rgb.b), clamp_unit(rgb.c)};
}

static float lab_curve(float value)
{
    const float delta = 6.0f / 29;
    return value > delta * delta * delta ? cbrtf(value) : value / (3 * delta * delta) + 4.0f / 29;
}

/* CIELAB whose chroma grows with lightness, as Hunt observed. */
static struct colour hunt_from_rgb(struct colour rgb)
{
    struct colour xyz = xyz_from_rgb(rgb);
    float x = lab_curve(xyz.a / white.a), y = lab_curve(xyz.b), z = lab_curve(xyz.c / white.c);
    float lightness = 116 * y - 16;
    return (struct colour){lightness, 0.01f * lightness * 500 * (x - y), 0.01f * lightness * 200 * (y - z)};
}

static float hyab_distance(struct colour p, struct colour q)
{
    float a = p.b - q.b, b = p.c - q.c;
    return fabsf(p.a - q.a) + sqrtf(a * a + b * b);
}

/* -- Filters -------------------------------------------------------------------------------------------- */

/* All of them separate into sums of products of 1D filters, here [2 radius + 1]. */
struct filters {
    int radius;
    float *achromatic, *red_green, *blue_yellow[2]; /* contrast sensitivity: normalised Gaussians */
    float blue_yellow_share[2];
    int feature_radius;
    float *gauss, *edge, *point; /* a Gaussian and its first two derivatives */
};

static float *gaussian(int radius, double sigma)
{
    float *weights = TL_NEW_ARRAY(float, 2 * (size_t)radius + 1);
    double sum = 0;
    for (int i = -radius; i <= radius; i++)
        sum += exp(-i * i / (2 * sigma * sigma));
    for (int i = -radius; i <= radius; i++)
        weights[i + radius] = (float)(exp(-i * i / (2 * sigma * sigma)) / sum);
    return weights;
}

/* First (order 1) or second derivative of a Gaussian; its positive weights sum to 1, its negative to -1. */
static float *derivative(int radius, double sigma, int order)
{
    float *weights = TL_NEW_ARRAY(float, 2 * (size_t)radius + 1);
    double positive = 0, negative = 0;
    for (int i = -radius; i <= radius; i++) {
        double weight = (order == 1 ? -i : i * i / (sigma * sigma) - 1) * exp(-i * i / (2 * sigma * sigma));
        *(weight > 0 ? &positive : &negative) += fabs(weight);
        weights[i + radius] = (float)weight;
    }
    for (int i = 0; i <= 2 * radius; i++)
        weights[i] /= (float)(weights[i] > 0 ? positive : negative);
    return weights;
}

/* The fits of contrast sensitivity are a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees, with b of table 1:
 * Gaussians of this sigma in pixels. */
static double sensitivity_sigma(double b, double pixels_per_degree)
{
    return sqrt(b / 2) / M_PI * pixels_per_degree;
}

static struct filters filters_create(double pixels_per_degree)
{
    const double achromatic_b = 0.0047, red_green_b = 0.0053;
    const double blue_yellow_a[2] = {34.1, 13.5}, blue_yellow_b[2] = {0.04, 0.025};
    const double feature_width = 0.082; /* degrees, from peak to trough of the edge detector */

    struct filters filters = {0};
    filters.radius = (int)ceil(3 * sensitivity_sigma(blue_yellow_b[0], pixels_per_degree));
    filters.achromatic = gaussian(filters.radius, sensitivity_sigma(achromatic_b, pixels_per_degree));
    filters.red_green = gaussian(filters.radius, sensitivity_sigma(red_green_b, pixels_per_degree));
    double volumes[2];
    for (int i = 0; i < 2; i++) {
        double sigma = sensitivity_sigma(blue_yellow_b[i], pixels_per_degree);
        filters.blue_yellow[i] = gaussian(filters.radius, sigma);
        double sum = (double)(1 / filters.blue_yellow[i][filters.radius]); /* of one whose middle is 1 */
        volumes[i] = blue_yellow_a[i] * sqrt(M_PI / blue_yellow_b[i]) * sum * sum;
    }
    for (int i = 0; i < 2; i++)
        filters.blue_yellow_share[i] = (float)(volumes[i] / (volumes[0] + volumes[1]));

    double sigma = 0.5 * feature_width * pixels_per_degree;
    filters.feature_radius = (int)ceil(3 * sigma);
    filters.gauss = gaussian(filters.feature_radius, sigma);
    filters.edge = derivative(filters.feature_radius, sigma, 1);
    filters.point = derivative(filters.feature_radius, sigma, 2);
    return filters;
}

static void filters_release(struct filters *filters)
{
    free(filters->achromatic);
    free(filters->red_green);
    free(filters->blue_yellow[0]);
    free(filters->blue_yellow[1]);
    free(filters->gauss);
    free(filters->edge);
    free(filters->point);
    *filters = (struct filters){0};
}

static int clamp_index(int value, int count)
{
    return value < 0 ? 0 : value >= count ? count - 1 : value;
}

/* target[y][x] = sum of weights[i] source[y][x + i] (or [y + i][x]). */
static void filter_rows(const struct tl_flip_frame *frame, const float *source, const float *weights,
                        int radius, float *target)
{
    int width = frame->width;
#pragma omp parallel for
    for (int y = 0; y < frame->height; y++) {
        const float *line = source + (size_t)y * (size_t)width;
        float *out = target + (size_t)y * (size_t)width;
        for (int x = 0; x < width; x++)
            out[x] = 0;
        for (int i = -radius; i <= radius; i++) {
            float weight = weights[i + radius];
            /* the part that reads inside the frame, then what goes on beyond it */
            int begin = clamp_index(-i, width + 1), end = clamp_index(width - i, width + 1);
            for (int x = 0; x < begin; x++)
                out[x] += weight * line[0];
            for (int x = begin; x < end; x++)
                out[x] += weight * line[x + i];
            for (int x = end; x < width; x++)
                out[x] += weight * line[width - 1];
        }
    }
}

static void filter_columns(const struct tl_flip_frame *frame, const float *source, const float *weights,
                           int radius, float *target)
{
    int width = frame->width;
#pragma omp parallel for
    for (int y = 0; y < frame->height; y++) {
        float *out = target + (size_t)y * (size_t)width;
        for (int x = 0; x < width; x++)
            out[x] = 0;
        for (int i = -radius; i <= radius; i++) {
            float weight = weights[i + radius];
            const float *line = source + (size_t)clamp_index(y + i, frame->height) * (size_t)width;
            for (int x = 0; x < width; x++)
                out[x] += weight * line[x];
        }
    }
}

/* -- One image ------------------------------------------------------------------------------------------ */

/* What is compared of an image, all [height][width]. */
struct features {
    float *opponent[3]; /* unfiltered; the first is overwritten by the achromatic image in [0, 1] */
    float *colour[3];   /* filtered: opponents, then Hunt-adjusted CIELAB */
    float *edge[2], *point[2];
    float *rows, *extra; /* scratch */
};

#define FEATURE_PLANES 12
static struct features features_create(const struct tl_flip_frame *frame)
{
    size_t count = (size_t)frame->width * (size_t)frame->height;
    float *planes = TL_NEW_ARRAY(float, FEATURE_PLANES *count);
    struct features features = {0};
    float **names[FEATURE_PLANES] = {
        &features.opponent[0], &features.opponent[1], &features.opponent[2], &features.colour[0],
        &features.colour[1],   &features.colour[2],   &features.edge[0],     &features.edge[1],
        &features.point[0],    &features.point[1],    &features.rows,        &features.extra,
    };
    for (size_t i = 0; i < FEATURE_PLANES; i++)
        *names[i] = planes + i * count;
    return features;
}

static void features_release(struct features *features)
{
    free(features->opponent[0]);
    *features = (struct features){0};
}

/* `along_x` and `along_y` one after the other. */
static void filter_plane(const struct tl_flip_frame *frame, struct features *features, const float *source,
                         const float *along_x, const float *along_y, int radius, float *target)
{
    filter_rows(frame, source, along_x, radius, features->rows);
    filter_columns(frame, features->rows, along_y, radius, target);
}

static void filter_colours(const struct tl_flip_frame *frame, const struct filters *filters,
                           struct features *features)
{
    int radius = filters->radius, count = frame->width * frame->height;
    const float *const *blue_yellow = (const float *const *)filters->blue_yellow;
    filter_plane(frame, features, features->opponent[0], filters->achromatic, filters->achromatic, radius,
                 features->colour[0]);
    filter_plane(frame, features, features->opponent[1], filters->red_green, filters->red_green, radius,
                 features->colour[1]);
    filter_plane(frame, features, features->opponent[2], blue_yellow[0], blue_yellow[0], radius,
                 features->colour[2]);
    filter_plane(frame, features, features->opponent[2], blue_yellow[1], blue_yellow[1], radius,
                 features->extra);
#pragma omp parallel for
    for (int i = 0; i < count; i++) {
        float blue_yellow_sum = filters->blue_yellow_share[0] * features->colour[2][i] +
                                filters->blue_yellow_share[1] * features->extra[i];
        struct colour opponent = {features->colour[0][i], features->colour[1][i], blue_yellow_sum};
        struct colour hunt = hunt_from_rgb(rgb_from_opponent(opponent));
        features->colour[0][i] = hunt.a;
        features->colour[1][i] = hunt.b;
        features->colour[2][i] = hunt.c;
    }
}

/* Edges and points of the achromatic image [HPG 2020, section 4.2]. */
static void detect_features(const struct tl_flip_frame *frame, const struct filters *filters,
                            struct features *features)
{
    int radius = filters->feature_radius, count = frame->width * frame->height;
    float *grey = features->opponent[0];
#pragma omp parallel for
    for (int i = 0; i < count; i++)
        grey[i] = (grey[i] + 16) / 116;
    filter_plane(frame, features, grey, filters->edge, filters->gauss, radius, features->edge[0]);
    filter_plane(frame, features, grey, filters->gauss, filters->edge, radius, features->edge[1]);
    filter_plane(frame, features, grey, filters->point, filters->gauss, radius, features->point[0]);
    filter_plane(frame, features, grey, filters->gauss, filters->point, radius, features->point[1]);
}

/* Exposure and tone mapping of one channel; without them for LDR. */
struct display {
    bool tone_mapped;
    double scale; /* 2^exposure */
};

/* Narkowicz' fit of ACES, its pre-exposure of 0.6 put back: (k0 x^2 + k1 x) / (k3 x^2 + k4 x + k5). */
static const double aces[6] = {0.6 * 0.6 * 2.51, 0.6 * 0.03, 0, 0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14};

static float show(const struct display *display, float value)
{
    if (!display->tone_mapped)
        return clamp_unit(value);
    double x = (double)(value > 0 ? value : 0) * display->scale;
    return clamp_unit((float)(((aces[0] * x + aces[1]) * x) / ((aces[3] * x + aces[4]) * x + aces[5])));
}

static void analyse(const struct tl_flip_frame *frame, const struct filters *filters,
                    const struct display *display, const float *rgb, struct features *features)
{
    int count = frame->width * frame->height;
#pragma omp parallel for
    for (int i = 0; i < count; i++) {
        const float *texel = rgb + 3 * (size_t)i;
        struct colour shown = {show(display, texel[0]), show(display, texel[1]), show(display, texel[2])};
        struct colour opponent = opponent_from_rgb(shown);
        features->opponent[0][i] = opponent.a;
        features->opponent[1][i] = opponent.b;
        features->opponent[2][i] = opponent.c;
    }
    filter_colours(frame, filters, features);
    detect_features(frame, filters, features);
}

/* -- Two images ----------------------------------------------------------------------------------------- */

#define COLOUR_EXPONENT  0.7f
#define FEATURE_EXPONENT 0.5f

/* The largest distance within the gamut, between green and blue, to the power of COLOUR_EXPONENT. */
static float largest_colour_difference(void)
{
    struct colour green = hunt_from_rgb((struct colour){0, 1, 0}),
                  blue = hunt_from_rgb((struct colour){0, 0, 1});
    return powf(hyab_distance(green, blue), COLOUR_EXPONENT);
}

/* Compresses large differences: the first two fifths of the range take 95 % of the result. */
static float colour_difference(struct colour p, struct colour q, float largest)
{
    const float knee = 0.4f * largest, knee_value = 0.95f;
    float difference = powf(hyab_distance(p, q), COLOUR_EXPONENT);
    if (difference < knee)
        return knee_value / knee * difference;
    return knee_value + (difference - knee) / (largest - knee) * (1 - knee_value);
}

static float magnitude_difference(float *const p[2], float *const q[2], int i)
{
    float first = sqrtf(p[0][i] * p[0][i] + p[1][i] * p[1][i]);
    float second = sqrtf(q[0][i] * q[0][i] + q[1][i] * q[1][i]);
    return fabsf(first - second);
}

static struct colour colour_at(const struct features *features, int i)
{
    return (struct colour){features->colour[0][i], features->colour[1][i], features->colour[2][i]};
}

/* Raises `map` to the error of each pixel where that is larger. */
static void raise_map(const struct tl_flip_frame *frame, const struct features *test,
                      const struct features *reference, float *map)
{
    float largest = largest_colour_difference();
    int count = frame->width * frame->height;
#pragma omp parallel for
    for (int i = 0; i < count; i++) {
        float colour = colour_difference(colour_at(test, i), colour_at(reference, i), largest);
        float edge = magnitude_difference(test->edge, reference->edge, i);
        float point = magnitude_difference(test->point, reference->point, i);
        float feature = powf(fmaxf(edge, point) / sqrtf(2), FEATURE_EXPONENT);
        map[i] = fmaxf(map[i], powf(colour, 1 - feature));
    }
}

static void raise_by_displays(const struct tl_flip_frame *frame, const float *test, const float *reference,
                              const struct display displays[], int display_count, float *map)
{
    struct filters filters = filters_create(frame->pixels_per_degree);
    struct features test_features = features_create(frame), reference_features = features_create(frame);
    for (int i = 0; i < frame->width * frame->height; i++)
        map[i] = 0;
    for (int i = 0; i < display_count; i++) {
        analyse(frame, &filters, &displays[i], test, &test_features);
        analyse(frame, &filters, &displays[i], reference, &reference_features);
        raise_map(frame, &test_features, &reference_features, map);
    }
    features_release(&test_features);
    features_release(&reference_features);
    filters_release(&filters);
}

void tl_flip_ldr(const struct tl_flip_frame *frame, const float *test, const float *reference, float *map)
{
    raise_by_displays(frame, test, reference, &(struct display){.tone_mapped = false}, 1, map);
}

static int compare_floats(const void *a, const void *b)
{
    float left = *(const float *)a, right = *(const float *)b;
    return (left > right) - (left < right);
}

/* Where the tone mapper's curve reaches t. */
static double shown_at(double t)
{
    double a = aces[0] - t * aces[3], b = aces[1] - t * aces[4], c = aces[2] - t * aces[5];
    return (-b + sqrt(b * b - 4 * a * c)) / (2 * a);
}

bool tl_flip_exposures(float *luminances, size_t count, double *start, double *stop)
{
    *start = *stop = (double)NAN;
    if (count == 0)
        return false;
    qsort(luminances, count, sizeof(float), compare_floats);
    double largest = (double)luminances[count - 1];
    double median = 0.5 * ((double)luminances[(count - 1) / 2] + (double)luminances[count / 2]);
    *start = log2(shown_at(0.85) / largest);
    *stop = log2(shown_at(0.85) / median);
    return isfinite(*start) && isfinite(*stop);
}

void tl_flip_hdr(const struct tl_flip_frame *frame, const float *test, const float *reference, double start,
                 double stop, float *map)
{
    int count = (int)fmax(2, ceil(stop - start));
    struct display *displays = TL_NEW_ARRAY(struct display, (size_t)count);
    for (int i = 0; i < count; i++)
        displays[i] = (struct display){true, exp2(start + (stop - start) * i / (count - 1))};
    raise_by_displays(frame, test, reference, displays, count, map);
    free(displays);
}
