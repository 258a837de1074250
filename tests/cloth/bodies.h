/* Closed bodies for tests. */
#ifndef TOILE_TESTS_CLOTH_BODIES_H
#define TOILE_TESTS_CLOTH_BODIES_H

#include "assets/base/mesh.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A sphere of latitude and longitude rings. Vertices at the seam and the poles are duplicated, as in files.
 */
static inline tl_mesh body_sphere(vec3s centre, double radius, int rings)
{
    int sides = 2 * rings;
    tl_mesh mesh = {.vertex_count = (size_t)(rings + 1) * (size_t)(sides + 1)};
    mesh.positions = TL_NEW_ARRAY(vec3s, mesh.vertex_count);
    mesh.indices = TL_NEW_ARRAY(uint32_t, (size_t)rings * (size_t)sides * 6);
    for (int ring = 0; ring <= rings; ring++)
        for (int side = 0; side <= sides; side++) {
            /* the last column repeats the first, so that it welds bit by bit */
            double polar = M_PI * ring / rings, turn = 2 * M_PI * (side % sides) / sides;
            double wide = ring == 0 || ring == rings ? 0 : radius * sin(polar);
            mesh.positions[ring * (sides + 1) + side] =
                (vec3s){{(float)(centre.x + wide * cos(turn)), (float)(centre.y + radius * cos(polar)),
                         (float)(centre.z - wide * sin(turn))}};
        }
    for (int ring = 0; ring < rings; ring++)
        for (int side = 0; side < sides; side++) {
            uint32_t a = (uint32_t)(ring * (sides + 1) + side), b = a + 1;
            uint32_t d = a + (uint32_t)sides + 1, c = d + 1;
            const uint32_t corners[6] = {a, d, c, a, c, b};
            memcpy(mesh.indices + mesh.index_count, corners, sizeof corners);
            mesh.index_count += 6;
        }
    return mesh;
}

/* A box of twelve triangles about a centre, turned by `turn` about z. */
static inline tl_mesh body_box(vec3s centre, vec3s half, double turn)
{
    tl_mesh mesh = {.vertex_count = 8, .index_count = 36};
    mesh.positions = TL_NEW_ARRAY(vec3s, 8);
    mesh.indices = TL_NEW_ARRAY(uint32_t, 36);
    for (int i = 0; i < 8; i++) {
        double x = (i & 1 ? 1 : -1) * (double)half.x, y = (i & 2 ? 1 : -1) * (double)half.y;
        mesh.positions[i] = (vec3s){{(float)((double)centre.x + cos(turn) * x - sin(turn) * y),
                                     (float)((double)centre.y + sin(turn) * x + cos(turn) * y),
                                     centre.z + (i & 4 ? 1.0f : -1.0f) * half.z}};
    }
    const uint32_t corners[36] = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                  2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
    memcpy(mesh.indices, corners, sizeof corners);
    return mesh;
}

/* A cylinder about the z axis from `near` to `far`, closed by two fans. */
static inline tl_mesh body_cylinder(double radius, double near, double far, int sides)
{
    tl_mesh mesh = {.vertex_count = 2 * (size_t)sides + 2};
    mesh.positions = TL_NEW_ARRAY(vec3s, mesh.vertex_count);
    mesh.indices = TL_NEW_ARRAY(uint32_t, 12 * (size_t)sides);
    uint32_t near_middle = 2 * (uint32_t)sides, far_middle = near_middle + 1;
    for (int i = 0; i < sides; i++)
        for (int end = 0; end < 2; end++) {
            double turn = 2 * M_PI * i / sides;
            mesh.positions[2 * i + end] = (vec3s){
                {(float)(radius * cos(turn)), (float)(radius * sin(turn)), (float)(end ? far : near)}};
        }
    mesh.positions[near_middle] = (vec3s){{0, 0, (float)near}};
    mesh.positions[far_middle] = (vec3s){{0, 0, (float)far}};
    for (int i = 0; i < sides; i++) {
        uint32_t a = 2 * (uint32_t)i, b = 2 * (uint32_t)((i + 1) % sides);
        const uint32_t corners[12] = {a,           b, b + 1, a,          b + 1, a + 1,
                                      near_middle, b, a,     far_middle, a + 1, b + 1};
        memcpy(mesh.indices + mesh.index_count, corners, sizeof corners);
        mesh.index_count += 12;
    }
    return mesh;
}

#endif
