#include "assets/topology/simplify.h"

#include "assets/base/rig.h"
#include "assets/halfmesh/decimate.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Memory that decimation takes for each triangle: 250 bytes, measured with 760,000. */
#define TRIANGLE_BYTES ((uint64_t)320)

/* ---- Decimation ---- */

static bool report_progress(void *user, double share)
{
    tl_progress_update(user, share, 1);
    return !tl_interrupted();
}

/* Fills the number of each triangle's part, and the scale of each part's UVs. */
static void describe_parts(const tl_mesh *mesh, uint32_t *parts, float *uv_metres)
{
    for (size_t p = 0; p < mesh->part_count; p++) {
        const struct tl_mesh_part *part = &mesh->parts[p];
        uv_metres[p] = part->uv_metres;
        for (size_t t = 0; t < part->index_count / 3; t++)
            parts[part->first_index / 3 + t] = (uint32_t)p;
    }
}

struct vertex_use {
    uint32_t place;
    vec2s uv;
    uint32_t vertex;
};

static int compare_uses(const void *a, const void *b)
{
    const struct vertex_use *p = a, *q = b;
    if (p->place != q->place)
        return p->place > q->place ? 1 : -1;
    int order = memcmp(&p->uv, &q->uv, sizeof p->uv);
    return order ? order : (p->vertex > q->vertex) - (p->vertex < q->vertex);
}

static bool is_bound_alike(const tl_rig *rig, uint32_t a, uint32_t b)
{
    return !rig || (memcmp(&rig->influences[a], &rig->influences[b], sizeof *rig->influences) == 0 &&
                    memcmp(&rig->local[a], &rig->local[b], sizeof *rig->local) == 0);
}

/* Corners [index_count] of all triangles, one vertex for those that differ in their normals only. A body's
 * normals are recomputed for each frame from its places, so that such a split is no seam, and a scan with a
 * normal for each face would be nothing but seams. */
static uint32_t *join_split_normals(const tl_model *model, const uint32_t *weld)
{
    const tl_mesh *mesh = &model->mesh;
    struct vertex_use *uses = tl_alloc(mesh->vertex_count, sizeof *uses);
    uint32_t *firsts = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    uint32_t *corners = TL_NEW_ARRAY(uint32_t, mesh->index_count);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        uses[i] = (struct vertex_use){weld[i], mesh->uvs[i], i};
    qsort(uses, mesh->vertex_count, sizeof *uses, compare_uses);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        const struct vertex_use *use = &uses[i], *last = i > 0 ? &uses[i - 1] : use;
        bool joins = i > 0 && last->place == use->place && memcmp(&last->uv, &use->uv, sizeof use->uv) == 0 &&
                     is_bound_alike(model->rig, firsts[last->vertex], use->vertex);
        firsts[use->vertex] = joins ? firsts[last->vertex] : use->vertex;
    }
    for (size_t i = 0; i < mesh->index_count; i++)
        corners[i] = firsts[mesh->indices[i]];
    free(uses);
    free(firsts);
    return corners;
}

static bool decimate(const tl_model *model, const uint32_t *weld, struct tl_decimated *out)
{
    const tl_mesh *mesh = &model->mesh;
    size_t triangles = mesh->index_count / 3;
    uint32_t *corners = join_split_normals(model, weld);
    uint32_t *parts = TL_NEW_ARRAY(uint32_t, triangles);
    float *uv_metres = TL_NEW_ARRAY(float, mesh->part_count);
    struct tl_progress progress = tl_progress_begin("simplifying the body");
    describe_parts(mesh, parts, uv_metres);
    const struct tl_decimate_source source = {
        .vertex_count = mesh->vertex_count,
        .triangle_count = triangles,
        .positions = (const float(*)[3])mesh->positions,
        .uvs = (const float(*)[2])mesh->uvs,
        .weld = weld,
        .triangles = (const uint32_t(*)[3])corners,
        .parts = parts,
        .uv_metres = uv_metres,
        .triangle_target = TL_SIMPLIFY_TARGET,
        .distance_max_m = TL_SIMPLIFY_DISTANCE_M,
        .uv_max_m = TL_SIMPLIFY_UV_M,
        .progress = report_progress,
        .user = &progress,
    };
    bool made = tl_decimate(&source, out);
    tl_progress_end(&progress);
    free(corners);
    free(parts);
    free(uv_metres);
    return made;
}

/* ---- The vertices that stay ---- */

/* kept [count]: old numbers, rising. */
struct kept_vertices {
    size_t count;
    uint32_t *kept;
    uint32_t *numbers; /* [old count] the new number of each, UINT32_MAX: removed */
};

static struct kept_vertices find_kept(const struct tl_decimated *decimated, size_t vertex_count)
{
    struct kept_vertices vertices = {.kept = TL_NEW_ARRAY(uint32_t, vertex_count),
                                     .numbers = TL_NEW_ARRAY(uint32_t, vertex_count)};
    for (size_t t = 0; t < decimated->triangle_count; t++)
        for (size_t k = 0; k < 3; k++)
            vertices.numbers[decimated->triangles[t][k]] = 1;
    for (uint32_t i = 0; i < vertex_count; i++) {
        bool stays = vertices.numbers[i] != 0;
        vertices.numbers[i] = stays ? (uint32_t)vertices.count : UINT32_MAX;
        if (stays)
            vertices.kept[vertices.count++] = i;
    }
    return vertices;
}

/* Keeps those elements of an array [old count] that belong to vertices that stay; NULL stays NULL. */
static void *compact(const struct kept_vertices *vertices, void *array, size_t size)
{
    char *bytes = array;
    if (!array)
        return NULL;
    for (size_t i = 0; i < vertices->count; i++)
        memmove(bytes + i * size, bytes + vertices->kept[i] * size, size); /* kept[i] >= i */
    return tl_resize(array, vertices->count, size);
}

#define COMPACT(vertices, array) ((array) = compact(vertices, array, sizeof *(array)))

static void compact_rig(const struct kept_vertices *vertices, tl_rig *rig)
{
    COMPACT(vertices, rig->local);
    COMPACT(vertices, rig->influences);
    rig->vertex_count = vertices->count;
    for (size_t m = 0; m < rig->morph_count; m++) {
        struct rig_morph *morph = &rig->morphs[m];
        size_t count = 0;
        for (size_t i = 0; i < morph->offset_count; i++) {
            uint32_t number = vertices->numbers[morph->vertices[i]];
            if (number == UINT32_MAX)
                continue;
            morph->vertices[count] = number;
            morph->offsets[count++] = morph->offsets[i];
        }
        morph->offset_count = count;
    }
}

/* Triangles keep the order of the file, and with it their parts. */
static void take_triangles(const struct kept_vertices *vertices, const struct tl_decimated *decimated,
                           tl_mesh *mesh)
{
    size_t t = 0;
    for (size_t p = 0; p < mesh->part_count; p++) {
        struct tl_mesh_part *part = &mesh->parts[p];
        size_t end = ((size_t)part->first_index + part->index_count) / 3, first = t;
        for (; t < decimated->triangle_count && decimated->sources[t] < end; t++)
            for (size_t k = 0; k < 3; k++)
                mesh->indices[3 * t + k] = vertices->numbers[decimated->triangles[t][k]];
        part->first_index = (uint32_t)(3 * first);
        part->index_count = (uint32_t)(3 * (t - first));
    }
    mesh->index_count = 3 * t;
    mesh->indices = tl_resize(mesh->indices, mesh->index_count, sizeof *mesh->indices);
}

static void take(const struct tl_decimated *decimated, tl_model *model)
{
    tl_mesh *mesh = &model->mesh;
    struct kept_vertices vertices = find_kept(decimated, mesh->vertex_count);
    take_triangles(&vertices, decimated, mesh);
    if (!model->points) { /* each vertex was its own point */
        model->point_count = mesh->vertex_count;
        model->points = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
        for (uint32_t i = 0; i < mesh->vertex_count; i++)
            model->points[i] = i;
    }
    COMPACT(&vertices, mesh->positions);
    COMPACT(&vertices, mesh->normals);
    COMPACT(&vertices, mesh->uvs);
    COMPACT(&vertices, mesh->tangents);
    COMPACT(&vertices, model->points);
    COMPACT(&vertices, model->pins);
    COMPACT(&vertices, model->colours);
    mesh->vertex_count = vertices.count;
    if (model->rig)
        compact_rig(&vertices, model->rig);
    free(vertices.kept);
    free(vertices.numbers);
}

struct tl_simplified tl_simplify_model(tl_model *model, const uint32_t *weld)
{
    size_t before = model->mesh.index_count / 3;
    struct tl_simplified report = {before, before, 0};
    struct tl_decimated decimated;
    tl_error error;
    if (before <= TL_SIMPLIFY_ABOVE)
        return report;
    if (!tl_memory_request("simplifying the body", before * TRIANGLE_BYTES, &error)) {
        tl_info("%s", error.message);
        return report;
    }
    if (!decimate(model, weld, &decimated))
        return report;
    if (decimated.triangle_count < before - before / 4) {
        report = (struct tl_simplified){before, decimated.triangle_count, decimated.distance_m};
        take(&decimated, model);
    }
    tl_decimated_release(&decimated);
    return report;
}

char *tl_simplified_describe(const char *name, const struct tl_simplified *simplified)
{
    if (simplified->after == simplified->before)
        return NULL;
    return tl_format("%s: %zu triangles drawn as %zu, within %.2g mm", name, simplified->before,
                     simplified->after, 1e3 * simplified->distance_m);
}
