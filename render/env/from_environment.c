#include "render/env/from_environment.h"

#include "config/cache/cache.h"
#include "render/env/version.h"

#include <assert.h>
#include <math.h>

static int clamp_index(int value, int count)
{
    return value < 0 ? 0 : value >= count ? count - 1 : value;
}

/* The image of an environment in cube layout has the memory layout of a tl_cube; this returns a view of
 * it. */
static tl_cube environment_as_cube(const tl_environment *environment)
{
    assert(environment->image.height == 6 * environment->image.width);
    return (tl_cube){.size = environment->image.width, .texels = tl_image_floats(&environment->image)};
}

void tl_environment_place(vec3s direction, float *u, float *v)
{
    const vec2s place = latlong_place(direction);
    *u = place.x;
    *v = place.y;
}

static int floor_of(float value)
{
    int whole = (int)value; /* towards 0 */
    return whole - ((float)whole > value);
}

vec3s tl_environment_fetch(const tl_image *latlong, float u, float v)
{
    int width = latlong->width;
    float fx = u * (float)width - 0.5f, fy = v * (float)latlong->height - 0.5f;
    int x = floor_of(fx), row = floor_of(fy);
    float wx = fx - (float)x, wy = fy - (float)row;
    const int columns[2] = {x < 0 ? x + width : x, x + 1 < width ? x + 1 : x + 1 - width};
    vec3s sum = {{0, 0, 0}};
    for (int i = 0; i < 4; i++) {
        int line = clamp_index(row + (i >> 1), latlong->height);
        float weight = ((i & 1) ? wx : 1 - wx) * ((i >> 1) ? wy : 1 - wy);
        const float *texel =
            tl_image_floats(latlong) + 3 * ((size_t)line * (size_t)width + (size_t)columns[i & 1]);
        for (int c = 0; c < 3; c++)
            sum.raw[c] += weight * texel[c];
    }
    return sum;
}

static vec3s sample_latlong(const tl_image *image, vec3s direction)
{
    float length = glms_vec3_norm(direction), u, v;
    vec3s unit = length > 0 ? glms_vec3_scale(direction, 1 / length) : (vec3s){{0, 0, 0}};
    tl_environment_place(unit, &u, &v);
    return tl_environment_fetch(image, u, v);
}

vec3s tl_environment_sample(const tl_environment *environment, vec3s direction)
{
    assert(environment->image.type == TL_IMAGE_F32 && environment->image.channels == 3);
    if (environment->layout == TL_ENV_CUBE) {
        tl_cube cube = environment_as_cube(environment);
        return tl_cube_sample(&cube, direction);
    }
    return sample_latlong(&environment->image, direction);
}

vec3s tl_environment_texel(const tl_environment *environment, vec3s direction)
{
    const tl_image *image = &environment->image;
    size_t index;
    if (environment->layout == TL_ENV_CUBE) {
        index = (size_t)tl_cube_texel(image->width, direction);
    } else {
        const vec2s at = latlong_place(direction);
        index = (size_t)texel_within(at.y, image->height) * (size_t)image->width +
                (size_t)texel_within(at.x, image->width);
    }
    const float *texel = tl_image_floats(image) + 3 * index;
    return (vec3s){{texel[0], texel[1], texel[2]}};
}

/* Area average of a cube. The texels of both cubes are rectangles of the same planes, so the overlaps are
 * exact. */
static void average_cube(const tl_cube *source, tl_cube *target)
{
    double ratio = (double)source->size / target->size, step = 1.0 / source->size;
#pragma omp parallel for
    for (int line = 0; line < 6 * target->size; line++) {
        int face = line / target->size;
        double top = (line % target->size) * ratio, bottom = top + ratio;
        for (int x = 0; x < target->size; x++) {
            double left = x * ratio, right = left + ratio, weights = 0, sum[3] = {0, 0, 0};
            for (int j = (int)top; j < source->size && j < bottom; j++) {
                for (int i = (int)left; i < source->size && i < right; i++) {
                    double weight =
                        tl_cube_rectangle_solid_angle(fmax(left, i) * step, fmax(top, j) * step,
                                                      fmin(right, i + 1) * step, fmin(bottom, j + 1) * step);
                    const float *texel =
                        source->texels +
                        3 * ((size_t)(face * source->size + j) * (size_t)source->size + (size_t)i);
                    weights += weight;
                    for (int c = 0; c < 3; c++)
                        sum[c] += weight * texel[c];
                }
            }
            for (int c = 0; c < 3; c++)
                target->texels[3 * ((size_t)line * (size_t)target->size + (size_t)x) + (size_t)c] =
                    (float)(sum[c] / weights);
        }
    }
}

static struct tl_cache_key key_of(const tl_environment *environment, int size)
{
    const tl_image *image = &environment->image;
    const int shape[] = {environment->layout, size, image->width, image->height};
    struct tl_cache_key key = tl_cache_key_begin();
    tl_cache_key_add(&key, TL_ENV_VERSION, sizeof TL_ENV_VERSION);
    tl_cache_key_add(&key, shape, sizeof shape);
    tl_cache_key_add(&key, tl_image_floats(image),
                     3 * (size_t)image->width * (size_t)image->height * sizeof(float));
    return key;
}

static void fill_cube(const tl_environment *environment, tl_cube *target, struct tl_resampling *weights)
{
    if (environment->layout == TL_ENV_CUBE) {
        tl_cube source = environment_as_cube(environment);
        average_cube(&source, target);
    } else {
        tl_resample_latlong(&environment->image, target->size, target->texels, weights);
    }
}

/* With weights that are there already a cube takes no longer than reading it from the cache. */
tl_cube tl_cube_from_environment_with(const tl_environment *environment, int size,
                                      struct tl_resampling *weights)
{
    assert(environment->image.type == TL_IMAGE_F32 && environment->image.channels == 3);
    tl_cube target = tl_cube_create(size);
    const size_t bytes = 18 * (size_t)size * (size_t)size * sizeof *target.texels;
    if (!tl_cache_is_used() || weights->size > 0) {
        fill_cube(environment, &target, weights);
        return target;
    }
    const struct tl_cache_key key = key_of(environment, size);
    if (!tl_cache_read(&key, target.texels, bytes)) {
        fill_cube(environment, &target, weights);
        tl_cache_store(&key, target.texels, bytes);
    }
    return target;
}

tl_cube tl_cube_from_environment(const tl_environment *environment, int size)
{
    struct tl_resampling resampling = {0};
    tl_cube cube = tl_cube_from_environment_with(environment, size, &resampling);
    tl_resampling_release(&resampling);
    return cube;
}
