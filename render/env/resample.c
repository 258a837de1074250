#include "render/env/resample.h"

#include "config/base/memory.h"
#include "render/env/cube.h"

#include <math.h>
#include <stdlib.h>

/* Every source texel is distributed over the cube texels that it covers. If all its corners lie in one cube
 * texel it belongs there entirely; otherwise it is halved, down to cells of an eighth of a cube texel, which
 * are distributed by area. So no texel is missed, however thin the source texels are at the poles, and each
 * keeps its exact solid angle. */
#define CELLS_PER_TEXEL 8
/* The corners determine the texel of a cell only if its sides are nearly straight: a turn has at least this
 * many cells. */
#define TURN_CELLS_MIN 64
/* A fixed number of blocks of rows, each with its own list of shares, so that the result does not depend on
 * the number of threads. */
#define BLOCKS 4
/* Source texels in a band, the part that is resampled at once. The weights of an image of one band are
 * kept. */
#define BAND_TEXELS ((size_t)1 << 20)

struct resample_grid {
    const tl_image *image;
    int size;                  /* of the target cube */
    int steps_x, steps_y;      /* per source texel, powers of two; the smallest cell has two */
    int widest, highest;       /* largest steps of a cell whose corners decide */
    double *sin_phi, *cos_phi; /* [width * steps_x + 1], phi = atan2(x, -z) */
    double *y, *radius; /* [height * steps_y + 1]: height and distance from the axis on the unit sphere */
};

struct grid_cell {
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

static struct resample_grid grid_create(const tl_image *image, int size)
{
    int turn = 4 * size * CELLS_PER_TEXEL; /* cells; four faces are one turn */
    if (turn < TURN_CELLS_MIN)
        turn = TURN_CELLS_MIN;
    struct resample_grid grid = {.image = image,
                                 .size = size,
                                 .steps_x = steps_for(image->width, 2 * turn),
                                 .steps_y = steps_for(image->height, turn)};
    int columns = image->width * grid.steps_x, rows = image->height * grid.steps_y;
    grid.widest = columns / TURN_CELLS_MIN;
    grid.highest = 2 * rows / TURN_CELLS_MIN;
    grid.sin_phi = TL_NEW_ARRAY(double, (size_t)columns + 1);
    grid.cos_phi = TL_NEW_ARRAY(double, (size_t)columns + 1);
    grid.y = TL_NEW_ARRAY(double, (size_t)rows + 1);
    grid.radius = TL_NEW_ARRAY(double, (size_t)rows + 1);
    for (int i = 0; i <= columns; i++) {
        double phi = ((double)i / columns - 0.5) * 2 * M_PI;
        grid.sin_phi[i] = sin(phi);
        grid.cos_phi[i] = cos(phi);
    }
    for (int i = 0; i <= rows; i++) {
        grid.y[i] = cos(M_PI * i / rows);
        grid.radius[i] = sin(M_PI * i / rows);
    }
    return grid;
}

static void grid_release(struct resample_grid *grid)
{
    free(grid->sin_phi);
    free(grid->cos_phi);
    free(grid->y);
    free(grid->radius);
    *grid = (struct resample_grid){0};
}

static vec3s grid_direction(const struct resample_grid *grid, int x, int y)
{
    double radius = grid->radius[y];
    return (vec3s){
        {(float)(radius * grid->sin_phi[x]), (float)grid->y[y], (float)(-radius * grid->cos_phi[x])}};
}

static int grid_texel(const struct resample_grid *grid, int x, int y)
{
    return tl_cube_texel(grid->size, grid_direction(grid, x, y));
}

/* A share before sorting by target. */
struct share {
    uint32_t source, target;
    double solid_angle;
};

/* The shares of some rows in the order of their sources. */
struct stream {
    struct share *shares;
    size_t count, capacity;
    uint32_t source; /* texel that is being split */
    uint32_t *last;  /* [6 * size * size]: 1 + index of the latest share of a target; 0: none */
};

static void append_share(struct stream *stream, uint32_t target, double solid_angle)
{
    uint32_t last = stream->last[target];
    if (last > 0 && stream->shares[last - 1].source == stream->source) {
        stream->shares[last - 1].solid_angle += solid_angle;
        return;
    }
    if (stream->count == stream->capacity) {
        stream->capacity = stream->capacity ? 2 * stream->capacity : 1024;
        stream->shares = tl_resize(stream->shares, stream->capacity, sizeof *stream->shares);
    }
    stream->shares[stream->count++] = (struct share){stream->source, target, solid_angle};
    stream->last[target] = (uint32_t)stream->count;
}

static void add_share(const struct resample_grid *grid, const struct grid_cell *cell, double share,
                      int target, struct stream *stream)
{
    double step = 2 * M_PI / ((double)grid->image->width * grid->steps_x);
    double height = grid->y[cell->y0] - grid->y[cell->y1];
    append_share(stream, (uint32_t)target, share * (cell->x1 - cell->x0) * step * height);
}

/* The fraction of [centre - reach, centre + reach] above the border. */
static double share_above(double centre, double reach, double border)
{
    return fmin(fmax((centre + reach - border) / (2 * reach), 0), 1);
}

/* Distributes the smallest cell, approximated by its bounding box on the plane of its face, over up to four
 * cube texels by area. On four of the faces the borders of cube texels run along lines of the map; assigning
 * the whole cell to the texel of its centre would make the same error for all cells of a column. */
static void split_smallest(const struct resample_grid *grid, const struct grid_cell *cell,
                           struct stream *stream)
{
    int face;
    float s, t;
    tl_cube_locate(grid_direction(grid, cell->x0 + 1, cell->y0 + 1), &face, &s, &t);
    double reach_x = 0, reach_y = 0;
    for (int i = 0; i < 4; i++) {
        float corner_s, corner_t;
        vec3s corner = grid_direction(grid, i & 1 ? cell->x1 : cell->x0, i & 2 ? cell->y1 : cell->y0);
        tl_cube_project(face, corner, &corner_s, &corner_t);
        reach_x = fmax(reach_x, grid->size * fabs((double)(corner_s - s)));
        reach_y = fmax(reach_y, grid->size * fabs((double)(corner_t - t)));
    }
    double x = grid->size * (double)s, y = grid->size * (double)t;
    int border_x = (int)(x + 0.5), border_y = (int)(y + 0.5);
    double above_x = share_above(x, reach_x, border_x), above_y = share_above(y, reach_y, border_y);
    for (int i = 0; i < 4; i++) {
        double share = (i & 1 ? above_x : 1 - above_x) * (i & 2 ? above_y : 1 - above_y);
        if (share > 0)
            add_share(grid, cell, share,
                      tl_cube_texel_across(grid->size, face, border_x - !(i & 1), border_y - !(i & 2)),
                      stream);
    }
}

static void split_cell(const struct resample_grid *grid, const struct grid_cell *cell, struct stream *stream)
{
    const int *corners = cell->corners;
    int x0 = cell->x0, y0 = cell->y0, x1 = cell->x1, y1 = cell->y1;
    bool uniform = corners[0] == corners[1] && corners[0] == corners[2] && corners[0] == corners[3];
    if (uniform && x1 - x0 <= grid->widest && y1 - y0 <= grid->highest) {
        add_share(grid, cell, 1, corners[0], stream);
    } else if (x1 - x0 == 2 && y1 - y0 == 2) {
        split_smallest(grid, cell, stream);
    } else if (x1 - x0 >= y1 - y0) {
        int middle = (x0 + x1) / 2, top = grid_texel(grid, middle, y0), bottom = grid_texel(grid, middle, y1);
        split_cell(grid, &(struct grid_cell){x0, y0, middle, y1, {corners[0], top, corners[2], bottom}},
                   stream);
        split_cell(grid, &(struct grid_cell){middle, y0, x1, y1, {top, corners[1], bottom, corners[3]}},
                   stream);
    } else {
        int middle = (y0 + y1) / 2, left = grid_texel(grid, x0, middle), right = grid_texel(grid, x1, middle);
        split_cell(grid, &(struct grid_cell){x0, y0, x1, middle, {corners[0], corners[1], left, right}},
                   stream);
        split_cell(grid, &(struct grid_cell){x0, middle, x1, y1, {left, right, corners[2], corners[3]}},
                   stream);
    }
}

static void split_rows(const struct resample_grid *grid, int begin, int end, struct stream *stream)
{
    for (int row = begin; row < end; row++) {
        int y0 = row * grid->steps_y, y1 = y0 + grid->steps_y;
        struct grid_cell cell = {0, y0, 0, y1, {0, grid_texel(grid, 0, y0), 0, grid_texel(grid, 0, y1)}};
        for (int column = 0; column < grid->image->width; column++) {
            cell.x0 = cell.x1;
            cell.x1 += grid->steps_x;
            cell.corners[0] = cell.corners[1];
            cell.corners[2] = cell.corners[3];
            cell.corners[1] = grid_texel(grid, cell.x1, y0);
            cell.corners[3] = grid_texel(grid, cell.x1, y1);
            stream->source = (uint32_t)row * (uint32_t)grid->image->width + (uint32_t)column;
            split_cell(grid, &cell, stream);
        }
    }
}

static size_t target_count(int size)
{
    return 6 * (size_t)size * (size_t)size;
}

/* Sorts the shares by target (counting sort); shares of a target keep the order of their sources. */
static void sort_shares(struct stream streams[BLOCKS], struct tl_resampling *out)
{
    size_t targets = target_count(out->size), count = 0;
    uint32_t *next = TL_NEW_ARRAY(uint32_t, targets), place = 0;
    for (int block = 0; block < BLOCKS; block++) {
        count += streams[block].count;
        for (size_t i = 0; i < streams[block].count; i++)
            next[streams[block].shares[i].target]++;
    }
    out->first = TL_NEW_ARRAY(uint32_t, targets + 1);
    out->shares = TL_NEW_ARRAY(struct tl_resampling_share, count);
    for (size_t i = 0; i < targets; i++) {
        out->first[i] = place;
        place += next[i];
        next[i] = out->first[i];
    }
    out->first[targets] = place;
    for (int block = 0; block < BLOCKS; block++) {
        for (size_t i = 0; i < streams[block].count; i++) {
            const struct share *share = &streams[block].shares[i];
            out->shares[next[share->target]++] =
                (struct tl_resampling_share){share->source, (float)share->solid_angle};
        }
    }
    free(next);
}

/* The shares of rows [begin, end). */
static struct tl_resampling overlaps_of_rows(const struct resample_grid *grid, int begin, int end)
{
    struct tl_resampling weights = {
        .width = grid->image->width, .height = grid->image->height, .size = grid->size};
    struct stream streams[BLOCKS] = {{0}};
    int64_t rows = end - begin;
#pragma omp parallel for schedule(dynamic)
    for (int block = 0; block < BLOCKS; block++) {
        streams[block].last = TL_NEW_ARRAY(uint32_t, target_count(grid->size));
        split_rows(grid, begin + (int)(rows * block / BLOCKS), begin + (int)(rows * (block + 1) / BLOCKS),
                   &streams[block]);
    }
    sort_shares(streams, &weights);
    for (int block = 0; block < BLOCKS; block++) {
        free(streams[block].shares);
        free(streams[block].last);
    }
    return weights;
}

/* Sums of colour x solid angle, and of solid angle, by target. */
static void gather(const struct tl_resampling *weights, const tl_image *image, double (*sums)[4])
{
    const float *colours = tl_image_floats(image);
#pragma omp parallel for
    for (size_t i = 0; i < target_count(weights->size); i++) {
        for (uint32_t k = weights->first[i]; k < weights->first[i + 1]; k++) {
            const float *colour = colours + 3 * (size_t)weights->shares[k].source;
            double solid_angle = (double)weights->shares[k].solid_angle;
            for (int c = 0; c < 3; c++)
                sums[i][c] += solid_angle * (double)colour[c];
            sums[i][3] += solid_angle;
        }
    }
}

void tl_resampling_release(struct tl_resampling *weights)
{
    free(weights->first);
    free(weights->shares);
    *weights = (struct tl_resampling){0};
}

/* Resamples band by band, because the shares of the largest images would not fit into memory. */
static void resample_in_bands(const tl_image *image, int size, int band_rows, double (*sums)[4])
{
    struct resample_grid grid = grid_create(image, size);
    for (int begin = 0; begin < image->height; begin += band_rows) {
        int end = image->height - begin > band_rows ? begin + band_rows : image->height;
        struct tl_resampling weights = overlaps_of_rows(&grid, begin, end);
        gather(&weights, image, sums);
        tl_resampling_release(&weights);
    }
    grid_release(&grid);
}

static void update_weights(const tl_image *image, int size, struct tl_resampling *weights)
{
    if (weights->width == image->width && weights->height == image->height && weights->size == size)
        return;
    struct resample_grid grid = grid_create(image, size);
    tl_resampling_release(weights);
    *weights = overlaps_of_rows(&grid, 0, image->height);
    grid_release(&grid);
}

void tl_resample_latlong(const tl_image *image, int size, float *texels, struct tl_resampling *weights)
{
    size_t targets = target_count(size), band_rows = BAND_TEXELS / (size_t)image->width;
    double(*sums)[4] = tl_alloc(targets, sizeof *sums);
    if (band_rows < (size_t)image->height) {
        resample_in_bands(image, size, (int)band_rows, sums);
    } else {
        update_weights(image, size, weights);
        gather(weights, image, sums);
    }
    for (size_t i = 0; i < targets; i++)
        for (size_t c = 0; c < 3; c++)
            texels[3 * i + c] = (float)(sums[i][c] / sums[i][3]);
    free(sums);
}
