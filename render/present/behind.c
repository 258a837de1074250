#include "render/present/behind.h"

#include "config/memory.h"
#include "render/env/from_environment.h"

#include <stdlib.h>
#include <string.h>

#define PLANE_FLOATS TL_BEHIND_PIXELS
#define TILE_FLOATS  (3 * PLANE_FLOATS)

static bool is_same(const struct tl_behind_request *a, const struct tl_behind_request *b)
{
    return a->revision == b->revision && (a->blurred != NULL) == (b->blurred != NULL) &&
           a->width == b->width && a->height == b->height && a->environment_yaw == b->environment_yaw &&
           memcmp(&a->forward, &b->forward, sizeof a->forward) == 0 &&
           memcmp(&a->right, &b->right, sizeof a->right) == 0 && memcmp(&a->up, &b->up, sizeof a->up) == 0;
}

void tl_behind_begin(struct tl_behind *behind, const struct tl_behind_request *request)
{
    bool stays = behind->colours && is_same(&behind->of, request);
    behind->of = *request; /* pointers may change without the values */
    if (stays)
        return;
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

/* The environment's radiance behind the middle of a pixel. */
static vec3s sample_at(const struct tl_behind_request *of, int x, int y)
{
    float across = 2 * ((float)x + 0.5f) / (float)of->width - 1;
    float upwards = 2 * ((float)y + 0.5f) / (float)of->height - 1;
    vec3s world = glms_vec3_add(
        of->forward, glms_vec3_add(glms_vec3_scale(of->right, across), glms_vec3_scale(of->up, upwards)));
    vec3s direction = tl_turn_direction(world, -of->environment_yaw);
    return of->blurred ? tl_cube_sample(of->blurred, direction)
                       : tl_environment_sample(of->environment, direction);
}

static void sample_tile(const struct tl_behind_request *of, int left, int low, float *colours)
{
    for (int y = 0; y < TL_BEHIND_ROWS; y++)
        for (int x = 0; x < TL_BEHIND_COLUMNS; x++) {
            vec3s colour = sample_at(of, left + x, low + y);
            for (int c = 0; c < 3; c++)
                colours[c * PLANE_FLOATS + y * TL_BEHIND_COLUMNS + x] = colour.raw[c];
        }
}

/* Bilinear between every TL_BEHIND_STEP-th pixel of every TL_BEHIND_STEP-th row. */
static void interpolate_tile(const struct tl_behind_request *of, int left, int low, float *colours)
{
    enum { NODES = TL_BEHIND_COLUMNS / TL_BEHIND_STEP + 1 };
    vec3s nodes[2][NODES];
    for (int row = 0; row < 2; row++)
        for (int i = 0; i < NODES; i++)
            nodes[row][i] = sample_at(of, left + i * TL_BEHIND_STEP, low + row * TL_BEHIND_STEP);
    for (int y = 0; y < TL_BEHIND_ROWS; y++) {
        const float up = (float)y / TL_BEHIND_STEP;
        for (int c = 0; c < 3; c++) {
            float line[NODES], *out = colours + c * PLANE_FLOATS + y * TL_BEHIND_COLUMNS;
            for (int i = 0; i < NODES; i++)
                line[i] = nodes[0][i].raw[c] + up * (nodes[1][i].raw[c] - nodes[0][i].raw[c]);
            for (int i = 0; i + 1 < NODES; i++)
                for (int k = 0; k < TL_BEHIND_STEP; k++)
                    out[TL_BEHIND_STEP * i + k] =
                        line[i] + (float)k / TL_BEHIND_STEP * (line[i + 1] - line[i]);
        }
    }
}

_Static_assert(TL_BEHIND_ROWS <= TL_BEHIND_STEP, "a tile lies between two rows of nodes");

const float *tl_behind_tile(struct tl_behind *behind, int column, int row)
{
    size_t tile = (size_t)row * (size_t)behind->columns + (size_t)column;
    float *colours = behind->colours + tile * TILE_FLOATS;
    if (!behind->made[tile]) {
        int left = column * TL_BEHIND_COLUMNS, low = row * TL_BEHIND_ROWS;
        if (behind->of.blurred)
            interpolate_tile(&behind->of, left, low, colours);
        else
            sample_tile(&behind->of, left, low, colours);
        behind->made[tile] = 1;
    }
    return colours;
}
