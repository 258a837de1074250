#include "render/reference/detail.h"

#include "config/memory.h"
#include "render/detail/bake.h"
#include "render/detail/detail_terms.h"

#include <math.h>
#include <stdlib.h>

struct tl_moment_map {
    const tl_image *of;
    tl_image image;
    struct tl_map_texture texture;
};

const struct tl_map_texture *tl_reference_moments(struct tl_reference_detail *detail, const tl_image *normals)
{
    if (!normals || !normals->texels || !tl_detail_wants_moments(&detail->params))
        return NULL;
    for (size_t i = 0; i < detail->count; i++)
        if (detail->items[i]->of == normals)
            return &detail->items[i]->texture;
    struct tl_moment_map *made = TL_NEW(struct tl_moment_map);
    made->of = normals;
    made->image = tl_bake_moments(normals);
    made->texture = tl_map_texture_make(&made->image, false);
    detail->items = tl_resize(detail->items, detail->count + 1, sizeof(struct tl_moment_map *));
    detail->items[detail->count++] = made;
    return &made->texture;
}

void tl_reference_detail_release(struct tl_reference_detail *detail)
{
    for (size_t i = 0; i < detail->count; i++) {
        tl_map_texture_release(&detail->items[i]->texture);
        tl_image_release(&detail->items[i]->image);
        free(detail->items[i]);
    }
    free(detail->items);
    *detail = (struct tl_reference_detail){0};
}

struct tl_bump_statistics tl_bump_statistics_of_normal(vec3s normal)
{
    return (struct tl_bump_statistics){normal, {0, 0}, 1};
}

struct tl_bump_statistics tl_bump_statistics_of_moments(vec4s moments, float scale)
{
    float z = sqrtf(fmaxf(1 - moments.z - moments.w, 0));
    struct tl_bump_statistics bumps = {
        .normal = {{scale * moments.x, scale * moments.y, z}},
        .spread = {scale * scale * fmaxf(moments.z - moments.x * moments.x, 0),
                   scale * scale * fmaxf(moments.w - moments.y * moments.y, 0)}};
    bumps.length = sqrtf(fminf(fmaxf(1 - bumps.spread[0] - bumps.spread[1], 0.0025f), 1));
    return bumps;
}

struct tl_bump_statistics tl_bump_statistics_add(const struct tl_bump_statistics *a,
                                                 const struct tl_bump_statistics *b)
{
    vec3s n = a->normal, m = b->normal;
    return (struct tl_bump_statistics){.normal = {{n.x * m.z + m.x * n.z, n.y * m.z + m.y * n.z, n.z * m.z}},
                                       .spread = {a->spread[0] + b->spread[0], a->spread[1] + b->spread[1]},
                                       .length = a->length * b->length};
}

float tl_bump_statistics_roughness(const struct tl_detail_params *params, float rough,
                                   const struct tl_bump_statistics *bumps, vec3s view)
{
    if (params->minify == TL_DETAIL_MINIFY_NONE)
        return rough;
    if (params->minify == TL_DETAIL_MINIFY_TOKSVIG) {
        float variance = detail_variance(bumps->length);
        return detail_widened(rough, variance, variance, 1);
    }
    float square = view.x * view.x + view.y * view.y;
    float share = square > 1e-12f ? view.x * view.x / square : 0.5f;
    float along = bumps->spread[0] * share + bumps->spread[1] * (1 - share);
    float across = bumps->spread[0] * (1 - share) + bumps->spread[1] * share;
    return detail_widened(rough, along, across, fabsf(view.z));
}

/* Number of steps: four per texel along the surface, and at least as many as the renderer takes. */
static int fine_steps(const struct tl_height_field *field, vec3s view)
{
    float depth = (field->high_m - field->low_m) * detail_slant(view.z);
    vec2s moved = tl_field_moved(field, (vec2s){{0, 0}}, depth * view.x, depth * view.y);
    float texels = hypotf(moved.x * (float)field->heights->width, moved.y * (float)field->heights->height);
    return 64 + (int)fminf(4 * texels, 4096);
}

vec2s tl_reference_shift(const struct tl_detail_params *params, const struct tl_detail_heights *heights,
                         vec2s uv, float uv_metres, vec3s view, float side)
{
    if (params->mode < TL_DETAIL_PARALLAX || !heights->image.texels || !(uv_metres > 0))
        return (vec2s){{0, 0}};
    const float *rows = heights->rows;
    vec2s at = {{rows[0] * uv.x + rows[1] * uv.y + rows[2], rows[3] * uv.x + rows[4] * uv.y + rows[5]}};
    const struct tl_height_field *field = side > 0 ? &heights->field : &heights->back;
    vec3s seen = {{view.x, view.y, side * view.z}};
    float rise = tl_field_height(field, at);
    if (params->mode == TL_DETAIL_RELIEF)
        rise = tl_field_march(field, at, seen, fine_steps(field, seen)).height_m;
    if (params->mode != TL_DETAIL_PARALLAX_LIMITED)
        rise *= detail_slant(seen.z);
    return (vec2s){{rise * seen.x / uv_metres, -rise * seen.y / uv_metres}};
}
