#include "render/reference/detail.h"

#include "config/base/memory.h"
#include "render/detail/bake.h"
#include "render/detail/detail_terms.h"

#include <math.h>
#include <stdlib.h>

const struct tl_moment_map *tl_reference_moments(struct tl_reference_detail *detail, const tl_image *normals)
{
    if (!normals || !normals->texels || !tl_detail_wants_moments(&detail->params))
        return NULL;
    for (size_t i = 0; i < detail->count; i++)
        if (detail->items[i]->of == normals)
            return detail->items[i];
    struct tl_moment_map *made = TL_NEW(struct tl_moment_map);
    made->of = normals;
    made->image = tl_bake_moments(normals, false);
    made->texture = tl_map_texture_make(&made->image, false);
    made->cross_image = tl_bake_cross_moments(normals, false);
    made->cross_texture = tl_map_texture_make(&made->cross_image, false);
    detail->items = tl_resize(detail->items, detail->count + 1, sizeof(struct tl_moment_map *));
    detail->items[detail->count++] = made;
    return made;
}

void tl_reference_detail_release(struct tl_reference_detail *detail)
{
    for (size_t i = 0; i < detail->count; i++) {
        tl_map_texture_release(&detail->items[i]->texture);
        tl_image_release(&detail->items[i]->image);
        tl_map_texture_release(&detail->items[i]->cross_texture);
        tl_image_release(&detail->items[i]->cross_image);
        free(detail->items[i]);
    }
    free(detail->items);
    *detail = (struct tl_reference_detail){0};
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
