#include "render/gbuffer/samples.h"

#include "config/base/memory.h"
#include "config/base/simd.h"

#include <epoxy/gl.h>

#include <math.h>
#include <stdlib.h>

#define TILE 4 /* texels a side: 16 samples, as many as a bundle of rays */
#define BAND                                                                                                 \
    128 /* rows of texels that are read at a time, whole tiles: a copy of all would be as large as the       \
           samples */

/* The G-buffer's textures as GL keeps them: rows of the target from `first_row`, but all of the triangles. */
struct layers {
    int width, height; /* of the target */
    int first_row;
    const float *points;       /* [rows][width][4] */
    const uint16_t *normals;   /* [height][width][4] */
    const uint16_t *diffuses;  /* ... */
    const uint16_t *speculars; /* ... */
    const uint16_t *widenings; /* ..., or NULL */
    const uint32_t *triangles; /* [height][width] */
};

/* Barycentric weights of the point of the triangle's plane that is nearest to `p`, inside the triangle. */
static void weigh(vec3s p, vec3s a, vec3s b, vec3s c, float weights[3])
{
    vec3s ab = glms_vec3_sub(b, a), ac = glms_vec3_sub(c, a), ap = glms_vec3_sub(p, a);
    float d00 = glms_vec3_dot(ab, ab), d01 = glms_vec3_dot(ab, ac), d11 = glms_vec3_dot(ac, ac);
    float d20 = glms_vec3_dot(ap, ab), d21 = glms_vec3_dot(ap, ac);
    float area = d00 * d11 - d01 * d01;
    if (!(area > 0)) { /* a triangle without area is rasterised only by rounding */
        weights[0] = 1, weights[1] = weights[2] = 0;
        return;
    }
    float v = fminf(fmaxf((d11 * d20 - d01 * d21) / area, 0), 1);
    float w = fminf(fmaxf((d00 * d21 - d01 * d20) / area, 0), 1 - v);
    weights[0] = 1 - v - w, weights[1] = v, weights[2] = w;
}

static vec3s normalized_or(vec3s v, vec3s fallback)
{
    float square = glms_vec3_dot(v, v);
    return square > 1e-20f ? glms_vec3_scale(v, 1 / sqrtf(square)) : fallback;
}

/* A finite half float: its bits lie in a float's thirteen further up, and its exponent is 112 less. */
static float from_half(uint16_t half)
{
    const float scale = 0x1p112f;
    union tl_float_bits magnitude = {.bits = (half & 0x7fff) << 13};
    return half & 0x8000 ? -scale * magnitude.value : scale * magnitude.value;
}

static vec3s half_vector(const uint16_t *texel)
{
    return (vec3s){{from_half(texel[0]), from_half(texel[1]), from_half(texel[2])}};
}

/* The normal of the smooth surface, on the side that is seen. The G-buffer's half floats hold it to 0.03
 * degrees only, which a mirror would show. */
static vec3s smooth_normal(const tl_surface *surface, const uint32_t corners[3], const float weights[3],
                           bool back)
{
    vec3s sum = {{0, 0, 0}};
    for (int i = 0; i < 3; i++)
        sum = glms_vec3_add(sum,
                            glms_vec3_scale(surface->normals[corners[i]], back ? -weights[i] : weights[i]));
    return sum;
}

static tl_sample read_sample(const struct layers *layers, size_t texel,
                             const struct tl_triangle_ranges *ranges, vec3s eye)
{
    const size_t in_band = texel - (size_t)layers->first_row * (size_t)layers->width;
    const float *point = layers->points + 4 * in_band;
    const uint16_t *normal = layers->normals + 4 * in_band, *diffuse = layers->diffuses + 4 * in_band,
                   *specular = layers->speculars + 4 * in_band;
    uint32_t stored = layers->triangles[texel];
    tl_sample sample = {.texel = (uint32_t)texel,
                        .triangle = ((stored & ~TL_SAMPLE_BACK) - 1) | (stored & TL_SAMPLE_BACK),
                        .cover = point[3],
                        .point = {{point[0], point[1], point[2]}},
                        .glossiness = 1 - from_half(normal[3]),
                        .diffuse = half_vector(diffuse),
                        .specular = half_vector(specular)};
    for (size_t i = 0; layers->widenings && i < 3; i++)
        sample.widening[i] = from_half(layers->widenings[4 * in_band + i]);
    uint32_t corners[3];
    size_t index;
    const tl_surface *surface = tl_triangle_find(ranges, sample.triangle & ~TL_SAMPLE_BACK, corners, &index);
    weigh(sample.point, surface->positions[corners[0]], surface->positions[corners[1]],
          surface->positions[corners[2]], sample.weights);
    const float rounding = 1e-3f; /* of half floats */
    const vec3s up = {{0, 1, 0}};
    sample.normal = normalized_or(half_vector(normal), up);
    sample.smooth = normalized_or(
        smooth_normal(surface, corners, sample.weights, sample.triangle & TL_SAMPLE_BACK), sample.normal);
    if (glms_vec3_distance(sample.normal, sample.smooth) < rounding)
        sample.normal = sample.smooth;
    vec3s view = normalized_or(glms_vec3_sub(eye, sample.point), sample.normal);
    /* The rule of the light passes: where a normal turns away from the viewer, r passes straight on instead
     * of flipping. */
    float cosine = fmaxf(glms_vec3_dot(sample.normal, view), 0);
    sample.mirror =
        normalized_or(glms_vec3_sub(glms_vec3_scale(sample.normal, 2 * cosine), view), sample.normal);
    return sample;
}

/* Visits the covered texels of one row of tiles; fills `out` when it is there. Returns how many there are. */
static size_t read_tile_row(const struct layers *layers, int row, const struct tl_triangle_ranges *ranges,
                            vec3s eye, tl_sample *out)
{
    size_t count = 0;
    for (int x0 = 0; x0 < layers->width; x0 += TILE)
        for (int y = row * TILE; y < layers->height && y < (row + 1) * TILE; y++)
            for (int x = x0; x < layers->width && x < x0 + TILE; x++) {
                size_t texel = (size_t)y * (size_t)layers->width + (size_t)x;
                if (layers->triangles[texel] == 0)
                    continue;
                if (out)
                    out[count] = read_sample(layers, texel, ranges, eye);
                count++;
            }
    return count;
}

/* Counts the covered texels above each row of tiles and makes room for all of them. */
static size_t *count_rows(const struct layers *layers, int row_count, struct tl_samples *out)
{
    size_t *first = TL_NEW_ARRAY(size_t, (size_t)row_count + 1);
#pragma omp parallel for
    for (int row = 0; row < row_count; row++)
        first[row + 1] = read_tile_row(layers, row, NULL, (vec3s){{0, 0, 0}}, NULL);
    for (int row = 0; row < row_count; row++)
        first[row + 1] += first[row];
    out->count = out->primary_count = first[row_count];
    out->behind_count = out->other_count = 0;
    tl_samples_reserve(out, out->count);
    return first;
}

/* Rows of a layer, into the staging memory from `at` on. */
struct layer_rows {
    int first, count;
    char *at;
};

static const void *read_layer(const struct tl_gbuffer *gbuffer, int layer, GLenum format, GLenum type,
                              size_t texel_bytes, struct layer_rows *rows)
{
    const tl_target *target = &gbuffer->target;
    size_t bytes = (size_t)target->width * (size_t)rows->count * texel_bytes;
    void *data = rows->at;
    glGetTextureSubImage(target->colours[layer].id, 0, 0, rows->first, 0, target->width, rows->count, 1,
                         format, type, (GLsizei)bytes, data);
    rows->at += bytes;
    return data;
}

static void read_band(const struct tl_gbuffer *gbuffer, struct layer_rows rows, struct layers *layers)
{
    const bool faceted = gbuffer->target.colour_count > TL_GBUFFER_WIDENING;
    layers->first_row = rows.first;
    layers->points = read_layer(gbuffer, TL_GBUFFER_POINT, GL_RGBA, GL_FLOAT, 16, &rows);
    layers->normals = read_layer(gbuffer, TL_GBUFFER_NORMAL, GL_RGBA, GL_HALF_FLOAT, 8, &rows);
    layers->diffuses = read_layer(gbuffer, TL_GBUFFER_DIFFUSE, GL_RGBA, GL_HALF_FLOAT, 8, &rows);
    layers->speculars = read_layer(gbuffer, TL_GBUFFER_SPECULAR, GL_RGBA, GL_HALF_FLOAT, 8, &rows);
    layers->widenings =
        faceted ? read_layer(gbuffer, TL_GBUFFER_WIDENING, GL_RGBA, GL_HALF_FLOAT, 8, &rows) : NULL;
}

/* The triangles of the whole target and the other layers of a band. */
static void reserve_staging(const tl_target *target, struct tl_samples *out)
{
    const bool faceted = target->colour_count > TL_GBUFFER_WIDENING;
    const size_t width = (size_t)target->width, height = (size_t)target->height;
    const size_t band = height < BAND ? height : BAND;
    const size_t bytes = width * height * 4 + width * band * (faceted ? 16 + 4 * 8 : 16 + 3 * 8);
    if (bytes == out->staging_bytes)
        return;
    free(out->staging);
    out->staging = tl_alloc(bytes, 1);
    out->staging_bytes = bytes;
}

void tl_samples_read(const struct tl_gbuffer *gbuffer, const struct tl_triangle_ranges *ranges, vec3s eye,
                     struct tl_samples *out)
{
    const tl_target *target = &gbuffer->target;
    out->width = target->width;
    out->height = target->height;
    reserve_staging(target, out);
    struct layer_rows rows = {.count = target->height, .at = out->staging};
    struct layers layers = {.width = target->width, .height = target->height};
    layers.triangles = read_layer(gbuffer, TL_GBUFFER_TRIANGLE, GL_RED_INTEGER, GL_UNSIGNED_INT, 4, &rows);
    const int row_count = (target->height + TILE - 1) / TILE;
    size_t *first = count_rows(&layers, row_count, out);
    for (int top = 0; top < target->height; top += BAND) {
        rows.first = top;
        rows.count = target->height - top < BAND ? target->height - top : BAND;
        read_band(gbuffer, rows, &layers);
#pragma omp parallel for schedule(dynamic)
        for (int row = top / TILE; row < (top + rows.count + TILE - 1) / TILE; row++)
            read_tile_row(&layers, row, ranges, eye, out->items + first[row]);
    }
    free(first);
}
