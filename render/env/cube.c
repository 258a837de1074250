#include "render/env/cube.h"

#include "config/memory.h"
#include "render/env/resample.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

tl_cube tl_cube_create(int size)
{
    assert(size > 0);
    return (tl_cube){.size = size, .texels = TL_NEW_ARRAY(float, 18 * (size_t)size * (size_t)size)};
}

tl_cube tl_cube_copy(const tl_cube *cube)
{
    tl_cube copy = tl_cube_create(cube->size);
    memcpy(copy.texels, cube->texels, 18 * (size_t)cube->size * (size_t)cube->size * sizeof(float));
    return copy;
}

void tl_cube_release(tl_cube *cube)
{
    free(cube->texels);
    *cube = (tl_cube){0};
}

vec3s tl_cube_direction(int face, float s, float t)
{
    float u = 2 * s - 1, v = 2 * t - 1;
    switch (face) {
    case 0:
        return (vec3s){{1, -v, -u}};
    case 1:
        return (vec3s){{-1, -v, u}};
    case 2:
        return (vec3s){{u, 1, v}};
    case 3:
        return (vec3s){{u, -1, -v}};
    case 4:
        return (vec3s){{u, -v, 1}};
    default:
        assert(face == 5);
        return (vec3s){{-u, -v, -1}};
    }
}

void tl_cube_project(int face, vec3s direction, float *s, float *t)
{
    float x = direction.x, y = direction.y, z = direction.z;
    const float sc[6] = {-z, z, x, x, x, -x}, tc[6] = {-y, -y, z, -z, -y, -y};
    float major = fabsf(direction.raw[face / 2]);
    if (major <= 0) /* the zero vector looks along its face rather than nowhere */
        major = 1;
    *s = 0.5f * (sc[face] / major + 1);
    *t = 0.5f * (tc[face] / major + 1);
}

void tl_cube_locate(vec3s direction, int *face, float *s, float *t)
{
    float ax = fabsf(direction.x), ay = fabsf(direction.y), az = fabsf(direction.z);
    int axis = ax >= ay && ax >= az ? 0 : ay >= az ? 1 : 2;
    *face = 2 * axis + (direction.raw[axis] < 0);
    tl_cube_project(*face, direction, s, t);
}

/* Solid angle of the rectangle between the centre of a face at distance 1 and (u, v) on it, signed. */
static double corner_solid_angle(double u, double v)
{
    return atan2(u * v, sqrt(u * u + v * v + 1));
}

static double rectangle_solid_angle(double s0, double t0, double s1, double t1)
{
    double u0 = 2 * s0 - 1, v0 = 2 * t0 - 1, u1 = 2 * s1 - 1, v1 = 2 * t1 - 1;
    return corner_solid_angle(u1, v1) - corner_solid_angle(u0, v1) - corner_solid_angle(u1, v0) +
           corner_solid_angle(u0, v0);
}

vec3s tl_turn_direction(vec3s direction, float yaw)
{
    float c = cosf(yaw), s = sinf(yaw);
    return (vec3s){{c * direction.x + s * direction.z, direction.y, -s * direction.x + c * direction.z}};
}

float tl_cube_solid_angle(int size, int x, int y)
{
    double step = 1.0 / size;
    return (float)rectangle_solid_angle(x * step, y * step, (x + 1) * step, (y + 1) * step);
}

void tl_cube_solid_angles(int size, float *out)
{
    int half = (size + 1) / 2;
    for (int y = 0; y < half; y++) {
        for (int x = 0; x <= y; x++) {
            float value = tl_cube_solid_angle(size, x, y);
            const int columns[2] = {x, size - 1 - x}, rows[2] = {y, size - 1 - y};
            for (int i = 0; i < 4; i++) {
                out[rows[i >> 1] * size + columns[i & 1]] = value;
                out[columns[i & 1] * size + rows[i >> 1]] = value;
            }
        }
    }
}

static int clamp_index(int value, int count)
{
    return value < 0 ? 0 : value >= count ? count - 1 : value;
}

int tl_cube_texel(int size, vec3s direction)
{
    int face;
    float s, t;
    tl_cube_locate(direction, &face, &s, &t);
    int x = clamp_index((int)(s * (float)size), size), y = clamp_index((int)(t * (float)size), size);
    return (face * size + y) * size + x;
}

vec3s tl_cube_texel_direction(int size, int texel)
{
    int x = texel % size, line = texel / size;
    return glms_vec3_normalize(tl_cube_direction(line / size, ((float)x + 0.5f) / (float)size,
                                                 ((float)(line % size) + 0.5f) / (float)size));
}

int tl_cube_texel_across(int size, int face, int x, int y)
{
    if (x >= 0 && x < size && y >= 0 && y < size)
        return (face * size + y) * size + x;
    /* A point just over the border, level with the texel's centre, lies in the neighbour that touches it. */
    float over = 0.25f / (float)size, step = 1 / (float)size;
    float s = x < 0 ? -over : x >= size ? 1 + over : ((float)x + 0.5f) * step;
    float t = y < 0 ? -over : y >= size ? 1 + over : ((float)y + 0.5f) * step;
    return tl_cube_texel(size, tl_cube_direction(face, s, t));
}

struct tl_cube_taps tl_cube_taps(int size, vec3s direction)
{
    int face;
    float s, t;
    tl_cube_locate(direction, &face, &s, &t);
    float fx = s * (float)size - 0.5f, fy = t * (float)size - 0.5f;
    int x = (int)floorf(fx), y = (int)floorf(fy);
    float wx = fx - (float)x, wy = fy - (float)y;

    struct tl_cube_taps taps = {.weight = {(1 - wx) * (1 - wy), wx * (1 - wy), (1 - wx) * wy, wx * wy}};
    int missing = -1;
    for (int i = 0; i < 4; i++) {
        int tap_x = x + (i & 1), tap_y = y + (i >> 1);
        bool outside_x = tap_x < 0 || tap_x >= size, outside_y = tap_y < 0 || tap_y >= size;
        if (outside_x && outside_y)
            missing = i;
        else
            taps.texel[i] = tl_cube_texel_across(size, face, tap_x, tap_y);
    }
    if (missing >= 0) { /* three faces meet: the texel that does not exist is the mean of those that do */
        float share = taps.weight[missing] / 3;
        for (int i = 0; i < 4; i++)
            taps.weight[i] = i == missing ? 0 : taps.weight[i] + share;
        taps.texel[missing] = taps.texel[missing ^ 1];
    }
    return taps;
}

vec3s tl_cube_fetch(const tl_cube *cube, const struct tl_cube_taps *taps)
{
    vec3s sum = {{0, 0, 0}};
    for (int i = 0; i < 4; i++) {
        const float *texel = cube->texels + 3 * (size_t)taps->texel[i];
        for (int c = 0; c < 3; c++)
            sum.raw[c] += taps->weight[i] * texel[c];
    }
    return sum;
}

vec3s tl_cube_sample(const tl_cube *cube, vec3s direction)
{
    struct tl_cube_taps taps = tl_cube_taps(cube->size, direction);
    return tl_cube_fetch(cube, &taps);
}

/* An environment in cube layout is a tl_cube already; this only looks at it as one. */
static tl_cube environment_as_cube(const tl_environment *environment)
{
    assert(environment->image.height == 6 * environment->image.width);
    return (tl_cube){.size = environment->image.width, .texels = tl_image_floats(&environment->image)};
}

static vec3s sample_latlong(const tl_image *image, vec3s direction)
{
    float length = glms_vec3_norm(direction);
    float y = length > 0 ? direction.y / length : 0;
    float u = 0.5f + atan2f(direction.x, -direction.z) / (float)(2 * M_PI);
    float v = acosf(fminf(fmaxf(y, -1), 1)) / (float)M_PI;
    float fx = u * (float)image->width - 0.5f, fy = v * (float)image->height - 0.5f;
    int x = (int)floorf(fx), row = (int)floorf(fy);
    float wx = fx - (float)x, wy = fy - (float)row;

    vec3s sum = {{0, 0, 0}};
    for (int i = 0; i < 4; i++) {
        int column = (x + (i & 1) + image->width) % image->width;
        int line = clamp_index(row + (i >> 1), image->height);
        float weight = ((i & 1) ? wx : 1 - wx) * ((i >> 1) ? wy : 1 - wy);
        const float *texel =
            tl_image_floats(image) + 3 * ((size_t)line * (size_t)image->width + (size_t)column);
        for (int c = 0; c < 3; c++)
            sum.raw[c] += weight * texel[c];
    }
    return sum;
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
    int column, row;
    if (environment->layout == TL_ENV_CUBE) {
        int face;
        float s, t;
        tl_cube_locate(direction, &face, &s, &t);
        column = clamp_index((int)(s * (float)image->width), image->width);
        row = face * image->width + clamp_index((int)(t * (float)image->width), image->width);
    } else {
        float u = 0.5f + atan2f(direction.x, -direction.z) / (float)(2 * M_PI);
        float v = acosf(fminf(fmaxf(direction.y, -1), 1)) / (float)M_PI;
        column = clamp_index((int)(u * (float)image->width), image->width);
        row = clamp_index((int)(v * (float)image->height), image->height);
    }
    const float *texel = tl_image_floats(image) + 3 * ((size_t)row * (size_t)image->width + (size_t)column);
    return (vec3s){{texel[0], texel[1], texel[2]}};
}

/* Cube to cube: texels of both are rectangles of the same plane, so overlaps are exact. */
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
                        rectangle_solid_angle(fmax(left, i) * step, fmax(top, j) * step,
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

tl_cube tl_cube_from_environment_with(const tl_environment *environment, int size, struct tl_resampling *kept)
{
    assert(environment->image.type == TL_IMAGE_F32 && environment->image.channels == 3);
    tl_cube target = tl_cube_create(size);
    if (environment->layout == TL_ENV_CUBE) {
        tl_cube source = environment_as_cube(environment);
        average_cube(&source, &target);
    } else {
        tl_resample_latlong(&environment->image, size, target.texels, kept);
    }
    return target;
}

tl_cube tl_cube_from_environment(const tl_environment *environment, int size)
{
    struct tl_resampling pour = {0};
    tl_cube cube = tl_cube_from_environment_with(environment, size, &pour);
    tl_resampling_release(&pour);
    return cube;
}
