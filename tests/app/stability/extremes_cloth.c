#include "tests/app/stability/extremes_cloth.h"

#include "app/measure/cost.h"
#include "config/base/memory.h"
#include "tests/app/stability/envelope.h"

#include <math.h>
#include <omp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CAGED_ABOVE 3500 /* vertices: between those of the two tubes that hang */
#define SIDE        13
#define FRAMES      30
#define BALL_M      0.3     /* radius */
#define BALL_TOP    (-0.01) /* the level sheet lies at 0 */
#define DEEP_M      1e-3
#define REST_MS     0.01 /* m/s */
#define SLOWER      10.0
#define HEADROOM    0.01 /* of the weight falling by a metre */

struct trial {
    tl_garment garment;
    struct tl_cloth_fabric fabric;
    struct tl_cloth_params params;
    tl_mesh ball; /* no vertices: none */
    int frames;
    tl_cloth *cloth;
    tl_collider *collider;
    vec3s *moved;     /* where the ball is to be */
    double max_speed; /* m/s, of what went farthest in the last frame */
};

/* The bound of a trial that is not refused. Its state must be finite in any case. Errors are lengths, and
 * shares of the metre that the sheet is wide: */
enum promise {
    REFUSES, /* must be refused with a clear message */
    ENERGY,  /* kinetic energy never exceeds the potential energy lost, but for HEADROOM; as the height to
                which it would lift the sheet */
    OUTSIDE, /* finally no vertex is deeper in the avatar than DEEP_M */
    RESTS,   /* in the last frame no vertex is faster than REST_MS, within which explicit substeps oscillate;
                how far it goes in that frame */
    FINITE,  /* no more: how much longer than at rest an edge is, as a share of the edge */
};

struct extreme {
    const char *name;
    enum promise promise;
    void (*change)(struct trial *trial);
    void (*act)(struct trial *trial, int frame); /* before a frame; NULL: nothing happens */
    /* Instead of all that. */
    enum tl_outcome (*run)(int solver, struct tl_cell_error *error, tl_error *found);
};

static void say(tl_error *found, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void say(tl_error *found, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(found->message, sizeof found->message, format, arguments);
    va_end(arguments);
}

/* ---- Garments ---- */

static void move_vertex(struct trial *trial, size_t vertex, size_t to, float offset)
{
    tl_garment *garment = &trial->garment;
    garment->model.mesh.positions[vertex] = garment->model.mesh.positions[to];
    garment->model.mesh.positions[vertex].x += offset;
    garment->pattern[vertex] = garment->pattern[to];
    garment->pattern[vertex].x += offset;
}

static void make_needles(struct trial *trial)
{
    for (size_t i = 2 * SIDE + 3; i < (size_t)SIDE * (SIDE - 1); i += 17)
        move_vertex(trial, i, i - 1, 1e-6f);
}

static void make_zero_area(struct trial *trial)
{
    for (size_t i = 2 * SIDE + 3; i < (size_t)SIDE * (SIDE - 1); i += 17)
        move_vertex(trial, i, i - 1, 0);
}

static void add_triangles(struct trial *trial, const uint32_t *corners, size_t count)
{
    tl_mesh *mesh = &trial->garment.model.mesh;
    uint32_t *indices = TL_NEW_ARRAY(uint32_t, mesh->index_count + count);
    memcpy(indices, mesh->indices, mesh->index_count * sizeof *indices);
    memcpy(indices + mesh->index_count, corners, count * sizeof *indices);
    free(mesh->indices);
    mesh->indices = indices;
    mesh->index_count += count;
}

static void double_triangles(struct trial *trial)
{
    add_triangles(trial, trial->garment.model.mesh.indices, trial->garment.model.mesh.index_count);
}

/* A third triangle on an edge, to a far vertex; and one with a corner twice. */
static void add_fin(struct trial *trial)
{
    const uint32_t corners[] = {SIDE + 4, 2 * SIDE + 5, 9 * SIDE + 9, 7, 7, 9};
    add_triangles(trial, corners, TL_COUNT(corners));
}

/* The last row's triangles are gone; its vertices stay. */
static void isolate_vertices(struct trial *trial)
{
    trial->garment.model.mesh.index_count -= (size_t)6 * (SIDE - 1);
}

static void collapse(struct trial *trial)
{
    const tl_mesh *mesh = &trial->garment.model.mesh;
    for (size_t i = SIDE; i < mesh->vertex_count; i++) { /* near, but not welded into one */
        mesh->positions[i] = mesh->positions[i % SIDE];
        mesh->positions[i].y = -1e-6f * (float)i;
    }
}

/* Stretches the cloth by half, well beyond the strain limit of preview. */
static void stretch(struct trial *trial)
{
    const tl_mesh *mesh = &trial->garment.model.mesh;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        mesh->positions[i].y *= 1.5f;
}

static void stretch_small_step(struct trial *trial)
{
    stretch(trial);
    trial->params.dt = 1e-4;
    trial->params.frame_rate = 1000;
}

static void flatten_to_line(struct trial *trial)
{
    const tl_mesh *mesh = &trial->garment.model.mesh;
    free(trial->garment.pattern);
    trial->garment.pattern = NULL;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        mesh->positions[i].x = 0;
        mesh->uvs[i] = (vec2s){{0, 0}};
    }
}

static void turn_inside_out(struct trial *trial)
{
    for (size_t i = 0; i < trial->garment.model.mesh.vertex_count; i++)
        trial->garment.pattern[i].x = -trial->garment.pattern[i].x;
}

static void pin_all(struct trial *trial)
{
    size_t count = trial->garment.model.mesh.vertex_count;
    trial->garment.pins = tl_resize(trial->garment.pins, count, sizeof(uint32_t));
    for (size_t i = 0; i < count; i++)
        trial->garment.pins[i] = (uint32_t)i;
    trial->garment.pin_count = count;
}

static void nan_vertex(struct trial *trial)
{
    trial->garment.model.mesh.positions[40].y = NAN;
}

static void infinite_vertex(struct trial *trial)
{
    trial->garment.model.mesh.positions[40].z = -INFINITY;
}

static void far_vertex(struct trial *trial)
{
    trial->garment.model.mesh.positions[40].z = 1e30f;
}

static void nan_pattern(struct trial *trial)
{
    trial->garment.pattern[40].x = NAN;
}

static void wrong_index(struct trial *trial)
{
    trial->garment.model.mesh.indices[5] = SIDE * SIDE;
}

static void no_triangles(struct trial *trial)
{
    trial->garment.model.mesh.index_count = 0;
}

static void seam_to_nowhere(struct trial *trial)
{
    trial->garment.seams = TL_NEW_ARRAY(struct tl_seam_pair, 1);
    trial->garment.seams[0] = (struct tl_seam_pair){0, SIDE * SIDE};
    trial->garment.seam_count = 1;
}

static void pin_to_nowhere(struct trial *trial)
{
    trial->garment.pins[0] = UINT32_MAX;
}

/* ---- Fabrics and settings ---- */

static void no_stiffness(struct trial *trial)
{
    trial->fabric.stretch_weft = trial->fabric.stretch_warp = trial->fabric.shear = 0;
}

static void one_direction(struct trial *trial)
{
    trial->fabric.stretch_weft = 1e-2;
    trial->fabric.stretch_warp = 1e6;
}

static void stiff_bending(struct trial *trial)
{
    trial->fabric.bend_weft = trial->fabric.bend_warp = 1e3;
}

static void lightest(struct trial *trial)
{
    trial->fabric.areal_density = 1e-4;
}

static void heaviest(struct trial *trial)
{
    trial->fabric.areal_density = 100;
    trial->fabric.stretch_weft = trial->fabric.stretch_warp = 1e5;
}

static void max_damping(struct trial *trial)
{
    trial->fabric.damping = 1e3;
}

static void max_gravity(struct trial *trial)
{
    trial->params.gravity = 100;
}

static void upward_gravity(struct trial *trial)
{
    trial->params.gravity = -100;
}

/* Sets each number of a table in turn to NaN, infinity and values out of its range. All must be refused. */
static enum tl_outcome refuse_numbers(int solver, const struct tl_option_table *table, bool is_fabric,
                                      tl_error *found)
{
    const double wrong[] = {NAN, INFINITY, -INFINITY, 1e300, -1e300};
    tl_garment garment = tl_sheet_make(SIDE, TL_SHEET_EDGE, false);
    enum tl_outcome outcome = TL_OUTCOME_REFUSED;
    for (size_t i = 0; i < table->row_count * TL_COUNT(wrong); i++) {
        struct tl_cloth_fabric fabric = *(const struct tl_cloth_fabric *)tl_cloth_fabric_options.defaults;
        struct tl_cloth_params params = *(const struct tl_cloth_params *)tl_cloth_options.defaults;
        const struct tl_option *row = &table->rows[i / TL_COUNT(wrong)];
        params.solver = solver;
        if (row->type != TL_DOUBLE)
            continue;
        memcpy((char *)(is_fabric ? (void *)&fabric : (void *)&params) + row->offset,
               &wrong[i % TL_COUNT(wrong)], sizeof(double));
        tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, found);
        if (cloth || tl_refusal_outcome(found) != TL_OUTCOME_REFUSED) {
            outcome = TL_OUTCOME_SILENT;
            tl_fail(found, TL_UNSTABLE, "%s.%s = %g is taken", table->name, row->name,
                    wrong[i % TL_COUNT(wrong)]);
            i = table->row_count * TL_COUNT(wrong);
        }
        tl_cloth_destroy(&cloth);
    }
    tl_garment_release(&garment);
    return outcome;
}

static enum tl_outcome refuse_fabrics(int solver, struct tl_cell_error *error, tl_error *found)
{
    (void)error;
    return refuse_numbers(solver, &tl_cloth_fabric_options, true, found);
}

static enum tl_outcome refuse_params(int solver, struct tl_cell_error *error, tl_error *found)
{
    (void)error;
    return refuse_numbers(solver, &tl_cloth_options, false, found);
}

/* ---- Targets and avatars ---- */

static void grab_nothing(struct trial *trial, int frame)
{
    if (frame == 5)
        tl_cloth_grab(trial->cloth, SIDE * SIDE - 1, (vec3s){{NAN, 0, INFINITY}});
}

static void grab_far(struct trial *trial, int frame)
{
    if (frame == 5)
        tl_cloth_grab(trial->cloth, SIDE * SIDE - 1, (vec3s){{1e6f, 1e30f, 0}});
    if (frame == 20)
        tl_cloth_release(trial->cloth);
}

static tl_mesh make_ball(int rings)
{
    int sides = 2 * rings;
    tl_mesh mesh = {.vertex_count = (size_t)((rings + 1) * sides)};
    mesh.positions = TL_NEW_ARRAY(vec3s, mesh.vertex_count);
    mesh.indices = TL_NEW_ARRAY(uint32_t, (size_t)(6 * rings * sides));
    for (int i = 0; i < (rings + 1) * sides; i++) {
        int ring = i / sides;
        double polar = M_PI * ring / rings, turn = 2 * M_PI * (i % sides) / sides;
        double wide = ring == 0 || ring == rings ? 0 : BALL_M * sin(polar);
        mesh.positions[i] =
            (vec3s){{(float)(0.5 + wide * cos(turn)), (float)(BALL_TOP - BALL_M + BALL_M * cos(polar)),
                     (float)(0.5 - wide * sin(turn))}};
    }
    for (int ring = 0; ring < rings; ring++)
        for (int side = 0; side < sides; side++) {
            uint32_t a = (uint32_t)(ring * sides + side), b = (uint32_t)(ring * sides + (side + 1) % sides);
            uint32_t d = a + (uint32_t)sides, c = b + (uint32_t)sides;
            const uint32_t corners[6] = {a, d, c, a, c, b};
            memcpy(mesh.indices + mesh.index_count, corners, sizeof corners);
            mesh.index_count += TL_COUNT(corners);
        }
    return mesh;
}

/* A sheet that falls on a ball. */
static void lay_on_ball(struct trial *trial)
{
    tl_garment_release(&trial->garment);
    trial->garment = tl_sheet_make(SIDE + 4, TL_SHEET_FREE, true);
    trial->ball = make_ball(16);
    trial->frames = 90;
}

static void rough_and_thick(struct trial *trial)
{
    lay_on_ball(trial);
    trial->fabric.friction = 10;
    trial->fabric.thickness_m = 0.1;
}

static void come_to_rest(struct trial *trial, int frame)
{
    tl_error unused;
    if (frame == 0) /* later frames would refuse it, too */
        tl_cloth_settle(trial->cloth, trial->collider, &unused);
}

static void lay_long(struct trial *trial)
{
    lay_on_ball(trial);
    trial->params.settle_s = 20;
    trial->frames = 150;
}

static void move_ball(struct trial *trial, vec3s by)
{
    for (size_t i = 0; i < trial->ball.vertex_count; i++)
        trial->moved[i] = glms_vec3_add(trial->ball.positions[i], by);
    tl_collider_move(trial->collider, trial->moved);
}

/* It jumps at frame 30, and has arrived at frame 31. */
static void jump(struct trial *trial, int frame, vec3s by)
{
    if (frame == 30 || frame == 31)
        move_ball(trial, by);
}

static void jump_aside_little(struct trial *trial, int frame)
{
    jump(trial, frame, (vec3s){{0.1f, 0, 0}});
}

static void jump_aside(struct trial *trial, int frame)
{
    jump(trial, frame, (vec3s){{1, 0, 0}});
}

static void jump_away(struct trial *trial, int frame)
{
    jump(trial, frame, (vec3s){{1e3f, 1e3f, 0}});
}

static void jump_through(struct trial *trial, int frame)
{
    jump(trial, frame, (vec3s){{0, 0.5f, 0}});
}

static void nan_ball(struct trial *trial, int frame)
{
    if (frame == 30)
        move_ball(trial, (vec3s){{NAN, 0, 0}});
    if (frame == 31 || frame == 32)
        move_ball(trial, (vec3s){{0, 0, 0}});
}

/* ---- Denormals and sizes ---- */

/* `strayed_m`: how far the farthest vertex went. */
static double fastest_frame_ms(int solver, double gravity, double *strayed_m)
{
    tl_garment garment = tl_sheet_make(2 * SIDE, TL_SHEET_EDGE, false);
    struct tl_cloth_fabric fabric = *(const struct tl_cloth_fabric *)tl_cloth_fabric_options.defaults;
    struct tl_cloth_params params = *(const struct tl_cloth_params *)tl_cloth_options.defaults;
    tl_error error;
    double fastest = INFINITY;
    params.solver = solver;
    params.gravity = gravity;
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    for (int frame = 0; frame < 5; frame++) {
        struct tl_stopwatch watch = tl_stopwatch_start();
        if (!cloth || !tl_cloth_step(cloth, NULL, &error))
            break;
        fastest = fmin(fastest, tl_stopwatch_read(&watch).cpu_ms);
    }
    *strayed_m = cloth ? tl_cloth_farthest_from(cloth, &garment) : NAN;
    tl_cloth_destroy(&cloth);
    tl_garment_release(&garment);
    return fastest;
}

static struct tl_cell_error error_in_mm(double length_m, double whole_m)
{
    return (struct tl_cell_error){.share = length_m / whole_m, .own = 1e3 * length_m, .unit = "mm"};
}

/* Gravity so small that every velocity is a denormal number, and the sheet stays where it is. */
static enum tl_outcome time_denormals(int solver, struct tl_cell_error *error, tl_error *found)
{
    double strayed_m, unused;
    double ratio = fastest_frame_ms(solver, 1e-310, &strayed_m) / fastest_frame_ms(solver, 9.81, &unused);
    *error = error_in_mm(strayed_m, 1);
    say(found, "a frame takes %.2f times as long", ratio);
    return ratio <= SLOWER ? tl_outcome_of(error->share, 0, TL_STATED_SHARE) : TL_OUTCOME_SILENT;
}

/* Tubes as the envelope's, under their own weight. */
static enum tl_outcome hang_tube(const struct tl_envelope_size *size, int solver, double height_m,
                                 struct tl_cell_error *error, tl_error *found)
{
    const struct tl_envelope_case tested = {.size = size,
                                            .solver = solver,
                                            .stiffness = 1e3,
                                            .dt = 1.0 / 60,
                                            .mass_ratio = 1,
                                            .height_m = height_m,
                                            .caged_above = CAGED_ABOVE};
    struct tl_envelope_cell cell = tl_envelope_run(&tested);
    *found = cell.message;
    *error = cell.error;
    if (!found->message[0])
        say(found, "strays by %.3g of what is exact", cell.strayed);
    return cell.outcome;
}

static const struct tl_envelope_size small_tube = {"100", 5, 19, true, true},
                                     caged_tube = {"10k", 50, 199, false, true};

static enum tl_outcome hang_millimetre(int solver, struct tl_cell_error *error, tl_error *found)
{
    return hang_tube(&small_tube, solver, 1e-3, error, found);
}

static enum tl_outcome hang_hundred_metres(int solver, struct tl_cell_error *error, tl_error *found)
{
    return hang_tube(&small_tube, solver, 100, error, found);
}

/* The reference solver has no cage. Of 4,000 vertices none is made. */
static enum tl_outcome hang_by_cage(int solver, struct tl_cell_error *error, tl_error *found)
{
    return hang_tube(&caged_tube, solver, 1, error, found);
}

/* clang-format off: a table reads best as one. */
static const struct extreme extremes[] = {
    {"an ordinary sheet", ENERGY, NULL, NULL, NULL},
    {"needles of 1e-6 m", ENERGY, make_needles, NULL, NULL},
    {"triangles of no area", ENERGY, make_zero_area, NULL, NULL},
    {"every triangle twice", ENERGY, double_triangles, NULL, NULL},
    {"an edge of three triangles", FINITE, add_fin, NULL, NULL},
    {"vertices of no triangle", ENERGY, isolate_vertices, NULL, NULL},
    {"all of it in one line of its start", FINITE, collapse, NULL, NULL},
    {"stretched by half", ENERGY, stretch, NULL, NULL},
    {"stretched by half, steps of 1e-4 s", ENERGY, stretch_small_step, NULL, NULL},
    {"all of it without area", FINITE, flatten_to_line, NULL, NULL},
    {"cut inside out", ENERGY, turn_inside_out, NULL, NULL},
    {"every vertex pinned", ENERGY, pin_all, NULL, NULL},
    {"a vertex that is NaN", REFUSES, nan_vertex, NULL, NULL},
    {"a vertex at infinity", REFUSES, infinite_vertex, NULL, NULL},
    {"a vertex at 1e30 m", FINITE, far_vertex, NULL, NULL},
    {"a pattern with NaN", REFUSES, nan_pattern, NULL, NULL},
    {"a corner that is no vertex", REFUSES, wrong_index, NULL, NULL},
    {"no triangles", REFUSES, no_triangles, NULL, NULL},
    {"a seam to nowhere", REFUSES, seam_to_nowhere, NULL, NULL},
    {"a pin to nowhere", REFUSES, pin_to_nowhere, NULL, NULL},
    {"fabrics with NaN, Inf, 1e300", REFUSES, NULL, NULL, refuse_fabrics},
    {"settings with NaN, Inf, 1e300", REFUSES, NULL, NULL, refuse_params},
    {"no stiffness at all", FINITE, no_stiffness, NULL, NULL},
    {"weft 1e-2, warp 1e6 N/m", ENERGY, one_direction, NULL, NULL},
    {"bending 1e3 N m", ENERGY, stiff_bending, NULL, NULL},
    {"0.1 g/m^2", ENERGY, lightest, NULL, NULL},
    {"100 kg/m^2", ENERGY, heaviest, NULL, NULL},
    {"damping 1000 1/s", ENERGY, max_damping, NULL, NULL},
    {"gravity 100 m/s^2", ENERGY, max_gravity, NULL, NULL},
    {"gravity upwards", ENERGY, upward_gravity, NULL, NULL},
    {"pulled to NaN", ENERGY, NULL, grab_nothing, NULL},
    {"pulled to 1e30 m", FINITE, NULL, grab_far, NULL},
    {"laid on a ball", OUTSIDE, lay_on_ball, NULL, NULL},
    {"at rest on a ball", RESTS, lay_long, come_to_rest, NULL},
    {"friction 10, thickness 0.1 m", OUTSIDE, rough_and_thick, NULL, NULL},
    {"the ball jumps by 0.1 m", OUTSIDE, lay_on_ball, jump_aside_little, NULL},
    {"the ball jumps by 1 m", OUTSIDE, lay_on_ball, jump_aside, NULL},
    {"the ball jumps by 1 km", OUTSIDE, lay_on_ball, jump_away, NULL},
    {"the ball jumps through the cloth", OUTSIDE, lay_on_ball, jump_through, NULL},
    {"the ball is NaN for a frame", OUTSIDE, lay_on_ball, nan_ball, NULL},
    {"denormal velocities", FINITE, NULL, NULL, time_denormals},
    {"a garment of 1 mm", FINITE, NULL, NULL, hang_millimetre},
    {"a garment of 100 m", FINITE, NULL, NULL, hang_hundred_metres},
    {"moved by a cage (not reference)", FINITE, NULL, NULL, hang_by_cage},
};
/* clang-format on */
const size_t tl_cloth_extreme_count = TL_COUNT(extremes);

const char *tl_cloth_extreme_name(size_t index)
{
    return extremes[index].name;
}

bool tl_cloth_extreme_is_slow(size_t index)
{
    return extremes[index].promise == OUTSIDE || extremes[index].promise == RESTS;
}

/* ---- Running ---- */

static bool prepare(struct trial *trial, int solver, const struct extreme *extreme, tl_error *found)
{
    *trial = (struct trial){
        .garment = tl_sheet_make(SIDE, TL_SHEET_EDGE, false),
        .fabric = *(const struct tl_cloth_fabric *)tl_cloth_fabric_options.defaults,
        .params = *(const struct tl_cloth_params *)tl_cloth_options.defaults,
        .frames = FRAMES,
    };
    trial->params.solver = solver;
    if (extreme->change)
        extreme->change(trial);
    if (trial->ball.vertex_count) {
        trial->moved = TL_NEW_ARRAY(vec3s, trial->ball.vertex_count);
        trial->collider = tl_collider_create(&trial->ball, false, found);
        if (!trial->collider)
            return false;
    }
    trial->cloth = tl_cloth_create(&trial->garment, &trial->fabric, &trial->params, found);
    return trial->cloth != NULL;
}

static void release(struct trial *trial)
{
    tl_cloth_destroy(&trial->cloth);
    tl_collider_destroy(&trial->collider);
    tl_garment_release(&trial->garment);
    tl_mesh_release(&trial->ball);
    free(trial->moved);
}

/* Elastic energy is >= 0, so that kinetic + potential energy never exceeds the initial total. */
static double motion_energy(const struct trial *trial)
{
    struct tl_cloth_report report = tl_cloth_measure(trial->cloth, NULL);
    return report.kinetic_energy + report.potential_energy;
}

static enum tl_outcome judge(const struct trial *trial, enum promise promise, double first, double maximum,
                             struct tl_cell_error *error, tl_error *found)
{
    struct tl_cloth_report report = tl_cloth_measure(trial->cloth, trial->collider);
    double weight = trial->fabric.areal_density * fabs(trial->params.gravity); /* of a square metre */
    bool kept = true;
    switch (promise) {
    case REFUSES:
        tl_fail(found, TL_UNSTABLE, "taken, and should have been refused");
        return TL_OUTCOME_SILENT;
    case ENERGY:
        say(found, "energy grew by %.2g J, may by %.2g J", maximum - first, HEADROOM * weight);
        kept = maximum - first <= HEADROOM * weight;
        *error = error_in_mm((maximum - first) / weight, 1);
        break;
    case OUTSIDE:
        say(found, "%.2g mm deep, largest strain %.2g", 1e3 * report.deepest_m, report.max_strain);
        kept = report.deepest_m <= DEEP_M;
        *error = error_in_mm(report.deepest_m, 1);
        break;
    case RESTS:
        say(found, "%.2g mm/s after %.0f s (%.2g mm/s at its end)", 1e3 * trial->max_speed, report.time_s,
            1e3 * report.max_speed);
        kept = trial->max_speed <= REST_MS;
        *error = error_in_mm(trial->max_speed / trial->params.frame_rate, 1);
        break;
    case FINITE:
        say(found, "finite; largest strain %.2g", report.max_strain);
        *error = error_in_mm(report.max_strain / (SIDE - 1), 1.0 / (SIDE - 1));
        break;
    }
    return kept ? tl_outcome_of(error->share, -1, TL_STATED_SHARE) : TL_OUTCOME_SILENT;
}

static void keep_pace(struct trial *trial, const vec3s *before, vec3s *after)
{
    trial->max_speed = 0;
    tl_cloth_positions(trial->cloth, after);
    for (size_t i = 0; i < trial->garment.model.mesh.vertex_count; i++)
        trial->max_speed = fmax(trial->max_speed,
                                (double)glms_vec3_distance(before[i], after[i]) * trial->params.frame_rate);
}

static enum tl_outcome run_frames(struct trial *trial, const struct extreme *extreme,
                                  struct tl_cell_error *error, tl_error *found)
{
    enum tl_outcome outcome = TL_OUTCOME_BOUNDED;
    size_t count = trial->garment.model.mesh.vertex_count;
    vec3s *before = TL_NEW_ARRAY(vec3s, count), *after = TL_NEW_ARRAY(vec3s, count);
    double first = motion_energy(trial) + tl_cloth_measure(trial->cloth, NULL).elastic_energy,
           maximum = first;
    for (int frame = 0; frame < trial->frames && outcome == TL_OUTCOME_BOUNDED; frame++) {
        if (extreme->act)
            extreme->act(trial, frame);
        tl_cloth_positions(trial->cloth, before);
        outcome = tl_cloth_try_step(trial->cloth, trial->collider, count, found);
        keep_pace(trial, before, after);
        maximum = fmax(maximum, motion_energy(trial));
    }
    free(before);
    free(after);
    return outcome == TL_OUTCOME_BOUNDED ? judge(trial, extreme->promise, first, maximum, error, found)
                                         : outcome;
}

enum tl_outcome tl_cloth_extreme_run(size_t index, int solver, struct tl_cell_error *error, tl_error *found)
{
    const struct extreme *extreme = &extremes[index];
    struct trial trial;
    *found = (tl_error){0};
    *error = TL_CELL_NO_ERROR;
    omp_set_num_threads(1); /* threads cost more than they gain on small meshes */
    if (extreme->run)
        return extreme->run(solver, error, found);
    enum tl_outcome outcome = prepare(&trial, solver, extreme, found)
                                  ? run_frames(&trial, extreme, error, found)
                                  : tl_refusal_outcome(found);
    release(&trial);
    return outcome;
}
