#include "render/env/convert.h"

#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Overlaps of texels. A target texel is subdivided into cells whose outlines in the source picture are nearly
 * straight; these are clipped along the borders of the source texels. The shares of a cell sum to its exact
 * solid angle. Cells over seams, poles and rims of the source never become straight: at the last depth they
 * are assigned to the texel at their centre. */
#define STRAIGHT                                                                                             \
    0.01 /* largest distance, in source texels, between the centre of a cell and the mean of its corners */
#define DEPTH_MAX 6 /* subdivisions of a target texel into quarters */
#define INSET                                                                                                \
    1e-4 /* corners are moved inside by this fraction of the cell, off a seam that they may touch            \
          */
#define CORNERS 4
#define POLYGON                                                                                              \
    19 /* largest number of corners: each of four clips adds at most half as many, 4 6 9 13 19               \
        */
/* The shares are then scaled alternately by source and by target until each source texel distributes and each
 * target texel receives its exact solid angle (iterative proportional fitting [Deming and Stephan 1940]). */
#define ROUNDS_MAX 400
/* A fixed number of blocks of texels, each with its own list of shares, so that the result does not depend on
 * the number of threads. */
#define BLOCKS 64
/* Number of rounds of scaling that take about as long as finding the shares; used for the progress report
 * only. */
#define ROUNDS_USUAL 40

struct texel_share {
    uint32_t source, target;
    float solid_angle; /* sr */
};

struct share_block {
    struct texel_share *shares;
    size_t count, capacity;
};

/* The source or the target picture. */
struct side {
    const struct tl_sphere_map *map;
    double *solid_angles; /* [texels], sr */
    double *scales;       /* [texels], factors on the shares */
    double *sums;         /* [texels], of the scaled shares */
};

struct conversion {
    struct side source, target;
    struct share_block blocks[BLOCKS];
    struct tl_progress progress;
};

struct sphere_point {
    double x, y;
};

struct polygon {
    struct sphere_point points[POLYGON];
    int count;
};

static size_t texel_count(const struct tl_sphere_map *map)
{
    return (size_t)map->width * (size_t)map->height;
}

static struct tl_layout_cell texel_cell(const struct tl_sphere_map *map, size_t texel)
{
    size_t column = texel % (size_t)map->width, row = texel / (size_t)map->width;
    double x = (double)column, y = (double)row;
    return (struct tl_layout_cell){x, y, x + 1, y + 1};
}

static struct side side_create(const struct tl_sphere_map *map)
{
    size_t count = texel_count(map), width = (size_t)map->width;
    struct side side = {.map = map,
                        .solid_angles = TL_NEW_ARRAY(double, count),
                        .scales = TL_NEW_ARRAY(double, count),
                        .sums = TL_NEW_ARRAY(double, count)};
#pragma omp parallel for
    for (size_t i = 0; i < count; i++) {
        side.solid_angles[i] = tl_layout_solid_angle(map, (int)(i % width), (int)(i / width));
        side.scales[i] = 1;
    }
    return side;
}

static void side_release(struct side *side)
{
    free(side->solid_angles);
    free(side->scales);
    free(side->sums);
    *side = (struct side){0};
}

static void add_share(struct share_block *block, size_t source, size_t target, double solid_angle)
{
    if (solid_angle <= 0)
        return;
    if (block->count == block->capacity) {
        block->capacity = block->capacity ? 2 * block->capacity : 1024;
        block->shares = tl_resize(block->shares, block->capacity, sizeof *block->shares);
    }
    block->shares[block->count++] =
        (struct texel_share){(uint32_t)source, (uint32_t)target, (float)solid_angle};
}

/* The part of a polygon on which sign * (coordinate - border) <= 0; axis 0 is x. */
static struct polygon cut(const struct polygon *polygon, int axis, double border, double sign)
{
    struct polygon part = {.count = 0};
    for (int i = 0; i < polygon->count; i++) {
        struct sphere_point a = polygon->points[i], b = polygon->points[(i + 1) % polygon->count];
        double over_a = sign * ((axis ? a.y : a.x) - border), over_b = sign * ((axis ? b.y : b.x) - border);
        if (over_a <= 0)
            part.points[part.count++] = a;
        if ((over_a < 0 && over_b > 0) || (over_a > 0 && over_b < 0)) {
            double along = over_a / (over_a - over_b);
            part.points[part.count++] =
                (struct sphere_point){a.x + along * (b.x - a.x), a.y + along * (b.y - a.y)};
        }
    }
    return part;
}

/* Area of a convex polygon times the density at its centre of area: exact where the density is linear. */
static double weigh(const struct polygon *polygon, const struct tl_sphere_map *map)
{
    struct sphere_point origin = polygon->points[0];
    double twice = 0, x = 0, y = 0;
    for (int i = 1; i + 1 < polygon->count; i++) {
        struct sphere_point a = polygon->points[i], b = polygon->points[i + 1];
        double triangle = fabs((a.x - origin.x) * (b.y - origin.y) - (a.y - origin.y) * (b.x - origin.x));
        twice += triangle;
        x += triangle * (origin.x + a.x + b.x) / 3;
        y += triangle * (origin.y + a.y + b.y) / 3;
    }
    return twice > 0 ? 0.5 * twice * tl_layout_density(map, x / twice, y / twice) : 0;
}

static void bounds(const struct polygon *polygon, struct sphere_point *low, struct sphere_point *high)
{
    *low = *high = polygon->points[0];
    for (int i = 1; i < polygon->count; i++) {
        low->x = fmin(low->x, polygon->points[i].x);
        low->y = fmin(low->y, polygon->points[i].y);
        high->x = fmax(high->x, polygon->points[i].x);
        high->y = fmax(high->y, polygon->points[i].y);
    }
}

static int index_in(double value, int begin, int end)
{
    return value < begin ? begin : value >= end ? end - 1 : (int)value;
}

/* Distributes the solid angle of a cell over the source texels that its outline covers, in proportion to the
 * overlaps. */
static void share_outline(const struct side *source, const struct polygon *outline, int piece, size_t target,
                          double solid_angle, struct share_block *block)
{
    struct tl_layout_piece texels = tl_layout_piece(source->map, piece);
    struct sphere_point low, high;
    bounds(outline, &low, &high);
    int y0 = index_in(low.y, texels.y0, texels.y1), y1 = index_in(high.y, texels.y0, texels.y1);
    size_t begin = block->count;
    double sum = 0;
    for (int y = y0; y <= y1; y++) {
        struct polygon upper = cut(outline, 1, y + 1, 1), row = cut(&upper, 1, y, -1);
        if (row.count == 0)
            continue;
        bounds(&row, &low, &high);
        int x0 = index_in(low.x, texels.x0, texels.x1), x1 = index_in(high.x, texels.x0, texels.x1);
        for (int x = x0; x <= x1; x++) {
            struct polygon left = cut(&row, 0, x + 1, 1), part = cut(&left, 0, x, -1);
            double weight = weigh(&part, source->map);
            size_t texel = (size_t)y * (size_t)source->map->width + (size_t)x;
            if (source->solid_angles[texel] <= 0)
                continue;
            add_share(block, texel, target, weight);
            sum += weight;
        }
    }
    for (size_t i = begin; i < block->count; i++)
        block->shares[i].solid_angle = (float)((double)block->shares[i].solid_angle / sum * solid_angle);
}

/* Projects a cell into the source picture. False when the outline is not straight or not within one piece of
 * it. */
static bool find_outline(const struct conversion *conversion, const struct tl_layout_cell *cell,
                         struct polygon *outline, int *piece)
{
    const struct tl_sphere_map *source = conversion->source.map, *target = conversion->target.map;
    double middle_x = 0.5 * (cell->x0 + cell->x1), middle_y = 0.5 * (cell->y0 + cell->y1), mean_x = 0,
           mean_y = 0;
    double half_x = (0.5 - INSET) * (cell->x1 - cell->x0), half_y = (0.5 - INSET) * (cell->y1 - cell->y0);
    struct sphere_point centre, low, high;
    *piece = tl_layout_locate(source, tl_layout_direction(target, middle_x, middle_y), &centre.x, &centre.y);
    outline->count = CORNERS;
    for (int i = 0; i < CORNERS; i++) {
        double x = middle_x + (i == 1 || i == 2 ? half_x : -half_x),
               y = middle_y + (i < 2 ? half_y : -half_y);
        struct sphere_point *corner = &outline->points[i];
        if (!tl_layout_contains(target, x, y) ||
            tl_layout_locate(source, tl_layout_direction(target, x, y), &corner->x, &corner->y) != *piece)
            return false;
        mean_x += corner->x / CORNERS;
        mean_y += corner->y / CORNERS;
    }
    bounds(outline, &low, &high);
    return fabs(mean_x - centre.x) <= STRAIGHT && fabs(mean_y - centre.y) <= STRAIGHT &&
           high.x - low.x < 0.25 * source->width;
}

static void share_cell(const struct conversion *conversion, const struct tl_layout_cell *cell, size_t target,
                       int depth, struct share_block *block)
{
    struct polygon outline;
    int piece;
    double solid_angle = tl_layout_cell_solid_angle(conversion->target.map, cell);
    if (solid_angle <= 0)
        return;
    if (find_outline(conversion, cell, &outline, &piece)) {
        share_outline(&conversion->source, &outline, piece, target, solid_angle, block);
    } else if (depth == DEPTH_MAX) {
        double x, y;
        tl_layout_nearest(conversion->target.map, cell, &x, &y);
        vec3s direction = tl_layout_direction(conversion->target.map, x, y);
        add_share(block, tl_layout_texel(conversion->source.map, direction), target, solid_angle);
    } else {
        double x = 0.5 * (cell->x0 + cell->x1), y = 0.5 * (cell->y0 + cell->y1);
        const struct tl_layout_cell quarters[4] = {{cell->x0, cell->y0, x, y},
                                                   {x, cell->y0, cell->x1, y},
                                                   {cell->x0, y, x, cell->y1},
                                                   {x, y, cell->x1, cell->y1}};
        for (int i = 0; i < 4; i++)
            share_cell(conversion, &quarters[i], target, depth + 1, block);
    }
}

static int by_source(const void *a, const void *b)
{
    uint32_t first = ((const struct texel_share *)a)->source,
             second = ((const struct texel_share *)b)->source;
    return (first > second) - (first < second);
}

/* Merges the shares that the cells of one target texel have in the same source texel. */
static void merge_shares(struct share_block *block, size_t begin)
{
    size_t kept = begin;
    if (block->count > begin)
        qsort(block->shares + begin, block->count - begin, sizeof *block->shares, by_source);
    for (size_t i = begin; i < block->count; i++) {
        if (kept > begin && block->shares[kept - 1].source == block->shares[i].source)
            block->shares[kept - 1].solid_angle += block->shares[i].solid_angle;
        else
            block->shares[kept++] = block->shares[i];
    }
    block->count = kept;
}

static void find_shares(struct conversion *conversion)
{
    size_t count = texel_count(conversion->target.map);
    int done = 0;
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < BLOCKS; i++) {
        struct share_block *block = &conversion->blocks[i];
        if (tl_interrupted())
            continue;
        for (size_t texel = count * (size_t)i / BLOCKS; texel < count * (size_t)(i + 1) / BLOCKS; texel++) {
            struct tl_layout_cell cell = texel_cell(conversion->target.map, texel);
            size_t begin = block->count;
            share_cell(conversion, &cell, texel, 0, block);
            merge_shares(block, begin);
        }
#pragma omp critical
        tl_progress_update(&conversion->progress, 0.5 * ++done / BLOCKS, 1);
    }
}

static void clear_sums(struct side *side)
{
    for (size_t i = 0; i < texel_count(side->map); i++)
        side->sums[i] = 0;
}

static void sum_targets(struct conversion *conversion)
{
    clear_sums(&conversion->target);
    for (int i = 0; i < BLOCKS; i++) {
        const struct share_block *block = &conversion->blocks[i];
        for (const struct texel_share *share = block->shares; share < block->shares + block->count; share++)
            conversion->target.sums[share->target] +=
                (double)share->solid_angle * conversion->source.scales[share->source];
    }
}

static void sum_sources(struct conversion *conversion)
{
    clear_sums(&conversion->source);
    for (int i = 0; i < BLOCKS; i++) {
        const struct share_block *block = &conversion->blocks[i];
        for (const struct texel_share *share = block->shares; share < block->shares + block->count; share++)
            conversion->source.sums[share->source] +=
                (double)share->solid_angle * conversion->target.scales[share->target];
    }
}

/* Assigns slivers of source texels at the rims of discs that no cell covered. */
static void share_missed(struct conversion *conversion)
{
    const struct side *source = &conversion->source;
    sum_sources(conversion);
    for (size_t i = 0; i < texel_count(source->map); i++) {
        if (source->solid_angles[i] <= 0 || source->sums[i] > 0)
            continue;
        double x, y;
        struct tl_layout_cell cell = texel_cell(source->map, i);
        tl_layout_nearest(source->map, &cell, &x, &y);
        vec3s direction = tl_layout_direction(source->map, x, y);
        add_share(&conversion->blocks[BLOCKS - 1], i, tl_layout_texel(conversion->target.map, direction),
                  source->solid_angles[i]);
    }
}

static void scale_to_fit(struct side *side)
{
    for (size_t i = 0; i < texel_count(side->map); i++)
        if (side->sums[i] > 0)
            side->scales[i] = side->solid_angles[i] / side->sums[i];
}

/* Largest relative error of the solid angle that a source texel distributes. */
static double worst_source(const struct side *source)
{
    double worst = 0;
    for (size_t i = 0; i < texel_count(source->map); i++)
        if (source->solid_angles[i] > 0)
            worst = fmax(worst, fabs(source->scales[i] * source->sums[i] / source->solid_angles[i] - 1));
    return worst;
}

/* Fits the shares and returns the remaining error of the sources. The last step scales the targets, whose
 * sums are exact then. */
static double fit_shares(struct conversion *conversion)
{
    double worst = INFINITY;
    for (int round = 0; worst >= TL_CONVERT_ERROR && round < ROUNDS_MAX && !tl_interrupted(); round++) {
        tl_progress_update(&conversion->progress, 0.5 + 0.5 * fmin((double)round / ROUNDS_USUAL, 0.99), 1);
        if (round > 0)
            scale_to_fit(&conversion->source);
        sum_targets(conversion);
        scale_to_fit(&conversion->target);
        sum_sources(conversion);
        worst = worst_source(&conversion->source);
    }
    return worst;
}

static void sum_light(const struct conversion *conversion, const float *from, float *to)
{
    const struct side *source = &conversion->source, *target = &conversion->target;
    double(*sums)[3] = tl_alloc(texel_count(target->map), sizeof *sums);
    for (int i = 0; i < BLOCKS; i++) {
        const struct share_block *block = &conversion->blocks[i];
        for (const struct texel_share *share = block->shares; share < block->shares + block->count; share++) {
            double weight = (double)share->solid_angle * source->scales[share->source] *
                            target->scales[share->target] / target->solid_angles[share->target];
            for (int c = 0; c < 3; c++)
                sums[share->target][c] += weight * (double)from[3 * (size_t)share->source + (size_t)c];
        }
    }
    for (size_t i = 0; i < texel_count(target->map); i++)
        for (size_t c = 0; c < 3; c++)
            to[3 * i + c] = (float)sums[i][c];
    free(sums);
}

/* Fills texels outside of the discs with the colour that lies in their direction. */
static void fill_outside(const struct side *target, float *texels)
{
    for (size_t i = 0; i < texel_count(target->map); i++) {
        if (target->solid_angles[i] > 0)
            continue;
        struct tl_layout_cell cell = texel_cell(target->map, i);
        vec3s direction = tl_layout_direction(target->map, cell.x0 + 0.5, cell.y0 + 0.5);
        size_t shown = tl_layout_texel(target->map, direction);
        for (size_t c = 0; c < 3; c++)
            texels[3 * i + c] = texels[3 * shown + c];
    }
}

int tl_convert_size(const struct tl_sphere_map *from, enum tl_layout to)
{
    static const int parts[TL_LAYOUT_COUNT] = {[TL_LAYOUT_CUBE] = 1,
                                               [TL_LAYOUT_LATLONG] = 2,
                                               [TL_LAYOUT_PARABOLOID] = 2,
                                               [TL_LAYOUT_SPHERE] = 3,
                                               [TL_LAYOUT_OCTAHEDRAL] = 3};
    int size = (int)((int64_t)tl_layout_size(from) * parts[to] / parts[from->layout]);
    return size > 1 ? size : 1;
}

/* Writes the converted picture. Returns the largest relative error of the solid angle that a source texel
 * distributes. */
static double convert(const tl_image *image, const struct tl_sphere_map *from, const struct tl_sphere_map *to,
                      float *texels)
{
    struct conversion conversion = {
        .source = side_create(from), .target = side_create(to), .progress = tl_progress_begin("converting")};
    find_shares(&conversion);
    share_missed(&conversion);
    double worst = fit_shares(&conversion);
    sum_light(&conversion, tl_image_floats(image), texels);
    fill_outside(&conversion.target, texels);
    tl_progress_end(&conversion.progress);
    for (int i = 0; i < BLOCKS; i++)
        free(conversion.blocks[i].shares);
    side_release(&conversion.source);
    side_release(&conversion.target);
    return worst;
}

uint64_t tl_convert_bytes(const struct tl_sphere_map *from, const struct tl_sphere_map *to)
{
    /* A list of shares has up to twice the size that it needs. A texel has about as many shares as the texels
     * of the finer map that it covers, and those that its sides cut. */
    const uint64_t side_bytes = 3 * sizeof(double), share_bytes = 2 * 2 * 2 * sizeof(struct texel_share),
                   target_bytes = 3 * (sizeof(double) + sizeof(float));
    return (texel_count(from) + texel_count(to)) * (side_bytes + share_bytes) +
           texel_count(to) * target_bytes;
}

tl_image tl_image_convert(const tl_image *image, const struct tl_sphere_map *from,
                          const struct tl_sphere_map *to, double *error)
{
    assert(image->type == TL_IMAGE_F32 && image->channels == 3);
    assert(image->width == from->width && image->height == from->height);
    tl_image converted = tl_image_create(to->width, to->height, 3, TL_IMAGE_F32);
    double worst = 0;
    if (from->layout == to->layout && from->width == to->width && from->height == to->height)
        memcpy(converted.texels, image->texels, texel_count(from) * sizeof(float[3]));
    else
        worst = convert(image, from, to, tl_image_floats(&converted));
    if (tl_interrupted())
        tl_image_release(&converted);
    if (error)
        *error = worst;
    return converted;
}
