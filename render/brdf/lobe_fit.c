#include "render/brdf/lobe_fit.h"

#include "render/brdf/facets.h"
#include "render/brdf/ggx/ggx_lobes.h"
#include "render/brdf/ward_lanes.h"

#include <math.h>

struct slopes {
    float weft, warp; /* standard deviations along tangent and bitangent */
};

static bool is_ggx(const struct tl_brdf *brdf)
{
    return tl_gloss_has_tails(&brdf->gloss);
}

/* A width is Beckmann's m: exp(-tan^2 / m^2) has the variance m^2 / 2 along each axis. */
static struct slopes slopes_of(const struct tl_brdf *brdf)
{
    if (brdf->gloss.model == TL_REFLECT_WARD)
        return (struct slopes){brdf->gloss.width_weft * GLM_SQRT1_2f, brdf->gloss.width_warp * GLM_SQRT1_2f};
    float both = brdf->gloss.width_weft * GLM_SQRT1_2f;
    if (brdf->gloss.model == TL_REFLECT_BLINN_PHONG)
        both = 1 / sqrtf(4 * brdf->exponent + 2);
    return (struct slopes){both, both};
}

static vec3s local_of(const struct tl_brdf_frame *frame, vec3s d)
{
    return (vec3s){{glms_vec3_dot(d, frame->tangent), glms_vec3_dot(d, frame->bitangent),
                    glms_vec3_dot(d, frame->normal)}};
}

/* The normal of a facet with a slope along tangent and bitangent. */
static vec3s facet_of(const struct tl_brdf_frame *frame, vec2s slope)
{
    vec3s h = glms_vec3_add(frame->normal, glms_vec3_scale(frame->tangent, slope.x));
    return glms_vec3_normalize(glms_vec3_add(h, glms_vec3_scale(frame->bitangent, slope.y)));
}

static vec3s mirrored(vec3s h, vec3s v)
{
    return glms_vec3_normalize(glms_vec3_sub(glms_vec3_scale(h, 2 * glms_vec3_dot(h, v)), v));
}

/* The gloss in the direction in which a facet of this slope reflects, divided by the pdf with which Gaussian
 * slopes reflect light there (the pdf of the slope times the Jacobian of the mirror direction). This is the
 * contribution of the slope. */
static vec3s value_of_slope(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame,
                            const struct slopes *slopes, vec3s v, vec2s slope)
{
    vec3s h = facet_of(frame, slope), l = mirrored(h, v);
    float cosine = glms_vec3_dot(h, frame->normal), towards = glms_vec3_dot(h, v);
    if (!(towards > 0) || !(glms_vec3_dot(l, frame->normal) > 0))
        return (vec3s){{0, 0, 0}};
    float x = slope.x / slopes->weft, y = slope.y / slopes->warp;
    float pdf = expf(-0.5f * (x * x + y * y)) / (2 * GLM_PIf * slopes->weft * slopes->warp);
    pdf /= cosine * cosine * cosine * 4 * towards;
    return glms_vec3_scale(tl_brdf_gloss(brdf, frame, l, v), 1 / pdf);
}

/* Nodes and weights for the mean over a normal distribution between middle - half and middle + half. The
 * weights sum to `mass`. */
static void sample_normal(float middle, float half, float mass, float at[SLOPE_POINTS],
                          float share[SLOPE_POINTS])
{
    float sum = 0;
    for (int i = 0; i < SLOPE_POINTS; i++) {
        at[i] = middle + half * slope_points[i];
        share[i] = slope_weight(i, at[i]);
        sum += share[i];
    }
    for (int i = 0; i < SLOPE_POINTS; i++)
        share[i] *= mass / sum;
}

/* The albedo towards the viewer: the mean contribution over all slopes. */
static vec3s albedo_of(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame,
                       const struct slopes *slopes, vec3s v)
{
    vec3s local = local_of(frame, v), sum = {{0, 0, 0}};
    const SlopeQuadrature nodes = slope_quadrature(slopes->weft, slopes->warp, local.x, local.y, local.z);
    float at[SLOPE_POINTS], share[SLOPE_POINTS];
    sample_normal(nodes.middle, nodes.half_width, nodes.share, at, share);
    for (int i = 0; i < SLOPE_POINTS; i++)
        for (int sign = -1; sign <= 1; sign += 2) {
            vec2s slope = {{at[i] * nodes.along_x + (float)sign * nodes.across_x,
                            at[i] * nodes.along_y + (float)sign * nodes.across_y}};
            vec3s value = value_of_slope(brdf, frame, slopes, v, slope);
            sum = glms_vec3_add(sum, glms_vec3_scale(value, 0.5f * share[i]));
        }
    return sum;
}

static void scale_to_albedo(vec3s albedo, const struct tl_brdf_frame *frame, int count,
                            struct tl_fitted_lobe *lobes)
{
    vec3s sum = {{0, 0, 0}};
    for (int k = 0; k < count; k++) {
        float above = slope_above(glms_vec3_dot(lobes[k].direction, frame->normal), lobes[k].exponent);
        sum = glms_vec3_add(sum, glms_vec3_scale(lobes[k].weight, above));
    }
    for (int k = 0; k < count; k++)
        for (int c = 0; c < 3; c++)
            lobes[k].weight.raw[c] *= sum.raw[c] > 1e-20f ? albedo.raw[c] / sum.raw[c] : 0;
}

static int fit_facets(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s v, int minimum,
                      int maximum, struct tl_fitted_lobe *lobes)
{
    struct slopes slopes = slopes_of(brdf);
    vec3s local = local_of(frame, v);
    const LobeSet set =
        lobe_set(slopes.weft, slopes.warp, local.x, local.y, local.z, (float)minimum, (float)maximum);
    int count = (int)set.count;
    for (int k = 0; k < count; k++) {
        const SlopeLobe lobe = slope_lobe(set, (float)k, local.x, local.y, local.z);
        vec2s slope = {{lobe.slope_x, lobe.slope_y}};
        vec3s value = value_of_slope(brdf, frame, &slopes, v, slope);
        lobes[k] = (struct tl_fitted_lobe){.direction = mirrored(facet_of(frame, slope), v),
                                           .exponent = slope_exponent(lobe.variance),
                                           .weight = glms_vec3_scale(value, lobe.share)};
    }
    scale_to_albedo(albedo_of(brdf, frame, &slopes, v), frame, count, lobes);
    return count;
}

/* The fit works in the frame of the widths. */
static int fit_turned(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s v, int minimum,
                      int maximum, struct tl_fitted_lobe *lobes)
{
    const struct tl_brdf_frame own = tl_brdf_own_frame(brdf, frame);
    struct tl_brdf straight = *brdf;
    straight.turn = 0;
    return fit_facets(&straight, &own, v, minimum, maximum, lobes);
}

/* The share of light by the model's masking over that by the table's, which is Smith's. */
static float masked_otherwise(const struct tl_brdf *brdf, vec3s h, vec3s l, vec3s v)
{
    const float cos_a = fmaxf(l.z, 0.02f);
    return tl_brdf_masking(brdf, cos_a, v.z, fmaxf(glms_vec3_dot(h, v), 0.02f), h.z) /
           tl_brdf_smith(brdf, cos_a, v.z);
}

static int fit_ggx(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s v, int maximum,
                   struct tl_fitted_lobe *lobes)
{
    const vec3s local = local_of(frame, v);
    const float flat = hypotf(local.x, local.y), x = flat > 0 ? local.x / flat : 1,
                y = flat > 0 ? local.y / flat : 0;
    struct tl_ggx_lobe found[TL_GGX_LOBES_MAX];
    const int count = tl_ggx_lobes(brdf->gloss.width_weft, local.z, maximum, found);
    for (int k = 0; k < count; k++) {
        const float sine = sinf(found[k].facet);
        const vec3s h = {{x * sine, y * sine, cosf(found[k].facet)}}, l = mirrored(h, local);
        const float masked =
            brdf->gloss.masking == TL_MASKING_SMITH ? 1 : masked_otherwise(brdf, h, l, local);
        vec3s direction = glms_vec3_scale(frame->tangent, l.x);
        direction = glms_vec3_muladds(frame->bitangent, l.y, direction);
        direction = glms_vec3_muladds(frame->normal, l.z, direction);
        lobes[k] = (struct tl_fitted_lobe){
            direction, found[k].exponent,
            glms_vec3_scale(tl_brdf_fresnel(brdf, found[k].cosine), masked * found[k].weight)};
    }
    return count;
}

/* The albedo of F (s + 2) / (s + 1) K_s(r, l) cos a: the mean of F cos a over the lobe. Its directions spread
 * by about 1 / sqrt(s + 2) in the plane of incidence, where the horizon cuts them off. The spread across that
 * plane multiplies the cosine by sqrt((s + 1) / (s + 2)). */
static vec3s albedo_of_cosine_lobe(const struct tl_brdf *brdf, float facing)
{
    float spread = 1 / sqrtf(brdf->exponent + 2), across = sqrtf(fmaxf(1 - facing * facing, 0));
    float at[SLOPE_POINTS], share[SLOPE_POINTS];
    vec3s sum = {{0, 0, 0}};
    float from = fmaxf(-SLOPE_RANGE, -asinf(fminf(facing, 1)) / spread);
    float mass = (erff(SLOPE_RANGE * GLM_SQRT1_2f) - erff(from * GLM_SQRT1_2f)) / 2;
    sample_normal((SLOPE_RANGE + from) / 2, (SLOPE_RANGE - from) / 2, mass, at, share);
    for (int i = 0; i < SLOPE_POINTS; i++) {
        float turn = spread * at[i], cosine = facing * cosf(turn) + across * sinf(turn);
        float from_half = cosf((2 * acosf(fminf(facing, 1)) - turn) / 2);
        vec3s reflectance = tl_brdf_fresnel(brdf, from_half);
        sum = glms_vec3_add(sum, glms_vec3_scale(reflectance, share[i] * fmaxf(cosine, 0)));
    }
    return glms_vec3_scale(sum, sqrtf((brdf->exponent + 2) / (brdf->exponent + 1)));
}

/* (r.l)^s times a cosine is close to one lobe of exponent s + 1 whose axis is tilted slightly towards the
 * normal. */
static int fit_cosine_lobe(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s v,
                           struct tl_fitted_lobe *lobes)
{
    float s = brdf->exponent, facing = fmaxf(glms_vec3_dot(frame->normal, v), 0);
    vec3s r = mirrored(frame->normal, v);
    lobes[0] = (struct tl_fitted_lobe){
        .direction = glms_vec3_normalize(glms_vec3_add(glms_vec3_scale(r, s), frame->normal)),
        .exponent = s + 1,
        .weight = {{1, 1, 1}}};
    scale_to_albedo(albedo_of_cosine_lobe(brdf, facing), frame, 1, lobes);
    return 1;
}

/* Standard deviation of neighbours on a half circle over their distance, at which their sum has no dip. */
#define THREAD_OVERLAP 0.35f

/* The variance at which `count` neighbours on a half circle overlap. */
static float thread_variance(const struct tl_brdf *brdf, int count, float sine)
{
    float deviation = THREAD_OVERLAP * GLM_PIf * sine / (float)count;
    return fmaxf(1 / (brdf->exponent + 1), deviation * deviation);
}

/* A thread reflects light into a cone about itself. Across the cone the gloss is a power of a cosine; along
 * it the gloss follows the cosine to the normal, and every lobe gets an equal part of its integral. */
static int fit_threads(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s v, int max_count,
                       struct tl_fitted_lobe *lobes)
{
    float s = brdf->exponent, along = -glms_vec3_dot(frame->tangent, v);
    float sine = sqrtf(fmaxf(1 - along * along, 0)), facing = fmaxf(glms_vec3_dot(frame->normal, v), 0);
    /* The albedo: the integral of cos^s, close to sqrt(2 pi / (s + 1/2)), times the mean of sin^2 weighted by
     * it, times the integral of the cosine along the cone. */
    float across = sine * sine + (along * along - sine * sine) / (s + 2);
    float all = tl_brdf_lobe_scale(brdf) * sqrtf(2 * GLM_PIf / (s + 0.5f)) * across * 2;
    vec3s albedo = glms_vec3_scale(tl_brdf_fresnel(brdf, facing), facing > 0 ? all : 0);
    for (int k = 0; k < max_count; k++) {
        float aside = (2 * (float)k + 1) / (float)max_count - 1, ahead = sqrtf(1 - aside * aside);
        vec3s d = glms_vec3_scale(frame->tangent, along);
        d = glms_vec3_add(d, glms_vec3_scale(frame->normal, sine * ahead));
        d = glms_vec3_add(d, glms_vec3_scale(frame->bitangent, sine * aside));
        lobes[k] = (struct tl_fitted_lobe){.direction = glms_vec3_normalize(d),
                                           .exponent = slope_exponent(thread_variance(brdf, max_count, sine)),
                                           .weight = {{1, 1, 1}}};
    }
    scale_to_albedo(albedo, frame, max_count, lobes);
    return max_count;
}

int tl_lobe_fit_make(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s v, int minimum,
                     int maximum, struct tl_fitted_lobe lobes[TL_LOBE_FIT_MAX])
{
    if (!(glms_vec3_dot(frame->normal, v) > 0))
        return 0;
    switch (brdf->gloss.model) {
    case TL_REFLECT_PHONG:
        lobes[0] = (struct tl_fitted_lobe){mirrored(frame->normal, v), brdf->exponent,
                                           tl_brdf_fresnel(brdf, glms_vec3_dot(frame->normal, v))};
        return 1;
    case TL_REFLECT_COSINE_LOBE:
        return fit_cosine_lobe(brdf, frame, v, lobes);
    case TL_REFLECT_BANKS:
        return fit_threads(brdf, frame, v, maximum, lobes);
    default:
        return is_ggx(brdf) ? fit_ggx(brdf, frame, v, maximum, lobes)
                            : fit_turned(brdf, frame, v, minimum, maximum, lobes);
    }
}

/* Ward's facets, alike but for widths and colours, whose fit has a closed form. */
static bool are_lanes(const struct tl_brdf_sum *sum)
{
    const struct tl_gloss *first = &sum->items[0].gloss;
    for (int i = 0; i < sum->count; i++) {
        const struct tl_gloss *gloss = &sum->items[i].gloss;
        if (gloss->model != TL_REFLECT_WARD || gloss->ward != first->ward ||
            gloss->fresnel != TL_FRESNEL_SCHLICK)
            return false;
    }
    return true;
}

/* Lane i is gloss i of the sum; idle lanes repeat the first. */
TL_CLONES static void fit_lanes(const struct tl_brdf_sum *sum, vec3s viewer, int max_count,
                                struct tl_ward_lanes *ward)
{
    ward->gloss = &sum->items[0].gloss;
    for (int i = 0; i < TL_LANES; i++) {
        const struct tl_brdf *brdf = &sum->items[i < sum->count ? i : 0];
        const struct tl_gloss *gloss = &brdf->gloss;
        const float sine = brdf->turn, cosine = sqrtf(1 - sine * sine);
        const vec3s local = {
            {cosine * viewer.x + sine * viewer.y, cosine * viewer.y - sine * viewer.x, viewer.z}};
        for (int c = 0; c < 3; c++)
            ward->viewer[c][i] = local.raw[c];
        ward->square[0][i] = gloss->width_weft * gloss->width_weft;
        ward->square[1][i] = gloss->width_warp * gloss->width_warp;
    }
    tl_ward_fit(ward, max_count, sum->count);
}

/* The lobes of lane i, in the space of the frame's vectors. Lanes with fewer than `ward->count` have none at
 * the end. */
static int take_lane(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame,
                     const struct tl_ward_lanes *ward, int i, struct tl_fitted_lobe *lobes)
{
    const struct tl_brdf_frame own = tl_brdf_own_frame(brdf, frame);
    const vec3s plain = tl_brdf_fresnel(brdf, 1), away = glms_vec3_sub(tl_brdf_fresnel(brdf, 0), plain);
    vec3s scale;
    for (int c = 0; c < 3; c++) {
        const float sum = plain.raw[c] * ward->sum[0][i] + away.raw[c] * ward->sum[1][i];
        const float albedo = plain.raw[c] * ward->albedo[0][i] + away.raw[c] * ward->albedo[1][i];
        scale.raw[c] = sum > 1e-20f ? albedo / sum : 0;
    }
    int count = 0;
    for (int k = 0; k < ward->count; k++) {
        if (!(ward->plain[k][i] > 0))
            continue;
        vec3s weight = glms_vec3_scale(plain, ward->plain[k][i]);
        weight = glms_vec3_muladds(away, ward->away[k][i], weight);
        vec3s direction = glms_vec3_scale(own.tangent, ward->local[k][0][i]);
        direction = glms_vec3_muladds(own.bitangent, ward->local[k][1][i], direction);
        direction = glms_vec3_muladds(own.normal, ward->local[k][2][i], direction);
        lobes[count++] =
            (struct tl_fitted_lobe){direction, ward->exponent[k][i], glms_vec3_mul(scale, weight)};
    }
    return count;
}

int tl_lobe_fit_sum(const struct tl_brdf_sum *sum, const struct tl_brdf_frame *frame, vec3s v, int max_count,
                    struct tl_fitted_lobe lobes[TL_LOBE_FIT_SUM_MAX])
{
    int count = 0;
    const bool by_lanes = are_lanes(sum) && glms_vec3_dot(frame->normal, v) > 0;
    struct tl_ward_lanes ward;
    if (by_lanes)
        fit_lanes(sum, local_of(frame, v), max_count, &ward);
    for (int i = 0; i < sum->count; i++)
        count += by_lanes ? take_lane(&sum->items[i], frame, &ward, i, &lobes[count])
                          : tl_lobe_fit_make(&sum->items[i], frame, v, 1, max_count, &lobes[count]);
    return count;
}

void tl_lobe_fit_exponents(const struct tl_brdf *brdf, float *min, float *max)
{
    struct slopes slopes = slopes_of(brdf);
    float wide = fmaxf(slopes.weft, slopes.warp), thin = fminf(slopes.weft, slopes.warp);
    if (is_ggx(brdf)) {
        tl_ggx_exponents(brdf->gloss.width_weft, min, max);
        return;
    }
    switch (brdf->gloss.model) {
    case TL_REFLECT_PHONG:
    case TL_REFLECT_COSINE_LOBE:
        *min = brdf->exponent;
        *max = brdf->exponent + 1;
        break;
    case TL_REFLECT_BANKS:
        *min = slope_exponent(thread_variance(brdf, 1, 1));
        *max = brdf->exponent;
        break;
    default:
        *min = slope_exponent(4 * wide * wide);
        *max = slope_exponent(4 * thin * thin * SLOPE_MIN_COSINE * SLOPE_MIN_COSINE);
    }
}

vec3s tl_brdf_gloss_under_disc(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s l,
                               vec3s v, float radius)
{
    /* The variance of a disc is radius^2 / 4 along each axis. A facet turns light by twice its own turn, so
     * the disc adds a sixteenth of radius^2 to the variance of the facets' slopes, which is m^2 / 2: an
     * eighth to m^2. To the variance 1 / (s + 1) of a lobe it adds a quarter. */
    struct tl_brdf wide = *brdf;
    float square = radius * radius / 8;
    wide.gloss.width_weft = sqrtf(wide.gloss.width_weft * wide.gloss.width_weft + square);
    wide.gloss.width_warp = sqrtf(wide.gloss.width_warp * wide.gloss.width_warp + square);
    wide.exponent = fmaxf((brdf->exponent + 1) / (1 + (brdf->exponent + 1) * radius * radius / 4) - 1, 0.25f);
    return tl_brdf_gloss(&wide, frame, l, v);
}
