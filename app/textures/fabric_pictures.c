#include "app/textures/fabric_pictures.h"

#include "assets/fabric/fabric_maps.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "render/detail/bake.h"

#include <string.h>

/* Metres above the middle plane; flat where the fabric has no heights. */
static tl_image heights_of(const struct tl_fabric_maps *maps, float depth_m)
{
    tl_image out = tl_image_create(maps->width, maps->height, 1, TL_IMAGE_F32);
    for (size_t i = 0; maps->height_map.texels && i < (size_t)out.width * (size_t)out.height; i++)
        tl_image_floats(&out)[i] = depth_m * (tl_image_floats(&maps->height_map)[i] - 0.5f);
    return out;
}

/* The file's own normals, or else those of its heights. */
static tl_image normals_of(struct tl_fabric_maps *maps, const tl_image *heights, const float size_m[2])
{
    tl_image own = maps->normal;
    maps->normal = (tl_image){0};
    if (own.texels)
        return own;
    struct tl_height_field field = tl_height_field_make(heights, size_m[0], size_m[1], false, false);
    tl_image slopes = tl_bake_slopes(&field), normals = tl_bake_normals(&slopes, 1),
             bytes = tl_bake_encoded(&normals);
    tl_image_release(&slopes);
    tl_image_release(&normals);
    return bytes;
}

static void take(tl_image *to, tl_image *from)
{
    *to = *from;
    *from = (tl_image){0};
}

static void make(const struct tl_weave_params *params, struct tl_fabric_maps *maps,
                 struct tl_fabric_pictures *out)
{
    float width_m = 1e-3f * tl_weave_picture_mm(params), length_m = 1e-3f * params->picture_length_mm;
    if (!(length_m > 0))
        length_m = width_m * (float)maps->height / (float)maps->width;
    tl_fabric_maps_mirror(maps, params->picture_mirror & TL_PICTURE_MIRROR_WEFT,
                          params->picture_mirror & TL_PICTURE_MIRROR_WARP);
    width_m *= params->picture_mirror & TL_PICTURE_MIRROR_WEFT ? 2 : 1; /* as large as both images */
    length_m *= params->picture_mirror & TL_PICTURE_MIRROR_WARP ? 2 : 1;
    out->weave =
        (tl_weave){.size_m = {width_m, length_m}, .height = heights_of(maps, 1e-3f * params->depth_mm)};
    out->weave.normal = normals_of(maps, &out->weave.height, out->weave.size_m);
    take(&out->weave.tint, &maps->colour);
    take(&out->weave.gloss, &maps->gloss);
    take(&out->cover, &maps->opacity);
    take(&out->specular, &maps->specular);
}

bool tl_fabric_pictures_make(const struct tl_weave_params *params, struct tl_fabric_pictures *out,
                             tl_error *error)
{
    tl_fabric_file file;
    struct tl_fabric_maps maps;
    *out = (struct tl_fabric_pictures){0};
    if (!tl_fabric_file_open(params->pictures, &file, error))
        return false;
    bool loaded = tl_fabric_maps_load(&file, &maps, error);
    if (loaded && maps.lean_deg > 0)
        tl_warn("%s: the picture of normals leans by %.0f degrees in the mean: it is levelled; take one from "
                "its maker",
                file.pictures[TL_PICTURE_NORMAL].file, (double)maps.lean_deg);
    if (loaded && maps.width > 0)
        make(params, &maps, out);
    else if (loaded)
        loaded = tl_fail(error, TL_INPUT, "%s: weave.pictures: has no pictures", params->pictures);
    tl_fabric_maps_release(&maps);
    tl_fabric_file_release(&file);
    return loaded;
}

void tl_fabric_pictures_release(struct tl_fabric_pictures *pictures)
{
    tl_weave_release(&pictures->weave);
    tl_image_release(&pictures->cover);
    tl_image_release(&pictures->specular);
}

struct tl_uv_transform tl_fabric_pictures_transform(const tl_weave *weave, float uv_metres)
{
    return (struct tl_uv_transform){.scale = {uv_metres / weave->size_m[0], uv_metres / weave->size_m[1]}};
}
