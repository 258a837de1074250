#include "render/gbuffer/cull.h"

#include "config/base/memory.h"
#include "config/base/simd.h"
#include "render/gbuffer/depth_terms.glsl"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Depths may differ from the plane's by sixteen roundings of a float, and those of backs by their step.
 * Rounding of places for every sample that the picture is wide. */
#define DEPTH_MARGIN   (1e-6f + DEPTH_OF_BACKS)
#define PLACE_ROUNDING (16 * FLT_EPSILON)

/* Positions farther out than this, in sizes of the picture, are rounded too coarsely for a bound. */
#define FARTHEST 4

/* Triangles that span more samples than this one way cover one; where only that is asked they are kept. */
#define SPAN_TRIED 3

struct raster {
    const struct tl_cull_request *request;
    float margin; /* samples: how far the rasteriser may see a corner from where it is */
    float *depths;
};

/* A triangle that lies before the eye, and the samples that its box touches. */
struct facet {
    struct tl_cull_place corners[3];
    float side; /* of its edges that its inside is on: 1 or -1 */
    int first_x, last_x, first_y, last_y;
    float slope_x, slope_y; /* of its depth, a sample */
};

TL_CLONES static void place_vertices(const tl_surface *surface, const struct tl_cull_request *request,
                                     struct tl_cull_place *places)
{
    const float(*m)[4] = (const float(*)[4])request->view_projection.raw;
    const float width = (float)request->width, height = (float)request->height;
    for (size_t i = 0; i < surface->vertex_count; i++) {
        const vec3s p = surface->positions[i];
        float x = m[0][0] * p.x + m[1][0] * p.y + m[2][0] * p.z + m[3][0];
        float y = m[0][1] * p.x + m[1][1] * p.y + m[2][1] * p.z + m[3][1];
        float z = m[0][2] * p.x + m[1][2] * p.y + m[2][2] * p.z + m[3][2];
        float w = m[0][3] * p.x + m[1][3] * p.y + m[2][3] * p.z + m[3][3];
        places[i] = (struct tl_cull_place){.x = (0.5f + 0.5f * x / w) * width,
                                           .y = (0.5f + 0.5f * y / w) * height,
                                           .z = 0.5f + 0.5f * z / w,
                                           .ahead = w > 0};
    }
}

TL_INLINE float min3(float a, float b, float c)
{
    return tl_minf(tl_minf(a, b), c);
}

TL_INLINE float max3(float a, float b, float c)
{
    return tl_maxf(tl_maxf(a, b), c);
}

/* Samples whose middles lie between two places. False when there is none. */
TL_INLINE bool span(float low, float high, int size, int *first, int *last)
{
    *first = (int)ceilf(tl_minf(tl_maxf(low - 0.5f, 0), (float)size));
    *last = (int)floorf(tl_maxf(tl_minf(high - 0.5f, (float)(size - 1)), -1));
    return *first <= *last;
}

TL_INLINE bool box_of(const struct raster *raster, struct facet *facet)
{
    const struct tl_cull_place *at = facet->corners;
    const float margin = raster->margin;
    return span(min3(at[0].x, at[1].x, at[2].x) - margin, max3(at[0].x, at[1].x, at[2].x) + margin,
                raster->request->width, &facet->first_x, &facet->last_x) &&
           span(min3(at[0].y, at[1].y, at[2].y) - margin, max3(at[0].y, at[1].y, at[2].y) + margin,
                raster->request->height, &facet->first_y, &facet->last_y);
}

TL_INLINE bool is_far_out(const struct raster *raster, const struct tl_cull_place *place)
{
    return !(fabsf(place->x) <= (float)(FARTHEST * raster->request->width) &&
             fabsf(place->y) <= (float)(FARTHEST * raster->request->height));
}

enum seen { SEEN_NEVER, SEEN_PERHAPS, SEEN_BY_SAMPLE };

/* Classifies a triangle before its samples are tested. */
TL_INLINE enum seen set_up(const struct raster *raster, const struct tl_cull_place *places,
                           const uint32_t corners[3], struct facet *facet)
{
    int ahead = 0, far_out = 0;
    for (int i = 0; i < 3; i++) {
        facet->corners[i] = places[corners[i]];
        ahead += facet->corners[i].ahead;
        far_out += is_far_out(raster, &facet->corners[i]);
    }
    if (ahead < 3)
        return ahead == 0 ? SEEN_NEVER : SEEN_PERHAPS;
    if (!box_of(raster, facet))
        return SEEN_NEVER;
    if (far_out > 0)
        return SEEN_PERHAPS;
    const struct tl_cull_place a = facet->corners[0], b = facet->corners[1], c = facet->corners[2];
    float area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    facet->side = area < 0 ? -1.0f : 1.0f;
    facet->slope_x = ((b.z - a.z) * (c.y - a.y) - (c.z - a.z) * (b.y - a.y)) / area;
    facet->slope_y = ((c.z - a.z) * (b.x - a.x) - (b.z - a.z) * (c.x - a.x)) / area;
    return SEEN_BY_SAMPLE;
}

/* A lower bound of the distance of the middle of a sample inside all edges, in lengths of which none is
 * longer than its edge's: above `margin` it is surely covered, below -margin surely not. */
TL_INLINE bool is_within(const struct facet *facet, float x, float y, float margin)
{
    bool within = true;
    for (int i = 0; i < 3; i++) {
        const struct tl_cull_place *from = &facet->corners[i], *to = &facet->corners[(i + 1) % 3];
        float along_x = to->x - from->x, along_y = to->y - from->y;
        float inside = facet->side * (along_x * (y - from->y) - along_y * (x - from->x));
        within &= !(inside < margin * (fabsf(along_x) + fabsf(along_y)));
    }
    return within;
}

/* Bounds of the triangle's depth at a sample. A sliver's slopes may be anything, even NaN; then there is no
 * bound. */
TL_INLINE void depth_bounds(const struct facet *facet, float margin, float x, float y, float *low,
                            float *high)
{
    const struct tl_cull_place *at = &facet->corners[0];
    float z = at->z + facet->slope_x * (x - at->x) + facet->slope_y * (y - at->y);
    float spread = margin * (fabsf(facet->slope_x) + fabsf(facet->slope_y));
    *low = z - spread - DEPTH_MARGIN;
    *high = z + spread + DEPTH_MARGIN;
}

TL_INLINE bool covers_any(const struct raster *raster, const struct facet *facet)
{
    if (facet->last_x - facet->first_x >= SPAN_TRIED || facet->last_y - facet->first_y >= SPAN_TRIED)
        return true;
    for (int y = facet->first_y; y <= facet->last_y; y++)
        for (int x = facet->first_x; x <= facet->last_x; x++)
            if (is_within(facet, (float)x + 0.5f, (float)y + 0.5f, -raster->margin))
                return true;
    return false;
}

/* The near plane cuts away what lies before it: that hides nothing. */
TL_INLINE void hide_behind(const struct raster *raster, const struct facet *facet)
{
    for (int y = facet->first_y; y <= facet->last_y; y++)
        for (int x = facet->first_x; x <= facet->last_x; x++) {
            float low, high, middle_x = (float)x + 0.5f, middle_y = (float)y + 0.5f;
            float *depth = raster->depths + (size_t)y * (size_t)raster->request->width + x;
            if (!is_within(facet, middle_x, middle_y, raster->margin))
                continue;
            depth_bounds(facet, raster->margin, middle_x, middle_y, &low, &high);
            if (low > 0 && high < *depth)
                *depth = high;
        }
}

TL_INLINE bool is_hidden(const struct raster *raster, const struct facet *facet)
{
    for (int y = facet->first_y; y <= facet->last_y; y++)
        for (int x = facet->first_x; x <= facet->last_x; x++) {
            float low, high, middle_x = (float)x + 0.5f, middle_y = (float)y + 0.5f;
            if (!is_within(facet, middle_x, middle_y, -raster->margin))
                continue;
            depth_bounds(facet, raster->margin, middle_x, middle_y, &low, &high);
            if (!(low > raster->depths[(size_t)y * (size_t)raster->request->width + (size_t)x]))
                return false;
        }
    return true;
}

static void reserve(const struct tl_cull_request *request, struct tl_cull *out)
{
    size_t triangles = 0, parts = 0, vertices = 0;
    size_t samples = request->nearest_only ? (size_t)request->width * (size_t)request->height : 0;
    for (size_t s = 0; s < request->surface_count; s++) {
        triangles += request->surfaces[s]->index_count / 3;
        parts += request->surfaces[s]->part_count;
        vertices += request->surfaces[s]->vertex_count;
    }
    if (triangles > out->triangle_capacity) {
        out->triangle_capacity = triangles;
        out->indices = tl_resize(out->indices, 3 * triangles, sizeof *out->indices);
        out->numbers = tl_resize(out->numbers, triangles, sizeof *out->numbers);
    }
    if (parts > out->part_capacity) {
        out->part_capacity = parts;
        out->parts = tl_resize(out->parts, parts, sizeof *out->parts);
    }
    if (vertices > out->place_capacity) {
        out->place_capacity = vertices;
        out->places = tl_resize(out->places, vertices, sizeof *out->places);
    }
    if (samples > out->depth_capacity) {
        out->depth_capacity = samples;
        out->depths = tl_resize(out->depths, samples, sizeof *out->depths);
    }
}

TL_INLINE void keep(struct tl_cull *out, const uint32_t corners[3], uint32_t number)
{
    uint32_t *indices = out->indices + 3 * out->triangle_count;
    for (int i = 0; i < 3; i++)
        indices[i] = corners[i];
    out->numbers[out->triangle_count++] = number;
}

/* `first` is the number of the surface's first triangle. */
TL_CLONES static void keep_part(const struct raster *raster, const tl_surface *surface,
                                const struct tl_mesh_part *part, const struct tl_cull_place *places,
                                uint32_t first, bool hides, struct tl_cull *out)
{
    struct tl_cull_part *kept = &out->parts[out->part_count++];
    uint32_t begin = part->first_index / 3, end = begin + part->index_count / 3;
    kept->first = out->triangle_count;
    for (uint32_t t = begin; t < end; t++) {
        const uint32_t *corners = surface->indices + 3 * (size_t)t;
        struct facet facet = {0};
        enum seen seen = set_up(raster, places, corners, &facet);
        if (seen == SEEN_NEVER || (seen == SEEN_BY_SAMPLE && !covers_any(raster, &facet)))
            continue;
        if (hides && seen == SEEN_BY_SAMPLE)
            hide_behind(raster, &facet);
        keep(out, corners, first + t);
    }
    kept->count = out->triangle_count - kept->first;
}

static void keep_covering(const struct raster *raster, struct tl_cull *out)
{
    const struct tl_cull_request *request = raster->request;
    struct tl_cull_place *places = out->places;
    uint32_t first = 0;
    out->triangle_count = out->part_count = 0;
    for (size_t s = 0; s < request->surface_count; s++) {
        const tl_surface *surface = request->surfaces[s];
        place_vertices(surface, request, places);
        for (size_t p = 0; p < surface->part_count; p++) {
            const struct tl_mesh_part *part = &surface->parts[p];
            bool is_whole =
                s < request->first_fading && !(surface->materials[part->material].alpha_cutoff > 0);
            keep_part(raster, surface, part, places, first, request->nearest_only && is_whole, out);
        }
        places += surface->vertex_count;
        first += (uint32_t)(surface->index_count / 3);
    }
}

TL_CLONES static void drop_occluded(const struct raster *raster, struct tl_cull *out)
{
    const struct tl_cull_request *request = raster->request;
    const struct tl_cull_place *places = out->places;
    struct tl_cull_part *part = out->parts;
    out->triangle_count = 0;
    for (size_t s = 0; s < request->surface_count; s++) {
        for (size_t p = 0; p < request->surfaces[s]->part_count; p++, part++) {
            size_t begin = part->first, end = begin + part->count;
            part->first = out->triangle_count;
            for (size_t t = begin; t < end; t++) {
                struct facet facet = {0};
                enum seen seen = set_up(raster, places, out->indices + 3 * t, &facet);
                if (seen == SEEN_PERHAPS || !is_hidden(raster, &facet))
                    keep(out, out->indices + 3 * t, out->numbers[t]);
            }
            part->count = out->triangle_count - part->first;
        }
        places += request->surfaces[s]->vertex_count;
    }
}

void tl_cull_make(const struct tl_cull_request *request, struct tl_cull *out)
{
    const int side = request->width > request->height ? request->width : request->height;
    reserve(request, out);
    const struct raster raster = {.request = request,
                                  .margin = ldexpf(1, -request->subpixel_bits) + PLACE_ROUNDING * (float)side,
                                  .depths = out->depths};
    for (size_t i = 0; request->nearest_only && i < (size_t)request->width * (size_t)request->height; i++)
        out->depths[i] = 1;
    keep_covering(&raster, out);
    if (request->nearest_only)
        drop_occluded(&raster, out);
}

void tl_cull_release(struct tl_cull *cull)
{
    free(cull->indices);
    free(cull->numbers);
    free(cull->parts);
    free(cull->places);
    free(cull->depths);
    *cull = (struct tl_cull){0};
}

size_t tl_cull_bytes(const struct tl_cull *cull)
{
    return cull->triangle_capacity * 4 * sizeof(uint32_t) + cull->part_capacity * sizeof *cull->parts +
           cull->place_capacity * sizeof *cull->places + cull->depth_capacity * sizeof *cull->depths;
}
