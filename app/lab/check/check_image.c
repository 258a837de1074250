/* Invariants of one image, and of images that must agree. */
#include "app/lab/check/check_measures.h"

#include <math.h>
#include <string.h>

static size_t pixel_count(const tl_image *image)
{
    return (size_t)image->width * (size_t)image->height;
}

static void place_pixel(struct tl_finding *finding, const tl_image *image, size_t pixel)
{
    size_t width = (size_t)image->width;
    tl_finding_pixel(finding, (int)(pixel % width), (int)(pixel / width));
}

static void measure_pixels(const tl_image *image, struct tl_finding *finding)
{
    size_t bad = 0, first = 0;
    const float *values = tl_image_floats(image);
    for (size_t i = 0; i < 4 * pixel_count(image); i++)
        if (!isfinite(values[i]) && bad++ == 0)
            first = i / 4;
    if (tl_finding_add(finding, (double)bad) && bad > 0)
        place_pixel(finding, image, first);
}

static void measure_coverage(const tl_image *image, struct tl_finding *finding)
{
    const float *values = tl_image_floats(image);
    for (size_t i = 0; i < pixel_count(image); i++) {
        double alpha = (double)values[4 * i + 3];
        if (tl_finding_add(finding, alpha < 0 ? -alpha : alpha > 1 ? alpha - 1 : 0 * alpha))
            place_pixel(finding, image, i);
    }
}

static void measure_negative(const tl_image *image, struct tl_finding *finding)
{
    const float *values = tl_image_floats(image);
    for (size_t i = 0; i < 4 * pixel_count(image); i++)
        if (i % 4 != 3 && tl_finding_add(finding, values[i] < 0 ? -(double)values[i] : 0))
            place_pixel(finding, image, i / 4);
}

/* What every image must be, as it is kept and as budgets draw it. */
static void measure_both(const struct tl_checked *checked, struct tl_finding *finding,
                         void (*measure)(const tl_image *image, struct tl_finding *finding))
{
    measure(checked->image, finding);
    if (checked->in_motion)
        measure(checked->in_motion, finding);
}

void tl_measure_pixels(const struct tl_checked *checked, struct tl_finding *finding)
{
    measure_both(checked, finding, measure_pixels);
}

void tl_measure_coverage(const struct tl_checked *checked, struct tl_finding *finding)
{
    measure_both(checked, finding, measure_coverage);
}

void tl_measure_negative(const struct tl_checked *checked, struct tl_finding *finding)
{
    measure_both(checked, finding, measure_negative);
}

/* sqrt(mean (a - b)^2) / mean b over the covered pixels and their channels, as render/metrics/compare.h has
 * it but without what FLIP costs; and the worst pixel. */
static double relative_error(const tl_image *a, const tl_image *b, size_t *worst)
{
    double squares = 0, sum = 0, largest = -1;
    size_t count = 0;
    for (size_t i = 0; i < pixel_count(a); i++) {
        const float *x = tl_image_floats(a) + 4 * i, *y = tl_image_floats(b) + 4 * i;
        if (!(x[3] > 0 || y[3] > 0))
            continue;
        double square = 0;
        for (int c = 0; c < 3; c++) {
            square += ((double)x[c] - (double)y[c]) * ((double)x[c] - (double)y[c]);
            sum += (double)y[c];
        }
        squares += square;
        count += 3;
        if (square > largest) {
            largest = square;
            *worst = i;
        }
    }
    if (count == 0 || squares == 0) // NOLINT: to the bit
        return 0;
    return sqrt(squares / (double)count) / (sum / (double)count);
}

/* Two images by rays differ by the errors of both: `toile bench light` reports 3 to 4.5 % for review in
 * motion; small images and fewer regions increase it. Maps are rebuilt whenever anything moves, so that the
 * images are equal except for the rounds that an image at rest has averaged. */
static double fresh_bound(const struct tl_light_params *light)
{
    const double by_rays = 0.12, by_jitter = 0.12, same = 1e-6;
    return light->visibility == TL_VISIBILITY_RAYS ? by_rays : light->jitter ? by_jitter : same;
}

void tl_measure_fresh(const struct tl_checked *checked, struct tl_finding *finding)
{
    size_t worst = 0;
    if (!checked->fresh)
        return;
    finding->bound = fresh_bound(&checked->settings->light);
    tl_finding_add(finding, relative_error(checked->image, checked->fresh, &worst));
    place_pixel(finding, checked->image, worst);
}

void tl_measure_repeat(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (!checked->first_hash)
        return;
    tl_finding_add(finding, checked->hash == checked->first_hash ? 0 : 1);
    tl_finding_place(finding, "%s",
                     checked->positions_hash != checked->first_positions_hash ? "in positions"
                     : checked->hash != checked->first_hash                   ? "in pixels only"
                                                                              : "");
}

/* If even the cheapest plan exceeds the budget, its predicted time is the bound. */
void tl_measure_budget(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (!(checked->budget_ms > 0) || !isfinite(checked->predicted_ms))
        return;
    double could_ms = fmax(checked->budget_ms, fmin(checked->min_ms, checked->predicted_ms));
    tl_finding_add(finding, checked->predicted_ms / could_ms);
    tl_finding_place(finding, "predicted %.1f ms of %.1f, the cheapest plan %.1f", checked->predicted_ms,
                     checked->budget_ms, checked->min_ms);
}
