#include "render/detail/bake.h"

#include "render/detail/bumps.h"
#include "render/detail/detail_terms.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static float value_of(const tl_image *image, size_t texel, int channel)
{
    size_t index = texel * (size_t)image->channels + (size_t)channel;
    return image->type == TL_IMAGE_F32 ? tl_image_floats(image)[index]
                                       : (float)tl_image_bytes(image)[index] / 255;
}

static size_t texel_count(const tl_image *image)
{
    return (size_t)image->width * (size_t)image->height;
}

tl_image tl_bake_heights(const tl_image *picture, float base_m, float scale_m)
{
    tl_image heights = tl_image_create(picture->width, picture->height, 1, TL_IMAGE_F32);
    for (size_t i = 0; i < texel_count(picture); i++)
        tl_image_floats(&heights)[i] = base_m + scale_m * value_of(picture, i, 0);
    return heights;
}

tl_image tl_bake_smaller(const tl_image *heights, int width, int height)
{
    tl_image small = tl_image_create(width, height, 1, TL_IMAGE_F32);
    for (int i = 0; i < width * height; i++) {
        int left = (int)((int64_t)(i % width) * heights->width / width),
            top = (int)((int64_t)(i / width) * heights->height / height);
        int right = (int)((int64_t)(i % width + 1) * heights->width / width),
            bottom = (int)((int64_t)(i / width + 1) * heights->height / height);
        double sum = 0;
        for (int y = top; y < bottom; y++)
            for (int x = left; x < right; x++)
                sum += (double)tl_image_floats(heights)[(size_t)y * (size_t)heights->width + (size_t)x];
        tl_image_floats(&small)[i] = (float)(sum / ((double)(right - left) * (bottom - top)));
    }
    return small;
}

/* The neighbouring texels along one axis and their distance in texels. */
struct neighbours {
    int before, after, distance;
};

static struct neighbours neighbours_of(int at, int size, bool clamp)
{
    int before = at > 0 ? at - 1 : clamp ? 0 : size - 1, after = at + 1 < size ? at + 1 : clamp ? at : 0;
    return (struct neighbours){before, after, clamp ? after - before : 2};
}

/* Change of height per repeat, by central differences. */
static float difference(const float *row_before, const float *row_after, int before, int after, int size,
                        int distance)
{
    return distance ? (row_after[after] - row_before[before]) * (float)size / (float)distance : 0;
}

tl_image tl_bake_slopes(const struct tl_height_field *field)
{
    int width = field->heights->width, height = field->heights->height;
    const float *to = field->repeats_per_m;
    tl_image slopes = tl_image_create(width, height, 2, TL_IMAGE_F32);
#pragma omp parallel for
    for (int row = 0; row < height; row++) {
        const float *texels = tl_image_floats(field->heights);
        struct neighbours v = neighbours_of(row, height, field->clamp_v);
        const float *here = texels + (size_t)row * (size_t)width,
                    *above = texels + (size_t)v.before * (size_t)width,
                    *below = texels + (size_t)v.after * (size_t)width;
        float *out = tl_image_floats(&slopes) + 2 * (size_t)row * (size_t)width;
        for (int column = 0; column < width; column++) {
            struct neighbours u = neighbours_of(column, width, field->clamp_u);
            float along_u = difference(here, here, u.before, u.after, width, u.distance);
            float along_v = difference(above, below, column, column, height, v.distance);
            out[2 * (size_t)column] = to[0] * along_u + to[2] * along_v;
            out[2 * (size_t)column + 1] = to[1] * along_u + to[3] * along_v;
        }
    }
    return slopes;
}

tl_image tl_bake_normals(const tl_image *slopes, float k)
{
    tl_image normals = tl_image_create(slopes->width, slopes->height, 3, TL_IMAGE_F32);
    for (size_t i = 0; i < texel_count(slopes); i++) {
        const float *slope = tl_image_floats(slopes) + 2 * i;
        float x = -k * slope[0], y = -k * slope[1], length = sqrtf(1 + x * x + y * y);
        const float normal[3] = {x / length, y / length, 1 / length};
        memcpy(tl_image_floats(&normals) + 3 * i, normal, sizeof normal);
    }
    return normals;
}

tl_image tl_bake_encoded(const tl_image *normals)
{
    tl_image bytes = tl_image_create(normals->width, normals->height, 3, TL_IMAGE_U8);
    bytes.linear = true;
    for (size_t i = 0; i < 3 * texel_count(normals); i++)
        tl_image_bytes(&bytes)[i] = (uint8_t)lrintf(255 * (0.5f + 0.5f * tl_image_floats(normals)[i]));
    return bytes;
}

/* ---- Horizons ---- */

/* The distance (m) along (x, y) that corresponds to half a texel, and the number of such steps within the
 * reach of shadows. */
static float half_texel(const struct tl_height_field *field, float x, float y, int *count)
{
    vec2s moved = tl_field_moved(field, (vec2s){{0, 0}}, x, y);
    float texels =
        fmaxf(fabsf(moved.x) * (float)field->heights->width, fabsf(moved.y) * (float)field->heights->height);
    if (!(texels > 0))
        return INFINITY;
    *count = (int)(DETAIL_REACH / glms_vec2_norm(moved) * 2 * texels);
    return 0.5f / texels;
}

/* The largest slope from a height at uv to the field along (x, y). The search stops where even the highest
 * point could not exceed the slope found so far. */
static float horizon_slope(const struct tl_height_field *field, vec2s uv, float from_m, float x, float y)
{
    int count = 0;
    float step = half_texel(field, x, y, &count), slope = 0;
    for (int i = 1; i <= count; i++) {
        float distance = step * (float)i;
        if ((field->high_m - from_m) <= slope * distance)
            break;
        vec2s there = tl_field_moved(field, uv, x * distance, y * distance);
        if (tl_field_is_outside(field, there))
            break;
        slope = fmaxf(slope, (tl_field_height(field, there) - from_m) / distance);
        if (field->high_m == field->low_m)
            break;
    }
    return slope;
}

static void bake_horizons_at(const struct tl_height_field *field, struct tl_horizon_maps *maps, int column,
                             int row)
{
    int width = field->heights->width, height = field->heights->height;
    size_t texel = (size_t)row * (size_t)width + (size_t)column;
    vec2s uv = {{((float)column + 0.5f) / (float)width, ((float)row + 0.5f) / (float)height}};
    float raised = tl_image_floats(field->heights)[texel], from = field->turned_over ? -raised : raised;
    for (int k = 0; k < maps->angle_count; k++) {
        float angle = (float)k * (2 * (float)M_PI / (float)maps->angle_count);
        float slope = horizon_slope(field, uv, from, cosf(angle), sinf(angle));
        float sine = slope / sqrtf(1 + slope * slope);
        tl_image_bytes(&maps->images[k / 4])[4 * texel + (size_t)(k % 4)] = (uint8_t)lrintf(255 * sine);
    }
}

struct tl_horizon_maps tl_bake_horizons(const struct tl_height_field *field, int angle_count)
{
    struct tl_horizon_maps maps = {.angle_count = angle_count};
    assert(angle_count % 4 == 0 && angle_count <= TL_HORIZON_ANGLES_MAX);
    for (int i = 0; i < angle_count / 4; i++) {
        maps.images[i] = tl_image_create(field->heights->width, field->heights->height, 4, TL_IMAGE_U8);
        maps.images[i].linear = true;
    }
#pragma omp parallel for schedule(dynamic)
    for (int row = 0; row < field->heights->height; row++)
        for (int column = 0; column < field->heights->width; column++)
            bake_horizons_at(field, &maps, column, row);
    return maps;
}

void tl_horizon_maps_release(struct tl_horizon_maps *maps)
{
    for (int i = 0; i < maps->angle_count / 4; i++)
        tl_image_release(&maps->images[i]);
}

/* ---- The spread of normals ---- */

#define STEEPEST 16.0f

/* The normal of a texel, renormalised, because bytes are rounded and a length below 1 would count as spread;
 * `offset`: as (-h_u, -h_v, 1). +Z where the texel has no direction. */
static vec3s normal_of(const tl_image *normals, size_t texel, bool offset)
{
    float n[3];
    for (int c = 0; c < 3; c++)
        n[c] =
            normals->type == TL_IMAGE_F32 ? value_of(normals, texel, c) : 2 * value_of(normals, texel, c) - 1;
    float square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    float scale = square > 1e-12f && isfinite(square) ? 1 / sqrtf(square) : 0;
    if (offset)
        scale /= fmaxf(scale * n[2], 1 / STEEPEST);
    return scale > 0 ? (vec3s){{scale * n[0], scale * n[1], scale * n[2]}} : (vec3s){{0, 0, 1}};
}

tl_image tl_bake_moments(const tl_image *normals, bool offsets)
{
    tl_image moments = tl_image_create(normals->width, normals->height, 4, TL_IMAGE_F32);
    assert(normals->channels >= 3);
    for (size_t i = 0; i < texel_count(normals); i++) {
        vec3s n = normal_of(normals, i, offsets);
        const float texel[4] = {n.x, n.y, n.x * n.x, n.y * n.y};
        memcpy(tl_image_floats(&moments) + 4 * i, texel, sizeof texel);
    }
    return moments;
}

tl_image tl_bake_cross_moments(const tl_image *normals, bool offsets)
{
    tl_image moments = tl_image_create(normals->width, normals->height, 1, TL_IMAGE_F32);
    assert(normals->channels >= 3);
    for (size_t i = 0; i < texel_count(normals); i++) {
        vec3s n = normal_of(normals, i, offsets);
        tl_image_floats(&moments)[i] = n.x * n.y;
    }
    return moments;
}

static float mean_z(vec4s moments)
{
    return sqrtf(fmaxf(1 - moments.z - moments.w, 0));
}

float tl_moments_length(vec4s moments)
{
    float z = mean_z(moments);
    return fminf(sqrtf(moments.x * moments.x + moments.y * moments.y + z * z), 1);
}

static float window_gloss(const tl_image *moments, float glossiness, int window, int column, int row)
{
    vec4s sum = {{0, 0, 0, 0}};
    for (int i = 0; i < window * window; i++) {
        int x = (column + i % window - window / 2 + moments->width * window) % moments->width;
        int y = (row + i / window - window / 2 + moments->height * window) % moments->height;
        const float *texel = tl_image_floats(moments) + 4 * ((size_t)y * (size_t)moments->width + (size_t)x);
        sum = glms_vec4_add(sum, (vec4s){{texel[0], texel[1], texel[2], texel[3]}});
    }
    vec4s mean = glms_vec4_scale(sum, 1 / (float)(window * window));
    float variance = detail_variance(tl_moments_length(mean));
    return 1 - detail_widened(1 - glossiness, variance, variance, 1);
}

tl_image tl_bake_gloss(const tl_image *moments, float glossiness, int window)
{
    tl_image gloss = tl_image_create(moments->width, moments->height, 1, TL_IMAGE_U8);
    gloss.linear = true;
#pragma omp parallel for
    for (int row = 0; row < moments->height; row++)
        for (int column = 0; column < moments->width; column++) {
            float factor =
                glossiness > 0 ? window_gloss(moments, glossiness, window, column, row) / glossiness : 1;
            tl_image_bytes(&gloss)[(size_t)row * (size_t)moments->width + (size_t)column] =
                (uint8_t)lrintf(255 * factor);
        }
    return gloss;
}

size_t tl_image_size_bytes(const tl_image *image)
{
    size_t size = image->type == TL_IMAGE_U8 ? sizeof(uint8_t) : sizeof(float);
    return texel_count(image) * (size_t)image->channels * size;
}
