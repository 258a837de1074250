#include "cloth/build.h"

#include "cloth/solvers/xpbd.h"
#include "cloth/timestep.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Inverse masses; 0 holds a particle: pins, and vertices that no triangle uses. Masses have a lower bound
 * because slivers weigh next to nothing: see TL_CLOTH_MIN_MASS. */
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
    double min = TL_CLOTH_MIN_MASS * total / (double)count;
    for (size_t i = 0; i < count; i++) {
        double mass = fmax(cloth->energy.masses[i], min) * cloth->fabric.areal_density;
        w[i] = used[i] && mass > 0 ? 1 / mass : 0;
    }
    for (size_t i = 0; i < cloth->pin_count; i++)
        w[cloth->pins[i].particle] = 0;
    free(used);
}

static void set_energy(tl_cloth *cloth)
{
    const bool symmetric = tl_cloth_uses_symmetric_sweep(cloth);
    tl_energy_set_preview(&cloth->energy, &cloth->fabric, cloth->particles.w,
                          tl_xpbd_step(tl_cloth_substep(cloth), symmetric), symmetric);
}

/* The step is infinite where nothing resists. */
static void set_wave_step(tl_cloth *cloth)
{
    const size_t vertex_count = cloth->particles.count;
    double *sums = TL_NEW_ARRAY(double, vertex_count + 1), total = 0, count = 0;
    tl_energy_row_sums(&cloth->energy, &cloth->fabric, vertex_count, NULL, sums);
    for (size_t i = 0; i < vertex_count; i++)
        if (cloth->particles.w[i] > 0 && sums[i] > 0) {
            total += 2 / sqrt(cloth->particles.w[i] * sums[i]);
            count++;
        }
    cloth->wave_step_s = count > 0 ? total / count : HUGE_VAL;
    free(sums);
}

void tl_cloth_set_constants(tl_cloth *cloth)
{
    set_inverse_masses(cloth);
    tl_energy_set_fabric(&cloth->energy, &cloth->fabric);
    set_wave_step(cloth);
    cloth->critical_step = tl_energy_critical_step(&cloth->energy, &cloth->fabric, cloth->particles.count,
                                                   cloth->particles.w, NULL);
    cloth->forces = tl_resize(cloth->forces, cloth->particles.count, sizeof *cloth->forces);
    set_energy(cloth);
    tl_contacts_release(&cloth->contacts); /* the planes depend on the thickness */
    cloth->contacts = tl_contacts_create(&cloth->topology, cloth->rest);
    tl_strain_limits_release(&cloth->limits);
    cloth->limits =
        tl_strain_limits_create(&cloth->topology, &cloth->energy, (const vec2s(*)[3])cloth->rest,
                                cloth->shortest_edge, cloth->params.strain_limit, cloth->particles.x);
    tl_layers_forget(&cloth->layers);
    tl_self_contact_forget(&cloth->self_contact);
    cloth->undriven = cloth->cage_is_current = false;
}

void tl_cloth_set_prestress(tl_cloth *cloth, bool is_prestressed)
{
    tl_energy_clear_prestress(&cloth->energy);
    cloth->energy.is_prestressed = is_prestressed; /* on which the substep depends */
    set_energy(cloth);
    if (is_prestressed)
        tl_energy_set_prestress(&cloth->energy, &cloth->fabric, cloth->particles.w, tl_cloth_substep(cloth),
                                cloth->particles.x);
}

void tl_cloth_use_solver(tl_cloth *cloth, const struct tl_cloth_params *params)
{
    const struct tl_cloth_params *now = &cloth->params;
    if (now->solver == params->solver && now->dt == params->dt && now->frame_rate == params->frame_rate &&
        now->substeps == params->substeps)
        return;
    cloth->params = *params;
    set_energy(cloth);
}

/* Shorter edges are not measured for strain: a hundredth of the mean edge length, which is about the root of
 * the mean area per vertex. */
static double find_shortest_edge(const tl_cloth *cloth)
{
    double area = 0;
    for (size_t i = 0; i < cloth->topology.vertex_count; i++)
        area += cloth->energy.masses[i];
    return 0.01 * sqrt(area / (double)cloth->topology.vertex_count);
}

/* Share of the triangles that are needles: their height is less than a sixteenth of their longest side. */
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

void tl_cloth_build_mesh(tl_cloth *cloth, const uint32_t *weld, size_t vertex_count)
{
    const tl_mesh *mesh = &cloth->garment->model.mesh;
    tl_topology_release(&cloth->topology);
    tl_energy_release(&cloth->energy);
    free(cloth->rest);
    cloth->topology =
        tl_topology_build(mesh->indices, mesh->index_count, weld, mesh->vertex_count, vertex_count);
    cloth->rest = tl_rest_shapes(cloth->garment, &cloth->topology);
    cloth->made_at = tl_resize(cloth->made_at, vertex_count, sizeof *cloth->made_at);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        cloth->made_at[weld[i]] = vec3d_from(mesh->positions[i]);
    cloth->energy =
        tl_energy_build(&cloth->topology, cloth->rest, cloth->garment->pattern ? NULL : cloth->made_at);
    cloth->shortest_edge = find_shortest_edge(cloth);
    cloth->needle_share = find_needle_share(cloth);
    tl_layers_release(&cloth->layers);
    tl_self_contact_forget(&cloth->self_contact);
}

void tl_cloth_add_pin(tl_cloth *cloth, uint32_t particle, bool by_hand)
{
    cloth->pins = tl_resize(cloth->pins, cloth->pin_count + 1, sizeof *cloth->pins);
    cloth->pins[cloth->pin_count++] = (struct tl_pin){
        .particle = particle, .by_hand = by_hand, .at = cloth->particles.x[particle], .triangle = TL_NONE};
}

void tl_cloth_make_pins(tl_cloth *cloth)
{
    const tl_garment *garment = cloth->garment;
    double above_m = cloth->params.pin_above_m;
    cloth->pin_count = 0;
    memset(cloth->particles.driven, 0, cloth->particles.count * sizeof(bool));
    for (size_t i = 0; i < garment->pin_count; i++)
        tl_cloth_add_pin(cloth, cloth->topology.weld[garment->pins[i]], false);
    for (uint32_t i = 0; above_m > 0 && i < cloth->particles.count; i++)
        if (cloth->made_at[i].y > above_m)
            tl_cloth_add_pin(cloth, i, false);
    int channel = cloth->params.pin_colour - TL_PIN_RED;
    for (size_t i = 0; channel >= 0 && garment->model.colours && i < garment->model.mesh.vertex_count; i++)
        if (tl_model_is_painted(&garment->model, i, channel))
            tl_cloth_add_pin(cloth, cloth->topology.weld[i], false);
}

void tl_cloth_build_state(tl_cloth *cloth)
{
    const tl_garment *garment = cloth->garment;
    const tl_mesh *mesh = &garment->model.mesh;
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    size_t count = mesh->vertex_count;
    for (size_t i = 0; i < count; i++)
        weld[i] = (uint32_t)i;
    if (!garment->welds_seams_only)
        count = tl_weld_positions(mesh->positions, mesh->vertex_count, weld);
    tl_cloth_build_mesh(cloth, weld, count);
    cloth->particles = tl_particles_create(count);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        cloth->particles.x[weld[i]] = vec3d_from(mesh->positions[i]);
    cloth->seams = tl_seams_create(garment->seams, garment->seam_count, weld);
    free(weld);
    tl_cloth_make_pins(cloth);
    tl_cloth_set_constants(cloth);
}

void tl_cloth_release_state(tl_cloth *cloth)
{
    tl_topology_release(&cloth->topology);
    tl_energy_release(&cloth->energy);
    tl_particles_release(&cloth->particles);
    tl_contacts_release(&cloth->contacts);
    tl_layers_release(&cloth->layers);
    tl_self_contact_release(&cloth->self_contact);
    tl_strain_limits_release(&cloth->limits);
    tl_seams_release(&cloth->seams);
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
    if (cloth->cage)
        cloth->destroy_cage(&cloth->cage);
    cloth->has_no_cage = false;
}

void tl_cloth_join(tl_cloth *cloth, const uint32_t *joined, size_t joined_count)
{
    struct tl_particles from = cloth->particles, to = tl_particles_create(joined_count);
    double *masses = TL_NEW_ARRAY(double, joined_count);
    bool *held = TL_NEW_ARRAY(bool, joined_count);
    for (size_t i = 0; i < from.count; i++) { /* if one of the joined particles is held, it alone decides */
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
    tl_cloth_build_mesh(cloth, weld, joined_count);
    free(weld);
    tl_particles_release(&cloth->particles);
    cloth->particles = to;
    for (size_t i = 0; i < cloth->pin_count; i++)
        cloth->pins[i].particle = joined[cloth->pins[i].particle];
    tl_cloth_set_constants(cloth);
}
