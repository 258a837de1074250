#include "cloth/measure.h"

#include "cloth/contact/peaks.h"
#include "cloth/contacts.h"
#include "cloth/self_contact/crossings.h"
#include "cloth/timestep.h"
#include "config/base/memory.h"

#include <stdlib.h>

double tl_cloth_max_speed(const tl_cloth *cloth)
{
    double fastest = 0;
    for (size_t i = 0; i < cloth->particles.count; i++)
        if (cloth->particles.w[i] > 0)
            fastest = fmax(fastest, vec3d_dot(cloth->particles.v[i], cloth->particles.v[i]));
    return sqrt(fastest);
}

/* Strain is change of length over rest length, which is meaningless for an edge much shorter than usual: a
 * mesh resolves folds no finer than its usual edge, and the short edge of a sliver absorbs the rest.
 * (Example: a dress as a heap on the floor; one edge of 0.4 mm among edges of 8 mm is 1.5 mm long, and no
 * other is strained by more than 0.7.) So the divisor is at least a quarter of the usual edge length. */
#define RESOLVED_EDGES                                                                                       \
    25 /* times shortest_edge, which is a hundredth of the mean edge: a quarter of that                      \
        */

double tl_cloth_max_strain(const tl_cloth *cloth)
{
    double worst = 0;
    double max = 1, min = 1; /* squared length ratios within these cannot exceed `worst`: no root is needed */
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
            if (!(rest > shortest) || (length <= max * rest && length >= min * rest))
                continue;
            worst = fmax(worst, fabs(sqrt(length) - sqrt(rest)) / fmax(sqrt(rest), resolved));
            max = (1 + worst) * (1 + worst);
            min = worst < 1 ? (1 - worst) * (1 - worst) : 0;
        }
    }
    return worst;
}

double tl_cloth_moved_from(const tl_cloth *cloth, const vec3d *from)
{
    const struct tl_particles *particles = &cloth->particles;
    double squares = 0;
    for (size_t i = 0; i < particles->count; i++) {
        const vec3d way = vec3d_sub(particles->x[i], from[i]);
        squares += vec3d_dot(way, way);
    }
    return sqrt(squares / (double)particles->count);
}

bool tl_cloth_is_still(const tl_cloth *cloth)
{
    return !cloth->good_x ||
           tl_cloth_moved_from(cloth, cloth->good_x) * cloth->params.frame_rate <= cloth->params.settle_speed;
}

/* Root mean square over the sides of all triangles. */
static double rms_strain(const tl_cloth *cloth)
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

/* Depth of a point below the surface; 0: outside. The sign at the nearest feature is not enough: where the
 * surface passes through itself, creases are inside out. The winding number, which is expensive, confirms it.
 */
static double depth_at(const tl_collider *collider, const double point[3])
{
    const double reach_m = 0.1;
    struct tl_contact contact;
    bool behind = tl_collider_query(collider, point, reach_m, &contact) && contact.distance_m < 0;
    return behind && tl_collider_winding(collider, point) > 0.5 ? -contact.distance_m : 0;
}

static void measure_depths(const tl_cloth *cloth, const tl_collider *collider, struct tl_cloth_report *report)
{
    for (size_t i = 0; i < cloth->particles.count; i++) {
        const double point[3] = {cloth->particles.x[i].x, cloth->particles.x[i].y, cloth->particles.x[i].z};
        double depth = depth_at(collider, point);
        if (tl_collider_has_ground(collider))
            depth = fmax(depth, -point[1]);
        report->inside_count += depth > 0;
        report->deepest_m = fmax(report->deepest_m, depth);
    }
}

static void measure_skin(const tl_cloth *cloth, const tl_collider *collider, struct tl_cloth_report *report)
{
    struct tl_peak *peaks;
    struct tl_skin_grid skin = tl_skin_grid_create(collider, 1, -1);
    report->skin_count = tl_peaks_find(&skin, &cloth->topology, cloth->particles.x, NULL, 0, &peaks);
    for (size_t i = 0; i < report->skin_count; i++)
        report->skin_m = fmax(report->skin_m, peaks[i].beyond_m);
    free(peaks);
    tl_skin_grid_release(&skin);
}

struct tl_energies tl_cloth_energies(const tl_cloth *cloth)
{
    struct tl_energies energies = {0};
    vec3d *forces = TL_NEW_ARRAY(vec3d, cloth->particles.count);
    energies.elastic = tl_energy_evaluate(&cloth->energy, &cloth->fabric, cloth->particles.count,
                                          cloth->particles.x, forces);
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

/* Contact's own tree is fitted to other positions whenever it is used. */
static size_t count_crossings(const tl_cloth *cloth)
{
    struct tl_near_tree tree = cloth->self_contact.near.tree;
    return tl_crossings_count(cloth->self_contact.made ? &tree : NULL, &cloth->topology, cloth->particles.x);
}

struct tl_cloth_report tl_cloth_measure(const tl_cloth *cloth, const tl_collider *collider)
{
    /* Across a fold of a cage, edges of what follows it are as short as the fold is thin: no strain. */
    const tl_cloth *moved = cloth->was_caged ? cloth->caged_cloth : cloth;
    struct tl_cloth_report report = {.vertex_count = cloth->topology.vertex_count,
                                     .edge_count = cloth->topology.edge_count,
                                     .triangle_count = cloth->topology.triangle_count,
                                     .crossing_count = count_crossings(cloth),
                                     .layer_count = cloth->layers.layer_count,
                                     .open_seams = cloth->seams.pair_count,
                                     .time_s = cloth->time_s,
                                     .max_speed = tl_cloth_max_speed(cloth),
                                     .max_strain = tl_cloth_max_strain(moved),
                                     .rms_strain = rms_strain(moved),
                                     .critical_step_s = cloth->critical_step,
                                     .substep_s = tl_cloth_substep(cloth),
                                     .caught_count = moved->contacts.caught_count,
                                     .settled = cloth->settled};
    struct tl_energies energies = tl_cloth_energies(cloth);
    report.kinetic_energy = energies.kinetic;
    report.elastic_energy = energies.elastic;
    report.potential_energy = energies.potential;
    uint32_t *pieces = TL_NEW_ARRAY(uint32_t, cloth->topology.vertex_count);
    report.piece_count = tl_layers_pieces(&cloth->topology, pieces);
    free(pieces);
    if (collider) {
        measure_depths(cloth, collider, &report);
        measure_skin(cloth, collider, &report);
    }
    return report;
}

struct tl_residual tl_cloth_residual(const tl_cloth *cloth, const tl_collider *collider)
{
    struct tl_contacts body;
    struct tl_self_contact self;
    vec3d *forces = TL_NEW_ARRAY(vec3d, cloth->particles.count);
    tl_energy_forces(&cloth->energy, &cloth->fabric, cloth->particles.x, forces, NULL);
    tl_cloth_find_contacts(cloth, collider, &body, &self);
    const struct tl_residual_source source = {.particles = &cloth->particles,
                                              .forces = forces,
                                              .body = &body,
                                              .self = self.made ? &self.contacts : NULL,
                                              .gravity = cloth->params.gravity,
                                              .friction = cloth->fabric.friction,
                                              .thickness_m = cloth->fabric.thickness_m};
    struct tl_residual residual = tl_residual_measure(&source);
    tl_contacts_release(&body);
    tl_self_contact_release(&self);
    free(forces);
    return residual;
}

struct tl_balance tl_cloth_balance(const tl_cloth *cloth)
{
    return cloth->balance;
}
