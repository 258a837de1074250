#include "cloth/step/advance.h"

#include "cloth/build.h"
#include "cloth/contacts.h"
#include "cloth/drive/hand.h"
#include "cloth/drive/holds.h"
#include "cloth/drive/wind.h"
#include "cloth/measure.h"
#include "cloth/mesh/denormals.h"
#include "cloth/solvers/verlet.h"
#include "cloth/solvers/xpbd.h"
#include "cloth/timestep.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* The pull of tl_cloth_grab: a soft spring, N/m, whose force, N, is bounded by the weight of a heavy coat. */
#define GRAB_STIFFNESS 200.0
#define GRAB_FORCE     5.0

/* Damping of relative velocities along edges, as a multiple of fabric.damping: the weave's inner friction. */
#define INNER_DAMPING 10

/* One substep, as the solvers see it. */
struct tl_substep {
    double h; /* s */
    double gravity, drag;
    double phase_before, phase; /* of the collider's motion at the substep's start and end */
    const tl_collider *collider;
    bool continues_previous; /* follows a substep directly: a solver may have merged that one's end with this
                                one's start */
    bool continues_next;     /* is followed directly by another */
};

/* Whether the chosen solver can simulate this fabric within its budget of substeps. */
static bool check_budget(const tl_cloth *cloth, tl_error *error)
{
    double wanted = tl_cloth_substeps_per_step(cloth) * tl_cloth_steps_per_frame(&cloth->params);
    if (cloth->params.solver != TL_CLOTH_REFERENCE || wanted <= cloth->params.reference_substeps)
        return true;
    return tl_fail(error, TL_USAGE,
                   "cloth: the reference solver's step for this fabric is %.3g s, %.4g substeps a frame, and "
                   "cloth.reference_substeps allows %d: allow more, or choose cloth.solver preview",
                   TL_VERLET_SAFETY * cloth->critical_step, wanted, cloth->params.reference_substeps);
}

/* ---- A frame ---- */

/* The end of the pull's spring at a phase of the frame. If it jumped once a frame, one vertex of a fine mesh
 * would be pulled over many of its edges before any other vertex could follow. */
static vec3d hand_at(const tl_cloth *cloth, double phase)
{
    vec3d step = vec3d_sub(cloth->grab_target, cloth->grab_from);
    return vec3d_muladd(cloth->grab_from, step, phase);
}

static void pull_grabbed(tl_cloth *cloth, const struct tl_substep *substep)
{
    double h = substep->h;
    if (!cloth->grabbed)
        return;
    uint32_t i = cloth->topology.weld[cloth->grabbed_vertex];
    double w = cloth->particles.w[i];
    vec3d step = vec3d_sub(hand_at(cloth, substep->phase), cloth->particles.x[i]);
    double length = vec3d_norm(step);
    if (!(w > 0) || !(length > 0))
        return;
    double impulse = fmin(length / (w + 1 / (GRAB_STIFFNESS * h * h)), GRAB_FORCE * h * h);
    step = vec3d_scale(step, w * impulse / length);
    double share = tl_hand_share(&cloth->limits, &cloth->energy.pairs, &cloth->particles, i, step);
    cloth->particles.x[i] = vec3d_muladd(cloth->particles.x[i], step, share);
}

static struct tl_contact_params contact_params(const tl_cloth *cloth, const struct tl_substep *substep)
{
    return tl_cloth_contact_params(cloth, substep->h, substep->phase_before, substep->phase);
}

static void draw_seams(tl_cloth *cloth, const struct tl_substep *substep)
{
    const tl_garment *garment = cloth->garment;
    if (cloth->hanging || tl_seams_are_closing(&cloth->seams))
        tl_holds_draw(garment->holds, garment->hold_count, cloth->topology.weld, cloth->hanging, substep->h,
                      &cloth->particles);
    if (cloth->seams.pair_count > 0)
        tl_seams_solve(&cloth->seams, &cloth->particles, substep->h);
}

/* The last constraint is the strongest: gentle seams come before the strain limit. */
static bool seams_come_last(const tl_cloth *cloth)
{
    return tl_seams_are_firm(&cloth->seams);
}

/* Projects positions onto the constraints that are not in the elastic energy: seams, the pull, contact. */
static void apply_constraints(tl_cloth *cloth, const struct tl_substep *substep, bool draws_seams)
{
    const struct tl_contact_params contact = contact_params(cloth, substep);
    if (draws_seams)
        draw_seams(cloth, substep);
    pull_grabbed(cloth, substep);
    tl_cloth_solve_contact(cloth, &contact);
}

/* One substep of XPBD: predict x from v and external forces, project the constraints, then take v from the
 * displacement. The strain limit comes after the elastic constraints, which would otherwise undo it, and
 * contact comes last, so that no substep ends inside the avatar. */
static void advance_preview(tl_cloth *cloth, const struct tl_substep *substep)
{
    const bool pushes = tl_energy_has_explicit_forces(&cloth->energy);
    struct tl_prediction prediction =
        tl_prediction_make(pushes ? cloth->forces : NULL, substep->gravity, substep->drag, substep->h);
    prediction.velocity_from_positions = substep->continues_previous;
    const struct tl_particle_kernel predict = tl_prediction_kernel(&cloth->particles, &prediction);
    if (pushes)
        tl_energy_explicit_forces(&cloth->energy, cloth->particles.x, cloth->forces, &predict);
    else
        tl_particles_run(&predict);
    tl_pins_place(cloth->pins, cloth->pin_count, substep->collider, substep->phase, &cloth->particles);
    bool limited = cloth->params.strain_limit > 0, seams_last = seams_come_last(cloth);
    if (!seams_last)
        draw_seams(cloth, substep);
    tl_xpbd_solve(&cloth->energy, &cloth->particles, limited ? &cloth->limits.watch : NULL);
    if (tl_cloth_uses_symmetric_sweep(cloth))
        tl_xpbd_solve_backward(&cloth->energy, &cloth->particles);
    if (limited)
        tl_strain_limits_solve(&cloth->limits, &cloth->energy, substep->h, &cloth->particles);
    apply_constraints(cloth, substep, seams_last);
    if (!substep->continues_next)
        tl_particles_finish(&cloth->particles, substep->h);
}

static void compute_forces(tl_cloth *cloth, const struct tl_particle_kernel *then)
{
    tl_energy_forces(&cloth->energy, &cloth->fabric, cloth->particles.x, cloth->forces, then);
}

/* One substep of velocity Verlet: drift, constraints, forces at the new positions, kick. Between two substeps
 * the kick and the next drift are one pass over memory (tl_verlet_leap).
 *
 * After the half kick, velocities of touching particles point into the avatar by h/2 times the acceleration
 * that presses them there; the next drift undoes it. After the last substep nothing does, and cloth at rest
 * would seem to move: hence the velocity stage of contact there. */
static void advance_reference(tl_cloth *cloth, const struct tl_substep *substep, bool last)
{
    struct tl_particles *particles = &cloth->particles;
    const struct tl_verlet verlet =
        tl_verlet_make(cloth->forces, substep->gravity, substep->drag, substep->h);
    if (!substep->continues_previous)
        tl_verlet_drift(particles, &verlet);
    tl_pins_place(cloth->pins, cloth->pin_count, substep->collider, substep->phase, particles);
    apply_constraints(cloth, substep, true);
    const struct tl_particle_kernel then =
        substep->continues_next ? tl_verlet_leap(particles, &verlet) : tl_verlet_kick(particles, &verlet);
    compute_forces(cloth, &then);
    const struct tl_contact_params contact = contact_params(cloth, substep);
    if (last)
        tl_contacts_solve_velocities(&cloth->contacts, &contact, particles);
}

static bool wind_blows(const tl_cloth *cloth)
{
    const float *velocity = cloth->params.wind;
    return (velocity[0] != 0 || velocity[1] != 0 || velocity[2] != 0) && !tl_seams_are_closing(&cloth->seams);
}

/* Adds the wind's impulse to the velocities, before a substep of any solver. */
static void apply_wind(tl_cloth *cloth, const struct tl_substep *substep)
{
    const float *velocity = cloth->params.wind;
    const struct tl_wind wind = {.velocity = {(double)velocity[0], (double)velocity[1], (double)velocity[2]},
                                 .gust = cloth->params.gust,
                                 .time_s = cloth->time_s + substep->phase / cloth->params.frame_rate,
                                 .areal_density = cloth->fabric.areal_density};
    struct tl_particles *particles = &cloth->particles;
    cloth->external = tl_resize(cloth->external, particles->count, sizeof *cloth->external);
    tl_wind_forces(&wind, &cloth->topology, substep->h, particles, cloth->external);
    for (size_t i = 0; i < particles->count; i++)
        particles->v[i] = vec3d_muladd(particles->v[i], cloth->external[i], particles->w[i] * substep->h);
}

/* Substeps of the next step. Crushed cloth is stiffer than at rest, so `reference` measures its critical step
 * again; returns 0, and sets refused_step, if the budget does not allow so many. */
static double substeps_now(tl_cloth *cloth)
{
    double substeps = tl_cloth_substeps_per_step(cloth);
    if (cloth->params.solver != TL_CLOTH_REFERENCE)
        return substeps;
    double now =
        TL_VERLET_SAFETY * tl_energy_critical_step(&cloth->energy, &cloth->fabric, cloth->particles.count,
                                                   cloth->particles.w, cloth->particles.x);
    substeps = fmax(substeps, ceil(tl_cloth_step_seconds(cloth) / now));
    if (substeps * tl_cloth_steps_per_frame(&cloth->params) <= cloth->params.reference_substeps)
        return substeps;
    cloth->refused_step = now;
    return 0;
}

static void run_step(tl_cloth *cloth, const tl_collider *collider, const struct tl_advance_params *advance,
                     int step)
{
    /* No gravity until the panels have met: they would fall off the body. */
    double gravity = tl_seams_are_closing(&cloth->seams) ? 0 : cloth->params.gravity;
    double substeps = substeps_now(cloth), total = tl_cloth_steps_per_frame(&cloth->params) * substeps;
    if (cloth->params.solver == TL_CLOTH_REFERENCE)
        compute_forces(cloth, NULL);
    bool blown = wind_blows(cloth);
    for (int64_t sub = 0; (double)sub < substeps; sub++) {
        double done = step * substeps + (double)sub;
        const struct tl_substep substep = {.h = tl_cloth_step_seconds(cloth) / substeps,
                                           .gravity = gravity,
                                           .drag = fmax(advance->drag, cloth->fabric.damping),
                                           .phase_before = done / total,
                                           .phase = (done + 1) / total,
                                           .collider = collider,
                                           .continues_previous = sub > 0 && !blown,
                                           .continues_next = (double)(sub + 1) < substeps && !blown};
        tl_cloth_renew_contact(cloth, substep.h, substep.phase_before, substep.continues_previous);
        if (blown)
            apply_wind(cloth, &substep);
        if (cloth->params.solver == TL_CLOTH_REFERENCE)
            advance_reference(cloth, &substep, (double)(sub + 1) == substeps);
        else
            advance_preview(cloth, &substep);
    }
}

static void run_steps(tl_cloth *cloth, const tl_collider *collider, const struct tl_advance_params *advance)
{
    int steps = tl_cloth_steps_per_frame(&cloth->params);
    cloth->refused_step = 0;
    double damping = 1 - exp(-INNER_DAMPING * cloth->fabric.damping * tl_cloth_step_seconds(cloth));
    for (int step = 0; step < steps && !tl_interrupted() && !(cloth->refused_step > 0); step++) {
        const struct tl_contact_params contact = {.thickness_m = cloth->fabric.thickness_m,
                                                  .push_out_speed = TL_PUSH_OUT_SPEED,
                                                  .phase_before = (double)step / steps,
                                                  .phase = (step + 1.0) / steps,
                                                  .h = tl_cloth_step_seconds(cloth)};
        tl_contacts_update(&cloth->contacts, cloth->particles.x, cloth->fabric.thickness_m,
                           (double)step / steps);
        if (tl_cloth_is_tangled(cloth))
            tl_layers_update(&cloth->layers, &cloth->topology, cloth->particles.x);
        run_step(cloth, collider, advance, step);
        tl_cloth_keep_outside(cloth, collider, &contact);
        tl_particles_damp(&cloth->particles, (const uint32_t(*)[2])cloth->topology.edges,
                          cloth->topology.edge_count, damping);
    }
}

static void close_seams(tl_cloth *cloth, bool was_stuck)
{
    if (cloth->seams.pair_count == 0)
        return;
    uint32_t *joined = TL_NEW_ARRAY(uint32_t, cloth->particles.count);
    size_t count = tl_seams_close(&cloth->seams, &cloth->particles, joined);
    if (count < cloth->particles.count)
        tl_cloth_join(cloth, joined, count);
    else if (tl_seams_are_stuck(&cloth->seams) != was_stuck)
        tl_self_contact_forget(&cloth->self_contact);
    free(joined);
}

bool tl_cloth_check_state(const tl_cloth *cloth, tl_error *error)
{
    for (size_t i = 0; i < cloth->particles.count; i++)
        if (!vec3d_finite(cloth->particles.x[i]) || !vec3d_finite(cloth->particles.v[i]))
            return tl_fail(error, TL_UNSTABLE,
                           "cloth: vertex %zu became NaN or infinite at %.3f s; the last good frame is kept: "
                           "make cloth.dt smaller or cloth.substeps larger",
                           i, cloth->time_s);
    double strain = tl_cloth_max_strain(cloth);
    if (strain > TL_CLOTH_MAX_STRAIN)
        return tl_fail(error, TL_UNSTABLE,
                       "cloth: stretched by %.0f times at %.3f s; the last good frame is kept: make cloth.dt "
                       "smaller, cloth.substeps larger or the fabric stiffer",
                       strain, cloth->time_s);
    return true;
}

static bool check_refused(const tl_cloth *cloth, tl_error *error)
{
    return !(cloth->refused_step > 0) ||
           tl_fail(
               error, TL_UNSTABLE,
               "cloth: crushed at %.3f s so that the reference solver's step would be %.3g s; the last good "
               "frame is kept: allow more cloth.reference_substeps, or choose cloth.solver preview",
               cloth->time_s, cloth->refused_step);
}

/* Particles deeper below the ground than this are being lifted out of it; less is rounding. */
#define BURIED_M 1e-6

/* Whether anything may add energy: contact that moves or pushes out, a pull, seams, untangling, wind. Contact
 * of the cloth with itself only takes speed away, but for depth that it removes at a bounded speed: less than
 * the tolerance of check_energy. */
static bool is_driven(const tl_cloth *cloth, const tl_collider *collider)
{
    const float *wind = cloth->params.wind;
    bool pushed = cloth->contacts.caught_count > 0 || cloth->collider_revision != cloth->contacts.revision ||
                  (collider && tl_collider_travel(collider) > 0);
    bool ground = collider && tl_collider_has_ground(collider);
    for (size_t i = 0; i < cloth->particles.count && collider && !pushed; i++)
        pushed = cloth->contacts.allowed_depth[i] > 0 || (ground && cloth->particles.x[i].y < -BURIED_M);
    return pushed || cloth->grabbed || cloth->hanging || cloth->seams.pair_count > 0 ||
           (cloth->params.self_contact && !cloth->self_contact.clean) || wind[0] != 0 || wind[1] != 0 ||
           wind[2] != 0;
}

/* Detects a solver that creates energy. While nothing drives the cloth, kinetic plus potential energy cannot
 * exceed the smallest total energy so far, since elastic energy is not negative and dissipated energy cannot
 * return. Violations were seen on meshes with needles only: for needles that are crushed to nothing no step
 * is short enough. So other meshes are not checked.
 *
 * Elastic energy is left out of the gain, since it may rise: `preview` comes to rest stretched by h^2 w T for
 * a vertex of inverse mass w under a tension T, which for stiff needles is much energy. The tolerance allows
 * for contact, which may lift the cloth out of the avatar. */
static bool check_energy(tl_cloth *cloth, const tl_collider *collider, tl_error *error)
{
    const double lift = 0.25; /* J/kg: 2.5 cm */
    if (!(cloth->needle_share > 0) || is_driven(cloth, collider)) {
        cloth->undriven = false;
        cloth->collider_revision = cloth->contacts.revision;
        return true;
    }
    struct tl_energies energies = tl_cloth_energies(cloth);
    double total = energies.kinetic + energies.elastic + energies.potential;
    if (!cloth->undriven) {
        cloth->undriven = true;
        cloth->min_energy = total;
        cloth->start_energy = energies.kinetic + energies.elastic;
    }
    double gain = energies.kinetic + energies.potential - cloth->min_energy;
    cloth->min_energy = fmin(cloth->min_energy, total);
    if (gain <= cloth->start_energy + lift * energies.mass)
        return true;
    return tl_fail(
        error, TL_UNSTABLE,
        "cloth: gained %.3g J at %.3f s though nothing drives it; the last good frame is kept: repair needle "
        "triangles, or make cloth.dt smaller",
        gain, cloth->time_s);
}

/* Applies an avatar's jump (tl_collider_jump) to the cloth that it wears, once per jump. Cloth with a pin
 * fixed in the world stays where it is. */
static void follow_jump(tl_cloth *cloth, const tl_collider *collider)
{
    struct tl_rigid jump;
    struct tl_particles *particles = &cloth->particles;
    bool worn = true;
    for (size_t i = 0; i < cloth->pin_count; i++)
        worn = worn && cloth->pins[i].triangle != TL_NONE;
    if (!worn || !collider || !tl_collider_jump(collider, &jump) ||
        tl_collider_revision(collider) == cloth->jump_followed)
        return;
    cloth->jump_followed = tl_collider_revision(collider);
    tl_info("the avatar jumped by %.2f m within a frame: the cloth is moved along with it",
            vec3d_distance(jump.from, jump.to));
    for (size_t i = 0; i < particles->count; i++) {
        particles->x[i] = tl_rigid_point(&jump, particles->x[i]);
        particles->v[i] = tl_rigid_turn(&jump, particles->v[i]);
    }
    tl_contacts_forget(&cloth->contacts);
    tl_self_contact_end_window(&cloth->self_contact);
}

bool tl_cloth_advance(tl_cloth *cloth, const tl_collider *collider, const struct tl_advance_params *advance,
                      tl_error *error)
{
    cloth->cage_is_current = cloth->was_caged = false;
    tl_cloth_prepare_contact(cloth);
    if (!check_budget(cloth, error) || !tl_cloth_order_layers(cloth, collider, error))
        return false;
    uint64_t jump_followed = cloth->jump_followed;
    bool was_stuck = tl_seams_are_stuck(&cloth->seams);
    struct tl_particles *particles = &cloth->particles;
    size_t bytes = particles->count * sizeof(vec3d);
    cloth->good_x = tl_resize(cloth->good_x, particles->count, sizeof *cloth->good_x);
    cloth->good_v = tl_resize(cloth->good_v, particles->count, sizeof *cloth->good_v);
    memcpy(cloth->good_x, particles->x, bytes);
    memcpy(cloth->good_v, particles->v, bytes);
    follow_jump(cloth, collider);
    unsigned denormals = tl_denormals_off();
    if (collider)
        tl_pins_bind(cloth->pins, cloth->pin_count, collider, cloth->fabric.thickness_m);
    tl_contacts_begin(&cloth->contacts, collider);
    run_steps(cloth, collider, advance);
    tl_denormals_restore(denormals);

    bool good = tl_interrupted()
                    ? tl_fail(error, TL_INTERRUPTED, "cloth: interrupted at %.3f s", cloth->time_s)
                    : check_refused(cloth, error) && tl_cloth_check_state(cloth, error) &&
                          check_energy(cloth, collider, error);
    if (good) {
        close_seams(cloth, was_stuck);
        cloth->grab_from = cloth->grab_target;
        cloth->time_s += advance->clock ? 1 / cloth->params.frame_rate : 0;
    } else {
        memcpy(particles->x, cloth->good_x, bytes);
        memcpy(particles->v, cloth->good_v, bytes);
        cloth->jump_followed = jump_followed;
        tl_layers_forget(&cloth->layers);
        tl_self_contact_forget(&cloth->self_contact);
    }
    return good;
}
