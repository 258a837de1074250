#include "cloth/solvers/implicit/stiffness.h"

#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Shorter than this a vector has no direction. */
#define NO_LENGTH 1e-12
#define CORNERS   3 /* of a membrane; a link repeats its second end */

/* Second derivatives of an element's energy by F_u and F_v. The block of its vertices i and j is
 * c_i c_j uu + d_i d_j vv + c_i d_j uv + d_i c_j uv^T. */
struct tl_element_stiffness {
    double c[CORNERS], d[CORNERS];
    double uu[9], vv[9], uv[9];
};

/* ---- Patterns ---- */

static int compare_numbers(const void *a, const void *b)
{
    uint32_t left = *(const uint32_t *)a, right = *(const uint32_t *)b;
    return (left > right) - (left < right);
}

/* All vertices that share an element with a vertex, itself among them, rising. */
static size_t list_row(const struct tl_fans *fans, const uint32_t *corners, size_t per_element, size_t vertex,
                       uint32_t *out)
{
    size_t count = 0, kept = 1;
    out[count++] = (uint32_t)vertex;
    for (uint32_t item = fans->first[vertex]; item < fans->first[vertex + 1]; item++) {
        const uint32_t *element = corners + fans->items[item] / per_element * per_element;
        memcpy(out + count, element, per_element * sizeof *out);
        count += per_element;
    }
    qsort(out, count, sizeof *out, compare_numbers);
    for (size_t i = 1; i < count; i++)
        if (out[i] != out[kept - 1])
            out[kept++] = out[i];
    return kept;
}

static uint32_t find_entry(const struct tl_sparse_rows *rows, size_t vertex, uint32_t column)
{
    uint32_t low = rows->first[vertex], high = rows->first[vertex + 1];
    while (low + 1 < high) {
        uint32_t middle = (low + high) / 2;
        if (rows->columns[middle] <= column)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static struct tl_sparse_rows make_rows(const struct tl_fans *fans, const uint32_t *corners,
                                       size_t per_element, size_t corner_count, size_t vertex_count)
{
    size_t most = vertex_count + per_element * corner_count, used = 0;
    struct tl_sparse_rows rows = {TL_NEW_ARRAY(uint32_t, vertex_count + 1), TL_NEW_ARRAY(uint32_t, most)};
    for (size_t v = 0; v < vertex_count; v++) {
        used += list_row(fans, corners, per_element, v, rows.columns + used);
        rows.first[v + 1] = (uint32_t)used;
    }
    rows.columns = tl_resize(rows.columns, used, sizeof *rows.columns);
    return rows;
}

/* Elements of empty lanes have the vertex one past the last, which has no row. */
static struct tl_gather make_gather(const uint32_t *corners, size_t per_element, size_t element_count,
                                    size_t vertex_count, struct tl_sparse_rows *rows)
{
    size_t corner_count = element_count * per_element;
    struct tl_gather gather = {.fans = tl_fans_build(corners, corner_count, vertex_count + 1)};
    *rows = make_rows(&gather.fans, corners, per_element, corner_count, vertex_count);
    gather.slots = TL_NEW_ARRAY(uint32_t, corner_count * per_element);
    for (size_t v = 0; v < vertex_count; v++)
        for (uint32_t item = gather.fans.first[v]; item < gather.fans.first[v + 1]; item++) {
            const uint32_t *element = corners + gather.fans.items[item] / per_element * per_element;
            for (size_t k = 0; k < per_element; k++)
                gather.slots[(size_t)item * per_element + k] = find_entry(rows, v, element[k]);
        }
    return gather;
}

static void release_gather(struct tl_gather *gather)
{
    tl_fans_release(&gather->fans);
    free(gather->slots);
}

static uint32_t *list_corners(const struct tl_energy *energy, const struct tl_springs *springs,
                              size_t *element_count)
{
    size_t lanes = energy->membrane_count * TL_BATCH, count = lanes + energy->link_count + springs->count;
    uint32_t *corners = TL_NEW_ARRAY(uint32_t, CORNERS * count);
    for (size_t i = 0; i < lanes; i++)
        for (int k = 0; k < CORNERS; k++)
            corners[CORNERS * i + (size_t)k] = energy->membranes[i / TL_BATCH].vertices[k][i % TL_BATCH];
    for (size_t i = lanes; i < count; i++) {
        size_t link = i - lanes;
        const struct tl_link *from =
            link < energy->link_count ? &energy->links[link] : &springs->links[link - energy->link_count];
        corners[CORNERS * i] = from->a;
        corners[CORNERS * i + 1] = corners[CORNERS * i + 2] = from->b;
    }
    *element_count = count;
    return corners;
}

/* ---- Bending ---- */

static void gather_bends(const struct tl_gather *gather, const struct tl_energy *energy,
                         const struct tl_cloth_fabric *fabric, size_t vertex_count, double *values)
{
    const double stiffness[3] = {fabric->bend_weft, fabric->bend_warp,
                                 sqrt(fabric->bend_weft * fabric->bend_warp)};
    for (size_t v = 0; v < vertex_count; v++)
        for (uint32_t item = gather->fans.first[v]; item < gather->fans.first[v + 1]; item++) {
            uint32_t element = gather->fans.items[item] / TL_BEND_STENCIL;
            uint32_t corner = gather->fans.items[item] % TL_BEND_STENCIL, lane = element % TL_BATCH;
            const struct tl_bend *bend = &energy->bends[element / TL_BATCH];
            for (size_t k = 0; k < TL_BEND_STENCIL; k++)
                for (int row = 0; row < 3; row++)
                    values[gather->slots[(size_t)item * TL_BEND_STENCIL + k]] +=
                        stiffness[row] * bend->area[lane] * bend->rows[row][corner][lane] *
                        bend->rows[row][k][lane];
        }
}

static void build_bends(struct tl_stiffness *stiffness, const struct tl_energy *energy,
                        const struct tl_cloth_fabric *fabric)
{
    size_t count = energy->bend_count * TL_BATCH;
    uint32_t *corners = TL_NEW_ARRAY(uint32_t, TL_BEND_STENCIL * count);
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < TL_BEND_STENCIL; k++)
            corners[TL_BEND_STENCIL * i + (size_t)k] = energy->bends[i / TL_BATCH].vertices[k][i % TL_BATCH];
    struct tl_gather gather =
        make_gather(corners, TL_BEND_STENCIL, count, stiffness->vertex_count, &stiffness->bends);
    stiffness->bend_values = TL_NEW_ARRAY(double, stiffness->bends.first[stiffness->vertex_count]);
    gather_bends(&gather, energy, fabric, stiffness->vertex_count, stiffness->bend_values);
    release_gather(&gather);
    free(corners);
}

/* ---- The whole ---- */

struct tl_stiffness tl_stiffness_build(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                                       const struct tl_springs *springs, size_t vertex_count)
{
    struct tl_stiffness stiffness = {.vertex_count = vertex_count};
    uint32_t *corners = list_corners(energy, springs, &stiffness.element_count);
    stiffness.gather =
        make_gather(corners, CORNERS, stiffness.element_count, vertex_count, &stiffness.blocks);
    free(corners);
    stiffness.values = tl_alloc(stiffness.blocks.first[vertex_count], sizeof *stiffness.values);
    stiffness.elements = TL_NEW_ARRAY(struct tl_element_stiffness, stiffness.element_count);
    build_bends(&stiffness, energy, fabric);
    return stiffness;
}

static void release_rows(struct tl_sparse_rows *rows)
{
    free(rows->first);
    free(rows->columns);
}

void tl_stiffness_release(struct tl_stiffness *stiffness)
{
    release_rows(&stiffness->blocks);
    release_rows(&stiffness->bends);
    release_gather(&stiffness->gather);
    free(stiffness->values);
    free(stiffness->bend_values);
    free(stiffness->elements);
    *stiffness = (struct tl_stiffness){0};
}

/* ---- The current shape ---- */

static void add_outer(double out[9], vec3d a, vec3d b, double scale)
{
    const double left[3] = {a.x, a.y, a.z}, right[3] = {b.x, b.y, b.z};
    for (size_t i = 0; i < 3; i++)
        for (size_t j = 0; j < 3; j++)
            out[3 * i + j] += scale * left[i] * right[j];
}

/* k [ n n^T + across (I - n n^T) ] */
static void add_spring(double out[9], vec3d direction, double stiffness, double across)
{
    for (size_t i = 0; i < 3; i++)
        out[4 * i] += stiffness * across;
    add_outer(out, direction, direction, stiffness * (1 - across));
}

static void add_stretch(double out[9], vec3d f, double stiffness, double rest)
{
    double length = vec3d_norm(f);
    if (length > NO_LENGTH)
        add_spring(out, vec3d_scale(f, 1 / length), stiffness, fmax(1 - rest / length, 0));
    else
        add_spring(out, f, stiffness, 1);
}

static void add_shear(struct tl_element_stiffness *element_stiffness, vec3d u, vec3d v, double stiffness)
{
    double uu = vec3d_dot(u, u), vv = vec3d_dot(v, v);
    if (!(uu > NO_LENGTH * NO_LENGTH && vv > NO_LENGTH * NO_LENGTH))
        return;
    double both = 1 / sqrt(uu * vv), cosine = vec3d_dot(u, v) * both;
    vec3d along_u = vec3d_muladd(vec3d_scale(v, both), u, -cosine / uu);
    vec3d along_v = vec3d_muladd(vec3d_scale(u, both), v, -cosine / vv);
    add_outer(element_stiffness->uu, along_u, along_u, stiffness);
    add_outer(element_stiffness->vv, along_v, along_v, stiffness);
    add_outer(element_stiffness->uv, along_u, along_v, stiffness);
}

static struct tl_element_stiffness membrane_stiffness(const struct tl_membrane *m, size_t lane,
                                                      const struct tl_cloth_fabric *fabric, const vec3d *x)
{
    struct tl_element_stiffness element_stiffness = {0};
    vec3d u = {0}, v = {0};
    double area = m->area[lane];
    for (int i = 0; i < CORNERS && area > 0; i++) {
        element_stiffness.c[i] = m->c[i][lane];
        element_stiffness.d[i] = m->d[i][lane];
        u = vec3d_muladd(u, x[m->vertices[i][lane]], element_stiffness.c[i]);
        v = vec3d_muladd(v, x[m->vertices[i][lane]], element_stiffness.d[i]);
    }
    add_stretch(element_stiffness.uu, u, area * fabric->stretch_weft, 1);
    add_stretch(element_stiffness.vv, v, area * fabric->stretch_warp, 1);
    add_shear(&element_stiffness, u, v, area * fabric->shear);
    return element_stiffness;
}

static struct tl_element_stiffness link_stiffness(const struct tl_link *link, double stiffness,
                                                  const vec3d *x)
{
    struct tl_element_stiffness element_stiffness = {.c = {-1, 1, 0}};
    add_stretch(element_stiffness.uu, vec3d_sub(x[link->b], x[link->a]), stiffness, link->rest);
    return element_stiffness;
}

static void add_block(double out[9], const struct tl_element_stiffness *element_stiffness, size_t i, size_t j)
{
    double cc = element_stiffness->c[i] * element_stiffness->c[j],
           dd = element_stiffness->d[i] * element_stiffness->d[j];
    double cd = element_stiffness->c[i] * element_stiffness->d[j],
           dc = element_stiffness->d[i] * element_stiffness->c[j];
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) {
            int k = 3 * row + column, turned = 3 * column + row;
            out[k] += cc * element_stiffness->uu[k] + dd * element_stiffness->vv[k] +
                      cd * element_stiffness->uv[k] + dc * element_stiffness->uv[turned];
        }
}

static void gather_row(struct tl_stiffness *stiffness, size_t vertex)
{
    const struct tl_gather *gather = &stiffness->gather;
    uint32_t first = stiffness->blocks.first[vertex], end = stiffness->blocks.first[vertex + 1];
    memset(stiffness->values[first], 0, (end - first) * sizeof *stiffness->values);
    for (uint32_t item = gather->fans.first[vertex]; item < gather->fans.first[vertex + 1]; item++) {
        uint32_t element = gather->fans.items[item] / CORNERS, corner = gather->fans.items[item] % CORNERS;
        for (size_t k = 0; k < CORNERS; k++)
            add_block(stiffness->values[gather->slots[(size_t)item * CORNERS + k]],
                      &stiffness->elements[element], corner, k);
    }
}

void tl_stiffness_assemble(struct tl_stiffness *stiffness, const struct tl_energy *energy,
                           const struct tl_cloth_fabric *fabric, const struct tl_springs *springs,
                           const vec3d *x)
{
    size_t lanes = energy->membrane_count * TL_BATCH, own = lanes + energy->link_count;
#pragma omp parallel if (stiffness->vertex_count > TL_PARALLEL_ROWS)
    {
#pragma omp for schedule(static)
        for (size_t i = 0; i < stiffness->element_count; i++) {
            if (i < lanes)
                stiffness->elements[i] =
                    membrane_stiffness(&energy->membranes[i / TL_BATCH], i % TL_BATCH, fabric, x);
            else if (i < own)
                stiffness->elements[i] = link_stiffness(&energy->links[i - lanes], fabric->stretch_warp, x);
            else
                stiffness->elements[i] = link_stiffness(&springs->links[i - own], springs->stiffness, x);
        }
#pragma omp for schedule(static)
        for (size_t v = 0; v < stiffness->vertex_count; v++)
            gather_row(stiffness, v);
    }
}

void tl_stiffness_add(struct tl_stiffness *stiffness, uint32_t row, uint32_t column, vec3d n, double scale)
{
    add_outer(stiffness->values[find_entry(&stiffness->blocks, row, column)], n, n, scale);
}

vec3d tl_stiffness_row(const struct tl_stiffness *stiffness, size_t vertex, const vec3d *p)
{
    vec3d sum = {0};
    for (uint32_t e = stiffness->blocks.first[vertex]; e < stiffness->blocks.first[vertex + 1]; e++) {
        const double *block = stiffness->values[e];
        vec3d from = p[stiffness->blocks.columns[e]];
        sum.x += block[0] * from.x + block[1] * from.y + block[2] * from.z;
        sum.y += block[3] * from.x + block[4] * from.y + block[5] * from.z;
        sum.z += block[6] * from.x + block[7] * from.y + block[8] * from.z;
    }
    for (uint32_t e = stiffness->bends.first[vertex]; e < stiffness->bends.first[vertex + 1]; e++)
        sum = vec3d_muladd(sum, p[stiffness->bends.columns[e]], stiffness->bend_values[e]);
    return sum;
}
