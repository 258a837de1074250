#include "assets/weave/knit.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A piece of pile is as large as its fibres can be drawn, three texels wide: the larger it is, the less its
 * repeats show. */
#define PILE_TEXELS      1024
#define TEXELS_PER_FIBRE 3.0
#define PILE_MIN_MM      32.0
#define PILE_MAX_MM      48.0
#define LEAN_MAX                                                                                             \
    1.2 /* slope of the axis of a pile that leans all, where its patch leans most [LOOK: by eye] */
#define TIP_DEPTH 1.5 /* tips of a pile end within, in radii */

/* A fibre: a curve that wanders over the surface and leaves it by up to `lift` in its middle. */
struct fibre {
    double x, y, heading;              /* m, rad */
    double length, radius, lift, curl; /* m; curl: rad per m */
    float shade, tint[3];
    uint32_t seed;
};

static float surface_at(const struct tl_tile *tile, const float *heights, double x, double y)
{
    int column = (int)floor(x / tile->size_m[0] * tile->width),
        row = (int)floor(y / tile->size_m[1] * tile->height);
    column = (column % tile->width + tile->width) % tile->width;
    row = (row % tile->height + tile->height) % tile->height;
    return heights[(size_t)(tile->height - 1 - row) * (size_t)tile->width + (size_t)column];
}

static void lay_fibre(const struct fibre *fibre, const float *base, struct tl_tile *tile)
{
    const int steps = (int)ceil(fibre->length / (0.8 * fibre->radius));
    const double step = fibre->length / steps;
    double x = fibre->x, y = fibre->y, heading = fibre->heading, z = 0;
    for (int k = 0; k <= steps; k++) {
        const double t = (double)k / steps;
        const double ground = (double)surface_at(tile, base, x, y);
        z = k == 0 ? ground : z + 0.06 * (ground - z); /* it bridges what is narrower than itself */
        const struct tl_strand strand = {.x = x,
                                         .y = y,
                                         .z = z + fibre->lift * sin(M_PI * t),
                                         .radius = fibre->radius,
                                         .along_x = cos(heading),
                                         .along_y = sin(heading),
                                         .tint = {fibre->shade * fibre->tint[0],
                                                  fibre->shade * fibre->tint[1],
                                                  fibre->shade * fibre->tint[2]},
                                         .seed = fibre->seed};
        tl_tile_lay(tile, &strand);
        heading += fibre->curl * step * (1 + 1.5 * tl_tile_noise(fibre->seed, 3 * t, 64));
        x += step * cos(heading);
        y += step * sin(heading);
    }
}

/* Three octaves of smooth noise that repeats with the tile, about [-1, 1]. */
static double noise_at(uint32_t seed, double u, double v, int cells)
{
    double sum = 0;
    for (int octave = 0; octave < 3; octave++) {
        const int n = cells << octave;
        const double x = u * n, y = v * n, row = floor(y), t = y - row, smooth = t * t * (3 - 2 * t);
        double low = tl_tile_noise(seed + (uint32_t)octave * 256 + (uint32_t)((int)row % n), x, n);
        double high = tl_tile_noise(seed + (uint32_t)octave * 256 + (uint32_t)(((int)row + 1) % n), x, n);
        sum += (low + (high - low) * smooth) / (1 << octave);
    }
    return sum / 1.75;
}

/* The cells of `size_mm` in a tile, as many as repeat with it. */
static int cells_of(const struct tl_tile *tile, double size_mm)
{
    int cells = (int)lround(1e3 * tile->size_m[0] / size_mm);
    return cells < 2 ? 2 : cells > 31 ? 31 : cells;
}

/* A pile that stands is seen from above its tips, each a little deeper or less deep than its neighbours. */
static void lay_tips(const struct tl_weave_params *params, struct tl_tile *tile)
{
    const double radius = 0.5e-3 * (double)params->fibre_mm, area = tile->size_m[0] * tile->size_m[1];
    const int count = (int)lround((double)params->nap * area / (M_PI * radius * radius));
    for (int i = 0; i < count; i++) {
        const uint32_t seed = 77000u + (uint32_t)i;
        const double x = tile->size_m[0] * tl_tile_random(seed, 0, 0);
        const double y = tile->size_m[1] * tl_tile_random(seed, 1, 0);
        const float shade = (float)(1 + (double)params->melange * (2 * tl_tile_random(seed, 7, 0) - 1));
        const struct tl_strand tip = {.x = x,
                                      .y = y,
                                      .z = -radius * TIP_DEPTH * tl_tile_random(seed, 5, 0),
                                      .radius = radius * (0.8 + 0.4 * tl_tile_random(seed, 4, 0)),
                                      .along_x = 1,
                                      .tint = {shade, shade, shade},
                                      .seed = seed};
        tl_tile_lay(tile, &tip);
    }
}

/* The lean that hands and folds leave in a pile: in patches of the size of its clumps, each towards somewhere
 * else. */
static void lean(const struct tl_weave_params *params, struct tl_tile *tile)
{
    const int cells = cells_of(tile, (double)params->clump_mm);
    const double maximum = LEAN_MAX * (double)params->lean;
    tile->leans = TL_NEW_ARRAY(float, 2 * (size_t)tile->width * (size_t)tile->height);
#pragma omp parallel for schedule(static)
    for (int row = 0; row < tile->height; row++)
        for (int column = 0; column < tile->width; column++) {
            const double u = (column + 0.5) / tile->width, v = (tile->height - row - 0.5) / tile->height;
            float *slopes = tile->leans + 2 * ((size_t)row * (size_t)tile->width + (size_t)column);
            for (uint32_t k = 0; k < 2; k++)
                slopes[k] = (float)(maximum * noise_at(5900u + 1024 * k, u, v, cells));
        }
}

void tl_nap_lay(const struct tl_weave_params *params, const float tint[3], struct tl_tile *tile)
{
    if (params->pattern == TL_WEAVE_PILE && params->lean > 0) {
        lay_tips(params, tile);
        lean(params, tile);
        return;
    }
    const double length = 1e-3 * (double)params->nap_mm, radius = 0.5e-3 * (double)params->fibre_mm;
    const double area = tile->size_m[0] * tile->size_m[1];
    const int count = (int)lround((double)params->nap * area / (2 * radius * length));
    const size_t texels = (size_t)tile->width * (size_t)tile->height;
    float *base = TL_NEW_ARRAY(float, texels);
    memcpy(base, tile->heights, texels * sizeof *base);
    for (int i = 0; i < count; i++) {
        const uint32_t seed = 77000u + (uint32_t)i;
        const double own = tl_tile_random(seed, 3, 0);
        const double x = tile->size_m[0] * tl_tile_random(seed, 0, 0);
        const double y = tile->size_m[1] * tl_tile_random(seed, 1, 0);
        const struct fibre fibre = {
            .x = x,
            .y = y,
            .heading = 2 * M_PI * tl_tile_random(seed, 2, 0),
            .length = length * (0.5 + own),
            .radius = radius * (0.8 + 0.4 * tl_tile_random(seed, 4, 0)),
            .lift = length * 0.06 * tl_tile_random(seed, 5, 0),
            .curl = (double)params->curl * (2 * tl_tile_random(seed, 6, 0) - 1) / radius,
            .shade = (float)(1 + (0.12 + (double)params->melange) * (2 * tl_tile_random(seed, 7, 0) - 1)),
            .tint = {tint[0], tint[1], tint[2]},
            .seed = seed};
        lay_fibre(&fibre, base, tile);
    }
    free(base);
}

struct tl_tile tl_pile_make(const struct tl_weave_params *params)
{
    const double drawn_mm = PILE_TEXELS * (double)params->fibre_mm / TEXELS_PER_FIBRE;
    const double side = 1e-3 * fmin(fmax(drawn_mm, PILE_MIN_MM), PILE_MAX_MM);
    struct tl_tile tile = tl_tile_make(PILE_TEXELS, PILE_TEXELS, side, side, 0);
    const int cells = cells_of(&tile, (double)params->clump_mm);
    for (int row = 0; row < tile.height; row++)
        for (int column = 0; column < tile.width; column++)
            tile.heights[(size_t)row * PILE_TEXELS + (size_t)column] =
                (float)(0.5e-3 * (double)params->crimp_mm *
                        noise_at(900u, (column + 0.5) / PILE_TEXELS, (row + 0.5) / PILE_TEXELS, cells));
    tl_tile_even_heights(&tile);
    return tile;
}
