#include "assets/base/model_build.h"
#include "config/base/memory.h"

#include <stdlib.h>

static double area_of(const tl_mesh *mesh)
{
    double twice = 0;
    for (size_t i = 0; i + 2 < mesh->index_count; i += 3) {
        vec3s a = mesh->positions[mesh->indices[i]];
        vec3s u = glms_vec3_sub(mesh->positions[mesh->indices[i + 1]], a);
        vec3s v = glms_vec3_sub(mesh->positions[mesh->indices[i + 2]], a);
        twice += (double)glms_vec3_norm(glms_vec3_cross(u, v));
    }
    return 0.5 * twice;
}

bool model_take_units(const char *path, enum tl_units wanted, bool is_metric, tl_model *model,
                      tl_error *error)
{
    /* Farther away a float cannot resolve a millimetre. A scale that overflows is caught here too. */
    const float farthest_m = 1e5f;
    tl_mesh *mesh = &model->mesh;
    const struct tl_box box = tl_box_of(mesh->positions, mesh->vertex_count);
    model->units = tl_units_read(box, wanted, is_metric);
    tl_units_weigh(&model->units, box, area_of(mesh));
    float metres = (float)tl_units_metres(model->units.units);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        mesh->positions[i] = glms_vec3_scale(mesh->positions[i], metres);
        if (!(glms_vec3_norm(mesh->positions[i]) <= farthest_m))
            return tl_fail(error, TL_INPUT,
                           "%s: vertex %zu lies more than 100 km away or is not finite: check its units",
                           path, i);
    }
    return true;
}

struct by_position {
    vec3s position;
    uint32_t vertex;
};

static int compare_positions(const void *a, const void *b)
{
    const vec3s *p = &((const struct by_position *)a)->position,
                *q = &((const struct by_position *)b)->position;
    for (int c = 0; c < 3; c++)
        if (p->raw[c] != q->raw[c])
            return p->raw[c] < q->raw[c] ? -1 : 1;
    return 0;
}

void model_smooth_normals(tl_mesh *mesh)
{
    size_t count = mesh->vertex_count;
    vec3s *sums = TL_NEW_ARRAY(vec3s, count);
    struct by_position *sorted = TL_NEW_ARRAY(struct by_position, count);
    for (size_t i = 0; i + 2 < mesh->index_count; i += 3) {
        const uint32_t *v = &mesh->indices[i];
        vec3s side = glms_vec3_sub(mesh->positions[v[1]], mesh->positions[v[0]]);
        vec3s area = glms_vec3_cross(side, glms_vec3_sub(mesh->positions[v[2]], mesh->positions[v[0]]));
        for (int c = 0; c < 3; c++)
            sums[v[c]] = glms_vec3_add(sums[v[c]], area);
    }
    for (size_t i = 0; i < count; i++)
        sorted[i] = (struct by_position){mesh->positions[i], (uint32_t)i};
    qsort(sorted, count, sizeof *sorted, compare_positions);
    for (size_t first = 0, end; first < count; first = end) {
        vec3s sum = {{0, 0, 0}};
        for (end = first; end < count && compare_positions(&sorted[first], &sorted[end]) == 0; end++)
            sum = glms_vec3_add(sum, sums[sorted[end].vertex]);
        float length = glms_vec3_norm(sum);
        vec3s normal = length > 0 ? glms_vec3_divs(sum, length) : (vec3s){{0, 1, 0}};
        for (size_t i = first; i < end; i++)
            if (glms_vec3_norm2(mesh->normals[sorted[i].vertex]) == 0)
                mesh->normals[sorted[i].vertex] = normal;
    }
    free(sorted);
    free(sums);
}
