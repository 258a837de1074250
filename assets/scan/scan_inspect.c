/* Faults of the mesh of a scan. */
#include "assets/base/model_build.h"
#include "assets/scan/scan_internal.h"
#include "assets/topology/sets.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

/* A side of a triangle, of the lower place to the higher. */
struct scan_side {
    uint32_t lower, higher;
    bool rises; /* the triangle runs along it from `lower` to `higher` */
};

struct scan_inspection {
    const tl_mesh *mesh;
    const uint32_t *places; /* [vertex_count] */
    size_t border_count;    /* borders that are closed lines, or several that touch */
    double longest_m;       /* the longest of them */
    size_t crowded, turned; /* edges of three triangles or more; of two that run along it alike */
    size_t piece_count, loose_count, loose_triangles;
    double volume_m3, area_m2;
};

/* A piece of less than this share of the largest is loose. */
#define LOOSE_SHARE 0.01

static int by_places(const void *a, const void *b)
{
    const struct scan_side *p = a, *q = b;
    if (p->lower != q->lower)
        return p->lower < q->lower ? -1 : 1;
    return (p->higher > q->higher) - (p->higher < q->higher);
}

/* A vertex at each place, for its position. */
static uint32_t *vertices_at(const struct scan_inspection *inspection)
{
    uint32_t *vertices = tl_alloc(inspection->mesh->vertex_count, sizeof *vertices);
    for (size_t i = 0; i < inspection->mesh->vertex_count; i++)
        vertices[inspection->places[i]] = (uint32_t)i;
    return vertices;
}

static struct scan_side *sides_of(const struct scan_inspection *inspection)
{
    const tl_mesh *mesh = inspection->mesh;
    struct scan_side *sides = tl_alloc(mesh->index_count, sizeof *sides);
    for (size_t i = 0; i < mesh->index_count; i++) {
        uint32_t from = inspection->places[mesh->indices[i]];
        uint32_t to = inspection->places[mesh->indices[i % 3 == 2 ? i - 2 : i + 1]];
        sides[i] = from < to ? (struct scan_side){from, to, true} : (struct scan_side){to, from, false};
    }
    qsort(sides, mesh->index_count, sizeof *sides, by_places);
    return sides;
}

/* Sorts edges by their triangles: those of one are borders, joined where they touch. */
static void find_borders(struct scan_inspection *inspection)
{
    const tl_mesh *mesh = inspection->mesh;
    struct scan_side *sides = sides_of(inspection);
    uint32_t *vertices = vertices_at(inspection), *parents = tl_sets_create(mesh->vertex_count);
    double *lengths_m = TL_NEW_ARRAY(double, mesh->vertex_count);
    size_t borders = 0;
    for (size_t first = 0, end; first < mesh->index_count; first = end) {
        for (end = first + 1; end < mesh->index_count && by_places(&sides[first], &sides[end]) == 0;)
            end++;
        inspection->crowded += end - first > 2;
        inspection->turned += end - first == 2 && sides[first].rises == sides[first + 1].rises;
        if (end - first == 1 && sides[first].lower != sides[first].higher) {
            tl_sets_join(parents, sides[first].lower, sides[first].higher);
            sides[borders++] = sides[first];
        }
    }
    for (size_t i = 0; i < borders; i++) {
        vec3s from = mesh->positions[vertices[sides[i].lower]],
              to = mesh->positions[vertices[sides[i].higher]];
        double *length_m = &lengths_m[tl_sets_find(parents, sides[i].lower)];
        inspection->border_count += *length_m == 0;
        *length_m += fmax((double)glms_vec3_distance(from, to), 1e-12);
        inspection->longest_m = fmax(inspection->longest_m, *length_m);
    }
    free(lengths_m);
    free(parents);
    free(vertices);
    free(sides);
}

static void find_pieces(struct scan_inspection *inspection)
{
    const tl_mesh *mesh = inspection->mesh;
    uint32_t *parents = tl_sets_create(mesh->vertex_count);
    size_t *triangles = TL_NEW_ARRAY(size_t, mesh->vertex_count), largest = 0;
    for (size_t i = 0; i < mesh->index_count; i++)
        tl_sets_join(parents, inspection->places[mesh->indices[i]],
                     inspection->places[mesh->indices[i - i % 3]]);
    for (size_t i = 0; i < mesh->index_count; i += 3) {
        size_t count = ++triangles[tl_sets_find(parents, inspection->places[mesh->indices[i]])];
        largest = count > largest ? count : largest;
    }
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        bool loose = (double)triangles[i] < LOOSE_SHARE * (double)largest;
        inspection->piece_count += triangles[i] > 0;
        inspection->loose_count += triangles[i] > 0 && loose;
        inspection->loose_triangles += loose ? triangles[i] : 0;
    }
    free(triangles);
    free(parents);
}

/* The volume below the faces, seen from the middle of the box; negative where they point inwards. */
static void measure(struct scan_inspection *inspection)
{
    const tl_mesh *mesh = inspection->mesh;
    struct tl_box box = tl_box_of(mesh->positions, mesh->vertex_count);
    vec3s middle = glms_vec3_lerp(box.lower, box.upper, 0.5f);
    for (size_t i = 0; i < mesh->index_count; i += 3) {
        vec3s corners[3];
        for (size_t c = 0; c < 3; c++)
            corners[c] = glms_vec3_sub(mesh->positions[mesh->indices[i + c]], middle);
        vec3s cross =
            glms_vec3_cross(glms_vec3_sub(corners[1], corners[0]), glms_vec3_sub(corners[2], corners[0]));
        inspection->volume_m3 += (double)glms_vec3_dot(corners[0], cross) / 6;
        inspection->area_m2 += (double)glms_vec3_norm(cross) / 2;
    }
}

void scan_inspect(tl_model *model, const uint32_t *places)
{
    /* A sphere has 0.094, a body 0.03. */
    const double hollow = 0.005;
    struct scan_inspection found = {.mesh = &model->mesh, .places = places};
    find_borders(&found);
    find_pieces(&found);
    measure(&found);
    if (found.border_count > 0)
        model_defect(model, "%zu open border%s, the longest %.3g m around", found.border_count,
                     found.border_count > 1 ? "s" : "", found.longest_m);
    if (found.crowded > 0)
        model_defect(model, "%zu edges of more than two triangles", found.crowded);
    if (found.turned > 0)
        model_defect(model, "%zu edges between triangles that face opposite ways", found.turned);
    if (found.loose_count > 0)
        model_defect(model, "%zu loose pieces of %zu triangles in all", found.loose_count,
                     found.loose_triangles);
    if (found.volume_m3 < -hollow * pow(found.area_m2, 1.5))
        model_defect(model, "its faces point inwards: turn them in the program that made it");
}
