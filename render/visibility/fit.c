#include "render/visibility/fit.h"

#include "config/base/memory.h"
#include "config/base/simd.h"

#include <stdlib.h>

#define EXTENT_MIN   1e-4f /* metres: for cloth seen edge-on, or no casters */
#define DEPTH_MARGIN 1e-3f /* of the range */

static size_t whole_groups(size_t count)
{
    return (count + TL_LANES - 1) / TL_LANES * TL_LANES;
}

static size_t vertex_total(const tl_surface *surfaces, size_t surface_count)
{
    size_t total = 0;
    for (size_t s = 0; s < surface_count; s++)
        total += surfaces[s].vertex_count;
    return total;
}

void tl_caster_cloud_fill(struct tl_caster_cloud *cloud, const tl_surface *surfaces, size_t surface_count)
{
    size_t total = vertex_total(surfaces, surface_count), next = 0;
    cloud->count = total > 0 ? whole_groups(total) : TL_LANES;
    if (cloud->count > cloud->capacity) {
        cloud->capacity = cloud->count;
        for (int axis = 0; axis < 3; axis++)
            cloud->coordinates[axis] = tl_resize(cloud->coordinates[axis], cloud->capacity, sizeof(float));
    }
    for (size_t s = 0; s < surface_count; s++)
        for (size_t v = 0; v < surfaces[s].vertex_count; v++, next++)
            for (int axis = 0; axis < 3; axis++)
                cloud->coordinates[axis][next] = surfaces[s].positions[v].raw[axis];
    for (; next < cloud->count; next++)
        for (int axis = 0; axis < 3; axis++)
            cloud->coordinates[axis][next] = total > 0 ? cloud->coordinates[axis][total - 1] : 0;
}

void tl_caster_cloud_release(struct tl_caster_cloud *cloud)
{
    for (int axis = 0; axis < 3; axis++)
        free(cloud->coordinates[axis]);
    *cloud = (struct tl_caster_cloud){0};
}

void tl_view_axes(vec3s direction, vec3s *right, vec3s *up)
{
    vec3s helper = fabsf(direction.y) < 0.9f ? (vec3s){{0, 1, 0}} : (vec3s){{1, 0, 0}};
    *right = glms_vec3_normalize(glms_vec3_cross(helper, direction));
    *up = glms_vec3_cross(direction, *right);
}

vec4s tl_view_row(vec3s axis, vec3s centre, float scale)
{
    return (vec4s){
        {axis.x * scale, axis.y * scale, axis.z * scale, 0.5f - scale * glms_vec3_dot(axis, centre)}};
}

struct value_range {
    float low, high;
};

/* Minimum and maximum coordinate along an axis, lane by lane; the lanes are reduced at the end. */
TL_CLONES static struct value_range range_along(const struct tl_caster_cloud *cloud, vec3s axis)
{
    const float *x = cloud->coordinates[0], *y = cloud->coordinates[1], *z = cloud->coordinates[2];
    float low[TL_LANES], high[TL_LANES];
    for (int lane = 0; lane < TL_LANES; lane++)
        low[lane] = high[lane] = axis.x * x[lane] + axis.y * y[lane] + axis.z * z[lane];
    for (size_t i = TL_LANES; i < cloud->count; i += TL_LANES)
        for (int lane = 0; lane < TL_LANES; lane++) {
            size_t k = i + (size_t)lane;
            float value = axis.x * x[k] + axis.y * y[k] + axis.z * z[k];
            low[lane] = tl_minf(low[lane], value);
            high[lane] = tl_maxf(high[lane], value);
        }
    struct value_range range = {low[0], high[0]};
    for (int lane = 1; lane < TL_LANES; lane++)
        range = (struct value_range){tl_minf(range.low, low[lane]), tl_maxf(range.high, high[lane])};
    return range;
}

/* Maps the range to the middle `share` of [0, 1]. */
static vec4s fit_row(const struct tl_caster_cloud *cloud, vec3s axis, float share)
{
    struct value_range range = range_along(cloud, axis);
    float scale = share / tl_maxf(range.high - range.low, EXTENT_MIN);
    return (vec4s){
        {axis.x * scale, axis.y * scale, axis.z * scale, 0.5f - scale * 0.5f * (range.low + range.high)}};
}

struct tl_region_view tl_region_view_fit(vec3s direction, const struct tl_caster_cloud *cloud, int map_size)
{
    vec3s right, up;
    tl_view_axes(direction, &right, &up);
    float inner =
        map_size > 4 * TL_MAP_MARGIN_TEXELS ? 1 - 2.0f * TL_MAP_MARGIN_TEXELS / (float)map_size : 0.5f;
    return (struct tl_region_view){
        .map_rows = {fit_row(cloud, right, inner), fit_row(cloud, up, inner),
                     fit_row(cloud, glms_vec3_negate(direction), 1 - 2 * DEPTH_MARGIN)},
        .direction = {{direction.x, direction.y, direction.z, 0}},
    };
}
