#include "render/pem/lobe_error.h"

#include "render/pem/lobe.h"

#include <math.h>

#define POINTS_ALONG 3 /* TL_LOBE_SOURCE_POINTS is its square */

struct tl_lobe_source tl_lobe_source(int size, vec3s direction)
{
    int texel = tl_cube_texel(size, direction);
    int face = texel / (size * size), y = texel / size % size, x = texel % size;
    float radiance = 1 / tl_cube_solid_angle(size, x, y);
    struct tl_lobe_source source = {.texel = texel, .power = {{radiance, radiance, radiance}}};
    for (int i = 0; i < TL_LOBE_SOURCE_POINTS; i++) {
        int fine_x = POINTS_ALONG * x + i % POINTS_ALONG, fine_y = POINTS_ALONG * y + i / POINTS_ALONG;
        float step = 1 / (float)(POINTS_ALONG * size);
        source.points[i] = glms_vec3_normalize(
            tl_cube_direction(face, ((float)fine_x + 0.5f) * step, ((float)fine_y + 0.5f) * step));
        source.weights[i] =
            (double)tl_cube_solid_angle(POINTS_ALONG * size, fine_x, fine_y) * (double)radiance;
    }
    return source;
}

static double wanted(const struct tl_lobe_source *source, float s, vec3s direction)
{
    double sum = 0;
    for (int i = 0; i < TL_LOBE_SOURCE_POINTS; i++)
        sum += source->weights[i] * (double)tl_lobe_cosine(s, glms_vec3_dot(source->points[i], direction));
    return sum;
}

/* Rings and spokes of the quadrature, whose density over the front half is a cosine lobe of half the
 * exponent; the back half has none of the light and few directions. */
#define RINGS  64
#define BACK   12
#define SPOKES 48

struct tl_lobe_error tl_lobe_measure(const struct tl_lobe_source *source, float s, tl_lobe_response *response,
                                     const void *filter)
{
    vec3s axis = source->points[TL_LOBE_SOURCE_POINTS / 2];
    vec3s right = glms_vec3_ortho(axis);
    right = glms_vec3_normalize(right);
    vec3s up = glms_vec3_cross(axis, right);
    double error = 0, energy = 0, whole = 0, wide = (double)s / 2;
    for (int ring = 0; ring < RINGS + BACK; ring++) {
        bool front = ring < RINGS;
        double cosine = front ? pow((ring + 0.5) / RINGS, 1 / (wide + 1)) : -(ring - RINGS + 0.5) / BACK;
        double sine = sqrt(1 - cosine * cosine);
        double share = front ? 2 * M_PI / ((wide + 1) * pow(cosine, wide)) / RINGS : 2 * M_PI / BACK;
        for (int spoke = 0; spoke < SPOKES; spoke++) {
            /* Rings are turned against each other by the golden section, lest spokes follow a texel grid. */
            double phi = 2 * M_PI * (fmod(ring * 0.6180339887498949, 1) + spoke) / SPOKES;
            vec3s direction = glms_vec3_scale(axis, (float)cosine);
            direction = glms_vec3_muladds(right, (float)(sine * cos(phi)), direction);
            direction = glms_vec3_muladds(up, (float)(sine * sin(phi)), direction);
            double got = response(filter, direction), lobe = wanted(source, s, direction);
            error += share / SPOKES * fabs(got - lobe);
            energy += share / SPOKES * got;
            whole += share / SPOKES * lobe;
        }
    }
    return (struct tl_lobe_error){error / whole, energy / whole};
}
