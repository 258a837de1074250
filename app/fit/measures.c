#include "app/fit/measures.h"

#include "app/fit/girths.h"
#include "assets/sewing/charts.h"
#include "cloth/energy/energy.h"
#include "cloth/energy/strain.h"
#include "config/base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Panels ---- */

/* The panel of each triangle. */
struct panel_map {
    size_t count, triangle_count;
    uint32_t *of_triangle;
};

static struct panel_map parts_as_panels(const tl_mesh *mesh)
{
    struct panel_map map = {mesh->part_count, mesh->index_count / 3, NULL};
    map.of_triangle = TL_NEW_ARRAY(uint32_t, map.triangle_count);
    for (size_t p = 0; p < mesh->part_count; p++)
        for (uint32_t i = 0; i < mesh->parts[p].index_count; i += 3)
            map.of_triangle[(mesh->parts[p].first_index + i) / 3] = (uint32_t)p;
    return map;
}

static struct panel_map map_panels(const tl_garment *garment)
{
    if (!garment->pattern)
        return parts_as_panels(&garment->model.mesh);
    struct tl_charts charts = tl_charts_find(&garment->model.mesh);
    struct panel_map map = {charts.count, charts.triangle_count, charts.of_triangle};
    charts.of_triangle = NULL;
    tl_charts_release(&charts);
    return map;
}

/* The material of a triangle's part. */
static size_t material_of(const tl_mesh *mesh, size_t triangle)
{
    for (size_t p = 0; p < mesh->part_count; p++) {
        const struct tl_mesh_part *part = &mesh->parts[p];
        if (3 * triangle >= part->first_index && 3 * triangle < part->first_index + part->index_count)
            return (size_t)part->material;
    }
    return 0;
}

/* A panel has the name of its material, with a number where it is not the only one. */
static void name_panels(const tl_model *model, const struct panel_map *map, const struct tl_fans *triangles,
                        struct tl_panel_measures *panels)
{
    unsigned *alike = TL_NEW_ARRAY(unsigned, model->material_count);
    unsigned *before = TL_NEW_ARRAY(unsigned, model->material_count);
    size_t *materials = TL_NEW_ARRAY(size_t, map->count);
    for (size_t p = 0; p < map->count; p++) {
        bool empty = triangles->first[p] == triangles->first[p + 1];
        materials[p] = empty ? 0 : material_of(&model->mesh, triangles->items[triangles->first[p]]);
        alike[materials[p]]++;
    }
    for (size_t p = 0; p < map->count; p++) {
        const char *name = model->materials[materials[p]].name;
        name = name[0] != '\0' ? name : "panel";
        if (alike[materials[p]] > 1)
            snprintf(panels[p].name, sizeof panels[p].name, "%s %u", name, ++before[materials[p]]);
        else
            snprintf(panels[p].name, sizeof panels[p].name, "%s", name);
    }
    free(materials);
    free(before);
    free(alike);
}

struct strain_sample {
    double value, area;
};

static int compare_samples(const void *a, const void *b)
{
    double p = ((const struct strain_sample *)a)->value, q = ((const struct strain_sample *)b)->value;
    return (p > q) - (p < q);
}

static struct tl_spread spread_of(struct strain_sample *samples, size_t count)
{
    const double share = 0.95;
    double area = 0, sum = 0, below = 0;
    size_t i = 0;
    if (count == 0)
        return (struct tl_spread){0};
    qsort(samples, count, sizeof *samples, compare_samples);
    for (size_t k = 0; k < count; k++) {
        area += samples[k].area;
        sum += samples[k].value * samples[k].area;
    }
    while (i + 1 < count && below + samples[i].area < share * area)
        below += samples[i++].area;
    return (struct tl_spread){sum / area, samples[i].value, samples[count - 1].value};
}

static double worn_area(const tl_mesh *mesh, const vec3s *positions, size_t triangle)
{
    const uint32_t *v = &mesh->indices[3 * triangle];
    vec3s side = glms_vec3_sub(positions[v[1]], positions[v[0]]);
    vec3s other = glms_vec3_sub(positions[v[2]], positions[v[0]]);
    return 0.5 * (double)glms_vec3_norm(glms_vec3_cross(side, other));
}

static void measure_triangles(const struct tl_measures_source *source, const tl_strains *strains,
                              const uint32_t *triangles, size_t count, struct tl_panel_measures *out)
{
    struct strain_sample *samples[3];
    size_t used = 0;
    for (int i = 0; i < 3; i++)
        samples[i] = TL_NEW_ARRAY(struct strain_sample, count);
    for (size_t k = 0; k < count; k++) {
        struct tl_triangle_strain strain = tl_strains_of_triangle(strains, triangles[k]);
        out->rest_m2 += strain.area;
        out->worn_m2 += worn_area(&source->garment->model.mesh, source->positions, triangles[k]);
        if (!(strain.area > 0))
            continue;
        samples[0][used] = (struct strain_sample){strain.warp, strain.area};
        samples[1][used] = (struct strain_sample){strain.weft, strain.area};
        samples[2][used++] = (struct strain_sample){fabs(strain.shear), strain.area};
    }
    struct tl_spread *spreads[3] = {&out->warp, &out->weft, &out->shear};
    for (int i = 0; i < 3; i++) {
        *spreads[i] = spread_of(samples[i], used);
        free(samples[i]);
    }
}

static void measure_panels(const struct tl_measures_source *source, struct tl_measures *out)
{
    const tl_model *model = &source->garment->model;
    struct panel_map map = map_panels(source->garment);
    struct tl_fans triangles = tl_fans_build(map.of_triangle, map.triangle_count, map.count);
    tl_strains *strains = tl_strains_create(source->garment);
    vec3s *of_vertices = TL_NEW_ARRAY(vec3s, model->mesh.vertex_count);
    tl_strains_update(strains, source->positions, of_vertices);
    out->panel_count = map.count;
    out->panels = TL_NEW_ARRAY(struct tl_panel_measures, map.count);
    name_panels(model, &map, &triangles, out->panels);
    for (size_t p = 0; p < map.count; p++)
        measure_triangles(source, strains, &triangles.items[triangles.first[p]],
                          triangles.first[p + 1] - triangles.first[p], &out->panels[p]);
    measure_triangles(source, strains, triangles.items, map.triangle_count, &out->whole);
    snprintf(out->whole.name, sizeof out->whole.name, "all");
    tl_strains_destroy(&strains);
    tl_fans_release(&triangles);
    free(of_vertices);
    free(map.of_triangle);
}

/* ---- Openings and girths ---- */

/* Length at rest of the side between two welded vertices of a triangle. */
static double rest_side(const struct tl_topology *topology, const vec2s (*rest)[3], uint32_t triangle,
                        uint32_t a, uint32_t b)
{
    vec2s ends[2] = {rest[triangle][0], rest[triangle][0]};
    for (int i = 0; i < 3; i++) {
        ends[0] = topology->triangles[triangle][i] == a ? rest[triangle][i] : ends[0];
        ends[1] = topology->triangles[triangle][i] == b ? rest[triangle][i] : ends[1];
    }
    return (double)glms_vec2_distance(ends[0], ends[1]);
}

static void measure_openings(const struct tl_topology *topology, const vec2s (*rest)[3],
                             const vec3s *positions, struct tl_measures *out)
{
    const struct tl_opening_mesh mesh = {topology->vertex_count, topology->triangle_count, positions,
                                         (const uint32_t(*)[3])topology->triangles};
    struct tl_openings openings;
    tl_openings_find(&mesh, &openings);
    out->opening_count = openings.count;
    out->openings = TL_NEW_ARRAY(struct tl_opening_measures, openings.count);
    for (size_t i = 0; i < openings.count; i++) {
        const struct tl_opening *opening = &openings.items[i];
        memcpy(out->openings[i].name, opening->name, sizeof opening->name);
        out->openings[i].worn_m = opening->length;
        out->openings[i].height_m = (double)opening->centre.y;
        for (size_t k = 0; k < opening->side_count; k++)
            out->openings[i].rest_m += rest_side(topology, rest, opening->triangles[k], opening->vertices[k],
                                                 opening->vertices[(k + 1) % opening->side_count]);
    }
    tl_openings_release(&openings);
}

struct tl_measures tl_measures_take(const struct tl_measures_source *source)
{
    const tl_mesh *mesh = &source->garment->model.mesh;
    struct tl_measures out = {.has_pattern = source->garment->pattern != NULL};
    size_t count = 0;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        count = source->weld[i] + 1 > count ? source->weld[i] + 1 : count;
    struct tl_topology topology =
        tl_topology_build(mesh->indices, mesh->index_count, source->weld, mesh->vertex_count, count);
    vec2s(*rest)[3] = tl_rest_shapes(source->garment, &topology);
    vec3s *positions = TL_NEW_ARRAY(vec3s, count);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        positions[source->weld[i]] = source->positions[i];
    measure_panels(source, &out);
    measure_openings(&topology, (const vec2s(*)[3])rest, positions, &out);
    if (source->body) {
        tl_girths_of_body(source->body, out.girths);
        tl_girths_of_cloth(source->body, &topology, (const vec2s(*)[3])rest, positions, out.girths);
    }
    free(positions);
    free(rest);
    tl_topology_release(&topology);
    return out;
}

void tl_measures_release(struct tl_measures *measures)
{
    free(measures->panels);
    free(measures->openings);
    *measures = (struct tl_measures){0};
}
