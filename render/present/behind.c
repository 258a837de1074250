#include "render/present/behind.h"

#include "config/base/memory.h"
#include "render/env/from_environment.h"

#include <stdlib.h>
#include <string.h>

enum { PLANE_FLOATS = TL_BEHIND_PIXELS, TILE_FLOATS = 3 * PLANE_FLOATS };

static bool is_same(const struct tl_behind_request *a, const struct tl_behind_request *b)
{
    return a->revision == b->revision && (a->blurred != NULL) == (b->blurred != NULL) &&
           a->width == b->width && a->height == b->height && a->environment_yaw == b->environment_yaw &&
           glms_vec3_eqv(a->forward, b->forward) && glms_vec3_eqv(a->right, b->right) &&
           glms_vec3_eqv(a->up, b->up);
}

/* Whether TL_BEHIND_STEP pixels are few enough to interpolate over. Blurred light bends at the middles of its
 * texels: the step is a small part of one. A place in a picture is off by step^2 / 8 times its curvature,
 * which is about 1 except near the poles. */
static bool is_smooth(const struct tl_behind_request *of)
{
    float across = 2 * glms_vec3_norm(of->right) / (float)of->width,
          upwards = 2 * glms_vec3_norm(of->up) / (float)of->height;
    float step = TL_BEHIND_STEP * fmaxf(across, upwards); /* rad */
    if (of->blurred)
        return step < (float)M_PI_2 / (float)of->blurred->size / 8;
    return of->environment->layout == TL_ENV_LATLONG &&
           step * step / 8 < 0.01f * 2 * (float)M_PI / (float)of->environment->image.width;
}

void tl_behind_begin(struct tl_behind *behind, const struct tl_behind_request *request)
{
    bool stays = behind->colours && is_same(&behind->of, request);
    behind->of = *request; /* pointers may change without the values */
    if (stays)
        return;
    behind->forward = tl_turn_direction(request->forward, -request->environment_yaw);
    behind->right = tl_turn_direction(request->right, -request->environment_yaw);
    behind->up = tl_turn_direction(request->up, -request->environment_yaw);
    behind->is_interpolated = is_smooth(request);
    behind->columns = (request->width + TL_BEHIND_COLUMNS - 1) / TL_BEHIND_COLUMNS;
    behind->rows = (request->height + TL_BEHIND_ROWS - 1) / TL_BEHIND_ROWS;
    size_t tiles = (size_t)behind->columns * (size_t)behind->rows;
    size_t bytes = tiles * (TILE_FLOATS * sizeof(float) + 1);
    if (bytes != behind->bytes) {
        free(behind->colours);
        free(behind->made);
        behind->colours = tl_alloc_lines(tiles * TILE_FLOATS, sizeof(float));
        behind->made = TL_NEW_ARRAY(uint8_t, tiles);
        behind->bytes = bytes;
    }
    memset(behind->made, 0, tiles);
}

void tl_behind_release(struct tl_behind *behind)
{
    free(behind->colours);
    free(behind->made);
    *behind = (struct tl_behind){0};
}

/* The direction of the middle of a pixel, in the environment's frame; not normalised. */
static vec3s direction_of(const struct tl_behind *behind, int x, int y)
{
    float across = 2 * ((float)x + 0.5f) / (float)behind->of.width - 1;
    float upwards = 2 * ((float)y + 0.5f) / (float)behind->of.height - 1;
    return glms_vec3_add(behind->forward, glms_vec3_add(glms_vec3_scale(behind->right, across),
                                                        glms_vec3_scale(behind->up, upwards)));
}

static void put(vec3s colour, int x, int y, float *colours)
{
    for (int c = 0; c < 3; c++)
        colours[c * PLANE_FLOATS + y * TL_BEHIND_COLUMNS + x] = colour.raw[c];
}

static void sample_tile(const struct tl_behind *behind, int left, int low, float *colours)
{
    const struct tl_behind_request *of = &behind->of;
    for (int y = 0; y < TL_BEHIND_ROWS; y++)
        for (int x = 0; x < TL_BEHIND_COLUMNS; x++) {
            vec3s direction = direction_of(behind, left + x, low + y);
            put(of->blurred ? tl_cube_sample(of->blurred, direction)
                            : tl_environment_sample(of->environment, direction),
                x, y, colours);
        }
}

/* The nodes of a tile: every TL_BEHIND_STEP-th pixel of its first row and of the one after its last. */
#define NODES (TL_BEHIND_COLUMNS / TL_BEHIND_STEP + 1)
_Static_assert(TL_BEHIND_ROWS == TL_BEHIND_STEP, "a tile lies between two rows of nodes");

/* Bilinear between the nodes. */
static void interpolate(float nodes[2][NODES], float *out)
{
    for (int y = 0; y < TL_BEHIND_ROWS; y++) {
        const float up = (float)y / TL_BEHIND_STEP;
        for (int i = 0; i + 1 < NODES; i++) {
            float begin = nodes[0][i] + up * (nodes[1][i] - nodes[0][i]);
            float end = nodes[0][i + 1] + up * (nodes[1][i + 1] - nodes[0][i + 1]);
            for (int k = 0; k < TL_BEHIND_STEP; k++)
                *out++ = begin + (float)k / TL_BEHIND_STEP * (end - begin);
        }
    }
}

static void interpolate_colours(const struct tl_behind *behind, int left, int low, float *colours)
{
    float nodes[3][2][NODES];
    for (int row = 0; row < 2; row++)
        for (int i = 0; i < NODES; i++) {
            vec3s direction = direction_of(behind, left + i * TL_BEHIND_STEP, low + row * TL_BEHIND_STEP);
            vec3s colour = tl_cube_sample(behind->of.blurred, direction);
            for (int c = 0; c < 3; c++)
                nodes[c][row][i] = colour.raw[c];
        }
    for (int c = 0; c < 3; c++)
        interpolate(nodes[c], colours + (size_t)c * PLANE_FLOATS);
}

/* Interpolates places in the environment's picture. Returns false where they are not smooth: near the poles,
 * and where the picture's left and right edges meet. */
static bool interpolate_places(const struct tl_behind *behind, int left, int low, float *colours)
{
    const float polar = 0.9f; /* the height from which on meridians are close */
    float u[2][NODES], v[2][NODES], places[2][PLANE_FLOATS];
    for (int row = 0; row < 2; row++)
        for (int i = 0; i < NODES; i++) {
            vec3s direction = glms_vec3_normalize(
                direction_of(behind, left + i * TL_BEHIND_STEP, low + row * TL_BEHIND_STEP));
            tl_environment_place(direction, &u[row][i], &v[row][i]);
            if (fabsf(direction.y) > polar || fabsf(u[row][i] - u[0][0]) > 0.5f)
                return false;
        }
    interpolate(u, places[0]);
    interpolate(v, places[1]);
    for (int y = 0; y < TL_BEHIND_ROWS; y++)
        for (int x = 0; x < TL_BEHIND_COLUMNS; x++) {
            int i = y * TL_BEHIND_COLUMNS + x;
            put(tl_environment_fetch(&behind->of.environment->image, places[0][i], places[1][i]), x, y,
                colours);
        }
    return true;
}

static void make_tile(const struct tl_behind *behind, int left, int low, float *colours)
{
    if (behind->is_interpolated && behind->of.blurred)
        interpolate_colours(behind, left, low, colours);
    else if (!behind->is_interpolated || !interpolate_places(behind, left, low, colours))
        sample_tile(behind, left, low, colours);
}

const float *tl_behind_tile(struct tl_behind *behind, int column, int row)
{
    size_t tile = (size_t)row * (size_t)behind->columns + (size_t)column;
    float *colours = behind->colours + tile * TILE_FLOATS;
    if (!behind->made[tile]) {
        make_tile(behind, column * TL_BEHIND_COLUMNS, row * TL_BEHIND_ROWS, colours);
        behind->made[tile] = 1;
    }
    return colours;
}
