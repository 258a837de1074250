#include "assets/adaptation.h"

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

/* The integral over all directions of radiance times the sine of the angle to the vertical, over pi squared.
 * A lat-long texel has a solid angle of 2 pi^2 sine / (width height). */
static void of_latlong(const tl_image *image, double sum[3])
{
    for (int y = 0; y < image->height; y++) {
        double sine = sin(M_PI * (y + 0.5) / image->height);
        add_row(tl_image_floats(image) + 3 * (size_t)y * (size_t)image->width, image->width,
                2 * sine * sine / ((double)image->width * image->height), sum);
    }
}

/* A cube's texel at (u, v) in [-1, 1]^2 of a face has a solid angle of (2 / side)^2 / r^3, r^2 = 1 + u^2 +
 * v^2. The vertical is v on the four side faces, and the faces' axis on the other two. */
static void of_cube(const tl_image *image, double sum[3])
{
    const int side = image->width;
    for (int face = 0; face < 6; face++)
        for (int y = 0; y < side; y++)
            for (int x = 0; x < side; x++) {
                double u = (2 * x + 1.0) / side - 1, v = (2 * y + 1.0) / side - 1, r2 = 1 + u * u + v * v;
                double height = face == 2 || face == 3 ? 1 : v;
                double weight = 4.0 / side / side / (r2 * sqrt(r2)) * sqrt(1 - height * height / r2);
                add_row(tl_image_floats(image) + 3 * ((size_t)(face * side + y) * (size_t)side + (size_t)x),
                        1, weight / (M_PI * M_PI), sum);
            }
}

vec3s tl_adaptation_to(const tl_environment *environment)
{
    double card[3] = {0}, white[3], total = 0;
    if (environment->layout == TL_ENV_CUBE)
        of_cube(&environment->image, card);
    else
        of_latlong(&environment->image, card);
    double bright = luminance(card);
    if (!(bright > 0) || !isfinite(bright))
        return (vec3s){{1, 1, 1}};
    /* A channel that is missing is no tint that could be taken away. */
    for (int c = 0; c < 3; c++)
        white[c] = pow(bright / fmax(card[c], 0.05 * bright), (double)TL_ADAPTED_WHITE);
    const double turned[3] = {white[0] * card[0], white[1] * card[1], white[2] * card[2]};
    total = (double)TL_ADAPTED_LUMINANCE / luminance(turned);
    total = fmin(fmax(total, 1 / (double)TL_ADAPTED_MOST), (double)TL_ADAPTED_MOST);
    return (vec3s){{(float)(total * white[0]), (float)(total * white[1]), (float)(total * white[2])}};
}
