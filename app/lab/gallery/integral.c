#include "app/lab/gallery/integral.h"

#include "config/base/memory.h"
#include "render/brdf/facets.h"
#include "render/env/cube.h"

#include <math.h>
#include <stdlib.h>

/* The environment as a list of directions for sums: blocks of its texels, each with its mean radiance times
 * its solid angle. */
struct directions {
    int count;
    vec3s *toward, *power;
};

/* A lobe of exponent s has a standard deviation of about 1/sqrt(s). Blocks are at most a sixth of that: to
 * gather light in the middle of its block adds at most 1/432 to the lobe's variance. */
static int columns_for(float exponent, int maximum)
{
    double width = 1 / sqrt((double)fmaxf(exponent, 1));
    int columns = maximum;
    while (columns % 2 == 0 && columns >= 4 * M_PI * 6 / width)
        columns /= 2;
    return columns;
}

static vec3s direction_at(double u, double v)
{
    double azimuth = 2 * M_PI * (u - 0.5), polar = M_PI * v;
    return (vec3s){
        {(float)(sin(polar) * sin(azimuth)), (float)cos(polar), (float)(-sin(polar) * cos(azimuth))}};
}

static vec3s texel_of(const tl_image *image, int x, int y)
{
    const float *texel =
        tl_image_floats(image) + (size_t)image->channels * ((size_t)y * (size_t)image->width + (size_t)x);
    return (vec3s){{texel[0], texel[1], texel[2]}};
}

static struct directions directions_make(const tl_image *image, int columns)
{
    int block = image->width / columns, rows = image->height / block;
    struct directions list = {.count = columns * rows};
    list.toward = TL_NEW_ARRAY(vec3s, (size_t)list.count);
    list.power = TL_NEW_ARRAY(vec3s, (size_t)list.count);
    for (int i = 0; i < list.count; i++) {
        int column = i % columns, row = i / columns;
        for (int y = row * block; y < (row + 1) * block; y++) {
            double angle = 2 * M_PI / image->width *
                           (cos(M_PI * y / image->height) - cos(M_PI * (y + 1) / image->height));
            for (int x = column * block; x < (column + 1) * block; x++)
                list.power[i] =
                    glms_vec3_add(list.power[i], glms_vec3_scale(texel_of(image, x, y), (float)angle));
        }
        list.toward[i] = direction_at((column + 0.5) / columns, (row + 0.5) / rows);
    }
    return list;
}

static void directions_release(struct directions *list)
{
    free(list->toward);
    free(list->power);
}

struct integral {
    const struct tl_integral_request *request;
    struct directions diffuse, glossy;
    float exponent;
};

/* E(d, s) = (s + 1)/2pi sum of L(w) max(0, d.w)^s over all w. What is below the cutoff adds up to less than
 * 1e-5 of the lobe. */
static vec3s sum_lobe(const struct directions *list, vec3s about, float exponent)
{
    float cutoff = exponent > 1 ? powf(1e-6f, 1 / exponent) : 0;
    double sum[3] = {0, 0, 0};
    for (int i = 0; i < list->count; i++) {
        float cosine = glms_vec3_dot(about, list->toward[i]);
        if (!(cosine > cutoff))
            continue;
        float weight = exponent > 1 ? powf(cosine, exponent) : cosine;
        for (int c = 0; c < 3; c++)
            sum[c] += (double)(weight * list->power[i].raw[c]);
    }
    double scale = ((double)exponent + 1) / (2 * M_PI);
    return (vec3s){{(float)(scale * sum[0]), (float)(scale * sum[1]), (float)(scale * sum[2])}};
}

/* L(d), between the middles of four texels. */
static vec3s read_light(const tl_image *image, vec3s d)
{
    double u = 0.5 + atan2((double)d.x, (double)-d.z) / (2 * M_PI),
           v = acos(fmin(fmax((double)d.y, -1), 1)) / M_PI;
    double x = u * image->width - 0.5, y = fmin(fmax(v * image->height - 0.5, 0), image->height - 1);
    int left = (int)floor(x), top = (int)fmin(floor(y), image->height - 2);
    float across = (float)(x - left), down = (float)(y - top);
    int columns[2] = {(left + image->width) % image->width, (left + 1) % image->width};
    vec3s rows[2];
    for (int i = 0; i < 2; i++)
        rows[i] = glms_vec3_lerp(texel_of(image, columns[0], top + i), texel_of(image, columns[1], top + i),
                                 across);
    return glms_vec3_lerp(rows[0], rows[1], down);
}

static vec3s light_toward(const struct integral *integral, vec3s direction)
{
    const struct tl_integral_request *request = integral->request;
    return read_light(&request->environment->image, tl_turn_direction(direction, -request->environment_yaw));
}

static vec3s lobe_toward(const struct integral *integral, const struct directions *list, vec3s about,
                         float exponent)
{
    return sum_lobe(list, tl_turn_direction(about, -integral->request->environment_yaw), exponent);
}

static vec3s reflectance_at(const struct tl_material_params *material, float cosine)
{
    vec3s f;
    for (int c = 0; c < 3; c++)
        f.raw[c] = material->fresnel == TL_FRESNEL_SCHLICK
                       ? schlick_reflectance(material->specular[c], schlick_share(cosine))
                       : material->specular[c] * fresnel_dielectric(material->index, cosine);
    return f;
}

static vec3s refract(vec3s v, vec3s n, vec3s mirror, float ratio)
{
    float cosine = glms_vec3_dot(n, v), square = 1 - ratio * ratio * (1 - cosine * cosine);
    if (square < 0)
        return mirror;
    vec3s along = glms_vec3_scale(n, ratio * cosine - sqrtf(square));
    return glms_vec3_normalize(glms_vec3_sub(along, glms_vec3_scale(v, ratio)));
}

/* Lm and Ld of envmap.h. */
static vec3s light_over(const struct integral *integral, vec3s mirror)
{
    int mode = integral->request->settings->maps.mode;
    if (mode == TL_MAPS_MIRROR || mode == TL_MAPS_REFRACTION)
        return light_toward(integral, mirror);
    return lobe_toward(integral, &integral->glossy, mirror, integral->exponent);
}

static vec3s light_under(const struct integral *integral, vec3s n, vec3s v, vec3s mirror, vec3s diffuse)
{
    const struct tl_settings *settings = integral->request->settings;
    if (settings->maps.mode == TL_MAPS_REFRACTION)
        return light_toward(integral, refract(v, n, mirror, 1 / settings->material.index));
    if (settings->maps.mode == TL_MAPS_TRANSMISSION)
        return glms_vec3_mul(
            diffuse, lobe_toward(integral, &integral->glossy, glms_vec3_negate(v), integral->exponent));
    return glms_vec3_mul(diffuse, lobe_toward(integral, &integral->diffuse, n, 1));
}

static vec3s shade(const struct integral *integral, size_t sample)
{
    const struct tl_integral_request *request = integral->request;
    const struct tl_maps_params *maps = &request->settings->maps;
    const float *normal = tl_image_floats(request->normals) + 3 * sample,
                *point = tl_image_floats(request->points) + 3 * sample,
                *kd = tl_image_floats(request->diffuse) + 3 * sample;
    vec3s n = {{normal[0], normal[1], normal[2]}}, at = {{point[0], point[1], point[2]}};
    vec3s diffuse = {{kd[0], kd[1], kd[2]}}, v = glms_vec3_normalize(glms_vec3_sub(request->eye, at));
    float cosine = fminf(fmaxf(glms_vec3_dot(n, v), 0), 1);
    vec3s mirror = glms_vec3_sub(glms_vec3_scale(n, 2 * glms_vec3_dot(n, v)), v);
    vec3s f = reflectance_at(&request->settings->material, cosine);
    if (maps->fresnel != TL_MAPS_FRESNEL_OFF) {
        vec3s passed =
            maps->fresnel == TL_MAPS_FRESNEL_COAT ? glms_vec3_sub(glms_vec3_one(), f) : glms_vec3_one();
        vec3s under = glms_vec3_mul(passed, light_under(integral, n, v, mirror, diffuse));
        return glms_vec3_add(glms_vec3_mul(f, light_over(integral, mirror)), under);
    }
    switch (maps->mode) {
    case TL_MAPS_MIRROR:
        return light_over(integral, mirror);
    case TL_MAPS_REFRACTION:
    case TL_MAPS_DIFFUSE:
    case TL_MAPS_TRANSMISSION:
        return light_under(integral, n, v, mirror, diffuse);
    case TL_MAPS_GLOSSY:
        return glms_vec3_mul(f, light_over(integral, mirror));
    default:
        return glms_vec3_add(glms_vec3_mul(f, light_over(integral, mirror)),
                             light_under(integral, n, v, mirror, diffuse));
    }
}

/* The mean of the 2 x 2 samples of a pixel. */
static void shade_pixel(const struct integral *integral, int x, int y, float texel[4])
{
    const tl_image *covered = integral->request->covered;
    for (int i = 0; i < 4; i++) {
        size_t sample = (size_t)(2 * y + i / 2) * (size_t)covered->width + (size_t)(2 * x + i % 2);
        if (!(tl_image_floats(covered)[4 * sample + 3] > 0))
            continue;
        vec3s light = shade(integral, sample);
        for (int c = 0; c < 3; c++)
            texel[c] += light.raw[c] / 4;
        texel[3] += 0.25f;
    }
}

tl_image tl_integral_make(const struct tl_integral_request *request)
{
    const tl_image *light = &request->environment->image;
    float exponent = 1 / fmaxf(1 - request->settings->material.glossiness, 1e-6f);
    struct integral integral = {.request = request,
                                .exponent = exponent,
                                .diffuse = directions_make(light, columns_for(1, light->width)),
                                .glossy = directions_make(light, columns_for(exponent, light->width))};
    tl_image image =
        tl_image_create(request->covered->width / 2, request->covered->height / 2, 4, TL_IMAGE_F32);
#pragma omp parallel for schedule(dynamic)
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++)
            shade_pixel(&integral, x, y,
                        tl_image_floats(&image) + 4 * ((size_t)y * (size_t)image.width + (size_t)x));
    directions_release(&integral.diffuse);
    directions_release(&integral.glossy);
    return image;
}
