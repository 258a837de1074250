#include "app/lab/cloth/trade_cloth.h"

#include "app/lab/experiments/closed_form.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#define FALL_S      0.5
#define ENOUGH_MS   100  /* a shorter fall is measured again */
#define REST_SIDE   33   /* vertices a side of the largest sheet whose rest is measured */
#define REST_S      60   /* of settling, longest */
#define RESTED_S    1    /* of motion after that: each solver then shows where it rests */
#define TRUTH_SHARE 0.25 /* of the reference's own step */

/* One choice of settings. An unknown solver name is skipped. */
struct setting {
    const char *solver, *name;
    double dt;    /* s; 0: the longest that the solver accepts */
    double share; /* of the solver's own substep, instead of dt; 0: none */
    int substeps; /* of preview; 0: the default */
    bool quick;
};
static const struct setting settings[] = {
    {"preview", "preview 4", 1.0 / 60, 0, 4, true},
    {"preview", "preview 8", 1.0 / 60, 0, 8, false},
    {"preview", "preview 16", 1.0 / 60, 0, 16, true},
    {"preview", "preview 32", 1.0 / 60, 0, 32, false},
    {"preview", "preview 64", 1.0 / 60, 0, 64, false},
    {"preview", "preview 128", 1.0 / 60, 0, 128, false},
    {"reference", "reference", 0, 1, 0, true},
    {"reference", "reference, half step", 0, 0.5, 0, false},
};

/* The scenes of the sheet. */
struct cloth_scene {
    enum tl_sheet_hold hold;
    double frame_rate;
    bool damped;
};
static const struct cloth_scene falling = {TL_SHEET_EDGE, 10,
                                           false}, /* every step divides a tenth of a second */
    resting = {TL_SHEET_CORNERS, 30, true};

/* Vertices a side; the finest is the reference only. */
struct sizes {
    int sides[4], count, finest;
};
static const struct sizes all_sizes = {{17, 33, 65, 101}, 4, 129}, quick_sizes = {{9, 17}, 2, 25};

/* The state at the end of a fall or of a rest. */
struct shape {
    int side;
    vec3s *x; /* [side * side] */
    double energy, strain;
};

struct cloth_run {
    struct tl_trade_cloth *trade;
    bool quick;
    const struct sizes *sizes;
    struct shape finest, fallen, rested; /* references: the finest; those of the current size */
};

static int find_solver(const char *name)
{
    for (int i = 0; tl_cloth_solver_names[i]; i++)
        if (strcmp(tl_cloth_solver_names[i], name) == 0)
            return i;
    return -1;
}

static void release_shape(struct shape *shape)
{
    free(shape->x);
    *shape = (struct shape){0};
}

static struct shape read_shape(const tl_cloth *cloth, int side)
{
    struct tl_cloth_report report = tl_cloth_measure(cloth, NULL);
    struct shape shape = {.side = side,
                          .x = TL_NEW_ARRAY(vec3s, (size_t)side * (size_t)side),
                          .energy = report.elastic_energy + report.potential_energy,
                          .strain = report.max_strain};
    tl_cloth_positions(cloth, shape.x);
    return shape;
}

/* ---- Comparing ---- */

static vec3s mix(vec3s a, vec3s b, double t)
{
    return glms_vec3_lerp(a, b, (float)t);
}

/* The sheet's point at (u, v), 0 to 1. */
static vec3s sample(const struct shape *shape, double u, double v)
{
    int last = shape->side - 1;
    double across = u * last, down = v * last;
    int column = (int)fmin(across, last - 1), row = (int)fmin(down, last - 1);
    const vec3s *at = &shape->x[row * shape->side + column];
    vec3s upper = mix(at[0], at[1], across - column);
    vec3s lower = mix(at[shape->side], at[shape->side + 1], across - column);
    return mix(upper, lower, down - row);
}

/* RMS distance of the vertices; `mirror` 1 exchanges front and back, 2 left and right, 3 both. */
static double distance(const struct shape *tested, const struct shape *truth, int mirror)
{
    double sum = 0;
    int last = tested->side - 1;
    for (int row = 0; row <= last; row++)
        for (int column = 0; column <= last; column++) {
            vec3s x = tested->x[row * tested->side + column];
            double u = (double)column / last;
            if (mirror & 1)
                x.z = -x.z;
            if (mirror & 2) {
                x.x = 1 - x.x;
                u = 1 - u;
            }
            sum += (double)glms_vec3_distance2(x, sample(truth, u, (double)row / last));
        }
    return sqrt(sum / ((double)tested->side * tested->side));
}

static double nearest_mirror(const struct shape *tested, const struct shape *truth)
{
    double minimum = INFINITY;
    for (int mirror = 0; mirror < 4; mirror++)
        minimum = fmin(minimum, distance(tested, truth, mirror));
    return minimum;
}

/* ---- Running ---- */

static tl_cloth *make_cloth(const tl_garment *sheet, const struct setting *setting,
                            const struct cloth_scene *scene, tl_error *error)
{
    struct tl_cloth_fabric fabric = *(const struct tl_cloth_fabric *)tl_cloth_fabric_options.defaults;
    struct tl_cloth_params params = *(const struct tl_cloth_params *)tl_cloth_options.defaults;
    if (!scene->damped)
        fabric.damping = 0;
    params.solver = find_solver(setting->solver);
    params.frame_rate = scene->frame_rate;
    params.dt = setting->dt > 0 ? setting->dt : 0.1;
    if (setting->substeps > 0)
        params.substeps = setting->substeps;
    params.reference_substeps = 100000000;
    params.settle_s = REST_S;
    tl_cloth *cloth = tl_cloth_create(sheet, &fabric, &params, error);
    if (!cloth || !(setting->share > 0))
        return cloth;
    params.dt = setting->share * tl_cloth_measure(cloth, NULL).substep_s;
    if (tl_cloth_set(cloth, &fabric, &params, error))
        return cloth;
    tl_cloth_destroy(&cloth);
    return NULL;
}

static bool fall_once(tl_cloth *cloth, struct tl_taken *taken, tl_error *error)
{
    struct tl_stopwatch watch = tl_stopwatch_start();
    for (int frame = 0; frame < (int)(FALL_S * falling.frame_rate); frame++)
        if (!tl_cloth_step(cloth, NULL, error))
            return false;
    *taken = tl_stopwatch_read(&watch);
    taken->cpu_ms /= FALL_S;
    taken->wall_ms /= FALL_S;
    return true;
}

/* The minimum of three runs if it is short. */
static bool fall(int side, const struct setting *setting, struct shape *out, struct tl_trade_cloth_row *row,
                 tl_error *error)
{
    tl_garment sheet = tl_sheet_make(side, falling.hold, true);
    tl_cloth *cloth = make_cloth(&sheet, setting, &falling, error);
    bool done = cloth && fall_once(cloth, &row->fall, error);
    if (done) {
        *out = read_shape(cloth, side);
        row->substep_s = tl_cloth_measure(cloth, NULL).substep_s;
    }
    for (int again = 0; done && again < 2 && row->fall.cpu_ms * FALL_S < ENOUGH_MS; again++) {
        struct tl_taken taken;
        tl_cloth_reset(cloth);
        done = fall_once(cloth, &taken, error);
        if (done && taken.cpu_ms < row->fall.cpu_ms)
            row->fall = taken;
    }
    tl_cloth_destroy(&cloth);
    tl_garment_release(&sheet);
    return done;
}

static bool rest(int side, const struct setting *setting, const struct cloth_scene *scene, struct shape *out,
                 struct tl_taken *taken, tl_error *error)
{
    tl_garment sheet = tl_sheet_make(side, scene->hold, true);
    tl_cloth *cloth = make_cloth(&sheet, setting, scene, error);
    struct tl_stopwatch watch = tl_stopwatch_start();
    bool done = cloth && tl_cloth_settle(cloth, NULL, error);
    *taken = tl_stopwatch_read(&watch);
    for (int frame = 0; done && frame < RESTED_S * scene->frame_rate; frame++)
        done = tl_cloth_step(cloth, NULL, error);
    if (done)
        *out = read_shape(cloth, side);
    tl_cloth_destroy(&cloth);
    tl_garment_release(&sheet);
    return done;
}

static void note_refusal(struct tl_trade_cloth *trade, const char *name, int side, const tl_error *error)
{
    tl_warn("trade: %s: %s", name, error->message);
    trade->refusals = tl_resize(trade->refusals, trade->refusal_count + 1, sizeof *trade->refusals);
    trade->refusals[trade->refusal_count++] = tl_format("%s, %d x %d: %s", name, side, side, error->message);
}

static bool measure(struct cloth_run *run, int side, const struct setting *setting, tl_error *error)
{
    struct tl_trade_cloth *trade = run->trade;
    struct shape shape = {0};
    tl_error refusal = {0};
    struct tl_trade_cloth_row row = {.solver = find_solver(setting->solver),
                                     .side = side,
                                     .dt = setting->dt,
                                     .substeps = setting->substeps,
                                     .rest_error_m = NAN,
                                     .rest_energy_j = NAN,
                                     .rest_strain = NAN,
                                     .rest = {NAN, NAN}};
    snprintf(row.name, sizeof row.name, "%s", setting->name);
    bool done = fall(side, setting, &shape, &row, &refusal);
    if (done) {
        row.error_m = distance(&shape, &run->fallen, 0);
        row.total_error_m = distance(&shape, &run->finest, 0);
    }
    release_shape(&shape);
    if (done && run->rested.x) {
        done = rest(side, setting, &resting, &shape, &row.rest, &refusal);
        if (done) {
            row.rest_error_m = nearest_mirror(&shape, &run->rested);
            row.rest_energy_j = shape.energy - run->rested.energy;
            row.rest_strain = shape.strain;
        }
        release_shape(&shape);
    }
    if (!done && refusal.code == TL_INTERRUPTED) {
        *error = refusal;
        return false;
    }
    if (!done) {
        note_refusal(trade, setting->name, side, &refusal);
        return true;
    }
    trade->rows = tl_resize(trade->rows, trade->row_count + 1, sizeof *trade->rows);
    trade->rows[trade->row_count++] = row;
    return true;
}

/* The references of one size. */
static bool find_truths(struct cloth_run *run, int side, tl_error *error)
{
    const struct setting short_step = {"reference", "converged", 0, TRUTH_SHARE, 0, true},
                         own_step = {"reference", "at rest", 0, 0, 0, true};
    struct tl_trade_cloth_row unused;
    struct tl_taken taken;
    release_shape(&run->fallen);
    release_shape(&run->rested);
    return fall(side, &short_step, &run->fallen, &unused, error) &&
           (side > REST_SIDE || rest(side, &own_step, &resting, &run->rested, &taken, error));
}

static bool find_finest(struct cloth_run *run, tl_error *error)
{
    const struct setting own = {"reference", "finest", 0, 1, 0, true},
                         half = {"reference", "finest", 0, 0.5, 0, true};
    int side = run->sizes->finest;
    struct tl_trade_cloth_row unused;
    struct shape coarse = {0};
    bool done = fall(side, &own, &coarse, &unused, error) && fall(side, &half, &run->finest, &unused, error);
    if (done)
        run->trade->truth_error_m = distance(&coarse, &run->finest, 0);
    run->trade->truth_side = side;
    release_shape(&coarse);
    return done;
}

static bool measure_all(struct cloth_run *run, tl_error *error)
{
    struct tl_progress progress = tl_progress_begin("measuring the trade of cloth");
    const int size_count = run->sizes->count, setting_count = (int)TL_COUNT(settings);
    bool done = find_finest(run, error);
    for (int i = 0; done && i < size_count; i++) {
        int side = run->sizes->sides[i];
        done = find_truths(run, side, error);
        for (int s = 0; done && s < setting_count; s++) {
            if ((!run->quick || settings[s].quick) && find_solver(settings[s].solver) >= 0)
                done = measure(run, side, &settings[s], error);
            tl_progress_update(&progress, i * setting_count + s + 1, size_count * setting_count);
        }
    }
    tl_progress_end(&progress);
    return done;
}

bool tl_trade_cloth(bool quick, struct tl_trade_cloth *out, tl_error *error)
{
    *out = (struct tl_trade_cloth){0};
    struct cloth_run run = {.trade = out, .quick = quick, .sizes = quick ? &quick_sizes : &all_sizes};
    omp_set_num_threads(1); /* CPU time of one core, undisturbed */
    bool done = out->complete = measure_all(&run, error) && tl_trade_fit(quick, &out->fit, error);
    release_shape(&run.finest);
    release_shape(&run.fallen);
    release_shape(&run.rested);
    return done;
}

void tl_trade_cloth_release(struct tl_trade_cloth *trade)
{
    for (size_t i = 0; i < trade->refusal_count; i++)
        free(trade->refusals[i]);
    free(trade->refusals);
    free(trade->rows);
    tl_trade_fit_release(&trade->fit);
    *trade = (struct tl_trade_cloth){0};
}
