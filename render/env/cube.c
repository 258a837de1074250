#include "render/env/cube.h"

#include "config/base/memory.h"
#include "render/env/exponent.h"

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

bool tl_cube_is_black(const tl_cube *cube)
{
    const size_t count = (size_t)18 * (size_t)cube->size * (size_t)cube->size;
    for (size_t i = 0; i < count; i++)
        if (cube->texels[i] > 0)
            return false;
    return true;
}

vec3s tl_cube_direction(int face, float s, float t)
{
    return cube_direction(face, s, t);
}

void tl_cube_project(int face, vec3s direction, float *s, float *t)
{
    const vec2s place = cube_place(face, direction);
    *s = place.x;
    *t = place.y;
}

void tl_cube_locate(vec3s direction, int *face, float *s, float *t)
{
    *face = cube_face(direction);
    tl_cube_project(*face, direction, s, t);
}

/* Signed solid angle of the rectangle between the centre of a face at distance 1 and the point (u, v) on
 * it. */
static double corner_solid_angle(double u, double v)
{
    return atan2(u * v, sqrt(u * u + v * v + 1));
}

double tl_cube_rectangle_solid_angle(double s0, double t0, double s1, double t1)
{
    double u0 = 2 * s0 - 1, v0 = 2 * t0 - 1, u1 = 2 * s1 - 1, v1 = 2 * t1 - 1;
    return corner_solid_angle(u1, v1) - corner_solid_angle(u0, v1) - corner_solid_angle(u1, v0) +
           corner_solid_angle(u0, v0);
}

vec3s tl_turn_direction(vec3s direction, float yaw)
{
    return turned_direction(cosf(yaw), -sinf(yaw), direction);
}

float tl_cube_solid_angle(int size, int x, int y)
{
    double step = 1.0 / size;
    return (float)tl_cube_rectangle_solid_angle(x * step, y * step, (x + 1) * step, (y + 1) * step);
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

int tl_cube_texel(int size, vec3s direction)
{
    return cube_texel(direction, size);
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
    /* A point just across the border, at the height of the texel centre, lies in the neighbouring texel. */
    float over = 0.25f / (float)size, step = 1 / (float)size;
    float s = x < 0 ? -over : x >= size ? 1 + over : ((float)x + 0.5f) * step;
    float t = y < 0 ? -over : y >= size ? 1 + over : ((float)y + 0.5f) * step;
    return tl_cube_texel(size, tl_cube_direction(face, s, t));
}

static int floor_of(float value)
{
    int whole = (int)value; /* towards 0 */
    return whole - ((float)whole > value);
}

struct tl_cube_taps tl_cube_taps(int size, vec3s direction)
{
    int face;
    float s, t;
    tl_cube_locate(direction, &face, &s, &t);
    float fx = s * (float)size - 0.5f, fy = t * (float)size - 0.5f;
    int x = floor_of(fx), y = floor_of(fy);
    float wx = fx - (float)x, wy = fy - (float)y;

    struct tl_cube_taps taps = {.weight = {(1 - wx) * (1 - wy), wx * (1 - wy), (1 - wx) * wy, wx * wy}};
    if (x >= 0 && y >= 0 && x + 1 < size && y + 1 < size) {
        int first = (face * size + y) * size + x;
        memcpy(taps.texel, (const int[]){first, first + 1, first + size, first + size + 1},
               sizeof taps.texel);
        return taps;
    }
    int missing = -1;
    for (int i = 0; i < 4; i++) {
        int tap_x = x + (i & 1), tap_y = y + (i >> 1);
        bool outside_x = tap_x < 0 || tap_x >= size, outside_y = tap_y < 0 || tap_y >= size;
        if (outside_x && outside_y)
            missing = i;
        else
            taps.texel[i] = tl_cube_texel_across(size, face, tap_x, tap_y);
    }
    if (missing >= 0) { /* three faces meet: the missing texel is the mean of those that exist */
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
