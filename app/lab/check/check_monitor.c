#include "app/lab/check/check_monitor.h"

#include "config/base/memory.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Largest speed of the hand of app/measure/motion.c, m/s. */
#define HAND_SPEED 1.0
/* Factor on the sum of the driving speeds: the end of a whip is faster than the hand that swings it. */
#define WHIP 3.0

static double area_of(const tl_mesh *mesh, const uint32_t corners[3])
{
    vec3s origin = mesh->positions[corners[0]];
    vec3s a = glms_vec3_sub(mesh->positions[corners[1]], origin);
    vec3s b = glms_vec3_sub(mesh->positions[corners[2]], origin);
    return 0.5 * (double)glms_vec3_norm(glms_vec3_cross(a, b));
}

/* The weight of the garment in its rest shape, newtons. */
static double weigh(tl_session *session, const struct tl_settings *settings)
{
    const tl_model *model = tl_session_garment(session);
    double area = 0;
    for (size_t i = 0; model && i + 2 < model->mesh.index_count; i += 3)
        area += area_of(&model->mesh, &model->mesh.indices[i]);
    return area * settings->fabric.areal_density * settings->cloth.gravity;
}

/* The speed after a free fall from the highest point of the scene to the lowest. */
static double fall_speed(const tl_frame *frame, double gravity)
{
    double lowest = DBL_MAX, highest = -DBL_MAX;
    for (size_t s = 0; s < frame->surface_count; s++)
        for (size_t v = 0; v < frame->surfaces[s].vertex_count; v++) {
            lowest = fmin(lowest, (double)frame->surfaces[s].positions[v].y);
            highest = fmax(highest, (double)frame->surfaces[s].positions[v].y);
        }
    return highest > lowest ? sqrt(2 * gravity * (highest - lowest)) : 0;
}

/* The speed of the fastest vertex of the wearer since the last frame. Keeps this frame's positions for the
 * next call. */
static double wearer_speed(struct tl_cloth_monitor *watch, const tl_frame *frame)
{
    double farthest = 0;
    for (size_t s = 0; s < frame->surface_count; s++) {
        const tl_surface *surface = &frame->surfaces[s];
        if (strcmp(surface->name, "avatar") != 0)
            continue;
        size_t bytes = surface->vertex_count * sizeof(vec3s);
        for (size_t v = 0; watch->wearer && v < surface->vertex_count; v++)
            farthest = fmax(farthest, (double)glms_vec3_distance(surface->positions[v], watch->wearer[v]));
        watch->wearer = tl_resize(watch->wearer, bytes, 1);
        memcpy(watch->wearer, surface->positions, bytes);
    }
    return farthest * watch->settings->cloth.frame_rate;
}

/* The garment's centre of mass in the plane of the ground, with each triangle's mass from its rest shape. */
static void find_centre(const struct tl_cloth_monitor *watch, const tl_frame *frame, double centre[2])
{
    const tl_mesh *cut = &tl_session_garment(watch->session)->mesh;
    const tl_surface *garment = &frame->surfaces[frame->surface_count - 1];
    double weight = 0, sum[2] = {0};
    for (size_t i = 0; i + 2 < cut->index_count; i += 3) {
        const uint32_t *at = &cut->indices[i];
        double area = area_of(cut, at);
        weight += 3 * area;
        for (int c = 0; c < 3; c++) {
            sum[0] += area * (double)garment->positions[at[c]].x;
            sum[1] += area * (double)garment->positions[at[c]].z;
        }
    }
    centre[0] = sum[0] / weight;
    centre[1] = sum[1] / weight;
}

/* Without wearer and ground nothing ends a fall. */
static bool nothing_below(const struct tl_cloth_monitor *watch, const tl_frame *frame)
{
    return frame->surface_count == 1 && !watch->settings->image.ground;
}

/* Horizontal displacement since the first frame, metres. NaN if anything supports, holds or pushes the cloth,
 * or did so earlier. */
static double measure_drift(struct tl_cloth_monitor *watch, const tl_frame *frame, bool is_driven)
{
    const struct tl_settings *settings = watch->settings;
    bool is_free = nothing_below(watch, frame) && !(settings->cloth.pin_above_m > 0);
    double centre[2];
    if (!is_free || is_driven || watch->was_held)
        return NAN;
    find_centre(watch, frame, centre);
    if (isnan(watch->centre[0]))
        memcpy(watch->centre, centre, sizeof centre);
    return hypot(centre[0] - watch->centre[0], centre[1] - watch->centre[1]);
}

static double wind_speed(const float wind[3])
{
    return sqrt((double)(wind[0] * wind[0] + wind[1] * wind[1] + wind[2] * wind[2]));
}

/* Cloth that releases a strain e moves at e sqrt(k / areal density), as behind a wave along a rod. The steps
 * of the other solvers damp such waves; the reference solver keeps their energy. */
static double spring_speed(const struct tl_settings *settings, double strain)
{
    const struct tl_cloth_fabric *fabric = &settings->fabric;
    double stiffness = fmax(fabric->stretch_warp, fabric->stretch_weft);
    return settings->cloth.solver == TL_CLOTH_REFERENCE ? strain * sqrt(stiffness / fabric->areal_density)
                                                        : 0;
}

struct tl_checked_cloth tl_cloth_monitor_measure(struct tl_cloth_monitor *watch, const tl_frame *frame,
                                                 bool is_held, bool is_changed)
{
    const struct tl_cloth_params *params = &watch->settings->cloth;
    double blows = wind_speed(params->wind), falls = fall_speed(frame, params->gravity);
    struct tl_checked_cloth cloth = {.report = tl_session_report(watch->session),
                                     .strain_limit =
                                         params->solver == TL_CLOTH_PREVIEW ? params->strain_limit : 0,
                                     .weight_n = watch->weight_n,
                                     .kept_m = watch->settings->fabric.thickness_m,
                                     .first_strain = watch->first_strain,
                                     .first_elastic_j = NAN,
                                     .min_energy_j = watch->min_energy_j,
                                     .is_held = is_held,
                                     .is_hurried = is_changed,
                                     .cannot_cross = params->self_contact,
                                     .is_dragged = tl_session_plays_clip(watch->session)};
    cloth.is_driven = is_held || is_changed || blows > 0 || cloth.is_dragged;
    const struct tl_cloth_report *report = &cloth.report;
    if (nothing_below(watch, frame))
        falls = fmax(falls, params->gravity * report->time_s);
    watch->was_held = watch->was_held || is_held;
    cloth.drift_m = measure_drift(watch, frame, cloth.is_driven);
    cloth.allowed_speed =
        WHIP * (falls + wearer_speed(watch, frame) + blows + (watch->was_held ? HAND_SPEED : 0)) +
        spring_speed(watch->settings, report->max_strain);
    if (isnan(watch->first_strain))
        watch->first_strain = report->max_strain;
    double energy_j = report->kinetic_energy + report->elastic_energy + report->potential_energy;
    watch->min_energy_j =
        cloth.is_driven ? NAN : fmin(watch->min_energy_j, energy_j); /* fmin of a NaN: the other */
    return cloth;
}

struct tl_cloth_monitor tl_cloth_monitor_begin(tl_session *session, const struct tl_settings *settings)
{
    return (struct tl_cloth_monitor){.session = session,
                                     .settings = settings,
                                     .weight_n = weigh(session, settings),
                                     .min_energy_j = NAN,
                                     .first_strain = NAN,
                                     .centre = {NAN, NAN}};
}

void tl_cloth_monitor_release(struct tl_cloth_monitor *watch)
{
    free(watch->wearer);
    watch->wearer = NULL;
}
