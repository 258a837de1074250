#include "tests/app/stability/envelope.h"

#include "app/measure/cost.h"
#include "config/base/memory.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* As many frames as the work limit allows, because an instability may grow slowly. */
#define FRAMES_MIN  2
#define FRAMES_MAX  100
#define FRAMES_WORK 1e6 /* particle-substeps */
#define MIN_WORK    20  /* of a substep, in particles */
#define EXACT_SHARE 1e-3
#define FLOAT_SHARE 1e-6
#define SCRAMBLE    0.2
#define SWING       2.0 /* a vertex released at rest swings as far beyond its equilibrium as it began before it */

const struct tl_envelope_size tl_envelope_sizes[] = {
    {"1 triangle", 0, 1, true, true}, {"12", 3, 3, true, true},       {"100", 5, 19, true, false},
    {"1000", 10, 99, true, false},    {"10k", 50, 199, false, false}, {"100k", 200, 499, false, false},
    {"1M", 1000, 999, false, false},
};
const size_t tl_envelope_size_count = TL_COUNT(tl_envelope_sizes);

const double tl_envelope_stiffnesses[TL_ENVELOPE_STIFFNESSES] = {1e-2, 1e-1, 1,   1e1, 1e2, 1e3,
                                                                 1e4,  1e5,  1e6, 1e7, 1e8, 1e9};
const double tl_envelope_steps[TL_ENVELOPE_STEPS] = {1e-5, 1e-4, 1e-3, 1e-2, 1e-1};
const double tl_envelope_ratios[TL_ENVELOPE_RATIOS] = {1, 1e3, 1e6};

/* ---- What the extremes share ---- */

enum tl_outcome tl_refusal_outcome(const tl_error *error)
{
    bool clear = error->message[0] &&
                 (error->code == TL_USAGE || error->code == TL_INPUT || error->code == TL_UNSTABLE);
    return clear ? TL_OUTCOME_REFUSED : TL_OUTCOME_SILENT;
}

static vec3s *read_positions(const tl_cloth *cloth, size_t count)
{
    vec3s *x = TL_NEW_ARRAY(vec3s, count);
    tl_cloth_positions(cloth, x);
    return x;
}

bool tl_cloth_is_finite(const tl_cloth *cloth, size_t vertex_count)
{
    struct tl_cloth_report report = tl_cloth_measure(cloth, NULL);
    bool finite = isfinite(report.kinetic_energy) && isfinite(report.elastic_energy) &&
                  isfinite(report.potential_energy) && isfinite(report.max_strain);
    vec3s *x = read_positions(cloth, vertex_count);
    for (size_t i = 0; i < vertex_count; i++)
        finite &= isfinite(x[i].x) && isfinite(x[i].y) && isfinite(x[i].z);
    free(x);
    return finite;
}

double tl_cloth_farthest_from(const tl_cloth *cloth, const tl_garment *garment)
{
    const tl_mesh *mesh = &garment->model.mesh;
    vec3s *x = read_positions(cloth, mesh->vertex_count);
    double farthest = 0;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        farthest = fmax(farthest, (double)glms_vec3_distance(x[i], mesh->positions[i]));
    free(x);
    return farthest;
}

static bool same_state(const tl_cloth *cloth, size_t vertex_count, const vec3s *x,
                       const struct tl_cloth_report *before)
{
    struct tl_cloth_report after = tl_cloth_measure(cloth, NULL);
    vec3s *now = read_positions(cloth, vertex_count);
    bool same = memcmp(now, x, vertex_count * sizeof *x) == 0 &&
                after.kinetic_energy == before->kinetic_energy &&
                after.elastic_energy == before->elastic_energy && after.time_s == before->time_s;
    free(now);
    return same;
}

enum tl_outcome tl_cloth_try_step(tl_cloth *cloth, const tl_collider *collider, size_t vertex_count,
                                  tl_error *error)
{
    struct tl_cloth_report before = tl_cloth_measure(cloth, NULL);
    vec3s *x = read_positions(cloth, vertex_count);
    enum tl_outcome outcome = TL_OUTCOME_BOUNDED;
    bool stepped = tl_cloth_step(cloth, collider, error);
    if (!tl_cloth_is_finite(cloth, vertex_count)) {
        outcome = TL_OUTCOME_NAN;
        tl_fail(error, TL_UNSTABLE, "a number is not finite after a frame");
    } else if (!stepped) {
        outcome = tl_refusal_outcome(error);
        if (outcome == TL_OUTCOME_REFUSED && !same_state(cloth, vertex_count, x, &before)) {
            outcome = TL_OUTCOME_SILENT;
            tl_fail(error, TL_UNSTABLE, "refused, but the last good state was lost");
        }
    }
    free(x);
    return outcome;
}

/* ---- A cell ---- */

struct subject {
    const struct tl_envelope_case *tested;
    struct tl_tube tube; /* columns 0: the triangle */
    struct tl_cloth_fabric fabric;
    struct tl_cloth_params params;
    size_t vertex_count;
};

static struct subject make_subject(const struct tl_envelope_case *tested)
{
    struct subject subject = {
        .tested = tested,
        .tube = {tested->size->columns, tested->size->row_count, tested->height_m, tested->mass_ratio},
        .fabric = *(const struct tl_cloth_fabric *)tl_cloth_fabric_options.defaults,
        .params = *(const struct tl_cloth_params *)tl_cloth_options.defaults};
    struct tl_cloth_fabric *fabric = &subject.fabric;
    fabric->stretch_weft = fabric->stretch_warp = fabric->shear = tested->stiffness;
    fabric->bend_weft = fabric->bend_warp = fabric->damping = 0;
    subject.params.solver = tested->solver;
    subject.params.strain_limit = 0; /* because limiting changes no energy */
    /* The solvers alone: contact moves single vertices, which the stiffest threads turn into energy, and
     * cloth that a cage moves has the cage's rest and energy. */
    subject.params.self_contact = false;
    subject.params.caged_above = tested->caged_above;
    subject.params.dt = tested->dt;
    subject.params.frame_rate = fmin(1 / tested->dt, 1000);
    return subject;
}

/* The garment, and the depth of what hangs lowest in `sink_m`; `sinks` has an entry for every row. */
static tl_garment make_hanging(struct subject *subject, double *sink_m)
{
    tl_garment garment;
    double gravity = subject->params.gravity;
    if (subject->tube.columns == 0) {
        *sink_m = tl_triangle_sink(&subject->fabric, gravity);
        garment = tl_triangle_make(*sink_m, 0);
    } else {
        double *sinks = TL_NEW_ARRAY(double, (size_t)subject->tube.row_count + 1);
        tl_tube_sink(&subject->tube, &subject->fabric, gravity, sinks);
        *sink_m = sinks[subject->tube.row_count];
        garment = tl_tube_make(&subject->tube, sinks, 0);
        free(sinks);
    }
    subject->vertex_count = garment.model.mesh.vertex_count;
    return garment;
}

static int frame_count(const tl_cloth *cloth, const struct subject *subject)
{
    struct tl_cloth_report report = tl_cloth_measure(cloth, NULL);
    if (!subject->tested->size->whole)
        return 1;
    double work =
        fmax((double)report.vertex_count, MIN_WORK) / (subject->params.frame_rate * report.substep_s);
    return (int)fmin(fmax(FRAMES_WORK / work, FRAMES_MIN), FRAMES_MAX);
}

/* Growth of the cloth's energy since `first`, a ratio. One sweep of `preview` leaves stiff threads strained:
 * by definition this is elastic energy, but the solver cannot release it. For `preview` the growth is
 * therefore the larger of that of the kinetic energy and the square of that of the largest strain. */
static double growth_since(const struct tl_cloth_report *first, const tl_cloth *cloth, int solver)
{
    struct tl_cloth_report now = tl_cloth_measure(cloth, NULL);
    double began = first->kinetic_energy + first->elastic_energy,
           strained = now.max_strain / first->max_strain;
    if (solver == TL_CLOTH_PREVIEW)
        return fmax(now.kinetic_energy / began, strained * strained);
    return (now.kinetic_energy + now.elastic_energy) / began;
}

/* Simulates frames until one is refused. */
static enum tl_outcome run_frames(tl_cloth *cloth, const struct subject *subject, double *growth,
                                  tl_error *error)
{
    const struct tl_cloth_report first = tl_cloth_measure(cloth, NULL);
    enum tl_outcome outcome = TL_OUTCOME_BOUNDED;
    *growth = 0;
    for (int i = 0, frames = frame_count(cloth, subject); i < frames && outcome == TL_OUTCOME_BOUNDED; i++) {
        outcome = tl_cloth_try_step(cloth, NULL, subject->vertex_count, error);
        *growth = fmax(*growth, growth_since(&first, cloth, subject->params.solver));
    }
    return outcome;
}

/* Distance below the true equilibrium at which a solver comes to rest. */
static double slack(const tl_cloth *cloth, const struct subject *subject)
{
    if (subject->params.solver != TL_CLOTH_PREVIEW || subject->tube.columns == 0)
        return 0;
    return tl_tube_slack(&subject->tube, &subject->fabric, subject->params.gravity,
                         tl_cloth_measure(cloth, NULL).substep_s);
}

static enum tl_outcome judge_hanging(const tl_cloth *cloth, const tl_garment *garment,
                                     const struct subject *subject, double sink_m,
                                     struct tl_envelope_cell *cell)
{
    double passed_s = tl_cloth_measure(cloth, NULL).time_s, gravity = subject->params.gravity;
    double rounding_m = FLOAT_SHARE * subject->tube.height_m;
    double fallen_m = 0.5 * gravity * passed_s * (passed_s + subject->params.dt);
    double bound_m = fallen_m + SWING * slack(cloth, subject) + rounding_m;
    double strayed_m = tl_cloth_farthest_from(cloth, garment);
    cell->strayed = strayed_m / (EXACT_SHARE * fmin(sink_m, fallen_m) + rounding_m);
    double length_m = subject->tube.height_m + sink_m;
    cell->error = (struct tl_cell_error){.share = strayed_m / length_m, .own = 1e3 * strayed_m, .unit = "mm"};
    if (cell->strayed <= 1)
        return TL_OUTCOME_EXACT;
    bound_m = fmin(bound_m, TL_STATED_SHARE * length_m);
    if (strayed_m <= bound_m)
        return TL_OUTCOME_BOUNDED;
    tl_fail(&cell->message, TL_UNSTABLE, "left its place by %.3g m, and may by %.3g m", strayed_m, bound_m);
    return TL_OUTCOME_SILENT;
}

static enum tl_outcome run_hanging(struct subject *subject, struct tl_envelope_cell *cell)
{
    double sink_m, unused;
    tl_garment garment = make_hanging(subject, &sink_m);
    tl_cloth *cloth = tl_cloth_create(&garment, &subject->fabric, &subject->params, &cell->message);
    enum tl_outcome outcome =
        cloth ? run_frames(cloth, subject, &unused, &cell->message) : tl_refusal_outcome(&cell->message);
    if (outcome == TL_OUTCOME_BOUNDED)
        outcome = judge_hanging(cloth, &garment, subject, sink_m, cell);
    tl_cloth_destroy(&cloth);
    tl_garment_release(&garment);
    return outcome;
}

static enum tl_outcome run_scrambled(struct subject *subject, struct tl_envelope_cell *cell)
{
    tl_garment garment =
        subject->tube.columns ? tl_tube_make(&subject->tube, NULL, SCRAMBLE) : tl_triangle_make(0, SCRAMBLE);
    struct tl_cloth_params weightless = subject->params;
    weightless.gravity = 0;
    tl_cloth *cloth = tl_cloth_create(&garment, &subject->fabric, &weightless, &cell->message);
    enum tl_outcome outcome = cloth ? run_frames(cloth, subject, &cell->growth, &cell->message)
                                    : tl_refusal_outcome(&cell->message);
    if (outcome == TL_OUTCOME_BOUNDED && !(cell->growth <= TL_ENVELOPE_GROWTH)) {
        outcome = TL_OUTCOME_SILENT;
        tl_fail(&cell->message, TL_UNSTABLE, "its energy grew %.3g times", cell->growth);
    }
    tl_cloth_destroy(&cloth);
    tl_garment_release(&garment);
    return outcome;
}

struct tl_envelope_cell tl_envelope_run(const struct tl_envelope_case *tested)
{
    struct subject subject = make_subject(tested);
    struct tl_envelope_cell cell = {.error = TL_CELL_NO_ERROR, .strayed = NAN, .growth = NAN};
    struct tl_stopwatch watch = tl_stopwatch_start();
    omp_set_num_threads(
        tested->size->whole ? 1 : omp_get_num_procs()); /* threads cost more than they gain on small meshes */
    cell.outcome = run_hanging(&subject, &cell);
    if (cell.outcome == TL_OUTCOME_EXACT || cell.outcome == TL_OUTCOME_BOUNDED) {
        enum tl_outcome scrambled = run_scrambled(&subject, &cell);
        if (scrambled > cell.outcome)
            cell.outcome = scrambled;
        if (scrambled == TL_OUTCOME_BOUNDED && cell.strayed <= 1)
            cell.outcome = TL_OUTCOME_EXACT;
    }
    cell.cpu_ms = tl_stopwatch_read(&watch).cpu_ms;
    return cell;
}
