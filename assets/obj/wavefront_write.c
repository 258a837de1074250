#include "assets/obj/wavefront.h"
#include "config/base/memory.h"

#include <locale.h>
#include <stdlib.h>

static void write_faces(FILE *stream, const tl_model *model, const tl_surface *surface)
{
    for (size_t p = 0; p < surface->part_count; p++) {
        const struct tl_mesh_part *part = &surface->parts[p];
        fprintf(stream, "g part%zu\nusemtl %s\n", p, surface->materials[part->material].name);
        for (uint32_t i = 0; i < part->index_count; i++) {
            uint32_t vertex = surface->indices[part->first_index + i];
            uint32_t point = model->points ? model->points[vertex] : vertex;
            fprintf(stream, "%s %u/%u/%u", i % 3 == 0 ? "f" : "", point + 1, vertex + 1, vertex + 1);
            if (i % 3 == 2)
                fputc('\n', stream);
        }
    }
}

static void write_object(FILE *stream, const tl_model *model, const tl_surface *surface)
{
    size_t point_count = tl_model_point_count(model);
    vec3s *points = TL_NEW_ARRAY(vec3s, point_count);
    tl_model_points(model, surface->positions, points);
    fprintf(stream, "# toile: %s\n", model->name);
    for (size_t i = 0; i < point_count; i++) /* nine digits give the same float back */
        fprintf(stream, "v %.9g %.9g %.9g\n", (double)points[i].x, (double)points[i].y, (double)points[i].z);
    for (size_t i = 0; i < surface->vertex_count; i++)
        fprintf(stream, "vt %.9g %.9g\n", (double)surface->uvs[i].x, 1 - (double)surface->uvs[i].y);
    for (size_t i = 0; i < surface->vertex_count; i++) {
        const vec3s *n = &surface->normals[i];
        fprintf(stream, "vn %.6g %.6g %.6g\n", (double)n->x, (double)n->y, (double)n->z);
    }
    write_faces(stream, model, surface);
    free(points);
}

void wave_write(FILE *stream, const tl_model *model, const tl_surface *surface)
{
    locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0), before = uselocale(plain);
    write_object(stream, model, surface);
    uselocale(before);
    freelocale(plain);
}
