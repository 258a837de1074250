#include "render/metrics/flip.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* -- Colour [Andersson et al. 2020, 4.1]
 * --------------------------------------------------------------------- */

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

/* All kernels separate into (sums of) products of 1D filters. */
enum kernel_name {
    ACHROMATIC, /* contrast sensitivity: normalised Gaussians */
    RED_GREEN,
    BLUE_YELLOW_WIDE,
    BLUE_YELLOW_NARROW,
    SMOOTH, /* features: a Gaussian and its first two derivatives */
    EDGE,
    POINT,
    KERNEL_COUNT
};

struct filters {
    struct {
        int radius;
        float *weights; /* [2 radius + 1] */
    } kernels[KERNEL_COUNT];
    float wide_share; /* weight of the wide one of the two Gaussians for blue-yellow */
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
    const double b[4] = {0.0047, 0.0053, 0.04, 0.025}; /* in the order of enum kernel_name */
    const double blue_yellow_a[2] = {34.1, 13.5};
    const double feature_width = 0.082; /* degrees, from peak to trough of the edge detector */

    struct filters filters = {0};
    int radius = (int)ceil(3 * sensitivity_sigma(b[BLUE_YELLOW_WIDE], pixels_per_degree));
    double volumes[2];
    for (int i = 0; i < 4; i++) {
        filters.kernels[i].radius = radius;
        filters.kernels[i].weights = gaussian(radius, sensitivity_sigma(b[i], pixels_per_degree));
    }
    for (int i = 0; i < 2; i++) {
        /* the sum of a Gaussian whose peak is 1 */
        double sum = 1 / (double)filters.kernels[BLUE_YELLOW_WIDE + i].weights[radius];
        volumes[i] = blue_yellow_a[i] * sqrt(M_PI / b[BLUE_YELLOW_WIDE + i]) * sum * sum;
    }
    filters.wide_share = (float)(volumes[0] / (volumes[0] + volumes[1]));

    double sigma = 0.5 * feature_width * pixels_per_degree;
    int feature_radius = (int)ceil(3 * sigma);
    for (int i = SMOOTH; i <= POINT; i++)
        filters.kernels[i].radius = feature_radius;
    filters.kernels[SMOOTH].weights = gaussian(feature_radius, sigma);
    filters.kernels[EDGE].weights = derivative(feature_radius, sigma, 1);
    filters.kernels[POINT].weights = derivative(feature_radius, sigma, 2);
    return filters;
}

static void filters_release(struct filters *filters)
{
    for (int i = 0; i < KERNEL_COUNT; i++)
        free(filters->kernels[i].weights);
    *filters = (struct filters){0};
}

static int clamp_index(int value, int count)
{
    return value < 0 ? 0 : value >= count ? count - 1 : value;
}

/* -- One image ------------------------------------------------------------------------------------------ */

enum plane_name {
    LUMINANCE, /* opponent colours before filtering */
    RED_GREEN_OPPONENT,
    BLUE_YELLOW_OPPONENT,
    GREY,                         /* the achromatic image in [0, 1] */
    ROWS,                         /* filtered along x, one plane a kernel */
    COLOUR = ROWS + KERNEL_COUNT, /* Hunt-adjusted CIELAB of what is seen, three planes */
    NARROW = COLOUR + 3,          /* scratch: the other blue-yellow Gaussian */
    EDGES,                        /* along x and along y */
    POINTS = EDGES + 2,           /* likewise */
    PLANE_COUNT = POINTS + 2
};

/* The source of each kernel along x, and the kernels along y. */
static const enum plane_name row_sources[KERNEL_COUNT] = {
    LUMINANCE, RED_GREEN_OPPONENT, BLUE_YELLOW_OPPONENT, BLUE_YELLOW_OPPONENT, GREY, GREY, GREY};
static const struct {
    enum kernel_name rows, columns;
    enum plane_name target;
} column_passes[] = {
    {ACHROMATIC, ACHROMATIC, COLOUR},
    {RED_GREEN, RED_GREEN, COLOUR + 1},
    {BLUE_YELLOW_WIDE, BLUE_YELLOW_WIDE, COLOUR + 2},
    {BLUE_YELLOW_NARROW, BLUE_YELLOW_NARROW, NARROW},
    {EDGE, SMOOTH, EDGES},
    {SMOOTH, EDGE, EDGES + 1},
    {POINT, SMOOTH, POINTS},
    {SMOOTH, POINT, POINTS + 1},
};

struct analysis {
    const struct tl_flip_frame *frame;
    const struct filters *filters;
    float *planes; /* [PLANE_COUNT][height][width] */
};

static float *line_of(const struct analysis *analysis, int plane, int y)
{
    size_t line = (size_t)plane * (size_t)analysis->frame->height + (size_t)y;
    return analysis->planes + line * (size_t)analysis->frame->width;
}

/* out[x] = sum of weights[i] line[x + i], in three parts: taps before the line, inside of it and after it. */
static void filter_row(const struct analysis *analysis, enum kernel_name kernel, int y)
{
    const float *line = line_of(analysis, row_sources[kernel], y);
    float *out = line_of(analysis, ROWS + (int)kernel, y);
    int width = analysis->frame->width, radius = analysis->filters->kernels[kernel].radius;
    memset(out, 0, (size_t)width * sizeof(float));
    for (int i = -radius; i <= radius; i++) {
        float weight = analysis->filters->kernels[kernel].weights[i + radius];
        int begin = clamp_index(-i, width + 1), end = clamp_index(width - i, width + 1);
        for (int x = 0; x < begin; x++)
            out[x] += weight * line[0];
        for (int x = begin; x < end; x++)
            out[x] += weight * line[x + i];
        for (int x = end; x < width; x++)
            out[x] += weight * line[width - 1];
    }
}

static void filter_column(const struct analysis *analysis, size_t pass, int y)
{
    enum kernel_name kernel = column_passes[pass].columns;
    float *out = line_of(analysis, (int)column_passes[pass].target, y);
    int width = analysis->frame->width, radius = analysis->filters->kernels[kernel].radius;
    memset(out, 0, (size_t)width * sizeof(float));
    for (int i = -radius; i <= radius; i++) {
        float weight = analysis->filters->kernels[kernel].weights[i + radius];
        int row = clamp_index(y + i, analysis->frame->height);
        const float *line = line_of(analysis, ROWS + (int)column_passes[pass].rows, row);
        for (int x = 0; x < width; x++)
            out[x] += weight * line[x];
    }
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

static void split_opponents(const struct analysis *analysis, const struct display *display, const float *rgb,
                            int y)
{
    const float *texel = rgb + 3 * (size_t)y * (size_t)analysis->frame->width;
    float *luminance = line_of(analysis, LUMINANCE, y), *grey = line_of(analysis, GREY, y);
    float *red_green = line_of(analysis, RED_GREEN_OPPONENT, y);
    float *blue_yellow = line_of(analysis, BLUE_YELLOW_OPPONENT, y);
    for (int x = 0; x < analysis->frame->width; x++, texel += 3) {
        struct colour shown = {show(display, texel[0]), show(display, texel[1]), show(display, texel[2])};
        struct colour opponent = opponent_from_rgb(shown);
        luminance[x] = opponent.a;
        red_green[x] = opponent.b;
        blue_yellow[x] = opponent.c;
        grey[x] = (opponent.a + 16) / 116;
    }
}

static void adjust_colours(const struct analysis *analysis, int y)
{
    float *a = line_of(analysis, COLOUR, y), *b = line_of(analysis, COLOUR + 1, y);
    float *c = line_of(analysis, COLOUR + 2, y);
    const float *narrow = line_of(analysis, NARROW, y);
    float share = analysis->filters->wide_share;
    for (int x = 0; x < analysis->frame->width; x++) {
        struct colour opponent = {a[x], b[x], share * c[x] + (1 - share) * narrow[x]};
        struct colour hunt = hunt_from_rgb(rgb_from_opponent(opponent));
        a[x] = hunt.a;
        b[x] = hunt.b;
        c[x] = hunt.c;
    }
}

static void analyse(const struct analysis *analysis, const struct display *display, const float *rgb)
{
#pragma omp parallel for
    for (int y = 0; y < analysis->frame->height; y++) {
        split_opponents(analysis, display, rgb, y);
        for (int kernel = 0; kernel < KERNEL_COUNT; kernel++)
            filter_row(analysis, (enum kernel_name)kernel, y);
    }
#pragma omp parallel for
    for (int y = 0; y < analysis->frame->height; y++) {
        for (size_t pass = 0; pass < TL_COUNT(column_passes); pass++)
            filter_column(analysis, pass, y);
        adjust_colours(analysis, y);
    }
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

static struct colour colour_at(const struct analysis *analysis, int x, int y)
{
    return (struct colour){line_of(analysis, COLOUR, y)[x], line_of(analysis, COLOUR + 1, y)[x],
                           line_of(analysis, COLOUR + 2, y)[x]};
}

/* Length of the two responses that start at `plane`. */
static float feature_at(const struct analysis *analysis, int plane, int x, int y)
{
    float along_x = line_of(analysis, plane, y)[x], along_y = line_of(analysis, plane + 1, y)[x];
    return sqrtf(along_x * along_x + along_y * along_y);
}

/* Replaces `map` by the error of each pixel where that is larger. */
static void raise_map(const struct analysis *test, const struct analysis *reference, float *map)
{
    float largest = largest_colour_difference();
    int width = test->frame->width;
#pragma omp parallel for
    for (int y = 0; y < test->frame->height; y++) {
        float *out = map + (size_t)y * (size_t)width;
        for (int x = 0; x < width; x++) {
            float colour = colour_difference(colour_at(test, x, y), colour_at(reference, x, y), largest);
            float edge = fabsf(feature_at(test, EDGES, x, y) - feature_at(reference, EDGES, x, y));
            float point = fabsf(feature_at(test, POINTS, x, y) - feature_at(reference, POINTS, x, y));
            float feature = powf(fmaxf(edge, point) / sqrtf(2), FEATURE_EXPONENT);
            out[x] = fmaxf(out[x], powf(colour, 1 - feature));
        }
    }
}

uint64_t tl_flip_bytes(const struct tl_flip_frame *frame)
{
    const uint64_t images = 2;
    return images * PLANE_COUNT * sizeof(float) * (uint64_t)frame->width * (uint64_t)frame->height;
}

static void raise_by_displays(const struct tl_flip_frame *frame, const float *test, const float *reference,
                              const struct display displays[], int display_count, float *map)
{
    size_t pixel_count = (size_t)frame->width * (size_t)frame->height;
    struct filters filters = filters_create(frame->pixels_per_degree);
    struct analysis seen[2];
    for (int i = 0; i < 2; i++)
        seen[i] = (struct analysis){frame, &filters, TL_NEW_ARRAY(float, PLANE_COUNT *pixel_count)};
    memset(map, 0, pixel_count * sizeof(float));
    for (int i = 0; i < display_count; i++) {
        analyse(&seen[0], &displays[i], test);
        analyse(&seen[1], &displays[i], reference);
        raise_map(&seen[0], &seen[1], map);
    }
    free(seen[0].planes);
    free(seen[1].planes);
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

/* The input at which the tone mapper's curve reaches t. */
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
