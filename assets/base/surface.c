#include "assets/base/surface.h"

tl_surface tl_surface_of_mesh(const char *name, const tl_mesh *mesh, const tl_material *materials)
{
    return (tl_surface){
        .name = name,
        .vertex_count = mesh->vertex_count,
        .positions = mesh->positions,
        .normals = mesh->normals,
        .tangents = mesh->tangents,
        .uvs = mesh->uvs,
        .index_count = mesh->index_count,
        .indices = mesh->indices,
        .part_count = mesh->part_count,
        .parts = mesh->parts,
        .materials = materials,
    };
}
