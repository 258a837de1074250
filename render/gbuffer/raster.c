#include "render/gbuffer/raster.h"

#include "config/base/memory.h"
#include "config/base/simd.h"
#include "render/gbuffer/clip.h"
#include "render/gbuffer/depth_terms.glsl"
#include "render/gbuffer/samples.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Corners are rounded to 1/256 of a pixel. */
#define SUBPIXEL_BITS 8
#define SUBPIXELS     (1 << SUBPIXEL_BITS)

/* Rows of a band: its ids and depths stay in a core's cache. */
#define BAND_ROWS 16
/* Rows whose spans are computed together, and pixels that are filled together. */
#define SPAN_LANES 4
#define FILL_LANES 8
/* Bit of an id while its band is filled: the triangle is open. */
#define OPEN 0x40000000u
/* Triangles of the surfaces that one thread prepares at a time, and vertices. */
#define CHUNK_TRIANGLES 1024
#define CHUNK_VERTICES  2048

/* A vertex in the window. */
struct raster_vertex {
    float x, y, z;       /* pixels from the lower left corner, and depth in 0 .. 1 */
    int32_t column, row; /* from the centre of the first pixel, in subpixels */
    uint32_t outside;    /* planes of the frustum, as tl_clip_outside has them */
};

/* A triangle on the grid of subpixels, its inside to the same side of all edges. */
struct raster_triangle {
    int32_t columns[3], rows[3];
    float depth, depth_x, depth_y; /* at the first pixel's centre, and its change to the next across and up */
    uint32_t id;
    int16_t left, right, bottom, top; /* pixels that its box touches, the last ones included */
};

/* Triangles of one part that are prepared by one thread, and lists of them by band. */
struct raster_chunk {
    const tl_surface *surface;
    const struct raster_vertex *vertices; /* the surface's */
    uint32_t begin, end;                  /* triangles of the surface */
    uint32_t first;                       /* number of the surface's first triangle */
    uint32_t bits;                        /* OPEN, or 0 */
    struct raster_triangle *triangles;
    size_t count, capacity;
    uint32_t *bands; /* [band_count + 1]: where the list of a band begins, and where the last one ends */
    uint32_t *lists; /* triangles of the first band, of the second, ... */
    size_t band_capacity, list_capacity;
};

/* State of a frame. */
struct raster_frame {
    const struct tl_raster_request *request;
    float half_width, half_height;
    int band_count;
};

static struct raster_vertex snapped(float x, float y, float z, uint32_t outside)
{
    /* A corner outside the frustum is clipped before its place counts. One that is not a number makes the
     * triangle's depth NaN, which is nearer than nothing: it is not drawn. */
    bool is_inside = fabsf(x) <= TL_RASTER_SIDE_MAX + 1 && fabsf(y) <= TL_RASTER_SIDE_MAX + 1;
    return (struct raster_vertex){.x = x,
                                  .y = y,
                                  .z = z,
                                  .column = is_inside ? (int32_t)lrintf((x - 0.5f) * SUBPIXELS) : 0,
                                  .row = is_inside ? (int32_t)lrintf((y - 0.5f) * SUBPIXELS) : 0,
                                  .outside = outside};
}

TL_INLINE vec4s into_clip_space(const float (*m)[4], vec3s p)
{
    vec4s clip;
    for (int i = 0; i < 4; i++)
        clip.raw[i] = m[0][i] * p.x + m[1][i] * p.y + m[2][i] * p.z + m[3][i];
    return clip;
}

TL_CLONES static void transform(const struct raster_frame *frame, const vec3s *positions, size_t count,
                                struct raster_vertex *vertices)
{
    const float(*m)[4] = (const float(*)[4])frame->request->view_projection.raw;
    for (size_t i = 0; i < count; i++) {
        vec4s p = into_clip_space(m, positions[i]);
        float inverse = 1 / p.w;
        vertices[i] = snapped(fmaf(p.x * inverse, frame->half_width, frame->half_width),
                              fmaf(p.y * inverse, frame->half_height, frame->half_height),
                              fmaf(p.z * inverse, 0.5f, 0.5f), tl_clip_outside(p.x, p.y, p.z, p.w));
    }
}

static void transform_surfaces(const struct tl_raster *raster, const struct raster_frame *frame)
{
    struct raster_vertex *vertices = raster->vertices;
    for (size_t s = 0; s < frame->request->surface_count; s++) {
        const tl_surface *surface = frame->request->surfaces[s];
#pragma omp parallel for schedule(static)
        for (size_t begin = 0; begin < surface->vertex_count; begin += CHUNK_VERTICES) {
            size_t left = surface->vertex_count - begin;
            transform(frame, surface->positions + begin, left < CHUNK_VERTICES ? left : CHUNK_VERTICES,
                      vertices + begin);
        }
        vertices += surface->vertex_count;
    }
}

/* Depth as a plane over the window, from the corners before they were rounded. */
TL_INLINE void set_depths(const struct raster_vertex *a, const struct raster_vertex *b,
                          const struct raster_vertex *c, struct raster_triangle *out)
{
    float x_ab = a->x - b->x, y_ab = a->y - b->y, z_ab = a->z - b->z;
    float x_ca = c->x - a->x, y_ca = c->y - a->y, z_ca = c->z - a->z;
    float inverse = 1 / (x_ab * y_ca - y_ab * x_ca);
    out->depth_x = z_ab * (y_ca * inverse) - z_ca * (y_ab * inverse);
    out->depth_y = z_ca * (x_ab * inverse) - z_ab * (x_ca * inverse);
    out->depth = a->z - (out->depth_x * (a->x - 0.5f) + out->depth_y * (a->y - 0.5f));
}

TL_INLINE int32_t minimum(const int32_t v[3])
{
    int32_t ab = v[0] < v[1] ? v[0] : v[1];
    return ab < v[2] ? ab : v[2];
}

TL_INLINE int32_t maximum(const int32_t v[3])
{
    int32_t ab = v[0] > v[1] ? v[0] : v[1];
    return ab > v[2] ? ab : v[2];
}

/* Pixels whose centres lie between two places. False when there is none. */
TL_INLINE bool pixels_between(int32_t low, int32_t high, int size, int16_t *first, int16_t *last)
{
    int32_t from = (low + SUBPIXELS - 1) >> SUBPIXEL_BITS, to = high >> SUBPIXEL_BITS;
    *first = (int16_t)(from > 0 ? from : 0);
    *last = (int16_t)(to < size - 1 ? to : size - 1);
    return *first <= *last;
}

/* Adds a triangle unless it covers no pixel's centre. A front is turned over, so that every triangle's inside
 * lies to the same side of its edges. */
TL_INLINE void add_triangle(const struct raster_frame *frame, struct raster_chunk *chunk,
                            const struct raster_vertex *a, const struct raster_vertex *b,
                            const struct raster_vertex *c, uint32_t number)
{
    int64_t area = (int64_t)(b->column - a->column) * (c->row - a->row) -
                   (int64_t)(c->column - a->column) * (b->row - a->row);
    if (area == 0)
        return;
    bool is_front = area > 0;
    if (is_front) {
        const struct raster_vertex *other = a;
        a = b;
        b = other;
    }
    struct raster_triangle *out = &chunk->triangles[chunk->count];
    *out = (struct raster_triangle){.columns = {a->column, b->column, c->column},
                                    .rows = {a->row, b->row, c->row},
                                    .id = (number + 1) | (is_front ? 0 : TL_SAMPLE_BACK)};
    if (!pixels_between(minimum(out->columns), maximum(out->columns), frame->request->width, &out->left,
                        &out->right) ||
        !pixels_between(minimum(out->rows), maximum(out->rows), frame->request->height, &out->bottom,
                        &out->top))
        return;
    set_depths(a, b, c, out);
    chunk->count++;
}

static struct raster_vertex project(const struct raster_frame *frame, vec4s p)
{
    float inverse = 1 / p.w;
    return snapped(p.x * inverse * frame->half_width + frame->half_width,
                   p.y * inverse * frame->half_height + frame->half_height, p.z * inverse * 0.5f + 0.5f, 0);
}

/* Adds what a triangle leaves within the frustum, as a fan about the polygon's first corner. */
static void add_clipped(const struct raster_frame *frame, struct raster_chunk *chunk,
                        const uint32_t indices[3], unsigned planes, uint32_t number)
{
    const float(*m)[4] = (const float(*)[4])frame->request->view_projection.raw;
    struct tl_clip_corner corners[TL_CLIP_CORNERS_MAX];
    struct raster_vertex placed[TL_CLIP_CORNERS_MAX];
    for (int i = 0; i < 3; i++)
        corners[i] = (struct tl_clip_corner){.at = into_clip_space(m, chunk->surface->positions[indices[i]]),
                                             .source = i};
    int count = tl_clip_triangle(corners, planes);
    for (int i = 0; i < count; i++)
        placed[i] = corners[i].source >= 0 ? chunk->vertices[indices[corners[i].source]]
                                           : project(frame, corners[i].at);
    for (int i = 2; i < count; i++)
        add_triangle(frame, chunk, &placed[i - 1], &placed[i], &placed[0], number);
}

static void reserve_triangles(struct raster_chunk *chunk, size_t more)
{
    if (chunk->count + more <= chunk->capacity)
        return;
    chunk->capacity = 2 * (chunk->count + more);
    chunk->triangles = tl_resize(chunk->triangles, chunk->capacity, sizeof *chunk->triangles);
}

TL_CLONES static void prepare_triangles(const struct raster_frame *frame, struct raster_chunk *chunk)
{
    chunk->count = 0;
    for (uint32_t t = chunk->begin; t < chunk->end; t++) {
        const uint32_t *indices = chunk->surface->indices + 3 * (size_t)t;
        const struct raster_vertex *a = &chunk->vertices[indices[0]], *b = &chunk->vertices[indices[1]],
                                   *c = &chunk->vertices[indices[2]];
        if (a->outside & b->outside & c->outside)
            continue;
        reserve_triangles(chunk, TL_CLIP_CORNERS_MAX);
        unsigned planes = a->outside | b->outside | c->outside;
        if (planes)
            add_clipped(frame, chunk, indices, planes, (chunk->first + t) | chunk->bits);
        else
            add_triangle(frame, chunk, a, b, c, (chunk->first + t) | chunk->bits);
    }
}

static int first_band(const struct raster_triangle *triangle)
{
    return triangle->bottom / BAND_ROWS;
}

static int last_band(const struct raster_triangle *triangle)
{
    return triangle->top / BAND_ROWS;
}

/* Lists the triangles by band, in order: a sort by counting. */
static void sort_into_bands(const struct raster_frame *frame, struct raster_chunk *chunk)
{
    size_t bands = (size_t)frame->band_count;
    if (bands + 1 > chunk->band_capacity) {
        chunk->band_capacity = bands + 1;
        chunk->bands = tl_resize(chunk->bands, chunk->band_capacity, sizeof *chunk->bands);
    }
    memset(chunk->bands, 0, (bands + 1) * sizeof *chunk->bands);
    for (size_t i = 0; i < chunk->count; i++)
        for (int b = first_band(&chunk->triangles[i]); b <= last_band(&chunk->triangles[i]); b++)
            chunk->bands[b]++;
    for (size_t b = 0; b < bands; b++)
        chunk->bands[b + 1] += chunk->bands[b]; /* each list's end */
    if (chunk->bands[bands] > chunk->list_capacity) {
        chunk->list_capacity = chunk->bands[bands];
        chunk->lists = tl_resize(chunk->lists, chunk->list_capacity, sizeof *chunk->lists);
    }
    for (size_t i = chunk->count; i-- > 0;) /* from the ends back to the beginnings */
        for (int b = first_band(&chunk->triangles[i]); b <= last_band(&chunk->triangles[i]); b++)
            chunk->lists[--chunk->bands[b]] = (uint32_t)i;
}

static void prepare_chunks(const struct tl_raster *raster, const struct raster_frame *frame)
{
#pragma omp parallel for schedule(dynamic, 1)
    for (size_t i = 0; i < raster->chunk_count; i++) {
        prepare_triangles(frame, &raster->chunks[i]);
        sort_into_bands(frame, &raster->chunks[i]);
    }
}

/* A band while it is filled. Rows are longer than the picture's, so that spans are filled by whole lanes. */
struct raster_band {
    int first, last; /* rows of the picture */
    int begin, end;  /* columns that are looked at */
    size_t stride;
    float *depths; /* [BAND_ROWS][stride] */
    uint32_t *ids; /* the same */
    float *passed; /* the same: only what is deeper is drawn; where this is 1 nothing is */
};

/* The part of each row that a triangle covers: first pixel and the one after the last. */
struct raster_spans {
    double begin[BAND_ROWS], end[BAND_ROWS];
};

/* An edge's function is positive inside: value + across * column + up * row. All numbers are whole and below
 * 2^53, and the division rounds no quotient to a whole number that it is not: its distance from one is at
 * least 1 / across, 2^-30. A centre on an edge belongs to the triangle on its right, or above it. */
TL_INLINE void cut_spans(const struct raster_triangle *triangle, int edge, int first_row, int count,
                         struct raster_spans *spans)
{
    int next = edge == 2 ? 0 : edge + 1;
    int64_t x = triangle->columns[edge], y = triangle->rows[edge];
    int64_t across = y - triangle->rows[next], up = x - triangle->columns[next];
    bool is_owner = across < 0 || (across == 0 && up > 0);
    double rise = (double)(up * SUBPIXELS), step = (double)(across * SUBPIXELS);
    double value = (double)(across * x - up * y + (is_owner ? 1 : 0)) + rise * (double)first_row;
    if (across > 0)
        for (int from = 0; from < count; from += SPAN_LANES)
#pragma omp simd
            for (int k = 0; k < SPAN_LANES; k++) {
                double end = ceil((value + rise * (double)(from + k)) / step);
                spans->end[from + k] = end < spans->end[from + k] ? end : spans->end[from + k];
            }
    else if (across < 0)
        for (int from = 0; from < count; from += SPAN_LANES)
#pragma omp simd
            for (int k = 0; k < SPAN_LANES; k++) {
                double begin = floor((value + rise * (double)(from + k)) / step) + 1;
                spans->begin[from + k] = begin > spans->begin[from + k] ? begin : spans->begin[from + k];
            }
    else
        for (int k = 0; k < count; k++)
            if (!(value + rise * (double)k > 0))
                spans->end[k] = spans->begin[k];
}

/* `passed`: NULL in the nearest layer. */
TL_INLINE void fill_span(const struct raster_triangle *triangle, int row, int begin, int end,
                         float *restrict depths, uint32_t *restrict ids, const float *restrict passed)
{
    const float y = (float)row, start = triangle->depth, across = triangle->depth_x, up = triangle->depth_y;
    const uint32_t id = triangle->id;
    const float back = id & TL_SAMPLE_BACK ? DEPTH_OF_BACKS : 0;
    for (int from = begin; from < end; from += FILL_LANES)
#pragma omp simd
        for (int k = 0; k < FILL_LANES; k++) {
            int x = from + k;
            float depth = fmaf(up, y, fmaf(across, (float)x, start)) + back;
            bool is_nearer = (x < end) & (depth < depths[x]);
            if (passed)
                is_nearer &= depth > passed[x];
            depths[x] = is_nearer ? depth : depths[x];
            ids[x] = is_nearer ? id : ids[x];
        }
}

TL_INLINE void fill_triangle(const struct raster_triangle *triangle, const struct raster_band *band,
                             const float *passed)
{
    if (triangle->left >= band->end || triangle->right < band->begin)
        return;
    int from = triangle->bottom > band->first ? triangle->bottom : band->first;
    int count = (triangle->top < band->last ? triangle->top : band->last) - from + 1;
    struct raster_spans spans;
    for (int k = 0; k < BAND_ROWS; k++) {
        spans.begin[k] = triangle->left;
        spans.end[k] = triangle->right + 1;
    }
    for (int edge = 0; edge < 3; edge++)
        cut_spans(triangle, edge, from, count, &spans);
    for (int k = 0; k < count; k++) {
        size_t row = (size_t)(from + k - band->first) * band->stride;
        if (spans.begin[k] < spans.end[k])
            fill_span(triangle, from + k, (int)spans.begin[k], (int)spans.end[k], band->depths + row,
                      band->ids + row, passed ? passed + row : NULL);
    }
}

TL_INLINE void fill_triangles(const struct tl_raster *raster, int number, const struct raster_band *band,
                              const float *passed)
{
    for (size_t i = 0; i < BAND_ROWS * band->stride; i++) {
        band->depths[i] = 1;
        band->ids[i] = 0;
    }
    for (size_t c = 0; c < raster->chunk_count; c++) {
        const struct raster_chunk *chunk = &raster->chunks[c];
        for (uint32_t i = chunk->bands[number]; i < chunk->bands[number + 1]; i++)
            fill_triangle(&chunk->triangles[chunk->lists[i]], band, passed);
    }
}

TL_CLONES static void fill_nearest(const struct tl_raster *raster, int number, const struct raster_band *band)
{
    fill_triangles(raster, number, band, NULL);
}

TL_CLONES static void fill_behind(const struct tl_raster *raster, int number, const struct raster_band *band)
{
    fill_triangles(raster, number, band, band->passed);
}

/* Prepares for what lies behind the open triangles of the band. Returns whether there are some. */
static bool pass_open(struct raster_band *band, int width)
{
    int begin = width, end = 0;
    for (int y = 0; y <= band->last - band->first; y++) {
        const size_t row = (size_t)y * band->stride;
        for (int x = 0; x < width; x++) {
            bool is_open = band->ids[row + (size_t)x] & OPEN;
            band->passed[row + (size_t)x] = is_open ? band->depths[row + (size_t)x] + DEPTH_ROUNDING : 1;
            begin = is_open && x < begin ? x : begin;
            end = is_open && x >= end ? x + 1 : end;
        }
    }
    band->begin = begin;
    band->end = end;
    return begin < end;
}

/* Copies a band's row without the bit that only the band has. Returns whether something is there. */
TL_CLONES static bool copy_row(const uint32_t *restrict from, int width, uint32_t *restrict to)
{
    uint32_t any = 0;
    for (int x = 0; x < width; x++) {
        to[x] = from[x] & ~OPEN;
        any |= from[x];
    }
    return any;
}

static void copy_behind(const struct raster_band *band, int width, int layer,
                        const struct tl_raster_layers *to)
{
    for (int y = band->first; y <= band->last; y++)
        if (copy_row(band->ids + (size_t)(y - band->first) * band->stride, width,
                     to->behind[layer] + (size_t)y * (size_t)width))
            to->depths[y] = (uint8_t)(layer + 1);
}

static void clear_behind(const struct raster_band *band, int width, const struct tl_raster_layers *to)
{
    for (int y = band->first; y <= band->last; y++) {
        for (int layer = 0; layer < to->depths[y]; layer++)
            memset(to->behind[layer] + (size_t)y * (size_t)width, 0, (size_t)width * sizeof(uint32_t));
        to->depths[y] = 0;
    }
}

static void fill_layers(const struct tl_raster *raster, const struct raster_frame *frame, int number,
                        struct raster_band *band, const struct tl_raster_layers *to)
{
    const int width = frame->request->width;
    band->begin = 0;
    band->end = width;
    fill_nearest(raster, number, band);
    for (int y = band->first; y <= band->last; y++)
        copy_row(band->ids + (size_t)(y - band->first) * band->stride, width,
                 to->nearest + (size_t)y * (size_t)width);
    if (!frame->request->is_layered)
        return;
    clear_behind(band, width, to);
    for (int layer = 0; layer < TL_TRANSPARENCY_LAYERS && pass_open(band, width); layer++) {
        fill_behind(raster, number, band);
        copy_behind(band, width, layer, to);
    }
}

static void fill_bands(const struct tl_raster *raster, const struct raster_frame *frame,
                       const struct tl_raster_layers *layers)
{
    const int height = frame->request->height;
#pragma omp parallel
    {
        struct raster_band band = {.stride = (size_t)(frame->request->width + FILL_LANES)};
        const size_t size = BAND_ROWS * band.stride;
        band.depths = tl_alloc_lines(size, sizeof *band.depths);
        band.ids = tl_alloc_lines(size, sizeof *band.ids);
        if (frame->request->is_layered) {
            band.passed = tl_alloc_lines(size, sizeof *band.passed);
            memset(band.passed, 0, size * sizeof *band.passed); /* beyond the picture, where spans end */
        }
#pragma omp for schedule(dynamic, 1)
        for (int i = 0; i < frame->band_count; i++) {
            band.first = i * BAND_ROWS;
            band.last = band.first + BAND_ROWS < height ? band.first + BAND_ROWS - 1 : height - 1;
            fill_layers(raster, frame, i, &band, layers);
        }
        free(band.depths);
        free(band.ids);
        free(band.passed);
    }
}

static void reserve(struct tl_raster *raster, const struct tl_raster_request *request)
{
    size_t vertices = 0, chunks = 0;
    for (size_t s = 0; s < request->surface_count; s++) {
        vertices += request->surfaces[s]->vertex_count;
        for (size_t p = 0; p < request->surfaces[s]->part_count; p++)
            chunks += 1 + request->surfaces[s]->parts[p].index_count / (3 * CHUNK_TRIANGLES);
    }
    if (vertices > raster->vertex_capacity) {
        raster->vertex_capacity = vertices;
        raster->vertices = tl_resize(raster->vertices, vertices, sizeof *raster->vertices);
    }
    if (chunks > raster->chunk_capacity) {
        raster->chunks = tl_resize(raster->chunks, chunks, sizeof *raster->chunks);
        memset(raster->chunks + raster->chunk_capacity, 0,
               (chunks - raster->chunk_capacity) * sizeof *raster->chunks);
        raster->chunk_capacity = chunks;
    }
}

/* Cuts the parts into chunks, in the order in which they are drawn. */
static void cut_into_chunks(struct tl_raster *raster, const struct tl_raster_request *request)
{
    const struct raster_vertex *vertices = raster->vertices;
    uint32_t number = 0;
    raster->chunk_count = 0;
    for (size_t s = 0; s < request->surface_count; s++) {
        const tl_surface *surface = request->surfaces[s];
        for (size_t p = 0; p < surface->part_count; p++) {
            uint32_t end = (surface->parts[p].first_index + surface->parts[p].index_count) / 3;
            for (uint32_t t = surface->parts[p].first_index / 3; t < end; t += CHUNK_TRIANGLES) {
                struct raster_chunk *chunk = &raster->chunks[raster->chunk_count++];
                chunk->surface = surface;
                chunk->vertices = vertices;
                chunk->begin = t;
                chunk->end = end - t < CHUNK_TRIANGLES ? end : t + CHUNK_TRIANGLES;
                chunk->first = number;
                chunk->bits =
                    request->is_layered && surface->materials[surface->parts[p].material].openness > 0 ? OPEN
                                                                                                       : 0;
            }
        }
        vertices += surface->vertex_count;
        number += (uint32_t)(surface->index_count / 3);
    }
}

void tl_raster_draw(struct tl_raster *raster, const struct tl_raster_request *request,
                    const struct tl_raster_layers *layers)
{
    const struct raster_frame frame = {.request = request,
                                       .half_width = 0.5f * (float)request->width,
                                       .half_height = 0.5f * (float)request->height,
                                       .band_count = (request->height + BAND_ROWS - 1) / BAND_ROWS};
    reserve(raster, request);
    cut_into_chunks(raster, request);
    transform_surfaces(raster, &frame);
    prepare_chunks(raster, &frame);
    fill_bands(raster, &frame, layers);
}

void tl_raster_release(struct tl_raster *raster)
{
    for (size_t i = 0; i < raster->chunk_capacity; i++) {
        free(raster->chunks[i].triangles);
        free(raster->chunks[i].bands);
        free(raster->chunks[i].lists);
    }
    free(raster->chunks);
    free(raster->vertices);
    *raster = (struct tl_raster){0};
}

size_t tl_raster_bytes(const struct tl_raster *raster)
{
    size_t bytes =
        raster->vertex_capacity * sizeof *raster->vertices + raster->chunk_capacity * sizeof *raster->chunks;
    for (size_t i = 0; i < raster->chunk_capacity; i++) {
        const struct raster_chunk *chunk = &raster->chunks[i];
        bytes += chunk->capacity * sizeof *chunk->triangles + chunk->band_capacity * sizeof *chunk->bands +
                 chunk->list_capacity * sizeof *chunk->lists;
    }
    return bytes;
}
