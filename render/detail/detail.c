#include "render/detail/detail.h"

#include "render/detail/bake.h"

#include <stdio.h>
#include <string.h>

static bool has_weave(const tl_material *material)
{
    return material->weave && material->weave->size_m[0] > 0 && material->weave->size_m[1] > 0;
}

/* The heights of a height map: 0 is deepest, 1 lies height_top_m above the surface of the mesh. A step (x, y)
 * in metres is (x, -y) / uv_metres in UV. */
static void heights_of_map(const tl_material *material, float uv_metres, float scale,
                           struct tl_detail_heights *out)
{
    const struct tl_map *map = &material->height_map;
    float depth = scale * material->height_m;
    out->image = tl_bake_heights(map->image, scale * material->height_top_m - depth, depth);
    out->field = tl_height_field_make(&out->image, uv_metres, uv_metres, map->clamp_u, map->clamp_v);
    tl_uv_transform_rows(&map->transform, out->rows);
    const float to[4] = {out->rows[0] / uv_metres, -out->rows[1] / uv_metres, out->rows[3] / uv_metres,
                         -out->rows[4] / uv_metres};
    memcpy(out->field.repeats_per_m, to, sizeof to);
}

static void heights_of_weave(const tl_weave *weave, float uv_metres, float scale,
                             struct tl_detail_heights *out)
{
    out->image = tl_bake_heights(&weave->height, 0, scale);
    out->field = tl_height_field_make(&out->image, weave->size_m[0], weave->size_m[1], false, false);
    const float rows[6] = {uv_metres / weave->size_m[0], 0, 0, 0, uv_metres / weave->size_m[1], 0};
    memcpy(out->rows, rows, sizeof rows);
}

bool tl_detail_heights_make(const tl_material *material, float uv_metres, float scale,
                            struct tl_detail_heights *out)
{
    *out = (struct tl_detail_heights){0};
    if (!(uv_metres > 0))
        return false;
    if (material->height_map.image)
        heights_of_map(material, uv_metres, scale, out);
    else if (has_weave(material))
        heights_of_weave(material->weave, uv_metres, scale, out);
    if (out->image.texels)
        out->back = tl_height_field_back(&out->field);
    return out->image.texels;
}

void tl_detail_heights_release(struct tl_detail_heights *heights)
{
    tl_image_release(&heights->image);
    *heights = (struct tl_detail_heights){0};
}

bool tl_detail_wants_heights(const struct tl_detail_params *params)
{
    return params->mode >= TL_DETAIL_PARALLAX || params->shadow == TL_DETAIL_SHADOW_RELIEF;
}

bool tl_detail_wants_cones(const struct tl_detail_params *params)
{
    return params->mode == TL_DETAIL_RELIEF && !params->curved;
}

bool tl_detail_wants_horizons(const struct tl_detail_params *params)
{
    return params->shadow != TL_DETAIL_SHADOW_NONE;
}

bool tl_detail_wants_moments(const struct tl_detail_params *params)
{
    return params->minify != TL_DETAIL_MINIFY_NONE;
}

bool tl_detail_has_offsets(const struct tl_detail_params *params)
{
    return params->mode == TL_DETAIL_OFFSET || params->mode == TL_DETAIL_EYE_SPACE;
}

bool tl_detail_has_derivatives(const struct tl_detail_params *params)
{
    return params->mode == TL_DETAIL_BLINN || params->mode == TL_DETAIL_EYE_SPACE;
}

int tl_detail_angle_count(const struct tl_detail_params *params)
{
    return 8 << params->angles;
}

bool tl_detail_has_own_normals(const tl_material *material)
{
    return material->height_map.image && !material->normal_map.image;
}

bool tl_detail_wants_maps(const struct tl_detail_params *params, const tl_material *material)
{
    bool has_heights = material->height_map.image || has_weave(material);
    bool has_normals = material->normal_map.image || has_heights;
    return (has_heights && (tl_detail_wants_heights(params) || tl_detail_wants_horizons(params))) ||
           (has_normals && (tl_detail_wants_moments(params) || tl_detail_has_offsets(params) ||
                            tl_detail_has_derivatives(params))) ||
           tl_detail_has_own_normals(material);
}

void tl_detail_defines(const struct tl_detail_params *params, char *out, size_t size)
{
    out[0] = '\0';
    if (!params)
        return;
    bool shifts = params->mode >= TL_DETAIL_PARALLAX,
         clips = params->mode == TL_DETAIL_RELIEF && params->silhouette,
         curves = params->mode == TL_DETAIL_RELIEF && params->curved;
    snprintf(out, size,
             "#define DETAIL_MODE %d\n#define DETAIL_SHADOW %d\n#define DETAIL_ANGLES %d\n"
             "#define DETAIL_MINIFY %d\n%s%s%s%s%s",
             params->mode, params->shadow, tl_detail_angle_count(params), params->minify,
             shifts ? "#define DETAIL_SHIFTED\n" : "", clips ? "#define DETAIL_CLIPPED\n" : "",
             curves ? "#define DETAIL_CURVED\n" : "",
             tl_detail_has_offsets(params) ? "#define DETAIL_OFFSETS\n" : "",
             params->mode == TL_DETAIL_EYE_SPACE ? "#define DETAIL_EYE_SPACE\n" : "");
}
