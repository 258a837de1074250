#include "render/detail/transfer.h"

#include "config/base/memory.h"
#include "render/trace/trace.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define OUTSIDE   1e-3f /* how far UVs may leave the unit square by rounding */
#define UNCOVERED UINT32_MAX

/* The coarse triangle of a texel, and weights of its second and third corner. */
struct texel_place {
    uint32_t triangle;
    float second, third;
};

/* ---- Triangles of texels ---- */

static bool check_uvs(const tl_surface *coarse, tl_error *error)
{
    bool differ = false;
    for (size_t i = 0; coarse->uvs && i < coarse->vertex_count; i++) {
        vec2s uv = coarse->uvs[i];
        differ = differ || uv.x != coarse->uvs[0].x || uv.y != coarse->uvs[0].y;
        if (!(uv.x >= -OUTSIDE && uv.x <= 1 + OUTSIDE && uv.y >= -OUTSIDE && uv.y <= 1 + OUTSIDE))
            return tl_fail(error, TL_INPUT,
                           "%s: texture coordinates leave the unit square: unwrap the mesh into one square",
                           coarse->name);
    }
    return differ ||
           tl_fail(error, TL_INPUT, "%s: has no texture coordinates: unwrap the mesh", coarse->name);
}

static float twice_area(vec2s a, vec2s b, vec2s c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

static int clamped(float value, int maximum)
{
    return (int)fminf(fmaxf(value, 0), (float)maximum);
}

static void cover(const tl_surface *coarse, const struct tl_transfer_params *params, uint32_t triangle,
                  struct texel_place *places, struct tl_transfer *out)
{
    vec2s at[3];
    for (int k = 0; k < 3; k++) {
        vec2s uv = coarse->uvs[coarse->indices[3 * (size_t)triangle + (size_t)k]];
        at[k] = (vec2s){{uv.x * (float)params->width - 0.5f, uv.y * (float)params->height - 0.5f}};
    }
    float area = twice_area(at[0], at[1], at[2]);
    if (!(fabsf(area) > 0))
        return;
    int right = clamped(floorf(fmaxf(fmaxf(at[0].x, at[1].x), at[2].x)), params->width - 1);
    int low = clamped(floorf(fmaxf(fmaxf(at[0].y, at[1].y), at[2].y)), params->height - 1);
    int left = clamped(ceilf(fminf(fminf(at[0].x, at[1].x), at[2].x)), params->width - 1);
    for (int y = clamped(ceilf(fminf(fminf(at[0].y, at[1].y), at[2].y)), params->height - 1); y <= low; y++)
        for (int x = left; x <= right; x++) {
            vec2s texel = {{(float)x, (float)y}};
            float second = twice_area(at[0], texel, at[2]) / area,
                  third = twice_area(at[0], at[1], texel) / area;
            if (second < 0 || third < 0 || second + third > 1)
                continue;
            struct texel_place *place = &places[(size_t)y * (size_t)params->width + (size_t)x];
            bool is_border = second == 0 || third == 0 || second + third == 1;
            if (place->triangle == UNCOVERED) {
                *place = (struct texel_place){triangle, second, third};
                out->covered++;
            } else if (!is_border) {
                out->shared++;
            }
        }
}

/* ---- Hits of rays ---- */

/* The coarse mesh at a texel. */
struct coarse_frame {
    vec3s point, n, t, b;
};

static vec3s mean(const vec3s *values, const uint32_t corners[3], const float weights[3])
{
    vec3s sum = {{0, 0, 0}};
    for (int k = 0; k < 3; k++)
        sum = glms_vec3_add(sum, glms_vec3_scale(values[corners[k]], weights[k]));
    return sum;
}

static struct coarse_frame frame_at(const tl_surface *coarse, const struct texel_place *place)
{
    const uint32_t *corners = coarse->indices + 3 * (size_t)place->triangle;
    const float weights[3] = {1 - place->second - place->third, place->second, place->third};
    struct coarse_frame frame = {.point = mean(coarse->positions, corners, weights),
                                 .n = glms_vec3_normalize(mean(coarse->normals, corners, weights))};
    vec3s tangent = {{0, 0, 0}};
    for (int k = 0; k < 3; k++) {
        const vec4s corner = coarse->tangents[corners[k]];
        tangent =
            glms_vec3_add(tangent, glms_vec3_scale((vec3s){{corner.x, corner.y, corner.z}}, weights[k]));
    }
    tangent = glms_vec3_sub(tangent, glms_vec3_scale(frame.n, glms_vec3_dot(frame.n, tangent)));
    frame.t = glms_vec3_normalize(tangent);
    frame.b =
        glms_vec3_scale(glms_vec3_cross(frame.n, frame.t), coarse->tangents[corners[0]].w < 0 ? -1.0f : 1.0f);
    return frame;
}

static vec3s normal_of_hit(const tl_surface *fine, const struct tl_trace_hit *hit)
{
    const uint32_t *corners = fine->indices + 3 * (size_t)hit->triangle;
    const float weights[3] = {1 - hit->u - hit->v, hit->u, hit->v};
    return glms_vec3_normalize(mean(fine->normals, corners, weights));
}

/* Follows the normal one way; `sign` -1: inwards. */
static bool find(const tl_trace *trace, const tl_surface *fine, const struct coarse_frame *frame,
                 float reach_m, float sign, float *height, vec3s *normal)
{
    vec3s way = glms_vec3_scale(frame->n, sign);
    float behind = tl_trace_offset(trace); /* so that a point on the finer mesh finds it */
    vec3s origin = glms_vec3_sub(frame->point, glms_vec3_scale(way, behind));
    struct tl_trace_hit hit = tl_trace_nearest(trace, origin, way, 0, reach_m + behind);
    if (hit.surface == TL_TRACE_NONE)
        return false;
    *height = sign * (hit.distance_m - behind);
    *normal = normal_of_hit(fine, &hit);
    return glms_vec3_dot(*normal, frame->n) > 0;
}

static bool follow(const tl_trace *trace, const tl_surface *fine, const struct coarse_frame *frame,
                   float reach_m, float *height, vec3s *normal)
{
    float in_m;
    vec3s inner;
    bool is_out = find(trace, fine, frame, reach_m, 1, height, normal);
    if (find(trace, fine, frame, reach_m, -1, &in_m, &inner) && (!is_out || fabsf(in_m) < fabsf(*height))) {
        *height = in_m;
        *normal = inner;
        return true;
    }
    return is_out;
}

/* Fills the texels of the charts; `known` marks them. */
static size_t trace_texels(const tl_trace *trace, const tl_surface *coarse, const tl_surface *fine,
                           const struct tl_transfer_params *params, const struct texel_place *places,
                           bool *known, struct tl_transfer *out)
{
    float *normals = tl_image_floats(&out->normals), *heights = tl_image_floats(&out->heights);
    size_t hits = 0;
#pragma omp parallel for schedule(dynamic, 4) reduction(+ : hits)
    for (int y = 0; y < params->height; y++)
        for (int x = 0; x < params->width; x++) {
            size_t i = (size_t)y * (size_t)params->width + (size_t)x;
            vec3s normal = {{0, 0, 1}};
            if (places[i].triangle == UNCOVERED)
                continue;
            const struct coarse_frame frame = frame_at(coarse, &places[i]);
            known[i] = follow(trace, fine, &frame, params->reach_m, &heights[i], &normal);
            if (!known[i])
                continue;
            hits++;
            normals[3 * i] = glms_vec3_dot(normal, frame.t);
            normals[3 * i + 1] = glms_vec3_dot(normal, frame.b);
            normals[3 * i + 2] = glms_vec3_dot(normal, frame.n);
        }
    return hits;
}

/* ---- Texels without a value ---- */

/* Gives texels beside known ones the mean of these, in one layer. */
static void widen(const struct tl_transfer_params *params, bool *known, bool *next, struct tl_transfer *out)
{
    float *normals = tl_image_floats(&out->normals), *heights = tl_image_floats(&out->heights);
    size_t width = (size_t)params->width, texels = width * (size_t)params->height;
    memcpy(next, known, texels * sizeof *next);
    for (size_t i = 0; i < texels; i++) {
        int x = (int)(i % width), y = (int)(i / width), count = 0;
        float sum[4] = {0};
        for (int k = 0; !known[i] && k < 9; k++) {
            int beside = x + k % 3 - 1, row = y + k / 3 - 1;
            if (beside < 0 || row < 0 || beside >= params->width || row >= params->height)
                continue;
            size_t other = (size_t)row * width + (size_t)beside;
            if (!known[other])
                continue;
            count++;
            sum[3] += heights[other];
            for (int c = 0; c < 3; c++)
                sum[c] += normals[3 * other + (size_t)c];
        }
        if (count == 0)
            continue;
        vec3s normal = glms_vec3_normalize((vec3s){{sum[0], sum[1], sum[2]}});
        memcpy(&normals[3 * i], normal.raw, sizeof normal.raw);
        heights[i] = sum[3] / (float)count;
        next[i] = true;
    }
    memcpy(known, next, texels * sizeof *known);
}

static void flatten(struct tl_transfer *out)
{
    size_t texels = (size_t)out->heights.width * (size_t)out->heights.height;
    for (size_t i = 0; i < texels; i++) {
        memcpy(tl_image_floats(&out->normals) + 3 * i, (float[]){0, 0, 1}, 3 * sizeof(float));
        tl_image_floats(&out->heights)[i] = 0;
    }
}

/* ---- All of it ---- */

static bool bake(const tl_surface *coarse, const tl_surface *fine, const struct tl_transfer_params *params,
                 struct texel_place *places, bool *known, struct tl_transfer *out, tl_error *error)
{
    tl_trace *trace = tl_trace_create(error);
    bool built = trace && tl_trace_update(trace, fine, 1, error);
    size_t hits = built ? trace_texels(trace, coarse, fine, params, places, known, out) : 0;
    tl_trace_destroy(&trace);
    out->missed = out->covered - hits;
    if (built && hits == 0)
        return tl_fail(error, TL_INPUT, "%s: lies nowhere within reach of %s: %zu rays hit nothing",
                       fine->name, coarse->name, out->covered);
    return built;
}

bool tl_transfer_make(const tl_surface *coarse, const tl_surface *fine,
                      const struct tl_transfer_params *params, struct tl_transfer *out, tl_error *error)
{
    size_t texels = (size_t)params->width * (size_t)params->height;
    *out = (struct tl_transfer){0};
    if (!check_uvs(coarse, error) ||
        !tl_memory_request(coarse->name,
                           texels * (sizeof(struct texel_place) + 4 * sizeof(float) + 2 * sizeof(bool)),
                           error))
        return false;
    struct texel_place *places = TL_NEW_ARRAY(struct texel_place, texels);
    bool *known = TL_NEW_ARRAY(bool, texels), *next = TL_NEW_ARRAY(bool, texels);
    out->normals = tl_image_create(params->width, params->height, 3, TL_IMAGE_F32);
    out->heights = tl_image_create(params->width, params->height, 1, TL_IMAGE_F32);
    flatten(out);
    for (size_t i = 0; i < texels; i++) {
        places[i].triangle = UNCOVERED;
        known[i] = false;
    }
    for (size_t i = 0; i < coarse->index_count / 3; i++)
        cover(coarse, params, (uint32_t)i, places, out);
    bool baked = bake(coarse, fine, params, places, known, out, error);
    for (int i = 0; baked && i < TL_TRANSFER_MARGIN; i++)
        widen(params, known, next, out);
    free(places);
    free(known);
    free(next);
    if (!baked)
        tl_transfer_release(out);
    return baked;
}

void tl_transfer_release(struct tl_transfer *transfer)
{
    tl_image_release(&transfer->normals);
    tl_image_release(&transfer->heights);
    *transfer = (struct tl_transfer){0};
}
