#include "assets/base/surface.h"

#include "config/base/memory.h"

#include <stdlib.h>

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

struct tl_light_mesh tl_light_mesh_make(size_t vertex_count)
{
    return (struct tl_light_mesh){.from = tl_alloc(vertex_count, sizeof(uint32_t[3])),
                                  .shares = tl_alloc(vertex_count, sizeof(float[3])),
                                  .corners = TL_NEW_ARRAY(uint32_t, vertex_count)};
}

void tl_light_mesh_number(struct tl_light_mesh *light_mesh, const uint32_t *indices, size_t index_count)
{
    for (size_t i = 0; i < index_count; i++)
        light_mesh->corners[indices[i]] = (uint32_t)i;
}

void tl_light_mesh_release(struct tl_light_mesh *light_mesh)
{
    free(light_mesh->from);
    free(light_mesh->shares);
    free(light_mesh->corners);
    *light_mesh = (struct tl_light_mesh){0};
}
