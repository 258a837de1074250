#include "app/fit/sewn.h"

#include "assets/base/placing.h"
#include "assets/topology/sets.h"
#include "cloth/mesh/topology.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

size_t tl_sewn_weld(const tl_garment *garment, uint32_t *weld)
{
    const tl_mesh *mesh = &garment->model.mesh;
    size_t count = mesh->vertex_count, sewn = 0;
    for (size_t i = 0; i < count; i++)
        weld[i] = (uint32_t)i;
    if (!garment->welds_seams_only)
        count = tl_weld_positions(mesh->positions, mesh->vertex_count, weld);
    uint32_t *sets = tl_sets_create(count), *numbers = TL_NEW_ARRAY(uint32_t, count);
    for (size_t i = 0; i < garment->seam_count; i++)
        tl_sets_join(sets, weld[garment->seams[i].a], weld[garment->seams[i].b]);
    for (uint32_t i = 0; i < count; i++) { /* a set's lowest member comes first */
        uint32_t root = tl_sets_find(sets, i);
        numbers[i] = root == i ? (uint32_t)sewn++ : numbers[root];
    }
    for (size_t i = 0; i < mesh->vertex_count; i++)
        weld[i] = numbers[weld[i]];
    free(numbers);
    free(sets);
    return sewn;
}

struct tl_openings tl_sewn_openings(const tl_garment *garment, const vec3s *positions, uint32_t *weld)
{
    const tl_mesh *mesh = &garment->model.mesh;
    size_t count = tl_sewn_weld(garment, weld);
    struct tl_topology topology =
        tl_topology_build(mesh->indices, mesh->index_count, weld, mesh->vertex_count, count);
    vec3s *places = TL_NEW_ARRAY(vec3s, count);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        places[weld[i]] = positions[i];
    const struct tl_opening_mesh sewn = {count, topology.triangle_count, places,
                                         (const uint32_t(*)[3])topology.triangles};
    struct tl_openings openings;
    tl_openings_find(&sewn, &openings);
    free(places);
    tl_topology_release(&topology);
    return openings;
}

struct tl_openings tl_sewn_openings_of_model(const tl_model *model)
{
    size_t count = model->mesh.vertex_count;
    const struct tl_placing placing = {.z_up = model->units.z_up, .scale = 1};
    const tl_garment garment = {.model = *model};
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, count);
    vec3s *positions = TL_NEW_ARRAY(vec3s, count);
    for (size_t i = 0; i < count; i++)
        positions[i] = tl_placing_point(&placing, model->mesh.positions[i]);
    struct tl_openings openings = tl_sewn_openings(&garment, positions, weld);
    free(positions);
    free(weld);
    return openings;
}

static bool is_one_piece(const tl_mesh *mesh)
{
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    size_t count = tl_weld_positions(mesh->positions, mesh->vertex_count, weld);
    uint32_t *sets = tl_sets_create(count);
    for (size_t i = 0; i < mesh->index_count; i++)
        tl_sets_join(sets, weld[mesh->indices[i]], weld[mesh->indices[i - i % 3]]);
    bool is_one = true;
    for (size_t i = 0; is_one && i < mesh->index_count; i++)
        is_one = tl_sets_find(sets, weld[mesh->indices[i]]) == tl_sets_find(sets, weld[mesh->indices[0]]);
    free(sets);
    free(weld);
    return is_one;
}

/* The openings of a garment, fallen in whatever pose, are few and long: together 2.9 (a T-shirt) to 4.2 (a
 * sheet) times the root of its area. Holes of a scan or of furniture are short (a sofa: 0.3), and what is put
 * together from plates has many pieces. */
static bool is_open_cloth(const tl_model *model, const struct tl_openings *openings)
{
    const size_t max_openings = 6; /* neck, cuffs, waist and legs */
    const double min_rim = 1.2;
    const tl_mesh *mesh = &model->mesh;
    double rim_m = 0, area_m2 = 0;
    if (openings->count == 0 || openings->count > max_openings || !is_one_piece(mesh))
        return false;
    for (size_t i = 0; i < openings->count; i++)
        rim_m += openings->items[i].length;
    for (size_t i = 0; i < mesh->index_count; i += 3) {
        const vec3s a = mesh->positions[mesh->indices[i]], b = mesh->positions[mesh->indices[i + 1]],
                    c = mesh->positions[mesh->indices[i + 2]];
        area_m2 += 0.5 * (double)glms_vec3_norm(glms_vec3_cross(glms_vec3_sub(b, a), glms_vec3_sub(c, a)));
    }
    return rim_m > min_rim * sqrt(area_m2);
}

bool tl_sewn_is_worn(const tl_model *model)
{
    if (model->rig || model->clip_count > 0)
        return false;
    struct tl_openings openings = tl_sewn_openings_of_model(model);
    bool is_worn = tl_openings_named(&openings, "neck") || tl_openings_named(&openings, "waist") ||
                   is_open_cloth(model, &openings);
    tl_openings_release(&openings);
    return is_worn;
}

static void add_pins(const struct tl_opening *opening, const uint32_t *weld, tl_garment *garment)
{
    size_t vertex_count = garment->model.mesh.vertex_count;
    bool *pinned = TL_NEW_ARRAY(bool, vertex_count); /* by sewn vertex, of which there are at most as many */
    for (size_t i = 0; i < opening->side_count; i++)
        pinned[opening->vertices[i]] = true;
    garment->pins = tl_resize(garment->pins, garment->pin_count + vertex_count, sizeof *garment->pins);
    for (size_t i = 0; i < vertex_count; i++)
        if (pinned[weld[i]])
            garment->pins[garment->pin_count++] = (uint32_t)i;
    free(pinned);
}

static bool refuse_name(const char *name, const tl_garment *garment, const struct tl_openings *openings,
                        tl_error *error)
{
    char known[256] = "";
    for (size_t i = 0; i < openings->count; i++) {
        size_t length = strlen(known);
        snprintf(known + length, sizeof known - length, "%s%s", i > 0 ? ", " : "", openings->items[i].name);
    }
    return tl_fail(error, TL_USAGE, "cloth.pin_openings: %s has no opening \"%s\": it has %s",
                   garment->model.name, name, openings->count > 0 ? known : "none");
}

bool tl_sewn_pin(const char *names, tl_garment *garment, tl_error *error)
{
    if (names[0] == '\0')
        return true;
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, garment->model.mesh.vertex_count);
    struct tl_openings openings = tl_sewn_openings(garment, garment->model.mesh.positions, weld);
    char *list = tl_copy_string(names), *rest = list;
    bool good = true;
    for (char *name = strsep(&rest, ","); good && name; name = strsep(&rest, ",")) {
        name += strspn(name, " ");
        const struct tl_opening *opening = tl_openings_named(&openings, name);
        good = opening || refuse_name(name, garment, &openings, error);
        if (opening)
            add_pins(opening, weld, garment);
    }
    free(list);
    tl_openings_release(&openings);
    free(weld);
    return good;
}
