#include "app/lab/check/check_trials.h"

#include "app/lab/check/check_measures.h"
#include "app/lab/experiments/closed_form.h"
#include "cloth/cloth.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

/* ---- Fall ---- */

/* Weights, for 99 % of the vertices: cloth whose tension is far from balance changes its shape as it falls.
 */
#define NEAR_BALANCE 10

/* Seconds. The drag of ordinary fabrics shortens the fall by 5 % in this time. */
#define DURATION_S (1.0 / 3)

struct centre {
    double x, y, z;
};

/* With a third of every triangle's mass, from its rest shape, at each corner. */
static struct centre centre_of(const tl_mesh *mesh, const vec3s *positions)
{
    struct centre sum = {0};
    double weight = 0;
    for (size_t i = 0; i + 2 < mesh->index_count; i += 3) {
        const uint32_t *at = &mesh->indices[i];
        vec3s a = glms_vec3_sub(mesh->positions[at[1]], mesh->positions[at[0]]);
        vec3s b = glms_vec3_sub(mesh->positions[at[2]], mesh->positions[at[0]]);
        double area = (double)glms_vec3_norm(glms_vec3_cross(a, b));
        for (int c = 0; c < 3; c++) {
            sum.x += area * (double)positions[at[c]].x;
            sum.y += area * (double)positions[at[c]].y;
            sum.z += area * (double)positions[at[c]].z;
        }
        weight += 3 * area;
    }
    return (struct centre){sum.x / weight, sum.y / weight, sum.z / weight};
}

/* The way from rest under a constant acceleration and drag. */
static double expected_way(double acceleration, double drag, double t)
{
    if (drag * t < 1e-3)
        return acceleration * t * t / 2;
    return acceleration / drag * (t - (1 - exp(-drag * t)) / drag);
}

static bool fall(tl_cloth *cloth, const tl_mesh *mesh, const struct tl_settings *settings,
                 struct tl_fall *out, tl_error *error)
{
    int frames = (int)ceil(DURATION_S * settings->cloth.frame_rate);
    double t = frames / settings->cloth.frame_rate;
    vec3s *positions = TL_NEW_ARRAY(vec3s, mesh->vertex_count);
    tl_cloth_positions(cloth, positions);
    struct centre before = centre_of(mesh, positions);
    bool done = true;
    for (int i = 0; i < frames && done; i++)
        done = tl_cloth_step(cloth, NULL, error);
    tl_cloth_positions(cloth, positions);
    struct centre after = centre_of(mesh, positions);
    free(positions);
    out->is_measured = done;
    out->fallen_m = before.y - after.y;
    out->expected_m = expected_way(settings->cloth.gravity, settings->fabric.damping, t);
    out->sideways_m = hypot(after.x - before.x, after.z - before.z);
    out->tolerance = tl_cloth_measure(cloth, NULL).substep_s / t;
    return done;
}

static bool is_pinned(const tl_garment *cut, const struct tl_cloth_params *params)
{
    return cut->pin_count > 0 || params->pin_above_m > 0 || params->pin_colour != TL_PIN_NO_COLOUR ||
           tl_text_is_given(params->pin_openings);
}

static bool let_fall(tl_session *session, const struct tl_settings *settings, struct tl_fall *out,
                     tl_error *error)
{
    tl_cloth *cloth = tl_session_cloth(session);
    struct tl_cloth_params params = settings->cloth;
    if (!tl_cloth_is_still(cloth) || tl_cloth_balance(cloth).residual.high > NEAR_BALANCE ||
        !(params.gravity > 0) || is_pinned(tl_session_cut(session), &params))
        return true;
    tl_cloth_reset(cloth);
    if (tl_cloth_measure(cloth, NULL).open_seams > 0)
        return true;
    params.wind[0] = params.wind[1] = params.wind[2] = 0;
    return tl_cloth_set(cloth, &settings->fabric, &params, error) &&
           fall(cloth, &tl_session_garment(session)->mesh, settings, out, error);
}

/* ---- Strips and sheets ---- */

#define SUBSTEPS_MAX 100000000 /* of the reference solver: the largest that its option takes */

/* The scene's solver, with as many substeps as each mesh needs, for cloth that only gravity drives; nothing
 * is near enough to meet itself. */
static struct tl_cloth_params params_of_trial(const struct tl_settings *settings)
{
    struct tl_cloth_params params = settings->cloth;
    params.wind[0] = params.wind[1] = params.wind[2] = 0;
    params.substeps = 0;
    params.reference_substeps = SUBSTEPS_MAX;
    params.pin_above_m = 0;
    params.pin_colour = TL_PIN_NO_COLOUR;
    params.pin_openings = "";
    params.self_contact = false;
    return params;
}

static bool step_for(tl_cloth *cloth, const tl_collider *collider, double frames, tl_error *error)
{
    bool done = cloth != NULL;
    for (int i = 0; done && i < (int)ceil(frames); i++)
        done = tl_cloth_step(cloth, collider, error);
    return done;
}

/* Cells of a strip: the elastica's error is a quarter of a percent of its length. */
#define STRIP_CELLS 20

/* Under critical damping of its lowest mode, omega = 3.516 sqrt(B/rho)/L^2, the strip is at rest after
 * 8/omega. */
static bool let_droop(const struct tl_settings *settings, bool is_warp, struct tl_droop *worst,
                      tl_error *error)
{
    struct tl_cloth_fabric fabric = settings->fabric;
    const struct tl_cloth_params params = params_of_trial(settings);
    const double bend = is_warp ? fabric.bend_warp : fabric.bend_weft;
    if (!(bend > 0) || !(params.gravity > 0))
        return true;
    const double length = cbrt(TL_STRIP_LOAD * bend / (fabric.areal_density * params.gravity));
    const double omega = 3.516 * sqrt(params.gravity / (TL_STRIP_LOAD * length));
    fabric.damping = 2 * omega;
    tl_garment strip = tl_strip_make(length, STRIP_CELLS, is_warp);
    tl_cloth *cloth = tl_cloth_create(&strip, &fabric, &params, error);
    const bool done = step_for(cloth, NULL, 8 / omega * params.frame_rate, error);
    if (done) {
        vec3s *positions = TL_NEW_ARRAY(vec3s, strip.model.mesh.vertex_count);
        tl_cloth_positions(cloth, positions);
        const double tip = 1 - (double)positions[2 * STRIP_CELLS + 1].y, expected = TL_STRIP_DROOP * length;
        free(positions);
        if (!worst->is_measured || fabs(tip / expected - 1) > fabs(worst->tip_m / worst->expected_m - 1))
            *worst = (struct tl_droop){true, is_warp ? "warp" : "weft", length, tip, expected};
    }
    tl_cloth_destroy(&cloth);
    tl_garment_release(&strip);
    return done;
}

/* How much the slope's tangent exceeds the friction. */
#define SLOPE_EXCESS 0.3
#define SLOPE_S      0.3
#define SLOPE_SIDE   9 /* vertices */

/* A slab of 16 x 1 x 16 m under the plane through the origin that falls to +x by `tilt`. */
static tl_collider *make_slope(double tilt, tl_error *error)
{
    vec3s corners[8];
    for (int i = 0; i < 8; i++) {
        const double along = i & 1 ? 8 : -8, out = i & 2 ? 0 : -1;
        corners[i] = (vec3s){{(float)(cos(tilt) * along + sin(tilt) * out),
                              (float)(-sin(tilt) * along + cos(tilt) * out), i & 4 ? 8 : -8}};
    }
    static uint32_t triangles[36] = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                     2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
    const tl_mesh slab = {
        .vertex_count = 8, .positions = corners, .index_count = TL_COUNT(triangles), .indices = triangles};
    return tl_collider_create(&slab, false, error);
}

/* Lays a sheet in y = 0 on the slope, at the distance that contact keeps. */
static void lay_on_slope(tl_garment *sheet, double tilt, double kept_m)
{
    tl_mesh *mesh = &sheet->model.mesh;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        const double along = (double)mesh->positions[i].x;
        mesh->positions[i].x = (float)(cos(tilt) * along + sin(tilt) * kept_m);
        mesh->positions[i].y = (float)(-sin(tilt) * along + cos(tilt) * kept_m);
    }
}

static bool let_slide(const struct tl_settings *settings, struct tl_slide *out, tl_error *error)
{
    const struct tl_cloth_fabric *fabric = &settings->fabric;
    const struct tl_cloth_params params = params_of_trial(settings);
    if (!(params.gravity > 0))
        return true;
    const double tilt = atan(fabric->friction + SLOPE_EXCESS), frames = ceil(SLOPE_S * params.frame_rate);
    tl_garment sheet = tl_sheet_make(SLOPE_SIDE, TL_SHEET_FREE, true);
    lay_on_slope(&sheet, tilt, fabric->thickness_m);
    tl_collider *slope = make_slope(tilt, error);
    tl_cloth *cloth = slope ? tl_cloth_create(&sheet, fabric, &params, error) : NULL;
    const bool done = step_for(cloth, slope, frames, error);
    if (done) {
        const size_t middle = SLOPE_SIDE * SLOPE_SIDE / 2;
        const vec3s from = sheet.model.mesh.positions[middle];
        vec3s positions[SLOPE_SIDE * SLOPE_SIDE];
        tl_cloth_positions(cloth, positions);
        const double t = frames / params.frame_rate;
        *out = (struct tl_slide){
            .is_measured = true,
            .friction = fabric->friction,
            .slid_m = (double)glms_vec3_distance(positions[middle], from),
            .expected_m =
                expected_way(params.gravity * (sin(tilt) - fabric->friction * cos(tilt)), fabric->damping, t),
            .tolerance = tl_cloth_measure(cloth, NULL).substep_s / t};
    }
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&slope);
    tl_garment_release(&sheet);
    return done;
}

bool tl_trials_run(tl_session *session, const struct tl_settings *settings, struct tl_trials *out,
                   tl_error *error)
{
    *out = (struct tl_trials){0};
    if (!tl_session_cloth(session))
        return true;
    return let_fall(session, settings, &out->fall, error) && let_droop(settings, false, &out->droop, error) &&
           let_droop(settings, true, &out->droop, error) && let_slide(settings, &out->slide, error);
}

/* ---- What the invariants measure ---- */

void tl_measure_fall(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (!checked->trials || !checked->trials->fall.is_measured)
        return;
    const struct tl_fall *fell = &checked->trials->fall;
    double off = fabs(fell->fallen_m - fell->expected_m) + fell->sideways_m;
    finding->bound = 0.01 + fell->tolerance;
    tl_finding_add(finding, off / fell->expected_m);
    tl_finding_place(finding, "garment: %.4f m of %.4f, %.4f m sideways", fell->fallen_m, fell->expected_m,
                     fell->sideways_m);
}

void tl_measure_droop(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (!checked->trials || !checked->trials->droop.is_measured)
        return;
    const struct tl_droop *droop = &checked->trials->droop;
    tl_finding_add(finding, fabs(droop->tip_m / droop->expected_m - 1));
    tl_finding_place(finding, "fabric: a strip of %.1f mm along the %s droops by %.2f mm of %.2f",
                     1e3 * droop->length_m, droop->along, 1e3 * droop->tip_m, 1e3 * droop->expected_m);
}

void tl_measure_slide(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (!checked->trials || !checked->trials->slide.is_measured)
        return;
    const struct tl_slide *slide = &checked->trials->slide;
    finding->bound = 0.02 + slide->tolerance;
    tl_finding_add(finding, fabs(slide->slid_m / slide->expected_m - 1));
    tl_finding_place(finding, "fabric: with friction %.2f it slides %.4f m of %.4f", slide->friction,
                     slide->slid_m, slide->expected_m);
}
