#include "app/lab/check/check_fall.h"

#include "app/lab/check/check_measures.h"
#include "cloth/cloth.h"
#include "config/memory.h"

#include <math.h>
#include <stdlib.h>

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

static double expected_fall(double gravity, double drag, double t)
{
    if (drag * t < 1e-3)
        return gravity * t * t / 2;
    return gravity / drag * (t - (1 - exp(-drag * t)) / drag);
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
    out->expected_m = expected_fall(settings->cloth.gravity, settings->fabric.damping, t);
    out->sideways_m = hypot(after.x - before.x, after.z - before.z);
    out->tolerance = tl_cloth_measure(cloth, NULL).substep_s / t;
    return done;
}

static bool is_pinned(const tl_garment *cut, const struct tl_cloth_params *params)
{
    return cut->pin_count > 0 || params->pin_above_m > 0 || params->pin_colour != TL_PIN_NO_COLOUR ||
           params->pin_openings[0];
}

bool tl_fall_measure(tl_session *session, const struct tl_settings *settings, struct tl_fall *out,
                     tl_error *error)
{
    tl_cloth *cloth = tl_session_cloth(session);
    struct tl_cloth_params params = settings->cloth;
    *out = (struct tl_fall){0};
    if (!cloth || !tl_cloth_is_settled(cloth) || !(params.gravity > 0) ||
        is_pinned(tl_session_cut(session), &params))
        return true;
    tl_cloth_reset(cloth);
    if (tl_cloth_measure(cloth, NULL).open_seams > 0)
        return true;
    params.wind[0] = params.wind[1] = params.wind[2] = 0;
    return tl_cloth_set(cloth, &settings->fabric, &params, error) &&
           fall(cloth, &tl_session_garment(session)->mesh, settings, out, error);
}

void tl_measure_fall(const struct tl_checked *checked, struct tl_finding *finding)
{
    const struct tl_fall *fell = checked->fall;
    if (!fell || !fell->is_measured)
        return;
    double off = fabs(fell->fallen_m - fell->expected_m) + fell->sideways_m;
    finding->bound = 0.01 + fell->tolerance;
    tl_finding_add(finding, off / fell->expected_m);
    tl_finding_place(finding, "garment: %.4f m of %.4f, %.4f m sideways", fell->fallen_m, fell->expected_m,
                     fell->sideways_m);
}
