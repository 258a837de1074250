#include "render/reference/gather.h"

#include "config/simd.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* What a reflected point is lit by: few directions, because there are many such points. */
#define REFLECTED_STRATA       8
#define REFLECTED_LOBE_SAMPLES 1
#define LOBE_END               40.0f /* exp(-40) of a lobe's peak is nothing */
#define GOLDEN                 0.61803398874989485

void tl_spots_add(struct tl_spots *spots, const struct tl_spot *spot)
{
    int i = spots->count++;
    for (int c = 0; c < 3; c++) {
        spots->point[c][i] = spot->point.raw[c];
        spots->horizon[c][i] = spot->horizon.raw[c];
        spots->normal[c][i] = spot->normal.raw[c];
        spots->axis[c][i] = spot->axis.raw[c];
        spots->diffuse[c][i] = spot->diffuse.raw[c];
        spots->glossy[c][i] = spot->glossy.raw[c];
    }
    spots->exponent[i] = spot->exponent;
}

/* The state of one call. */
struct gathering {
    const struct tl_gathering *asked;
    const struct tl_reference_scene *scene;
    const struct tl_spots *spots;
    bool diffuse[TL_SPOTS], glossy[TL_SPOTS]; /* whether the spot has such a lobe at all */
    struct tl_random shared, own;
    float (*light)[TL_SPOTS];
    size_t rays;
};

/* K_s of a direction whose cosine with the axis is 1 - `off` [DESIGN 3]. */
static float lobe_value(float exponent, float off)
{
    if (off >= 1 || exponent * off > LOBE_END)
        return 0;
    return (exponent + 1) / (2 * (float)M_PI) * expf(exponent * log1pf(-off));
}

/* 1 - cosine of the angle between two directions, without cancellation where they are close. */
static float off_axis(const struct tl_spots *spots, int i, vec3s w)
{
    float x = spots->axis[0][i] - w.x, y = spots->axis[1][i] - w.y, z = spots->axis[2][i] - w.z;
    return 0.5f * (x * x + y * y + z * z);
}

static float dot_of(const float v[3][TL_SPOTS], int i, vec3s w)
{
    return v[0][i] * w.x + v[1][i] * w.y + v[2][i] * w.z;
}

static vec3s point_of(const struct tl_spots *spots, int i)
{
    return (vec3s){{spots->point[0][i], spots->point[1][i], spots->point[2][i]}};
}

/* Rays whose light is worth asking for, and how much of it each would bring its spot. */
struct volley {
    struct tl_trace_bundle bundle;
    int spot[TL_SPOTS];
    vec3s light[TL_SPOTS];
};

static void add_ray(struct volley *volley, const struct gathering *gathering, int spot, vec3s direction,
                    vec3s light)
{
    int i = volley->bundle.count++;
    vec3s origin = point_of(gathering->spots, spot);
    volley->bundle.origin_x[i] = origin.x;
    volley->bundle.origin_y[i] = origin.y;
    volley->bundle.origin_z[i] = origin.z;
    volley->bundle.direction_x[i] = direction.x;
    volley->bundle.direction_y[i] = direction.y;
    volley->bundle.direction_z[i] = direction.z;
    volley->spot[i] = spot;
    volley->light[i] =
        glms_vec3_scale(light, tl_ground_visibility(gathering->scene->ground, origin, direction));
}

static void add_light(struct gathering *gathering, int spot, vec3s light)
{
    for (int c = 0; c < 3; c++)
        gathering->light[c][spot] += light.raw[c];
}

static void fire(struct gathering *gathering, struct volley *volley)
{
    if (volley->bundle.count == 0)
        return;
    uint32_t stopped = tl_trace_occluded_bundle(gathering->scene->trace, &volley->bundle);
    for (int i = 0; i < volley->bundle.count; i++)
        if (!(stopped >> i & 1))
            add_light(gathering, volley->spot[i], volley->light[i]);
    gathering->rays += (size_t)volley->bundle.count;
}

static vec3s weigh(const struct tl_spots *spots, int i, vec3s radiance, float diffuse, float glossy)
{
    vec3s light;
    for (int c = 0; c < 3; c++)
        light.raw[c] =
            fminf(radiance.raw[c] * (spots->diffuse[c][i] * diffuse + spots->glossy[c][i] * glossy), FLT_MAX);
    return light;
}

static bool is_dark(vec3s light)
{
    return !(light.x > 0 || light.y > 0 || light.z > 0);
}

/* One direction from the environment, for all spots. */
static void gather_stratum(struct gathering *gathering, const struct tl_skylight *sky)
{
    const struct tl_spots *spots = gathering->spots;
    float draws = (float)gathering->asked->strata * sky->density;
    struct volley volley = {.bundle = {.to_m = INFINITY, .coherent = true}};
    for (int i = 0; i < spots->count; i++) {
        if (!(dot_of(spots->horizon, i, sky->direction) > 0))
            continue;
        float diffuse = 0, glossy = 0;
        if (gathering->diffuse[i])
            diffuse = fmaxf(dot_of(spots->normal, i, sky->direction), 0) / (float)M_PI / draws;
        if (gathering->glossy[i]) {
            float lobe = lobe_value(spots->exponent[i], off_axis(spots, i, sky->direction));
            glossy = lobe / (draws + (float)gathering->asked->lobe_samples * lobe);
        }
        vec3s light = weigh(spots, i, sky->radiance, diffuse, glossy);
        if (!is_dark(light))
            add_ray(&volley, gathering, i, sky->direction, light);
    }
    fire(gathering, &volley);
}

static void gather_strata(struct gathering *gathering)
{
    const struct tl_gathering *asked = gathering->asked;
    for (int i = 0; i < asked->strata; i++) {
        int turn = (int)(tl_random_unit(&gathering->shared) * asked->slots);
        int slot = (asked->slot + turn) % asked->slots;
        double within = (slot + tl_random_unit(&gathering->own)) / asked->slots;
        double x = tl_random_unit(&gathering->own), y = tl_random_unit(&gathering->own);
        struct tl_skylight sky = tl_sky_draw(&gathering->scene->sky, (i + within) / asked->strata, x, y);
        gather_stratum(gathering, &sky);
    }
}

/* A direction drawn from K_s about the axis: `off` is 1 - its cosine, whose density is (s + 1) cos^s. */
static vec3s draw_lobe(const struct tl_spots *spots, int i, double height, double turn, float *off)
{
    double away = -expm1(log(1 - height) / ((double)spots->exponent[i] + 1));
    double radius = sqrt(fmax(away * (2 - away), 0)), angle = 2 * M_PI * turn;
    vec3s axis = {{spots->axis[0][i], spots->axis[1][i], spots->axis[2][i]}};
    vec3s aside = fabsf(axis.x) < 0.6f ? (vec3s){{1, 0, 0}} : (vec3s){{0, 1, 0}};
    vec3s a = glms_vec3_normalize(glms_vec3_cross(axis, aside)), b = glms_vec3_cross(axis, a);
    vec3s w = glms_vec3_scale(axis, (float)(1 - away));
    w = glms_vec3_add(w, glms_vec3_scale(a, (float)(radius * cos(angle))));
    w = glms_vec3_add(w, glms_vec3_scale(b, (float)(radius * sin(angle))));
    *off = (float)away;
    return glms_vec3_normalize(w);
}

/* Reflections that met the scene, and whose they are. */
struct reflections {
    struct tl_spots spots;
    int owner[TL_SPOTS];
    float share[TL_SPOTS];
};

/* Where a mirror's ray ends: in the sky, in the scene, or, where the ground fades, in both. */
static void reflect(struct gathering *gathering, int i, vec3s direction, vec3s sky_light,
                    struct reflections *reflections)
{
    const struct tl_ray ray = {
        .origin = point_of(gathering->spots, i), .direction = direction, .to_m = INFINITY};
    struct tl_spot met = tl_spot_find(gathering->scene, &ray);
    gathering->rays++;
    add_light(gathering, i, glms_vec3_scale(sky_light, 1 - met.cover));
    if (met.cover > 0) {
        int r = reflections->spots.count;
        tl_spots_add(&reflections->spots, &met);
        reflections->owner[r] = i;
        reflections->share[r] = met.cover / (float)gathering->asked->lobe_samples;
    }
}

static void light_reflections(struct gathering *gathering, const struct reflections *reflections)
{
    if (reflections->spots.count == 0)
        return;
    const struct tl_gathering inner = {.scene = gathering->scene,
                                       .strata = REFLECTED_STRATA,
                                       .lobe_samples = REFLECTED_LOBE_SAMPLES,
                                       .slots = 1,
                                       .shared = gathering->own,
                                       .own = tl_random_begin(gathering->own.state, 1)};
    float light[3][TL_SPOTS];
    gathering->rays += tl_gather(&inner, &reflections->spots, light);
    for (int r = 0; r < reflections->spots.count; r++)
        for (int c = 0; c < 3; c++)
            gathering->light[c][reflections->owner[r]] +=
                gathering->spots->glossy[c][reflections->owner[r]] * reflections->share[r] * light[c][r];
}

/* One direction from each spot's lobe. */
static void gather_lobes(struct gathering *gathering, int sample)
{
    const struct tl_spots *spots = gathering->spots;
    const struct tl_gathering *asked = gathering->asked;
    struct volley volley = {.bundle = {.to_m = INFINITY}};
    struct reflections reflections = {0};
    for (int i = 0; i < spots->count; i++) {
        double height = (sample + tl_random_unit(&gathering->own)) / asked->lobe_samples;
        double turn = tl_random_unit(&gathering->own);
        if (!gathering->glossy[i])
            continue;
        float off;
        vec3s direction = draw_lobe(spots, i, fmin(height, 1 - DBL_EPSILON), turn, &off);
        if (!(dot_of(spots->horizon, i, direction) > 0))
            continue;
        struct tl_skylight sky = tl_sky_look(&gathering->scene->sky, direction);
        float lobe = lobe_value(spots->exponent[i], off);
        float glossy = lobe / ((float)asked->strata * sky.density + (float)asked->lobe_samples * lobe);
        vec3s light = weigh(spots, i, sky.radiance, 0, glossy);
        if (asked->reflect && spots->exponent[i] >= TL_MIRROR_EXPONENT)
            reflect(gathering, i, direction, light, &reflections);
        else if (!is_dark(light))
            add_ray(&volley, gathering, i, direction, light);
    }
    fire(gathering, &volley);
    light_reflections(gathering, &reflections);
}

size_t tl_gather(const struct tl_gathering *asked, const struct tl_spots *spots, float light[3][TL_SPOTS])
{
    struct gathering gathering = {.asked = asked,
                                  .scene = asked->scene,
                                  .spots = spots,
                                  .shared = asked->shared,
                                  .own = asked->own,
                                  .light = light};
    bool any_glossy = false;
    for (int i = 0; i < spots->count; i++) {
        gathering.diffuse[i] =
            spots->diffuse[0][i] > 0 || spots->diffuse[1][i] > 0 || spots->diffuse[2][i] > 0;
        gathering.glossy[i] = spots->glossy[0][i] > 0 || spots->glossy[1][i] > 0 || spots->glossy[2][i] > 0;
        any_glossy |= gathering.glossy[i];
    }
    memset(light, 0, 3 * sizeof light[0]);
    gather_strata(&gathering);
    for (int i = 0; any_glossy && i < asked->lobe_samples; i++)
        gather_lobes(&gathering, i);
    for (int c = 0; c < 3; c++) /* no infinity goes on, so that nothing times zero makes a NaN */
        for (int i = 0; i < spots->count; i++)
            light[c][i] = fminf(light[c][i], FLT_MAX);
    return gathering.rays;
}
