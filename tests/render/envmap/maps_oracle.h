/* The reference for environment maps, without any map: a smooth environment as a function of direction, its
 * integrals, and the laws of reflection, in double. */
#ifndef TOILE_TESTS_RENDER_MAPS_ORACLE_H
#define TOILE_TESTS_RENDER_MAPS_ORACLE_H

#include "tests/render/scenes.h"

#include "config/base/memory.h"
#include "render/env/layout.h"

#include <math.h>

/* Two coloured lights and a glow: smooth, so that a map's texels are no part of the question. */
static inline vec3s lights(vec3s d)
{
    float first = fmaxf(glms_vec3_dot(d, glms_vec3_normalize((vec3s){{0.5f, 0.7f, 0.6f}})), 0);
    float second = fmaxf(glms_vec3_dot(d, glms_vec3_normalize((vec3s){{-0.6f, 0.1f, -0.8f}})), 0);
    float warm = 3 * powf(first, 6), cold = 2 * powf(second, 6);
    return (vec3s){{0.2f + warm, 0.2f + 0.7f * warm + 0.6f * cold, 0.2f + cold + 0.2f * d.y}};
}
#define BRIGHTEST 3.2

/* The directions and solid angles of an environment's texels, made for the last size. */
struct oracle_texels {
    int width, height;
    vec3s *directions;
    double *solid_angles;
};

static inline const struct oracle_texels *oracle_texels_of(const tl_image *image)
{
    static struct oracle_texels texels;
    const struct tl_sphere_map map = {TL_LAYOUT_LATLONG, image->width, image->height};
    const int count = image->width * image->height;
    if (texels.width == image->width && texels.height == image->height)
        return &texels;
    free(texels.directions);
    free(texels.solid_angles);
    texels = (struct oracle_texels){image->width, image->height, TL_NEW_ARRAY(vec3s, (size_t)count),
                                    TL_NEW_ARRAY(double, (size_t)count)};
    for (int i = 0; i < count; i++) {
        const int x = i % map.width, y = i / map.width;
        texels.directions[i] = tl_layout_direction(&map, x + 0.5, y + 0.5);
        texels.solid_angles[i] = tl_layout_solid_angle(&map, x, y);
    }
    return &texels;
}

/* K_s integrated over the environment's texels. */
static inline vec3s integrate(const tl_environment *environment, vec3s direction, double s)
{
    const tl_image *image = &environment->image;
    const struct oracle_texels *texels = oracle_texels_of(image);
    double sum[3] = {0, 0, 0};
    for (int i = 0; i < image->width * image->height; i++) {
        double cosine = (double)glms_vec3_dot(texels->directions[i], direction);
        if (cosine <= 0)
            continue;
        double weight = (s + 1) / (2 * M_PI) * pow(cosine, s) * texels->solid_angles[i];
        for (int c = 0; c < 3; c++)
            sum[c] += weight * (double)tl_image_floats(image)[3 * i + c];
    }
    return (vec3s){{(float)sum[0], (float)sum[1], (float)sum[2]}};
}

static inline vec3s mirrored_ray(vec3s normal, vec3s viewer)
{
    return glms_vec3_sub(glms_vec3_scale(normal, 2 * glms_vec3_dot(normal, viewer)), viewer);
}

/* Snell's law by angles. `normal` is on the viewer's side, which is within the material when `inside`. */
static inline vec3s refracted_ray(vec3s normal, vec3s viewer, double index, bool inside, bool *total)
{
    double cosine = (double)glms_vec3_dot(normal, viewer);
    double sine = sqrt(1 - cosine * cosine) * (inside ? index : 1 / index);
    *total = sine > 1;
    if (*total)
        return mirrored_ray(normal, viewer);
    vec3s along = glms_vec3_sub(glms_vec3_scale(normal, (float)cosine), viewer);
    vec3s straight = glms_vec3_scale(normal, -(float)sqrt(1 - sine * sine));
    return glms_vec3_add(straight, glms_vec3_scale(glms_vec3_normalize(along), (float)sine));
}

/* Fresnel's equations by angles [Born and Wolf 1999, 1.5.2]. */
static inline double dielectric(double index, double cosine)
{
    double sine = sqrt(1 - cosine * cosine) / index, inner = sqrt(1 - sine * sine);
    double across = (cosine - index * inner) / (cosine + index * inner);
    double along = (index * cosine - inner) / (index * cosine + inner);
    return 0.5 * (across * across + along * along);
}

#endif
