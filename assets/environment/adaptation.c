#include "assets/environment/adaptation.h"

#include <math.h>

static double luminance(const double rgb[3])
{
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

/* Adds the texels of a row, all of one weight. */
static void add_row(const float *texels, int count, double weight, double sum[3])
{
    double row[3] = {0};
    for (int x = 0; x < count; x++)
        for (int c = 0; c < 3; c++)
            row[c] += (double)texels[3 * x + c];
    for (int c = 0; c < 3; c++)
        sum[c] += weight * row[c];
}

/* Light on cards, over pi. */
struct cards {
    double upright[3]; /* the mean over all that stand */
    double above[3];   /* a level one that faces up */
    double below[3];   /* ... and down */
};

/* A texel of solid angle `solid` sends sine / pi^2 of its radiance, times that angle, to upright cards, and
 * cosine / pi to a level one; `height` is the cosine of its angle to the vertical. */
static void add_texels(struct cards *cards, const float *texels, int count, double solid, double height)
{
    add_row(texels, count, solid * sqrt(fmax(1 - height * height, 0)) / (M_PI * M_PI), cards->upright);
    add_row(texels, count, solid * fabs(height) / M_PI, height > 0 ? cards->above : cards->below);
}

/* A row's texels have a solid angle of 2 pi^2 sine / (width height) each. */
static void add_latlong(struct cards *cards, const tl_image *image)
{
    for (int y = 0; y < image->height; y++) {
        double angle = M_PI * (y + 0.5) / image->height;
        double solid = 2 * M_PI * M_PI * sin(angle) / ((double)image->width * image->height);
        add_texels(cards, tl_image_floats(image) + 3 * (size_t)y * (size_t)image->width, image->width, solid,
                   cos(angle));
    }
}

/* A texel at (u, v) in [-1, 1]^2 of a face has a solid angle of (2 / side)^2 / r^3, r^2 = 1 + u^2 + v^2. The
 * vertical is -v on the four side faces, whose rows run downwards, and the axis of the other two. */
static void add_cube(struct cards *cards, const tl_image *image)
{
    const int side = image->width;
    for (int face = 0; face < 6; face++)
        for (int y = 0; y < side; y++)
            for (int x = 0; x < side; x++) {
                double u = (2 * x + 1.0) / side - 1, v = (2 * y + 1.0) / side - 1, r2 = 1 + u * u + v * v;
                double height = face == 2 ? 1 : face == 3 ? -1 : -v;
                const float *texel =
                    tl_image_floats(image) + 3 * ((size_t)(face * side + y) * (size_t)side + (size_t)x);
                add_texels(cards, texel, 1, 4.0 / side / side / (r2 * sqrt(r2)), height / sqrt(r2));
            }
}

static struct cards measure(const tl_environment *environment)
{
    struct cards cards = {0};
    if (environment->layout == TL_ENV_CUBE)
        add_cube(&cards, &environment->image);
    else
        add_latlong(&cards, &environment->image);
    return cards;
}

vec3s tl_adaptation_to(const tl_environment *environment)
{
    const struct cards cards = measure(environment);
    const double *card = cards.upright;
    double white[3], total, bright = luminance(card);
    if (!(bright > 0) || !isfinite(bright))
        return (vec3s){{1, 1, 1}};
    /* A channel that is missing is no tint that could be taken away. */
    for (int c = 0; c < 3; c++)
        white[c] = pow(bright / fmax(card[c], 0.05 * bright), (double)TL_ADAPTED_WHITE);
    const double turned[3] = {white[0] * card[0], white[1] * card[1], white[2] * card[2]};
    total = (double)TL_ADAPTED_LUMINANCE / luminance(turned);
    total = fmin(fmax(total, 1 / (double)TL_ADAPTED_MAX), (double)TL_ADAPTED_MAX);
    return (vec3s){{(float)(total * white[0]), (float)(total * white[1]), (float)(total * white[2])}};
}

vec3s tl_adaptation_ground(const tl_environment *environment)
{
    const struct cards cards = measure(environment);
    double share[3];
    for (int c = 0; c < 3; c++)
        share[c] = cards.below[c] / cards.above[c];
    double bright = luminance(share);
    if (!isfinite(bright))
        return glms_vec3_zero();
    if (!(bright > 0))
        return glms_vec3_fill(TL_GROUND_DARKEST);
    double bounded = fmin(fmax(bright, (double)TL_GROUND_DARKEST), (double)TL_GROUND_BRIGHTEST) / bright;
    vec3s ground;
    for (int c = 0; c < 3; c++) /* no ground sends back more than it gets */
        ground.raw[c] = (float)fmin(bounded * share[c], 1);
    return ground;
}

vec3s tl_adaptation_above(const tl_environment *environment)
{
    const struct cards cards = measure(environment);
    return (vec3s){{(float)cards.above[0], (float)cards.above[1], (float)cards.above[2]}};
}
