#include "app/audit/audit_internal.h"
#include "config/base/memory.h"

#include <stdlib.h>

static void audit_units(tl_audit *audit, const tl_model *model)
{
    char *units = tl_units_describe(model->name, &model->units, "--units");
    char *up = tl_units_describe_up(model->name, &model->units, "--up");
    bool fits = model->units.fits && !model->units.absurd;
    if (units)
        tl_audit_add_file(audit, fits ? TL_AUDIT_UNITS_GUESSED : TL_AUDIT_UNITS_UNFIT, NULL, units);
    if (up)
        tl_audit_add_file(audit, TL_AUDIT_UP_GUESSED, NULL, up);
    free(up);
    free(units);
}

static void audit_files(tl_audit *audit, const tl_model *model)
{
    for (size_t i = 0; i < model->unread_count; i++)
        tl_audit_add_file(audit,
                          model->unread[i].is_absent ? TL_AUDIT_FILE_MISSING : TL_AUDIT_FILE_UNREADABLE,
                          model->unread[i].file, model->unread[i].reason);
}

static void audit_textures(tl_audit *audit, const tl_model *model)
{
    const tl_mesh *mesh = &model->mesh;
    for (size_t p = 0; p < mesh->part_count; p++) {
        const tl_material *material = &model->materials[mesh->parts[p].material];
        bool has_maps = material->diffuse_map.image || material->normal_map.image ||
                        material->gloss_map.image || material->specular_map.image ||
                        material->emission_map.image || material->occlusion_map.image;
        if (has_maps && mesh->parts[p].uv_metres == 0)
            audit_add(audit, TL_AUDIT_TEXTURE_UNSCALED, model, mesh->parts[p].first_index / 3,
                      "its material has pictures, but its triangles (%u) have no UVs, or all at one point",
                      mesh->parts[p].index_count / 3);
    }
}

void tl_audit_garment(tl_audit *audit, const tl_garment *garment)
{
    const tl_model *model = &garment->model;
    const tl_mesh *mesh = &model->mesh;
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    size_t places = tl_weld_positions(mesh->positions, mesh->vertex_count, weld);
    struct audited audited = {
        .model = model,
        .mesh = mesh,
        .topology = tl_topology_build(mesh->indices, mesh->index_count, weld, mesh->vertex_count, places),
        .degenerate = TL_NEW_ARRAY(bool, mesh->index_count / 3)};
    audit_files(audit, model);
    audit_textures(audit, model);
    audit_units(audit, model);
    audit_seams(audit, garment);
    audit_degenerate(audit, &audited);
    audit_winding(audit, &audited);
    audit_repeated(audit, &audited);
    audit_crossings(audit, &audited);
    tl_topology_release(&audited.topology);
    free(audited.degenerate);
    free(weld);
}

void tl_audit_fabric(tl_audit *audit, const tl_fabric_file *fabric)
{
    for (size_t i = 0; i < fabric->missing_count; i++)
        tl_audit_add_file(audit, TL_AUDIT_FILE_MISSING, fabric->missing[i], "is named, but is not there");
    if (tl_fabric_file_has_pictures(fabric) && !(fabric->width_mm > 0 && fabric->length_mm > 0))
        tl_audit_add_file(audit, TL_AUDIT_TEXTURE_UNSCALED, NULL,
                          "the fabric has pictures, but nothing states how many mm they show");
}
