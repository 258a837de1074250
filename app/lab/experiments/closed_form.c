#include "app/lab/experiments/closed_form.h"

#include "config/base/memory.h"

#include <math.h>
#include <string.h>

static tl_garment make_empty(size_t vertex_count, size_t triangle_count)
{
    tl_garment garment = {0};
    tl_mesh *mesh = &garment.model.mesh;
    mesh->vertex_count = vertex_count;
    mesh->index_count = 3 * triangle_count;
    mesh->positions = TL_NEW_ARRAY(vec3s, vertex_count);
    mesh->normals = TL_NEW_ARRAY(vec3s, vertex_count);
    mesh->uvs = TL_NEW_ARRAY(vec2s, vertex_count);
    mesh->indices = TL_NEW_ARRAY(uint32_t, mesh->index_count);
    garment.pattern = TL_NEW_ARRAY(vec2s, vertex_count);
    return garment;
}

/* Rows of `columns` cells, each cut along one diagonal; vertices row by row. */
static void fill_cells(tl_mesh *mesh, int columns, int rows)
{
    uint32_t *index = mesh->indices, stride = (uint32_t)columns + 1;
    for (uint32_t row = 0; row < (uint32_t)rows; row++)
        for (uint32_t column = 0; column < (uint32_t)columns; column++) {
            uint32_t a = row * stride + column, below = a + stride;
            const uint32_t corners[6] = {a, below, below + 1, a, below + 1, a + 1};
            memcpy(index, corners, sizeof corners);
            index += TL_COUNT(corners);
        }
}

static void place(tl_garment *garment, size_t vertex, vec3s position, double u, double v)
{
    garment->model.mesh.positions[vertex] = position;
    garment->model.mesh.normals[vertex] = (vec3s){{0, 0, 1}};
    garment->model.mesh.uvs[vertex] = (vec2s){{(float)u, (float)v}};
    garment->pattern[vertex] = (vec2s){{(float)u, (float)-v}};
}

tl_garment tl_sheet_make(int side, enum tl_sheet_hold hold, bool lies)
{
    size_t across = (size_t)side;
    tl_garment garment = make_empty(across * across, 2 * (across - 1) * (across - 1));
    fill_cells(&garment.model.mesh, side - 1, side - 1);
    for (size_t i = 0; i < across * across; i++) {
        size_t column = i % across, row = i / across;
        double u = (double)column / (double)(across - 1), v = (double)row / (double)(across - 1);
        vec3s at = lies ? (vec3s){{(float)u, 0, (float)v}} : (vec3s){{(float)u, (float)-v, 0}};
        place(&garment, i, at, u, v);
    }
    garment.pins = TL_NEW_ARRAY(uint32_t, across);
    for (size_t i = 0; i < across && hold != TL_SHEET_FREE; i++)
        if (hold == TL_SHEET_EDGE || i == 0 || i == across - 1)
            garment.pins[garment.pin_count++] = (uint32_t)i;
    return garment;
}

tl_garment tl_strip_make(double length_m, int columns, bool is_warp)
{
    enum { ROWS = 2 };
    const size_t across = (size_t)columns + 1;
    const double cell = length_m / (columns - 0.5);
    tl_garment garment = make_empty(across * (ROWS + 1), 2 * (size_t)columns * ROWS);
    fill_cells(&garment.model.mesh, columns, ROWS);
    garment.pins = TL_NEW_ARRAY(uint32_t, 2 * (ROWS + 1));
    for (size_t i = 0; i < across * (ROWS + 1); i++) {
        const size_t column = i % across;
        const double along = cell * (double)column, beside = cell * (double)(i / across);
        const vec3s at = {{(float)(along - cell / 2), 1, (float)beside}};
        place(&garment, i, at, is_warp ? beside : along, is_warp ? along : beside);
        if (column < 2)
            garment.pins[garment.pin_count++] = (uint32_t)i;
    }
    return garment;
}

/* ---- The tube ---- */

double tl_tube_row_height(const struct tl_tube *tube, int row)
{
    int small = tube->row_count / 2;
    double units = small / tube->mass_ratio + (tube->row_count - small);
    return tube->height_m / units / (row < small ? tube->mass_ratio : 1);
}

double tl_tube_width(const struct tl_tube *tube)
{
    return sqrt(tl_tube_row_height(tube, 0) * tl_tube_row_height(tube, tube->row_count - 1));
}

void tl_tube_sink(const struct tl_tube *tube, const struct tl_cloth_fabric *fabric, double gravity,
                  double *out)
{
    /* A row's tension carries what its lower vertices weigh, who share the cells above and below them. */
    double below = tube->height_m;
    out[0] = 0;
    for (int row = 0; row < tube->row_count; row++) {
        double height = tl_tube_row_height(tube, row);
        double carried = below - height / 2; /* metres of tube */
        out[row + 1] = out[row] + height * fabric->areal_density * gravity * carried / fabric->stretch_warp;
        below -= height;
    }
}

double tl_tube_slack(const struct tl_tube *tube, const struct tl_cloth_fabric *fabric, double gravity,
                     double h)
{
    double width = tl_tube_width(tube), below = tube->height_m, slack = 0;
    double mean = tube->height_m * width / (tube->row_count + 1);
    for (int row = 1; row <= tube->row_count; row++) {
        double above = tl_tube_row_height(tube, row - 1) / 2;
        double under = row < tube->row_count ? tl_tube_row_height(tube, row) / 2 : 0;
        double area = fmax(width * (above + under), TL_CLOTH_MIN_MASS * mean);
        double tension = fabric->areal_density * fabs(gravity) * width * (below - above);
        slack += fmin(h * h * tension / (fabric->areal_density * area),
                      TL_CLOTH_MAX_STRAIN * hypot(width, 2 * above));
        below -= 2 * above;
    }
    return slack;
}

/* -1 to 1, by a hash of the vertex and the axis. */
static float noise(size_t vertex, uint32_t axis)
{
    uint32_t bits = (uint32_t)vertex * 3 + axis;
    bits = (bits ^ bits >> 16) * 0x7feb352du;
    bits = (bits ^ bits >> 15) * 0x846ca68bu;
    return (float)(bits >> 8 & 0xffff) / 32767.5f - 1;
}

tl_garment tl_tube_make(const struct tl_tube *tube, const double *sink, double scramble)
{
    size_t columns = (size_t)tube->columns, rows = (size_t)tube->row_count;
    tl_garment garment = make_empty((columns + 1) * (rows + 1), 2 * columns * rows);
    double width = tl_tube_width(tube), radius = width / (2 * sin(M_PI / tube->columns)), depth = 0;
    fill_cells(&garment.model.mesh, tube->columns, tube->row_count);
    for (size_t row = 0; row <= rows; row++) {
        double below = tl_tube_row_height(tube, (int)(row < rows ? row : rows - 1));
        double above = tl_tube_row_height(tube, (int)(row > 0 ? row - 1 : 0));
        float reach = (float)(row > 0 ? scramble * fmin(width, fmin(above, below)) : 0);
        for (size_t column = 0; column <= columns; column++) {
            size_t i = row * (columns + 1) + column, alike = row * (columns + 1) + column % columns;
            double angle = 2 * M_PI * (double)(column % columns) / tube->columns;
            vec3s at = {{(float)(radius * cos(angle)), (float)-(depth + (sink ? sink[row] : 0)),
                         (float)(-radius * sin(angle))}};
            vec3s shift = {{noise(alike, 0), noise(alike, 1), noise(alike, 2)}};
            place(&garment, i, glms_vec3_add(at, glms_vec3_scale(shift, reach)), width * (double)column,
                  depth);
        }
        depth += below;
    }
    garment.pins = TL_NEW_ARRAY(uint32_t, columns + 1);
    for (size_t i = 0; i <= columns; i++)
        garment.pins[garment.pin_count++] = (uint32_t)i;
    return garment;
}

/* ---- The triangle ---- */

double tl_triangle_sink(const struct tl_cloth_fabric *fabric, double gravity)
{
    return fabric->areal_density * gravity / (3 * fabric->stretch_warp);
}

tl_garment tl_triangle_make(double sink, double scramble)
{
    tl_garment garment = make_empty(3, 1);
    const uint32_t corners[3] = {0, 2, 1};
    memcpy(garment.model.mesh.indices, corners, sizeof corners);
    place(&garment, 0, (vec3s){{0, 0, 0}}, 0, 0);
    place(&garment, 1, (vec3s){{1, 0, 0}}, 1, 0);
    vec3s shift = {{noise(2, 0), noise(2, 1), noise(2, 2)}};
    vec3s lowest = glms_vec3_scale(shift, (float)scramble);
    lowest.x += 0.5f;
    lowest.y -= (float)(1 + sink);
    place(&garment, 2, lowest, 0.5, 1);
    garment.pins = TL_NEW_ARRAY(uint32_t, 2);
    garment.pins[1] = 1;
    garment.pin_count = 2;
    return garment;
}
