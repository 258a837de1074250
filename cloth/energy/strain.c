#include "cloth/energy/strain.h"

#include "cloth/energy/energy.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct triangle {
    uint32_t vertices[3];
    double weft[2],
        warp[2]; /* 1/m: F_u = weft[0] side + weft[1] other, and F_v likewise; sides leave the first corner */
    double area; /* m^2, at rest; 0: a sliver */
};

struct tl_strains {
    size_t vertex_count, triangle_count;
    struct triangle *triangles;
    struct tl_fans fans; /* triangles around vertices */
    vec3d *of_triangles; /* [triangle_count]: warp, weft, shear */
};

/* Coefficients of F = [sides] [rest sides]^-1. */
static struct triangle make_triangle(const tl_garment *garment, size_t number)
{
    vec2s rest[3];
    struct triangle triangle = {0};
    memcpy(triangle.vertices, &garment->model.mesh.indices[3 * number], sizeof triangle.vertices);
    tl_rest_shape(garment, number, rest);
    if (tl_rest_is_sliver(rest))
        return triangle;
    double side[2], other[2];
    for (int c = 0; c < 2; c++) {
        side[c] = (double)rest[1].raw[c] - (double)rest[0].raw[c];
        other[c] = (double)rest[2].raw[c] - (double)rest[0].raw[c];
    }
    double determinant = side[0] * other[1] - side[1] * other[0];
    triangle.area = 0.5 * fabs(determinant);
    triangle.weft[0] = other[1] / determinant, triangle.weft[1] = -side[1] / determinant;
    triangle.warp[0] = -other[0] / determinant, triangle.warp[1] = side[0] / determinant;
    return triangle;
}

tl_strains *tl_strains_create(const tl_garment *garment)
{
    const tl_mesh *mesh = &garment->model.mesh;
    tl_strains *strains = TL_NEW(tl_strains);
    strains->vertex_count = mesh->vertex_count;
    strains->triangle_count = mesh->index_count / 3;
    strains->triangles = TL_NEW_ARRAY(struct triangle, strains->triangle_count);
    strains->of_triangles = TL_NEW_ARRAY(vec3d, strains->triangle_count);
    for (size_t i = 0; i < strains->triangle_count; i++)
        strains->triangles[i] = make_triangle(garment, i);
    strains->fans = tl_fans_build(mesh->indices, 3 * strains->triangle_count, mesh->vertex_count);
    return strains;
}

void tl_strains_destroy(tl_strains **strains)
{
    if (!*strains)
        return;
    tl_fans_release(&(*strains)->fans);
    free((*strains)->triangles);
    free((*strains)->of_triangles);
    free(*strains);
    *strains = NULL;
}

static vec3d strain_of(const struct triangle *triangle, const vec3s *positions)
{
    vec3d origin = vec3d_from(positions[triangle->vertices[0]]);
    vec3d side = vec3d_sub(vec3d_from(positions[triangle->vertices[1]]), origin);
    vec3d other = vec3d_sub(vec3d_from(positions[triangle->vertices[2]]), origin);
    vec3d along_u = vec3d_muladd(vec3d_scale(side, triangle->weft[0]), other, triangle->weft[1]);
    vec3d along_v = vec3d_muladd(vec3d_scale(side, triangle->warp[0]), other, triangle->warp[1]);
    double u = vec3d_norm(along_u), v = vec3d_norm(along_v);
    return (vec3d){v - 1, u - 1, u > 0 && v > 0 ? vec3d_dot(along_u, along_v) / (u * v) : 0};
}

static vec3s mean_about(const tl_strains *strains, size_t vertex)
{
    vec3d sum = {0};
    double area = 0;
    for (uint32_t k = strains->fans.first[vertex]; k < strains->fans.first[vertex + 1]; k++) {
        uint32_t t = strains->fans.items[k] / 3;
        sum = vec3d_muladd(sum, strains->of_triangles[t], strains->triangles[t].area);
        area += strains->triangles[t].area;
    }
    return area > 0 ? vec3d_to_float(vec3d_scale(sum, 1 / area)) : (vec3s){{0, 0, 0}};
}

void tl_strains_update(tl_strains *strains, const vec3s *positions, vec3s *out)
{
#pragma omp parallel for
    for (size_t t = 0; t < strains->triangle_count; t++)
        strains->of_triangles[t] =
            strains->triangles[t].area > 0 ? strain_of(&strains->triangles[t], positions) : (vec3d){0};
#pragma omp parallel for
    for (size_t i = 0; i < strains->vertex_count; i++)
        out[i] = mean_about(strains, i);
}

struct tl_triangle_strain tl_strains_of_triangle(const tl_strains *strains, size_t triangle)
{
    vec3d strain = strains->of_triangles[triangle];
    return (struct tl_triangle_strain){strain.x, strain.y, strain.z, strains->triangles[triangle].area};
}
