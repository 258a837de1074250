#include "assets/base/mesh.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

void tl_mesh_release(tl_mesh *mesh)
{
    free(mesh->positions);
    free(mesh->normals);
    free(mesh->uvs);
    free(mesh->tangents);
    free(mesh->indices);
    free(mesh->parts);
    *mesh = (tl_mesh){0};
}

static double uv_area(vec2s a, vec2s b, vec2s c)
{
    return 0.5 * fabs((double)(b.x - a.x) * (double)(c.y - a.y) - (double)(c.x - a.x) * (double)(b.y - a.y));
}

void tl_mesh_measure_uvs(tl_mesh *mesh)
{
    for (size_t p = 0; p < mesh->part_count; p++) {
        struct tl_mesh_part *part = &mesh->parts[p];
        double space = 0, texture = 0;
        for (uint32_t i = 0; i + 2 < part->index_count; i += 3) {
            const uint32_t *v = &mesh->indices[part->first_index + i];
            vec3s side = glms_vec3_sub(mesh->positions[v[1]], mesh->positions[v[0]]);
            vec3s other = glms_vec3_sub(mesh->positions[v[2]], mesh->positions[v[0]]);
            space += 0.5 * (double)glms_vec3_norm(glms_vec3_cross(side, other));
            texture += uv_area(mesh->uvs[v[0]], mesh->uvs[v[1]], mesh->uvs[v[2]]);
        }
        /* UVs of less than a millionth of a texel of an 8k map are degenerate. */
        const double degenerate = 1e-14;
        part->uv_metres = texture > degenerate ? (float)sqrt(space / texture) : 0;
    }
}

struct tl_box tl_box_of(const vec3s *positions, size_t count)
{
    if (count == 0)
        return (struct tl_box){0};
    struct tl_box box = {positions[0], positions[0]};
    for (size_t i = 1; i < count; i++) {
        box.lower = glms_vec3_minv(box.lower, positions[i]);
        box.upper = glms_vec3_maxv(box.upper, positions[i]);
    }
    return box;
}

struct tl_box tl_box_of_both(struct tl_box a, struct tl_box b)
{
    return (struct tl_box){glms_vec3_minv(a.lower, b.lower), glms_vec3_maxv(a.upper, b.upper)};
}
