#include "render/shade/outlines.h"

#include "config/base/memory.h"
#include "config/base/simd.h"
#include "render/env/quad.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BAND_ROWS 32 /* of pixels, that a thread takes at a time */

/* Depths fit when they differ by no more than a plane's at this slope would over one sample (the tangent of
 * its angle to the image), beyond what the plane of the triangle accounts for. */
#define SLOPE_MARGIN 2.0f
/* ... which is trusted up to this slope. */
#define SLOPE_MAX 16.0f
/* Samples to each side among which one of any part is looked for. */
#define REACH 8

/* The surface at a pixel or sample. */
struct shown {
    uint32_t part;            /* 0: nothing; else one number for each part and side */
    float nearness;           /* 1 / depth, 1/m */
    float change_x, change_y; /* of it, on the triangle's plane, to the next pixel or sample */
};

/* A grid of ids, and the rays through it. */
struct id_grid {
    const struct tl_id_buffer *ids;
    vec3s first, across, up; /* the ray through (0, 0) and its changes; depth 1 along the view */
};

struct outlines {
    const struct tl_outlines_request *request;
    struct id_grid samples, pixels;
    double ratio_x, ratio_y;  /* samples a pixel */
    float margin;             /* of depth, relative: SLOPE_MARGIN over one sample */
    float pixels_x, pixels_y; /* pixels a sample */
    uint32_t ground_part;     /* its number, the last one; greater than any where there is no ground */
    const int *columns;       /* [width of the pixels]: the sample to the left; -1 at the border */
    const float *shares;      /* ... and the share of the one to the right */
};

/* Rows of samples about a band of pixels; of each array [count][samples' width]. */
struct sample_band {
    int first, count; /* the first row may be above the border */
    uint32_t *parts;
    float *nearness, *changes_x, *changes_y;
    uint8_t *across; /* 1: a sample and the next one of its row fit one another */
    uint8_t *same;   /* [count][samples' width + 1]: see join_rows */
};

static struct id_grid make_grid(const struct tl_id_buffer *ids, const struct tl_view *view)
{
    struct id_grid grid = {.ids = ids,
                           .across = glms_vec3_scale(view->right, 2 / (float)ids->width),
                           .up = glms_vec3_scale(view->up, 2 / (float)ids->height)};
    vec3s corner = glms_vec3_sub(view->forward, glms_vec3_add(view->right, view->up));
    grid.first = glms_vec3_add(corner, glms_vec3_scale(glms_vec3_add(grid.across, grid.up), 0.5f));
    return grid;
}

/* The part of a surface that holds triangles first .. end - 1. Ids that follow one another are mostly of one
 * part. */
struct part_cursor {
    uint32_t first, end;
    uint32_t surface_first; /* number of the surface's first triangle */
    const tl_surface *surface;
    uint32_t part; /* number for its front; its back has the next one */
};

static uint32_t number_of(size_t part)
{
    return 2 + 2 * (uint32_t)part;
}

static void find_part(const struct tl_outlines_request *request, uint32_t number, struct part_cursor *cursor)
{
    uint32_t corners[3];
    size_t index;
    const tl_surface *surface = tl_triangle_find(request->ranges, number, corners, &index);
    const uint32_t first = request->ranges->first[index];
    const struct tl_mesh_part *part = tl_triangle_part(surface, number - first);
    *cursor = (struct part_cursor){
        .first = first + (uint32_t)(part->first_index / 3),
        .end = first + (uint32_t)((part->first_index + part->index_count) / 3),
        .surface_first = first,
        .surface = surface,
        .part = number_of(tl_shade_part_at(request->materials, surface, index, number - first))};
}

TL_INLINE uint32_t part_of(const struct tl_outlines_request *request, uint32_t id, struct part_cursor *cursor)
{
    uint32_t number = (id & ~TL_SAMPLE_BACK) - 1;
    if (number < cursor->first || number >= cursor->end)
        find_part(request, number, cursor);
    return cursor->part + (id & TL_SAMPLE_BACK ? 1 : 0);
}

/* The plane of a triangle, as 1 / depth over the grid, linear there: of the ray d that meets the plane
 * through p with normal n, depth is n (p - eye) / n d. Returns it at (0, 0). `cursor` is at the id's part. */
static struct shown show_triangle(const struct outlines *outlines, const struct id_grid *grid,
                                  const struct part_cursor *cursor, uint32_t id)
{
    const tl_surface *surface = cursor->surface;
    const uint32_t *corners =
        &surface->indices[3 * (size_t)((id & ~TL_SAMPLE_BACK) - 1 - cursor->surface_first)];
    const vec3s a = surface->positions[corners[0]];
    const vec3s normal = glms_vec3_cross(glms_vec3_sub(surface->positions[corners[1]], a),
                                         glms_vec3_sub(surface->positions[corners[2]], a));
    const float height = glms_vec3_dot(normal, glms_vec3_sub(a, outlines->request->view->eye));
    const float scale = height != 0 ? 1 / height : 0; /* seen edge on: no sample fits */
    return (struct shown){.part = cursor->part + (id & TL_SAMPLE_BACK ? 1 : 0),
                          .nearness = scale * glms_vec3_dot(normal, grid->first),
                          .change_x = scale * glms_vec3_dot(normal, grid->across),
                          .change_y = scale * glms_vec3_dot(normal, grid->up)};
}

/* True when a sample continues a surface that is seen elsewhere: `change` is that of nearness from there to
 * the sample on the triangle's plane. */
TL_INLINE bool fits(uint32_t part, float nearness, float change, uint32_t sample_part, float sample_nearness,
                    float margin)
{
    const float allowed = margin * nearness, maximum = SLOPE_MAX / SLOPE_MARGIN * allowed;
    const float trusted = tl_maxf(tl_minf(change, maximum), -maximum);
    const float difference = sample_nearness - nearness;
    const float min = tl_minf(trusted, 0) - allowed, max = tl_maxf(trusted, 0) + allowed;
    return (part == sample_part) & (difference >= min) & (difference <= max);
}

TL_INLINE int within(int i, int count)
{
    return i < 0 ? 0 : i < count ? i : count - 1;
}

/* ---- Samples about a band ---- */

/* Fills row `i` of the band from row `y` of the samples. */
static void show_row(const struct outlines *outlines, int y, struct sample_band *band, int i)
{
    const struct tl_id_buffer *ids = outlines->samples.ids;
    const uint32_t *from = ids->ids + (size_t)y * (size_t)ids->width;
    const size_t row = (size_t)i * (size_t)ids->width;
    struct part_cursor cursor = {0};
    for (int x = 0; x < ids->width;) {
        const uint32_t id = from[x];
        struct shown shown = {0};
        if (id != 0) {
            part_of(outlines->request, id, &cursor);
            shown = show_triangle(outlines, &outlines->samples, &cursor, id);
        }
        const float begin = shown.nearness + shown.change_y * (float)y;
        for (; x < ids->width && from[x] == id; x++) {
            band->parts[row + (size_t)x] = shown.part;
            band->nearness[row + (size_t)x] = begin + shown.change_x * (float)x;
            band->changes_x[row + (size_t)x] = shown.change_x;
            band->changes_y[row + (size_t)x] = shown.change_y;
        }
    }
}

/* Whether pairs of samples fit, the second of which is `step` further and `change` nearer. */
TL_CLONES static void join_pairs(const uint32_t *restrict parts, const float *restrict nearness,
                                 const float *restrict changes, size_t step, int count, float margin,
                                 uint8_t *restrict joined)
{
    for (size_t x = 0; x < (size_t)count; x++)
        joined[x] = fits(parts[x], nearness[x], changes[x], parts[x + step], nearness[x + step], margin);
}

/* Bit 0 of same[1 + x]: samples x and x + 1 of row `i` and of the next one fit one another. Bit 1: so do all
 * three such cells about x. `up`: whether the samples of the two rows fit. */
TL_CLONES static void join_rows(int width, const uint8_t *restrict up, const uint8_t *restrict lower,
                                const uint8_t *restrict upper, uint8_t *restrict same)
{
    same[0] = up[0];
    for (int x = 0; x + 1 < width; x++)
        same[1 + x] = up[x] & up[x + 1] & lower[x] & upper[x];
    same[width] = up[width - 1];
    uint8_t before = 1;
    for (int x = 0; x < width; x++) {
        uint8_t here = same[x];
        same[x] = (uint8_t)(here | (before & here & same[x + 1]) << 1);
        before = here;
    }
    same[width] = (uint8_t)(same[width] | (before & same[width]) << 1);
}

static void fill_band(const struct outlines *outlines, int first_row, int end_row, struct sample_band *band,
                      uint8_t *up)
{
    const int width = outlines->samples.ids->width, height = outlines->samples.ids->height;
    band->first = (int)floor((first_row + 0.5) * outlines->ratio_y - 0.5) - 1;
    band->count = (int)floor((end_row - 0.5) * outlines->ratio_y - 0.5) + 3 - band->first;
    for (int i = 0; i < band->count; i++) {
        const size_t row = (size_t)i * (size_t)width;
        show_row(outlines, within(band->first + i, height), band, i);
        join_pairs(band->parts + row, band->nearness + row, band->changes_x + row, 1, width - 1,
                   outlines->margin, band->across + row);
    }
    for (int i = 0; i + 1 < band->count; i++) {
        const size_t row = (size_t)i * (size_t)width;
        join_pairs(band->parts + row, band->nearness + row, band->changes_y + row, (size_t)width, width,
                   outlines->margin, up);
        join_rows(width, up, band->across + row, band->across + row + width,
                  band->same + (size_t)i * (size_t)(width + 1));
    }
}

/* ---- A pixel ---- */

struct pixel {
    struct shown shown;
    int column, row;        /* of the lower left of its four samples; -1 at the border */
    float share_x, share_y; /* of the right and of the upper ones */
};

/* Index of a sample in the band's arrays. */
TL_INLINE size_t sample_at(const struct outlines *outlines, const struct sample_band *band, int column,
                           int row)
{
    const int width = outlines->samples.ids->width;
    return (size_t)(row - band->first) * (size_t)width + (size_t)within(column, width);
}

TL_INLINE tl_quad light_at(const struct outlines *outlines, int column, int row)
{
    const struct tl_id_buffer *ids = outlines->samples.ids;
    return ((const tl_quad *)outlines->request->light)[(size_t)within(row, ids->height) * (size_t)ids->width +
                                                       (size_t)within(column, ids->width)];
}

/* Whether a sample of the band, (x, y) samples from the pixel, continues its surface. */
TL_INLINE bool suits(const struct outlines *outlines, const struct sample_band *band,
                     const struct pixel *pixel, size_t sample, float x, float y)
{
    const struct shown *shown = &pixel->shown;
    const float change =
        shown->change_x * (x * outlines->pixels_x) + shown->change_y * (y * outlines->pixels_y);
    return fits(shown->part, shown->nearness, change, band->parts[sample], band->nearness[sample],
                outlines->margin);
}

TL_INLINE bool blend_four(const struct outlines *outlines, const struct sample_band *band,
                          const struct pixel *pixel, tl_quad *out)
{
    tl_quad sum = {0, 0, 0, 0};
    float total = 0;
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++) {
            const int column = pixel->column + i, row = pixel->row + j;
            const size_t sample = sample_at(outlines, band, column, row);
            float weight =
                (i ? pixel->share_x : 1 - pixel->share_x) * (j ? pixel->share_y : 1 - pixel->share_y);
            if (suits(outlines, band, pixel, sample, (float)i - pixel->share_x, (float)j - pixel->share_y)) {
                sum += weight * light_at(outlines, column, row);
                total += weight;
            }
        }
    *out = sum / total;
    return total > 0;
}

/* The nearest of 4 x 4 samples that continues the surface, else that shows the same part. */
static bool take_nearest(const struct outlines *outlines, const struct sample_band *band,
                         const struct pixel *pixel, tl_quad *out)
{
    float nearest = INFINITY;
    bool is_found = false;
    for (int j = -1; j <= 2; j++)
        for (int i = -1; i <= 2; i++) {
            const int column = pixel->column + i, row = pixel->row + j;
            const size_t sample = sample_at(outlines, band, column, row);
            float x = (float)i - pixel->share_x, y = (float)j - pixel->share_y;
            float distance = x * x + y * y + (suits(outlines, band, pixel, sample, x, y) ? 0 : 100);
            if (band->parts[sample] != pixel->shown.part || distance >= nearest)
                continue;
            nearest = distance;
            *out = light_at(outlines, column, row);
            is_found = true;
        }
    return is_found;
}

/* The nearest covered sample, as if it were covered altogether. */
static bool take_any(const struct outlines *outlines, const struct pixel *pixel, tl_quad *out)
{
    float nearest = INFINITY;
    for (int j = 1 - REACH; j <= REACH; j++)
        for (int i = 1 - REACH; i <= REACH; i++) {
            float x = (float)i - pixel->share_x, y = (float)j - pixel->share_y;
            const tl_quad light = light_at(outlines, pixel->column + i, pixel->row + j);
            if (x * x + y * y >= nearest || !(light[3] > 0))
                continue;
            nearest = x * x + y * y;
            *out = light / light[3];
        }
    return nearest < INFINITY;
}

static tl_quad correct(const struct outlines *outlines, const struct sample_band *band,
                       const struct pixel *pixel, struct tl_outlines_counts *counts)
{
    tl_quad light = {0, 0, 0, 0};
    if (blend_four(outlines, band, pixel, &light))
        counts->blended++;
    else if (take_nearest(outlines, band, pixel, &light))
        counts->nearest++;
    else if (take_any(outlines, pixel, &light))
        counts->foreign++;
    else
        counts->lost++;
    return light;
}

/* Sets the cover of a pixel where the ground fades. `shown` is that of (0, 0). */
static tl_quad fade(const struct outlines *outlines, const struct shown *shown, int x, int y, tl_quad light)
{
    const struct id_grid *grid = &outlines->pixels;
    const float nearness = shown->nearness + shown->change_x * (float)x + shown->change_y * (float)y;
    const vec3s ray = glms_vec3_add(grid->first, glms_vec3_add(glms_vec3_scale(grid->across, (float)x),
                                                               glms_vec3_scale(grid->up, (float)y)));
    const vec3s eye = outlines->request->view->eye;
    const float cover =
        tl_ground_cover(outlines->request->ground, eye.x + ray.x / nearness, eye.z + ray.z / nearness);
    light *= light[3] > 0 ? cover / light[3] : 0;
    light[3] = cover;
    return light;
}

static struct tl_outlines_counts correct_row(const struct outlines *outlines, const struct sample_band *band,
                                             int y, tl_quad *to)
{
    struct tl_outlines_counts counts = {0};
    const struct tl_id_buffer *ids = outlines->pixels.ids;
    const uint32_t *from = ids->ids + (size_t)y * (size_t)ids->width;
    const double at = (y + 0.5) * outlines->ratio_y - 0.5;
    struct pixel pixel = {.row = (int)floor(at), .share_y = (float)(at - floor(at))};
    const uint8_t *same =
        band->same + (size_t)(pixel.row - band->first) * (size_t)(outlines->samples.ids->width + 1);
    const uint8_t *below = same - (outlines->samples.ids->width + 1);
    const uint8_t *above = same + (outlines->samples.ids->width + 1);
    uint32_t before = 0, part = 0, shown = 0;
    struct part_cursor cursor = {0};
    struct shown first = {0};
    for (int x = 0; x < ids->width; x++) {
        const uint32_t id = from[x];
        if (id == 0) {
            to[x] = (tl_quad){0, 0, 0, 0};
            continue;
        }
        if (id != before) {
            part = part_of(outlines->request, id, &cursor);
            before = id;
        }
        pixel.column = outlines->columns[x];
        const int cell = 1 + pixel.column;
        const bool is_kept = (below[cell] & same[cell] & above[cell] & 2) &&
                             band->parts[sample_at(outlines, band, pixel.column, pixel.row)] == part;
        const bool is_ground = part >= outlines->ground_part;
        counts.kept += is_kept;
        if (is_kept && (!is_ground || to[x][3] == 1))
            continue;
        if (id != shown) {
            first = show_triangle(outlines, &outlines->pixels, &cursor, id);
            shown = id;
        }
        if (!is_kept) {
            pixel.share_x = outlines->shares[x];
            pixel.shown = first;
            pixel.shown.nearness += first.change_x * (float)x + first.change_y * (float)y;
            to[x] = correct(outlines, band, &pixel, &counts);
        }
        if (is_ground)
            to[x] = fade(outlines, &first, x, y, to[x]);
    }
    return counts;
}

/* ---- All pixels ---- */

static void add_counts(struct tl_outlines_counts *sum, const struct tl_outlines_counts *counts)
{
    sum->kept += counts->kept;
    sum->blended += counts->blended;
    sum->nearest += counts->nearest;
    sum->foreign += counts->foreign;
    sum->lost += counts->lost;
}

static struct tl_outlines_counts correct_bands(const struct outlines *outlines, float *image)
{
    struct tl_outlines_counts sum = {0};
    const int width = outlines->pixels.ids->width, height = outlines->pixels.ids->height;
    const size_t columns = (size_t)outlines->samples.ids->width;
    const size_t rows = (size_t)(BAND_ROWS * outlines->ratio_y) + 5;
#pragma omp parallel
    {
        struct tl_outlines_counts counts = {0};
        struct sample_band band = {.parts = tl_alloc(rows * columns, sizeof *band.parts),
                                   .nearness = tl_alloc(rows * columns, sizeof *band.nearness),
                                   .changes_x = tl_alloc(rows * columns, sizeof *band.changes_x),
                                   .changes_y = tl_alloc(rows * columns, sizeof *band.changes_y),
                                   .across = tl_alloc(rows * columns, 1),
                                   .same = tl_alloc(rows * (columns + 1), 1)};
        uint8_t *up = tl_alloc(columns, 1);
#pragma omp for schedule(dynamic)
        for (int begin = 0; begin < height; begin += BAND_ROWS) {
            int end = begin + BAND_ROWS < height ? begin + BAND_ROWS : height;
            fill_band(outlines, begin, end, &band, up);
            for (int y = begin; y < end; y++) {
                const struct tl_outlines_counts of_row =
                    correct_row(outlines, &band, y, (tl_quad *)image + (size_t)y * (size_t)width);
                add_counts(&counts, &of_row);
            }
        }
#pragma omp critical
        add_counts(&sum, &counts);
        free(band.parts);
        free(band.nearness);
        free(band.changes_x);
        free(band.changes_y);
        free(band.across);
        free(band.same);
        free(up);
    }
    return sum;
}

struct tl_outlines_counts tl_outlines_draw(const struct tl_outlines_request *request, float *image)
{
    const struct tl_id_buffer *samples = request->samples, *pixels = request->pixels;
    const size_t width = (size_t)pixels->width;
    int *columns = TL_NEW_ARRAY(int, width);
    float *shares = TL_NEW_ARRAY(float, width);
    struct outlines outlines = {.request = request,
                                .samples = make_grid(samples, request->view),
                                .pixels = make_grid(pixels, request->view),
                                .ratio_x = (double)samples->width / pixels->width,
                                .ratio_y = (double)samples->height / pixels->height,
                                .pixels_x = (float)pixels->width / (float)samples->width,
                                .pixels_y = (float)pixels->height / (float)samples->height,
                                .ground_part = UINT32_MAX,
                                .columns = columns,
                                .shares = shares};
    if (request->ground)
        outlines.ground_part = number_of(tl_shade_part_at(request->materials, &request->ground->surface,
                                                          request->ranges->surface_count - 1, 0));
    outlines.margin =
        SLOPE_MARGIN * fmaxf(glms_vec3_norm(outlines.samples.across), glms_vec3_norm(outlines.samples.up));
    for (size_t x = 0; x < width; x++) {
        double at = ((double)x + 0.5) * outlines.ratio_x - 0.5;
        columns[x] = (int)floor(at);
        shares[x] = (float)(at - floor(at));
    }
    const struct tl_outlines_counts counts = correct_bands(&outlines, image);
    free(columns);
    free(shares);
    return counts;
}
