#include "assets/body/form.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

/* The figure's mesh: surface nets [Gibson 1998] of its distance function. Each cell of a grid that the
 * surface passes through gets one vertex, each edge of the grid that it passes through a quad of the four
 * cells around it. Vertices are then moved onto the surface. */
#define CELL_M 0.014
enum { CELLS_X = 64, CELLS_Y = 124, CELLS_Z = 28, BLOCK = 4 };
enum { NODES_X = CELLS_X + 1, NODES_Y = CELLS_Y + 1, NODES_Z = CELLS_Z + 1 };
#define ORIGIN_Y (-0.021)
#define ORIGIN_Z (-0.187)

static size_t node_index(int x, int y, int z)
{
    return ((size_t)y * NODES_Z + (size_t)z) * NODES_X + (size_t)x;
}

static void node_position(double x, double y, double z, double position[3])
{
    position[0] = (x - 0.5 * CELLS_X) * CELL_M;
    position[1] = ORIGIN_Y + y * CELL_M;
    position[2] = ORIGIN_Z + z * CELL_M;
}

static double node_distance(double x, double y, double z)
{
    double position[3];
    node_position(x, y, z, position);
    return tl_figure_distance(position);
}

/* The distance at every node; where a block of cells is far from the surface, that at its middle. */
static double *sample_nodes(void)
{
    const double far = 2 * 0.5 * sqrt(3) * BLOCK * CELL_M; /* twice a block's radius: distances are rough */
    double *distance = TL_NEW_ARRAY(double, (size_t)NODES_X *NODES_Y *NODES_Z);
    for (int by = 0; by < NODES_Y; by += BLOCK)
        for (int bz = 0; bz < NODES_Z; bz += BLOCK)
            for (int bx = 0; bx < NODES_X; bx += BLOCK) {
                const double half = 0.5 * (BLOCK - 1);
                double middle = node_distance(bx + half, by + half, bz + half);
                for (int y = by; y < by + BLOCK && y < NODES_Y; y++)
                    for (int z = bz; z < bz + BLOCK && z < NODES_Z; z++)
                        for (int x = bx; x < bx + BLOCK && x < NODES_X; x++)
                            distance[node_index(x, y, z)] =
                                fabs(middle) > far ? middle : node_distance(x, y, z);
            }
    return distance;
}

/* Takes one more corner inside where only the diagonal corners of a square of nodes are, as the net would
 * touch itself. Happens where a limb's ridge just passes a plane of nodes. */
static void join_diagonals(double *distance)
{
    bool changed = true;
    while (changed) {
        changed = false;
        for (int y = 0; y < CELLS_Y; y++)
            for (int z = 0; z < CELLS_Z; z++)
                for (int x = 0; x < CELLS_X; x++)
                    for (int axis = 0; axis < 3; axis++) {
                        double *corner[4];
                        for (int i = 0; i < 4; i++) {
                            int node[3] = {x, y, z};
                            node[(axis + 1) % 3] += i & 1;
                            node[(axis + 2) % 3] += i >> 1;
                            corner[i] = &distance[node_index(node[0], node[1], node[2])];
                        }
                        bool first = *corner[0] < 0, second = *corner[1] < 0;
                        if (first == second || first != (*corner[3] < 0) || second != (*corner[2] < 0))
                            continue;
                        *corner[first ? 1 : 0] = -1e-6;
                        changed = true;
                    }
    }
}

static void find_gradient(const double p[3], double distance, double gradient[3])
{
    const double step = 1e-5;
    for (int k = 0; k < 3; k++) {
        double q[3] = {p[0], p[1], p[2]};
        q[k] += step;
        gradient[k] = (tl_figure_distance(q) - distance) / step;
    }
}

/* Newton's steps along the gradient; `normal` is its direction at the end. */
static void project(double p[3], double normal[3])
{
    enum { STEPS = 3 };
    for (int step = 0; step <= STEPS; step++) {
        double distance = tl_figure_distance(p), norm2 = 0;
        find_gradient(p, distance, normal);
        for (int k = 0; k < 3; k++)
            norm2 += normal[k] * normal[k];
        for (int k = 0; k < 3; k++) {
            p[k] -= step < STEPS ? distance * normal[k] / norm2 : 0;
            normal[k] /= sqrt(norm2);
        }
    }
}

/* The mean of the points where the surface passes through the cell's edges; false when it passes none. */
static bool cell_point(const double *distance, int x, int y, int z, double point[3])
{
    int count = 0;
    double sum[3] = {0};
    for (int edge = 0; edge < 12; edge++) {
        int axis = edge / 4, u = edge % 2, v = edge / 2 % 2, a[3] = {x, y, z}, b[3];
        a[(axis + 1) % 3] += u;
        a[(axis + 2) % 3] += v;
        for (int k = 0; k < 3; k++)
            b[k] = a[k] + (k == axis);
        double from = distance[node_index(a[0], a[1], a[2])], to = distance[node_index(b[0], b[1], b[2])];
        if ((from < 0) == (to < 0))
            continue;
        for (int k = 0; k < 3; k++)
            sum[k] += a[k] + (k == axis ? from / (from - to) : 0);
        count++;
    }
    if (count)
        node_position(sum[0] / count, sum[1] / count, sum[2] / count, point);
    return count > 0;
}

/* One vertex a cell that the surface passes through; vertex[node_index of the cell's lower corner]. */
static void fill_vertices(const double *distance, uint32_t *vertex, tl_mesh *mesh)
{
    size_t room = 0;
    for (int y = 0; y < CELLS_Y; y++)
        for (int z = 0; z < CELLS_Z; z++)
            for (int x = 0; x < CELLS_X; x++) {
                double p[3], n[3];
                if (!cell_point(distance, x, y, z, p))
                    continue;
                if (mesh->vertex_count == room) {
                    room = room ? 2 * room : 4096;
                    mesh->positions = tl_resize(mesh->positions, room, sizeof *mesh->positions);
                    mesh->normals = tl_resize(mesh->normals, room, sizeof *mesh->normals);
                }
                project(p, n);
                vertex[node_index(x, y, z)] = (uint32_t)mesh->vertex_count;
                mesh->positions[mesh->vertex_count] = (vec3s){{(float)p[0], (float)p[1], (float)p[2]}};
                mesh->normals[mesh->vertex_count++] = (vec3s){{(float)n[0], (float)n[1], (float)n[2]}};
            }
}

/* The four cells around a grid edge along `axis`, in counter-clockwise order seen from its end. The quad is
 * cut along its shorter diagonal. */
static void add_quad(const uint32_t *vertex, const int node[3], int axis, bool outwards, tl_mesh *mesh)
{
    static const int around[4][2] = {{-1, -1}, {0, -1}, {0, 0}, {-1, 0}};
    uint32_t corner[4];
    for (int i = 0; i < 4; i++) {
        int cell[3] = {node[0], node[1], node[2]};
        cell[(axis + 1) % 3] += around[i][0];
        cell[(axis + 2) % 3] += around[i][1];
        corner[outwards ? i : 3 - i] = vertex[node_index(cell[0], cell[1], cell[2])];
    }
    const vec3s *p = mesh->positions;
    bool other =
        glms_vec3_distance2(p[corner[1]], p[corner[3]]) < glms_vec3_distance2(p[corner[0]], p[corner[2]]);
    const int cuts[2][6] = {{0, 1, 2, 0, 2, 3}, {0, 1, 3, 1, 2, 3}};
    for (int i = 0; i < 6; i++)
        mesh->indices[mesh->index_count++] = corner[cuts[other][i]];
}

static void fill_quads(const double *distance, const uint32_t *vertex, tl_mesh *mesh)
{
    size_t room = 0;
    for (int y = 1; y < CELLS_Y; y++)
        for (int z = 1; z < CELLS_Z; z++)
            for (int x = 1; x < CELLS_X; x++)
                for (int axis = 0; axis < 3; axis++) {
                    const int a[3] = {x, y, z}, b[3] = {x + (axis == 0), y + (axis == 1), z + (axis == 2)};
                    bool from = distance[node_index(a[0], a[1], a[2])] < 0;
                    bool to = distance[node_index(b[0], b[1], b[2])] < 0;
                    if (from == to)
                        continue;
                    if (mesh->index_count + 6 > room) {
                        room = room ? 2 * room : 65536;
                        mesh->indices = tl_resize(mesh->indices, room, sizeof *mesh->indices);
                    }
                    add_quad(vertex, a, axis, from, mesh);
                }
}

tl_avatar tl_avatar_figure(void)
{
    double *distance = sample_nodes();
    join_diagonals(distance);
    uint32_t *vertex = TL_NEW_ARRAY(uint32_t, (size_t)NODES_X * NODES_Y * NODES_Z);
    tl_mesh mesh = {.part_count = 1};
    fill_vertices(distance, vertex, &mesh);
    fill_quads(distance, vertex, &mesh);
    free(vertex);
    free(distance);
    mesh.uvs = TL_NEW_ARRAY(vec2s, mesh.vertex_count);
    for (size_t v = 0; v < mesh.vertex_count; v++)
        mesh.uvs[v] = (vec2s){{mesh.positions[v].x, -mesh.positions[v].y}};
    mesh.parts = TL_NEW(struct tl_mesh_part);
    mesh.parts[0] = (struct tl_mesh_part){.index_count = (uint32_t)mesh.index_count};
    tl_mesh_measure_uvs(&mesh);
    tl_material *canvas = TL_NEW(tl_material);
    *canvas = tl_form_canvas();
    return (tl_avatar){
        .model = {.name = tl_copy_string("figure"), .mesh = mesh, .material_count = 1, .materials = canvas}};
}
