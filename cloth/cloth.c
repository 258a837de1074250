#include "cloth/cloth.h"

#include "cloth/solvers/xpbd.h"
#include "cloth/state.h"
#include "cloth/tangents/frames.h"
#include "config/memory.h"

#include <stdlib.h>
#include <string.h>

/* ---- What is refused ---- */

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
            return tl_fail(error, TL_INPUT, "%s: %s %zu names vertex %u of %zu: mend the garment", name, what,
                           i, indices[i], vertex_count);
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
            return tl_fail(error, TL_INPUT, "%s: vertex %zu is not finite: mend the garment", name, i);
    }
    return check_indices(name, "corner", mesh->indices, mesh->index_count, mesh->vertex_count, error) &&
           check_indices(name, "seam end", (const uint32_t *)garment->seams, 2 * garment->seam_count,
                         mesh->vertex_count, error) &&
           check_indices(name, "pin", garment->pins, garment->pin_count, mesh->vertex_count, error);
}

/* ---- Building the state ---- */

/* Inverse masses: held for pins and for vertices that no triangle uses. Slivers weigh next to nothing. */
static void set_inverse_masses(tl_cloth *cloth)
{
    size_t count = cloth->particles.count;
    double *w = cloth->particles.w, total = 0;
    bool *used = TL_NEW_ARRAY(bool, count);
    for (size_t t = 0; t < cloth->topology.triangle_count; t++)
        for (int i = 0; i < 3; i++)
            used[cloth->topology.triangles[t][i]] = true;
    for (size_t i = 0; i < count; i++)
        total += cloth->energy.masses[i];
    double least = TL_CLOTH_LEAST_MASS * total / (double)count;
    for (size_t i = 0; i < count; i++) {
        double mass = fmax(cloth->energy.masses[i], least) * cloth->fabric.areal_density;
        w[i] = used[i] && mass > 0 ? 1 / mass : 0;
    }
    for (size_t i = 0; i < cloth->pin_count; i++)
        w[cloth->pins[i].particle] = 0;
    free(used);
}

static void set_energy(tl_cloth *cloth)
{
    bool back = tl_cloth_sweeps_back(cloth);
    tl_energy_set(&cloth->energy, &cloth->fabric, cloth->particles.w,
                  tl_xpbd_step(tl_cloth_substep(cloth), back));
    cloth->energy.bends_as_force = cloth->energy.bends_as_force && !back; /* measured with the whole step */
}

static void set_constants(tl_cloth *cloth)
{
    set_inverse_masses(cloth);
    tl_energy_set_fabric(&cloth->energy, &cloth->fabric);
    cloth->critical_step = tl_energy_critical_step(&cloth->energy, &cloth->fabric, cloth->particles.count,
                                                   cloth->particles.w, NULL);
    cloth->forces = tl_resize(cloth->forces, cloth->particles.count, sizeof *cloth->forces);
    tl_implicit_destroy(&cloth->implicit);
    set_energy(cloth);
    tl_contacts_release(&cloth->contacts); /* its planes know the thickness */
    cloth->contacts = tl_contacts_create(&cloth->topology, cloth->rest);
    tl_limits_release(&cloth->limits);
    cloth->limits = tl_limits_create(&cloth->topology, &cloth->energy, (const vec2s(*)[3])cloth->rest,
                                     cloth->shortest_edge, cloth->params.strain_limit, cloth->particles.x);
    tl_layers_forget(&cloth->layers);
    cloth->left_alone = false;
}

void tl_cloth_use(tl_cloth *cloth, const struct tl_cloth_params *params)
{
    const struct tl_cloth_params *now = &cloth->params;
    if (now->solver == params->solver && now->dt == params->dt && now->frame_rate == params->frame_rate)
        return;
    cloth->params = *params;
    tl_implicit_destroy(&cloth->implicit);
    set_energy(cloth);
}

/* A hundredth of the mean edge. */
static double find_shortest_edge(const tl_cloth *cloth)
{
    double area = 0;
    for (size_t i = 0; i < cloth->topology.vertex_count; i++)
        area += cloth->energy.masses[i];
    return 0.01 * sqrt(area / (double)cloth->topology.vertex_count);
}

/* The share of triangles whose height is less than a sixteenth of their longest side. */
static double find_needle_share(const tl_cloth *cloth)
{
    const double needle = 1.0 / 16;
    size_t count = 0;
    for (size_t t = 0; t < cloth->topology.triangle_count; t++) {
        const vec2s *corners = cloth->rest[t];
        vec2s side = glms_vec2_sub(corners[1], corners[0]), other = glms_vec2_sub(corners[2], corners[0]);
        double longest = (double)fmaxf(glms_vec2_distance(corners[1], corners[2]),
                                       fmaxf(glms_vec2_norm(side), glms_vec2_norm(other)));
        count += fabs((double)glms_vec2_cross(side, other)) < needle * longest * longest;
    }
    return (double)count / (double)cloth->topology.triangle_count;
}

/* Everything that follows from a numbering of the physics vertices, but for positions and velocities. */
static void build_mesh(tl_cloth *cloth, const uint32_t *weld, size_t vertex_count)
{
    const tl_mesh *mesh = &cloth->garment->model.mesh;
    tl_topology_release(&cloth->topology);
    tl_energy_release(&cloth->energy);
    free(cloth->rest);
    cloth->topology =
        tl_topology_build(mesh->indices, mesh->index_count, weld, mesh->vertex_count, vertex_count);
    cloth->rest = tl_rest_shapes(cloth->garment, &cloth->topology);
    cloth->energy = tl_energy_build(&cloth->topology, cloth->rest);
    cloth->shortest_edge = find_shortest_edge(cloth);
    cloth->needle_share = find_needle_share(cloth);
    cloth->made_at = tl_resize(cloth->made_at, vertex_count, sizeof *cloth->made_at);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        cloth->made_at[weld[i]] = vec3d_from(mesh->positions[i]);
    tl_layers_release(&cloth->layers);
}

static void add_pin(tl_cloth *cloth, uint32_t particle, bool by_hand)
{
    cloth->pins = tl_resize(cloth->pins, cloth->pin_count + 1, sizeof *cloth->pins);
    cloth->pins[cloth->pin_count++] = (struct tl_pin){
        .particle = particle, .by_hand = by_hand, .at = cloth->particles.x[particle], .triangle = TL_NONE};
}

/* The garment's own, and what starts above cloth.pin_above_m or has cloth.pin_colour, where they are now. */
static void make_pins(tl_cloth *cloth)
{
    const tl_garment *garment = cloth->garment;
    double above_m = cloth->params.pin_above_m;
    cloth->pin_count = 0;
    memset(cloth->particles.driven, 0, cloth->particles.count * sizeof(bool));
    for (size_t i = 0; i < garment->pin_count; i++)
        add_pin(cloth, cloth->topology.weld[garment->pins[i]], false);
    for (uint32_t i = 0; above_m > 0 && i < cloth->particles.count; i++)
        if (cloth->made_at[i].y > above_m)
            add_pin(cloth, i, false);
    int channel = cloth->params.pin_colour - TL_PIN_RED;
    for (size_t i = 0; channel >= 0 && garment->model.colours && i < garment->model.mesh.vertex_count; i++)
        if (tl_model_is_painted(&garment->model, i, channel))
            add_pin(cloth, cloth->topology.weld[i], false);
}

static void build_state(tl_cloth *cloth)
{
    const tl_garment *garment = cloth->garment;
    const tl_mesh *mesh = &garment->model.mesh;
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    size_t count = tl_weld_positions(mesh->positions, mesh->vertex_count, weld);
    build_mesh(cloth, weld, count);
    cloth->particles = tl_particles_create(count);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        cloth->particles.x[weld[i]] = vec3d_from(mesh->positions[i]);
    cloth->sewing = tl_sewing_create(garment->seams, garment->seam_count, weld, cloth->particles.x);
    free(weld);
    make_pins(cloth);
    set_constants(cloth);
}

static void release_state(tl_cloth *cloth)
{
    tl_topology_release(&cloth->topology);
    tl_energy_release(&cloth->energy);
    tl_particles_release(&cloth->particles);
    tl_contacts_release(&cloth->contacts);
    tl_layers_release(&cloth->layers);
    tl_repulsion_release(&cloth->repulsion);
    tl_limits_release(&cloth->limits);
    tl_sewing_release(&cloth->sewing);
    tl_implicit_destroy(&cloth->implicit);
    free(cloth->rest);
    free(cloth->made_at);
    free(cloth->pins);
    free(cloth->forces);
    free(cloth->external);
    free(cloth->good_x);
    free(cloth->good_v);
    cloth->rest = NULL;
    cloth->made_at = NULL;
    cloth->pins = NULL;
    cloth->forces = NULL;
    cloth->external = NULL;
    cloth->good_x = cloth->good_v = NULL;
}

void tl_cloth_join(tl_cloth *cloth, const uint32_t *joined, size_t joined_count)
{
    struct tl_particles from = cloth->particles, to = tl_particles_create(joined_count);
    double *masses = TL_NEW_ARRAY(double, joined_count);
    bool *held = TL_NEW_ARRAY(bool, joined_count);
    for (size_t i = 0; i < from.count; i++) { /* held ones decide where they all are */
        uint32_t j = joined[i];
        bool holds = !(from.w[i] > 0);
        if (held[j] && !holds)
            continue;
        if (holds && !held[j])
            masses[j] = 0;
        held[j] = holds;
        double mass = holds ? 1 : 1 / from.w[i];
        masses[j] += mass;
        to.x[j] = vec3d_mix(to.x[j], from.x[i], mass / masses[j]);
        to.v[j] = vec3d_mix(to.v[j], from.v[i], mass / masses[j]);
    }
    free(masses);
    free(held);

    uint32_t *weld = TL_NEW_ARRAY(uint32_t, cloth->topology.render_count);
    for (size_t i = 0; i < cloth->topology.render_count; i++)
        weld[i] = joined[cloth->topology.weld[i]];
    build_mesh(cloth, weld, joined_count);
    free(weld);
    tl_particles_release(&cloth->particles);
    cloth->particles = to;
    for (size_t i = 0; i < cloth->pin_count; i++)
        cloth->pins[i].particle = joined[cloth->pins[i].particle];
    set_constants(cloth);
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
    build_state(cloth);
    return cloth;
}

void tl_cloth_destroy(tl_cloth **cloth)
{
    if (!*cloth)
        return;
    release_state(*cloth);
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
    cloth->fabric = *fabric;
    cloth->params = *params;
    if (pins_change)
        make_pins(cloth);
    set_constants(cloth);
    return true;
}

/* What contacts remember would make a run after a reset differ from the first one: the planes, and of
 * `settle` what stuck and slipped; and so would the time since the limits began. */
static void forget_past(tl_cloth *cloth)
{
    tl_limits_restart(&cloth->limits, cloth->particles.x);
    tl_implicit_destroy(&cloth->implicit);
    tl_contacts_release(&cloth->contacts);
    cloth->contacts = tl_contacts_create(&cloth->topology, cloth->rest);
    for (size_t i = 0; i < cloth->topology.render_count; i++)
        cloth->contacts.pinched[cloth->topology.weld[i]] |= cloth->start_pinched[i];
    tl_layers_forget(&cloth->layers);
}

/* Kept by render vertex: seams that close later change the particles, but not these. */
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
    cloth->left_alone = false;
    forget_past(cloth);
}

void tl_cloth_reset(tl_cloth *cloth)
{
    cloth->grabbed = cloth->left_alone = false;
    cloth->time_s = 0;
    if (!cloth->start_x) {
        release_state(cloth);
        cloth->settled = false;
        build_state(cloth);
        return;
    }
    tl_cloth_unpin(cloth);
    for (size_t i = 0; i < cloth->topology.render_count; i++) {
        cloth->particles.x[cloth->topology.weld[i]] = cloth->start_x[i];
        cloth->particles.v[cloth->topology.weld[i]] = cloth->start_v[i];
    }
    forget_past(cloth);
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
    add_pin(cloth, cloth->topology.weld[render_vertex], true);
    set_constants(cloth);
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
        set_constants(cloth);
    return count - kept;
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

double tl_cloth_max_speed(const tl_cloth *cloth)
{
    double fastest = 0;
    for (size_t i = 0; i < cloth->particles.count; i++)
        if (cloth->particles.w[i] > 0)
            fastest = fmax(fastest, vec3d_dot(cloth->particles.v[i], cloth->particles.v[i]));
    return sqrt(fastest);
}

/* A mesh shows folds as fine as its usual edge, and the short edge of a sliver takes what its neighbours
 * leave of them: below a quarter of the usual length it counts as that long. (A dress as a heap on the floor:
 * one edge of 0.4 mm among such of 8 is 1.5 mm long, no other is strained by more than 0.7.) */
#define RESOLVED_EDGES 25 /* shortest ones, of a hundredth */

double tl_cloth_max_strain(const tl_cloth *cloth)
{
    double worst = 0, most = 1, least = 1; /* of the squared ratio of lengths: beyond is worse */
    double shortest = cloth->shortest_edge * cloth->shortest_edge;
    double resolved = RESOLVED_EDGES * cloth->shortest_edge;
    const vec3d *x = cloth->particles.x;
    for (size_t m = 0; m < cloth->topology.triangle_count; m++) {
        const uint32_t *t = cloth->topology.triangles[m];
        for (int i = 0; i < 3; i++) {
            vec2s side = glms_vec2_sub(cloth->rest[m][(i + 1) % 3], cloth->rest[m][i]);
            vec3d now = vec3d_sub(x[t[(i + 1) % 3]], x[t[i]]);
            double rest = (double)side.x * (double)side.x + (double)side.y * (double)side.y;
            double length = vec3d_dot(now, now);
            if (!(rest > shortest) || (length <= most * rest && length >= least * rest))
                continue;
            worst = fmax(worst, fabs(sqrt(length) - sqrt(rest)) / fmax(sqrt(rest), resolved));
            most = (1 + worst) * (1 + worst);
            least = worst < 1 ? (1 - worst) * (1 - worst) : 0;
        }
    }
    return worst;
}

/* Over the sides of all triangles, by the same measure. */
static double usual_strain(const tl_cloth *cloth)
{
    double resolved = RESOLVED_EDGES * cloth->shortest_edge, squares = 0;
    const vec3d *x = cloth->particles.x;
    for (size_t m = 0; m < cloth->topology.triangle_count; m++)
        for (int i = 0; i < 3; i++) {
            const uint32_t *t = cloth->topology.triangles[m];
            double rest = (double)glms_vec2_distance(cloth->rest[m][(i + 1) % 3], cloth->rest[m][i]);
            double off = (vec3d_distance(x[t[(i + 1) % 3]], x[t[i]]) - rest) / fmax(rest, resolved);
            squares += rest > cloth->shortest_edge ? off * off : 0;
        }
    return sqrt(squares / (3.0 * (double)cloth->topology.triangle_count));
}

/* Behind the surface that is nearest, and within what it surrounds. */
static double depth_at(const tl_collider *collider, const double point[3], double least)
{
    const double reach_m = 0.1;
    struct tl_contact contact;
    bool behind = tl_collider_query(collider, point, reach_m, &contact) && -contact.distance_m > least;
    return behind && tl_collider_winding(collider, point) > 0.5 ? -contact.distance_m : least;
}

static double deepest(const tl_cloth *cloth, const tl_collider *collider)
{
    double worst = 0;
    for (size_t i = 0; i < cloth->particles.count; i++) {
        const double point[3] = {cloth->particles.x[i].x, cloth->particles.x[i].y, cloth->particles.x[i].z};
        worst = depth_at(collider, point, worst);
        if (tl_collider_has_ground(collider))
            worst = fmax(worst, -point[1]);
    }
    return worst;
}

struct tl_energies tl_cloth_energies(const tl_cloth *cloth)
{
    struct tl_energies energies = {0};
    vec3d *forces = TL_NEW_ARRAY(vec3d, cloth->particles.count);
    energies.elastic =
        tl_energy_forces(&cloth->energy, &cloth->fabric, cloth->particles.count, cloth->particles.x, forces);
    free(forces);
    for (size_t i = 0; i < cloth->particles.count; i++) {
        vec3d x = cloth->particles.x[i], v = cloth->particles.v[i];
        double mass = cloth->particles.w[i] > 0 ? 1 / cloth->particles.w[i] : 0;
        energies.mass += mass;
        energies.kinetic += 0.5 * mass * vec3d_dot(v, v);
        energies.potential += mass * cloth->params.gravity * x.y;
    }
    return energies;
}

struct tl_cloth_report tl_cloth_measure(const tl_cloth *cloth, const tl_collider *collider)
{
    struct tl_cloth_report report = {.vertex_count = cloth->topology.vertex_count,
                                     .edge_count = cloth->topology.edge_count,
                                     .triangle_count = cloth->topology.triangle_count,
                                     .layer_count = cloth->layers.layer_count,
                                     .open_seams = cloth->sewing.pair_count,
                                     .time_s = cloth->time_s,
                                     .max_speed = tl_cloth_max_speed(cloth),
                                     .max_strain = tl_cloth_max_strain(cloth),
                                     .usual_strain = usual_strain(cloth),
                                     .critical_step_s = cloth->critical_step,
                                     .substep_s = tl_cloth_substep(cloth),
                                     .unconverged_steps = cloth->tally.unconverged,
                                     .shortened_steps = cloth->tally.shortened,
                                     .caught_count = cloth->contacts.caught_count,
                                     .settled = cloth->settled};
    struct tl_energies energies = tl_cloth_energies(cloth);
    report.kinetic_energy = energies.kinetic;
    report.elastic_energy = energies.elastic;
    report.potential_energy = energies.potential;
    uint32_t *pieces = TL_NEW_ARRAY(uint32_t, cloth->topology.vertex_count);
    report.piece_count = tl_layers_pieces(&cloth->topology, pieces);
    free(pieces);
    if (collider)
        report.deepest_m = deepest(cloth, collider);
    return report;
}
