#include "cloth/cloth.h"

#include "cloth/build.h"
#include "cloth/solvers/xpbd.h"
#include "cloth/timestep.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* ---- Checks ---- */

static double read_number(const struct tl_option *row, const void *params)
{
    double number = 0;
    float single;
    int whole;
    const char *at = (const char *)params + row->offset;
    if (row->type == TL_DOUBLE) {
        memcpy(&number, at, sizeof number);
        return number;
    }
    if (row->type == TL_FLOAT) {
        memcpy(&single, at, sizeof single);
        return (double)single;
    }
    if (row->type == TL_INT) {
        memcpy(&whole, at, sizeof whole);
        return whole;
    }
    return row->minimum; /* not a number */
}

static bool check_params(const struct tl_option_table *table, const void *params, tl_error *error)
{
    for (size_t i = 0; i < table->row_count; i++) {
        const struct tl_option *row = &table->rows[i];
        double number = read_number(row, params);
        if (!(number >= row->minimum && number <= row->maximum))
            return tl_fail(error, TL_USAGE, "%s.%s is %g: give a number from %g to %g %s", table->name,
                           row->name, number, row->minimum, row->maximum, row->unit);
    }
    return true;
}

static bool check_indices(const char *name, const char *what, const uint32_t *indices, size_t count,
                          size_t vertex_count, tl_error *error)
{
    for (size_t i = 0; i < count; i++)
        if (indices[i] >= vertex_count)
            return tl_fail(error, TL_INPUT, "%s: %s %zu names vertex %u of %zu: repair the garment", name,
                           what, i, indices[i], vertex_count);
    return true;
}

static bool check_garment(const tl_garment *garment, tl_error *error)
{
    const tl_mesh *mesh = &garment->model.mesh;
    const char *name = garment->model.name ? garment->model.name : "garment";
    if (mesh->index_count < 3)
        return tl_fail(error, TL_INPUT, "%s: has no triangles to make cloth of: choose another garment",
                       name);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        bool flat = !garment->pattern || (isfinite(garment->pattern[i].x) && isfinite(garment->pattern[i].y));
        if (!flat || !vec3d_finite(vec3d_from(mesh->positions[i])))
            return tl_fail(error, TL_INPUT, "%s: vertex %zu is not finite: repair the garment", name, i);
    }
    return check_indices(name, "corner", mesh->indices, mesh->index_count, mesh->vertex_count, error) &&
           check_indices(name, "seam end", (const uint32_t *)garment->seams, 2 * garment->seam_count,
                         mesh->vertex_count, error) &&
           check_indices(name, "pin", garment->pins, garment->pin_count, mesh->vertex_count, error);
}

/* ---- The public face ---- */

tl_cloth *tl_cloth_create(const tl_garment *garment, const struct tl_cloth_fabric *fabric,
                          const struct tl_cloth_params *params, tl_error *error)
{
    if (!check_garment(garment, error) || !check_params(&tl_cloth_fabric_options, fabric, error) ||
        !check_params(&tl_cloth_options, params, error))
        return NULL;
    tl_cloth *cloth = TL_NEW(tl_cloth);
    cloth->garment = garment;
    cloth->fabric = *fabric;
    cloth->params = *params;
    tl_cloth_build_state(cloth);
    return cloth;
}

void tl_cloth_destroy(tl_cloth **cloth)
{
    if (!*cloth)
        return;
    tl_cloth_release_state(*cloth);
    free((*cloth)->start_x);
    free((*cloth)->start_v);
    free((*cloth)->start_pinched);
    free(*cloth);
    *cloth = NULL;
}

bool tl_cloth_set(tl_cloth *cloth, const struct tl_cloth_fabric *fabric, const struct tl_cloth_params *params,
                  tl_error *error)
{
    if (!check_params(&tl_cloth_fabric_options, fabric, error) ||
        !check_params(&tl_cloth_options, params, error))
        return false;
    bool pins_change =
        params->pin_above_m != cloth->params.pin_above_m || params->pin_colour != cloth->params.pin_colour;
    const struct tl_cloth_fabric *old = &cloth->fabric;  /* numbers without gaps */
    bool is_new = memcmp(fabric, old, sizeof *old) != 0; // NOLINT(bugprone-suspicious-memory-comparison)
    bool weight_changes = is_new || params->gravity != cloth->params.gravity;
    const double substep = tl_cloth_substep(cloth);
    cloth->fabric = *fabric;
    cloth->params = *params;
    if (pins_change)
        tl_cloth_make_pins(cloth);
    tl_cloth_set_constants(cloth);
    if (weight_changes || tl_cloth_substep(cloth) != substep)
        tl_cloth_set_prestress(cloth, false); /* it is of what was */
    return true;
}

/* A run after a reset must equal the first one to the bit. So everything is reset that remembers earlier
 * frames: contact planes, and the start lengths of the strain limits.
 */
static void reset_history(tl_cloth *cloth)
{
    tl_strain_limits_restart(&cloth->limits, cloth->particles.x);
    tl_contacts_release(&cloth->contacts);
    cloth->contacts = tl_contacts_create(&cloth->topology, cloth->rest);
    for (size_t i = 0; i < cloth->topology.render_count; i++)
        cloth->contacts.pinched[cloth->topology.weld[i]] |= cloth->start_pinched[i];
    tl_layers_forget(&cloth->layers);
    tl_self_contact_forget(&cloth->self_contact);
    cloth->cage_is_current = false;
}

/* Stored by render vertex: seams that close later renumber the physics vertices, but not these. */
void tl_cloth_mark_start(tl_cloth *cloth)
{
    size_t count = cloth->topology.render_count;
    cloth->start_x = tl_resize(cloth->start_x, count, sizeof *cloth->start_x);
    cloth->start_v = tl_resize(cloth->start_v, count, sizeof *cloth->start_v);
    cloth->start_pinched = tl_resize(cloth->start_pinched, count, sizeof *cloth->start_pinched);
    for (size_t i = 0; i < count; i++) {
        cloth->start_x[i] = cloth->particles.x[cloth->topology.weld[i]];
        cloth->start_v[i] = cloth->particles.v[cloth->topology.weld[i]];
        cloth->start_pinched[i] = tl_contacts_is_pinched(&cloth->contacts, cloth->topology.weld[i]);
    }
    cloth->time_s = 0;
    cloth->undriven = false;
    reset_history(cloth);
}

void tl_cloth_reset(tl_cloth *cloth)
{
    cloth->grabbed = cloth->undriven = false;
    cloth->time_s = 0;
    if (!cloth->start_x) {
        tl_cloth_release_state(cloth);
        cloth->settled = false;
        tl_cloth_build_state(cloth);
        return;
    }
    tl_cloth_unpin(cloth);
    for (size_t i = 0; i < cloth->topology.render_count; i++) {
        cloth->particles.x[cloth->topology.weld[i]] = cloth->start_x[i];
        cloth->particles.v[cloth->topology.weld[i]] = cloth->start_v[i];
    }
    reset_history(cloth);
}

void tl_cloth_grab(tl_cloth *cloth, uint32_t render_vertex, vec3s target)
{
    bool held = cloth->grabbed && cloth->grabbed_vertex == render_vertex;
    cloth->grabbed = render_vertex < cloth->topology.render_count && vec3d_finite(vec3d_from(target));
    if (!cloth->grabbed)
        return;
    cloth->grabbed_vertex = render_vertex;
    cloth->grab_target = vec3d_from(target);
    if (!held)
        cloth->grab_from = cloth->particles.x[cloth->topology.weld[render_vertex]];
}

void tl_cloth_release(tl_cloth *cloth)
{
    cloth->grabbed = false;
}

void tl_cloth_pin(tl_cloth *cloth, uint32_t render_vertex)
{
    if (render_vertex >= cloth->topology.render_count)
        return;
    tl_cloth_add_pin(cloth, cloth->topology.weld[render_vertex], true);
    tl_cloth_set_constants(cloth);
}

size_t tl_cloth_unpin(tl_cloth *cloth)
{
    size_t kept = 0, count = cloth->pin_count;
    for (size_t i = 0; i < count; i++)
        if (!cloth->pins[i].by_hand)
            cloth->pins[kept++] = cloth->pins[i];
        else
            cloth->particles.driven[cloth->pins[i].particle] = false;
    cloth->pin_count = kept;
    if (kept < count)
        tl_cloth_set_constants(cloth);
    return count - kept;
}

bool tl_cloth_is_settled(const tl_cloth *cloth)
{
    return cloth->settled;
}

void tl_cloth_start_at(tl_cloth *cloth, const vec3s *positions)
{
    for (size_t i = 0; i < cloth->topology.render_count; i++) {
        const uint32_t particle = cloth->topology.weld[i];
        if (cloth->particles.w[particle] > 0)
            cloth->particles.x[particle] = vec3d_from(positions[i]);
    }
}

void tl_cloth_positions(const tl_cloth *cloth, vec3s *out)
{
    for (size_t i = 0; i < cloth->topology.render_count; i++)
        out[i] = vec3d_to_float(cloth->particles.x[cloth->topology.weld[i]]);
}

const uint32_t *tl_cloth_weld(const tl_cloth *cloth)
{
    return cloth->topology.weld;
}
