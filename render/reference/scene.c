#include "render/reference/scene.h"

#include "config/base/memory.h"

#include <stdlib.h>

/* Fraction of the conservative offset tl_trace_offset: a hundred times the rounding error of positions, and
 * small enough that contact shadows of resting objects stay closed. */
#define OFFSET_SHARE 0.1f

static const struct tl_map_texture *find_texture(struct tl_reference_scene *scene, const tl_image *image,
                                                 bool colour)
{
    if (!image)
        return NULL;
    for (size_t i = 0; i < scene->texture_count; i++)
        if (scene->textures[i]->image == image && scene->textures[i]->colour == colour)
            return scene->textures[i];
    scene->textures = tl_resize(scene->textures, scene->texture_count + 1, sizeof(struct tl_map_texture *));
    struct tl_map_texture *texture = TL_NEW(struct tl_map_texture);
    *texture = tl_map_texture_make(image, colour);
    scene->textures[scene->texture_count++] = texture;
    return texture;
}

static struct tl_reference_material make_material(struct tl_reference_scene *scene,
                                                  const tl_material *material)
{
    const struct tl_map *maps[TL_MAP_USES] = {[TL_MAP_DIFFUSE] = &material->diffuse_map,
                                              [TL_MAP_NORMAL] = &material->normal_map,
                                              [TL_MAP_GLOSS] = &material->gloss_map,
                                              [TL_MAP_SPECULAR] = &material->specular_map,
                                              [TL_MAP_OCCLUSION] = &material->occlusion_map};
    struct tl_reference_material prepared = {0};
    for (enum tl_map_use use = 0; use < TL_MAP_USES; use++) {
        bool colour = use == TL_MAP_DIFFUSE || use == TL_MAP_SPECULAR;
        prepared.maps[use] =
            (struct tl_reference_map){.texture = find_texture(scene, maps[use]->image, colour),
                                      .clamp_u = maps[use]->clamp_u,
                                      .clamp_v = maps[use]->clamp_v};
        tl_uv_transform_rows(&maps[use]->transform, prepared.maps[use].rows);
    }
    const struct tl_map *emission = &material->emission_map;
    prepared.emission = (struct tl_reference_map){.texture = find_texture(scene, emission->image, true),
                                                  .clamp_u = emission->clamp_u,
                                                  .clamp_v = emission->clamp_v};
    tl_uv_transform_rows(&emission->transform, prepared.emission.rows);
    prepared.own_moments = tl_reference_moments(&scene->detail, material->normal_map.image);
    const tl_weave *weave = material->weave;
    if (weave && weave->size_m[0] > 0 && weave->size_m[1] > 0) {
        prepared.weave_moments = tl_reference_moments(&scene->detail, &weave->normal);
        prepared.weave[TL_WEAVE_NORMAL] = find_texture(scene, &weave->normal, false);
        prepared.weave[TL_WEAVE_GLOSS] = find_texture(scene, &weave->gloss, false);
        prepared.weave[TL_WEAVE_TINT] = find_texture(scene, &weave->tint, false);
    }
    if (tl_material_is_sewn(material)) {
        prepared.construction = TL_NEW(struct tl_construction_tables);
        tl_construction_tables_make(&material->construction, prepared.construction);
    }
    return prepared;
}

static struct tl_surface_materials make_materials(struct tl_reference_scene *scene, const tl_surface *surface)
{
    size_t count = 0;
    for (size_t p = 0; p < surface->part_count; p++) {
        size_t needed = (size_t)surface->parts[p].material + 1;
        count = needed > count ? needed : count;
    }
    struct tl_surface_materials prepared = {count, TL_NEW_ARRAY(struct tl_reference_material, count)};
    for (size_t m = 0; m < count; m++)
        prepared.materials[m] = make_material(scene, &surface->materials[m]);
    const struct tl_detail_params *detail = &scene->detail.params;
    for (size_t p = 0; p < surface->part_count && tl_detail_wants_heights(detail); p++) {
        const struct tl_mesh_part *part = &surface->parts[p];
        struct tl_detail_heights *heights = &prepared.materials[part->material].heights;
        if (!heights->image.texels)
            tl_detail_heights_make(&surface->materials[part->material], part->uv_metres, detail->height_scale,
                                   heights);
    }
    return prepared;
}

bool tl_reference_scene_make(const struct tl_reference_request *request, struct tl_reference_scene *out,
                             tl_error *error)
{
    const tl_frame *frame = request->frame;
    const struct tl_ground *ground = request->ground;
    *out = (struct tl_reference_scene){.surfaces = frame->surfaces,
                                       .surface_count = frame->surface_count,
                                       .ground = ground,
                                       .lobe = request->lobe,
                                       .terminator = request->params->terminator,
                                       .detail.params = *request->detail,
                                       .reflect = request->reflect_scene,
                                       .bounces = request->bounces};
    out->materials = TL_NEW_ARRAY(struct tl_surface_materials, out->surface_count + 1);
    for (size_t i = 0; i < out->surface_count; i++)
        out->materials[i] = make_materials(out, &frame->surfaces[i]);
    if (ground)
        out->materials[out->surface_count] = make_materials(out, &ground->surface);
    out->lamp_count = tl_lamps_lit(frame, out->lamps);
    tl_sky_make(frame->environment, frame->environment_yaw, &out->sky);
    out->trace = tl_trace_create(error);
    if (!out->trace || !tl_trace_update(out->trace, out->surfaces, out->surface_count, error)) {
        tl_reference_scene_release(out);
        return false;
    }
    out->offset_m = OFFSET_SHARE * tl_trace_offset(out->trace);
    return true;
}

void tl_reference_scene_release(struct tl_reference_scene *scene)
{
    for (size_t i = 0; scene->materials && i <= scene->surface_count; i++) {
        for (size_t m = 0; m < scene->materials[i].count; m++) {
            tl_detail_heights_release(&scene->materials[i].materials[m].heights);
            free(scene->materials[i].materials[m].construction);
        }
        free(scene->materials[i].materials);
    }
    tl_reference_detail_release(&scene->detail);
    free(scene->materials);
    for (size_t i = 0; i < scene->texture_count; i++) {
        tl_map_texture_release(scene->textures[i]);
        free(scene->textures[i]);
    }
    free(scene->textures);
    tl_sky_release(&scene->sky);
    tl_trace_destroy(&scene->trace);
    *scene = (struct tl_reference_scene){0};
}
