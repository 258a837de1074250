/* The background of the figure, on the CPU: the environment as it is, or blurred, in linear radiance. It is
 * evaluated in tiles, where one is asked for, and kept for as long as camera, environment and size stay. What
 * is smooth enough over TL_BEHIND_STEP pixels, blurred light or the place in the environment's picture, is
 * evaluated at every TL_BEHIND_STEP-th pixel and interpolated. Pure. */
#ifndef TOILE_RENDER_PRESENT_BEHIND_H
#define TOILE_RENDER_PRESENT_BEHIND_H

#include "assets/environment/environment.h"
#include "render/env/cube.h"
#include "render/scene/view.h"

#include <stdbool.h>
#include <stdint.h>

#define TL_BEHIND_COLUMNS 32 /* pixels of a tile */
#define TL_BEHIND_ROWS    8
#define TL_BEHIND_STEP    8
enum { TL_BEHIND_PIXELS = TL_BEHIND_COLUMNS * TL_BEHIND_ROWS };

struct tl_behind_request {
    vec3s forward, right, up;          /* tl_view's */
    float environment_yaw;             /* rad */
    const tl_environment *environment; /* borrowed for as long as tiles are asked for */
    const tl_cube *blurred;            /* in place of it; NULL: the environment itself */
    int width, height;                 /* of the image, pixels */
    uint64_t revision;                 /* changes when the environment or its blurred cube does */
};

struct tl_behind {
    struct tl_behind_request of;
    vec3s forward, right, up; /* in the environment's frame */
    bool is_interpolated;
    int columns, rows; /* tiles */
    float *colours;    /* [rows][columns][3][TL_BEHIND_PIXELS]: of those that are made */
    uint8_t *made;     /* [rows][columns] */
    size_t bytes;      /* of both */
};

/* Prepares tiles for a request: those of another request are forgotten. */
void tl_behind_begin(struct tl_behind *behind, const struct tl_behind_request *request);
/* Red, green and blue of the pixels of a tile: [3][TL_BEHIND_ROWS][TL_BEHIND_COLUMNS], rows upwards. Those
 * outside of the image hold arbitrary numbers. Threads: several at once, each with tiles of its own. */
const float *tl_behind_tile(struct tl_behind *behind, int column, int row);
void tl_behind_release(struct tl_behind *behind);

#endif
