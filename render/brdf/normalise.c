#include "render/brdf/normalise.h"

#include "config/base/memory.h"
#include "render/env/cube.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

const char *const tl_normalisation_names[] = {"none",    "cube8",   "cube16", "newton", "taylor2",
                                              "taylor3", "newton8", "slerp",  "exact",  NULL};

struct tl_normal_cube tl_normal_cube_make(int size, int bits)
{
    assert(bits == 8 || bits == 16);
    size_t count = 6 * (size_t)size * (size_t)size;
    struct tl_normal_cube cube = {size, bits, tl_alloc(3 * count, (size_t)bits / 8)};
    float maximum = bits == 8 ? 255 : 65535;
    for (size_t i = 0; i < count; i++) {
        vec3s n = tl_cube_texel_direction(size, (int)i);
        for (size_t c = 0; c < 3; c++) {
            float level = roundf((n.raw[c] + 1) / 2 * maximum);
            if (bits == 8)
                ((uint8_t *)cube.texels)[3 * i + c] = (uint8_t)level;
            else
                ((uint16_t *)cube.texels)[3 * i + c] = (uint16_t)level;
        }
    }
    return cube;
}

void tl_normal_cube_release(struct tl_normal_cube *cube)
{
    free(cube->texels);
    *cube = (struct tl_normal_cube){0};
}

vec3s tl_normal_cube_at(const struct tl_normal_cube *cube, vec3s v)
{
    struct tl_cube_taps taps = tl_cube_taps(cube->size, v);
    vec3s sum = {{0, 0, 0}};
    for (int i = 0; i < 4; i++) {
        for (int c = 0; c < 3; c++) {
            size_t at = 3 * (size_t)taps.texel[i] + (size_t)c;
            float level = cube->bits == 8 ? (float)((const uint8_t *)cube->texels)[at] / 255
                                          : (float)((const uint16_t *)cube->texels)[at] / 65535;
            sum.raw[c] += taps.weight[i] * (2 * level - 1);
        }
    }
    return sum;
}

vec3s tl_normalise(int method, const struct tl_normal_cube *cube, vec3s v)
{
    float square = glms_vec3_norm2(v);
    if (!(square > 0))
        return (vec3s){{0, 0, 0}};
    switch (method) {
    case TL_NORMALISE_CUBE8:
    case TL_NORMALISE_CUBE16:
        return tl_normal_cube_at(cube, v);
    case TL_NORMALISE_NEWTON:
    case TL_NORMALISE_TAYLOR2:
    case TL_NORMALISE_TAYLOR3:
        return glms_vec3_scale(v, unit_series(square, 1 + method - TL_NORMALISE_NEWTON));
    case TL_NORMALISE_NEWTON8:
        return register_newton_vector(v);
    case TL_NORMALISE_SLERP:
    case TL_NORMALISE_EXACT:
        return glms_vec3_scale(v, 1 / sqrtf(square));
    default:
        return v;
    }
}

#define ARCS      256
#define POSITIONS 64 /* on each arc */

/* The middle of arc i and its direction there. Arcs are spread evenly over the sphere by the golden angle. */
static void set_arc(int i, vec3s *middle, vec3s *along)
{
    float z = 1 - 2 * ((float)i + 0.5f) / ARCS, radius = sqrtf(1 - z * z), azimuth = (float)i * 2.3999632f;
    *middle = (vec3s){{radius * cosf(azimuth), radius * sinf(azimuth), z}};
    vec3s side = {{-sinf(azimuth), cosf(azimuth), 0}}, up = glms_vec3_cross(*middle, side);
    float turn = (float)i * 1.7f;
    *along = glms_vec3_add(glms_vec3_scale(side, cosf(turn)), glms_vec3_scale(up, sinf(turn)));
}

static vec3s on_arc(vec3s middle, vec3s along, double angle)
{
    return glms_vec3_add(glms_vec3_scale(middle, (float)cos(angle)),
                         glms_vec3_scale(along, (float)sin(angle)));
}

static double angle_between(vec3s a, vec3s b)
{
    return atan2((double)glms_vec3_norm(glms_vec3_cross(a, b)), (double)glms_vec3_dot(a, b));
}

static double eighth_power(vec3s a, vec3s b)
{
    return pow(fmin(fmax((double)glms_vec3_dot(a, b), 0), 1), 8);
}

static void measure_arc(int method, const struct tl_normal_cube *cube, double angle, int arc,
                        struct tl_normalise_error *error)
{
    vec3s middle, along;
    set_arc(arc, &middle, &along);
    vec3s first = on_arc(middle, along, -angle / 2), last = on_arc(middle, along, angle / 2);
    vec3s h = on_arc(middle, along, angle * (arc % 17 / 16.0 - 0.5));
    for (int i = 0; i <= POSITIONS; i++) {
        double place = (double)i / POSITIONS;
        vec3s linear = glms_vec3_lerp(first, last, (float)place);
        vec3s slerp = on_arc(middle, along, angle * (place - 0.5));
        vec3s exact = glms_vec3_scale(linear, 1 / glms_vec3_norm(linear));
        vec3s v = tl_normalise(method, cube, linear);
        double samples = (double)ARCS * (POSITIONS + 1);
        error->length = fmax(error->length, fabs((double)glms_vec3_norm(v) - 1));
        error->direction = fmax(error->direction, angle_between(v, exact));
        error->vector += (double)glms_vec3_distance2(v, exact) / samples;
        error->slerp += (double)glms_vec3_distance2(v, slerp) / samples;
        error->highlight = fmax(error->highlight, fabs(eighth_power(v, h) - eighth_power(slerp, h)));
    }
}

struct tl_normalise_error tl_normalise_error(int method, double angle)
{
    struct tl_normal_cube cube = {0};
    if (method == TL_NORMALISE_CUBE8 || method == TL_NORMALISE_CUBE16)
        cube = tl_normal_cube_make(TL_NORMALISE_CUBE_SIZE, method == TL_NORMALISE_CUBE8 ? 8 : 16);
    struct tl_normalise_error error = {0};
    for (int arc = 0; arc < ARCS; arc++)
        measure_arc(method, &cube, angle, arc, &error);
    error.vector = sqrt(error.vector);
    error.slerp = sqrt(error.slerp);
    tl_normal_cube_release(&cube);
    return error;
}

double tl_normalise_limit(int method, int against)
{
    const double degree = M_PI / 180;
    double bound = tl_normalise_error(against, 30 * degree).vector, low = degree, high = 120 * degree;
    for (int i = 0; i < 16; i++) {
        double middle = (low + high) / 2;
        if (tl_normalise_error(method, middle).vector < bound)
            low = middle;
        else
            high = middle;
    }
    return low;
}
