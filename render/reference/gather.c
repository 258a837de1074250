#include "render/reference/gather.h"

#include "config/simd.h"
#include "render/reference/lamps.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* What a reflected point is lit by: few directions, because there are many such points. */
#define REFLECTED_STRATA       64
#define REFLECTED_LOBE_SAMPLES 1
#define LOBE_END               40.0f               /* exp(-40) of a lobe's peak is nothing */
#define GOLDEN                 0.61803398874989485 /* of a turn: leaves no gaps however many follow */

void tl_shading_points_add(struct tl_shading_points *spots, const struct tl_shading_point *spot)
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
    spots->layered[i] = spot->layered;
    if (spot->layered) {
        spots->any_layered = true;
        spots->layers[i] = spot->layers;
        spots->viewer[i] = spot->viewer;
    }
}

/* The state of one call. */
struct gathering {
    const struct tl_gather_request *asked;
    const struct tl_reference_scene *scene;
    const struct tl_shading_points *spots;
    bool diffuse[TL_SHADING_POINTS], glossy[TL_SHADING_POINTS]; /* whether the spot has such a lobe at all */
    double turn[TL_SHADING_POINTS]; /* where about its axis a spot's first lobe sample lies */
    struct tl_random random;
    float (*light)[TL_SHADING_POINTS];
    size_t rays;
};

/* K_s of a direction whose cosine with the axis is 1 - `off` [DESIGN 3]. */
static float lobe_value(float exponent, float off)
{
    if (off >= 1 || exponent * off > LOBE_END)
        return 0;
    return (exponent + 1) / (2 * (float)M_PI) * expf(exponent * log1pf(-off));
}

static float dot_of(const float v[3][TL_SHADING_POINTS], int i, vec3s w)
{
    return v[0][i] * w.x + v[1][i] * w.y + v[2][i] * w.z;
}

static vec3s point_of(const struct tl_shading_points *spots, int i)
{
    return (vec3s){{spots->point[0][i], spots->point[1][i], spots->point[2][i]}};
}

/* Rays whose light is worth asking for, and how much of it each would bring its spot. */
struct volley {
    struct tl_ray_packet bundle;
    int spot[TL_SHADING_POINTS];
    vec3s light[TL_SHADING_POINTS];
};

/* Directions stay unset where there is no ray. */
static void begin_volley(struct volley *volley, bool coherent)
{
    volley->bundle.count = 0;
    volley->bundle.from_m = 0;
    volley->bundle.to_m = INFINITY;
    volley->bundle.coherent = coherent;
}

static void add_ray_from(struct volley *volley, const struct gathering *gathering, int spot, vec3s origin,
                         vec3s direction, vec3s light)
{
    int i = volley->bundle.count++;
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

static void add_ray(struct volley *volley, const struct gathering *gathering, int spot, vec3s direction,
                    vec3s light)
{
    add_ray_from(volley, gathering, spot, point_of(gathering->spots, spot), direction, light);
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
    float seen[TL_SHADING_POINTS];
    tl_trace_transmittance_packet(gathering->scene->trace, &volley->bundle, seen);
    for (int i = 0; i < volley->bundle.count; i++)
        add_light(gathering, volley->spot[i], glms_vec3_scale(volley->light[i], seen[i]));
    gathering->rays += (size_t)volley->bundle.count;
}

static float kept_finite(float value)
{
    return value < FLT_MAX ? value : FLT_MAX;
}

static vec3s weigh(const struct tl_shading_points *spots, int i, vec3s radiance, float diffuse, float glossy)
{
    vec3s light;
    for (int c = 0; c < 3; c++)
        light.raw[c] =
            kept_finite(radiance.raw[c] * (spots->diffuse[c][i] * diffuse + spots->glossy[c][i] * glossy));
    return light;
}

static bool is_dark(vec3s light)
{
    return !(light.x > 0 || light.y > 0 || light.z > 0);
}

/* Cosines of a direction with every spot's horizon and normal, and 1 - its cosine with the axis. */
struct angles {
    float horizon[TL_SHADING_POINTS], normal[TL_SHADING_POINTS], off_axis[TL_SHADING_POINTS];
};

TL_CLONES static void measure_angles(const struct tl_shading_points *spots, vec3s w, struct angles *out)
{
    for (int i = 0; i < TL_SHADING_POINTS; i++) {
        out->horizon[i] =
            spots->horizon[0][i] * w.x + spots->horizon[1][i] * w.y + spots->horizon[2][i] * w.z;
        out->normal[i] = spots->normal[0][i] * w.x + spots->normal[1][i] * w.y + spots->normal[2][i] * w.z;
        /* Without cancellation where the two are close. */
        float x = spots->axis[0][i] - w.x, y = spots->axis[1][i] - w.y, z = spots->axis[2][i] - w.z;
        out->off_axis[i] = 0.5f * (x * x + y * y + z * z);
    }
}

/* 1 - the cosine of two directions, without cancellation where they are close. */
static float off_axis(vec3s axis, vec3s w)
{
    return 0.5f * glms_vec3_norm2(glms_vec3_sub(axis, w));
}

static vec3s finite_product(vec3s radiance, vec3s share)
{
    vec3s light;
    for (int c = 0; c < 3; c++)
        light.raw[c] = share.raw[c] > 0 ? kept_finite(radiance.raw[c] * share.raw[c]) : 0;
    return light;
}

/* What coat and facets send back of a direction from the environment, of which there are `draws` per sr. */
static vec3s layered_share(const struct gathering *gathering, int i, vec3s direction, float draws)
{
    const struct tl_shading_layers *layers = &gathering->spots->layers[i];
    float count = (float)gathering->asked->lobe_samples;
    vec3s share = {{0, 0, 0}};
    if (layers->coat > 0) {
        float lobe = lobe_value(layers->coat_exponent, off_axis(layers->coat_axis, direction));
        float coat = layers->coat * lobe / (draws + count * lobe);
        share = (vec3s){{coat, coat, coat}};
    }
    if (layers->faceted) {
        vec3s viewer = gathering->spots->viewer[i];
        vec3s gloss = tl_brdf_gloss(&layers->brdf, &layers->frame, direction, viewer);
        float density = tl_brdf_pdf(&layers->brdf, &layers->frame, direction, viewer);
        share = glms_vec3_add(share, glms_vec3_scale(gloss, layers->base / (draws + count * density)));
    }
    return share;
}

/* Light on the other side of sheets that let it through. */
static void gather_behind(struct gathering *gathering, const struct tl_sky_sample *sky)
{
    const struct tl_shading_points *spots = gathering->spots;
    float draws = (float)gathering->asked->strata * sky->density;
    struct volley volley;
    begin_volley(&volley, true);
    for (int i = 0; i < spots->count; i++) {
        float below = -dot_of(spots->normal, i, sky->direction);
        if (!spots->layered[i] || !(below > 0) || !(dot_of(spots->horizon, i, sky->direction) < 0))
            continue;
        vec3s share = glms_vec3_scale(spots->layers[i].transmitted, below / (float)M_PI / draws);
        vec3s light = finite_product(sky->radiance, share);
        if (!is_dark(light))
            add_ray_from(&volley, gathering, i, spots->layers[i].behind, sky->direction, light);
    }
    fire(gathering, &volley);
}

/* One direction from the environment, for all spots. */
static void gather_stratum(struct gathering *gathering, const struct tl_sky_sample *sky)
{
    const struct tl_shading_points *spots = gathering->spots;
    float draws = (float)gathering->asked->strata * sky->density;
    struct volley volley;
    struct angles angles;
    measure_angles(spots, sky->direction, &angles);
    begin_volley(&volley, true);
    for (int i = 0; i < spots->count; i++) {
        if (!(angles.horizon[i] > 0))
            continue;
        float diffuse = 0, glossy = 0;
        if (gathering->diffuse[i] && angles.normal[i] > 0)
            diffuse = angles.normal[i] / (float)M_PI / draws;
        if (gathering->glossy[i]) {
            float lobe = lobe_value(spots->exponent[i], angles.off_axis[i]);
            glossy = lobe / (draws + (float)gathering->asked->lobe_samples * lobe);
        }
        vec3s light = weigh(spots, i, sky->radiance, diffuse, glossy);
        if (spots->layered[i]) {
            vec3s share = layered_share(gathering, i, sky->direction, draws);
            light = glms_vec3_add(light, finite_product(sky->radiance, share));
        }
        if (!is_dark(light))
            add_ray(&volley, gathering, i, sky->direction, light);
    }
    fire(gathering, &volley);
}

void tl_gather_sample_sky(const struct tl_sky *sky, int count, int slot, int slots, struct tl_random shared,
                          struct tl_random own, struct tl_sky_sample *out)
{
    for (int i = 0; i < count; i++) {
        int turn = (int)(tl_random_unit(&shared) * slots);
        double within = ((slot + turn) % slots + tl_random_unit(&own)) / slots;
        out[i] = tl_sky_sample_at(sky, (i + within) / count);
    }
}

/* A direction drawn from K_s about the axis: `off` is 1 - its cosine, whose density is (s + 1) cos^s. */
static vec3s draw_lobe(vec3s axis, float exponent, double height, double turn, float *off)
{
    double away = -expm1(log(1 - height) / ((double)exponent + 1));
    double radius = sqrt(fmax(away * (2 - away), 0)), angle = 2 * M_PI * turn;
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
    struct tl_shading_points spots;
    int owner[TL_SHADING_POINTS];
    float share[TL_SHADING_POINTS];
    vec3s lamplight[TL_SHADING_POINTS];
};

/* Where a mirror's ray ends: in the sky, in the scene, or, where the ground fades, in both. */
static void reflect(struct gathering *gathering, int i, vec3s direction, vec3s sky_light,
                    struct reflections *reflections)
{
    const struct tl_ray_differential ray = {
        .origin = point_of(gathering->spots, i), .direction = direction, .to_m = INFINITY};
    struct tl_shading_point met = tl_shading_point_find(gathering->scene, &ray);
    if (met.layered) /* behind an open sheet a mirror shows the sky */
        met.cover *= 1 - met.layers.openness;
    gathering->rays++;
    add_light(gathering, i, glms_vec3_scale(sky_light, 1 - met.cover));
    if (met.cover > 0) {
        int r = reflections->spots.count;
        tl_shading_points_add(&reflections->spots, &met);
        reflections->owner[r] = i;
        reflections->share[r] = met.cover / (float)gathering->asked->lobe_samples;
        reflections->lamplight[r] = tl_reference_lamps(gathering->scene, &met, &gathering->rays);
    }
}

static void light_reflections(struct gathering *gathering, const struct reflections *reflections)
{
    if (reflections->spots.count == 0)
        return;
    struct tl_sky_sample sky[REFLECTED_STRATA];
    struct tl_random random = tl_random_begin(gathering->random.state, 1);
    tl_gather_sample_sky(&gathering->scene->sky, REFLECTED_STRATA, 0, 1, random, gathering->random, sky);
    const struct tl_gather_request inner = {.scene = gathering->scene,
                                            .strata = REFLECTED_STRATA,
                                            .sky = sky,
                                            .lobe_samples = REFLECTED_LOBE_SAMPLES,
                                            .random = random};
    float light[3][TL_SHADING_POINTS];
    gathering->rays += tl_gather(&inner, &reflections->spots, light);
    for (int r = 0; r < reflections->spots.count; r++)
        for (int c = 0; c < 3; c++)
            gathering->light[c][reflections->owner[r]] += gathering->spots->glossy[c][reflections->owner[r]] *
                                                          reflections->share[r] *
                                                          (light[c][r] + reflections->lamplight[r].raw[c]);
}

/* One direction from each spot's lobe. */
static void gather_lobes(struct gathering *gathering, int sample)
{
    const struct tl_shading_points *spots = gathering->spots;
    const struct tl_gather_request *asked = gathering->asked;
    struct volley volley;
    struct reflections reflections = {0};
    begin_volley(&volley, false);
    for (int i = 0; i < spots->count; i++) {
        double height = (sample + tl_random_unit(&gathering->random)) / asked->lobe_samples;
        if (!gathering->glossy[i])
            continue;
        float off;
        double turn = gathering->turn[i] + sample * GOLDEN;
        vec3s axis = {{spots->axis[0][i], spots->axis[1][i], spots->axis[2][i]}};
        vec3s direction = draw_lobe(axis, spots->exponent[i], fmin(height, 1 - DBL_EPSILON), turn, &off);
        if (!(dot_of(spots->horizon, i, direction) > 0))
            continue;
        struct tl_sky_sample sky = tl_sky_lookup(&gathering->scene->sky, direction);
        float lobe = lobe_value(spots->exponent[i], off);
        if (!(lobe > 0))
            continue;
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

/* Two numbers in [0, 1) for sample `sample` of a spot's lobe. */
static vec2s numbers_for(struct gathering *gathering, int i, int sample)
{
    double height = (sample + tl_random_unit(&gathering->random)) / gathering->asked->lobe_samples;
    double turn = gathering->turn[i] + sample * GOLDEN;
    const float below_one = 1 - 0x1p-24f;
    return (vec2s){{fminf((float)height, below_one), fminf((float)(turn - floor(turn)), below_one)}};
}

/* One direction from each spot's coat ... */
static void gather_coats(struct gathering *gathering, int sample)
{
    const struct tl_gather_request *asked = gathering->asked;
    struct volley volley;
    begin_volley(&volley, false);
    for (int i = 0; i < gathering->spots->count; i++) {
        const struct tl_shading_layers *layers = &gathering->spots->layers[i];
        if (!gathering->spots->layered[i] || !(layers->coat > 0))
            continue;
        float off;
        vec2s numbers = numbers_for(gathering, i, sample);
        vec3s direction =
            draw_lobe(layers->coat_axis, layers->coat_exponent, (double)numbers.x, (double)numbers.y, &off);
        float lobe = lobe_value(layers->coat_exponent, off);
        if (!(dot_of(gathering->spots->horizon, i, direction) > 0) || !(lobe > 0))
            continue;
        struct tl_sky_sample sky = tl_sky_lookup(&gathering->scene->sky, direction);
        float share =
            layers->coat * lobe / ((float)asked->strata * sky.density + (float)asked->lobe_samples * lobe);
        vec3s light = finite_product(sky.radiance, (vec3s){{share, share, share}});
        if (!is_dark(light))
            add_ray(&volley, gathering, i, direction, light);
    }
    fire(gathering, &volley);
}

/* ... and from its facets. */
static void gather_facets(struct gathering *gathering, int sample)
{
    const struct tl_gather_request *asked = gathering->asked;
    struct volley volley;
    begin_volley(&volley, false);
    for (int i = 0; i < gathering->spots->count; i++) {
        const struct tl_shading_layers *layers = &gathering->spots->layers[i];
        if (!gathering->spots->layered[i] || !layers->faceted)
            continue;
        float density;
        vec3s viewer = gathering->spots->viewer[i];
        vec2s numbers = numbers_for(gathering, i, sample);
        vec3s direction =
            tl_brdf_sample(&layers->brdf, &layers->frame, viewer, numbers.x, numbers.y, &density);
        if (!(density > 0) || !(dot_of(gathering->spots->horizon, i, direction) > 0))
            continue;
        struct tl_sky_sample sky = tl_sky_lookup(&gathering->scene->sky, direction);
        vec3s gloss = tl_brdf_gloss(&layers->brdf, &layers->frame, direction, viewer);
        float draws = (float)asked->strata * sky.density + (float)asked->lobe_samples * density;
        vec3s light = finite_product(sky.radiance, glms_vec3_scale(gloss, layers->base / draws));
        if (!is_dark(light))
            add_ray(&volley, gathering, i, direction, light);
    }
    fire(gathering, &volley);
}

static void gather_layers(struct gathering *gathering)
{
    for (int i = 0; i < gathering->asked->strata; i++)
        gather_behind(gathering, &gathering->asked->sky[i]);
    for (int i = 0; i < gathering->asked->lobe_samples; i++) {
        gather_coats(gathering, i);
        gather_facets(gathering, i);
    }
}

size_t tl_gather(const struct tl_gather_request *asked, const struct tl_shading_points *spots,
                 float light[3][TL_SHADING_POINTS])
{
    struct gathering gathering = {
        .asked = asked, .scene = asked->scene, .spots = spots, .random = asked->random, .light = light};
    bool any_glossy = false;
    for (int i = 0; i < spots->count; i++) {
        gathering.diffuse[i] =
            spots->diffuse[0][i] > 0 || spots->diffuse[1][i] > 0 || spots->diffuse[2][i] > 0;
        gathering.glossy[i] = spots->glossy[0][i] > 0 || spots->glossy[1][i] > 0 || spots->glossy[2][i] > 0;
        gathering.turn[i] = tl_random_unit(&gathering.random);
        any_glossy |= gathering.glossy[i];
    }
    memset(light, 0, 3 * sizeof light[0]);
    for (int i = 0; i < asked->strata; i++)
        gather_stratum(&gathering, &asked->sky[i]);
    for (int i = 0; any_glossy && i < asked->lobe_samples; i++)
        gather_lobes(&gathering, i);
    if (spots->any_layered)
        gather_layers(&gathering);
    for (int c = 0; c < 3; c++) /* no infinity goes on, so that nothing times zero makes a NaN */
        for (int i = 0; i < spots->count; i++)
            light[c][i] = kept_finite(light[c][i]);
    return gathering.rays;
}
