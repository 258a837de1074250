#include "render/inspect/inspect.h"

#include "render/inspect/paint.h"
#include "render/inspect/pick.h"

#include <string.h>

#define TILE 4 /* texels a side, as samples are kept (gbuffer/samples.h) */

/* Rises from each of the nearest samples to the next. */
static uint64_t place_of(const struct tl_samples *samples, uint32_t texel)
{
    uint32_t width = (uint32_t)samples->width, x = texel % width, y = texel / width;
    uint32_t tiles = (width + TILE - 1) / TILE;
    uint64_t tile = (uint64_t)(y / TILE) * tiles + x / TILE;
    return tile * TILE * TILE + (uint64_t)(y % TILE) * TILE + x % TILE;
}

/* The number of a texel's nearest sample; primary_count when nothing covers it. */
static size_t find_sample(const struct tl_samples *samples, uint32_t texel)
{
    uint64_t wanted = place_of(samples, texel);
    size_t low = 0, high = samples->primary_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (place_of(samples, samples->items[middle].texel) < wanted)
            low = middle + 1;
        else
            high = middle;
    }
    bool found = low < samples->primary_count && samples->items[low].texel == texel;
    return found ? low : samples->primary_count;
}

size_t tl_inspect_find(const struct tl_samples *samples, int width, int height, int x, int y)
{
    uint32_t column = (uint32_t)(((uint64_t)x * 2 + 1) * (uint64_t)samples->width / 2 / (uint64_t)width);
    uint64_t upwards = (uint64_t)(height - 1 - y);
    uint32_t row = (uint32_t)((upwards * 2 + 1) * (uint64_t)samples->height / 2 / (uint64_t)height);
    return find_sample(samples, row * (uint32_t)samples->width + column);
}

static bool pick(const struct tl_inspect_request *request, int width, int height, int x, int y,
                 tl_sample *out)
{
    const struct tl_view *view = request->view;
    float right = 2 * ((float)x + 0.5f) / (float)width - 1;
    float up = 1 - 2 * ((float)y + 0.5f) / (float)height;
    vec3s direction = glms_vec3_add(
        view->forward, glms_vec3_add(glms_vec3_scale(view->right, right), glms_vec3_scale(view->up, up)));
    if (!tl_pick(request->ranges, view->eye, glms_vec3_normalize(direction), out))
        return false;
    out->glossiness = tl_triangle_material(request->ranges, out->triangle & ~TL_SAMPLE_BACK)->glossiness;
    return true;
}

static void describe_visibility(const struct tl_inspect_request *request, size_t sample,
                                struct tl_inspection *out)
{
    struct tl_seen_regions regions;
    size_t stride;
    const struct tl_taps *taps = tl_points_taps(request->points);
    if (!taps)
        return;
    tl_seen_regions_make(request->regions, request->environment_yaw, &regions);
    const uint16_t *values = tl_points_values(request->points, &stride);
    struct tl_seen seen = tl_seen_at(&regions, values, stride, &taps[sample], out->smooth);
    out->has_visibility = true;
    out->visibility = seen.visibility;
    out->strongest_region = seen.strongest;
    out->strongest_share = seen.share;
}

static void describe_surface(const struct tl_inspect_request *request, const tl_sample *sample,
                             struct tl_inspection *out)
{
    uint32_t number = sample->triangle & ~TL_SAMPLE_BACK, corners[3];
    *out = (struct tl_inspection){.strongest_region = -1,
                                  .back = sample->triangle & TL_SAMPLE_BACK,
                                  .position = sample->point,
                                  .normal = sample->normal,
                                  .smooth = sample->smooth,
                                  .glossiness = sample->glossiness};
    memcpy(out->weights, sample->weights, sizeof out->weights);
    const tl_surface *surface = tl_triangle_find(request->ranges, number, corners, &out->surface_index);
    uint32_t own = number - request->ranges->first[out->surface_index];
    const struct tl_mesh_part *part = tl_triangle_part(surface, own);
    out->surface = surface->name;
    out->material = surface->materials[part->material].name;
    out->triangle = own;
    vec3s tangent = {{0, 0, 0}};
    for (int i = 0; i < 3; i++) {
        float weight = sample->weights[i];
        if (surface->uvs)
            out->uv = glms_vec2_add(out->uv, glms_vec2_scale(surface->uvs[corners[i]], weight));
        if (surface->tangents)
            tangent =
                glms_vec3_add(tangent, glms_vec3_scale(glms_vec3(surface->tangents[corners[i]]), weight));
    }
    out->tangent = glms_vec3_normalize(tangent); /* of zero zero */
    out->uv_mm = glms_vec2_scale(out->uv, 1000 * part->uv_metres);
    if (surface->strains) {
        vec3s strain = tl_paint_mix(surface->strains, corners, sample->weights);
        out->has_strain = true;
        out->strain_warp = strain.x;
        out->strain_weft = strain.y;
        out->shear = strain.z;
    }
}

void tl_inspect_sample(const struct tl_inspect_request *request, size_t number, struct tl_inspection *out)
{
    describe_surface(request, &request->samples->items[number], out);
    if (request->points)
        describe_visibility(request, number, out);
}

bool tl_inspect_ray(const struct tl_inspect_request *request, int width, int height, int x, int y,
                    struct tl_inspection *out)
{
    tl_sample sample;
    if (!pick(request, width, height, x, y, &sample))
        return false;
    describe_surface(request, &sample, out);
    return true;
}
