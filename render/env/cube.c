#include "render/env/cube.h"

#include "config/memory.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

tl_cube tl_cube_create(int size)
{
    assert(size > 0);
    return (tl_cube){.size = size, .texels = TL_NEW_ARRAY(float, 18 * (size_t)size * (size_t)size)};
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

/* Where a direction meets the plane of a face (OpenGL 4.5, table 8.19). */
static void project(int face, vec3s direction, float *s, float *t)
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
    project(*face, direction, s, t);
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

/* Index of a texel that may lie one step over one border of its face: then the one that touches it there. */
static int texel_across(int size, int face, int x, int y)
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
            taps.texel[i] = texel_across(size, face, tap_x, tap_y);
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

/* Lat-long to cube: every source texel is poured into the cube texels that it covers. Where all its corners
 * lie in one it goes there whole; otherwise it is halved, down to cells of an eighth of a cube texel, which
 * are shared out by area. So nothing is missed, however thin the source texels are (at the poles), and each
 * keeps its exact solid angle. */
#define CELLS_PER_TEXEL 8
/* Corners say where a cell lies only while its sides are nearly straight. */
#define TURN_CELLS_MIN 64
/* Fixed blocks of rows, each with sums of its own, so that the result does not depend on the threads. */
#define POUR_BLOCKS 4

struct pour {
    const tl_image *image;
    int size;                  /* of the target cube */
    int steps_x, steps_y;      /* per source texel, powers of two; the smallest cell has two */
    int widest, highest;       /* steps of a cell that its corners may judge */
    double *sin_phi, *cos_phi; /* [width * steps_x + 1] where phi = atan2(x, -z) */
    double *y, *radius;        /* [height * steps_y + 1] of the unit sphere, radius from the axis */
};

struct cell {
    int x0, y0, x1, y1; /* steps */
    int corners[4];     /* target texel at (x0, y0), (x1, y0), (x0, y1), (x1, y1) */
};

static int steps_for(int texels, int wanted)
{
    int steps = 2;
    while (texels * steps < wanted)
        steps *= 2;
    return steps;
}

static struct pour pour_create(const tl_image *image, int size)
{
    int turn = 4 * size * CELLS_PER_TEXEL; /* cells; four faces are one turn */
    if (turn < TURN_CELLS_MIN)
        turn = TURN_CELLS_MIN;
    struct pour pour = {.image = image,
                        .size = size,
                        .steps_x = steps_for(image->width, 2 * turn),
                        .steps_y = steps_for(image->height, turn)};
    int columns = image->width * pour.steps_x, rows = image->height * pour.steps_y;
    pour.widest = columns / TURN_CELLS_MIN;
    pour.highest = 2 * rows / TURN_CELLS_MIN;
    pour.sin_phi = TL_NEW_ARRAY(double, (size_t)columns + 1);
    pour.cos_phi = TL_NEW_ARRAY(double, (size_t)columns + 1);
    pour.y = TL_NEW_ARRAY(double, (size_t)rows + 1);
    pour.radius = TL_NEW_ARRAY(double, (size_t)rows + 1);
    for (int i = 0; i <= columns; i++) {
        double phi = ((double)i / columns - 0.5) * 2 * M_PI;
        pour.sin_phi[i] = sin(phi);
        pour.cos_phi[i] = cos(phi);
    }
    for (int i = 0; i <= rows; i++) {
        pour.y[i] = cos(M_PI * i / rows);
        pour.radius[i] = sin(M_PI * i / rows);
    }
    return pour;
}

static void pour_release(struct pour *pour)
{
    free(pour->sin_phi);
    free(pour->cos_phi);
    free(pour->y);
    free(pour->radius);
    *pour = (struct pour){0};
}

static vec3s pour_direction(const struct pour *pour, int x, int y)
{
    double radius = pour->radius[y];
    return (vec3s){
        {(float)(radius * pour->sin_phi[x]), (float)pour->y[y], (float)(-radius * pour->cos_phi[x])}};
}

static int pour_texel(const struct pour *pour, int x, int y)
{
    return tl_cube_texel(pour->size, pour_direction(pour, x, y));
}

static void pour_whole(const struct pour *pour, const float *colour, const struct cell *cell, double share,
                       double sum[4])
{
    double step = 2 * M_PI / ((double)pour->image->width * pour->steps_x);
    double weight = share * (cell->x1 - cell->x0) * step * (pour->y[cell->y0] - pour->y[cell->y1]);
    for (int c = 0; c < 3; c++)
        sum[c] += weight * (double)colour[c];
    sum[3] += weight;
}

/* Part of [centre - reach, centre + reach] that lies above the border. */
static double share_above(double centre, double reach, double border)
{
    return fmin(fmax((centre + reach - border) / (2 * reach), 0), 1);
}

/* The smallest cell, taken for the box around it on the plane of its face. Borders of cube texels run along
 * lines of the map on four of the faces, so that sending it whole to where its centre lies would err the same
 * way for all cells of a column. */
static void pour_smallest(const struct pour *pour, const float *colour, const struct cell *cell,
                          double (*sums)[4])
{
    int face;
    float s, t;
    tl_cube_locate(pour_direction(pour, cell->x0 + 1, cell->y0 + 1), &face, &s, &t);
    double reach_x = 0, reach_y = 0;
    for (int i = 0; i < 4; i++) {
        float corner_s, corner_t;
        vec3s corner = pour_direction(pour, i & 1 ? cell->x1 : cell->x0, i & 2 ? cell->y1 : cell->y0);
        project(face, corner, &corner_s, &corner_t);
        reach_x = fmax(reach_x, pour->size * fabs((double)(corner_s - s)));
        reach_y = fmax(reach_y, pour->size * fabs((double)(corner_t - t)));
    }
    double x = pour->size * (double)s, y = pour->size * (double)t;
    int border_x = (int)(x + 0.5), border_y = (int)(y + 0.5);
    double above_x = share_above(x, reach_x, border_x), above_y = share_above(y, reach_y, border_y);
    for (int i = 0; i < 4; i++) {
        double share = (i & 1 ? above_x : 1 - above_x) * (i & 2 ? above_y : 1 - above_y);
        if (share > 0)
            pour_whole(pour, colour, cell, share,
                       sums[texel_across(pour->size, face, border_x - !(i & 1), border_y - !(i & 2))]);
    }
}

static void pour_cell(const struct pour *pour, const float *colour, const struct cell *cell,
                      double (*sums)[4])
{
    const int *corners = cell->corners;
    int x0 = cell->x0, y0 = cell->y0, x1 = cell->x1, y1 = cell->y1;
    bool uniform = corners[0] == corners[1] && corners[0] == corners[2] && corners[0] == corners[3];
    if (uniform && x1 - x0 <= pour->widest && y1 - y0 <= pour->highest) {
        pour_whole(pour, colour, cell, 1, sums[corners[0]]);
    } else if (x1 - x0 == 2 && y1 - y0 == 2) {
        pour_smallest(pour, colour, cell, sums);
    } else if (x1 - x0 >= y1 - y0) {
        int middle = (x0 + x1) / 2, top = pour_texel(pour, middle, y0), bottom = pour_texel(pour, middle, y1);
        pour_cell(pour, colour, &(struct cell){x0, y0, middle, y1, {corners[0], top, corners[2], bottom}},
                  sums);
        pour_cell(pour, colour, &(struct cell){middle, y0, x1, y1, {top, corners[1], bottom, corners[3]}},
                  sums);
    } else {
        int middle = (y0 + y1) / 2, left = pour_texel(pour, x0, middle), right = pour_texel(pour, x1, middle);
        pour_cell(pour, colour, &(struct cell){x0, y0, x1, middle, {corners[0], corners[1], left, right}},
                  sums);
        pour_cell(pour, colour, &(struct cell){x0, middle, x1, y1, {left, right, corners[2], corners[3]}},
                  sums);
    }
}

static void pour_rows(const struct pour *pour, int begin, int end, double (*sums)[4])
{
    for (int row = begin; row < end; row++) {
        const float *colour = tl_image_floats(pour->image) + 3 * (size_t)row * (size_t)pour->image->width;
        int y0 = row * pour->steps_y, y1 = y0 + pour->steps_y;
        struct cell cell = {0, y0, 0, y1, {0, pour_texel(pour, 0, y0), 0, pour_texel(pour, 0, y1)}};
        for (int column = 0; column < pour->image->width; column++, colour += 3) {
            cell.x0 = cell.x1;
            cell.x1 += pour->steps_x;
            cell.corners[0] = cell.corners[1];
            cell.corners[2] = cell.corners[3];
            cell.corners[1] = pour_texel(pour, cell.x1, y0);
            cell.corners[3] = pour_texel(pour, cell.x1, y1);
            pour_cell(pour, colour, &cell, sums);
        }
    }
}

static void average_latlong(const tl_image *image, tl_cube *target)
{
    struct pour pour = pour_create(image, target->size);
    size_t texel_count = 6 * (size_t)target->size * (size_t)target->size;
    double(*sums)[4] = tl_alloc(POUR_BLOCKS * texel_count, sizeof *sums);
#pragma omp parallel for schedule(dynamic)
    for (int block = 0; block < POUR_BLOCKS; block++)
        pour_rows(&pour, image->height * block / POUR_BLOCKS, image->height * (block + 1) / POUR_BLOCKS,
                  sums + (size_t)block * texel_count);
    for (size_t i = 0; i < texel_count; i++) {
        double total[4] = {0, 0, 0, 0};
        for (size_t block = 0; block < POUR_BLOCKS; block++)
            for (int c = 0; c < 4; c++)
                total[c] += sums[block * texel_count + i][c];
        for (size_t c = 0; c < 3; c++)
            target->texels[3 * i + c] = (float)(total[c] / total[3]);
    }
    free(sums);
    pour_release(&pour);
}

tl_cube tl_cube_from_environment(const tl_environment *environment, int size)
{
    assert(environment->image.type == TL_IMAGE_F32 && environment->image.channels == 3);
    tl_cube target = tl_cube_create(size);
    if (environment->layout == TL_ENV_CUBE) {
        tl_cube source = environment_as_cube(environment);
        average_cube(&source, &target);
    } else {
        average_latlong(&environment->image, &target);
    }
    return target;
}
